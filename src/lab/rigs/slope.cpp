// SPDX-License-Identifier: Apache-2.0
// Rig `slope`: the angle at which a long bed starts to flow, and the one at which a flowing bed
// stops.
//
// An infinite slope is the one flow with a known stress everywhere: both normal stresses are equal,
// and shear is weight x sin. Soil that neither swells nor shrinks as it shears slips at atan(sin
// phi), not at phi, which is why poured heaps of phi 35 stand at 30 degrees. The rig finds two
// angles since they could differ: starting needs the law to yield, stopping needs it to dissipate.
// Both are found by trials at fixed angles, so no rate of tilting matters.
#include <cmath>

#include "lab/lab_site.h"
#include "lab/rig_shapes.h"
#include "lab/rigs/rig_list.h"
#include "lab/soils.h"
#include "lab/theory/formulas.h"

namespace navvy::lab {
namespace {

/// Mean speed above which a bed flows [m/s]. After 1.25 s a bed 2 degrees too flat has 0.002 (its
/// ends collapse), one 0.5 degrees too steep would have 0.1.
constexpr double kFlows = 0.03;

/// A bed under tilted gravity; the middle third is read, away from the ends.
class Bed {
 public:
  Bed(const Setup& setup, double angle)
      : length_(setup["length"]), site_(smooth(setup), options(setup, angle)) {
    const double cell = setup.cell, depth = setup["depth"], gap = setup["gap"] * cell;
    scene::Shell walls = channel(1.6 * length_, gap, -6 * cell, depth + 8 * cell, false);
    // Longer than the bed at its lower end: what runs out stays between the plates.
    walls.half_thickness = 0.2 * cell;
    site_.add_tool(walls, make_pose(-0.7 * length_, -gap / 2 + 0.07 * cell, 0));
    const double y = gap / 2 - 0.25 * cell;
    auto soil = site_.fill(
        {Vec3(-length_ / 2, 0.07 * cell - y, 0), Vec3(length_ / 2, 0.07 * cell + y, depth)});
    for (soil::Particle& p : soil) stress(p, depth);
    site_.solver().insert(soil);
  }

  // The caller runs the site.
  Site& site() { return site_; }
  /// Returns the mean velocity of the middle third down the slope [m/s].
  double speed() const {
    double sum = 0, count = 0;
    for (const soil::Particle& p : site_.solver().particles()) {
      if (std::abs(site_.position(p).x()) > length_ / 6) continue;
      sum += static_cast<double>(p.v[0]);
      count += 1;
    }
    return sum / count;
  }

 private:
  /// The plates must not hold the bed back. The progress report is that of the search, not of one
  /// bed.
  static Setup smooth(Setup setup) {
    setup.soil = without_tool_friction(setup.soil);
    setup.progress = {};
    return setup;
  }
  /// Gravity is tilted, not the bed: its surface is level with the grid, so that no steps of cells
  /// roughen it.
  static SiteOptions options(const Setup& setup, double angle) {
    SiteOptions out;
    out.size = 2 * setup["length"];
    out.depth = 8 * setup.cell;
    out.gravity = kGravity * Vec3(std::sin(angle), 0, -std::cos(angle));
    return out;
  }
  /// Sets the stress of an infinite slope with equal normal stresses, the state in which coaxial
  /// soil flows.
  void stress(soil::Particle& p, double top) const {
    const double depth = top - site_.position(p).z();
    const scene::Soil& soil = site_.soil();
    const double weight = soil.bank_density * depth;
    const double bulk = soil.young_modulus / (3 * (1 - 2 * soil.poisson));
    p.j = static_cast<float>(1 + weight * site_.world().gravity.z() / bulk);
    // Shear of an infinite slope: the weight's whole component along the slope, at every depth.
    p.s[5] = static_cast<float>(weight * site_.world().gravity.x());
  }

