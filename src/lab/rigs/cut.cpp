// SPDX-License-Identifier: Apache-2.0
// Rig `cut`: height at which a vertical cut in cohesive soil stands.
//
// Cohesion lets a trench stand. A vertical face certainly holds while no tension is needed, and
// certainly fails well above the critical height of a slip circle. Between the two the rig finds
// the limit of the law by bisection.
#include <algorithm>
#include <cmath>

#include "lab/rigs/chute.h"
#include "lab/rigs/rig_list.h"
#include "lab/soils.h"
#include "lab/theory/formulas.h"

namespace navvy::lab {
namespace {

const char* const kSource = "[docs/validation.md, Slopes, walls and cuts]";

/// Returns the mean displacement of the upper half of the soil within half a height of the face
/// [m].
double face_motion(const Site& site, double height, const std::vector<Vec3>& start) {
  double sum = 0;
  int count = 0;
  const auto now = site.solver().particles();
  for (std::size_t i = 0; i < start.size(); ++i) {
    const Vec3& p = start[i];
    // The wedge that slides down is this part of the soil, at any angle.
    if (p.z() < -0.5 * height || p.x() > 0.5 * height) continue;
    // Particles keep their order: index i is the same particle.
    sum += (site.position(now[i]) - p).norm();
    ++count;
  }
  return sum / count;
}

/// Returns two smooth plates beside the whole bed, three cells beyond its ends and below it; their
/// fronts face the soil.
scene::Shell plates(const ChuteBed& bed, double gap, double cell) {
  const double half = chute_half(cell), y0 = -half, y1 = gap + half, x0 = -bed.back - 3 * cell,
               x1 = bed.ahead + 3 * cell, z0 = -bed.below - 3 * cell, z1 = 4 * cell;
  scene::Shell s;
  s.name = "plates";
  s.half_thickness = half;
  s.vertices = {{x0, y0, z0}, {x1, y0, z0}, {x1, y0, z1}, {x0, y0, z1},
                {x0, y1, z0}, {x1, y1, z0}, {x1, y1, z1}, {x0, y1, z1}};
  s.triangles = {{0, 2, 1}, {0, 3, 2}, {4, 5, 6}, {4, 6, 7}};
  return s;
}

/// Releases a cut of this height; returns the displacement of its face over its height.
double try_cut(const Setup& setup, double height, Report& report) {
  const double cell = setup.cell, gap = 4 * cell;
  const double below = whole_cells(height + setup["below"] * height, cell), foot = height;
  const ChuteBed bed{whole_cells(setup["front"] * height, cell),
                     whole_cells(setup["back"] * height, cell), below};
  Site site(setup, chute_soils(setup.soil), chute_site(setup, bed, gap));
  site.add_tool(plates(bed, gap, cell), make_pose(0, chute_offset(cell), 0));
  // Nothing supports the face from the start.
  const auto keep = [foot](const Vec3& p) { return p.x() > 0 || p.z() < -foot; };
  const auto surface = [foot](double x, double) { return x > 0 ? 0.0 : -foot; };
  // Smooth plates and one kind of soil: only the face is free.
  site.solver().insert(chute_fill(site, bed, gap, false, keep, surface));
  // Positions as the solver rounds them: no motion then reads as zero.
  std::vector<Vec3> start;
  for (const soil::Particle& p : site.solver().particles()) start.push_back(site.position(p));
  site.run(setup["time"]);
  site.finish(report);
  return face_motion(site, height, start) / height;
}

/// The two heights with tolerances first, then the requested bisections between them.
Report run(const Setup& setup) {
  const scene::Soil& s = setup.soil;
  const double weight = s.bank_density * kGravity;
  const double safe = cut_no_tension_height(s.friction_angle, s.cohesion, weight),
               critical = cut_critical_height(s.friction_angle, s.cohesion, weight);
  // Displacement over height, far above the settling of a face that stands.
  const double share = setup["limit"];
  Report report;
  Series heights{"height", "m", {}}, motions{"motion over height", "", {}};
  const auto moved = [&](double height) {
    // Resting ground would hold half of a face between two planes of the grid.
    // Whole cells.
    height = std::round(height / setup.cell) * setup.cell;
    const double motion = try_cut(setup, height, report);
    heights.values.push_back(height);
    motions.values.push_back(motion);
    if (setup.progress)
      setup.progress(std::min(0.99, heights.values.size() / (2 + setup["trials"])));
    return motion;
  };
  // Below the first no element needs tension; at the second any mechanism fails.
  const double low = moved(0.9 * safe), high = moved(1.25 * critical);
  // Faces are whole cells high: in coarse cells neither height is that of its tolerance.
  const char* range = "heights that whole cells meet within a twentieth";
  report
      .add("motion at 0.9 of the no-tension height", 100 * low, "% of H", 0, kNone, 100 * share,
           std::string("stands ") + kSource)
      .holds_for(range, heights.values[0] < 0.95 * safe);
  report
      .add("motion at 1.25 Hc", 100 * high, "% of H", kNone, 100 * share, kNone,
           std::string("fails ") + kSource)
      .holds_for(range, heights.values[1] > 1.2 * critical);
  // The two heights bracket the search; their own results are judged above.
  double stands = 0.9 * safe, fails = 1.25 * critical;
  for (int i = 0; i < setup.whole("trials"); ++i) {
    const double middle = 0.5 * (stands + fails);
    (moved(middle) < share ? stands : fails) = middle;
  }
  const double height = 0.5 * (stands + fails);
  report.add("highest cut that stands over Hc", height / critical, "", 1, kNone, kNone,
             "aim: 0.8; Hc = 3.83 c / gamma tan(45 + phi/2) [Taylor 1948]");
  report.note("highest cut that stands", height, "m");
  report.series = {heights, motions};
  return report;
}

}  // namespace

Rig cut_rig() {
  Rig rig;
  rig.name = "cut";
  rig.summary = "vertical cut in cohesive soil: the height at which it stands";
  rig.drawing =
      "Cohesive soil between smooth plates has an upright free face. It starts at rest under its "
      "own weight, and without support of the face it is released for `time`. It stands if the "
      "upper half of the soil within half a height of the face has moved by less than `limit` "
      "heights on average. The trials are 0.9 of the height that holds without tension, 1.25 Hc, "
      "and `trials` bisections between them.";
  rig.parameters = {{"time", 1.5, "s", "of each trial", above(0)},
                    {"trials", 3, "", "bisections between the two heights", count_from(1)},
                    {"limit", 0.05, "heights", "of displacement that count as failure", above(0)},
                    {"back", 1.5, "heights", "of soil behind the face", at_least(0)},
                    {"front", 0.6, "heights", "of ground in front of it", at_least(0)},
                    {"below", 0.4, "heights", "of soil under the foot", at_least(0)}};
  rig.default_soil = cohesive(30, 5000);
  rig.default_soil.bank_density = 18000 / kGravity;
  rig.experiment = run;
  return rig;
}

}  // namespace navvy::lab
