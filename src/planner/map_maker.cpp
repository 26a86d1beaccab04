// SPDX-License-Identifier: Apache-2.0
// Two passes over what changed: first what each column tells of itself, then what follows from its
// elevation and that of the columns round it. Rectangles may overlap; a column that comes twice
// gets the same value twice. What did not change since the first view comes from a source that
// computes the same.
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

/// Side of the blocks in which derived layers are computed: their elevation with its margin fits a
/// processor's cache.
constexpr int kBlock = 256;

/// Layers that `layer` is computed from.
std::initializer_list<Layer> made_of(Layer layer) {
  static constexpr std::initializer_list<Layer> kFromElevation = {Layer::kElevation};
  static constexpr std::initializer_list<Layer> kFromThree = {Layer::kSlope, Layer::kStepHeight,
                                                              Layer::kRoughness, Layer::kElevation};
  static constexpr std::initializer_list<Layer> kFromTarget = {Layer::kElevation, Layer::kTarget};
  // A change is seen by comparing all that can change by itself.
  static constexpr std::initializer_list<Layer> kFromAll = {Layer::kElevation, Layer::kSoil,
                                                            Layer::kDensity, Layer::kLooseDepth};
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
CellRect grown(const CellRect& rect, int by) {
  return {rect.x0 - by, rect.y0 - by, rect.x1 + by, rect.y1 + by};
}

/// Bulk density of the uppermost soil.
float density_at(const heightfield::TerrainView& view, int ix, int iy) {
  const double bank = view.setup().soils[view.surface_soil(ix, iy)].bank_density;
  return static_cast<float>(bank / static_cast<double>(view.specific_volume(ix, iy)));
}

float target_at(const MapOptions& options, const heightfield::TerrainView& view, int ix, int iy) {
  return options.target.empty()
             ? kUnknown
             : options
                   .target[static_cast<std::size_t>(iy) * static_cast<std::size_t>(view.nx()) + ix];
}

/// Of the layers that look around; which of them are wanted.
struct Derived {
  bool slope = false, step_height = false, roughness = false, traversability = false;
};

/// Computes them over `block` from its elevation with a margin of `reach`; `give(ix, iy, slope,
/// step, rough, good)`.
template <class Give>
void derive(const ElevationPatch& patch, const CellRect& block, const TraversabilityLimits& limits,
            const Derived& wanted, const Give& give) {
  const int reach = limits.reach(patch.cell);
  // Traversability is made of the three; what else is wanted is computed by itself.
  const bool all = wanted.traversability;
  for (int iy = block.y0; iy < block.y1; ++iy)
    for (int ix = block.x0; ix < block.x1; ++ix) {
      const float slope = all || wanted.slope ? slope_at(patch, ix, iy) : kUnknown;
      const float step =
          all || wanted.step_height ? step_height_at(patch, ix, iy, reach) : kUnknown;
      const float rough = all || wanted.roughness ? roughness_at(patch, ix, iy, reach) : kUnknown;
      give(ix, iy, slope, step, rough, all ? traversability(slope, step, rough, limits) : kUnknown);
    }
}

/// One block of a site after the other.
template <class Work>
void in_blocks(const CellRect& rect, const Work& work) {
  for (int y0 = rect.y0; y0 < rect.y1; y0 += kBlock)
    for (int x0 = rect.x0; x0 < rect.x1; x0 += kBlock)
      work(CellRect{x0, y0, std::min(x0 + kBlock, rect.x1), std::min(y0 + kBlock, rect.y1)});
}

/// What a map holds where nothing changed since its first view.
class ViewSource final : public LayerSource {
 public:
  ViewSource(const heightfield::TerrainView& view, std::shared_ptr<const MapOptions> options)
      : view_(view), options_(std::move(options)) {}

  /// Whether anything is known of a layer.
  bool knows(Layer layer) const {
    if (layer == Layer::kTarget || layer == Layer::kCutFill) return !options_->target.empty();
    // When the map begins nothing is known of what was before.
    return layer != Layer::kDisturbedAt;
  }

  void fill(Layer layer, const CellRect& rect, float* out, std::size_t stride) const override {
    const auto each = [&](const auto& value) {
      for (int iy = rect.y0; iy < rect.y1; ++iy)
        for (int ix = rect.x0; ix < rect.x1; ++ix) {
          const float v = value(ix, iy);
          out[static_cast<std::size_t>(iy - rect.y0) * stride +
              static_cast<std::size_t>(ix - rect.x0)] = v == v ? v : kUnknown;
        }
    };
    switch (layer) {
      case Layer::kElevation:
      case Layer::kCutFill: {
        std::vector<float> z;
        view_.copy_heights(rect, z);
        std::size_t next = 0;
        if (layer == Layer::kElevation) return each([&](int, int) { return z[next++]; });
        return each(
            [&](int ix, int iy) { return z[next++] - target_at(*options_, view_, ix, iy); });
      }
      case Layer::kElevationStart:
        return each([&](int ix, int iy) { return static_cast<float>(view_.start_height(ix, iy)); });
      case Layer::kTarget:
        return each([&](int ix, int iy) { return target_at(*options_, view_, ix, iy); });
      case Layer::kSoil:
        return each([&](int ix, int iy) { return static_cast<float>(view_.surface_soil(ix, iy)); });
      case Layer::kDensity:
        return each([&](int ix, int iy) { return density_at(view_, ix, iy); });
      case Layer::kLooseDepth:
        return each([&](int ix, int iy) { return view_.loose_depth(ix, iy); });
      case Layer::kAwake:
        return each([&](int ix, int iy) { return view_.active(ix, iy) ? 1.0f : 0.0f; });
      case Layer::kDisturbedAt:
        return each([](int, int) { return kUnknown; });
      case Layer::kSlope:
      case Layer::kStepHeight:
      case Layer::kRoughness:
      case Layer::kTraversability:
        return in_blocks(rect, [&](const CellRect& block) {
          derived(layer, block,
                  out + static_cast<std::size_t>(block.y0 - rect.y0) * stride +
                      static_cast<std::size_t>(block.x0 - rect.x0),
                  stride);
        });
    }
  }

 private:
  void derived(Layer layer, const CellRect& block, float* out, std::size_t stride) const {
    ElevationPatch patch{grown(block, options_->limits.reach(view_.cell())), view_.cell(), {}};
    // Column by column: blocks share their margins, and whole tiles of the site would be computed
    // for them.
    const CellRect site = view_.site_rect();
    patch.z.reserve(static_cast<std::size_t>(patch.rect.area()));
    for (int iy = patch.rect.y0; iy < patch.rect.y1; ++iy)
      for (int ix = patch.rect.x0; ix < patch.rect.x1; ++ix)
        patch.z.push_back(site.contains(ix, iy) ? static_cast<float>(view_.height(ix, iy))
                                                : kUnknown);
    const Derived wanted{layer == Layer::kSlope, layer == Layer::kStepHeight,
                         layer == Layer::kRoughness, layer == Layer::kTraversability};
    derive(patch, block, options_->limits, wanted,
           [&](int ix, int iy, float slope, float step, float rough, float good) {
             const float value = wanted.slope         ? slope
                                 : wanted.step_height ? step
                                 : wanted.roughness   ? rough
                                                      : good;
             out[static_cast<std::size_t>(iy - block.y0) * stride +
                 static_cast<std::size_t>(ix - block.x0)] = value == value ? value : kUnknown;
           });
  }

  heightfield::TerrainView view_;
  std::shared_ptr<const MapOptions> options_;
};

}  // namespace

