// SPDX-License-Identifier: Apache-2.0
// Interface of the physics engines that move machines. Two implementations are in this module: the
// Bullet engine (dynamic machines) and the kinematic engine (machines follow their commands). An
// engine outside the tree must pass the tests in tests/vehicle/engine_contract.h.
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

/// Read access to the ground under wheels and bodies. The ground's owner implements it: the
/// `coupling` module with its columns, tests with a plane.
using terramechanics::GroundQuery;

/// Steps all machines of one world together.
///
/// The functions below are the core that every engine implements; the capabilities at the end are
/// optional. Indices of links, joints and wheels are those of scene::Machine; poses, velocities and
/// forces are in the world frame. An engine is not thread-safe.
///
/// The `coupling` module adds all machines before the first step. Then it calls an engine in this
/// order in every base step: commands (set_joint, set_drive, set_brake), step(), reads of states
/// and inverse masses for the soil, and apply_impulse_of_step() with the soil's reaction. Reads
/// must be cheap, since they occur several times per link and step. The result of a step must
/// depend only on the visited state and the commands, so that a run continued from a snapshot is
/// bit-identical.
class PhysicsEngine {
 public:
  /// Destroys the engine and all its machines.
  virtual ~PhysicsEngine() = default;

  /// Adds a machine, with its model frame M at the pose `X_WM`, and returns its index in this
  /// engine.
  /// @throws InputError for a machine that this engine cannot build.
  virtual int add_machine(const scene::Machine& machine, const Pose& X_WM) = 0;
  /// Returns the number of machines added so far.
  virtual int machine_count() const = 0;

  /// Sets the command of a joint, which holds until it is replaced.
  ///
  /// A joint that has never been commanded holds its initial position. Exceptions are ball joints,
  /// and the wheels of a machine without a drive, which turn freely. If the drive controls the
  /// joint (a wheel or steering joint), this command overrides the drive until the next
  /// set_drive().
  virtual void set_joint(int machine, int joint, const JointInput& input) = 0;
  /// Sets the command of a machine's drive, which holds until it is replaced. Wheels and steering
  /// joints that set_joint() has overridden follow the drive again.
  virtual void set_drive(int machine, const DriveInput& input) = 0;
  /// Sets or releases the brake of a joint. A set brake holds the joint in place with an effort of
  /// at most scene::Joint::brake [N m|N], whatever the joint's command is. Does nothing for a joint
  /// without a brake.
  virtual void set_brake(int machine, int joint, bool on) = 0;
  /// Returns the command that the machine's drive currently follows.
  virtual DriveInput drive(int machine) const = 0;

  /// Applies an impulse `J_W` [N s] at the point `p_W` [m] and an angular impulse `L_W` about that
  /// point [N m s] to a link. Velocities of the whole machine change at once, according to its
  /// articulated inertia. The impulse is added to AccountCapability::external_impulse().
  virtual void apply_impulse(int machine, int link, const Vec3& J_W, const Vec3& L_W,
                             const Vec3& p_W) = 0;
  /// Applies an impulse that acted during the step of `dt` [s] that has just been computed. The
  /// parameters are those of apply_impulse().
  ///
  /// For a machine of one link without joints, this also changes the position by `dt` times the
  /// change of velocity. Otherwise such a body, resting on soil, would sink by the effect of its
  /// weight in every step. In the next step, the contacts of other bodies that rest on it assume a
  /// support equal to the mean of the recent impulses; link() reports the velocity without this
  /// assumed support.
  virtual void apply_impulse_of_step(int machine, int link, const Vec3& J_W, const Vec3& L_W,
                                     const Vec3& p_W, double dt) = 0;
  /// Adds a force `f_W` [N] at the point `p_W` [m] on a link, which acts during the next step only.
  virtual void add_force(int machine, int link, const Vec3& f_W, const Vec3& p_W) = 0;

  /// Advances all machines by `dt` [s]: joints, hydraulics, forces on tyres and tracks from
  /// `ground` and from bodies, contacts of collision shapes with the ground and with each other,
  /// and contacts of shells (steel plates of tools) with bodies.
  /// @throws SimulationError for a machine without a finite pose or deep below the ground.
  virtual void step(double dt, const GroundQuery& ground) = 0;

  /// Returns the state of a joint after the last step.
  virtual JointState joint(int machine, int joint) const = 0;
  /// Returns pose and velocity of a link after the last step.
  virtual LinkState link(int machine, int link) const = 0;
  /// Returns the state of a wheel or track after the last step, including its ground force.
  virtual WheelState wheel(int machine, int wheel) const = 0;
  /// Returns the inverse of a link's articulated mass at the link's origin, in the order (angular,
  /// linear) and world axes. Returns zero for a link that forces cannot move.
  virtual Mat6 inverse_mass(int machine, int link) const = 0;

  /// Saves, loads or hashes all state between two steps. An engine loaded from an archive continues
  /// exactly as the saved one. Precondition for loading: the same machines have been added.
  /// @throws InputError for an archive of other machines, or for a machine without a finite pose.
  virtual void visit(Archive& a) = 0;

  /// Returns the capability to place base links at given poses, or null.
  ///
  /// This function and the six below return optional capabilities. A returned interface is valid as
  /// long as the engine; null means that the engine lacks the capability.
  virtual PlacementCapability* placement() { return nullptr; }
  /// Returns the capability to collide with machines that another engine moves, or null.
  virtual ObstacleCapability* obstacles() { return nullptr; }
  /// Returns the capability to couple machines by hitches, or null.
  virtual HitchCapability* hitches() { return nullptr; }
  /// Returns the capability to stop shells at rock below the soil, or null.
  virtual RockCapability* rock() { return nullptr; }
  /// Returns the capability to report the contact patches of crawler tracks, or null.
  virtual const TrackCapability* tracks() const { return nullptr; }
  /// Returns the capability to report pumps and combustion engines, or null.
  virtual const PowerCapability* power() const { return nullptr; }
  /// Returns the capability to report momentum and work, or null.
  virtual const AccountCapability* accounts() const { return nullptr; }
};

/// Returns the pose to which the machine's base link moves. If the engine cannot place base links,
/// this is the base link's current pose.
BaseInput base_target(PhysicsEngine& engine, int machine);
/// Returns the engine's capability to place base links.
/// @throws InputError for an engine that moves machines by forces; the message contains the index
/// `machine`.
PlacementCapability& require_placement(PhysicsEngine& engine, int machine);
/// Returns the engine's capability to couple machines by hitches.
/// @throws InputError for an engine that cannot couple machines.
HitchCapability& require_hitches(PhysicsEngine& engine);

/// Returns the rectangles on which the track of a wheel pressed in the last step. The result is
/// empty for a wheel without a track and for an engine without TrackCapability.
std::vector<terramechanics::TrackPatch> track_patches(const PhysicsEngine& engine, int machine,
                                                      int wheel);

/// Makes the engine for dynamic machines, built on the Bullet library. `gravity` is in the world
/// frame [m/s2]. `materials` gives the properties of contacts between two bodies that both have a
/// material. Machines of another engine take part only as obstacles (ObstacleCapability).
std::unique_ptr<PhysicsEngine> make_bullet_engine(const Vec3& gravity,
                                                  const scene::Materials& materials = {});
/// Makes the kinematic engine, whose machines follow their commands at limited rates and are not
/// affected by forces.
std::unique_ptr<PhysicsEngine> make_kinematic_engine();

}  // namespace navvy::vehicle
