// SPDX-License-Identifier: Apache-2.0
#include "map/column_block.h"

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>

#include "core/error.h"

namespace navvy::map {
namespace {

using heightfield::CellRect;

// Heights of bodies are rounded to this [m]: a machine at rest trembles by micrometres, which is
// no news for readers of maps.
constexpr double kTopStep = 0.01;

/// Computes tiles from the state of the site's columns.
class ColumnsSource final : public LayerSource {
 public:
  explicit ColumnsSource(std::shared_ptr<const SiteColumns> site) : site_(std::move(site)) {}

  void fill(MapLayer layer, const CellRect& rect, float* out, std::size_t stride) const override {
    const LayerInfo& row = info(layer);
    const auto put = [&](int ix, int iy, float value) {
      // One NaN for all, so that maps compare bit by bit.
      out[static_cast<std::size_t>(iy - rect.y0) * stride +
          static_cast<std::size_t>(ix - rect.x0)] = value == value ? value : kUnknown;
    };
    if (row.of_surround != nullptr) {
      for_each_block(rect, [&](const CellRect& block) {
        const ElevationPatch patch = patch_around(block);
        for_each_surround(patch, block, site_->options().limits,
                          [&](int ix, int iy, Surround& s) { put(ix, iy, row.of_surround(s)); });
      });
      return;
    }
    const ColumnBlock block(*site_, rect);
    for (int iy = rect.y0; iy < rect.y1; ++iy)
      for (int ix = rect.x0; ix < rect.x1; ++ix)
        put(ix, iy, row.of_column != nullptr ? row.of_column(block, ix, iy) : kUnknown);
  }

 private:
  ElevationPatch patch_around(const CellRect& block) const {
    const heightfield::TerrainView& view = site_->view();
    // The margin is what slope, steps and roughness of the outermost columns look at.
    ElevationPatch patch{grown(block, site_->options().limits.reach(view.cell())), view.cell(), {}};
    // Column by column: blocks share their margins, and a copy would compute whole tiles for them.
    const CellRect site = view.site_rect();
    patch.z.reserve(static_cast<std::size_t>(patch.rect.area()));
    for (int iy = patch.rect.y0; iy < patch.rect.y1; ++iy)
      for (int ix = patch.rect.x0; ix < patch.rect.x1; ++ix)
        patch.z.push_back(site.contains(ix, iy) ? static_cast<float>(view.height(ix, iy))
                                                : kUnknown);
    // An empty list stands for a site without bodies, which most maps are of.
    if (site_->occupied().empty()) return patch;
    for (int iy = patch.rect.y0; iy < patch.rect.y1; ++iy)
      for (int ix = patch.rect.x0; ix < patch.rect.x1; ++ix)
        patch.occupied.push_back(site.contains(ix, iy) ? site_->occupied(ix, iy) : 0.0f);
    return patch;
  }

