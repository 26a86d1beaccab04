// SPDX-License-Identifier: Apache-2.0
// A terrain map: layers of a site at one instant, immutable.
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

/// Value of a map layer where nothing is known. Every comparison with this NaN is false. Maps
/// contain no other NaN, so that equal maps are bit-identical.
inline constexpr float kUnknown = std::numeric_limits<float>::quiet_NaN();

/// Computes values of map layers on demand. Implementations are pure functions of layer and
/// columns. Any number of threads may call them at the same time.
class LayerSource {
 public:
  /// Allows deletion through a base class pointer.
  virtual ~LayerSource() = default;
  /// Writes the values of `layer` for the columns in `rect`, which must lie within the site, to
  /// `out`: x fastest, row by row, with `stride` values from the start of one row to the start of
  /// the next. Unknown values are kUnknown.
  /// @throws InputError if the heights of the site cannot be read.
  virtual void fill(MapLayer layer, const heightfield::CellRect& rect, float* out,
                    std::size_t stride) const = 0;
};

/// The values of one map layer, stored in tiles of 64 x 64 columns that successive maps share.
///
/// One thread writes. It passes an edition number with every write; a tile written in an earlier
/// edition is copied first (16 KiB), so that earlier copies of the layer do not change. A tile that
/// was never written takes no memory: its values are unknown, or computed by a source. Reading a
/// single column of such a tile computes the tile and stores it for all maps that share the source.
/// Passes over many columns (`copy`, `passing`) store nothing.
class LayerTiles {
 public:
  /// Number of columns along each side of a tile.
  static constexpr int kSide = 64;
  /// Values of one tile, x fastest.
  using Values = std::array<float, static_cast<std::size_t>(kSide) * kSide>;
  /// Represents a layer that the map does not contain.
  LayerTiles() = default;
  /// Makes a layer of nx x ny columns whose values are computed by `source`. If `source` is null,
  /// all values are unknown.
  LayerTiles(int nx, int ny, MapLayer layer, std::shared_ptr<const LayerSource> source);

  /// Returns true if the map does not contain this layer.
  bool empty() const { return tiles_.empty(); }
  /// Returns the value of site column (ix, iy). The indices are not checked.
  float at(int ix, int iy) const {
    const float* tile = values(tile_of(ix, iy));
    return tile != nullptr ? tile[place(ix, iy)] : kUnknown;
  }
  /// Returns a pointer to the values of site columns (ix, iy), (ix + 1, iy) and so on, up to the
  /// end of the tile. Sets `count` to their number, which may include columns beyond the edge of
  /// the site. Returns null if all of them are unknown.
  const float* row(int ix, int iy, int& count) const {
    count = kSide - ix % kSide;
    const float* tile = values(tile_of(ix, iy));
    return tile != nullptr ? tile + place(ix, iy) : nullptr;
  }
  /// Copies the values of the columns in `rect`, which must lie within the site, to `out`: x
  /// fastest, with `stride` values from the start of one row to the start of the next.
  void copy(const heightfield::CellRect& rect, float* out, std::size_t stride) const;
  /// Returns the values of tile (tx, ty), x fastest; null if they are unknown. A tile that is not
  /// in memory is computed into `buffer`, and the result points to `buffer`.
  const float* passing(int tx, int ty, Values& buffer) const;
  /// Returns true if this layer and `other` share tile (tx, ty), so that its values are identical.
  /// False does not mean that values differ. Both must belong to the same site.
  bool shares(const LayerTiles& other, int tx, int ty) const;
  /// Writes the value of column (ix, iy) and returns true if that changed it. If the tile was last
  /// written in another edition, it is copied first.
  bool set(int ix, int iy, float value, std::uint64_t edition);

 private:
  /// A tile that was written with `set`.
  struct WrittenTile {
    /// Values of the tile, x fastest.
    Values values;
    /// Edition in which the tile was created or copied. Writes in this edition change the tile in
    /// place; writes in another edition copy it first.
    std::uint64_t edition = 0;
  };
  /// The source of a layer, with the tiles that it computed because a reader requested one of their
  /// columns.
  struct Asked;
  /// Returns the index of the tile that contains column (ix, iy).
  std::size_t tile_of(int ix, int iy) const {
    return static_cast<std::size_t>(iy / kSide) * static_cast<std::size_t>(across_) +
           static_cast<std::size_t>(ix / kSide);
  }
  /// Returns the index of column (ix, iy) within its tile.
  static std::size_t place(int ix, int iy) {
    return static_cast<std::size_t>(iy % kSide * kSide + ix % kSide);
  }
  /// Returns the values of a tile, x fastest, and computes them if necessary; null if they are
  /// unknown.
  const float* values(std::size_t tile) const {
    if (const WrittenTile* written = tiles_[tile].get()) return written->values.data();
    return asked_ ? ask(tile) : nullptr;
  }
  /// Returns the values of a tile that no one wrote to, x fastest. Computes them by the source and
  /// stores them if no reader requested the tile before.
  const float* ask(std::size_t tile) const;
  /// Returns the values of a tile, x fastest, if they are in memory; null if they are not.
  const float* present(std::size_t tile) const;
  /// Computes the values of a tile by the source and writes them to `to`.
  void compute(std::size_t tile, Values& to) const;

