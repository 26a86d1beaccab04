// SPDX-License-Identifier: Apache-2.0
// Builds a ground from a scene: checks the numbers, takes the surface from shapes or from a map,
// and settles it if requested.
#include "heightfield/make_ground.h"

#include <algorithm>
#include <cmath>
#include <memory>

#include "core/error.h"
#include "core/log.h"
#include "core/long_work.h"
#include "heightfield/map_files/import.h"
#include "heightfield/procedural.h"
#include "heightfield/settle.h"

namespace navvy::heightfield {
namespace {

// Settled slopes end a little below the friction angle, so that the running simulation does not
// move them.
constexpr double kSettleMargin = radians(1.0);
constexpr double kThinnest = 0.01;  // [m] of soil over a rock that the scene gives

[[noreturn]] void fail(const scene::Scene& world, const std::string& element,
                       const std::string& value, const std::string& rule,
                       const std::string& remedy) {
  throw InputError(Fault{Fault::Severity::kError, world.file, 0, element, value, rule, remedy});
}

// Returns the friction angle of the soil at the surface of the site.
double surface_friction(const scene::Scene& world) {
  for (const scene::GroundLayer& layer : world.ground.layers)
    if (const int i = world.soil_index(layer.soil); i >= 0) return world.soils[i].friction_angle;
  return scene::Soil().friction_angle;
}

// Limits are checked first, because a wrong unit would otherwise allocate far too much memory.
void check_size(const scene::Scene& world) {
  const Vec2& size = world.ground.size;
  const double cell = world.solver.cell;
  if (!std::isfinite(cell) || !(cell > 0))
    fail(world, "soil cell", std::to_string(cell), "must be a finite length > 0 m",
         "0.05 to 0.2 m is usual");
  // 2^30 columns per side fit into an int index.
  if (!size.allFinite() || !(size.minCoeff() > 0) || size.maxCoeff() / cell > (1 << 30))
    fail(world, "terrain/size", std::to_string(size.x()) + " " + std::to_string(size.y()),
         "must be two finite lengths > 0 m", "give the extent of the site in metres");
  if (!std::isfinite(world.ground.depth) || !(world.ground.depth > 0))
    fail(world, "terrain/depth", std::to_string(world.ground.depth),
         "must be a finite length > 0 m", "a few metres of soil below the deepest dig");
}

// Replaces the source by its settled copy.
void settle_site(const scene::Scene& world, Ground::Setup& setup) {
  if (static_cast<std::int64_t>(setup.nx) * setup.ny > kMostSettledColumns)
    fail(world, "terrain/steep", "settle",
         "needs the whole surface in memory: at most " + std::to_string(kMostSettledColumns) +
             " columns, this site has " +
             std::to_string(static_cast<std::int64_t>(setup.nx) * setup.ny),
         "choose a smaller size, a larger cell or steep = hold");
  // The only case in which a whole surface is kept; all copies of the source share it.
  auto dense = std::make_shared<DenseSurface>();
  dense->nx = setup.nx;
  dense->ny = setup.ny;
  dense->cell = setup.cell;
  dense->height.resize(static_cast<std::size_t>(setup.nx) * setup.ny);
  for (int iy = 0; iy < setup.ny; ++iy)
    for (int ix = 0; ix < setup.nx; ++ix) dense->at(ix, iy) = setup.surface(ix, iy);
  if (settle(*dense, std::max(surface_friction(world) - kSettleMargin, 0.0)) < 0)
    log_warning(
        "terrain: slopes above repose had not come to rest; the rest of them is held until "
        "touched");
  setup.surface = [dense](int ix, int iy) { return dense->at(ix, iy); };
}

// The shapes are copied into the source, so that the ground outlives the scene.
void make_procedural(const scene::Scene& world, Ground::Setup& setup) {
  const ProceduralSurface surface(world.ground, surface_friction(world));
  const Vec2 origin = setup.origin;
  const double cell = setup.cell;
  setup.surface = [surface, origin, cell](int ix, int iy) {
    return surface(origin.x() + (ix + 0.5) * cell, origin.y() + (iy + 0.5) * cell);
  };
  // The datum is common to all columns, so it is bounded over the whole site, centre to centre.
  const Vec2 half = Vec2::Constant(cell / 2);
  const double lowest =
      surface.lower_bound(origin + half, origin + cell * Vec2(setup.nx, setup.ny) - half);
  setup.datum = bedrock(world, lowest);
  // Without file coordinates, exports are in W.
  setup.easting = origin.x();
  setup.northing = origin.y();
}

}  // namespace

double bedrock(const scene::Scene& world, double lowest) {
  if (!world.ground.has_rock) return lowest - world.ground.depth;
  if (world.ground.rock > lowest - kThinnest)
    fail(world, "terrain/rock", std::to_string(world.ground.rock),
         "the plane of the rock must be below the whole surface, whose lowest point is " +
             std::to_string(lowest) + " m",
         "lower the plane by its <pose>, or remove it and give depth_m");
  return world.ground.rock;
}

int site_columns(double length, double cell) {
  // A length that is a whole number of cells up to rounding gets no further cell.
  const int n = static_cast<int>(std::ceil(length / cell - 1e-6));
  return std::max((n + 3) / 4 * 4, 4);
}

// Faults of size, place and layers are found before a map is read, because that may take seconds.
Ground make_ground(const scene::Scene& world, std::string* report) {
  const LongWork work("the columns of the ground were being made");
  // Sizes come first, because everything else is counted in columns.
  check_size(world);
  const scene::StartGround& ground = world.ground;
  Ground::Setup setup;
  setup.cell = world.solver.cell;
  setup.nx = site_columns(ground.size.x(), setup.cell);
  setup.ny = site_columns(ground.size.y(), setup.cell);
  // The middle of the site is W (0, 0) unless the scene gives an origin.
  setup.origin =
      ground.has_origin ? ground.origin : Vec2(-0.5 * setup.cell * Vec2(setup.nx, setup.ny));
  setup.soils = world.soils;
  setup.layers = ground.layers;
  setup.patches = ground.patches;
  if (ground.file.empty()) {
    make_procedural(world, setup);
    if (report != nullptr) report->clear();
  } else {
    const TerrainReport found = import_terrain(world, setup);
    if (const std::string warning = found.warning(); !warning.empty()) log_warning(warning);
    if (report != nullptr) *report = found.text();
  }
  // Done last, because it needs the finished surface.
  if (ground.steep == scene::SteepGround::kSettle) settle_site(world, setup);
  return Ground(std::move(setup));
}

}  // namespace navvy::heightfield