  std::shared_ptr<const SiteColumns> site_;
};

}  // namespace

SiteColumns::SiteColumns(heightfield::TerrainView view, std::shared_ptr<const MapOptions> options)
    : view_(std::move(view)),
      options_(std::move(options)),
      occupied_(occupied_columns(view_, *options_)) {}

// Walks the bounding rectangle of each area.
OccupiedColumns occupied_columns(const heightfield::TerrainView& view, const MapOptions& options) {
  OccupiedColumns out;
  if (!view.occupied()) return out;
  const double cell = view.cell();
  for (const heightfield::OccupiedArea& area : *view.occupied()) {
    if (area.outline.empty() || (area.machine && !options.machines)) continue;
    Vec2 low = Vec2::Constant(INFINITY), high = -low;
    for (const Vec2& p : area.outline) low = low.cwiseMin(p), high = high.cwiseMax(p);
    const auto column = [&](double x, double from, int most) {
      // Clamped before the cast, as a body far outside the site may exceed the range of an int.
      return static_cast<int>(std::clamp(std::floor((x - from) / cell), -1.0, most + 0.0));
    };
    // Upper bounds of a rectangle are exclusive.
    const CellRect around = CellRect{column(low.x(), view.origin().x(), view.nx()),
                                     column(low.y(), view.origin().y(), view.ny()),
                                     column(high.x(), view.origin().x(), view.nx()) + 1,
                                     column(high.y(), view.origin().y(), view.ny()) + 1}
                                .cut(view.site_rect());
    for (int iy = around.y0; iy < around.y1; ++iy)
      for (int ix = around.x0; ix < around.x1; ++ix) {
        const Vec2 corner = view.origin() + cell * Vec2(ix, iy);
        const double z = view.height(ix, iy);
        // A body in the ground, or high above it, is in nobody's way.
        if (!(area.high > z) || area.low > z + kHeadroom) continue;
        if (!heightfield::meets(area, corner, corner + Vec2(cell, cell))) continue;
        float& top = out[static_cast<std::int64_t>(iy) * view.nx() + ix];
        top = std::max(top, static_cast<float>(kTopStep * std::round((area.high - z) / kTopStep)));
      }
  }
  return out;
}

float SiteColumns::occupied(int ix, int iy) const {
  if (occupied_.empty()) return 0;
  const auto found = occupied_.find(static_cast<std::int64_t>(iy) * view_.nx() + ix);
  return found != occupied_.end() ? found->second : 0;
}

bool SiteColumns::knows(LayerNeeds needs) const {
  // A single view shows no history.
  if (needs == LayerNeeds::kHistory) return false;
  return needs != LayerNeeds::kDesign || !options_->target.empty();
}

float SiteColumns::target(int ix, int iy) const {
  const std::vector<float>& target = options_->target;
  if (target.empty()) return kUnknown;
  return target[static_cast<std::size_t>(iy) * static_cast<std::size_t>(view_.nx()) +
                static_cast<std::size_t>(ix)];
}

// Loosening and compaction change the volume of a mass, so density falls as specific volume rises.
float SiteColumns::density(int ix, int iy) const {
  const double bank = view_.setup().soils[view_.surface_soil(ix, iy)].bank_density;
  return static_cast<float>(bank / static_cast<double>(view_.specific_volume(ix, iy)));
}

// The heights are copied on first use: layers that need none pay nothing.
float ColumnBlock::elevation(int ix, int iy) const {
  if (z_.empty()) site_.view().copy_heights(rect_, z_);
  const auto width = static_cast<std::size_t>(rect_.x1 - rect_.x0);
  return z_[static_cast<std::size_t>(iy - rect_.y0) * width +
            static_cast<std::size_t>(ix - rect_.x0)];
}

// A layer without tiles costs nothing, so only the layers that are asked for and those that they
// are computed from get any. A layer that the site cannot know gets tiles without a source.
TerrainMap make_map(const std::shared_ptr<const SiteColumns>& site, std::uint64_t sequence) {
  const heightfield::TerrainView& view = site->view();
  const MapOptions& options = site->options();
  options.limits.require_valid(view.cell());
  if (!options.target.empty() &&
      options.target.size() != static_cast<std::size_t>(view.site_rect().area()))
    throw InputError(Fault{Fault::Severity::kError, "", 0, "target",
                           std::to_string(options.target.size()) + " values",
                           "one value for each of the site's " + std::to_string(view.nx()) + " x " +
                               std::to_string(view.ny()) + " columns",
                           "sample the design surface at the column centres, x fastest"});
  TerrainMap out(view.setup(), view.time(), sequence);
  const auto source = std::make_shared<const ColumnsSource>(site);
  const auto want = [&](MapLayer layer) {
    out.tiles_[index_of(layer)] =
        LayerTiles(view.nx(), view.ny(), layer, site->knows(info(layer).needs) ? source : nullptr);
  };
  for (const MapLayer asked : options.layers) {
    // One source serves all layers; each tile is computed when it is first read.
    want(asked);
    for (const MapLayer base : info(asked).from) want(base);
  }
  return out;
}

}  // namespace navvy::map
