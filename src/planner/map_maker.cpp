// SPDX-License-Identifier: Apache-2.0
// Two passes over what changed: first what each column tells of itself, then what follows from its elevation and that
// of the columns round it. Rectangles may overlap; a column that comes twice gets the same value twice.
#include "planner/map_maker.h"

#include <algorithm>
#include <bit>
#include <initializer_list>
#include <string>
#include <utility>

#include "core/error.h"

namespace navvy::planner {
namespace {

using heightfield::CellRect;

/// Side of the blocks in which derived layers are computed: their elevation with its margin fits a processor's cache.
constexpr int kBlock = 256;

/// Layers that `layer` is computed from.
std::initializer_list<Layer> made_of(Layer layer) {
  static constexpr std::initializer_list<Layer> kFromElevation = {Layer::kElevation};
  static constexpr std::initializer_list<Layer> kFromThree = {Layer::kSlope, Layer::kStepHeight, Layer::kRoughness,
                                                              Layer::kElevation};
  static constexpr std::initializer_list<Layer> kFromTarget = {Layer::kElevation, Layer::kTarget};
  // A change is seen by comparing all that can change by itself.
  static constexpr std::initializer_list<Layer> kFromAll = {Layer::kElevation, Layer::kSoil, Layer::kDensity,
                                                            Layer::kLooseDepth};
  switch (layer) {
    case Layer::kSlope:
    case Layer::kStepHeight:
    case Layer::kRoughness:
      return kFromElevation;
    case Layer::kTraversability:
      return kFromThree;
    case Layer::kCutFill:
      return kFromTarget;
    case Layer::kDisturbedAt:
      return kFromAll;
    default:
      return {};
  }
}

/// By so many columns to each side, also beyond the site.
CellRect grown(const CellRect& rect, int by) { return {rect.x0 - by, rect.y0 - by, rect.x1 + by, rect.y1 + by}; }

}  // namespace

MapMaker::MapMaker(MapOptions options) : options_(std::move(options)) {}

// By size and place: the follower itself tells sites of one size apart, and then names the whole of the new one.
bool MapMaker::is_of(const heightfield::TerrainView& view) const {
  return map_ && map_->nx() == view.nx() && map_->ny() == view.ny() && map_->cell() == view.cell() &&
         map_->origin() == view.origin();
}

void MapMaker::start(const heightfield::TerrainView& view) {
  options_.limits.require_valid(view.cell());
  const auto columns = static_cast<std::size_t>(view.site_rect().area());
  if (!options_.target.empty() && options_.target.size() != columns)
    throw InputError(Fault{
        Fault::Severity::kError, "", 0, "target", std::to_string(options_.target.size()) + " values",
        "one for each of the site's " + std::to_string(view.nx()) + " x " + std::to_string(view.ny()) + " columns",
        "sample the design surface at the column centres, x fastest"});
  // A layer that has tiles is wanted; the others cost nothing.
  map_.emplace(view.setup(), view.time(), 0);
  for (const Layer asked : options_.layers) {
    map_->tiles_[index_of(asked)] = LayerTiles(view.nx(), view.ny());
    for (const Layer base : made_of(asked)) map_->tiles_[index_of(base)] = LayerTiles(view.nx(), view.ny());
  }
}

bool MapMaker::set(Layer layer, int ix, int iy, float value) {
  LayerTiles& tiles = map_->tiles_[index_of(layer)];
  if (tiles.empty()) return false;
  // One NaN for all, so that maps compare bit by bit.
  if (value != value) value = kUnknown;
  if (std::bit_cast<std::uint32_t>(tiles.at(ix, iy)) == std::bit_cast<std::uint32_t>(value)) return false;
  tiles.set(ix, iy, value, edition_);
  return true;
}

void MapMaker::update_base(const heightfield::TerrainView& view, const CellRect& rect, bool first) {
  // In doubles up to the value that is kept.
  const auto& soils = view.setup().soils;
  const auto target = [&](int ix, int iy) {
    return options_.target.empty()
               ? kUnknown
               : options_.target[static_cast<std::size_t>(iy) * static_cast<std::size_t>(view.nx()) + ix];
  };
  for (int iy = rect.y0; iy < rect.y1; ++iy)
    for (int ix = rect.x0; ix < rect.x1; ++ix) {
      const auto height = static_cast<float>(view.height(ix, iy));
      const std::uint16_t soil = view.surface_soil(ix, iy);
      const double density = soils[soil].bank_density / static_cast<double>(view.specific_volume(ix, iy));
      // No short cut: each of them has to be written.
      bool differs = set(Layer::kElevation, ix, iy, height);
      differs = set(Layer::kSoil, ix, iy, soil) || differs;
      differs = set(Layer::kDensity, ix, iy, static_cast<float>(density)) || differs;
      differs = set(Layer::kLooseDepth, ix, iy, view.loose_depth(ix, iy)) || differs;
      set(Layer::kAwake, ix, iy, view.awake(ix, iy) ? 1.0f : 0.0f);
      // When the map begins nothing is known of what was before.
      if (differs && !first) set(Layer::kDisturbedAt, ix, iy, static_cast<float>(view.time()));
      if (wants(Layer::kElevationStart))
        set(Layer::kElevationStart, ix, iy, static_cast<float>(view.start_height(ix, iy)));
      if (first) set(Layer::kTarget, ix, iy, target(ix, iy));
      if (wants(Layer::kCutFill)) set(Layer::kCutFill, ix, iy, height - target(ix, iy));
    }
}

void MapMaker::derive(const CellRect& rect) {
  const int reach = options_.limits.reach(map_->cell());
  // Traversability is made of the three; what else is wanted is computed by itself.
  const bool all = wants(Layer::kTraversability);
  for (int y0 = rect.y0; y0 < rect.y1; y0 += kBlock)
    for (int x0 = rect.x0; x0 < rect.x1; x0 += kBlock) {
      const CellRect block{x0, y0, std::min(x0 + kBlock, rect.x1), std::min(y0 + kBlock, rect.y1)};
      ElevationPatch patch{grown(block, reach), map_->cell(), {}};
      // Read from the map and not from the view: values follow from the floats that the map tells.
      patch.z = map_->copy(Layer::kElevation, patch.rect);
      for (int iy = block.y0; iy < block.y1; ++iy)
        for (int ix = block.x0; ix < block.x1; ++ix) {
          const float slope = all || wants(Layer::kSlope) ? slope_at(patch, ix, iy) : kUnknown;
          const float step = all || wants(Layer::kStepHeight) ? step_height_at(patch, ix, iy, reach) : kUnknown;
          const float rough = all || wants(Layer::kRoughness) ? roughness_at(patch, ix, iy, reach) : kUnknown;
          set(Layer::kSlope, ix, iy, slope);
          set(Layer::kStepHeight, ix, iy, step);
          set(Layer::kRoughness, ix, iy, rough);
          if (all) set(Layer::kTraversability, ix, iy, traversability(slope, step, rough, options_.limits));
        }
    }
}

const std::vector<CellRect>& MapMaker::update(const heightfield::TerrainView& view) {
  const bool first = !is_of(view);
  if (first) {
    follower_.forget();
    map_.reset();
    start(view);
  }
  // From here on tiles are written to, copies of those that a map holds.
  ++edition_;
  const std::vector<CellRect> rects = follower_.take(view);
  for (const CellRect& rect : rects) update_base(view, rect, first);
  // What a derived value looks at reaches beyond the column; the lists unite what overlaps much.
  heightfield::RectList around;
  const int reach = options_.limits.reach(view.cell());
  for (const CellRect& rect : rects) around.add(grown(rect, reach).cut(view.site_rect()));
  changed_ = around.rects();
  const auto held = [&](Layer layer) { return wants(layer); };
  const std::initializer_list<Layer> derived = {Layer::kSlope, Layer::kStepHeight, Layer::kRoughness};
  if (std::any_of(derived.begin(), derived.end(), held))
    for (const CellRect& rect : changed_) derive(rect);
  // Last: an error on the way leaves the stamp of the map before.
  map_->time_ = view.time();
  map_->sequence_ = edition_;
  return changed_;
}

TerrainMap MapMaker::map() {
  if (!map_) throw Error("MapMaker::map: no view was shown yet; call update first");
  TerrainMap out = *map_;
  // What is written from now on is not this map's.
  ++edition_;
  return out;
}

}  // namespace navvy::planner
