// SPDX-License-Identifier: Apache-2.0
// Maps of a dig that is stopped in the middle agree with the ledger.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <numeric>
#include <utility>

#include "device/device.h"
#include "map/map_maker.h"
#include "record/earthwork.h"
#include "session/session.h"
#include "sim/scenes.h"
#include "sim/world_terrain.h"
#include "values.h"

namespace navvy::session {
namespace {

double kilograms_of(const std::vector<std::int64_t>& masses) {
  return kilograms(std::accumulate(masses.begin(), masses.end(), std::int64_t{0}));
}

/// Volume change of the columns' layers, from masses and density states only [m3].
double column_volume_change(const sim::World& world) {
  const heightfield::Ground& ground = world.ground();
  double sum = 0;
  std::vector<heightfield::SoilLayer> layers;
  for (int iy = 0; iy < ground.ny(); ++iy)
    for (int ix = 0; ix < ground.nx(); ++ix) {
      const auto add = [&](double sign) {
        for (const heightfield::SoilLayer& layer : layers)
          sum += sign * kilograms(layer.mass) * static_cast<double>(layer.specific_volume) /
                 world.description().soils[layer.soil].bank_density;
      };
      ground.column(ix, iy, layers);
      add(1);
      ground.start_column(ix, iy, layers);
      add(-1);
    }
  return sum;
}

struct MapVolume {
  double cut = 0, fill = 0;  ///< below and above the start [m3]
};

MapVolume volume_of(const heightfield::TerrainView& terrain) {
  const auto values = [&](map::MapLayer layer) {
    return map::layer_values(terrain, layer, terrain.site_rect());
  };
  const std::vector<float> change = values(map::MapLayer::kChange);
  const double area = terrain.cell() * terrain.cell();
  MapVolume out;
  for (const float rise : change)
    (rise < 0 ? out.cut : out.fill) += area * std::abs(static_cast<double>(rise));
  return out;
}

/// Compares heights of the map with those of columns and the mass that rests on each.
void expect_columns_and_what_lies(const heightfield::Terrain& map,
                                  const heightfield::Terrain& columns,
                                  const std::vector<heightfield::LooseGrain>& grains,
                                  double bank_density) {
  const auto place = [&](int ix, int iy) {
    return static_cast<std::size_t>(iy) * columns.nx() + ix;
  };
  std::vector<double> lying(static_cast<std::size_t>(columns.nx()) * columns.ny());
  const double area = columns.cell() * columns.cell();
  for (const heightfield::LooseGrain& grain : grains)
    lying.at(place(grain.ix, grain.iy)) +=
        kilograms(grain.mass) * static_cast<double>(grain.specific_volume) / bank_density / area;
  double squares = 0, highest = -1;
  for (int iy = 0; iy < columns.ny(); ++iy)
    for (int ix = 0; ix < columns.nx(); ++ix) {
      const double over = map.height(ix, iy) - columns.height(ix, iy) - lying[place(ix, iy)];
      squares += over * over;
      highest = std::max(highest, over);
    }
  // Tolerances of a quarter of a cell; sums of floats in another order differ by far less.
  EXPECT_LT(std::sqrt(squares / static_cast<double>(lying.size())), 0.25 * columns.cell());
  EXPECT_LT(highest, 1e-4) << "higher than its soil [m]";
}

struct Omitted {
  double gain = 0;  ///< mass that came to the omitted columns less what left them [kg]
  double loss = 0;  ///< mass that left some of them [kg]
};

/// Sums the changes of mass in columns that changed by less than a twentieth of a cell of soil 0.
Omitted omitted_from_earthwork(const sim::World& world,
                               const std::vector<heightfield::LooseGrain>& grains) {
  const heightfield::Ground& ground = world.ground();
  const double least = 0.05 * std::pow(ground.cell(), 3) * ground.setup().soils[0].bank_density;
  std::map<std::pair<int, int>, double> lying;
  for (const heightfield::LooseGrain& grain : grains)
    lying[{grain.ix, grain.iy}] += kilograms(grain.mass);
  Omitted sum;
  std::vector<heightfield::SoilLayer> layers;
  for (int iy = 0; iy < ground.ny(); ++iy)
    for (int ix = 0; ix < ground.nx(); ++ix) {
      const auto found = lying.find({ix, iy});
      double change = found == lying.end() ? 0 : found->second;
      ground.column(ix, iy, layers);
      for (const heightfield::SoilLayer& layer : layers) change += kilograms(layer.mass);
      ground.start_column(ix, iy, layers);
      for (const heightfield::SoilLayer& layer : layers) change -= kilograms(layer.mass);
      if (std::abs(change) > least) continue;
      sum.gain += change;
      if (change < 0) sum.loss -= change;
    }
  return sum;
}

TEST(MapVolume, OfADigStoppedAtTenTimesAgreesWithTheLedger) {
  device::Device device;
  Session session(sim::testing::load("bucket_path.sdf"), device);
  const sim::World& world = session.world();
  const scene::Soil& loam = world.description().soils[0];
  double deepest_columns = 0;  // excess of a map of columns over the dug volume [m3]
  // Above the ground, in it, dragging, curling, lifting, holding, over the heap, tipping, after it,
  // at rest.
  for (const double stop : {0.6, 1.5, 2.5, 3.5, 4.5, 6.0, 8.0, 11.0, 11.4, 13.0}) {
    SCOPED_TRACE(stop);
    while (world.time() < stop) session.step();
    const sim::MassLedger ledger = world.soil().mass_ledger();
    const sim::ActivePlaces active = sim::active_places(world);
    // Every unit of mass is accounted for.
    EXPECT_EQ(ledger.error, 0);
    for (std::size_t i = 0; i < ledger.particles.size(); ++i)
      EXPECT_EQ(active.resting[i] + active.held[i] + active.elsewhere[i], ledger.particles[i]);
    const double held = kilograms_of(active.held), elsewhere = kilograms_of(active.elsewhere),
                 lies = kilograms_of(active.resting);
    // The same quantity from another query.
    EXPECT_NEAR(held, world.machines().at(0).tool(0).payload(), 1e-9);

    const heightfield::TerrainView map =
        sim::terrain_view(world, heightfield::SurfaceKind::kMapped);
    const MapVolume shown = volume_of(map);
    double lying_volume = 0;
    for (const heightfield::LooseGrain& grain : active.on_ground.grains())
      lying_volume +=
          kilograms(grain.mass) * static_cast<double>(grain.specific_volume) / loam.bank_density;
    // Floats of the map round each of 4000 columns to 0.1 um: less than a thousandth of a litre.
    EXPECT_NEAR(shown.fill - shown.cut, column_volume_change(world) + lying_volume, 1e-6);
    // Column by column: the map is above the columns by the soil that rests there, and not by soil
    // in the air.
    expect_columns_and_what_lies(map, world.ground(), active.on_ground.grains(), loam.bank_density);
    // In mass: the columns lack exactly the soil that rests on them, is carried, or is in the air.
    EXPECT_NEAR(
        kilograms_of(ledger.columns) + lies + held + elsewhere + kilograms_of(ledger.left_site), 0,
        1e-9);
    // Resting soil is neither denser than compacted soil nor looser than swell allows.
    EXPECT_GE(lying_volume, 0.88 * lies / loam.bank_density);
    EXPECT_LE(lying_volume, 1.001 * loam.swell * lies / loam.bank_density);

    const record::Earthwork earth = record::measure_earthwork(world, active.on_ground);
    EXPECT_GE(earth.loose_volume, 0);
    EXPECT_GE(earth.bank_volume, 0);
    // Sums of earthwork omit columns that changed by less than a twentieth of a cell; with the mass
    // of these they agree with what is held and in the air.
    const Omitted omitted = omitted_from_earthwork(world, active.on_ground.grains());
    EXPECT_NEAR(earth.soils[0].dug - earth.soils[0].spoil - omitted.gain, held + elsewhere, 1e-6);
    // The cut on the map is the soil that was removed, swollen at most (to the floats of the map);
    // columns alone show a pit full of soil.
    EXPECT_LE(shown.cut, earth.bank_volume + omitted.loss / loam.bank_density + 1e-6);
    const MapVolume columns =
        volume_of(sim::terrain_view(world, heightfield::SurfaceKind::kColumns));
    deepest_columns = std::max(deepest_columns, columns.cut - shown.cut);
    char text[160];
    std::snprintf(
        text, sizeof text,
        "map %.4f, columns alone %.4f, dug %.4f; resting %.1f, held %.1f, elsewhere %.1f kg",
        shown.cut, columns.cut, earth.bank_volume, lies, held, elsewhere);
    std::printf("[ VALUE    ] cut [m3] at %.1f s: %s\n", stop, text);
  }
  // Otherwise the test would prove nothing.
  EXPECT_GT(deepest_columns, 0.5);
}

}  // namespace
}  // namespace navvy::session
