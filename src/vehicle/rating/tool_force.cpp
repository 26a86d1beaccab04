// SPDX-License-Identifier: Apache-2.0
#include "vehicle/rating/tool_force.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "vehicle/rating/machine_at_rest.h"
#include "vehicle/stability.h"

namespace navvy::vehicle {
namespace {

constexpr double kNever = std::numeric_limits<double>::infinity();
/// Joint without a limit of its own.
constexpr double kUnlimited = 1e9;
/// Samples of a joint's range: of the working joint alone, and of three joints together.
constexpr int kFine = 2000, kCoarse = 30;
/// Points of a curve.
constexpr int kCurve = 40;

Fault fault_of(const scene::Machine& machine, const std::string& element, const std::string& value,
               const std::string& rule, const std::string& remedy) {
  return {Fault::Severity::kError, machine.file, 0, element, value, rule, remedy};
}

/// Evaluates tool forces of one machine at any position of its arm.
class Bench {
 public:
  Bench(const scene::Machine& machine, ToolForceKind kind)
      : rest_(machine), arm_(arm_joints(machine)), bucket_(*arm_bucket(machine)) {
    works_ = kind == ToolForceKind::kBreakout ? arm_.bucket : arm_.stick;
    if (arm_.swing >= 0) rest_.set(arm_.swing, 0);
    friction_ = kNever;
    for (const scene::Wheel& wheel : machine.wheels)
      friction_ = std::min(friction_, wheel.friction);
    // Wheels without a drive have no brake.
    if (machine.has_drive) brake_ = scene::powertrain(machine.drive).brake_force;
  }

  int works() const { return works_; }
  const ArmJoints& arm() const { return arm_; }
  double lower(int joint) const { return about(joint).has_limits ? about(joint).lower : -kPi; }
  double upper(int joint) const { return about(joint).has_limits ? about(joint).upper : kPi; }

  /// Returns sample `i` of `n` + 1 over the range of a joint.
  double sample(int joint, int i, int n) const {
    return lower(joint) + (upper(joint) - lower(joint)) * i / n;
  }

  RatedToolForce at(double boom, double stick, double bucket) {
    rest_.set(arm_.boom, boom);
    rest_.set(arm_.stick, stick);
    rest_.set(arm_.bucket, bucket);
    rest_.place();
    RatedToolForce out;
    out.boom = rest_.position(arm_.boom);
    out.stick = rest_.position(arm_.stick);
    out.bucket = rest_.position(arm_.bucket);
    const Vec3 edge = this->edge();
    out.reach = edge.x() - rest_.origin(arm_.swing >= 0 ? arm_.swing : arm_.boom).x();
    out.height = edge.z() - rest_.ground();
    const Vec3 along =
        digging_sense(rest_, bucket_, works_) * rest_.axis(works_).cross(edge - pivot());
    out.radius = along.norm();
    // An edge on the pivot has no lever and no direction.
    if (!(out.radius > 1e-6)) return out;
    const Vec3 direction = along / out.radius;
    set_hydraulic(out, edge, direction);
    if (rest_.is_anchored()) return out;
    const double weight = kGravity * rest_.mass();
    out.tipping = tipping_factor(rest_.support_points(), rest_.ground(), rest_.centre().head<2>(),
                                 weight, edge, -direction);
    out.slipping = slipping(direction, weight);
    return out;
  }
  RatedToolForce at(const std::array<double, 3>& q) { return at(q[0], q[1], q[2]); }

  /// Returns the force of the working circuit alone at the same positions.
  double own(const std::array<double, 3>& q) {
    rest_.set(arm_.boom, q[0]);
    rest_.set(arm_.stick, q[1]);
    rest_.set(arm_.bucket, q[2]);
    rest_.place();
    const double radius = rest_.axis(works_).cross(edge() - pivot()).norm();
    const bool positive = digging_sense(rest_, bucket_, works_) > 0;
    return radius > 1e-6 ? rest_.effort_limit(works_, positive) / radius : 0;
  }

  /// Returns true if the edge is outside the support polygon, where soil can be dug.
  bool is_clear() const {
    return rest_.is_anchored() || support_margin(rest_.support_points(), edge().head<2>()) <= 0;
  }

 private:
  const scene::Joint& about(int joint) const {
    return rest_.machine().joints[static_cast<std::size_t>(joint)];
  }
  Vec3 edge() const { return rest_.link(about(arm_.bucket).child) * bucket_.p_tip; }
  Vec3 pivot() const { return rest_.origin(works_); }

