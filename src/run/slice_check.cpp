// SPDX-License-Identifier: Apache-2.0
#include "run/slice_check.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <iterator>
#include <string>
#include <string_view>

namespace navvy::run {
namespace {

/// Fewest cells per depth of cut without a warning.
constexpr double kEnough = 4;

/// measured: `navvy lab blade --speed 0.15 --cell 0.3,0.15,0.1,0.075,0.05`, force / [Rankine 1857].
struct Share {
  double cells, share;
};
constexpr Share kShares[] = {{1, 0.58}, {2, 0.85}, {3, 0.93}, {4, 0.96}, {6, 0.99}};

/// Equal slices of a cut.
struct Slices {
  double depth = 0;  ///< depth of the whole cut [m]; 0: the step has no slices
  double each = 0;   ///< thickness of one slice [m]
};

Slices slices_of(const scene::ProgramStep& step) {
  double depth = 0, pass = 0;
  for (const scene::NamedNumber& number :
       scene::numbers_of([&step](scene::Fields& f) { step.describe(f); })) {
    if (std::string_view(number.name) == "depth_m") depth = *number.value;
    if (std::string_view(number.name) == "pass_depth_m") pass = *number.value;
  }
  if (!(depth > 0 && pass > 0)) return {};
  // Rounding must not cut a whole number of passes once more.
  return {depth, depth / std::ceil(depth / pass - 1e-9)};
}

/// Returns the warning for slices in cells of `cell` [m], without its place.
Fault warning_of(const Slices& slices, double cell) {
  const double cells = slices.each / cell, passes = std::floor(slices.depth / (kEnough * cell));
  char rule[200], thicker[80] = "", remedy[200];
  std::snprintf(rule, sizeof rule,
                "is %.1f cells deep: a flat blade meets about %.0f %% of its force there, and %.0f "
                "cells or more are advised",
                cells, 100 * force_share(cells), kEnough);
  // A cut that is thinner in all has no thicker slices.
  if (passes > 0)
    std::snprintf(thicker, sizeof thicker, "pass_depth_m of %.3g, or ", slices.depth / passes);
  std::snprintf(remedy, sizeof remedy, "%scell_m of the solver at most %.3g", thicker,
                slices.each / kEnough);
  Fault out;
  out.severity = Fault::Severity::kWarning;
  out.value = scene::short_text(slices.each, 3) + " m";
  out.rule = rule;
  out.remedy = remedy;
  return out;
}

}  // namespace

double force_share(double cells) {
  const Share* high = std::begin(kShares) + 1;
  while (std::next(high) != std::end(kShares) && cells > high->cells) ++high;
  const Share& low = *std::prev(high);
  const double part = (cells - low.cells) / (high->cells - low.cells);
  return std::clamp(low.share + part * (high->share - low.share), 0.0, 1.0);
}

std::vector<Fault> check_slices(const scene::Scene& scene) {
  std::vector<Fault> faults;
  for (const scene::MachineInWorld& placed : scene.machines)
    for (std::size_t i = 0; i < placed.program.steps.size(); ++i) {
      const Slices slices = slices_of(placed.program.steps[i]);
      // Rounding of 4 x 0.1 m is no thin slice.
      if (!(slices.each > 0) || slices.each > kEnough * scene.solver.cell * (1 - 1e-9)) continue;
      Fault fault = warning_of(slices, scene.solver.cell);
      fault.file = scene.file;
      fault.line = i < placed.program.lines.size() ? placed.program.lines[i] : 0;
      fault.element = placed.name + "/navvy:program/step " + std::to_string(i + 1) + "/" +
                      placed.program.steps[i]->element() + "/slice";
      faults.push_back(std::move(fault));
    }
  return faults;
}

}  // namespace navvy::run