MapMaker::MapMaker(MapOptions options)
    : options_(std::make_shared<const MapOptions>(std::move(options))) {}

// By size and place: the follower itself tells sites of one size apart, and then names the whole of
// the new one.
bool MapMaker::is_of(const heightfield::TerrainView& view) const {
  return map_ && map_->nx() == view.nx() && map_->ny() == view.ny() &&
         map_->cell() == view.cell() && map_->origin() == view.origin();
}

void MapMaker::start(const heightfield::TerrainView& view) {
  options_->limits.require_valid(view.cell());
  const auto columns = static_cast<std::size_t>(view.site_rect().area());
  if (!options_->target.empty() && options_->target.size() != columns)
    throw InputError(Fault{Fault::Severity::kError, "", 0, "target",
                           std::to_string(options_->target.size()) + " values",
                           "one for each of the site's " + std::to_string(view.nx()) + " x " +
                               std::to_string(view.ny()) + " columns",
                           "sample the design surface at the column centres, x fastest"});
  // A layer that has tiles is wanted; the others cost nothing.
  map_.emplace(view.setup(), view.time(), 0);
  const auto source = std::make_shared<const ViewSource>(view, options_);
  const auto want = [&](Layer layer) {
    map_->tiles_[index_of(layer)] =
        LayerTiles(view.nx(), view.ny(), layer, source->knows(layer) ? source : nullptr);
  };
  for (const Layer asked : options_->layers) {
    want(asked);
    for (const Layer base : made_of(asked)) want(base);
  }
}

