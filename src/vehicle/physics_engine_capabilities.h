// SPDX-License-Identifier: Apache-2.0
// Optional abilities of a physics engine, one small interface each. An engine returns null for an
// ability that it lacks (vehicle/physics_engine.h); whoever needs it reports that to the user.
#pragma once

#include <vector>

#include "core/math.h"
#include "scene/hitch.h"
#include "scene/machine.h"
#include "terramechanics/track.h"
#include "vehicle/machine_state.h"

namespace navvy::vehicle {

/// Moves the bases of machines to given poses.
class PlacementCapability {
 public:
  /// Moves the base link to `input` within its duration. The target holds until it is replaced or
  /// until the drive is commanded.
  virtual void set_base(int machine, const BaseInput& input) = 0;
  /// Returns the pose that the base moves to, or its present pose if it has no target.
  virtual BaseInput base(int machine) const = 0;

 protected:
  ~PlacementCapability() = default;
};

/// Collides this engine's machines with machines that another engine moves.
///
/// Obstacles push what they meet and are not pushed back.
class ObstacleCapability {
 public:
  /// Adds the collision shapes and shells of `machine` as an obstacle and returns its number.
  /// @throws InputError for a machine that this engine cannot build.
  virtual int add_obstacle(const scene::Machine& machine) = 0;
  /// Sets the pose and velocity of every link of an obstacle at the start of the next step. Call it
  /// before every step.
  virtual void move_obstacle(int obstacle, const std::vector<LinkState>& links) = 0;

 protected:
  ~ObstacleCapability() = default;
};

/// Couples machines by hitches. Coupled machines do not collide with each other.
class HitchCapability {
 public:
  /// Adds a hitch between two machines of this engine and returns its number. `parent` and `child`
  /// are indices in this engine and replace the scene's indices in `hitch`.
  virtual int add_hitch(const scene::Hitch& hitch, int parent, int child) = 0;
  /// Closes or opens a hitch.
  /// @throws InputError when it should close and the eye is farther than kHitchReach from the hook.
  virtual void set_hitch(int hitch, bool closed) = 0;
  /// Returns the state of a hitch after the last step.
  virtual HitchState hitch(int hitch) const = 0;

 protected:
  ~HitchCapability() = default;
};

/// Stops shells at a level rock surface below the soil.
class RockCapability {
 public:
  /// Sets the height of the rock surface [m]. Until it is set, no shell meets rock. The height is
  /// not part of the engine's state: set it again after loading.
  virtual void set_rock(double height) = 0;
  /// Returns the impulse of the rock on a shell in the last step [N s], axes of W.
  virtual Vec3 rock_impulse(int machine, int shell) const = 0;

 protected:
  ~RockCapability() = default;
};

/// Reports where crawler tracks press on the ground.
class TrackCapability {
 public:
  /// Returns the contact patches of a track in the last step; empty for a wheel without a track.
  virtual std::vector<terramechanics::TrackPatch> track_patches(int machine, int wheel) const = 0;

 protected:
  ~TrackCapability() = default;
};

/// Reports the state of pumps and combustion engines.
class PowerCapability {
 public:
  /// Returns the pump's state after the last step; zeros for a machine without a pump.
  virtual PumpState pump(int machine) const = 0;
  /// Returns the state of the combustion engine after the last step; zeros for a drive that neither
  /// has gears nor shares its engine with the pump.
  virtual CombustionEngineState drive_engine(int machine) const = 0;

 protected:
  ~PowerCapability() = default;
};

/// Accounts for momentum and work, so that tests can close their balances.
class AccountCapability {
 public:
  /// Returns the total momentum of a machine [N s], axes of W.
  virtual Vec3 momentum(int machine) const = 0;
  /// Returns the mechanical work of the machine's joints and drive since the start [J].
  virtual double work(int machine) const = 0;
  /// Returns the sum of ground impulses (tyres, tracks, contacts, rock) in the last step [N s].
  virtual Vec3 ground_impulse(int machine) const = 0;
  /// Returns the sum of all impulses applied by the caller since the start [N s].
  virtual Vec3 external_impulse(int machine) const = 0;

 protected:
  ~AccountCapability() = default;
};

}  // namespace navvy::vehicle
