// SPDX-License-Identifier: Apache-2.0
// The trench: the shipped scene from start to end, measured on the final ground.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "core/stopwatch.h"
#include "record/summary.h"
#include "validation/dig_meter.h"
#include "validation/loads.h"
#include "validation/report.h"
#include "validation/scenes.h"
#include "validation/trench_measure.h"
#include "values.h"

namespace navvy::validation {
namespace {

/// Returns the mean time from the start of a cycle to the start of the next [s].
double mean_cycle_time(const std::vector<session::Cycle>& cycles) {
  if (cycles.size() < 2) return kNoLimit;
  return (cycles.back().start - cycles.front().start) / static_cast<double>(cycles.size() - 1);
}

/// Reports the loads of the dig and where its energy goes. `volume`: bank volume [m3].
void report_loads_and_energy(const DigMeter& meter, double volume) {
  const char* source = "the trench [docs/validation.md, Whole digs]";
  expect_between("lost from the fullest moment to lift-out, share of all loads", meter.lost(), 0,
                 0.10, source);
  const auto per_volume = [volume](double joules) { return joules / volume / 1000; };
  expect_between("energy of drives and cylinders [kJ/m3]", per_volume(meter.work()), 0, 340,
                 source);
  print_value("of it, cutting [kJ/m3]", per_volume(meter.cutting()), "no tolerance",
              "work of the bucket in the ground");
  print_value("of it, lifting the load [kJ/m3]", per_volume(meter.lifting()), "no tolerance",
              "work of the bucket on its load after that");
  print_value("of it, moving the machine [kJ/m3]",
              per_volume(meter.work() - meter.cutting() - meter.lifting()), "no tolerance",
              "the rest");
  expect_between("mean draft over the cut area [kPa]", per_volume(meter.draft_work()), 40, 130,
                 "light loam, handbooks [docs/validation.md, Whole digs]");
  expect_between("cutting energy / mean draft over the cut area",
                 meter.cutting() / meter.draft_work(), 0.9, 1.1,
                 "force x path [docs/validation.md, Whole digs]");
  print_value("largest force on edges and teeth [N]", meter.edge_peak(), "no tolerance",
              "[docs/tools.md, edges]");
  print_value("part of the draft on edges and teeth", meter.edge_part(), "no tolerance",
              "[docs/tools.md, edges]");
}

TEST(Trench, IsDugToItsDesignAndTheSpoilSwells) {
  const scene::Scene description = load_scene("trench.sdf");
  const control::Dig dig = dig_step(description);
  session::Session session(description, shared_device());
  WheelTracks tracks(session.world().ground());
  DigMeter meter(session);
  double fastest_rise = 0;
  const Stopwatch watch;
  while (!session.done()) {
    session.step();
    tracks.mark(session.world());
    meter.look();
    fastest_rise =
        std::max(fastest_rise, std::abs(session.world().machines().at(0).link(0).velocity().z()));
  }
  const double real_time_factor = session.world().time() / watch.seconds();
  const heightfield::Ground& ground = session.world().ground();
  const TrenchMeasure trench = measure(ground, dig);
  const record::Earthwork earth = record::measure_earthwork(session.world());
  const char* source = "the trench [docs/validation.md, Whole digs]";
  expect_between("design length [m]", (dig.to - dig.from).norm(), 3.0, 20, source);
  expect_between("design depth [m]", dig.depth, 0.8, 5, source);
  expect_between("centre line offset [m]", trench.center_offset, 0, 0.15, source);
  expect_between("floor within 0.10 m, share of length", trench.floor_share, 0.8, 1.0, source);
  expect_between("design volume removed, share", trench.inside_volume / trench.design_volume, 0.85,
                 1.0, source);
  expect_between("over-dug, share of design volume", trench.overdug / trench.design_volume, 0, 0.08,
                 source);
  expect_between("bank volume [m3]", earth.bank_volume, 2.0, 20, source);
  EXPECT_TRUE(session.complete());
  expect_between("time of the whole trench [s]", session.world().time(), 10, 125, source);
  expect_between("cycles", static_cast<double>(session.cycles().size()), 3, 7, source);
  expect_between("loose / bank / swell",
                 earth.loose_volume / earth.bank_volume / description.soils[0].swell, 0.95, 1.05,
                 source);
  const double spoil =
      spoil_radius(earth.loose_volume, description.soils[0].friction_angle, dig.width);
  expect_between("change off trench, spoil and tracks [m]",
                 change_elsewhere(ground, dig, spoil, tracks), 0, ground.cell(), source);
  const std::vector<double> slopes = heap_slopes(ground, dig, spoil);
  ASSERT_FALSE(slopes.empty());
  const char* const heap = "spoil lies at 34 .. 45 deg [docs/validation.md, Whole digs]";
  expect_between("slope of the heap over 0.6 m, median [deg]", slopes[slopes.size() / 2], 33, 45,
                 heap);
  expect_between("slope of the heap over 0.6 m, steepest [deg]", slopes.back(), -kNoLimit, 50,
                 heap);
  expect_between("real-time factor without pictures", real_time_factor, 0.2, kNoLimit, source);
  expect_between("ledger error [units]",
                 static_cast<double>(session.world().soil().mass_ledger().error), 0, 0, source);
  expect_between("shell crossings",
                 static_cast<double>(session.world().soil().counts().shell_crossings), 0, 0,
                 source);
  expect_between("momentum residual / scale", session.force().residual_max, 0, 1e-5, source);
  expect_between("machine's vertical speed [m/s]", fastest_rise, 0, 1.0,
                 "a machine does not jump [docs/validation.md, Machines]");
  expect_between("mean cycle, 80 deg of swing [s]", mean_cycle_time(session.cycles()), 13, 15,
                 source);
  expect_between("mean payload of all cycles / heaped bucket",
                 mean_payload(session) / heaped_load(description), 0.7, 1.1, source);
  double uplift = 0;
  for (const session::Cycle& cycle : session.cycles()) uplift = std::max(uplift, cycle.uplift_peak);
  expect_between("soil's push up on the bucket in a curl, less the load [N]", uplift, 0, 10e3,
                 "the heel does not carry the machine [docs/validation.md, Whole digs]");
  report_loads_and_energy(meter, earth.bank_volume);
  print_value("peak draft of the cutting edge [N]", session.force().draft_peak, "no tolerance",
              "plausibility");
  expect_between("soil on the ground under the swing, share of the loose volume",
                 volume_elsewhere(ground, dig, spoil, tracks) / earth.loose_volume, 0, 0.005,
                 source);
}

}  // namespace
}  // namespace navvy::validation