bool MapMaker::set(Layer layer, int ix, int iy, float value) {
  LayerTiles& tiles = map_->tiles_[index_of(layer)];
  // One NaN for all, so that maps compare bit by bit.
  return !tiles.empty() && tiles.set(ix, iy, value == value ? value : kUnknown, edition_);
}

void MapMaker::update_base(const heightfield::TerrainView& view, const CellRect& rect) {
  // In doubles up to the value that is kept.
  for (int iy = rect.y0; iy < rect.y1; ++iy)
    for (int ix = rect.x0; ix < rect.x1; ++ix) {
      const auto height = static_cast<float>(view.height(ix, iy));
      // No short cut: each of them has to be written.
      bool differs = set(Layer::kElevation, ix, iy, height);
      differs = set(Layer::kSoil, ix, iy, view.surface_soil(ix, iy)) || differs;
      differs = set(Layer::kDensity, ix, iy, density_at(view, ix, iy)) || differs;
      differs = set(Layer::kLooseDepth, ix, iy, view.loose_depth(ix, iy)) || differs;
      set(Layer::kAwake, ix, iy, view.active(ix, iy) ? 1.0f : 0.0f);
      if (differs) set(Layer::kDisturbedAt, ix, iy, static_cast<float>(view.time()));
      // Another site of this size and place has another start.
      if (wants(Layer::kElevationStart))
        set(Layer::kElevationStart, ix, iy, static_cast<float>(view.start_height(ix, iy)));
      if (wants(Layer::kCutFill))
        set(Layer::kCutFill, ix, iy, height - target_at(*options_, view, ix, iy));
    }
}

void MapMaker::update_derived(const CellRect& rect) {
  const Derived wanted{wants(Layer::kSlope), wants(Layer::kStepHeight), wants(Layer::kRoughness),
                       wants(Layer::kTraversability)};
  in_blocks(rect, [&](const CellRect& block) {
    // Read from the map and not from the view: values follow from the floats that the map tells.
    ElevationPatch patch{grown(block, options_->limits.reach(map_->cell())), map_->cell(), {}};
    patch.z = map_->copy(Layer::kElevation, patch.rect);
    derive(patch, block, options_->limits, wanted,
           [&](int ix, int iy, float slope, float step, float rough, float good) {
             set(Layer::kSlope, ix, iy, slope);
             set(Layer::kStepHeight, ix, iy, step);
             set(Layer::kRoughness, ix, iy, rough);
             set(Layer::kTraversability, ix, iy, good);
           });
  });
}

const std::vector<CellRect>& MapMaker::update(const heightfield::TerrainView& view) {
  const bool first = !is_of(view);
  if (first) {
    forget();
    start(view);
  }
  // From here on tiles are written to, copies of those that a map holds.
  ++edition_;
  const std::vector<CellRect> rects = follower_.take(view);
  // The first map is what its source says of this view.
  if (first) {
    changed_ = rects;
    map_->time_ = view.time();
    map_->sequence_ = ++updates_;
    return changed_;
  }
  for (const CellRect& rect : rects) update_base(view, rect);
  // What a derived value looks at reaches beyond the column; the lists unite what overlaps much.
  heightfield::RectList around;
  const int reach = options_->limits.reach(view.cell());
  for (const CellRect& rect : rects) around.add(grown(rect, reach).cut(view.site_rect()));
  changed_ = around.rects();
  const auto held = [&](Layer layer) { return wants(layer); };
  const std::initializer_list<Layer> derived = {Layer::kSlope, Layer::kStepHeight,
                                                Layer::kRoughness};
  if (std::any_of(derived.begin(), derived.end(), held))
    for (const CellRect& rect : changed_) update_derived(rect);
  // Last: an error on the way leaves the stamp of the map before.
  map_->time_ = view.time();
  map_->sequence_ = ++updates_;
  return changed_;
}

void MapMaker::forget() {
  follower_.forget();
  map_.reset();
}

TerrainMap MapMaker::map() {
  if (!map_) throw Error("MapMaker::map: no view was shown yet; call update first");
  TerrainMap out = *map_;
  // What is written from now on is not this map's.
  ++edition_;
  return out;
}

}  // namespace navvy::planner
