// SPDX-License-Identifier: Apache-2.0
#include "heightfield/tiles.h"

#include <algorithm>
#include <cmath>

#include "core/error.h"

namespace navvy::heightfield {
namespace {

// The cache holds a window of 32 x 32 tiles without collision, the 1024 x 1024 columns of a picture.
constexpr int kCacheSide = 32;

int index_in_tile(int ix, int iy) { return (iy % kTileSide) * kTileSide + ix % kTileSide; }

}  // namespace

Tiles::Tiles(const Ground::Setup& setup)
    : setup_(setup),
      tiles_x_((setup.nx + kTileSide - 1) / kTileSide),
      tiles_y_((setup.ny + kTileSide - 1) / kTileSide),
      groups_x_((tiles_x_ + kTileSide - 1) / kTileSide) {
  for (const scene::Soil& soil : setup.soils)
    unit_.push_back(kMassQuantum / (soil.bank_density * setup.cell * setup.cell));
  stack_ = make_stack(setup.layers);
  for (const scene::GroundPatch& patch : setup.patches)
    patches_.push_back({patch.min.x(), patch.min.y(), patch.max.x(), patch.max.y(), make_stack(patch.layers)});
  start_mass_.assign(setup.soils.size(), 0);
  groups_.resize(static_cast<std::size_t>(groups_x_) * ((tiles_y_ + kTileSide - 1) / kTileSide));
  cache_.resize(kCacheSide * kCacheSide);
}

Tiles::Stack Tiles::make_stack(const std::vector<scene::GroundLayer>& layers) const {
  Stack stack;
  for (const scene::GroundLayer& layer : layers)
    for (std::size_t i = 0; i < setup_.soils.size(); ++i)
      if (setup_.soils[i].name == layer.soil) {
        stack.push_back({static_cast<std::uint16_t>(i), layer.thickness});
        break;
      }
  return stack;
}

const Tiles::Stack& Tiles::stack_at(int ix, int iy) const {
  if (patches_.empty()) return stack_;
  const double x = setup_.origin.x() + (ix + 0.5) * setup_.cell, y = setup_.origin.y() + (iy + 0.5) * setup_.cell;
  // Where patches overlap the last one counts, as if it had been laid over the others.
  for (auto patch = patches_.rbegin(); patch != patches_.rend(); ++patch)
    if (x >= patch->x0 && x < patch->x1 && y >= patch->y0 && y < patch->y1) return patch->stack;
  return stack_;
}

void Tiles::start_column(int ix, int iy, Column& out) const {
  out.clear();
  const double surface = setup_.surface(ix, iy);
  if (!std::isfinite(surface))
    throw InputError(Fault{Fault::Severity::kError, "", 0,
                           "ground column (" + std::to_string(ix) + ", " + std::to_string(iy) + ")",
                           std::to_string(surface), "a height must be a finite number", "repair the height source"});
  const Stack& stack = stack_at(ix, iy);
  double rest = surface - setup_.datum;
  for (std::size_t i = 0; i < stack.size() && rest > 0; ++i) {
    const bool last = i + 1 == stack.size();
    const double part = last ? rest : std::min(rest, stack[i].thickness);
    const std::int64_t mass = std::llround(part / unit_[stack[i].soil]);
    if (mass > 0) out.push_back({stack[i].soil, mass, 1.0f, 0.0f});
    rest -= part;
  }
  std::reverse(out.begin(), out.end());
}

double Tiles::start_height(int ix, int iy) const {
  start_column(ix, iy, scratch_);
  return setup_.datum + column_height(scratch_, unit_);
}

std::uint16_t Tiles::start_surface_soil(int ix, int iy) const {
  const Stack& stack = stack_at(ix, iy);
  for (const StackLayer& layer : stack)
    if (layer.thickness > 0) return layer.soil;
  return stack.back().soil;
}

void Tiles::fill_start_heights(int tx, int ty, double* out) const {
  // Columns beyond the site's edge repeat the last one inside, so a tile is always full.
  for (int y = 0; y < kTileSide; ++y)
    for (int x = 0; x < kTileSide; ++x) {
      const int ix = tx * kTileSide + x, iy = ty * kTileSide + y;
      double& h = out[y * kTileSide + x];
      if (iy >= setup_.ny)
        h = out[(y - 1) * kTileSide + x];
      else if (ix >= setup_.nx)
        h = out[y * kTileSide + x - 1];
      else
        h = start_height(ix, iy);
    }
}

Tile* Tiles::find_tile(int tx, int ty) const {
  const auto& group = groups_[static_cast<std::size_t>(ty / kTileSide) * groups_x_ + tx / kTileSide];
  return group ? (*group)[index_in_tile(tx, ty)] : nullptr;
}

const double* Tiles::heights(int tx, int ty) const {
  const Tile* tile = find_tile(tx, ty);
  return tile != nullptr ? tile->height.data() : start_heights(tx, ty);
}

const double* Tiles::start_heights(int tx, int ty) const {
  const Tile* tile = find_tile(tx, ty);
  if (tile != nullptr) return tile->start_height.data();
  auto& slot = cache_[(ty % kCacheSide) * kCacheSide + tx % kCacheSide];
  const std::int64_t key = static_cast<std::int64_t>(ty) * tiles_x_ + tx;
  if (!slot) slot = std::make_unique<CacheSlot>();
  if (slot->key != key) {
    slot->key = -1;  // the source may throw half way
    fill_start_heights(tx, ty, slot->height.data());
    slot->key = key;
  }
  return slot->height.data();
}

Tile& Tiles::touch_tile(int tx, int ty) {
  if (Tile* tile = find_tile(tx, ty)) return *tile;
  auto tile = std::make_unique<Tile>();
  std::copy_n(start_heights(tx, ty), kTileColumns, tile->start_height.begin());
  tile->height = tile->start_height;
  tile->slot.fill(-1);
  auto& group = groups_[static_cast<std::size_t>(ty / kTileSide) * groups_x_ + tx / kTileSide];
  if (!group) {
    group = std::make_unique<Group>();
    group->fill(nullptr);
  }
  Tile* raw = tile.get();
  (*group)[index_in_tile(tx, ty)] = raw;
  touched_[static_cast<std::int64_t>(ty) * tiles_x_ + tx] = std::move(tile);
  return *raw;
}

const Column* Tiles::find_column(int ix, int iy) const {
  const Tile* tile = find_tile(ix / kTileSide, iy / kTileSide);
  if (tile == nullptr) return nullptr;
  const int slot = tile->slot[index_in_tile(ix, iy)];
  return slot < 0 ? nullptr : &tile->columns[slot];
}

Column& Tiles::touch_column(int ix, int iy) {
  Tile& tile = touch_tile(ix / kTileSide, iy / kTileSide);
  std::int16_t& slot = tile.slot[index_in_tile(ix, iy)];
  if (slot < 0) {
    Column column;
    start_column(ix, iy, column);
    for (const Layer& layer : column) start_mass_[layer.soil] += layer.mass;
    slot = static_cast<std::int16_t>(tile.columns.size());
    tile.columns.push_back(std::move(column));
  }
  return tile.columns[slot];
}

void Tiles::update_height(int ix, int iy) {
  Tile& tile = *find_tile(ix / kTileSide, iy / kTileSide);
  const int i = index_in_tile(ix, iy);
  tile.height[i] = setup_.datum + column_height(tile.columns[tile.slot[i]], unit_);
}

void Tiles::clear() {
  touched_.clear();
  for (auto& group : groups_) group.reset();
  std::fill(start_mass_.begin(), start_mass_.end(), 0);
}

}  // namespace navvy::heightfield
