// SPDX-License-Identifier: Apache-2.0
// The map of one instant, which never changes.
#pragma once

#include <array>
#include <cstdint>
#include <limits>
#include <memory>
#include <span>
#include <vector>

#include "heightfield/cell_rect.h"
#include "heightfield/ground_setup.h"
#include "map/map_layers.h"

namespace navvy::map {

class SiteColumns;

/// Value of a layer where nothing is known. Every comparison with it is false. Maps contain this
/// NaN and no other, so that they compare bit by bit.
inline constexpr float kUnknown = std::numeric_limits<float>::quiet_NaN();

/// Source of the tiles that no one wrote to: a pure function of place, evaluated on demand. Any
/// number of threads may call it at a time.
class LayerSource {
 public:
  virtual ~LayerSource() = default;
  /// Writes the values of `layer` over `rect`, which lies within the site, to `out`: x fastest, row
  /// after row, with `stride` values from one row to the next. Unknown values are kUnknown.
  /// @throws InputError where the heights of the site cannot be read.
  virtual void fill(MapLayer layer, const heightfield::CellRect& rect, float* out,
                    std::size_t stride) const = 0;
};

/// The values of one layer in tiles of 64 x 64 columns, shared between maps of successive instants.
///
/// One thread writes, and passes the edition that it works on with every write. A tile of an
/// earlier edition is copied first (16 KiB), so that copies made before do not change. A tile that
/// no one wrote to takes no memory: it is unknown, or computed by a source. Reading single columns
/// of such a tile computes it and keeps it for all who share it; passes over many columns (`copy`,
/// `passing`) keep nothing.
class LayerTiles {
 public:
  /// Columns along a side of a tile. A bucket touches one to four tiles.
  static constexpr int kSide = 64;
  /// The values of one tile, x fastest.
  using Values = std::array<float, static_cast<std::size_t>(kSide) * kSide>;
  /// Makes the tiles of a layer that the map does not hold.
  LayerTiles() = default;
  /// Makes a layer that `source` computes; without a source it is unknown everywhere.
  LayerTiles(int nx, int ny, MapLayer layer, std::shared_ptr<const LayerSource> source);

  /// Returns true for a layer that the map does not hold.
  bool empty() const { return tiles_.empty(); }
  /// Returns the value of a column of the site; nothing is checked.
  float at(int ix, int iy) const {
    const float* tile = values(tile_of(ix, iy));
    return tile != nullptr ? tile[place(ix, iy)] : kUnknown;
  }
  /// Returns the values from column ix to the end of the row of its tile; null where the tile is
  /// unknown. `count` receives their number.
  const float* row(int ix, int iy, int& count) const {
    count = kSide - ix % kSide;
    const float* tile = values(tile_of(ix, iy));
    return tile != nullptr ? tile + place(ix, iy) : nullptr;
  }
  /// Copies the values over `rect`, which lies within the site, x fastest, with `stride` values
  /// from row to row.
  void copy(const heightfield::CellRect& rect, float* out, std::size_t stride) const;
  /// Returns the values of tile (tx, ty); null where it is unknown. A tile that is not in memory is
  /// computed into `buffer`.
  const float* passing(int tx, int ty, Values& buffer) const;
  /// Returns true when no one wrote to the tile in between, so that it is the same in both. Both
  /// must belong to one site.
  bool shares(const LayerTiles& other, int tx, int ty) const;
  /// Writes one column and returns true when its value changed. Costs a copy of the tile where a
  /// map of an earlier edition may hold it.
  bool set(int ix, int iy, float value, std::uint64_t edition);

