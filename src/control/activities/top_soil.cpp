// SPDX-License-Identifier: Apache-2.0
#include "control/activities/top_soil.h"

#include <algorithm>

#include "scene/polygon.h"

namespace navvy::control {
namespace {

// The density is that of the soil down to this depth [m].
constexpr double kRolled = 0.3;

/// Returns the density of the uppermost soil of a column [kg/m3], and 0 for bare rock.
double top_density(const std::vector<heightfield::SoilLayer>& layers,
                   const heightfield::GroundSetup& setup) {
  double mass = 0, thick = 0;
  for (auto layer = layers.rbegin(); layer != layers.rend() && thick < kRolled; ++layer) {
    const double density =
        setup.soils.at(layer->soil).bank_density / static_cast<double>(layer->specific_volume);
    const double full = kilograms(layer->mass) / (density * setup.cell * setup.cell);
    const double part = std::min(full, kRolled - thick);
    mass += part * density;
    thick += part;
  }
  return thick > 0 ? mass / thick : 0;
}

}  // namespace

TopSoil top_soil_in(const std::vector<Vec2>& polygon, const heightfield::Ground& site) {
  TopSoil out;
  double columns = 0;
  Vec2 low = polygon.front(), high = low;
  for (const Vec2& p : polygon) low = low.cwiseMin(p), high = high.cwiseMax(p);
  const Vec2i from = site.column_at(low.x(), low.y()).cwiseMax(0);
  const Vec2i to =
      site.column_at(high.x(), high.y()).cwiseMin(Vec2i(site.nx(), site.ny()) - Vec2i::Ones());
  std::vector<heightfield::SoilLayer> layers;
  for (int iy = from.y(); iy <= to.y(); ++iy)
    for (int ix = from.x(); ix <= to.x(); ++ix) {
      if (!scene::contains(polygon, site.origin() + site.cell() * Vec2(ix + 0.5, iy + 0.5)))
        continue;
      ++columns;
      out.height += site.height(ix, iy);
      site.column(ix, iy, layers);
      out.density += top_density(layers, site.setup());
    }
  if (columns > 0) out.height /= columns, out.density /= columns;
  return out;
}

void add_settlement(const TopSoil& before, const TopSoil& now, std::vector<Measurement>& account) {
  account.push_back({"density_before_kg_m3", before.density});
  account.push_back({"density_kg_m3", now.density});
  account.push_back({"settled_m", before.height - now.height});
}

}  // namespace navvy::control
