// SPDX-License-Identifier: Apache-2.0
// Places the site on its map and computes the heights of columns from the cells of the map.
#include "heightfield/map_files/import.h"

#include <algorithm>
#include <cmath>
#include <memory>

#include "core/error.h"
#include "core/hash.h"
#include "heightfield/make_ground.h"
#include "heightfield/map_files/map_file.h"
#include "heightfield/span_text.h"

namespace navvy::heightfield {
namespace {

// Returns the lower-left corner of the site in metres from that of the map; throws when the site
// leaves the map.
Vec2 place_site(MapFile& map, const scene::StartGround& ground, Ground::Setup& setup) {
  TerrainReport& report = map.report;
  const Vec2 extent(report.cell_x * report.columns, report.cell_y * report.rows);
  // By default the site is in the middle of the map.
  Vec2 middle = 0.5 * extent;
  if (ground.has_at)
    middle = ground.at_is_local ? ground.at : Vec2((ground.at - report.file_min) * report.metres);
  const Vec2 size = setup.cell * Vec2(setup.nx, setup.ny);
  const Vec2 corner = middle - 0.5 * size;
  report.site_min = report.file_min + corner / report.metres;
  report.site_max = report.site_min + size / report.metres;
  // Rounding up to blocks may exceed the edge by up to four columns, which repeat the edge.
  const Vec2 slack = Vec2::Constant(4 * setup.cell);
  const bool inside = ((corner + slack).array() >= 0).all() &&
                      ((corner + size - slack).array() <= extent.array()).all();
  if (!inside) {
    map.fail("at", span_text(report.site_min, report.site_max),
             "the site is off the map, which reaches over " +
                 span_text(report.file_min, report.file_max) + " (" + number_text(extent.x()) +
                 " x " + number_text(extent.y()) + " m)",
             "move --at inside (local:X,Y counts metres from the map's lower-left corner) or make "
             "--size smaller");
  }
  setup.easting = report.site_min.x();
  setup.northing = report.site_min.y();
  setup.file_unit = report.metres;
  setup.file_height_unit = report.height_metres;
  return corner;
}

}  // namespace

// Small maps are held; larger ones are read in windows, with bit-identical heights.
TerrainReport import_terrain(const scene::Scene& world, Ground::Setup& setup, double held, int side,
                             MapReader reader) {
  MapFile map({world.ground.file, "terrain", world.file, world.ground.file_line},
              world.ground.scale, reader);
  setup.crs_wkt = map.crs_wkt;
  const Vec2 corner = place_site(map, world.ground, setup),
             size = setup.cell * Vec2(setup.nx, setup.ny);
  TerrainReport& report = map.report;
  for (const scene::GroundLayer& layer : world.ground.layers)
    if (const int i = world.soil_index(layer.soil); i >= 0) {
      report.repose = world.soils[static_cast<std::size_t>(i)].friction_angle;
      break;
    }
  const double cell = setup.cell;
  // Heights and slopes of the report are those of the filled map, from which the columns come. The
  // surfaces share their map, so that copies of the setup cost nothing.
  const auto surface_of = [cell](const auto& raster) {
    return [raster, cell](int ix, int iy) {
      return raster->mean((ix + 0.5) * cell, (iy + 0.5) * cell, cell);
    };
  };
  float least = 0, most = 0;
  if (static_cast<double>(cells_under(map, corner, size)) > held) {
    const auto raster = read_windows(map, corner, size, side);
    const WindowedRaster::Summary summary = raster->summary(report.repose);
    least = summary.least, most = summary.most;
    report.slope = summary.slope;
    setup.map_hash = summary.hash;
    setup.surface = surface_of(raster);
  } else {
    const auto raster = std::make_shared<HeightRaster>(read_heights(map, corner, size));
    report.nodata = fill_gaps(*raster);
    const auto [low, high] = std::minmax_element(raster->z.begin(), raster->z.end());
    least = *low, most = *high;
    report.slope = slopes(*raster, report.repose);
    StateHash heights;
    heights.bytes(raster->z.data(), raster->z.size() * sizeof(float));
    for (const double one : {raster->cell_x, raster->cell_y, raster->x0, raster->y0})
      heights.value(one);
    heights.value(raster->nx);
    setup.map_hash = heights.digest();
    setup.surface = surface_of(raster);
  }
  report.lowest = least + report.height_offset;
  report.highest = most + report.height_offset;
  report.soil_cell = setup.cell;
  if (report.site_gaps > 0) {
    setup.filled_share = report.share_filled();
    setup.filled_from = report.filled_from();
  }
  setup.height_offset = report.height_offset;
  setup.datum = bedrock(world, least);
  return report;
}

}  // namespace navvy::heightfield