 private:
  // A tile that was written.
  struct WrittenTile {
    Values values;
    std::uint64_t edition = 0;
  };
  /// Tiles that were computed by the source because a reader asked for a column.
  struct Asked;
  /// Returns the number of the tile that holds a column.
  std::size_t tile_of(int ix, int iy) const {
    return static_cast<std::size_t>(iy / kSide) * static_cast<std::size_t>(across_) +
           static_cast<std::size_t>(ix / kSide);
  }
  /// Returns the place of a column in its tile.
  static std::size_t place(int ix, int iy) {
    return static_cast<std::size_t>(iy % kSide * kSide + ix % kSide);
  }
  /// Returns the values of a tile and computes them if needed; null where it is unknown.
  const float* values(std::size_t tile) const {
    if (const WrittenTile* written = tiles_[tile].get()) return written->values.data();
    return asked_ ? ask(tile) : nullptr;
  }
  /// Returns the tile from the source and keeps it.
  const float* ask(std::size_t tile) const;
  /// Returns the tile when it is in memory, else null.
  const float* present(std::size_t tile) const;
  /// Computes a tile from the source.
  void compute(std::size_t tile, Values& to) const;

  int nx_ = 0, ny_ = 0, across_ = 0;
  std::vector<std::shared_ptr<WrittenTile>> tiles_;
  std::shared_ptr<const Asked> asked_;
};

/// Layers of a site at one instant: immutable, cheap to copy, readable by any number of threads.
///
/// Columns are numbered as in heightfield::GroundSetup: (0, 0) has least x and least y, x runs
/// fastest. A MapMaker makes maps; `with` makes one from other values.
class TerrainMap {
 public:
  /// Makes a map without layers. Copies size, place, soils and georeference from `setup`. `time` is
  /// in seconds.
  TerrainMap(const heightfield::GroundSetup& setup, double time, std::uint64_t sequence);

  /// Returns the grid, the soils and the georeference of the site.
  const heightfield::GroundSetup& setup() const { return *setup_; }
  /// Returns the number of columns along x and y.
  int nx() const { return setup_->nx; }
  int ny() const { return setup_->ny; }
  /// Returns the edge of a column [m].
  double cell() const { return setup_->cell; }
  /// Returns the lower-left corner of the site in W [m].
  const Vec2& origin() const { return setup_->origin; }
  /// Returns the simulated time [s]; NaN where the source of the map does not know it.
  double time() const { return time_; }
  /// Returns the number of the update that made the map, from 1: that of the UpdateFeed, or else of
  /// MapMaker::update.
  std::uint64_t sequence() const { return sequence_; }
  /// Returns the rectangle of all columns.
  heightfield::CellRect rect() const { return {0, 0, nx(), ny()}; }
  /// Returns true when the site has column (ix, iy).
  bool contains(int ix, int iy) const { return rect().contains(ix, iy); }

  /// Returns true when the map holds this layer; otherwise all its values are unknown.
  bool has(MapLayer layer) const { return !tiles_[index_of(layer)].empty(); }
  /// Returns the value of one column; kUnknown outside the site.
  float at(MapLayer layer, int ix, int iy) const {
    /// Returns the values of a layer tile by tile.
    const LayerTiles& tiles = tiles_[index_of(layer)];
    return !tiles.empty() && contains(ix, iy) ? tiles.at(ix, iy) : kUnknown;
  }
  /// Copies a layer over `rect`, x fastest, row 0 with least y; kUnknown where the rectangle leaves
  /// the site.
  std::vector<float> copy(MapLayer layer, const heightfield::CellRect& rect) const;
  /// Copies a layer over the whole site.
  std::vector<float> copy(MapLayer layer) const { return copy(layer, rect()); }
  /// The values themselves, tile by tile.
  const LayerTiles& tiles(MapLayer layer) const { return tiles_[index_of(layer)]; }

  /// Returns this map with `values` (nx x ny, x fastest) as that layer. @throws Error when their
  /// number does not match.
  TerrainMap with(MapLayer layer, std::span<const float> values) const;
  /// Moves this map into one with another number.
  TerrainMap numbered(std::uint64_t sequence) &&;

 private:
  friend class MapMaker;
  friend TerrainMap make_map(const std::shared_ptr<const SiteColumns>& site,
                             std::uint64_t sequence);
  // All maps of a site share it.
  std::shared_ptr<const heightfield::GroundSetup> setup_;
  double time_;
  std::uint64_t sequence_;
  std::array<LayerTiles, kMapLayers> tiles_;
};

}  // namespace navvy::map
