// SPDX-License-Identifier: Apache-2.0
#include "lab/rigs/blade_bed.h"

#include <cmath>

#include "lab/theory/earth_pressure.h"

namespace navvy::lab {

BladeCase blade_case(const Setup& setup, double rake, double depth, double width) {
  const scene::Soil& s = setup.soil;
  BladeCase out;
  out.phi = s.friction_angle, out.delta = s.tool_friction_angle, out.rake = rake;
  out.depth = depth, out.width = width;
  // Cohesion that softens is gone where the tool has been, so it is no reference.
  out.unit_weight = s.bank_density * kGravity, out.cohesion = s.residual_cohesion,
  out.adhesion = s.adhesion;
  return out;
}

Reference upright_reference(const BladeCase& blade) {
  Reference out;
  out.rough = blade.delta > 0 || blade.adhesion > 0;
  if (!out.rough) {
    out.expected = out.low = out.high =
        blade.width *
        rankine_passive_force(blade.phi, blade.cohesion, blade.unit_weight, blade.depth);
    out.source = "smooth and upright: [Rankine 1857]";
    return out;
  }
  const PassiveBand band = rough_passive(blade);
  out.expected = out.low = band.low, out.high = band.high, out.vertical = -band.vertical;
  // Both bounds are named, so that the reference of a rough tool is clear.
  out.source =
      "rough: slip lines [Sokolovskii 1965], weight from [Lancellotta 2002] to log spiral [Caquot "
      "1948]";
  return out;
}

bool ahead_of_blade(const Vec3& p, double depth, double rake, double cell) {
  // Under the edge everything is soil; above it only what lies ahead of the face.
  return p.z() < -depth || p.x() + (p.z() + depth) / std::tan(rake) > 0.1 * cell / std::sin(rake);
}

std::function<double(double, double)> trench(double depth) {
  return [depth](double x, double) { return x > 0 ? 0.0 : -depth; };
}

Report finish_blade(Site& site, const ToolDriver& driver, Report report) {
  report.add("particles through the blade",
             static_cast<double>(site.solver().stats().shell_crossings), "", 0, kNone, 0,
             "none may pass; summed over steps [docs/validation.md, Blades and earth pressure]");
  report.note("momentum residual", site.worst_residual(), "", "of the sum of impulses; 1e-5");
  driver.write(report, 20);
  site.finish(report);
  return report;
}

}  // namespace navvy::lab
