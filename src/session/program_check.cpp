// SPDX-License-Identifier: Apache-2.0
#include "session/program_check.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cstdio>
#include <optional>
#include <utility>

#include "control/program_step.h"
#include "control/reach.h"
#include "heightfield/design_surface.h"
#include "heightfield/make_ground.h"
#include "sim/start_placing.h"

namespace navvy::session {
namespace {

constexpr double kUnderTip = 0.05;  // room that a bed's rim needs below the opening bucket [m]

/// The box round a bed, untipped, in its machine's base frame [m].
Eigen::AlignedBox3d bed_box(const scene::Machine& machine, const scene::Bed& bed) {
  // Shells are in link frames: both go to the base link at zero joint positions.
  Eigen::AlignedBox3d out;
  const Pose X_BM = machine.links.at(0).X_ML.inverse();
  for (const scene::Shell& shell : machine.shells) {
    const int link = machine.link_index(shell.link);
    if (shell.name != bed.shell || link < 0) continue;
    for (const Vec3& v : shell.vertices)
      out.extend(X_BM * (machine.links[static_cast<std::size_t>(link)].X_ML * v));
  }
  return out;
}

/// Looks for beds that stand too high below the point where a dig dumps. A warning: which of its
/// stations a truck stands at when the bucket comes is known only in the run.
class BedCheck {
 public:
  BedCheck(const scene::Scene& world, const control::SurfaceView& surface,
           const std::vector<Pose>& X_WB)
      : world_(world), surface_(surface), X_WB_(X_WB) {}

  std::vector<Fault> faults;

  /// Every dig of this machine against the beds of all others.
  void look(std::size_t digger) {
    const scene::MachineInWorld& placed = world_.machines[digger];
    for (std::size_t i = 0; i < placed.program.steps.size(); ++i)
      if (const std::optional<control::DumpPoint> dump =
              control::step_of(placed.program.steps[i]).dump_point())
        for (std::size_t other = 0; other < world_.machines.size(); ++other)
          if (other != digger) look(placed, i, *dump, other);
  }

 private:
  void look(const scene::MachineInWorld& digger, std::size_t step, const control::DumpPoint& dump,
            std::size_t other) {
    const scene::MachineInWorld& truck = world_.machines[other];
    // Dump heights count from the ground under the dump point.
    const double ground = surface_.height(dump.at.x(), dump.at.y());
    double rim = 0;  // highest over the ground at the dump point, of all stations
    // Each place where the truck's program makes it stand, as any of them may be where it is
    // loaded.
    for (const scene::Bed& bed : truck.machine.beds) {
      const Eigen::AlignedBox3d box = bed_box(truck.machine, bed);
      for (const Pose& X_WB :
           control::stations(truck.machine, truck.program, X_WB_.at(other), surface_)) {
        Vec3 p_B = X_WB.inverse() * Vec3(dump.at.x(), dump.at.y(), X_WB.translation().z());
        p_B.z() = box.center().z();  // in plan
        // Only beds that stand under the dump point, seen from above.
        if (box.contains(p_B)) rim = std::max(rim, X_WB.translation().z() + box.max().z() - ground);
      }
    }
    if (rim <= 0 || rim + kUnderTip <= dump.height) return;
    // Programs read from a file know the line of every step; those built in code do not.
    const int line = step < digger.program.lines.size() ? digger.program.lines[step] : 0;
    faults.push_back(
        {Fault::Severity::kWarning, world_.file, line,
         digger.name + "/navvy:program/step " + std::to_string(step + 1) + "/" +
             digger.program.steps[step]->element() + "/dump_height",
         metres(dump.height), "the bed of '" + truck.name + "' is " + metres(rim) + " high there",
         "dump from " + metres(rim + kUnderTip) + " or higher, or the bucket strikes the bed"});
  }
  static std::string metres(double value) {
    std::array<char, 32> text{};
    std::snprintf(text.data(), text.size(), "%.2f m", value);
    return text.data();
  }

  const scene::Scene& world_;
  const control::SurfaceView& surface_;
  const std::vector<Pose>& X_WB_;
};

}  // namespace

std::vector<Fault> check_programs(const scene::Scene& world, const control::SurfaceView& surface,
                                  const std::vector<Pose>& X_WB,
                                  const control::MakePathPlanner& planners) {
  std::vector<Fault> faults;
  // Errors first: a dig out of reach is worse than one that drops its load too low.
  for (std::size_t m = 0; m < world.machines.size(); ++m) {
    const scene::MachineInWorld& placed = world.machines[m];
    for (Fault& fault : control::check_reach(placed.machine, placed.program, X_WB.at(m), surface,
                                             world.file, placed.name, planners))
      faults.push_back(std::move(fault));
  }
  BedCheck beds(world, surface, X_WB);
  for (std::size_t m = 0; m < world.machines.size(); ++m) beds.look(m);
  for (Fault& fault : beds.faults) faults.push_back(std::move(fault));
  return faults;
}

/// Lays the ground as a run would, but looks at columns alone: before a run no soil lies loose.
std::vector<Fault> check_programs(const scene::Scene& world,
                                  const control::MakePathPlanner& planners) {
  try {
    const heightfield::Ground ground = heightfield::make_ground(world, nullptr);
    sim::check_active(world, ground);
    heightfield::make_design(world, ground);
    return check_programs(world, control::GroundSurfaceView(ground),
                          sim::starting_poses(world, ground), planners);
  } catch (const InputError& error) {
    // A ground that cannot be laid is itself the answer.
    return error.faults();
  }
}

}  // namespace navvy::session
