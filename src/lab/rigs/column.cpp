// SPDX-License-Identifier: Apache-2.0
// Rig `column`: granular column collapse, plane or axisymmetric.
//
// A released column spreads, stops and leaves a deposit. Run-out and height depend on the aspect
// ratio a alone and hardly on the grains. The laws of the literature therefore hold for any sand,
// and the rig needs no material data. Between plates the collapse is plane strain, in which the
// law's friction angle is defined; the free cylinder is closer to triaxial states and spreads a
// little less than its law. Below 30 cells of length the run-out is too short, as the thin tongue
// at the front is then a cell high.
#include <algorithm>
#include <cmath>

#include "lab/lab_site.h"
#include "lab/rig_shapes.h"
#include "lab/rigs/heap.h"
#include "lab/rigs/rig_list.h"
#include "lab/soils.h"
#include "lab/theory/formulas.h"

namespace navvy::lab {
namespace {

const char* const kChapter = "[docs/validation.md, Columns and collapse]";
/// Samples of the front, 0.1 tau apart for the default `time`.
constexpr int kSamples = 40;

/// The released column. `length` is L0 of a plane column, R0 of a round one.
struct Column {
  bool axisymmetric;
  double a, length, height, gap;
  double front(const Vec3& p) const { return axisymmetric ? p.head<2>().norm() : p.x(); }
};

/// Builds a column between smooth plates, against a third one. The plates are a little off the
/// grid's planes, as any plate is.
void build_plane(Site& site, const Column& column) {
  const double cell = site.cell(), x0 = 0.13 * cell, y0 = 0.07 * cell;
  scene::Shell walls = channel(column.length * (2 + 4 * column.a), column.gap, -6 * cell,
                               column.height + 8 * cell, true);
  // Plates long enough for the widest run-out, low enough that no particle passes under them, high
  // enough for the splash.
  walls.half_thickness = 0.2 * cell;
  site.add_tool(walls, make_pose(x0, y0, 0));
  // A quarter of a cell: half the spacing of particles, between face and first row.
  const double inset = 0.25 * cell;
  const SiteBox box{Vec3(x0 + inset, y0 + inset, 0),
                    Vec3(x0 + column.length, y0 + column.gap - inset, column.height)};
  auto soil = site.fill(box);
  site.rest(soil, column.height);
  site.solver().insert(soil);
}

void build_round(Site& site, const Column& column) {
  const double r = column.length;
  const auto inside = [r](const Vec3& p) { return p.head<2>().norm() < r; };
  // A lattice cut by a circle: its radius is uncertain by a quarter of a cell, one percent of 30
  // cells.
  auto soil = site.fill({Vec3(-r, -r, 0), Vec3(r, r, column.height)}, inside);
  site.rest(soil, column.height);
  site.solver().insert(soil);
}

/// Returns the front. Particles that fly ahead of the heap do not count: only those in contact,
/// without the first percent.
double front_of(const Site& site, const Column& column) {
  std::vector<double> distance;
  for (const Vec3& p : in_contact(site, site.solver().particles()))
    distance.push_back(column.front(p));
  return percentile(std::move(distance), 0.99);
}

/// Times of the front [tau]: `accelerates` until its speed first reaches 95 % of the highest (over
/// 0.2 tau), `stops` when it has covered 99 % of its run-out.
struct FrontTimes {
  double accelerates = kNone, stops = kNone;
};

/// Finds the times. `time` [tau] and `front` in any unit, the first at rest.
FrontTimes times_of(const std::vector<double>& time, const std::vector<double>& front) {
  FrontTimes out;
  std::vector<double> speed;
  for (std::size_t i = 2; i < time.size(); ++i)
    speed.push_back((front[i] - front[i - 2]) / (time[i] - time[i - 2]));
  if (speed.empty() || !(front.back() > front.front())) return out;
  const double fast = 0.95 * *std::max_element(speed.begin(), speed.end());
  const double far = front.front() + 0.99 * (front.back() - front.front());
  const auto risen =
      std::find_if(speed.begin(), speed.end(), [fast](double v) { return v >= fast; });
  // The first sample at this speed, not the last: later the front only slows down. Centre of its
  // two intervals.
  out.accelerates = time[static_cast<std::size_t>(risen - speed.begin()) + 1];
  for (std::size_t i = 1; i < time.size() && std::isnan(out.stops); ++i)
    if (front[i] >= far)
      out.stops =
          time[i - 1] + (time[i] - time[i - 1]) * (far - front[i - 1]) / (front[i] - front[i - 1]);
  return out;
}

/// Two laws are listed for the plane height since they differ by a tenth; neither has a tolerance.
void judge_height(const Column& c, double height, Report& report) {
  const double h = height / c.length;
  if (c.axisymmetric) {
    report.add("height over L0", h, "", lajeunesse_axisymmetric_height(c.a), kNone, kNone,
               std::string("a, then 0.74 [Lajeunesse 2004] ") + kChapter);
    return;
  }
  report.add("height over L0", h, "", lajeunesse_plane_height(c.a), kNone, kNone,
             std::string("a, then a^(1/3) [Lajeunesse 2005] ") + kChapter);
  report.add("height over L0 against Lube", h, "", lube_plane_height(c.a), kNone, kNone,
             std::string("a, then a^(2/5) [Lube 2005] ") + kChapter);
}

void judge(const Setup& setup, const Column& c, double run_out, double height, Report& report) {
  const std::string source =
      std::string(c.axisymmetric ? "[Lube 2004] " : "[Lube 2005] ") + kChapter;
  const double expected = c.axisymmetric ? lube_axisymmetric_run_out(c.a) : lube_plane_run_out(c.a);
  // Ranges around the law, as published runs scatter; wider for tall columns.
  // Ranges exist for these aspect ratios only.
  double low = kNone, high = kNone;
  if (!c.axisymmetric && c.a == 1) low = 1.2, high = 1.8;
  if (!c.axisymmetric && c.a == 5)
    low = 1.6 * std::pow(5, 2.0 / 3), high = 2.7 * std::pow(5, 2.0 / 3);
  if (c.axisymmetric && c.a == 1) low = 1.0, high = 1.5;
  if (c.axisymmetric && c.a == 3) low = 2.49, high = 3.81;
  const double phi = degrees(setup.soil.friction_angle);
  const bool known = !std::isnan(low) && std::abs(phi - 33) < 0.5 && !(setup.soil.cohesion > 0);
  report.add("run-out over L0", run_out, "", expected, low, high, source)
      .holds_for(std::string("a of 1 or ") + (c.axisymmetric ? "3" : "5") +
                     ", phi 33, no cohesion, 30 cells along L0",
                 known && c.length > 29.999 * setup.cell);
  judge_height(c, height, report);
}

/// Builds the column at rest, releases it at once, and samples the front until everything is still.
Report run(const Setup& setup) {
  const Column column{setup.is("shape", "round"), setup["a"], setup["l0"], setup["a"] * setup["l0"],
                      setup["gap"] * setup.cell};
  SiteOptions options;
  // Space for a run-out of 4 a on every side, well above any observed.
  options.size = 2 * column.length * (2 + 4 * column.a);
  options.depth = 8 * setup.cell;
  Setup smooth = setup;
  // The side plates.
  if (!column.axisymmetric) smooth.soil = without_tool_friction(setup.soil);
  Site site(smooth, options);
  column.axisymmetric ? build_round(site, column) : build_plane(site, column);

  // The time of free fall over the height scales all phases of a collapse.
  const double tau = std::sqrt(column.height / kGravity), seconds = setup["time"] * tau;
  site.expect(seconds);
  Series time{"time over tau", "", {}}, front{"front over L0", "", {}};
  for (int i = 0; i <= kSamples; ++i) {
    if (i > 0) site.run(seconds / kSamples);
    time.values.push_back(site.time() / tau);
    front.values.push_back((front_of(site, column) - column.length) / column.length);
  }

  Report report;
  // The height is that of the rolling-ball surface: the topmost particle is higher than the support
  // of others.
  const HeapSurface surface =
      surface_of(in_contact(site, site.solver().particles()), setup.cell, 0);
  judge(setup, column, front.values.back(), surface.highest(), report);
  const FrontTimes times = times_of(time.values, front.values);
  report.add("front accelerates until", times.accelerates, "tau", 0.8, kNone, kNone,
             std::string("[Lube 2004] [Lube 2005] ") + kChapter);
  report.add("front stops after", times.stops, "tau", 3, kNone, kNone,
             std::string("near 3 tau [Lube 2004] [Lube 2005] ") + kChapter);
  // A leak would shorten the run-out unnoticed.
  report.note("particles through a plate",
              static_cast<double>(site.solver().stats().shell_crossings), "");
  report.series = {time, front};
  site.finish(report);
  return report;
}

}  // namespace

Rig column_rig() {
  Rig rig;
  rig.name = "column";
  rig.summary = "column collapse: run-out and height of a released plane or round column of sand";
  rig.drawing =
      "`shape` plane: a block `l0` long and a x l0 high stands on rough level ground between two "
      "smooth plates `gap` cells apart, its back against a third plate, and is released on its "
      "free side. `shape` round: a free cylinder of radius `l0`, without plates. After `time` x "
      "sqrt(H0/g) the run-out is the 99th percentile of the distances of particles in contact; "
      "the height is that of the surface over the heap. The front accelerates until its speed is "
      "within 5 % of the highest, and stops when it has covered 99 % of its run-out. The ground "
      "holds the lowest layer, so the floor has the soil's own friction. Tolerances apply to l0 "
      "of at least 30 cells, phi 33 and a = 1 or 5 (plane), 1 or 3 (round).";
  rig.examples = {
      {"Negative control: nearly rigid sand must fall outside the band", "--phi-deg 50"}};
  rig.parameters = {
      choice("shape", "plane", "",
             {{"plane", 0, "a block between plates"}, {"round", 1, "a free cylinder"}}),
      {"a", 1, "", "height over length (radius)", above(0)},
      {"l0", 1.5, "m", "length or radius at the start", above(0)},
      {"gap", 5, "cells", "between the side plates", above(0)},
      {"time", 4, "", "duration in units of sqrt(H0/g)", above(0)}};
  rig.default_soil = clean_sand(33);
  rig.default_cell = 0.05;
  rig.experiment = run;
  return rig;
}

}  // namespace navvy::lab
