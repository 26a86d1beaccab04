// SPDX-License-Identifier: Apache-2.0
// Coordinates are those of the site: a design in another CRS would be misplaced, so it is refused.
#include "heightfield/map_files/import_design.h"

#include <algorithm>
#include <cmath>

#include "heightfield/map_files/map_file.h"
#include "heightfield/span_text.h"
#ifdef NAVVY_WITH_GDAL
#include "heightfield/gdal/gdal_raster.h"
#endif

namespace navvy::heightfield {
namespace {

std::string name_of(const std::string& wkt) {
  const std::size_t begin = wkt.find('"'), end = wkt.find('"', begin + 1);
  return end == std::string::npos ? "none" : wkt.substr(begin + 1, end - begin - 1);
}

/// Two CRS are equal when their horizontal parts are; a file without one is assumed to use the CRS
/// of the site.
void require_same_crs(const MapFile& map, const GroundSetup& setup) {
  if (map.crs_wkt.empty() && setup.file_unit != 1)
    map.fail("CRS", "none",
             "the site counts in units of " + number_text(setup.file_unit) +
                 " m, this file does not say",
             "assign the site's CRS: gdal_translate -a_srs EPSG:CODE IN OUT.tif");
  if (map.crs_wkt.empty()) return;
  if (setup.crs_wkt.empty())
    map.fail(
        "CRS", name_of(map.crs_wkt), "the site has no CRS, so the two cannot be laid together",
        "give the ground's map its CRS too, or take this file's away: " + map.edit("-a_srs \"\""));
#ifdef NAVVY_WITH_GDAL
  const bool same = same_crs(map.crs_wkt, setup.crs_wkt);
#else
  // Without GDAL nothing knows that two texts mean the same.
  const bool same = map.crs_wkt == setup.crs_wkt;
#endif
  if (!same)
    map.fail("CRS", name_of(map.crs_wkt), "the site's map is in " + name_of(setup.crs_wkt),
             "reproject it: gdalwarp -t_srs EPSG:CODE IN OUT.tif, with the code of the site's CRS");
}

/// Returns the bilinear height; where a neighbour is a gap, that of the cell that holds the place.
double sample(const HeightRaster& raster, const Vec2& p, double edge) {
  const double z = raster.mean(p.x(), p.y(), edge);
  if (z == z) return z;
  const auto cell = [](double x, double x0, double step, int n) {
    return std::clamp(static_cast<int>(std::lround((x - x0) / step)), 0, n - 1);
  };
  return static_cast<double>(raster.at(cell(p.x(), raster.x0, raster.cell_x, raster.nx),
                                       cell(p.y(), raster.y0, raster.cell_y, raster.ny)));
}

}  // namespace

DesignSurface import_design(const scene::Scene& scene, const scene::Design& design,
                            const Terrain& site) {
  const GroundSetup& setup = site.setup();
  scene::RasterScale scale = design.scale;
  if (!scale.has_corner) scale.corner = Vec2(setup.easting, setup.northing);
  MapFile map({design.file, "navvy:design", scene.file, design.file_line}, scale);
  require_same_crs(map, setup);
  // Corner of the site in metres from that of the map.
  const TerrainReport& report = map.report;
  const Vec2 corner = (Vec2(setup.easting, setup.northing) - report.file_min) * report.metres;
  const Vec2 extent = (report.file_max - report.file_min) * report.metres;
  const Vec2 size = setup.cell * Vec2(setup.nx, setup.ny);
  const Vec2 low = corner.cwiseMax(0), high = extent.cwiseMin(corner + size);
  if (!((high - low).array() > 0).all()) {
    const Vec2 at(setup.easting, setup.northing);
    map.fail(
        "", span_text(report.file_min, report.file_max),
        "does not overlap the site, which reaches over " + span_text(at, at + size / report.metres),
        "give both in the same coordinates; a procedural site counts in W");
  }
  const HeightRaster raster = read_heights(map, low, high - low);
  const double shift = report.height_offset - setup.height_offset;
  // Columns whose centres lie on the map.
  const auto from =
      ((low - corner) / setup.cell - Vec2(0.5, 0.5)).array().ceil().cast<int>().max(0).eval();
  const auto to =
      ((high - corner) / setup.cell - Vec2(0.5, 0.5)).array().floor().cast<int>().eval();
  DesignSurface out;
  out.rect = {from.x(), from.y(), std::min(to.x() + 1, setup.nx), std::min(to.y() + 1, setup.ny)};
  out.z.reserve(static_cast<std::size_t>(out.rect.area()));
  for (int iy = out.rect.y0; iy < out.rect.y1; ++iy)
    for (int ix = out.rect.x0; ix < out.rect.x1; ++ix)
      out.z.push_back(static_cast<float>(
          sample(raster, corner + setup.cell * Vec2(ix + 0.5, iy + 0.5) - low, setup.cell) +
          shift));
  return out;
}

}  // namespace navvy::heightfield
