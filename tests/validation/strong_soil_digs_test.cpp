// SPDX-License-Identifier: Apache-2.0
// Effect of stronger soil and of the step on a machine: the shipped trench in clay, its first scoop
// from loam to clay that no bucket of its size cuts at full slices, and its forces at three steps.
#include <gtest/gtest.h>

#include <algorithm>
#include <string>
#include <vector>

#include "validation/report.h"
#include "validation/scenes.h"
#include "values.h"

namespace navvy::validation {
namespace {

constexpr const char* kSource = "[docs/validation.md, Digs in strong soil]";

/// Settings for the trench's soil with another cohesion, which remoulding reduces to a quarter as
/// in loam, and 200 times as stiff.
std::vector<std::string> with_cohesion(double pascals) {
  const auto set = [](const char* name, double value) {
    return std::string("soil.") + name + "=" + std::to_string(value);
  };
  return {set("cohesion_pa", pascals), set("residual_cohesion_pa", pascals / 4),
          set("young_modulus_pa", std::max(1e6, 200 * pascals))};
}

/// The first scoops of the trench.
struct Scoops {
  int count = 0;
  /// Mean payload when the bucket is out [kg].
  double payload = 0;
  /// Mean of the scoops' largest forces on the cutting edge [N].
  double draft = 0;
  /// Mean force of the soil on the bucket in contact [N].
  double force = 0;
  /// Mean time from the start of one scoop to the start of the next; for one scoop: until its end
  /// [s].
  double cycle = 0;
  /// Time in which soil blocked a joint of the arm with the bucket in the ground [s].
  double held = 0;
  bool finished = true;  ///< not given up before
};

Scoops dig(const std::vector<std::string>& settings, int scoops) {
  session::Session session(load_scene("trench.sdf", settings), shared_device());
  const sim::MachineHandle machine = session.world().machines().at(0);
  const std::vector<sim::JointHandle> arm = {
      machine.joint("boom_joint"), machine.joint("arm_joint"), machine.joint("bucket_joint")};
  Scoops out;
  double last = 0;
  const auto over = [&] {
    return static_cast<int>(session.cycles().size()) >= scoops && session.phase(0) == "return";
  };
  while (!session.done() && !over()) {
    session.step();
    const double time = session.world().time();
    const std::string phase = session.phase(0);
    const bool in_ground = phase == "penetrate" || phase == "drag" || phase == "curl";
    if (in_ground && std::any_of(arm.begin(), arm.end(),
                                 [](const auto& joint) { return joint.state().stalled; }))
      out.held += time - last;
    last = time;
  }
  const std::vector<session::Cycle>& cycles = session.cycles();
  out.count = std::min(scoops, static_cast<int>(cycles.size()));
  out.finished = static_cast<int>(cycles.size()) >= scoops;
  for (int i = 0; i < out.count; ++i) {
    const session::Cycle& one = cycles[static_cast<std::size_t>(i)];
    out.payload += one.payload_lift_out / out.count;
    out.draft += one.draft_peak / out.count;
    out.cycle += (one.end - one.start) / out.count;
  }
  out.force = session.force().mean();
  EXPECT_EQ(session.world().soil().mass_ledger().error, 0);
  EXPECT_EQ(session.world().soil().counts().shell_crossings, 0u);
  return out;
}

TEST(StrongSoil, AffectsTheFirstScoop) {
  // What the machine's cylinders can do (navvy lab iso6015 ew180): 89 kN of tear-out, 117 kN of
  // breakout force.
  constexpr double kTearOut = 89.4e3, kBreakout = 116.8e3;
  double before = 0;
  for (const double kilopascals : {6.0, 50.0, 150.0}) {
    const Scoops scoop = dig(with_cohesion(1000 * kilopascals), 1);
    const std::string name =
        "first scoop, c " + std::to_string(static_cast<int>(kilopascals)) + " kPa, ";
    print_value(name + "largest draft [N]", scoop.draft, "rises with c", kSource);
    print_value(name + "payload [kg]", scoop.payload, "no tolerance", kSource);
    print_value(name + "held by the soil [s]", scoop.held, "the last one is held", kSource);
    if (before > 0)
      expect_between(name + "largest draft / that of the weaker soil", scoop.draft / before, 1.2,
                     kNoLimit, kSource);
    before = scoop.draft;
    if (kilopascals < 150) continue;
    expect_between("first scoop, c 150 kPa: time in which the soil holds the arm [s]", scoop.held,
                   0.5, kNoLimit, kSource);
    // Held by the soil, the machine pulls with all that it has.
    expect_between("first scoop, c 150 kPa: largest draft / tear-out force", scoop.draft / kTearOut,
                   0.8, 1.1 * kBreakout / kTearOut, "[ISO 6015]");
  }
}

TEST(StrongSoil, FillsNoMoreAndTakesLonger) {
  constexpr int kScoops = 4;
  const Scoops loam = dig({}, kScoops);
  Scoops before = loam;
  for (const double kilopascals : {20.0, 50.0}) {
    const Scoops clay = dig(with_cohesion(1000 * kilopascals), kScoops);
    const std::string name =
        "four scoops, c " + std::to_string(static_cast<int>(kilopascals)) + " kPa, ";
    // A dig that ends earlier reports why (session::ProgramReport); it has no four scoops to
    // compare.
    print_value(name + "scoops", clay.count, "4, or the dig reports why not", kSource);
    expect_between(name + "payload / payload in loam", clay.payload / loam.payload, 0, 1.03,
                   kSource);
    expect_between(name + "largest draft / that of the weaker soil", clay.draft / before.draft, 1,
                   kNoLimit, kSource);
    if (clay.finished)
      expect_between(name + "time of a cycle / that of the weaker soil", clay.cycle / before.cycle,
                     1, kNoLimit, kSource);
    before = clay;
  }
}

TEST(StrongSoil, ForcesDoNotDependOnTheStep) {
  constexpr int kScoops = 4;
  double least = 1e9, most = 0, sum = 0;
  for (const char* courant : {"0.25", "0.5", "0.8"}) {
    const double force = dig({std::string("solver.courant=") + courant}, kScoops).force;
    print_value(std::string("four scoops of the trench, Courant ") + courant +
                    ": mean force on the bucket [N]",
                force, "one value", "the step [docs/validation.md, speed and step]");
    least = std::min(least, force), most = std::max(most, force), sum += force / 3;
  }
  expect_between("four scoops of the trench, Courant 0.25 .. 0.8: spread of the mean force / mean",
                 (most - least) / sum, 0, 0.03, "the step [docs/validation.md, speed and step]");
}

}  // namespace
}  // namespace navvy::validation
