// SPDX-License-Identifier: Apache-2.0
// The untouched site and the cache of its heights. Most of a large site is never touched, and
// wheels, soil and pictures read the same part repeatedly: that part is cached by tile on first
// use.
#include "heightfield/start_site.h"

#include <algorithm>
#include <cmath>

#include "core/error.h"

namespace navvy::heightfield {

StartSite::StartSite(GroundSetup setup) : setup_(std::move(setup)) {
  // Soils, stacks and patches are resolved once, because millions of columns are read.
  for (const scene::Soil& soil : setup_.soils)
    unit_.push_back(kMassQuantum / (soil.bank_density * setup_.cell * setup_.cell));
  stack_ = make_stack(setup_.layers);
  for (const scene::GroundPatch& patch : setup_.patches)
    patches_.push_back(
        {patch.min.x(), patch.min.y(), patch.max.x(), patch.max.y(), make_stack(patch.layers)});
}

StartSite::Stack StartSite::make_stack(const std::vector<scene::GroundLayer>& layers) const {
  Stack stack;
  for (const scene::GroundLayer& layer : layers)
    for (std::size_t i = 0; i < setup_.soils.size(); ++i)
      if (setup_.soils[i].name == layer.soil) {
        stack.push_back({static_cast<std::uint16_t>(i), layer.thickness});
        break;
      }
  return stack;
}

const StartSite::Stack& StartSite::stack_at(int ix, int iy) const {
  // Most sites have no patches.
  if (patches_.empty()) return stack_;
  const double x = setup_.origin.x() + (ix + 0.5) * setup_.cell,
               y = setup_.origin.y() + (iy + 0.5) * setup_.cell;
  // If patches overlap, the last one counts, as if laid over the others.
  for (auto patch = patches_.rbegin(); patch != patches_.rend(); ++patch)
    if (x >= patch->x0 && x < patch->x1 && y >= patch->y0 && y < patch->y1) return patch->stack;
  return stack_;
}

// The layers come from the description alone, so that every call gives the same ones.
void StartSite::column(int ix, int iy, Column& out) const {
  const double surface = setup_.surface(ix, iy);
  // Cleared only now: a surface may be made from another site, whose heights use the same column of
  // this thread.
  out.clear();
  if (!std::isfinite(surface))
    throw InputError(Fault{Fault::Severity::kError, "", 0,
                           "ground column (" + std::to_string(ix) + ", " + std::to_string(iy) + ")",
                           std::to_string(surface), "a height must be a finite number",
                           "repair the height source"});
  const Stack& stack = stack_at(ix, iy);
  // The last layer reaches down to bedrock, whatever its thickness.
  double rest = surface - setup_.datum;
  for (std::size_t i = 0; i < stack.size() && rest > 0; ++i) {
    // Rounded to whole units of mass here, and never again.
    const bool last = i + 1 == stack.size();
    const double part = last ? rest : std::min(rest, stack[i].thickness);
    const std::int64_t mass = std::llround(part / unit_[stack[i].soil]);
    if (mass > 0) out.push_back({stack[i].soil, mass, 1.0f, 0.0f});
    rest -= part;
  }
  // Described from the surface down, stored from the bottom up.
  std::reverse(out.begin(), out.end());
}

// The height is summed from rounded masses and can differ from the source by half a mass unit.
double StartSite::height(int ix, int iy) const {
  // Computed from the layers like every other column, so that soil that was dug and put back gives
  // a bit-identical height. One column per thread is kept for its capacity.
  thread_local Column column_of_thread;
  column(ix, iy, column_of_thread);
  return setup_.datum + column_height(column_of_thread, unit_);
}

void StartSite::heights(int tx, int ty, TileHeights& out) const {
  // Columns beyond the edge of the site repeat the last one inside, so that a tile is always full.
  for (int y = 0; y < kTileSide; ++y)
    for (int x = 0; x < kTileSide; ++x) {
      const int ix = tx * kTileSide + x, iy = ty * kTileSide + y;
      const auto at = static_cast<std::size_t>(y * kTileSide + x);
      if (iy >= setup_.ny)
        out[at] = out[at - kTileSide];
      else if (ix >= setup_.nx)
        out[at] = out[at - 1];
      else
        out[at] = height(ix, iy);
    }
}

// Walks the description only; the masses are not needed.
std::uint16_t StartSite::surface_soil(int ix, int iy) const {
  const Stack& stack = stack_at(ix, iy);
  // A layer may have thickness zero, to omit it without renaming the others.
  for (const StackLayer& layer : stack)
    if (layer.thickness > 0) return layer.soil;
  return stack.back().soil;
}

// An empty table has one pointer per 1024 x 1024 columns.
StartHeights::StartHeights(std::shared_ptr<const StartSite> site)
    : site_(std::move(site)),
      groups_x_((site_->tiles_x() + kTileSide - 1) / kTileSide),
      groups_(static_cast<std::size_t>(groups_x_) *
              static_cast<std::size_t>((site_->tiles_y() + kTileSide - 1) / kTileSide)) {}

StartHeights::~StartHeights() {
  // No one reads any more, so plain loads suffice.
  for (const auto& slot : groups_) {
    const Group* group = slot.load(std::memory_order_relaxed);
    if (group == nullptr) continue;
    for (const auto& tile : *group) delete tile.load(std::memory_order_relaxed);
    delete group;
  }
}

const TileHeights* StartHeights::fill(int tx, int ty) const {
  if (tiles_.load(std::memory_order_relaxed) >= kMostTiles) return nullptr;
  // Computed before anything is published, because the source may throw.
  auto heights = std::make_unique<TileHeights>();
  site_->heights(tx, ty, *heights);
  std::atomic<Group*>& slot = groups_[group_of(tx, ty)];
  Group* group = slot.load(std::memory_order_acquire);
  if (group == nullptr) {
    auto fresh = std::make_unique<Group>();
    for (auto& tile : *fresh) tile.store(nullptr, std::memory_order_relaxed);
    // If another thread was faster, its group is used; `group` then points to it.
    if (slot.compare_exchange_strong(group, fresh.get(), std::memory_order_acq_rel))
      group = fresh.release();
  }
  // The same for the tile. Two threads compute the same numbers, so either copy may stay.
  const TileHeights* known = nullptr;
  std::atomic<const TileHeights*>& place = (*group)[tile_in_group(tx, ty)];
  if (!place.compare_exchange_strong(known, heights.get(), std::memory_order_acq_rel)) return known;
  tiles_.fetch_add(1, std::memory_order_relaxed);
  return heights.release();
}

// The table is full: this column is computed at every query.
double StartHeights::single(int ix, int iy) const {
  // Counted, because many such reads mean that the table caches the wrong part of the site.
  computed_.fetch_add(1, std::memory_order_relaxed);
  return site_->height(ix, iy);
}

const TileHeights& StartHeights::passing(int tx, int ty, TileHeights& buffer) const {
  const Group* group = groups_[group_of(tx, ty)].load(std::memory_order_acquire);
  const TileHeights* heights =
      group == nullptr ? nullptr : (*group)[tile_in_group(tx, ty)].load(std::memory_order_acquire);
  if (heights != nullptr) return *heights;
  site_->heights(tx, ty, buffer);
  return buffer;
}

}  // namespace navvy::heightfield