  /// Finds the circuit that first reaches its relief pressure, of the working joint or of one that
  /// holds against the ground's reaction.
  void set_hydraulic(RatedToolForce& out, const Vec3& edge, const Vec3& direction) const {
    out.hydraulic = kNever;
    for (const int joint : {works_, arm_.boom, arm_.stick, arm_.bucket}) {
      const double effort = rest_.force_effort(joint, edge, -direction);
      if (effort == 0) continue;
      const double most = rest_.effort_limit(joint, effort > 0) / std::abs(effort);
      if (joint == works_) out.working = most;
      if (most >= out.hydraulic) continue;
      out.hydraulic = most;
      out.circuit = rest_.circuit(joint);
    }
  }

  /// Returns the force in `direction` at which the wheels slip on the ground or in their brakes.
  double slipping(const Vec3& direction, double weight) const {
    const double level = direction.head<2>().norm();
    // The reaction's vertical part adds to the weight.
    const double grip = level - friction_ * direction.z();
    const double ground = grip > 0 ? friction_ * weight / grip : kNever;
    const double brakes = level > 0 ? brake_ / level : kNever;
    return std::min(ground, brakes);
  }

  MachineAtRest rest_;
  ArmJoints arm_;
  const scene::Bucket& bucket_;
  int works_ = -1;
  double friction_ = 0, brake_ = 0;
};

using Position = std::array<double, 3>;  // boom, stick, bucket [rad]

/// Returns the position of the working joint, `joint` in `q`, at which its circuit has the largest
/// force.
double best_of_joint(Bench& bench, Position q, std::size_t joint) {
  double best = 0, most = -1;
  for (int i = 0; i <= kFine; ++i) {
    q[joint] = bench.sample(bench.works(), i, kFine);
    const double force = bench.own(q);
    if (force > most) most = force, best = q[joint];
  }
  return best;
}

/// Positions that a search covers, and the index of the working joint in a Position.
struct Grid {
  std::array<std::vector<double>, 3> values;
  std::size_t works = 0;
};

Grid grid_of(Bench& bench, const Position& start, ToolForceKind kind) {
  const bool breakout = kind == ToolForceKind::kBreakout;
  Grid out;
  out.works = breakout ? 2 : 1;
  const std::array<int, 3> joints = {bench.arm().boom, bench.arm().stick, bench.arm().bucket};
  for (std::size_t k = 0; k < 3; ++k)
    for (int i = 0; i <= kCoarse; ++i) out.values[k].push_back(bench.sample(joints[k], i, kCoarse));
  if (!breakout) out.values[2] = {start[2]};
  out.values[out.works].push_back(best_of_joint(bench, start, out.works));
  return out;
}

/// Calls `each` for all positions of a grid with one position of the working joint.
template <typename Each>
void over_others(const Grid& grid, double works, const Each& each) {
  std::array<std::vector<double>, 3> values = grid.values;
  values[grid.works] = {works};
  for (const double boom : values[0])
    for (const double stick : values[1])
      for (const double bucket : values[2]) each(Position{boom, stick, bucket});
}

/// Order of positions: a force that counts first, and one that decides between equal ones.
struct Order {
  double RatedToolForce::*first;
  double (*second)(const RatedToolForce&);

