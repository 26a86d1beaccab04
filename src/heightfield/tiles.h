// SPDX-License-Identifier: Apache-2.0
// Where columns are kept: a sparse table of 32 x 32 tiles over the untouched site.
#pragma once

#include <array>
#include <cstdint>
#include <map>
#include <memory>
#include <vector>

#include "heightfield/column.h"
#include "heightfield/ground.h"

namespace navvy::heightfield {

inline constexpr int kTileSide = 32;
inline constexpr int kTileColumns = kTileSide * kTileSide;

/// A tile that was touched: heights of all its columns, layers of those that were changed.
struct Tile {
  std::array<double, kTileColumns> height;        ///< W [m]
  std::array<double, kTileColumns> start_height;  ///< W [m]
  std::array<std::int16_t, kTileColumns> slot;    ///< into `columns`; -1: as in the untouched site
  std::vector<Column> columns;
};

/// The untouched site and the tiles that differ from it. Reading the height of an untouched column fills one slot of a
/// bounded cache (at most 8 MiB), never a tile.
class Tiles {
 public:
  explicit Tiles(const Ground::Setup& setup);

  /// Heights [m] of the 1024 columns of tile (tx, ty), x fastest; valid until the next call.
  const double* heights(int tx, int ty) const;
  /// Same for the untouched site.
  const double* start_heights(int tx, int ty) const;

  /// Layers of the untouched column, bottom first. @throws InputError where the source is not finite.
  void start_column(int ix, int iy, Column& out) const;
  double start_height(int ix, int iy) const;
  std::uint16_t start_surface_soil(int ix, int iy) const;

  /// Layers of a changed column, or null while it is as at the start.
  const Column* find_column(int ix, int iy) const;
  /// The column, brought into being; call `update_height` after changing it.
  Column& touch_column(int ix, int iy);
  void update_height(int ix, int iy);

  /// Touched tiles by key (ty tiles_x + tx), in rising order.
  const std::map<std::int64_t, std::unique_ptr<Tile>>& touched() const { return touched_; }
  /// Mass that the changed columns held at the start, per soil.
  const std::vector<std::int64_t>& start_mass() const { return start_mass_; }
  void clear();

  int tiles_x() const { return tiles_x_; }
  const UnitThickness& unit() const { return unit_; }

 private:
  struct StackLayer {
    std::uint16_t soil;
    double thickness;  // [m]
  };
  using Stack = std::vector<StackLayer>;  // from the surface down
  struct Patch {
    double x0, y0, x1, y1;
    Stack stack;
  };
  // Tiles are found through groups of 32 x 32 pointers, so a 1 km2 site costs 800 bytes until it is touched.
  using Group = std::array<Tile*, kTileColumns>;
  struct CacheSlot {
    std::int64_t key = -1;
    std::array<double, kTileColumns> height;
  };

  Stack make_stack(const std::vector<scene::GroundLayer>& layers) const;
  const Stack& stack_at(int ix, int iy) const;
  Tile* find_tile(int tx, int ty) const;
  Tile& touch_tile(int tx, int ty);
  void fill_start_heights(int tx, int ty, double* out) const;

  const Ground::Setup& setup_;
  int tiles_x_, tiles_y_, groups_x_;
  UnitThickness unit_;
  Stack stack_;
  std::vector<Patch> patches_;
  std::map<std::int64_t, std::unique_ptr<Tile>> touched_;
  std::vector<std::unique_ptr<Group>> groups_;
  std::vector<std::int64_t> start_mass_;
  mutable std::vector<std::unique_ptr<CacheSlot>> cache_;
  mutable Column scratch_;
};

}  // namespace navvy::heightfield
