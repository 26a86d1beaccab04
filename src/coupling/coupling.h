// SPDX-License-Identifier: Apache-2.0
// Exchange of motion, forces and ground heights between machines, soil and ground, once per base
// step. Only this module depends on all three.
#pragma once

#include <cstdint>
#include <functional>
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

/// Force of the soil on one shell (a body such as a bucket or blade that moves soil) of one
/// machine.
struct ToolLoad {
  /// `machine` is the index of the machine in the scene, `shell` and `link` are the indices of the
  /// shell and of its link in the machine, and `tool` is the index of the shell in the soil solver;
  /// -1 if not set.
  int machine = -1, shell = -1, link = -1, tool = -1;
  /// Mean soil force over the last completed transfer of momentum, in W [N].
  Vec3 force_W = Vec3::Zero();
  /// Mean soil moment about the origin of the link over the same time, in W [N m].
  Vec3 moment_W = Vec3::Zero();
  /// Part of force_W that acts on the edges of the shell's plates [N].
  Vec3 edge_force_W = Vec3::Zero();
  /// Low-pass filtered soil force in W [N], for display and control. The cutoff frequency is 3 Hz.
  Vec3 smooth_W = Vec3::Zero();
  /// Low-pass filtered force of the rock below the soil, in W [N]. The cutoff frequency is 3 Hz.
  Vec3 rock_W = Vec3::Zero();
  /// Impulse of the last step and its momentum balance.
  soil::ToolImpulse impulse;

  /// Saves or loads the forces and the impulse. The scene determines the indices.
  void visit(Archive& a);
};

/// Wall time spent so far in each module [s].
struct TimeShare {
  /// Time in the physics engines (`vehicle`), in the soil solver (`soil`), and for pressing ruts
  /// (`ground`) [s].
  double vehicle = 0, soil = 0, ground = 0;
};

/// Advances physics engines and soil together.
///
/// In each base step, the engines first move the machines to the end of the step. The soil solver
/// then computes the impulses between tools and soil over the same interval. These impulses are
/// applied to the links immediately, so that machines receive exactly the momentum that the soil
/// loses. Wheels and rigid bodies use the ground heights at the start of the step.
///
/// The order in a step is:
/// 1. Move the obstacles, which represent the kinematic machines, to their current poses.
/// 2. Advance both physics engines.
/// 3. Advance the soil with the tools' motion over the step, and apply the impulses to the links.
/// 4. In every kRutInterval-th step, press ruts into the ground.
class Coupling {
 public:
  /// Adds all machines of the scene to one of the two engines: kinematic machines to `kinematic`,
  /// all others to `engine`. Adds every shell to the solver as a tool. The references must outlive
  /// this object. @throws InputError if the scene needs a capability that its engine does not have.
  Coupling(const scene::Scene& world, vehicle::PhysicsEngine& engine,
           vehicle::PhysicsEngine& kinematic, soil::Solver& solver, heightfield::Ground& ground);

  /// Advances machines, soil and ground by one base step of `dt` [s].
  void step(double dt);

  /// Returns the loads of all shells, ordered by machine and then by shell.
  const std::vector<ToolLoad>& tools() const { return tools_; }
  /// Returns the wall time spent so far in each module.
  const TimeShare& time_share() const { return time_share_; }
  /// Returns the mass of the soil carried by a bucket or bed [kg]. Soil in a bucket that is inside
  /// a bed counts for the bucket only.
  double payload(const ToolLoad& tool) const;
  /// Returns a function that returns true for a point in W [m] if a bucket or a bed, at its present
  /// pose, holds soil there. It must not outlive this object.
  std::function<bool(const Vec3&)> holding() const;
  /// Returns the engine that moves the machine with the index `m` in the scene.
  vehicle::PhysicsEngine& engine(int m) const {
    return *placed_[static_cast<std::size_t>(m)].engine;
  }
  /// Returns the index within its engine of the machine with the index `m` in the scene.
  int index(int m) const { return placed_[static_cast<std::size_t>(m)].index; }

  /// Saves or loads the state of the coupling itself: step count, tool loads and ruts. The owner
  /// must visit engines, soil and ground before. @throws InputError if the number of tools does not
  /// match the scene.
  void visit(Archive& a);

 private:
  // A machine of the scene and the engine that moves it.
  struct PlacedMachine {
    // One of the two engines.
    vehicle::PhysicsEngine* engine = nullptr;
    // Index of the machine in that engine.
    int index = 0;
    // Index among the dynamic engine's obstacles if the machine is kinematic; -1 for other
    // machines.
    int mover = -1;
  };
  // Returns the buckets and beds at their present poses. Blades hold no soil.
  std::vector<soil::PlacedTool> containers() const;
  // Moves the dynamic engine's obstacles to the current poses of the kinematic machines.
  void show_movers();
  // Returns the areas of ground that support wheels and tracks of dynamic machines; `dt` [s] is the
  // base step.
  std::vector<soil::SupportArea> support_areas(double dt) const;
  // Presses ruts of tyres and tracks for the next kRutInterval steps of `dt` [s].
  void press_ruts(double dt);
  // Advances the soil by `dt` [s] and applies the impulses to the links. `poses_before` contains
  // the pose of each tool's link in W at the start of the step.
  void exchange_with_soil(double dt, const std::vector<Pose>& poses_before);

  // The simulated scene.
  const scene::Scene& world_;
  // Engine of all machines that are not kinematic.
  vehicle::PhysicsEngine& dynamic_;
  // Engine of all kinematic machines.
  vehicle::PhysicsEngine& kinematic_;
  // Soil solver, in which every shell is a tool.
  soil::Solver& solver_;
  // Ground into which ruts are pressed.
  heightfield::Ground& ground_;
  // Ruts of tyres.
  Ruts ruts_;
  // Ruts of tracks; they share the load history in `ruts_`.
  TrackRuts track_ruts_;
  // True if any machine of the scene has a track.
  bool has_tracks_ = false;
  // The ground as machines read it.
  GroundView view_;
  // All machines, in the order of the scene.
  std::vector<PlacedMachine> placed_;
  // Loads of all shells, ordered by machine and then by shell.
  std::vector<ToolLoad> tools_;
  // Number of steps taken.
  std::uint64_t steps_ = 0;
  // Wall time spent so far.
  TimeShare time_share_;
};

}  // namespace navvy::coupling
