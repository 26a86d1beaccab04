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

/// What a layer holds where nothing is known: a comparison with it is false. Always this very NaN.
inline constexpr float kUnknown = std::numeric_limits<float>::quiet_NaN();

/// Values of the tiles that nobody wrote to: a pure function of place, computed when somebody asks.
/// Any number of threads may ask at a time.
class LayerSource {
 public:
  virtual ~LayerSource() = default;
  /// Writes the values of `layer` over `rect`, which lies within the site, to `out`: x fastest, row
  /// after row, `stride` values from one row to the next. Unknown is kUnknown and no other NaN.
  /// @throws InputError where the site's heights cannot be had.
  virtual void fill(MapLayer layer, const heightfield::CellRect& rect, float* out,
                    std::size_t stride) const = 0;
};

/// The values of one layer in tiles of 64 x 64 columns, shared between maps of successive instants.
///
/// One thread writes, and tells with every write the edition that it works on; a tile of an earlier
/// edition is copied first (16 KiB), so copies made before stay as they were. A tile that nobody
/// wrote to takes no memory: it is unknown, or what a source says. Who asks for columns of such a
/// tile has it computed and kept for all who share it; a pass over many (`copy`, `passing`) keeps
/// nothing.
class LayerTiles {
 public:
  /// Columns along a side of a tile. A bucket's dig touches one to four of them.
  static constexpr int kSide = 64;
  using Values = std::array<float, static_cast<std::size_t>(kSide) * kSide>;
  /// Of no layer at all.
  LayerTiles() = default;
  /// As `source` says everywhere; unknown where there is none.
  LayerTiles(int nx, int ny, MapLayer layer, std::shared_ptr<const LayerSource> source);

  bool empty() const { return tiles_.empty(); }
  /// Of a column of the site; nothing is checked.
  float at(int ix, int iy) const {
    const float* tile = values(tile_of(ix, iy));
    return tile != nullptr ? tile[place(ix, iy)] : kUnknown;
  }
  /// The values of columns ix to the end of their tile's row, null where the tile is unknown;
  /// `count` says how many.
  const float* row(int ix, int iy, int& count) const {
    count = kSide - ix % kSide;
    const float* tile = values(tile_of(ix, iy));
    return tile != nullptr ? tile + place(ix, iy) : nullptr;
  }
  /// A tile as it lies in memory, rows along y, columns along x.
  using View = Eigen::Map<const Eigen::Array<float, kSide, kSide, Eigen::RowMajor>>;
  /// Tile (tx, ty), columns 64 tx to 64 tx + 63: no copy, valid as long as a map that has it.
  /// Beyond the site's edge, and where nothing is known, unknown.
  View view(int tx, int ty) const;
  /// Dense copy over `rect`, which lies within the site, x fastest, `stride` values from row to
  /// row.
  void copy(const heightfield::CellRect& rect, float* out, std::size_t stride) const;
  /// The values of tile (tx, ty), null where it is unknown. What is not in memory goes to `buffer`.
  const float* passing(int tx, int ty, Values& buffer) const;
  /// Whether a tile is the same in both because nobody wrote to it in between. For layers of one
  /// site.
  bool shares(const LayerTiles& other, int tx, int ty) const;
  /// Writes one column, unless it has that value already: says whether it was another. Costs a copy
  /// of its tile where a map of an earlier edition may hold that.
  bool set(int ix, int iy, float value, std::uint64_t edition);

 private:
  struct Tile {
    Values values;
    std::uint64_t edition = 0;
  };
  /// Tiles that somebody asked a source for.
  struct Asked;
  std::size_t tile_of(int ix, int iy) const {
    return static_cast<std::size_t>(iy / kSide) * static_cast<std::size_t>(across_) +
           static_cast<std::size_t>(ix / kSide);
  }
  static std::size_t place(int ix, int iy) {
    return static_cast<std::size_t>(iy % kSide * kSide + ix % kSide);
  }
  /// Of a tile, computed now if need be; null where it is unknown.
  const float* values(std::size_t tile) const {
    if (const Tile* written = tiles_[tile].get()) return written->values.data();
    return asked_ ? ask(tile) : nullptr;
  }
  const float* ask(std::size_t tile) const;
  /// Of a tile that is in memory, else null.
  const float* present(std::size_t tile) const;
  void compute(std::size_t tile, Values& to) const;

  int nx_ = 0, ny_ = 0, across_ = 0;
  std::vector<std::shared_ptr<Tile>> tiles_;
  std::shared_ptr<const Asked> asked_;
};

/// Layers of a site at one instant: immutable, cheap to copy, to be read by any number of threads.
///
/// Columns are numbered as in heightfield::GroundSetup: (0, 0) has least x and least y, x runs
/// fastest. Made by a MapMaker, or of values from elsewhere.
class TerrainMap {
 public:
  /// Without any layer yet. Of `setup` the size, the place, the soils and the georeference are
  /// kept.
  TerrainMap(const heightfield::GroundSetup& setup, double time, std::uint64_t sequence);

  const heightfield::GroundSetup& setup() const { return *setup_; }
  int nx() const { return setup_->nx; }
  int ny() const { return setup_->ny; }
  double cell() const { return setup_->cell; }           ///< [m]
  const Vec2& origin() const { return setup_->origin; }  ///< W of the lower-left corner [m]
  /// Simulated [s]; NaN where what it was made of does not tell.
  double time() const { return time_; }
  /// Number of the update that made it: in an UpdateFeed the feed's, else of the MapMaker's
  /// `update`, from 1 on.
  std::uint64_t sequence() const { return sequence_; }
  heightfield::CellRect rect() const { return {0, 0, nx(), ny()}; }
  bool contains(int ix, int iy) const { return rect().contains(ix, iy); }

  /// Whether it was made with this layer; without it every value of it is unknown.
  bool has(MapLayer layer) const { return !tiles_[index_of(layer)].empty(); }
  /// Of one column; unknown (NaN) outside the site.
  float at(MapLayer layer, int ix, int iy) const {
    const LayerTiles& tiles = tiles_[index_of(layer)];
    return !tiles.empty() && contains(ix, iy) ? tiles.at(ix, iy) : kUnknown;
  }
  /// Dense copy over `rect`, x fastest, row 0 with least y; unknown where the rectangle leaves the
  /// site.
  std::vector<float> copy(MapLayer layer, const heightfield::CellRect& rect) const;
  std::vector<float> copy(MapLayer layer) const { return copy(layer, rect()); }
  /// The values themselves, tile by tile.
  const LayerTiles& tiles(MapLayer layer) const { return tiles_[index_of(layer)]; }

  /// This map with `values` (nx x ny, x fastest) as that layer. @throws Error when their number
  /// does not fit.
  TerrainMap with(MapLayer layer, std::span<const float> values) const;
  /// This map with what `source` says as that layer; null: unknown everywhere.
  TerrainMap with(MapLayer layer, std::shared_ptr<const LayerSource> source) const;
  /// This map, which goes, under another number.
  TerrainMap numbered(std::uint64_t sequence) &&;

 private:
  friend class MapMaker;
  friend TerrainMap make_map(const std::shared_ptr<const SiteColumns>& site,
                             std::uint64_t sequence);
  // Shared between all maps of a site.
  std::shared_ptr<const heightfield::GroundSetup> setup_;
  double time_;
  std::uint64_t sequence_;
  std::array<LayerTiles, kMapLayers> tiles_;
};

}  // namespace navvy::map
