// SPDX-License-Identifier: Apache-2.0
#include "control/dig_rig.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "control/dig_pose.h"

namespace navvy::control::testing {
namespace {

constexpr double kStep = 0.005;     // [s]
constexpr double kPourRate = 900;   // [kg/s]
constexpr double kHalfCut = 0.525;  // [m]
constexpr double kAlong = 0.03;     // points on the profile [m]
// Share of the capacity above which soil spills.
constexpr double kMouthful = 1.15;
constexpr double kSpillAhead = 0.3;  // [m]

class Plane final : public vehicle::GroundQuery {
 public:
  double height(double, double) const override { return 0; }
  Vec3 normal(double, double) const override { return Vec3::UnitZ(); }
};

double tip_angle(const Pose& X_WB) {
  const Vec3 x = X_WB.linear().col(0), upward = X_WB.linear().col(2);
  // Angle of the bucket's x axis above the horizontal; beyond the vertical the tip points towards
  // the cab.
  const double rise = std::asin(std::clamp(x.z(), -1.0, 1.0));
  return upward.z() >= 0 ? rise : -kPi - rise;
}

}  // namespace

Dig trench() {
  Dig dig;
  dig.from = Vec2(4.85, 0);
  dig.to = Vec2(1.65, 0);
  dig.depth = 0.8;
  dig.dump_at = Vec2(-1.7, 5.9);
  dig.dump_height = 1.6;
  return dig;
}

heightfield::Ground flat_ground(double cell, double cohesion) {
  heightfield::Ground::Setup setup;
  setup.nx = static_cast<int>(24 / cell);
  setup.ny = static_cast<int>(20 / cell);
  setup.cell = cell;
  setup.origin = Vec2(-12, -10);
  setup.datum = -4;
  scene::Soil loam;
  loam.name = "loam";
  loam.cohesion = cohesion;
  setup.soils = {loam};
  setup.layers = {{"loam", 10}};
  setup.surface = [](int, int) { return 0.0; };
  return heightfield::Ground(std::move(setup));
}

DigRig::DigRig(scene::Machine machine, scene::Program program, const Pose& X_WM,
               const Planners& planners)
    : ground(flat_ground()),
      engine(vehicle::make_kinematic_engine()),
      op(machine, program, "", planners),
      machine_(std::move(machine)),
      target_(machine_.joints.size()) {
  engine->add_machine(machine_, X_WM);
  const scene::Soil& soil = ground.setup().soils[0];
  capacity_ = kMouthful * machine_.buckets[0].capacity / soil.swell * soil.bank_density;
  for (std::size_t j = 0; j < target_.size(); ++j) target_[j] = machine_.joints[j].initial;
}

Observation DigRig::look() const {
  Observation seen;
  for (std::size_t j = 0; j < machine_.joints.size(); ++j) {
    seen.joints.push_back(engine->joint(0, static_cast<int>(j)));
    seen.joints.back().stalled = stalled_ && j > 0;
  }
  seen.X_WB = engine->link(0, 0).X_WL;
  if (time < settled_at) seen.X_WB.linear() = Mat3::Identity();
  seen.v_WB = engine->link(0, 0).v_WL;
  seen.ground = &ground;
  seen.force = felt;
  if (fills_bed) seen.load_of = [this](const std::string&) { return poured; };
  if (fills_bed)
    seen.load_centre_of = [this](const std::string&) {
      return lands_off && poured > 0 ? std::optional<Vec2>(moment_ / poured) : load_centre;
    };
  if (fills_bed)
    seen.bed_of = [this](const std::string&) {
      std::optional<BedView> out = bed;
      if (out) out->load = poured;
      return out;
    };
  if (!stones.empty())
    seen.bodies = [this] {
      std::vector<BodyView> out;
      for (const Stone& stone : stones) out.push_back(stone.body);
      return out;
    };
  seen.payload = payload_ + (op.phase() == "penetrate" || op.phase() == "drag" ? in_mouth : 0);
  return seen;
}

bool DigRig::against_rock(const Command& command) const {
  const Vec3 tip = engine->link(0, machine_.link_index("bucket")).X_WL * machine_.buckets[0].p_tip;
  const bool rock = tip.x() >= rock_from && tip.x() <= rock_to && tip.z() <= rock_top;
  // The slice is the uncut ground just ahead of the cutting edge, which moves towards the machine.
  const bool strong = ground.sample(tip.x() - 0.2, tip.y()) - tip.z() > thickest_slice;
  if (!rock && !strong) return false;
  // Upward motion is free, any other is blocked.
  const ArmKinematics arm(machine_);
  ArmAngles q;
  for (std::size_t i = 0; i < 3; ++i)
    q[i] = command.joints[static_cast<std::size_t>(arm.joints()[i])]->target;
  const Pose X_WS = engine->link(0, 0).X_WL * arm.X_BS();
  return X_WS.translation().z() + arm.forward(q).height < tip.z() + 0.02;
}

void DigRig::step() {
  const Observation seen = look();
  const Command command = op.update(seen, time, kStep);
  stalled_ = against_rock(command);
  hit_rock = hit_rock || stalled_;
  for (std::size_t j = 0; j < command.joints.size(); ++j) {
    if (!command.joints[j]) continue;
    const double jump =
        std::abs(command.joints[j]->target - target_[j]) / (machine_.joints[j].velocity * kStep);
    fastest_jump = std::max(fastest_jump, jump);
    target_[j] = command.joints[j]->target;
    vehicle::JointInput input = *command.joints[j];
    if (stalled_ && j > 0) input.target = seen.joints[j].position;
    engine->set_joint(0, static_cast<int>(j), input);
  }
  if (command.drive) engine->set_drive(0, *command.drive);
  note(op.event(), seen);
  engine->step(kStep, Plane());
  time += kStep;
  const Pose X_WB = engine->link(0, machine_.link_index("bucket")).X_WL;
  // The link's origin is the pin.
  const bool curled = std::exchange(curling_, op.phase() == "curl");
  if (!curled) pin_ = X_WB.translation().z();
  if (curling_ && !curled) steepest_curl = std::max(steepest_curl, tip_angle(X_WB));
  if (curling_) deepest_curl = std::max(deepest_curl, pin_ - X_WB.translation().z());
  sweep(X_WB);
  pour(X_WB);
  leak(X_WB);
  carry_stones(X_WB);
  if (carrying_) worst_tilt = std::max(worst_tilt, std::abs(tip_angle(X_WB) - kCarry));
}

bool DigRig::run(double limit) {
  while (!op.ended() && time < limit) step();
  return op.done();
}

void DigRig::note(CycleEvent event, const Observation& seen) {
  if (event == CycleEvent::kScoopStart) {
    cycles.push_back({});
    cycles.back().start = time;
  }
  if (cycles.empty()) return;
  Cycle& cycle = cycles.back();
  if (event == CycleEvent::kLiftOut) {
    cycle.lift_out = time;
    cycle.payload = seen.payload;
    carrying_ = true;
  } else if (event == CycleEvent::kDumpStart) {
    cycle.dump = time;
    cycle.spilt = cycle.payload - seen.payload;
    carrying_ = false;
  } else if (event == CycleEvent::kCycleEnd) {
    cycle.end = time;
  }
}

void DigRig::sweep(const Pose& X_WB) {
  const Pose X_BW = X_WB.inverse();
  const auto& v = machine_.shells[0].vertices;
  std::vector<heightfield::SoilLayer> taken;
  double surplus = 0;
  for (std::size_t k = 0; k + 1 < 9; ++k) {
    const int n = static_cast<int>(std::ceil((v[k + 1] - v[k]).norm() / kAlong));
    for (int i = 0; i < n; ++i)
      for (int t = -10; t <= 10; ++t) {
        Vec3 p = v[k] + (v[k + 1] - v[k]) * i / n;
        p.y() = t * kHalfCut / 10;
        const Vec3 p_W = X_WB * p;
        const Vec2i c = ground.column_at(p_W.x(), p_W.y());
        if (!ground.contains(c.x(), c.y()) || ground.height(c.x(), c.y()) <= p_W.z() + 1e-4)
          continue;
        // A column belongs to the cut when its centre does.
        const Vec2 center = ground.origin() + ground.cell() * Vec2(c.x() + 0.5, c.y() + 0.5);
        if (std::abs((X_BW * Vec3(center.x(), center.y(), p_W.z())).y()) > kHalfCut) continue;
        taken.clear();
        ground.take_above(c.x(), c.y(), p_W.z(), taken);
        for (const heightfield::SoilLayer& layer : taken) payload_ += kilograms(layer.mass);
      }
  }
  surplus = payload_ - capacity_;
  if (surplus <= 0) return;
  payload_ = capacity_;
  const Vec3 tip = X_WB * v[0];
  const Vec3 towards = engine->link(0, machine_.link_index("upper")).X_WL.translation() - tip;
  drop(tip.head<2>() + kSpillAhead * Vec2(towards.x(), towards.y()).normalized(), 0.25, surplus);
}

void DigRig::leak(const Pose& X_WB) {
  const bool before = std::exchange(lifting_, op.phase() == "lift");
  if (!lifting_) return;
  if (!before) lift_since = time;
  const double mass = std::min(payload_, leak_rate * kStep);
  if (time - lift_since > leak_time || mass <= 0) return;
  dry_since = time;
  payload_ -= mass;
  drop((X_WB * machine_.buckets[0].p_tip).head<2>(), 0.3, mass);
}

void DigRig::pour(const Pose& X_WB) {
  if (payload_ <= 0 || op.phase() != "dump" || tip_angle(X_WB) < -radians(110)) return;
  const double mass = std::min(payload_, kPourRate * kStep);
  payload_ -= mass;
  const Vec3 tip = X_WB * machine_.buckets[0].p_tip;
  if (poured == 0) moment_.setZero();
  poured += mass;
  if (lands_off) moment_ += mass * (tip.head<2>() + *lands_off);
  if (fills_bed) return;
  drop(tip.head<2>(), 0.7, mass);
}

void DigRig::carry_stones(const Pose& X_WB) {
  const bool scoops = op.phase() == "drag" || op.phase() == "curl";
  const bool open = op.phase() == "dump" && tip_angle(X_WB) > -radians(110);
  for (Stone& stone : stones) {
    const Vec3 p_B = X_WB.inverse() * stone.body.centre;
    // Behind the edge and between the sides of the bucket.
    if (scoops && !stone.slips && !stone.held && p_B.x() > 0.2 && p_B.x() < 1.3 &&
        std::abs(p_B.y()) < kHalfCut && std::abs(p_B.z()) < 0.6) {
      stone.held = true;
      stone.p_B = Vec3(0.6, p_B.y(), 0.3);
    }
    if (!stone.held) continue;
    stone.body.centre = X_WB * stone.p_B;
    if (!open) continue;
    stone.held = false;
    stone.body.centre.z() = 0.5 * stone.body.smallest;
  }
}

void DigRig::drop(const Vec2& around, double radius, double mass) {
  const int reach = static_cast<int>(radius / ground.cell());
  const Vec2i c = ground.column_at(around.x(), around.y());
  std::vector<Vec2i> columns;
  for (int y = -reach; y <= reach; ++y)
    for (int x = -reach; x <= reach; ++x)
      if (x * x + y * y <= reach * reach && ground.contains(c.x() + x, c.y() + y))
        columns.push_back({c.x() + x, c.y() + y});
  heightfield::SoilLayer layer;
  layer.specific_volume = static_cast<float>(ground.setup().soils[0].swell);
  layer.mass = mass_units(mass / static_cast<double>(columns.size()));
  for (const Vec2i& p : columns) ground.put(p.x(), p.y(), layer);
}

void DigRig::visit(Archive& a) {
  a("engine", *engine);
  a("operator", op);
  a("payload", payload_);
  a("time", time);
  a("target", target_);
  a("ground", ground);
}

TrenchMeasure measure(const heightfield::Ground& ground, const Dig& dig) {
  TrenchMeasure out;
  const Vec2 along = (dig.to - dig.from).normalized(), across(-along.y(), along.x());
  const double length = (dig.to - dig.from).norm(), cell = ground.cell(), area = cell * cell;
  const auto slices = static_cast<std::size_t>(std::lround(length / cell));
  std::vector<double> drop_sum(slices, 0), count(slices, 0), moment(slices, 0), removed(slices, 0);
  double inside_volume = 0, over = 0;
  for (int iy = 0; iy < ground.ny(); ++iy)
    for (int ix = 0; ix < ground.nx(); ++ix) {
      const double fall = ground.start_height(ix, iy) - ground.height(ix, iy);
      if (fall == 0) continue;
      const Vec2 p = ground.origin() + cell * Vec2(ix + 0.5, iy + 0.5) - dig.from;
      const double s = p.dot(along), t = p.dot(across);
      const bool inside = s >= 0 && s <= length && std::abs(t) <= 0.5 * dig.width;
      if (inside) inside_volume += area * std::clamp(fall, 0.0, dig.depth);
      if (inside) over += area * std::max(0.0, fall - dig.depth);
      if (!inside && s > -1.5 && s < length + 1.5 && std::abs(t) < 0.5 * dig.width + 1.5)
        over += area * std::max(0.0, fall);
      const auto k =
          static_cast<std::size_t>(std::clamp(s / cell, 0.0, static_cast<double>(slices) - 1));
      if (s < 0 || s > length || std::abs(t) > dig.width) continue;
      moment[k] += std::max(0.0, fall) * t;
      removed[k] += std::max(0.0, fall);
      if (std::abs(t) > 0.25 * dig.width) continue;
      drop_sum[k] += fall;
      count[k] += 1;
    }
  int good = 0;
  for (std::size_t k = 0; k < slices; ++k) {
    if (count[k] > 0 && std::abs(drop_sum[k] / count[k] - dig.depth) <= 0.10) ++good;
    if (count[k] > 0 && drop_sum[k] / count[k] > 0.5 * dig.depth)
      out.center_offset = std::max(out.center_offset, std::abs(moment[k] / removed[k]));
  }
  const double design = length * dig.width * dig.depth;
  out.removed = inside_volume;
  out.removed_share = inside_volume / design;
  out.overdug_share = over / design;
  out.floor_share = good / static_cast<double>(slices);
  return out;
}

}  // namespace navvy::control::testing
