// SPDX-License-Identifier: Apache-2.0
#include "session/program_check.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cstdio>
#include <memory>
#include <optional>
#include <utility>

#include "control/activity_step.h"
#include "control/reach.h"
#include "core/edit_distance.h"
#include "heightfield/design_surface.h"
#include "heightfield/make_ground.h"
#include "sim/occupied_areas.h"
#include "sim/start_placing.h"

namespace navvy::session {
namespace {

constexpr double kUnderTip = 0.05;  // clearance of a bed's rim below the opening bucket [m]

/// Returns the bounding box of a bed that is not tipped, in its machine's base frame [m].
Eigen::AlignedBox3d bed_box(const scene::Machine& machine, const scene::Bed& bed) {
  // Shells are in link frames; they are moved to the base link at zero joint positions.
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

/// Finds beds that are too high for the point where a dig dumps. A warning: which of its
/// stations a truck stands at when the bucket comes is known only in the run.
class BedCheck {
 public:
  BedCheck(const scene::Scene& world, const control::SurfaceView& surface,
           const std::vector<Pose>& X_WB)
      : world_(world), surface_(surface), X_WB_(X_WB) {}

  std::vector<Fault> faults;

  /// Checks every dig of this machine against the beds of all others.
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
    // Dump heights are measured from the ground under the dump point.
    const double ground = surface_.height(dump.at.x(), dump.at.y());
    // Height of the highest rim above that ground, over all stations of the truck: it may be loaded
    // at any of them.
    double rim = 0;
    for (const scene::Bed& bed : truck.machine.beds) {
      const Eigen::AlignedBox3d box = bed_box(truck.machine, bed);
      for (const Pose& X_WB :
           control::stations(truck.machine, truck.program, X_WB_.at(other), surface_)) {
        Vec3 p_B = X_WB.inverse() * Vec3(dump.at.x(), dump.at.y(), X_WB.translation().z());
        // Only beds that are under the dump point in plan view.
        p_B.z() = box.center().z();
        if (box.contains(p_B)) rim = std::max(rim, X_WB.translation().z() + box.max().z() - ground);
      }
    }
    if (rim <= 0 || rim + kUnderTip <= dump.height) return;
    // Programs from a file know the line of each step; those built in code do not.
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

/// Returns which bodies stay where they start, as far as is known before a run: all but the machine
/// itself, those with a program, kinematic ones, and those that hitches couple.
std::vector<char> staying_bodies(const scene::Scene& world, std::size_t machine) {
  std::vector<char> out = sim::all_bodies(world);
  for (std::size_t m = 0; m < world.machines.size(); ++m)
    if (m == machine || !world.machines[m].program.steps.empty() ||
        world.machines[m].machine.kinematic)
      out[m] = 0;
  for (const scene::Hitch& hitch : world.hitches)
    out.at(static_cast<std::size_t>(hitch.parent)) = out.at(static_cast<std::size_t>(hitch.child)) =
        0;
  return out;
}

/// Returns an error for each step whose receiver is no other machine with a bed.
std::vector<Fault> check_receivers(const scene::Scene& world, const scene::MachineInWorld& placed) {
  std::vector<std::string> known;
  for (const scene::MachineInWorld& other : world.machines)
    if (&other != &placed && !other.machine.beds.empty()) known.push_back(other.name);
  std::vector<Fault> faults;
  for (std::size_t i = 0; i < placed.program.steps.size(); ++i) {
    const std::string into = control::step_of(placed.program.steps[i]).receiver();
    if (into.empty() || std::find(known.begin(), known.end(), into) != known.end()) continue;
    const int line = i < placed.program.lines.size() ? placed.program.lines[i] : 0;
    faults.push_back({Fault::Severity::kError, world.file, line,
                      placed.name + "/navvy:program/step " + std::to_string(i + 1) + "/" +
                          placed.program.steps[i]->element() + "/into",
                      into, "must be the name of another machine with a bed in this world",
                      suggestion(into, known)});
  }
  return faults;
}

}  // namespace

std::vector<Fault> check_programs(const scene::Scene& world, const control::SurfaceView& surface,
                                  const std::vector<Pose>& X_WB, const control::Planners& planners,
                                  std::vector<std::string>* notes) {
  std::vector<Fault> faults;
  // Errors come first, warnings follow.
  for (std::size_t m = 0; m < world.machines.size(); ++m) {
    const scene::MachineInWorld& placed = world.machines[m];
    const control::OccupiedSurfaceView around(
        surface, std::make_shared<const std::vector<heightfield::OccupiedArea>>(
                     sim::occupied_areas(world, X_WB, staying_bodies(world, m))));
    for (Fault& fault : control::check_reach(placed.machine, placed.program, X_WB.at(m), around,
                                             world.file, placed.name, planners, notes))
      faults.push_back(std::move(fault));
    for (Fault& fault : check_receivers(world, placed)) faults.push_back(std::move(fault));
  }
  BedCheck beds(world, surface, X_WB);
  for (std::size_t m = 0; m < world.machines.size(); ++m) beds.look(m);
  for (Fault& fault : beds.faults) faults.push_back(std::move(fault));
  return faults;
}

/// Makes the ground as a run does. Before a run there is no loose soil, so columns are enough.
std::vector<Fault> check_programs(const scene::Scene& world, const control::Planners& planners,
                                  std::vector<std::string>* notes) {
  try {
    const heightfield::Ground ground = heightfield::make_ground(world, nullptr);
    sim::check_active(world, ground);
    heightfield::make_design(world, ground);
    return check_programs(world, control::GroundSurfaceView(ground),
                          sim::starting_poses(world, ground), planners, notes);
  } catch (const InputError& error) {
    // A ground that cannot be laid is itself the answer.
    return error.faults();
  }
}

}  // namespace navvy::session