  double length_;
  Site site_;
};

/// Returns true if a bed at rest at this angle [rad] starts to flow.
bool starts(const Setup& setup, double angle, Report& report) {
  Bed bed(setup, angle);
  bed.site().run(setup["time"]);
  bed.site().finish(report);
  return bed.speed() > kFlows;
}

/// Returns true if a bed that a steeper slope has set in motion continues at this angle without
/// slowing down.
bool goes_on(const Setup& setup, double angle, double steep, Report& report) {
  Bed bed(setup, steep);
  bed.site().run(0.25 * setup["time"]);
  bed.site().set_gravity(kGravity * Vec3(std::sin(angle), 0, -std::cos(angle)));
  bed.site().run(0.25 * setup["time"]);
  const double before = bed.speed();
  bed.site().run(0.5 * setup["time"]);
  bed.site().finish(report);
  return bed.speed() > before;
}

/// Returns the angle where `flows` changes from false to true, by bisection [rad]. Eight trials of
/// 1.25 s cost less than one slow tilt, and each starts from the same state.
template <class F>
double critical(const F& flows, double low, double high, int halvings,
                const std::function<void(int)>& tick) {
  for (int i = 0; i < halvings; ++i) {
    const double middle = 0.5 * (low + high);
    (flows(middle) ? high : low) = middle;
    tick(i);
  }
  return 0.5 * (low + high);
}

/// Two searches in sequence, each trial on a fresh bed.
Report run(const Setup& setup) {
  Report report;
  const double flow = flow_angle(setup.soil.friction_angle), width = radians(setup["search"]);
  const int halvings = setup.whole("halvings");
  const auto tick = [&](int done, int offset) {
    if (setup.progress) setup.progress((offset + done + 1.0) / (2 * halvings));
  };
  // Both searches start around the expected angle; a result at the limit of the search is visible.
  const double start = critical([&](double angle) { return starts(setup, angle, report); },
                                flow - width, flow + width, halvings, [&](int i) { tick(i, 0); });
  const double stop =
      critical([&](double angle) { return goes_on(setup, angle, flow + radians(12), report); },
               flow - width, flow + width, halvings, [&](int i) { tick(i, halvings); });
  const double expected = degrees(flow);
  // Coaxial flow without dilatancy mobilises tau / sigma_n = sin phi, less than the tan phi of a
  // slip line.
  const char* source = "atan(sin phi), zero dilatancy [docs/validation.md, Slopes, walls and cuts]";
  const char* range = "sand: no cohesion, no dilatancy, friction that knows no rate";
  const scene::Soil& s = setup.soil;
  const bool sand =
      !(s.cohesion > 0) && !(s.dilatancy_angle > 0) && !(s.fast_friction_angle > s.friction_angle);
  report
      .add("starts to flow at", degrees(start), "deg", expected, expected - 1.5, expected + 1.5,
           source)
      .holds_for(range, sand);
  report
      .add("flowing bed stops at", degrees(stop), "deg", expected, expected - 1.5, expected + 1.5,
           source)
      .holds_for(range, sand);
  report.note("angles searched to", degrees(2 * width) / std::pow(2.0, halvings + 1), "deg");
  return report;
}

}  // namespace

Rig slope_rig() {
  Rig rig;
  rig.name = "slope";
  rig.summary =
      "long slope of sand: the angle at which it starts to flow, and the one at which it stops";
  rig.drawing =
      "A bed `length` long and `depth` deep lies on rough ground between smooth plates `gap` "
      "cells apart. Both ends are free, so that only its weight drives it; gravity is tilted. It "
      "starts with the stress of an infinite slope. The mean velocity of the middle third of its "
      "length is read after `time`: the bed flows if it is above 0.03 m/s. For stopping, 12 "
      "degrees more set the bed in motion for a quarter of `time`; it continues to flow at the "
      "tested angle if it does not slow down. Both angles are found by `halvings` bisections of "
      "+-`search` degrees around atan(sin phi).";
  rig.parameters = {
      {"length", 16, "m",
       "of the bed; with 30 depths the collapse of its ends does not reach the middle", above(0)},
      {"depth", 0.5, "m", "of the bed", above(0)},
      {"gap", 3, "cells", "between the side plates", above(0)},
      {"time", 1.25, "s", "of each trial", above(0)},
      {"search", 4, "deg", "half width of the search", at_least(0)},
      {"halvings", 4, "", "of the search, each", count_from(1)}};
  rig.default_soil = clean_sand(35);
  rig.experiment = run;
  return rig;
}

}  // namespace navvy::lab
