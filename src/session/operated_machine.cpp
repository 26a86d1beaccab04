// SPDX-License-Identifier: Apache-2.0
#include "session/operated_machine.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "core/log.h"
#include "session/bed_box.h"
#include "session/loose_bodies.h"
#include "session/uncontrolled_machine.h"
#include "sim/occupied_areas.h"
#include "sim/read_particles.h"
#include "sim/world_terrain.h"

namespace navvy::session {
namespace {

/// Steps between two measurements of a bucket's payload, which changes slowly and costs a pass over
/// the particles.
constexpr std::uint64_t kPayloadInterval = 12;

const scene::MachineInWorld& placed(const sim::World& world, int machine) {
  return world.description().machines[static_cast<std::size_t>(machine)];
}

/// Returns the mass of the soil in the beds of the machine of this name [kg].
double load_of(const sim::World& world, const std::string& name) {
  double sum = 0;
  for (const sim::ToolHandle& tool : world.machines().tools())
    if (tool.is_bed() && world.machines().at(tool.machine()).name() == name) sum += tool.payload();
  return sum;
}

/// Bounding box of a bed in the frame of its link L [m], and that link.
struct PlacedBed {
  Eigen::AlignedBox3d box_L;
  sim::LinkHandle link;
};

/// Returns the first bed of the machine of this name; nothing if it has none or is unknown.
std::optional<PlacedBed> first_bed(const sim::World& world, const std::string& name) {
  for (const sim::ToolHandle& tool : world.machines().tools()) {
    const sim::MachineHandle machine = world.machines().at(tool.machine());
    if (!tool.is_bed() || machine.name() != name) continue;
    const scene::Bed& bed = machine.description().beds.front();
    return PlacedBed{bed_box(machine.description(), bed, Pose::Identity()), machine.link(bed.link)};
  }
  return std::nullopt;
}

/// Returns the first bed of the machine of this name as the operator of another one sees it;
/// nothing if it has none or is unknown.
std::optional<control::BedView> bed_of(const sim::World& world, const std::string& name) {
  const std::optional<PlacedBed> bed = first_bed(world, name);
  if (!bed) return std::nullopt;
  const Pose X_WL = bed->link.pose();
  const Vec3 half = 0.5 * bed->box_L.sizes(), middle = X_WL * bed->box_L.center();
  const Vec3 along = half.x() >= half.y() ? Vec3(half.x(), 0, 0) : Vec3(0, half.y(), 0);
  control::BedView out;
  out.middle = middle.head<2>();
  out.to_end = (X_WL.linear() * along).head<2>();
  out.rim = middle.z() + (X_WL.linear().row(2).cwiseAbs() * half).value();
  out.speed = bed->link.velocity().norm();
  out.load = load_of(world, name);
  return out;
}

/// Height above the rim to which a heap in a bed may reach [m].
constexpr double kHeapedTo = 1.5;

/// Returns the centre of mass of the soil in the first bed of the machine of this name, in W [m];
/// nothing without a bed or soil in it.
std::optional<Vec2> load_centre_of(const sim::World& world, const std::string& name) {
  std::optional<PlacedBed> bed = first_bed(world, name);
  if (!bed) return std::nullopt;
  bed->box_L.max().z() += kHeapedTo;
  const Pose X_LW = bed->link.pose().inverse();
  const scene::ParticleTable table = sim::read_particles(world);
  double mass = 0;
  Vec2 sum = Vec2::Zero();
  for (std::size_t i = 0; i < table.count(); ++i) {
    const Vec3 p_W(table.position[3 * i], table.position[3 * i + 1], table.position[3 * i + 2]);
    if (!bed->box_L.contains(Vec3(X_LW * p_W))) continue;
    mass += table.mass[i];
    sum += table.mass[i] * p_W.head<2>();
  }
  if (mass <= 0) return std::nullopt;
  return Vec2(sum / mass);
}

}  // namespace

const heightfield::Terrain& SeenSurface::terrain() const {
  if (!view_ || seen_step_ != world_.steps()) {
    view_ = sim::terrain_view(world_, heightfield::SurfaceKind::kWithLooseSoil);
    seen_step_ = world_.steps();
  }
  return *view_;
}

heightfield::TerrainView SeenSurface::mapped() const {
  return sim::terrain_view(world_, heightfield::SurfaceKind::kMapped);
}

heightfield::TerrainView SurfaceAroundMachine::mapped() const {
  return surface_.mapped().with(std::make_shared<const std::vector<heightfield::OccupiedArea>>(
      sim::occupied_areas(world_, sim::bodies_around(world_, machine_))));
}

OperatedMachine::OperatedMachine(sim::World& world, int machine, const SeenSurface& surface,
                                 const Programs& programs, const control::Planners& planners)
    : world_(world),
      planners_(planners),
      machine_(world.machines().at(machine)),
      op_(make_operator(placed(world, machine).program)) {
  const scene::Machine& description = machine_.description();
  // A machine digs with its first bucket and tips its first bed. Others are passive.
  if (!description.buckets.empty()) bucket_.emplace(machine_, description.buckets[0]);
  if (!description.beds.empty()) bed_ = machine_.tool(description.beds[0].shell);
  for (std::size_t j = 0; j < description.joints.size(); ++j)
    joints_.push_back(machine_.joint(static_cast<int>(j)));
  for (std::size_t w = 0; w < description.wheels.size(); ++w)
    wheels_.push_back(machine_.wheel(static_cast<int>(w)));
  // Sized once, so that observing allocates no memory.
  seen_.joints.resize(joints_.size());
  seen_.ground = &world.ground();
  around_ = std::make_unique<const SurfaceAroundMachine>(surface, world, machine);
  seen_.surface = around_.get();
  seen_.programs = &programs;
  connect_gauges();
}

control::Operator OperatedMachine::make_operator(const scene::Program& program) const {
  return {machine_.description(), program, machine_.name(), planners_};
}

/// Gives the operator what a cab shows on demand. Handles are copied, as this object may move.
void OperatedMachine::connect_gauges() {
  if (bucket_) seen_.bucket_load = [bucket = bucket_->tool()] { return bucket.payload(); };
  if (bed_) seen_.bed_load = [bed = *bed_] { return bed.payload(); };
  const sim::World& world = world_;
  seen_.load_of = [&world](const std::string& name) { return load_of(world, name); };
  seen_.bed_of = [&world](const std::string& name) { return bed_of(world, name); };
  seen_.load_centre_of = [&world](const std::string& name) { return load_centre_of(world, name); };
  seen_.bodies = [&world, bodies = LooseBodies(world.description())] { return bodies.in(world); };
  seen_.is_hitched = [&world](const std::string& name) {
    const std::vector<scene::Hitch>& hitches = world.description().hitches;
    for (std::size_t h = 0; h < hitches.size(); ++h)
      if (hitches[h].name == name) return world.machines().hitch(static_cast<int>(h)).closed;
    return false;
  };
  seen_.is_coupled = [&world, machine = index()] { return is_coupled(world, machine); };
}

void OperatedMachine::step(std::vector<Cycle>& cycles, std::vector<BedTip>& tips) {
  if (taken_) return;
  const bool well = !op_.ended() || op_.done();
  observe(seen_);
  // Operators have no clock of their own.
  send(op_.update(seen_, world_.time(), world_.dt()));
  note_cycle(cycles);
  note_tip(tips);
  // Logged at once: the end of a run may be hours away.
  if (well && op_.ended() && !op_.done()) log_warning(report_line(report(), name()));
}

/// Fills what a cab shows: joint positions, stance, the force on the bucket, and its payload.
void OperatedMachine::observe(control::Observation& seen) const {
  for (std::size_t j = 0; j < joints_.size(); ++j) seen.joints[j] = joints_[j].state();
  observe_stance(world_, machine_, wheels_, seen);
  // Without a bucket there is no load to show.
  if (!bucket_) return;
  // The low-passed force, as an operator does not react to single particles.
  seen.force = bucket_->tool().smooth_force().norm();
  if (world_.steps() % kPayloadInterval == 0) seen.payload = bucket_->tool().payload();
}

/// Forwards the commands that changed. A joint without a new command keeps its last one.
void OperatedMachine::send(const control::Command& command) {
  for (std::size_t j = 0; j < command.joints.size(); ++j)
    if (command.joints[j]) world_.commands().set(joints_[j], *command.joints[j]);
  if (command.drive) world_.commands().set(machine_, *command.drive);
  if (!command.unhitch) return;
  const std::vector<scene::Hitch>& hitches = world_.description().hitches;
  for (std::size_t h = 0; h < hitches.size(); ++h)
    if (hitches[h].name == *command.unhitch)
      world_.commands().set_hitch(static_cast<int>(h), false);
}

/// Measures masses at the moment of the event, so soil that falls off before does not count as
/// tipped.
void OperatedMachine::note_tip(std::vector<BedTip>& tips) {
  if (!bed_) return;
  // An event is reported only in the step in which it happens.
  const control::CycleEvent event = op_.event();
  if (event == control::CycleEvent::kTipStart)
    open_tip_ = BedTip{index(), world_.time(), 0, bed_->payload(), 0};
  if (event != control::CycleEvent::kTipEnd || !open_tip_) return;
  open_tip_->end = world_.time();
  open_tip_->payload_end = bed_->payload();
  tips.push_back(*open_tip_);
  open_tip_.reset();
}

/// A cycle is open from the first touch to the end of the dump. One that never ends does not count.
void OperatedMachine::note_cycle(std::vector<Cycle>& cycles) {
  using control::CycleEvent;
  const CycleEvent event = op_.event();
  if (event == CycleEvent::kScoopStart) {
    open_ = Cycle{};
    open_->machine = index();
    open_->start = world_.time();
    open_->place = machine_.link(0).pose().translation().head<2>();
  }
  if (!open_ || !bucket_) return;
  // A cylinder is loaded by the low-passed force, not by impacts of single particles.
  const BucketLoad load = bucket_->load();
  open_->force_peak = std::max(open_->force_peak, load.whole);
  open_->draft_peak = std::max(open_->draft_peak, load.draft);
  if (event == CycleEvent::kCurlStart) open_->curl = world_.time();
  if (open_->curl > 0) open_->uplift_peak = std::max(open_->uplift_peak, load.uplift);
  if (event == CycleEvent::kLiftOut) {
    open_->lift_out = world_.time();
    open_->payload_lift_out = bucket_->tool().payload();
  } else if (event == CycleEvent::kDumpStart) {
    open_->dump_start = world_.time();
    open_->payload_dump = bucket_->tool().payload();
  } else if (event == CycleEvent::kCycleEnd) {
    open_->end = world_.time();
    cycles.push_back(*open_);
    open_.reset();
  }
}

bool OperatedMachine::take() {
  // Until an order, as a program that went on later would find its machine somewhere else.
  if (std::exchange(taken_, true)) return false;
  // Joints that the program never commanded keep their command.
  send(op_.stop());
  // A cycle that was cut short has no end to report.
  open_.reset();
  open_tip_.reset();
  return true;
}

control::Command OperatedMachine::stand() const {
  const scene::Machine& machine = machine_.description();
  control::Command out;
  out.joints.resize(machine.joints.size());
  for (const std::string& name :
       {machine.arm.swing, machine.arm.boom, machine.arm.stick, machine.arm.bucket})
    if (const int joint = machine.joint_index(name); joint >= 0)
      out.joints[static_cast<std::size_t>(joint)] =
          vehicle::JointInput{vehicle::JointMode::kVelocity, 0};
  if (machine.has_drive) out.drive = vehicle::DriveInput{0, 0, true};
  return out;
}

control::ProgramProgress OperatedMachine::progress() const {
  control::ProgramProgress out = op_.progress();
  const auto done = static_cast<int>(
      std::count_if(reports_before_.begin(), reports_before_.end(),
                    [](const auto& one) { return one.state == control::StepState::kDone; }));
  out.done += done;
  out.steps += done;
  return out;
}

void OperatedMachine::order(const std::string& steps, const scene::Program& program) {
  control::Operator next = make_operator(program);
  ProgramReport before = report();
  if (busy())
    send(op_.stop());
  else if (taken_ || op_.progress().steps == 0)
    send(stand());
  if (!before.list.empty() && before.last().state == control::StepState::kRunning) {
    before.list.back().state = control::StepState::kReplaced;
    before.list.back().reason = "another program was ordered";
  }
  // The program of a machine without one has a report of no step.
  std::erase_if(before.list, [](const control::StepReport& one) { return one.step == 0; });
  reports_before_ = std::move(before.list);
  paths_before_ = std::move(before.paths);
  op_ = std::move(next);
  steps_ = steps;
  ++orders_;
  taken_ = false;
  open_.reset();
  open_tip_.reset();
}

ProgramReport OperatedMachine::report() const {
  ProgramReport out;
  out.machine = index();
  out.steps = op_.progress().steps;
  out.orders = static_cast<int>(orders_);
  out.taken = taken_;
  out.list = reports_before_;
  out.list.insert(out.list.end(), op_.reports().begin(), op_.reports().end());
  out.paths = paths_before_;
  out.paths.insert(out.paths.end(), op_.paths().begin(), op_.paths().end());
  // The last report of a program that has ended is complete.
  if (op_.ended()) return out;
  // The stored observation is a step old, and empty after a snapshot was loaded.
  control::Observation now = seen_;
  observe(now);
  out.list.push_back(op_.present(now, world_.time()));
  return out;
}

void OperatedMachine::visit(Archive& a) {
  // Of the observation only the payload is older than a step.
  a("payload", seen_.payload);
  a("open_cycle", open_);
  a("open_tip", open_tip_);
  // Readers of reports use the index of the machine without a check.
  const auto own = [&](const auto& open) { return !open || open->machine == machine_.index(); };
  a.require(own(open_), "open_cycle", "refers to another machine");
  a.require(own(open_tip_), "open_tip", "refers to another machine");
  // The operator's state no longer changes while inputs drive its machine.
  a("taken", taken_);
  visit_orders(a);
  a("operator", op_);
}

void OperatedMachine::visit_orders(Archive& a) {
  std::int64_t orders = orders_;
  a.unhashed("states of runs without orders keep their hashes", [&] { a("orders", orders); });
  a.require(orders >= 0, "orders", "is negative");
  std::string steps = steps_;
  if (orders > 0) {
    a("ordered", steps);
    a("reports_before", reports_before_);
    a("paths_before", paths_before_);
  }
  if (!a.loading()) return;
  if (orders == 0) {
    steps.clear();
    reports_before_.clear();
    paths_before_.clear();
  }
  // Every operator loads its state into a new one.
  if (steps != steps_) {
    a.require(planners_.read_program || orders == 0, "ordered",
              "no program can be ordered here, but the snapshot holds one");
    op_ = make_operator(orders == 0 ? placed(world_, index()).program
                                    : planners_.read_program(steps, machine_.description(),
                                                             world_.description().ground));
  }
  steps_ = std::move(steps);
  orders_ = orders;
}

}  // namespace navvy::session
