// SPDX-License-Identifier: Apache-2.0
#include "vehicle/rating/lift_capacity.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "vehicle/rating/machine_at_rest.h"
#include "vehicle/rating/tool_force.h"
#include "vehicle/stability.h"

namespace navvy::vehicle {
namespace {

/// Samples of the stick's range between which positions of the pin are found.
constexpr int kSamples = 128;

}  // namespace

double LiftCapacity::rated() const {
  return std::min(kHydraulicShare * hydraulic, kTippingShare * tipping);
}

bool LiftCapacity::is_hydraulic() const {
  return kHydraulicShare * hydraulic <= kTippingShare * tipping;
}

/// The machine and the geometry of its arm: with the boom at zero, the pin of the bucket as seen
/// from the pivot of the boom, for positions of the stick.
struct LiftChart::State {
  State(const scene::Machine& original, bool with_bucket)
      : machine(without(original, with_bucket)), rest(machine), arm(arm_joints(machine)) {
    const scene::Joint& bucket = joint(arm.bucket);
    // Curled in: the end of the range towards which the bucket digs.
    const bool positive = digging_sense(rest, *arm_bucket(machine), arm.bucket) > 0;
    if (bucket.has_limits) rest.set(arm.bucket, positive ? bucket.upper : bucket.lower);
    if (arm.swing >= 0) rest.set(arm.swing, 0);
    rest.set(arm.boom, 0);
    rest.place();
    raises = rest.axis(arm.boom).y() < 0 ? 1 : -1;
    for (int i = 0; i <= kSamples; ++i) pins.push_back(pin_at(stick_at(i)));
  }

  static scene::Machine without(scene::Machine machine, bool with_bucket) {
    if (const std::optional<Fault> fault = tool_force_fault(machine)) throw InputError(*fault);
    const int bucket = machine.joint_index(machine.arm.bucket);
    if (!with_bucket)
      machine
          .links[static_cast<std::size_t>(machine.joints[static_cast<std::size_t>(bucket)].child)]
          .mass = 0;
    return machine;
  }

  const scene::Joint& joint(int index) const {
    return machine.joints[static_cast<std::size_t>(index)];
  }
  double lower(int index) const { return joint(index).has_limits ? joint(index).lower : -kPi; }
  double upper(int index) const { return joint(index).has_limits ? joint(index).upper : kPi; }
  double stick_at(int i) const {
    return lower(arm.stick) + (upper(arm.stick) - lower(arm.stick)) * i / kSamples;
  }

  /// Returns the pin of the bucket from the pivot of the boom, ahead and up [m].
  Vec2 pin_at(double stick) {
    rest.set(arm.boom, 0);
    rest.set(arm.stick, stick);
    rest.place();
    const Vec3 p = rest.origin(arm.bucket) - rest.origin(arm.boom);
    return {p.x(), p.z()};
  }

  /// Returns the position of the boom that brings the pin at `pin` into the direction of `target`;
  /// nothing if it is beyond the boom's limits.
  std::optional<double> boom_for(const Vec2& pin, const Vec2& target) const {
    const double turn = std::atan2(target.y(), target.x()) - std::atan2(pin.y(), pin.x());
    const double q = raises * std::remainder(turn, 2 * kPi);
    constexpr double kRounding = 1e-9;
    if (q < lower(arm.boom) - kRounding || q > upper(arm.boom) + kRounding) return std::nullopt;
    return q;
  }

  /// Returns all positions of the stick that bring the pin to the distance `length` from the pivot
  /// of the boom.
  std::vector<double> sticks_for(double length) {
    std::vector<double> out;
    for (int i = 0; i < kSamples; ++i) {
      const double before = pins[static_cast<std::size_t>(i)].norm() - length,
                   after = pins[static_cast<std::size_t>(i) + 1].norm() - length;
      if (before * after > 0) continue;
      double a = stick_at(i), b = stick_at(i + 1);
      for (int step = 0; step < 40; ++step) {
        const double middle = 0.5 * (a + b);
        ((pin_at(middle).norm() - length) * before > 0 ? a : b) = middle;
      }
      out.push_back(0.5 * (a + b));
    }
    return out;
  }

  /// Returns the axis of the swing, or the pivot of the boom, with the arm ahead [m].
  Vec3 centre() const { return rest.origin(arm.swing >= 0 ? arm.swing : arm.boom); }

  /// Returns the pin's target from the pivot of the boom for a load at `reach` and `height`.
  Vec2 target(double reach, double height) {
    if (arm.swing >= 0) rest.set(arm.swing, 0);
    rest.place();
    const Vec3 pivot = rest.origin(arm.boom);
    return {centre().x() + reach - pivot.x(), height + rest.ground() - pivot.z()};
  }