  /// Number of columns along x and y, and number of tiles along x.
  int nx_ = 0, ny_ = 0, across_ = 0;
  /// Tiles, x fastest; null where a tile was never written. Empty if the map does not contain the
  /// layer.
  std::vector<std::shared_ptr<WrittenTile>> tiles_;
  /// Source that computes the tiles without a written value, and the tiles it has computed so far;
  /// null if there is no source.
  std::shared_ptr<const Asked> asked_;
};

/// Layers of a site at one instant. Immutable, cheap to copy, and readable by any number of
/// threads.
///
/// Columns are numbered as in heightfield::GroundSetup: (0, 0) has the smallest x and y, and x runs
/// fastest. Maps are made by MapMaker, or by `with` from other values.
class TerrainMap {
 public:
  /// Makes a map without layers. Copies size, position, soils and georeference from `setup`. `time`
  /// is the simulated time [s].
  TerrainMap(const heightfield::GroundSetup& setup, double time, std::uint64_t sequence);

  /// Returns grid, soils and georeference of the site. The function `surface` in it is empty.
  const heightfield::GroundSetup& setup() const { return *setup_; }
  /// Returns the number of columns along x.
  int nx() const { return setup_->nx; }
  /// Returns the number of columns along y.
  int ny() const { return setup_->ny; }
  /// Returns the edge length of a column [m].
  double cell() const { return setup_->cell; }
  /// Returns the world (x, y) of the corner of the site with the smallest x and y [m].
  const Vec2& origin() const { return setup_->origin; }
  /// Returns the simulated time of the map [s]; NaN if it is unknown.
  double time() const { return time_; }
  /// Returns the sequence number of the map, which increases by 1 with each update of the
  /// UpdateFeed or MapMaker that made the map. The first one is 1.
  std::uint64_t sequence() const { return sequence_; }
  /// Returns the rectangle of all columns of the site.
  heightfield::CellRect rect() const { return {0, 0, nx(), ny()}; }
  /// Returns true if the site has a column (ix, iy).
  bool contains(int ix, int iy) const { return rect().contains(ix, iy); }

  /// Returns true if the map contains `layer`. If not, all values of the layer are unknown.
  bool has(MapLayer layer) const { return !tiles_[index_of(layer)].empty(); }
  /// Returns the value of `layer` in column (ix, iy); kUnknown outside the site, and if the map
  /// does not contain the layer.
  float at(MapLayer layer, int ix, int iy) const {
    const LayerTiles& tiles = tiles_[index_of(layer)];
    return !tiles.empty() && contains(ix, iy) ? tiles.at(ix, iy) : kUnknown;
  }
  /// Returns the values of `layer` for the columns in `rect`: x fastest, beginning with the row of
  /// smallest y; kUnknown outside the site.
  std::vector<float> copy(MapLayer layer, const heightfield::CellRect& rect) const;
  /// Returns the values of `layer` for the whole site: x fastest, beginning with the row of
  /// smallest y.
  std::vector<float> copy(MapLayer layer) const { return copy(layer, rect()); }
  /// Returns the values of `layer`, stored in tiles.
  const LayerTiles& tiles(MapLayer layer) const { return tiles_[index_of(layer)]; }

  /// Returns a copy of this map whose `layer` has the given values, one for each of the nx x ny
  /// columns, x fastest. @throws Error if the number of values is wrong.
  TerrainMap with(MapLayer layer, std::span<const float> values) const;
  /// Returns this map with the given sequence number. Moves the layers, because copying them takes
  /// time on a large site.
  TerrainMap numbered(std::uint64_t sequence) &&;

 private:
  friend class MapMaker;
  friend TerrainMap make_map(const std::shared_ptr<const SiteColumns>& site,
                             std::uint64_t sequence);
  /// Description of the site, shared by all maps of the site.
  std::shared_ptr<const heightfield::GroundSetup> setup_;
  /// Simulated time of the map [s]; NaN if it is unknown.
  double time_;
  /// Sequence number of the map.
  std::uint64_t sequence_;
  /// Values of each layer, in the order of MapLayer.
  std::array<LayerTiles, kMapLayers> tiles_;
};

}  // namespace navvy::map
