// SPDX-License-Identifier: Apache-2.0
#include "control/activities/dump.h"

#include <cmath>
#include <string>
#include <utility>
#include <vector>

#include "control/arm_move.h"
#include "control/load_change.h"
#include "control/reach.h"

namespace navvy::control {
namespace {

// Tolerance of the bucket's angle: heavy soil causes less; more is an obstacle.
constexpr double kShort = radians(6);
constexpr double kAtRest = 0.02;  // [rad/s]

enum Phase : std::int64_t { kOpening, kClosing };

struct Memory {
  ArmMove move;
  double bucket_before = 0;  // commanded angle of the bucket at the start [rad]
  LoadChange load;

  void visit(Archive& a) {
    a("move", move);
    a("bucket_before", bucket_before);
    a("load", load);
  }
};

// Open, hold, close; then something must have left the bucket.
class Dumping final : public ActivityWith<Memory> {
 public:
  Dumping(OperatorContext& place, const Dump& step) : ActivityWith(place), step_(step) {}
  const char* phase() const override { return "dump"; }

  void begin(const Observation& seen) override {
    // It curls back to the commanded angle, not to where a load had bent it.
    m.bucket_before = place_.handover.q[3];
    m.move.open_bucket(place_, seen);
    m.load.start(seen.bucket_load);
    enter(kOpening);
  }
  std::vector<Measurement> account(const Observation& seen) const override {
    return m.load.account(seen.bucket_load, "dumped_kg");
  }

 private:
  bool update(const Observation& seen, double, Command&) override {
    if (phase_index() == kClosing) {
      if (!m.move.advance(place_, seen, phase_time(), phase())) return false;
      if (held(seen, "closed")) return true;
      std::string shortfall = m.load.shortfall(seen.bucket_load, "bucket");
      return shortfall.empty() || fall_short(StepState::kStalled, std::move(shortfall));
    }
    // Soil leaves whether or not the bucket is fully open, so time alone decides.
    if (phase_time() <= m.move.duration()) m.move.advance(place_, seen, phase_time(), phase());
    if (phase_time() <= m.move.duration() + step_.hold) return false;
    if (held(seen, "open")) return true;
    Axes closed = place_.handover.q;
    closed[3] = m.bucket_before;
    m.move.start(place_, closed, seen, {});
    enter(kClosing);
    return false;
  }

  /// Returns true when something holds the bucket short of its target: the step falls short then.
  bool held(const Observation& seen, const char* target) {
    const std::size_t j = place_.joint(3);
    const vehicle::JointState& bucket = seen.joints[j];
    const double rest = std::abs(m.move.target(3) - bucket.position);
    // A bucket that still moves is only slow.
    if (rest < kShort || !(bucket.stalled || std::abs(bucket.velocity) < kAtRest)) return false;
    return fall_short(StepState::kBlocked,
                      held_text(place_.machine.joints[j], bucket, rest, target));
  }

  const Dump& step_;
};

}  // namespace

void Dump::check(const scene::StepSource& source) const {
  source.require(source.machine && !source.machine->arm.bucket.empty(),
                 "dump needs a machine with <navvy:arm>/bucket_joint");
}

std::unique_ptr<Activity> Dump::activity(OperatorContext& place) const {
  return std::make_unique<Dumping>(place, *this);
}

}  // namespace navvy::control
