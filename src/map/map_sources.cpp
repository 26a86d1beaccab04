// SPDX-License-Identifier: Apache-2.0
#include "map/map_sources.h"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <memory>
#include <optional>
#include <span>
#include <unordered_map>
#include <utility>

#include "core/error.h"
#include "heightfield/make_ground.h"
#ifdef NAVVY_WITH_GDAL
#include "heightfield/gdal/band.h"
#endif

namespace navvy::map {
namespace {

using heightfield::Ground;

/// Height [m] that two roundings to whole quanta of mass may make: 2^-24 kg are 1e-8 m of any soil
/// in columns of 0.05 m.
constexpr double kQuanta = 1e-7;

/// Builds the site again with its surface from `file`. A run writes its whole site, so the cells of
/// the file are the columns.
Ground reread(const scene::Scene& scene, const Ground& start, const std::string& file) {
  scene::Scene end = scene;
  end.ground.file = file;
  end.ground.has_at = end.ground.at_is_local = false;
  end.ground.size = start.cell() * Vec2(start.nx(), start.ny());
  // Heights are taken as they are, also where they were steeper than repose.
  end.ground.steep = scene::SteepGround::kHold;
  end.ground.features.clear();
  Ground ground = heightfield::make_ground(end);
  const heightfield::GroundSetup &a = start.setup(), &b = ground.setup();
  // A micrometre at an easting of millions; a hundredth of a cell catches any other site.
  const double tolerance = 0.01 * a.cell / a.file_unit;
  if (a.nx == b.nx && a.ny == b.ny && std::abs(a.easting - b.easting) < tolerance &&
      std::abs(a.northing - b.northing) < tolerance)
    return ground;
  throw InputError(Fault{Fault::Severity::kError, file, 0, "map",
                         std::to_string(b.nx) + " x " + std::to_string(b.ny),
                         "the scene's site has " + std::to_string(a.nx) + " x " +
                             std::to_string(a.ny) + " columns, or is elsewhere",
                         "a run's folder holds both: scene.sdf and terrain_end.tif"});
}

/// State of a site at the end of a run, as far as the run's files hold it: heights, and the depth
/// of the soil that rested on the columns as particles, in the few tiles that have any.
class RunColumns final : public SiteColumns {
 public:
  /// Reads no loose soil where `terrain_end` is empty.
  RunColumns(const heightfield::TerrainView& end, std::shared_ptr<const MapOptions> options,
             heightfield::TerrainView start, const std::string& terrain_end)
      : SiteColumns(end, std::move(options)),
        start_(std::move(start)),
        across_((start_.nx() + kSide - 1) / kSide) {
    if (terrain_end.empty()) return;
#ifdef NAVVY_WITH_GDAL
    const auto keep = [&](int iy, std::span<const float> depths) {
      for (std::size_t x = 0; x < depths.size(); ++x)
        if (depths[x] > 0) add(static_cast<int>(x), iy, depths[x]);
    };
    heightfield::read_band(terrain_end, info(MapLayer::kLooseDepth).name, start_.nx(), start_.ny(),
                           keep);
#endif
  }

  bool knows(LayerNeeds needs) const override {
    return needs != LayerNeeds::kSoilState && SiteColumns::knows(needs);
  }
  double start_height(int ix, int iy) const override { return start_.height(ix, iy); }
  float loose_depth(int ix, int iy) const override {
    const auto found = tiles_.find(tile_of(ix, iy));
    return found != tiles_.end() ? found->second[place(ix, iy)] : 0.0f;
  }

 private:
  static constexpr int kSide = LayerTiles::kSide;
  int tile_of(int ix, int iy) const { return iy / kSide * across_ + ix / kSide; }
  static std::size_t place(int ix, int iy) {
    return static_cast<std::size_t>(iy % kSide * kSide + ix % kSide);
  }
  void add(int ix, int iy, float depth) {
    std::vector<float>& tile = tiles_[tile_of(ix, iy)];
    if (tile.empty()) tile.assign(static_cast<std::size_t>(kSide) * kSide, 0.0f);
    tile[place(ix, iy)] = depth;
  }

