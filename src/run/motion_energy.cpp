// SPDX-License-Identifier: Apache-2.0
#include "run/motion_energy.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "core/error.h"
#include "earthwork/pit_planner.h"
#include "planner/map_path_planner.h"
#include "record/earthwork.h"
#include "session/session.h"
#include "sim/world.h"

namespace navvy::run {
namespace {

/// Speed by which a joint that deviates returns to its path, over the deviation [1/s]: that of the
/// joints' own servos [docs/machines.md, hydraulics].
constexpr double kReturn = 20;

[[noreturn]] void refuse(const std::string& value, const std::string& rule,
                         const std::string& remedy) {
  throw InputError(Fault{Fault::Severity::kError, "", 0, "machine", value, rule, remedy});
}

/// Returns the index of the machine whose energy is compared.
int machine_index(const scene::Scene& scene, const std::string& name) {
  int found = -1, count = 0;
  for (int i = 0; i < static_cast<int>(scene.machines.size()); ++i) {
    const scene::MachineInWorld& one = scene.machines[static_cast<std::size_t>(i)];
    const bool digs = !one.machine.kinematic && !one.machine.buckets.empty();
    if (!name.empty() && one.name != name) continue;
    if (!name.empty() && !digs)
      refuse(name, "a machine that forces move, with a navvy:bucket",
             "choose a dynamic machine with a bucket");
    if (!digs) continue;
    found = i;
    ++count;
  }
  if (count == 0)
    refuse(name.empty() ? "none" : name, "a dynamic machine of the scene with a navvy:bucket",
           "add one, or correct its name");
  if (count > 1) refuse("several", "one machine with a bucket", "name one of them");
  return found;
}

/// Returns true if a machine may dig: it has a program, and a tool that is no bed.
bool may_dig(const scene::MachineInWorld& one) {
  const auto is_tool = [&](const scene::Shell& shell) {
    const auto holds = [&](const scene::Bed& bed) { return bed.shell == shell.name; };
    return std::none_of(one.machine.beds.begin(), one.machine.beds.end(), holds);
  };
  return !one.program.steps.empty() &&
         std::any_of(one.machine.shells.begin(), one.machine.shells.end(), is_tool);
}

/// Refuses other machines that may dig: what they dig would count as work of this one.
void require_one_digs(const scene::Scene& scene, int machine) {
  for (int i = 0; i < static_cast<int>(scene.machines.size()); ++i) {
    const scene::MachineInWorld& other = scene.machines[static_cast<std::size_t>(i)];
    if (i != machine && may_dig(other))
      refuse(other.name,
             "several machines with a tool and a program: the mass that the site loses is shared "
             "out to none of them",
             "remove the navvy:program of all but '" +
                 scene.machines[static_cast<std::size_t>(machine)].name + "'");
  }
}

/// Returns the indices of the joints whose motion is repeated.
std::vector<int> repeated_joints(const scene::Machine& machine) {
  std::vector<int> out;
  for (int j = 0; j < static_cast<int>(machine.joints.size()); ++j) {
    const std::string& name = machine.joints[static_cast<std::size_t>(j)].name;
    const auto is_ours = [&](const auto& part) { return part.joint == name; };
    const scene::Arm& arm = machine.arm;
    if (name == arm.swing || name == arm.boom || name == arm.stick || name == arm.bucket ||
        std::any_of(machine.cylinders.begin(), machine.cylinders.end(), is_ours) ||
        std::any_of(machine.beds.begin(), machine.beds.end(), is_ours))
      out.push_back(j);
  }
  return out;
}

/// Repeated joint of a machine after one step.
struct JointMoment {
  double position = 0, velocity = 0;  ///< [rad|m], [rad/s|m/s]
  bool braked = false;                ///< true while its brake is set
};

/// State of a machine after one step, from which its motion is repeated.
struct Moment {
  std::vector<JointMoment> joints;  ///< those of repeated_joints, in its order
  vehicle::DriveInput drive;
};

/// Handles of the joints of all machines whose motion is repeated, by machine; none for kinematic
/// machines. Found once, as names are compared.
std::vector<std::vector<sim::JointHandle>> repeated_handles(const sim::World& world) {
  std::vector<std::vector<sim::JointHandle>> out(
      static_cast<std::size_t>(world.machines().count()));
  for (int m = 0; m < world.machines().count(); ++m) {
    const sim::MachineHandle machine = world.machines().at(m);
    if (machine.description().kinematic) continue;
    for (const int j : repeated_joints(machine.description()))
      out[static_cast<std::size_t>(m)].push_back(machine.joint(j));
  }
  return out;
}

/// Adds up the energy of one machine and follows the edge of its bucket.
class Meter {
 public:
  /// @param bucket of the machine as the scene describes it, which the second run lacks
  Meter(const sim::MachineHandle& machine, const std::vector<int>& joints,
        const scene::Bucket& bucket)
      : machine_(machine),
        work_(joints.size(), 0),
        speeds_(joints.size(), 0),
        edge_(bucket.p_tip),
        link_(machine.description().link_index(bucket.link)) {
    for (const int joint : joints) joints_.push_back(machine.joint(joint));
  }

