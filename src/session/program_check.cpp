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
#include "session/bed_box.h"
#include "session/loose_bodies.h"
#include "sim/occupied_areas.h"
#include "sim/start_placing.h"

namespace navvy::session {
namespace {

constexpr double kUnderTip = 0.05;  // clearance of a bed's rim below the opening bucket [m]

/// Returns the bounding box of a bed that is not tipped, in its machine's base frame [m].
Eigen::AlignedBox3d lowered_bed(const scene::Machine& machine, const scene::Bed& bed) {
  // Shells are in link frames; they are moved to the base link at zero joint positions.
  const int link = machine.link_index(bed.link);
  if (link < 0) return {};
  const Pose X_BM = machine.links.at(0).X_ML.inverse();
  return bed_box(machine, bed, X_BM * machine.links[static_cast<std::size_t>(link)].X_ML);
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
      const Eigen::AlignedBox3d box = lowered_bed(truck.machine, bed);
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

/// Checks of the steps of one machine's program that name something in the world.
class NameCheck {
 public:
  /// `file` contains the program; it is empty for one that was ordered.
  NameCheck(const scene::Scene& world, std::size_t machine, const scene::Program& program,
            std::string file)
      : world_(world), machine_(machine), program_(program), file_(std::move(file)) {}

  /// Returns an error for each step whose receiver is no other machine with a bed.
  std::vector<Fault> receivers() const {
    std::vector<Fault> faults;
    const std::vector<std::string> known =
        others([](const scene::MachineInWorld& one) { return !one.machine.beds.empty(); });
    for (std::size_t i = 0; i < program_.steps.size(); ++i)
      for (const std::string& into : control::step_of(program_.steps[i]).receivers())
        require(i, "into", into, known,
                "must be the name of another machine with a bed in this world", faults);
    return faults;
  }
  /// Returns an error for each step that waits for no other machine, or opens no hitch of this one.
  std::vector<Fault> waits_and_hitches() const {
    std::vector<Fault> faults;
    const std::vector<std::string> known =
        others([](const scene::MachineInWorld&) { return true; });
    std::vector<std::string> hitches;
    for (const scene::Hitch& one : world_.hitches)
      if (one.parent == static_cast<int>(machine_) || one.child == static_cast<int>(machine_))
        hitches.push_back(one.name);
    for (std::size_t i = 0; i < program_.steps.size(); ++i) {
      if (const std::optional<scene::Waiting> wait = program_.steps[i]->waits_for())
        require(i, "machine", wait->machine, known, "must be the name of another machine", faults);
      if (const std::optional<std::string> hitch = program_.steps[i]->opens())
        require(i, "hitch", *hitch, hitches, "must be the name of a hitch of this machine", faults);
    }
    return faults;
  }

 private:
  std::vector<std::string> others(bool (*wanted)(const scene::MachineInWorld&)) const {
    std::vector<std::string> out;
    for (std::size_t m = 0; m < world_.machines.size(); ++m)
      if (m != machine_ && wanted(world_.machines[m])) out.push_back(world_.machines[m].name);
    return out;
  }
  /// Adds a fault if a step names something that is not known.
  void require(std::size_t i, const std::string& element, const std::string& name,
               const std::vector<std::string>& known, const std::string& rule,
               std::vector<Fault>& faults) const {
    if (std::find(known.begin(), known.end(), name) != known.end()) return;
    const int line = i < program_.lines.size() ? program_.lines[i] : 0;
    faults.push_back({Fault::Severity::kError, file_, line,
                      world_.machines[machine_].name + "/navvy:program/step " +
                          std::to_string(i + 1) + "/" + program_.steps[i]->element() + "/" +
                          element,
                      name, rule, suggestion(name, known)});
  }

  const scene::Scene& world_;
  const std::size_t machine_;
  const scene::Program& program_;
  const std::string file_;
};

}  // namespace

std::vector<Fault> check_programs(const scene::Scene& world, const control::SurfaceView& surface,
                                  const std::vector<Pose>& X_WB, const control::Planners& planners,
                                  std::vector<std::string>* notes) {
  std::vector<Fault> faults;
  const std::vector<control::BodyView> bodies = LooseBodies(world).at(X_WB);
  // Errors come first, warnings follow.
  for (std::size_t m = 0; m < world.machines.size(); ++m) {
    const scene::MachineInWorld& placed = world.machines[m];
    const control::OccupiedSurfaceView around(
        surface, std::make_shared<const std::vector<heightfield::OccupiedArea>>(
                     sim::occupied_areas(world, X_WB, staying_bodies(world, m))));
    for (Fault& fault : control::check_reach(placed.machine, placed.program, X_WB.at(m), around,
                                             world.file, placed.name, planners, notes, bodies))
      faults.push_back(std::move(fault));
    for (Fault& fault : NameCheck(world, m, placed.program, world.file).receivers())
      faults.push_back(std::move(fault));
  }
  BedCheck beds(world, surface, X_WB);
  for (std::size_t m = 0; m < world.machines.size(); ++m) beds.look(m);
  for (Fault& fault : beds.faults) faults.push_back(std::move(fault));
  return faults;
}

std::vector<Fault> check_program(const scene::Scene& world, std::size_t machine,
                                 const scene::Program& program, const control::SurfaceView& surface,
                                 const std::vector<Pose>& X_WB, const control::Planners& planners) {
  const scene::MachineInWorld& placed = world.machines.at(machine);
  std::vector<Fault> faults =
      control::check_reach(placed.machine, program, X_WB.at(machine), surface, "order", placed.name,
                           planners, nullptr, LooseBodies(world).at(X_WB));
  const NameCheck names(world, machine, program, "order");
  for (const std::vector<Fault>& each : {names.receivers(), names.waits_and_hitches()})
    faults.insert(faults.end(), each.begin(), each.end());
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
