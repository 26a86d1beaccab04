// SPDX-License-Identifier: Apache-2.0
// Exchange between machines, soil and ground, once per base step. No other module sees all three.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "core/archive.h"
#include "coupling/ground_view.h"
#include "coupling/ruts.h"
#include "coupling/track_ruts.h"
#include "heightfield/layered_ground.h"
#include "scene/scene.h"
#include "soil/solver.h"
#include "vehicle/physics_engine.h"

namespace navvy::coupling {

/// Load of the soil on one shell of one machine.
struct ToolLoad {
  int machine = -1, shell = -1, link = -1, tool = -1;
  /// Mean soil force over the last completed transfer [N].
  Vec3 force_W = Vec3::Zero();
  /// Moment about the link's origin [N m].
  Vec3 moment_W = Vec3::Zero();
  /// Force low-passed near v / (2 cell), for display and control [N].
  Vec3 smooth_W = Vec3::Zero();
  /// Force of the rock, low-passed in the same way [N].
  Vec3 rock_W = Vec3::Zero();
  /// Impulse of the last step, with its momentum balance.
  soil::ToolImpulse impulse;

  /// Visits the forces and the impulse of the last step.
  void visit(Archive& a);
};

/// Wall time spent so far, by module [s].
struct TimeShare {
  double vehicle = 0, soil = 0, ground = 0;
};

/// Steps physics engines and soil together.
///
/// The engine moves the machines to the end of the step. The soil answers, over the same interval,
/// with impulses that change the links' velocities at once, so the machine receives exactly what
/// the soil gives. Wheels and rigid bodies read the ground from the columns of the current step.
///
/// A step is: move obstacles, step both engines, step the soil with the tools' motion from the
/// start of the step, apply its impulses, and press ruts every kRutInterval steps.
class Coupling {
 public:
  /// Adds the machines to the two engines and every shell to the solver. The references must
  /// outlive this object.
  /// @throws InputError for a scene that asks for a capability its engine lacks.
  Coupling(const scene::Scene& world, vehicle::PhysicsEngine& engine,
           vehicle::PhysicsEngine& kinematic, soil::Solver& solver, heightfield::Ground& ground);

  /// Advances everything by dt [s].
  void step(double dt);

  /// Returns the loads of all shells, machine by machine and shell by shell.
  const std::vector<ToolLoad>& tools() const { return tools_; }
  /// Returns the wall time spent so far.
  const TimeShare& time_share() const { return time_share_; }
  /// Returns the soil carried by a tool [kg]. Soil in a bucket inside a bed counts for the bucket.
  double payload(const ToolLoad& tool) const;
  /// Returns 1 for each particle that a bucket or a bed holds, 0 for the others.
  std::vector<std::uint8_t> held(std::span<const soil::Particle> particles) const;
  /// Returns the engine that moves machine `m` of the world, or the machine's index in it.
  vehicle::PhysicsEngine& engine(int m) const {
    return *placed_[static_cast<std::size_t>(m)].engine;
  }
  int index(int m) const { return placed_[static_cast<std::size_t>(m)].index; }

  /// Visits the state that continues from step to step. Engines, soil and ground are visited by
  /// their owner, before this. @throws InputError for another scene's tools.
  void visit(Archive& a);

 private:
  /// Engine of a machine of the scene.
  struct PlacedMachine {
    vehicle::PhysicsEngine* engine = nullptr;  ///< one of the two given
    /// Index of the machine in that engine.
    int index = 0;
    /// Number of a kinematic machine among the dynamic engine's obstacles, -1 for others.
    int mover = -1;
  };
  /// Moves the dynamic engine's obstacles to the poses of the kinematic machines.
  void show_movers();
  /// Returns the support areas of wheels and tracks of dynamic machines.
  std::vector<soil::SupportArea> support_areas(double dt) const;
  /// Presses ruts of tyres and tracks, every kRutInterval steps.
  void press_ruts(double dt);
  /// Steps the soil with the tools' motion and applies its impulses to the links.
  void exchange_with_soil(double dt, const std::vector<Pose>& poses_before);

  const scene::Scene& world_;
  vehicle::PhysicsEngine& dynamic_;
  vehicle::PhysicsEngine& kinematic_;
  soil::Solver& solver_;
  heightfield::Ground& ground_;
  Ruts ruts_;
  TrackRuts track_ruts_;
  bool has_tracks_ = false;
  GroundView view_;
  std::vector<PlacedMachine> placed_;  ///< in the order of the scene's machines
  std::vector<ToolLoad> tools_;
  std::uint64_t steps_ = 0;
  TimeShare time_share_;
};

}  // namespace navvy::coupling