  /// Reads the machine after a step of `dt` [s].
  void read(double dt) {
    for (std::size_t k = 0; k < joints_.size(); ++k) {
      const vehicle::JointState state = joints_[k].state();
      work_[k] += std::max(0.0, state.effort * 0.5 * (speeds_[k] + state.velocity) * dt);
      speeds_[k] = state.velocity;
    }
    const vehicle::PumpState pump = machine_.pump();
    pump_ += pump.flow * pump.pressure * dt;
    path_.push_back(machine_.link(0).pose().inverse() * (machine_.link(link_).pose() * edge_));
  }

  MotionEnergy energy() const { return {machine_.work(), pump_}; }
  const std::vector<double>& work() const { return work_; }
  const std::vector<Vec3>& path() const { return path_; }

 private:
  sim::MachineHandle machine_;
  std::vector<sim::JointHandle> joints_;
  std::vector<double> work_, speeds_;
  Vec3 edge_;
  int link_;
  double pump_ = 0;
  std::vector<Vec3> path_;
};

/// Motion of all dynamic machines of a run, step by step.
using Motion = std::vector<std::vector<Moment>>;  // by step, then by machine

/// Reads the state of all machines that forces move; others have an empty one.
std::vector<Moment> moments(const sim::World& world,
                            const std::vector<std::vector<sim::JointHandle>>& joints) {
  std::vector<Moment> out(joints.size());
  for (std::size_t m = 0; m < joints.size(); ++m) {
    const sim::MachineHandle machine = world.machines().at(static_cast<int>(m));
    if (machine.description().kinematic) continue;
    for (const sim::JointHandle& joint : joints[m]) {
      const vehicle::JointState state = joint.state();
      out[m].joints.push_back({state.position, state.velocity, state.braked});
    }
    out[m].drive = machine.drive();
  }
  return out;
}

/// Commands all machines to where they were at the end of the step to come.
void command(sim::World& world, const std::vector<std::vector<sim::JointHandle>>& joints,
             const std::vector<Moment>& before, const std::vector<Moment>& target) {
  sim::MachineCommands commands = world.commands();
  for (std::size_t m = 0; m < joints.size(); ++m) {
    const sim::MachineHandle machine = world.machines().at(static_cast<int>(m));
    if (machine.description().kinematic) continue;
    if (machine.description().has_drive) commands.set(machine, target[m].drive);
    for (std::size_t k = 0; k < joints[m].size(); ++k) {
      const sim::JointHandle& joint = joints[m][k];
      const JointMoment &start = before[m].joints[k], &end = target[m].joints[k];
      if (end.braked != start.braked) commands.set_brake(joint, end.braked);
      // By speeds: a command of a position would brake before each of them.
      const double off = start.position - joint.position();
      commands.set(joint, {vehicle::JointMode::kVelocity, end.velocity + kReturn * off});
    }
  }
}

/// Removes what touches soil and the programs: the motion alone remains.
scene::Scene without_soil(scene::Scene scene) {
  for (scene::MachineInWorld& one : scene.machines) {
    one.program = {};
    one.load = {};
    one.machine.buckets.clear();
    one.machine.beds.clear();
    one.machine.shells.clear();
  }
  return scene;
}

/// What is compared.
struct Subject {
  int machine = 0;
  const scene::Bucket* bucket = nullptr;
  std::vector<int> joints;
};

/// Fills in how the motion with soil ended, by the order of EndReason.
void note_end(const session::Session& session, EnergyComparison& out) {
  out.end.time = session.world().time();
  if (session.forbidden()) {
    out.end.reason = EndReason::kForbidden;
    out.end.cause = session.forbidden()->text();
  } else if (session.complete()) {
    out.end.reason = EndReason::kComplete;
  } else {
    out.end.reason = session.fell_short() ? EndReason::kFellShort : EndReason::kOutOfTime;
  }
  const auto& machines = session.world().description().machines;
  for (const session::ProgramReport& report : session.programs())
    if (report.last().state != control::StepState::kDone)
      out.unfinished.push_back(session::report_line(
          report, machines[static_cast<std::size_t>(report.machine)].name, "the motion ended"));
}

/// Runs the scene and fills in its results; `path` receives that of the edge.
Motion run_with_soil(const scene::Scene& scene, const Subject& subject, device::Device& device,
                     const std::function<void(double)>& progress, EnergyComparison& out,
                     std::vector<Vec3>& path) {
  session::Session session(scene, device,
                           control::Planners{planner::path_planners(), earthwork::job_planners()});
  Meter meter(session.world().machines().at(subject.machine), subject.joints, *subject.bucket);
  const auto joints = repeated_handles(session.world());
  Motion motion = {moments(session.world(), joints)};
  while (!session.done()) {
    session.step();
    meter.read(session.world().dt());
    motion.push_back(moments(session.world(), joints));
    if (progress) progress(0.5 * session.world().time() / scene.recording.duration);
  }
  note_end(session, out);
  out.duration = session.world().time();
  for (const record::SoilMoved& soil : record::measure_earthwork(session.world()).soils)
    out.moved += soil.dug;
  for (const session::Cycle& cycle : session.cycles())
    out.cycles += cycle.machine == subject.machine;
  out.with_soil = meter.energy();
  for (std::size_t k = 0; k < subject.joints.size(); ++k) out.joints[k].with_soil = meter.work()[k];
  path = meter.path();
  return motion;
}

/// Repeats the motion without soil and fills in its results.
void run_without_soil(const scene::Scene& scene, const Subject& subject, device::Device& device,
                      const Motion& motion, const std::vector<Vec3>& path,
                      const std::function<void(double)>& progress, EnergyComparison& out) {
  sim::World world(without_soil(scene), device);
  Meter meter(world.machines().at(subject.machine), subject.joints, *subject.bucket);
  const auto joints = repeated_handles(world);
  double sum = 0;
  for (std::size_t step = 1; step < motion.size(); ++step) {
    command(world, joints, motion[step - 1], motion[step]);
    world.step();
    meter.read(world.dt());
    const double apart = (meter.path().back() - path[step - 1]).norm();
    sum += apart * apart;
    out.path_largest = std::max(out.path_largest, apart);
    const double share = static_cast<double>(step) / static_cast<double>(motion.size() - 1);
    if (progress) progress(0.5 + 0.5 * share);
  }
  if (motion.size() > 1) out.path_rms = std::sqrt(sum / static_cast<double>(motion.size() - 1));
  out.without_soil = meter.energy();
  for (std::size_t k = 0; k < subject.joints.size(); ++k)
    out.joints[k].without_soil = meter.work()[k];
}

}  // namespace

EnergyComparison compare_motion_energy(const scene::Scene& scene, const std::string& machine,
                                       device::Device& device,
                                       const std::function<void(double)>& progress) {
  Subject subject;
  subject.machine = machine_index(scene, machine);
  require_one_digs(scene, subject.machine);
  const scene::MachineInWorld& placed = scene.machines[static_cast<std::size_t>(subject.machine)];
  subject.bucket = &placed.machine.buckets.front();
  subject.joints = repeated_joints(placed.machine);
  EnergyComparison out;
  out.machine = placed.name;
  for (const int joint : subject.joints)
    out.joints.push_back({placed.machine.joints[static_cast<std::size_t>(joint)].name, 0, 0});
  std::vector<Vec3> path;
  const Motion motion = run_with_soil(scene, subject, device, progress, out, path);
  run_without_soil(scene, subject, device, motion, path, progress, out);
  return out;
}

}  // namespace navvy::run