  bool is_better(const RatedToolForce& a, const RatedToolForce& b) const {
    constexpr double kEqual = 1e-9;
    const double more = a.*first - b.*first;
    return std::abs(more) <= kEqual * b.*first ? second(a) > second(b) * (1 + kEqual) : more > 0;
  }
};

/// Improves a position joint by joint, by steps that become smaller.
template <typename Better>
RatedToolForce improved(Bench& bench, RatedToolForce best, std::size_t moved,
                        const Better& is_better) {
  const std::array<int, 3> joints = {bench.arm().boom, bench.arm().stick, bench.arm().bucket};
  for (double step = 1.0 / kCoarse; step > 1e-5; step /= 2)
    for (bool better = true; better;) {
      better = false;
      for (std::size_t k = 0; k < moved; ++k)
        for (const double sign : {-1.0, 1.0}) {
          Position q = {best.boom, best.stick, best.bucket};
          q[k] += sign * step * (bench.upper(joints[k]) - bench.lower(joints[k]));
          const RatedToolForce now = bench.at(q);
          if (!bench.is_clear() || !is_better(now, best)) continue;
          best = now;
          better = true;
        }
    }
  return best;
}

/// Returns the best position of the grid, improved.
template <typename Better>
RatedToolForce best_of(Bench& bench, const Grid& grid, std::size_t moved, const Better& is_better) {
  RatedToolForce best;
  bool found = false;
  for (const double works : grid.values[grid.works])
    over_others(grid, works, [&](const Position& q) {
      const RatedToolForce now = bench.at(q);
      if (!bench.is_clear() || (found && !is_better(now, best))) return;
      best = now;
      found = true;
    });
  return found ? improved(bench, best, moved, is_better) : best;
}

}  // namespace

const char* name_of(ForceLimit limit) {
  return limit == ForceLimit::kHydraulic ? "hydraulic"
         : limit == ForceLimit::kTipping ? "tipping"
                                         : "slipping";
}

ForceLimit RatedToolForce::limit() const {
  if (hydraulic <= std::min(tipping, slipping)) return ForceLimit::kHydraulic;
  return tipping <= slipping ? ForceLimit::kTipping : ForceLimit::kSlipping;
}

// The first missing part is reported: the others mostly follow from it.
std::optional<Fault> tool_force_fault(const scene::Machine& machine) {
  if (machine.buckets.empty())
    return fault_of(machine, "navvy:bucket", "none", "the machine must have a bucket to dig with",
                    "name a machine with one, such as ew180");
  const ArmJoints arm = arm_joints(machine);
  const std::array<std::pair<const char*, int>, 3> needed = {
      {{"boom_joint", arm.boom}, {"stick_joint", arm.stick}, {"bucket_joint", arm.bucket}}};
  for (const auto& [name, joint] : needed) {
    if (joint < 0)
      return fault_of(machine, "navvy:arm", name, "an arm with boom, stick and bucket",
                      "name the joint in navvy:arm");
    const scene::Joint& about = machine.joints[static_cast<std::size_t>(joint)];
    const bool driven =
        std::any_of(machine.cylinders.begin(), machine.cylinders.end(),
                    [&](const scene::Cylinder& cylinder) { return cylinder.joint == about.name; });
    if (!driven && about.effort >= kUnlimited)
      return fault_of(machine, "joint[" + about.name + "]", "no limit",
                      "a cylinder or a limit of effort", "add a navvy:cylinder or <effort>");
  }
  if (arm_bucket(machine) == nullptr)
    return fault_of(machine, "navvy:bucket", "none", "a bucket on the link of the bucket joint",
                    "add a navvy:bucket");
  return std::nullopt;
}

ToolForceRating rate_tool_force(const scene::Machine& machine, ToolForceKind kind) {
  if (const std::optional<Fault> fault = tool_force_fault(machine)) throw InputError(*fault);
  Bench bench(machine, kind), breakout(machine, ToolForceKind::kBreakout);
  Position start;
  start[0] = bench.sample(bench.arm().boom, 1, 2);
  start[1] = bench.sample(bench.arm().stick, 1, 2);
  start[2] = bench.sample(bench.arm().bucket, 1, 2);
  start[2] = best_of_joint(breakout, start, 2);
  const Grid grid = grid_of(bench, start, kind);
  ToolForceRating out;
  out.kind = kind;
  // For the tear-out force the bucket stays where it is.
  const std::size_t moved = kind == ToolForceKind::kBreakout ? 3 : 2;
  const auto standing = [](const RatedToolForce& one) { return one.standing(); };
  const auto hydraulic = [](const RatedToolForce& one) { return one.hydraulic; };
  const Order rated{&RatedToolForce::hydraulic, standing},
      alone{&RatedToolForce::working, hydraulic};
  const auto by = [](const Order& order) {
    return
        [order](const RatedToolForce& a, const RatedToolForce& b) { return order.is_better(a, b); };
  };
  out.rated = best_of(bench, grid, moved, by(rated));
  out.alone = best_of(bench, grid, moved, by(alone));
  out.standing = best_of(bench, grid, moved, [](const RatedToolForce& a, const RatedToolForce& b) {
    return a.standing() > b.standing() * (1 + 1e-9);
  });
  for (int i = 0; i <= kCurve; ++i) {
    Position q = {out.rated.boom, out.rated.stick, out.rated.bucket};
    q[grid.works] = bench.sample(bench.works(), i, kCurve);
    out.curve.push_back(bench.at(q));
  }
  return out;
}

RatedToolForce tool_force_at(const scene::Machine& machine, ToolForceKind kind, double boom,
                             double stick, double bucket) {
  if (const std::optional<Fault> fault = tool_force_fault(machine)) throw InputError(*fault);
  return Bench(machine, kind).at(boom, stick, bucket);
}

}  // namespace navvy::vehicle
