// SPDX-License-Identifier: Apache-2.0
// The exchange between machines, soil and ground, once per base step. Alone sees all three.
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

/// What soil does to one shell of one machine.
struct ToolLoad {
  int machine = -1, shell = -1, link = -1, tool = -1;
  Vec3 force_W = Vec3::Zero();   ///< mean of the last transfer that ended [N]
  Vec3 moment_W = Vec3::Zero();  ///< about the link's origin [N m]
  /// Force low-passed near v / (2 cell), for display and control [N].
  Vec3 smooth_W = Vec3::Zero();
  Vec3 rock_W = Vec3::Zero();  ///< force of the rock on it, low-passed likewise [N]
  soil::ToolImpulse impulse;   ///< of the last step, with the momentum proof

  void visit(Archive& a);
};

/// Wall time spent so far, by module [s].
struct TimeShare {
  double vehicle = 0, soil = 0, ground = 0;
};

/// Steps engine and soil together.
///
/// The engine moves the machine to the end of the step; soil answers, over the same interval, with
/// impulses that change the links' velocities at once, so what soil gives is what the machine
/// takes. Ground under wheels and rigid bodies is read from the columns of this very step.
class Coupling {
 public:
  /// The references must outlive it. Registers every shell of every dynamic or kinematic machine
  /// with the solver.
  Coupling(const scene::Scene& world, vehicle::PhysicsEngine& engine,
           vehicle::PhysicsEngine& kinematic, soil::Solver& solver, heightfield::Ground& ground);

  /// Advances everything by dt [s].
  void step(double dt);

  const std::vector<ToolLoad>& tools() const { return tools_; }
  const TimeShare& time_share() const { return time_share_; }
  /// Soil carried by a tool [kg]; what a bucket holds inside a bed is the bucket's.
  double payload(const ToolLoad& tool) const;
  /// By particle, whether a bucket or a bed holds it: 1 or 0.
  std::vector<std::uint8_t> held(std::span<const soil::Particle> particles) const;
  /// The engine that moves machine `m` of the world, and its index there.
  vehicle::PhysicsEngine& engine(int m) const {
    return *placed_[static_cast<std::size_t>(m)].engine;
  }
  int index(int m) const { return placed_[static_cast<std::size_t>(m)].index; }

  /// All that goes on from step to step here; engines, soil and ground are visited by their owner,
  /// before this.
  /// @throws InputError for another scene's tools.
  void visit(Archive& a);

 private:
  /// Where a machine of the scene is moved.
  struct PlacedMachine {
    vehicle::PhysicsEngine* engine = nullptr;  ///< one of the two given
    int index = 0;                             ///< of the machine in that engine
    /// Its number in the dynamic engine of what another one moves.
    int mover = -1;
  };
  /// Tells the dynamic engine where kinematic machines are.
  void show_movers();
  /// Wheels and belts of machines with masses, which bear on the ground.
  std::vector<soil::SupportArea> support_areas(double dt) const;
  void press_ruts(double dt);
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
  std::vector<PlacedMachine> placed_;  ///< as in the scene's machines
  std::vector<ToolLoad> tools_;
  std::uint64_t steps_ = 0;
  TimeShare time_share_;
};

}  // namespace navvy::coupling