  /// Sets the swing for an arm at `heading`; returns false if it does not turn there.
  bool swing_to(double heading) {
    if (arm.swing < 0) return heading == 0;
    const double q = rest.axis(arm.swing).z() < 0 ? -heading : heading;
    // Limits may allow a direction only with a turn more or less.
    for (const double turn : {0.0, -2 * kPi, 2 * kPi}) {
      rest.set(arm.swing, q + turn);
      if (rest.position(arm.swing) == q + turn) return true;
    }
    return false;
  }

  /// Evaluates the capacity with the joints as they were set.
  LiftCapacity capacity() {
    rest.place();
    LiftCapacity out;
    const Vec3 pin = rest.origin(arm.bucket);
    out.boom = rest.position(arm.boom);
    out.stick = rest.position(arm.stick);
    out.hydraulic = std::numeric_limits<double>::infinity();
    for (const int held : {arm.boom, arm.stick}) {
      const double weights = rest.weight_effort(held),
                   per_load = rest.force_effort(held, pin, Vec3(0, 0, -kGravity));
      if (per_load == 0) continue;
      // Towards its limit, weights and load add up or take each other away.
      const double limit = rest.effort_limit(held, per_load > 0),
                   used = per_load > 0 ? weights : -weights;
      const double most = std::max(0.0, (limit - used) / std::abs(per_load));
      if (most >= out.hydraulic) continue;
      out.hydraulic = most;
      out.circuit = rest.circuit(held);
    }
    out.tipping = std::numeric_limits<double>::infinity();
    if (rest.is_anchored()) return out;
    const double tips =
        tipping_load(rest.support_points(), rest.centre().head<2>(), rest.mass(), pin.head<2>())
            .load;
    if (tips < kNoTippingLoad) out.tipping = tips;
    return out;
  }

  scene::Machine machine;
  MachineAtRest rest;
  ArmJoints arm;
  /// 1 if a positive rotation of the boom raises it with the arm ahead, otherwise -1.
  double raises = 1;
  std::vector<Vec2> pins;
};

LiftChart::LiftChart(const scene::Machine& machine, bool with_bucket)
    : state_(std::make_unique<State>(machine, with_bucket)) {}
LiftChart::~LiftChart() = default;

// The stick's position follows from the distance of the pin, the boom's from its direction.
std::optional<LiftCapacity> LiftChart::at(double reach, double height, double heading) {
  State& s = *state_;
  const Vec2 target = s.target(reach, height);
  std::optional<LiftCapacity> best;
  for (const double stick : s.sticks_for(target.norm())) {
    const std::optional<double> boom = s.boom_for(s.pin_at(stick), target);
    if (!boom) continue;
    s.rest.set(s.arm.boom, *boom);
    s.rest.set(s.arm.stick, stick);
    if (!s.swing_to(heading)) return std::nullopt;
    LiftCapacity now = s.capacity();
    now.reach = reach;
    now.height = height;
    now.heading = heading;
    if (!best || now.rated() > best->rated()) best = now;
  }
  return best;
}

// The pin is at the height on a circle about the boom's pivot for each position of the stick.
std::optional<double> LiftChart::max_reach(double height) {
  State& s = *state_;
  const Vec2 level = s.target(0, height);
  double most = -std::numeric_limits<double>::infinity();
  for (int i = 0; i <= kSamples; ++i) {
    const Vec2& pin = s.pins[static_cast<std::size_t>(i)];
    const double ahead2 = pin.squaredNorm() - level.y() * level.y();
    if (ahead2 < 0) continue;
    const Vec2 target(std::sqrt(ahead2), level.y());
    if (s.boom_for(pin, target)) most = std::max(most, target.x() - level.x());
  }
  if (!std::isfinite(most)) return std::nullopt;
  return std::floor(100 * most) / 100;
}

std::pair<double, double> LiftChart::heights() {
  State& s = *state_;
  const double ground = s.target(0, 0).y();
  double low = std::numeric_limits<double>::infinity(), high = -low;
  for (const Vec2& pin : s.pins)
    for (int i = 0; i <= kSamples; ++i) {
      const double boom = s.raises * (s.lower(s.arm.boom) +
                                      (s.upper(s.arm.boom) - s.lower(s.arm.boom)) * i / kSamples);
      const double z = std::sin(boom) * pin.x() + std::cos(boom) * pin.y() - ground;
      low = std::min(low, z);
      high = std::max(high, z);
    }
  return {low, high};
}

}  // namespace navvy::vehicle
