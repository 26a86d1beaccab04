// SPDX-License-Identifier: Apache-2.0
// One engine interface for machines: Bullet (dynamics) and kinematic (positions as commanded)
// implement it.
#pragma once

#include <cstdint>
#include <memory>
#include <vector>

#include "core/archive.h"
#include "core/math.h"
#include "scene/hitch.h"
#include "scene/machine.h"
#include "terramechanics/ground_query.h"
#include "terramechanics/track.h"
#include "vehicle/machine_state.h"

namespace navvy::vehicle {

/// What is under a wheel or body, answered by whoever owns the ground (coupling: the heightfield;
/// tests: a plane).
using terramechanics::GroundQuery;

/// Machines of one world, stepped together.
///
/// Machine, link, joint and wheel indices are those of scene::Machine. Not thread-safe.
class PhysicsEngine {
 public:
  virtual ~PhysicsEngine() = default;

  /// @throws InputError for what this engine cannot build.
  virtual int add_machine(const scene::Machine& machine, const Pose& X_WM) = 0;
  virtual int machine_count() const = 0;

  /// Until commanded, a joint holds its initial position (wheels of a machine without a drive and
  /// ball joints turn freely). A wheel's or steering joint taken by set_joint is the drive's again
  /// with the next set_drive.
  virtual void set_joint(int machine, int joint, const JointInput& input) = 0;
  virtual void set_drive(int machine, const DriveInput& input) = 0;
  /// Puts the brake of a joint on or off, whatever the joint is told meanwhile: it holds the joint
  /// where it stands by scene::Joint::brake at most. Nothing to a joint without a brake.
  virtual void set_brake(int machine, int joint, bool on) = 0;
  /// The command the drive follows now.
  virtual DriveInput drive(int machine) const = 0;

  /// Moves a base that no forces move. @throws InputError from an engine with forces.
  virtual void set_base(int machine, const BaseInput& input);
  /// The place it is on its way to, or where it is as long as nothing was told.
  virtual BaseInput base(int machine) const;

  /// A machine that another engine moves: what this one moves is pushed by its collision shapes and
  /// shells, and does not push back. Nothing to an engine without contacts.
  /// @return its number among them. @throws InputError for what this engine cannot build.
  virtual int add_mover(const scene::Machine& machine);
  /// Where its links are at the start of the next step and how they move, by link; told before
  /// every step.
  virtual void move(int mover, const std::vector<LinkState>& links);

  /// Couples two of this engine's machines, given by their indices in it, where the hitch has those
  /// of a scene. What is hitched does not collide with each other. @return its number. @throws
  /// InputError from an engine without forces.
  virtual int add_hitch(const scene::Hitch& hitch, int parent, int child);
  /// Lets go, or takes the eye up. @throws InputError for an eye beyond the hook's reach.
  virtual void set_hitch(int hitch, bool closed);
  virtual HitchState hitch(int hitch) const;

  /// Impulse [N s] and angular impulse about p_W [N m s] on a link, now: velocities change at once
  /// through the articulated inertia. Counted in `external_impulse`.
  virtual void apply_impulse(int machine, int link, const Vec3& J_W, const Vec3& L_W,
                             const Vec3& p_W) = 0;
  /// The same, of the step of `dt` [s] that was taken last: the place of a body without joints
  /// changes by dt times the change of its velocity, too, so that what stands on soil does not fall
  /// by the weight of a step in every step. The next step's contacts expect the mean of the last
  /// ones, so that what rests on such a body does not fall with it; `link` tells a velocity without
  /// it.
  virtual void apply_impulse_of_step(int machine, int link, const Vec3& J_W, const Vec3& L_W,
                                     const Vec3& p_W, double dt) = 0;
  /// Force [N] at p_W during the next step only.
  virtual void add_force(int machine, int link, const Vec3& f_W, const Vec3& p_W) = 0;

  /// Advances by dt [s]: joints, hydraulics, tyre forces from `ground` and from bodies, contacts of
  /// collision shapes with the ground (at full resolution, wherever they are) and with each other,
  /// of shells with bodies.
  /// @throws SimulationError for a machine that is nowhere, or deep below the ground.
  virtual void step(double dt, const GroundQuery& ground) = 0;
  /// Height [m] of the level rock that no shell of a machine with masses goes into; far below until
  /// told.
  virtual void set_rock(double height) { (void)height; }

  virtual JointState joint(int machine, int joint) const = 0;
  virtual LinkState link(int machine, int link) const = 0;
  virtual WheelState wheel(int machine, int wheel) const = 0;
  /// Where the belt of a track pressed on the ground in the last step; none of a wheel without one,
  /// and from engines without forces.
  virtual std::vector<terramechanics::TrackPatch> track_patches(int machine, int wheel) const {
    (void)machine, (void)wheel;
    return {};
  }
  /// Zeros for a machine without a pump, and from engines that have none.
  virtual PumpState pump(int machine) const {
    (void)machine;
    return {};
  }
  /// Zeros for a drive that neither has gears nor shares an engine with the pump, and from engines
  /// without forces.
  virtual CombustionEngineState drive_engine(int machine) const {
    (void)machine;
    return {};
  }
  /// Inverse articulated mass at the link's origin, order (angular, linear), axes of W.
  virtual Mat6 inverse_mass(int machine, int link) const = 0;
  /// Total momentum of a machine [N s], and mechanical work done by its joints and drive since the
  /// start [J].
  virtual Vec3 momentum(int machine) const = 0;
  virtual double work(int machine) const = 0;
  /// Sum of ground impulses (tyres, contacts, rock) on a machine in the last step [N s].
  virtual Vec3 ground_impulse(int machine) const = 0;
  /// Impulse of the rock on a shell in the last step [N s].
  virtual Vec3 rock_impulse(int machine, int shell) const {
    (void)machine, (void)shell;
    return Vec3::Zero();
  }
  /// Sum of all impulses of apply_impulse and add_force on a machine since the start [N s].
  virtual Vec3 external_impulse(int machine) const {
    (void)machine;
    return Vec3::Zero();
  }

  /// All state between two steps; a loaded engine steps on as the saved one did. Machines must have
  /// been added alike, and whoever owns the ground tells the rock again: it is not the engine's.
  /// @throws InputError for another number or make of machines, or one whose place is not finite.
  virtual void visit(Archive& a) = 0;
};

/// Dynamics under gravity [m/s2, W], contacts by `materials` where both bodies have one; and
/// positions as commanded, without forces. Neither knows the other's machines but by add_mover.
std::unique_ptr<PhysicsEngine> make_bullet_engine(const Vec3& gravity,
                                                  const scene::Materials& materials = {});
std::unique_ptr<PhysicsEngine> make_kinematic_engine();

}  // namespace navvy::vehicle
