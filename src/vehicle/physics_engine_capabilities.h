// SPDX-License-Identifier: Apache-2.0
// Optional capabilities of a physics engine, one small interface each. An engine returns null for a
// capability that it lacks (vehicle/physics_engine.h). A caller that needs a missing capability
// reports that to the user.
#pragma once

#include <vector>

#include "core/math.h"
#include "scene/hitch.h"
#include "scene/machine.h"
#include "terramechanics/track.h"
#include "vehicle/machine_state.h"

namespace navvy::vehicle {

/// Capability of an engine to move the base links of machines to given poses.
class PlacementCapability {
 public:
  /// Moves the machine's base link to the pose in `input` within its duration. The target holds
  /// until it is replaced or until the machine's drive is commanded.
  virtual void set_base(int machine, const BaseInput& input) = 0;
  /// Returns the pose to which the machine's base link moves. Without a target, this is its current
  /// pose.
  virtual BaseInput base(int machine) const = 0;

 protected:
  ~PlacementCapability() = default;
};

/// Capability of an engine to collide its machines with machines that another engine moves, called
/// obstacles.
///
/// Obstacles push what they touch and are not pushed back.
class ObstacleCapability {
 public:
  /// Adds the collision shapes and shells of `machine` as an obstacle and returns the obstacle's
  /// index.
  /// @throws InputError for a machine that this engine cannot build.
  virtual int add_obstacle(const scene::Machine& machine) = 0;
  /// Sets pose and velocity of every link of an obstacle for the start of the next step. `links`
  /// has one entry per link of the obstacle's machine. Call it before every step.
  virtual void move_obstacle(int obstacle, const std::vector<LinkState>& links) = 0;

 protected:
  ~ObstacleCapability() = default;
};

/// Capability of an engine to couple two machines by a hitch. Machines coupled by a closed hitch do
/// not collide with each other.
class HitchCapability {
 public:
  /// Adds a hitch between two machines of this engine and returns the hitch's index. `parent` and
  /// `child` are machine indices in this engine; the scene's machine indices in `hitch` are
  /// ignored.
  virtual int add_hitch(const scene::Hitch& hitch, int parent, int child) = 0;
  /// Closes or opens a hitch.
  /// @throws InputError if an open hitch is to be closed while its eye is farther than kHitchReach
  /// from its hook.
  virtual void set_hitch(int hitch, bool closed) = 0;
  /// Returns the state of a hitch after the last step.
  virtual HitchState hitch(int hitch) const = 0;

 protected:
  ~HitchCapability() = default;
};

/// Capability of an engine to stop shells (steel plates of tools) at a level rock surface below the
/// soil.
class RockCapability {
 public:
  /// Sets the height of the rock surface in the world frame [m]. Until it is set, shells meet no
  /// rock. The height is not part of the engine's state, so set it again after loading a snapshot.
  virtual void set_rock(double height) = 0;
  /// Returns the impulse of the rock on a shell in the last step, in the world frame [N s]. `shell`
  /// is an index in scene::Machine::shells.
  virtual Vec3 rock_impulse(int machine, int shell) const = 0;

 protected:
  ~RockCapability() = default;
};

/// Capability of an engine to report where crawler tracks press on the ground.
class TrackCapability {
 public:
  /// Returns the rectangles on which the track of a wheel pressed in the last step; empty for a
  /// wheel without a track.
  virtual std::vector<terramechanics::TrackPatch> track_patches(int machine, int wheel) const = 0;

 protected:
  ~TrackCapability() = default;
};

/// Capability of an engine to report the state of hydraulic pumps and combustion engines.
class PowerCapability {
 public:
  /// Returns the state of the machine's pump after the last step; all zero for a machine without a
  /// pump.
  virtual PumpState pump(int machine) const = 0;
  /// Returns the state of the machine's combustion engine after the last step. All values are zero
  /// for a drive that has no gears and does not share its engine with the pump.
  virtual CombustionEngineState drive_engine(int machine) const = 0;

 protected:
  ~PowerCapability() = default;
};

/// Capability of an engine to report momentum and work, from which tests check balances.
class AccountCapability {
 public:
  /// Returns the total linear momentum of a machine, in the world frame [N s].
  virtual Vec3 momentum(int machine) const = 0;
  /// Returns the mechanical work that a machine's joints and drive have done on it since the start
  /// [J]. Work done by a load on a joint is not subtracted.
  virtual double work(int machine) const = 0;
  /// Returns the sum of all impulses of the ground on the machine (tyres, tracks, contacts, rock)
  /// in the last step, in the world frame [N s].
  virtual Vec3 ground_impulse(int machine) const = 0;
  /// Returns the sum of all impulses that the caller has applied to the machine since the start,
  /// including those of forces, in the world frame [N s].
  virtual Vec3 external_impulse(int machine) const = 0;

 protected:
  ~AccountCapability() = default;
};

}  // namespace navvy::vehicle
