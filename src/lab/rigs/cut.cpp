// SPDX-License-Identifier: Apache-2.0
// Rig `cut`: how high a vertical cut in cohesive soil stands.
#include <algorithm>
#include <cmath>

#include "lab/rigs/chute.h"
#include "lab/rigs/tool_list.h"
#include "lab/theory/formulas.h"

namespace navvy::lab {
namespace {

/// Mean motion of the upper half of the soil within half a height of the face [m].
double face_motion(const Site& site, double height, const std::vector<Vec3>& start) {
  double sum = 0;
  int count = 0;
  const auto now = site.solver().particles();
  for (std::size_t i = 0; i < start.size(); ++i) {
    const Vec3& p = start[i];
    if (p.z() < -0.5 * height || p.x() > 0.5 * height) continue;
    sum += (site.position(now[i]) - p).norm();
    ++count;
  }
  return sum / count;
}

/// Lets a cut of this height stand; returns the motion of its face over its height.
double try_cut(const Setup& setup, double height, Report& report) {
  const double cell = setup.cell, gap = 4 * cell;
  const auto whole = [cell](double x) { return cell * std::ceil(x / cell - 1e-9); };
  const double below = whole(height + setup["below"] * height), foot = height;
  const ChuteBed bed{whole(setup["front"] * height), whole(setup["back"] * height), below};
  Site site(*setup.device, chute_soils(setup.soil), cell, chute_site(setup, bed, gap));
  ChuteShape shape;
  shape.half = chute_half(cell), shape.gap = gap;
  scene::Shell walls;
  {
    const double y0 = -shape.half, y1 = gap + shape.half, x0 = -bed.back - 3 * cell, x1 = bed.ahead + 3 * cell,
                 z0 = -below - 3 * cell, z1 = 4 * cell;
    walls.name = "plates";
    walls.half_thickness = shape.half;
    walls.vertices = {{x0, y0, z0}, {x1, y0, z0}, {x1, y0, z1}, {x0, y0, z1},
                      {x0, y1, z0}, {x1, y1, z0}, {x1, y1, z1}, {x0, y1, z1}};
    walls.triangles = {{0, 2, 1}, {0, 3, 2}, {4, 5, 6}, {4, 6, 7}};
  }
  site.add_tool(walls, make_pose(0, chute_offset(cell), 0));
  const auto keep = [foot](const Vec3& p) { return p.x() > 0 || p.z() < -foot; };
  const auto surface = [foot](double x, double) { return x > 0 ? 0.0 : -foot; };
  site.solver().insert(chute_fill(site, bed, gap, false, keep, surface));
  std::vector<Vec3> start;
  for (const soil::Particle& p : site.solver().particles()) start.push_back(site.position(p));
  site.run(setup["time"]);
  site.finish(report);
  return face_motion(site, height, start) / height;
}

Report run(const Setup& setup) {
  const scene::Soil& s = setup.soil;
  const double weight = s.bank_density * kGravity;
  const double safe = cut_no_tension_height(s.friction_angle, s.cohesion, weight),
               critical = cut_critical_height(s.friction_angle, s.cohesion, weight);
  const double share = setup["limit"];
  Report report;
  Series heights{"height", "m", {}}, motions{"motion over height", "", {}};
  const auto moved = [&](double height) {
    height = std::round(height / setup.cell) * setup.cell;  // whole cells
    const double motion = try_cut(setup, height, report);
    heights.values.push_back(height);
    motions.values.push_back(motion);
    if (setup.progress) setup.progress(std::min(0.99, heights.values.size() / (2 + setup["trials"])));
    return motion;
  };
  const double low = moved(0.9 * safe), high = moved(1.25 * critical);
  report.add("motion at 0.9 of the no-tension height", 100 * low, "% of H", 0, kNone, 100 * share,
             "stands; VALIDATION 1");
  report.add("motion at 1.25 Hc", 100 * high, "% of H", kNone, 100 * share, kNone, "fails; VALIDATION 1");
  double stands = 0.9 * safe, fails = 1.25 * critical;
  for (int i = 0; i < setup.whole("trials"); ++i) {
    const double middle = 0.5 * (stands + fails);
    (moved(middle) < share ? stands : fails) = middle;
  }
  const double height = 0.5 * (stands + fails);
  report.add("highest cut that stands over Hc", height / critical, "", 1, kNone, kNone,
             "aim: 0.8; Hc = 3.83 c / gamma tan(45 + phi/2)");
  report.note("highest cut that stands", height, "m");
  report.series = {heights, motions};
  return report;
}

}  // namespace

Rig cut() {
  Rig rig;
  rig.name = "cut";
  rig.summary = "vertical cut in cohesive soil: the height that stands";
  rig.drawing =
      "Cohesive soil between smooth plates with an upright free face, at rest under its own weight without support of "
      "the face, is let go for `time`. It stands when the upper half of the soil within half a height of the face has "
      "moved less than `limit` heights in the mean. Tried are 0.9 of the height that holds without tension, 1.25 Hc, "
      "and "
      "`trials` halvings between.";
  rig.parameters = {{"time", 1.5, "s", "of each trial"},
                    {"trials", 3, "", "halvings between the two heights"},
                    {"limit", 0.05, "heights", "of motion that count as failure"},
                    {"back", 1.5, "heights", "of soil behind the face"},
                    {"front", 0.6, "heights", "of ground in front of it"},
                    {"below", 0.4, "heights", "of soil under the foot"}};
  rig.default_soil = cohesive(30, 5000);
  rig.default_soil.bank_density = 18000 / kGravity;
  rig.run = run;
  return rig;
}

}  // namespace navvy::lab
