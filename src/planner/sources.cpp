// SPDX-License-Identifier: Apache-2.0
#include "planner/sources.h"

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

namespace navvy::planner {
namespace {

using heightfield::Ground;

/// Height that two roundings to whole quanta of mass may make [m]: 2^-24 kg are 1e-8 m of any soil
/// in columns of 0.05 m.
constexpr double kQuanta = 1e-7;

/// What a run's files cannot tell.
constexpr Layer kNotInFiles[] = {Layer::kSoil, Layer::kDensity, Layer::kDisturbedAt};

/// The site again, with its surface from `file`. A run writes its whole site, so the file's cells
/// are the columns.
Ground reread(const scene::Scene& scene, const Ground& start, const std::string& file) {
  scene::Scene end = scene;
  end.ground.file = file;
  end.ground.has_at = end.ground.at_is_local = false;
  end.ground.size = start.cell() * Vec2(start.nx(), start.ny());
  // As they lay, also where they were steeper than repose.
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
                             std::to_string(a.ny) + " columns, or lies elsewhere",
                         "a run's folder holds both: scene.sdf and terrain_end.tif"});
}

/// Heights of a terrain, whatever layer they stand for.
class HeightsOf final : public LayerSource {
 public:
  explicit HeightsOf(const heightfield::TerrainView& view) : view_(view) {}
  void fill(Layer /*layer*/, const heightfield::CellRect& rect, float* out,
            std::size_t stride) const override {
    std::vector<float> z;
    view_.copy_heights(rect, z);
    const auto width = static_cast<std::ptrdiff_t>(rect.x1 - rect.x0);
    for (int y = 0; y < rect.y1 - rect.y0; ++y)
      std::copy(z.begin() + y * width, z.begin() + (y + 1) * width,
                out + static_cast<std::size_t>(y) * stride);
  }

 private:
  heightfield::TerrainView view_;
};

/// What lies loose at a run's end, in the few tiles where anything does.
class LooseAtEnd final : public LayerSource {
 public:
  LooseAtEnd(const std::string& terrain_end, int nx, int ny) : across_((nx + kSide - 1) / kSide) {
#ifdef NAVVY_WITH_GDAL
    heightfield::read_band(terrain_end, "loose_depth", nx, ny,
                           [&](int iy, std::span<const float> depths) {
                             for (std::size_t x = 0; x < depths.size(); ++x)
                               if (depths[x] > 0) depth(static_cast<int>(x), iy) = depths[x];
                           });
#else
    (void)terrain_end, (void)ny;
#endif
  }

  void fill(Layer layer, const heightfield::CellRect& rect, float* out,
            std::size_t stride) const override {
    for (int iy = rect.y0; iy < rect.y1; ++iy)
      for (int ix = rect.x0; ix < rect.x1; ++ix) {
        const auto found = tiles_.find(tile_of(ix, iy));
        const float depth = found != tiles_.end() ? found->second[place(ix, iy)] : 0.0f;
        out[static_cast<std::size_t>(iy - rect.y0) * stride +
            static_cast<std::size_t>(ix - rect.x0)] =
            layer == Layer::kAwake ? (depth > 0 ? 1.0f : 0.0f) : depth;
      }
  }

 private:
  static constexpr int kSide = LayerTiles::kSide;
  int tile_of(int ix, int iy) const { return iy / kSide * across_ + ix / kSide; }
  static std::size_t place(int ix, int iy) {
    return static_cast<std::size_t>(iy % kSide * kSide + ix % kSide);
  }
  float& depth(int ix, int iy) {
    std::vector<float>& tile = tiles_[tile_of(ix, iy)];
    if (tile.empty()) tile.assign(static_cast<std::size_t>(kSide) * kSide, 0.0f);
    return tile[place(ix, iy)];
  }

  int across_;
  std::unordered_map<int, std::vector<float>> tiles_;
};

TraversabilityLimits limits_for(const scene::Scene& scene) {
  for (const scene::MachineInWorld& placed : scene.machines)
    if (placed.machine.traversability.given) return limits_of(placed.machine);
  return {};
}

}  // namespace

TraversabilityLimits limits_of(const scene::Machine& machine) {
  const scene::Traversability& own = machine.traversability;
  return {own.slope, own.step_height, own.roughness, own.window};
}

MapOptions options_for(const scene::Scene& scene, const heightfield::Terrain& site,
                       std::vector<Layer> layers, const heightfield::DesignSurface* design) {
  MapOptions out{std::move(layers), limits_for(scene), {}};
  const auto wants = [&](Layer layer) {
    return std::find(out.layers.begin(), out.layers.end(), layer) != out.layers.end();
  };
  // A float a column: only where somebody looks at it.
  if (!wants(Layer::kTarget) && !wants(Layer::kCutFill)) return out;
  std::optional<heightfield::DesignSurface> made;
  if (design == nullptr && (made = heightfield::make_design(scene, site))) design = &*made;
  if (design != nullptr) out.target = design->over(site.nx(), site.ny());
  return out;
}

TerrainMap map_of_site(const Ground& site, const MapOptions& options) {
  MapMaker maker(options);
  maker.update(site.view());
  return maker.map();
}

TerrainMap map_of_run(const scene::Scene& scene, const Ground& start,
                      const std::string& terrain_end, const MapOptions& options) {
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
  // Of a ground that was never another: only its heights are looked at.
  MapMaker maker(options);
  maker.update(Ground(setup).view(std::nan("")));
  TerrainMap out = maker.map();
  for (const Layer layer : kNotInFiles)
    if (out.has(layer)) out = out.with(layer, nullptr);
  if (out.has(Layer::kLooseDepth) || out.has(Layer::kAwake)) {
    const auto loose = std::make_shared<const LooseAtEnd>(terrain_end, start.nx(), start.ny());
    for (const Layer layer : {Layer::kLooseDepth, Layer::kAwake})
      if (out.has(layer)) out = out.with(layer, loose);
  }
  if (!out.has(Layer::kElevationStart)) return out;
  return out.with(Layer::kElevationStart, std::make_shared<const HeightsOf>(before));
}

}  // namespace navvy::planner
