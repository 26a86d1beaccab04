// SPDX-License-Identifier: Apache-2.0
// Interface of physics engines for machines. Bullet (dynamic machines) and the kinematic engine
// (positions as commanded) implement it here; an engine outside the tree passes
// tests/vehicle/engine_contract.h.
#pragma once

#include <memory>
#include <vector>

#include "core/archive.h"
#include "core/math.h"
#include "scene/machine.h"
#include "terramechanics/ground_query.h"
#include "vehicle/machine_state.h"
#include "vehicle/physics_engine_capabilities.h"
#include "vehicle/physics_engine_factory.h"

namespace navvy::vehicle {

/// Answers questions about the ground under wheels and bodies. The ground's owner implements it:
/// `coupling` over the columns, tests over a plane.
using terramechanics::GroundQuery;

/// Steps the machines of one world together.
///
/// The functions below are the core that every engine implements; the capabilities at the end are
/// optional. Machine, link, joint and wheel indices are those of scene::Machine; poses, velocities
/// and forces are in W. Not thread-safe.
///
/// `coupling` calls an engine in this order: all machines are added before the first step. Then, in
/// every base step, commands (set_joint, set_drive, set_brake), `step`, reads of states and inverse
/// masses for the soil, and `apply_impulse_of_step` with the soil's answer. Reads must be cheap:
/// they occur several times per link and step. A step must depend on the visited state alone, so
/// that a run continued from a snapshot is bit-identical.
class PhysicsEngine {
 public:
  virtual ~PhysicsEngine() = default;

  /// Adds a machine with its model frame M at X_WM and returns its index.
  /// @throws InputError for a machine that this engine cannot build.
  virtual int add_machine(const scene::Machine& machine, const Pose& X_WM) = 0;
  /// Returns the number of machines added so far.
  virtual int machine_count() const = 0;

  /// Commands a joint until the next command replaces it. Without any command a joint holds its
  /// initial position; ball joints, and wheels of a machine without a drive, turn freely. A wheel
  /// or steering joint commanded here returns to the drive with the next set_drive.
  virtual void set_joint(int machine, int joint, const JointInput& input) = 0;
  /// Commands the drive until the next command replaces it.
  virtual void set_drive(int machine, const DriveInput& input) = 0;
  /// Sets or releases a joint's brake. A set brake holds the joint in place with at most
  /// scene::Joint::brake, whatever its command. Has no effect on a joint without a brake.
  virtual void set_brake(int machine, int joint, bool on) = 0;
  /// Returns the command that the drive follows now.
  virtual DriveInput drive(int machine) const = 0;

  /// Applies an impulse [N s] at p_W and an angular impulse about p_W [N m s] to a link. Velocities
  /// change at once, through the articulated inertia. Adds to `external_impulse`.
  virtual void apply_impulse(int machine, int link, const Vec3& J_W, const Vec3& L_W,
                             const Vec3& p_W) = 0;
  /// Applies an impulse that acted during the step of `dt` [s] just taken.
  ///
  /// A body without joints also moves by dt times its change of velocity, so that a body resting on
  /// soil does not sink by one step's weight in every step. The next step's contacts expect the
  /// mean of the last impulses, for bodies that rest on this one; `link` reports the velocity
  /// without that expectation.
  virtual void apply_impulse_of_step(int machine, int link, const Vec3& J_W, const Vec3& L_W,
                                     const Vec3& p_W, double dt) = 0;
  /// Applies a force [N] at p_W during the next step only.
  virtual void add_force(int machine, int link, const Vec3& f_W, const Vec3& p_W) = 0;

  /// Advances all machines by dt [s]: joints, hydraulics, tyre forces from `ground` and from
  /// bodies, contacts of collision shapes with the ground and with each other, contacts of shells
  /// with bodies.
  /// @throws SimulationError for a machine without a finite pose or deep below the ground.
  virtual void step(double dt, const GroundQuery& ground) = 0;

  /// Returns the state of a joint after the last step.
  virtual JointState joint(int machine, int joint) const = 0;
  /// Returns pose and velocity of a link after the last step.
  virtual LinkState link(int machine, int link) const = 0;
  /// Returns the state of a wheel after the last step, tyre force included.
  virtual WheelState wheel(int machine, int wheel) const = 0;
  /// Returns the inverse articulated mass at the link's origin, order (angular, linear), axes of W.
  /// Zero for a link that forces cannot move.
  virtual Mat6 inverse_mass(int machine, int link) const = 0;

  /// Visits all state between two steps; a loaded engine continues exactly as the saved one did.
  /// Loads only into an engine to which the same machines were added.
  /// @throws InputError for other machines, or for a machine without a finite pose.
  virtual void visit(Archive& a) = 0;

  // Optional capabilities. The returned interface lives as long as the engine; null where the
  // engine lacks the capability.
  /// Placement of bases.
  virtual PlacementCapability* placement() { return nullptr; }
  /// Collisions with machines of another engine.
  virtual ObstacleCapability* obstacles() { return nullptr; }
  /// Hitches between machines.
  virtual HitchCapability* hitches() { return nullptr; }
  /// Rock below the soil.
  virtual RockCapability* rock() { return nullptr; }
  /// Contact patches of crawler tracks.
  virtual const TrackCapability* tracks() const { return nullptr; }
  /// Pumps and combustion engines.
  virtual const PowerCapability* power() const { return nullptr; }
  /// Momentum and work.
  virtual const AccountCapability* accounts() const { return nullptr; }
};

/// Returns the target pose of a base, or its present pose where the engine cannot place bases.
BaseInput base_target(PhysicsEngine& engine, int machine);
/// Returns the engine's placement capability.
/// @throws InputError for an engine that moves machines by forces; the message names `machine`.
PlacementCapability& require_placement(PhysicsEngine& engine, int machine);
/// Returns the engine's hitch capability.
/// @throws InputError for an engine that cannot couple machines.
HitchCapability& require_hitches(PhysicsEngine& engine);

/// Returns the contact patches of a track in the last step; empty without a track or without the
/// capability.
std::vector<terramechanics::TrackPatch> track_patches(const PhysicsEngine& engine, int machine,
                                                      int wheel);

/// Makes the dynamic engine, built on Bullet. `gravity` is in W [m/s2]; contacts use `materials`
/// where both bodies have one. Knows another engine's machines only as obstacles.
std::unique_ptr<PhysicsEngine> make_bullet_engine(const Vec3& gravity,
                                                  const scene::Materials& materials = {});
/// Makes the kinematic engine: machines follow their commands exactly and no force moves them.
std::unique_ptr<PhysicsEngine> make_kinematic_engine();

}  // namespace navvy::vehicle
