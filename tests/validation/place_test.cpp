// SPDX-License-Identifier: Apache-2.0
// The same dig, from activation to deposition, at both ends of a square kilometre.
#include <gtest/gtest.h>

#include <cmath>

#include "core/stopwatch.h"
#include "record/summary.h"
#include "validation/report.h"
#include "validation/scenes.h"

namespace navvy::validation {
namespace {

constexpr const char* kSource = "place does not matter [docs/validation.md, Whole digs]";
constexpr double kLifted = 7.0;

struct Dug {
  double force = 0;    ///< mean |force| over the steps in contact [N]
  double payload = 0;  ///< after the lift [kg]
  record::Earthwork earth;
  double work = 0;  ///< particle-steps
  double wall = 0;  ///< [s]
};

/// The scoop of bucket_path.sdf with its frame at (x, y) of a site whose corner is the origin of W,
/// to the end.
Dug dig_at(double x, double y, double until = 20) {
  session::Session session(
      load_scene(
          "bucket_path.sdf",
          {"ground.size_m=1000 1000", "ground.origin_m=0 0", "machine.x_m=" + std::to_string(x),
           "machine.y_m=" + std::to_string(y), "recording.settle_s=6", "recording.duration_s=20"}),
      shared_device());
  const Stopwatch watch;
  Dug out;
  while (!session.done() && session.world().time() < until) {
    session.step();
    if (session.world().time() < kLifted)
      out.payload = 0;
    else if (out.payload == 0)
      out.payload = session.world().machines().tools().at(0).payload();
  }
  out.wall = watch.seconds();
  out.force = session.force().mean();
  out.earth = record::measure_earthwork(session.world());
  out.work = static_cast<double>(session.world().soil().counts().particle_steps);
  EXPECT_EQ(session.world().soil().mass_ledger().error, 0);
  std::printf(
      "(%.1f, %.1f): force %.6g N, payload %.6g kg, bank %.6g m3, loose %.6g m3, %.6g "
      "particle-steps, %d still active, "
      "%.1f s\n",
      x, y, out.force, out.payload, out.earth.bank_volume, out.earth.loose_volume, out.work,
      session.world().soil().counts().particles, out.wall);
  return out;
}

constexpr double kTolerance = 1e-3;

void compare(const Dug& near, const Dug& far) {
  const double low = 1 - kTolerance, high = 1 + kTolerance;
  expect_between("force far / near", far.force / near.force, low, high, kSource);
  expect_between("payload far / near", far.payload / near.payload, low, high, kSource);
  expect_between("bank volume far / near", far.earth.bank_volume / near.earth.bank_volume, low,
                 high, kSource);
  expect_between("loose volume far / near", far.earth.loose_volume / near.earth.loose_volume, low,
                 high, kSource);
  expect_between("particle-steps far / near", far.work / near.work, low, high, kSource);
  std::printf("wall time far / near %.2f (no tolerance: the machine is shared)\n",
              far.wall / near.wall);
}

TEST(Place, TheSameDigAtBothEndsOfASquareKilometreIsTheSame) {
  const Dug near = dig_at(5, 5);
  // 2237.5 and 1737.5 blocks of 0.4 m away, and a quarter of a block off: blocks begin at the
  // machine (soil::PlanGrid).
  compare(near, dig_at(900, 700));
  compare(near, dig_at(900.1, 699.7));
}

}  // namespace
}  // namespace navvy::validation