  heightfield::TerrainView start_;
  int across_;
  std::unordered_map<int, std::vector<float>> tiles_;
};

/// Returns the limits of the first machine that gives some.
TraversabilityLimits limits_for(const scene::Scene& scene) {
  for (const scene::MachineInWorld& placed : scene.machines)
    if (placed.machine.traversability.given) return limits_of(placed.machine);
  return {};
}

/// Returns true when one of the layers needs this knowledge.
bool any_needs(const std::vector<MapLayer>& layers, LayerNeeds needs) {
  return std::any_of(layers.begin(), layers.end(),
                     [&](MapLayer layer) { return info(layer).needs == needs; });
}

}  // namespace

TraversabilityLimits limits_of(const scene::Machine& machine) {
  const scene::Traversability& own = machine.traversability;
  return {own.slope, own.step_height, own.roughness, own.window};
}

// Clients that have the design pass it, because computing it again costs a pass over the site.
MapOptions options_for(const scene::Scene& scene, const heightfield::Terrain& site,
                       std::vector<MapLayer> layers, const heightfield::DesignSurface* design) {
  MapOptions out{std::move(layers), limits_for(scene), {}};
  // A float per column: only where a layer needs it.
  if (!any_needs(out.layers, LayerNeeds::kDesign)) return out;
  std::optional<heightfield::DesignSurface> made;
  if (design == nullptr && (made = heightfield::make_design(scene, site))) design = &*made;
  if (design != nullptr) out.target = design->over(site.nx(), site.ny());
  return out;
}

TerrainMap map_of_site(const Ground& site, const MapOptions& options,
                       heightfield::OccupiedAreas areas) {
  MapMaker maker(options);
  maker.update(site.view().with(std::move(areas)));
  return maker.map();
}

// The file holds rounded heights. A column whose difference from the start is within the rounding
// keeps the exact height of the start, so that untouched ground shows no cut and no fill.
TerrainMap map_of_run(const scene::Scene& scene, const Ground& start,
                      const std::string& terrain_end, const MapOptions& options,
                      heightfield::OccupiedAreas areas) {
  if (!std::filesystem::is_regular_file(terrain_end))
    throw FileError(
        "cannot read '" + terrain_end +
        "': no such file; a run writes it at its end, until then there are snapshots (--snapshot)");
  const auto end = std::make_shared<const Ground>(reread(scene, start, terrain_end));
  const heightfield::TerrainView before = start.view();
  // W's zero of a site from a file is one of the file's heights, and those have changed.
  const double shift = end->setup().height_offset - start.setup().height_offset;
  const double unit = start.setup().file_height_unit, offset = start.setup().height_offset;
  heightfield::GroundSetup setup = start.setup();
  // Asked for as long as the map lives: it computes columns when a reader wants them.
  setup.surface = [end, before, shift, unit, offset](int ix, int iy) {
    const double z = before.height(ix, iy), now = end->height(ix, iy) + shift;
    // What differs by no more than the file's rounding, and that of two grounds to quanta of mass,
    // was not touched.
    const auto as_written = static_cast<float>((z + offset) / unit);
    const double rounding =
        static_cast<double>(std::nextafter(std::abs(as_written), INFINITY) - std::abs(as_written));
    return std::abs(now - z) <= rounding * unit + kQuanta ? z : now;
  };
  // No one has dug the ground of these heights: what a run changed is the heights themselves.
  const auto shared = std::make_shared<const MapOptions>(options);
  const bool loose = any_needs(options.layers, LayerNeeds::kLooseSoil);
  const heightfield::TerrainView view = Ground(setup).view(std::nan("")).with(std::move(areas));
  return make_map(
      std::make_shared<const RunColumns>(view, shared, before, loose ? terrain_end : ""), 1);
}

bool unknown_everywhere(const TerrainMap& map, MapLayer layer) {
  if (!map.has(layer)) return true;
  constexpr int kSide = LayerTiles::kSide;
  const LayerTiles& tiles = map.tiles(layer);
  // 16 KiB, which would be much for a stack.
  const auto buffer = std::make_unique<LayerTiles::Values>();
  for (int ty = 0; ty * kSide < map.ny(); ++ty)
    for (int tx = 0; tx * kSide < map.nx(); ++tx) {
      const float* values = tiles.passing(tx, ty, *buffer);
      if (values == nullptr) continue;
      for (int y = 0; y < std::min(kSide, map.ny() - ty * kSide); ++y)
        for (int x = 0; x < std::min(kSide, map.nx() - tx * kSide); ++x)
          if (values[y * kSide + x] == values[y * kSide + x]) return false;
    }
  return true;
}

}  // namespace navvy::map
