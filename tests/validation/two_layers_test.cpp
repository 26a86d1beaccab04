// SPDX-License-Identifier: Apache-2.0
// scenarios/two_layers.sdf from start to end: the trench goes through topsoil into loam, each with
// its own ledger.
#include <gtest/gtest.h>

#include <algorithm>
#include <string>

#include "record/summary.h"
#include "validation/report.h"
#include "validation/scenes.h"
#include "validation/trench_measure.h"

namespace navvy::validation {
namespace {

constexpr const char* kSource = "two layers [docs/validation.md, Whole digs]";

/// Returns the volume that the cut removed from the uppermost `cap` [m] of all dug columns [m3].
double cut_above(const heightfield::Ground& ground, double cap) {
  double sum = 0;
  for (int iy = 0; iy < ground.ny(); ++iy)
    for (int ix = 0; ix < ground.nx(); ++ix) {
      const double cut = ground.start_height(ix, iy) - ground.height(ix, iy);
      if (cut > 0.5 * ground.cell()) sum += std::min(cut, cap);  // less is a rut
    }
  return sum * ground.cell() * ground.cell();
}

TEST(TwoLayers, AreDugAndDumpedEachWithItsOwnLedger) {
  session::Session session(load_scene("two_layers.sdf"), shared_device());
  const sim::World& world = session.world();
  const scene::Scene& description = world.description();
  while (!session.done()) session.step();
  const control::Dig dig = dig_step(description);
  const TrenchMeasure trench = measure(world.ground(), dig);
  const record::Earthwork earth = record::measure_earthwork(world);
  const sim::MassLedger ledger = world.soil().mass_ledger();
  const double cap = description.ground.layers.at(0).thickness;
  // Dug volume, each soil at its own loose density [m3].
  double swelled = 0;
  for (std::size_t i = 0; i < 2; ++i) {
    const scene::Soil& soil = description.soils.at(i);
    const record::SoilMoved& moved = earth.soils.at(i);
    swelled += moved.dug / soil.bank_density * soil.swell;
    expect_between(soil.name + ": spoil / dug mass", moved.spoil / moved.dug, 0.99, 1.01, kSource);
    const std::int64_t error =
        ledger.columns[i] + ledger.particles[i] + ledger.left_site[i] - ledger.inserted[i];
    expect_between(soil.name + ": ledger error [units]", static_cast<double>(error), 0, 0, kSource);
  }
  // Below the border, loose soil of both kinds covers the floor, so that the shape of the cut no
  // longer shows the dug volume.
  expect_between(
      "topsoil dug / cut above the border, by mass",
      earth.soils[0].dug / (cut_above(world.ground(), cap) * description.soils[0].bank_density),
      0.95, 1.05, kSource);
  expect_between("spoil volume / dug volume with each soil's swell", earth.loose_volume / swelled,
                 0.95, 1.05, kSource);
  expect_between("floor within 0.10 m, share of length", trench.floor_share, 0.8, 1.0,
                 "the trench [docs/validation.md, Whole digs]");
  expect_between("shell crossings", static_cast<double>(world.soil().counts().shell_crossings), 0,
                 0, kSource);
  std::printf("%zu cycles, %.0f s simulated, %.2f m3 bank, %.2f m3 loose, %.0f and %.0f kg dug\n",
              session.cycles().size(), world.time(), earth.bank_volume, earth.loose_volume,
              earth.soils[0].dug, earth.soils[1].dug);
}

}  // namespace
}  // namespace navvy::validation
