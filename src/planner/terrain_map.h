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
#include "planner/layers.h"

namespace navvy::planner {

/// What a layer holds where nothing is known: a comparison with it is false. Always this very NaN.
inline constexpr float kUnknown = std::numeric_limits<float>::quiet_NaN();

/// The values of one layer in tiles of 64 x 64 columns, shared between maps of successive instants.
///
/// One thread writes, and tells with every write the edition that it works on; a tile of an earlier edition is copied
/// first (16 KiB), so copies made before stay as they were. A tile that nobody wrote to is unknown and takes no memory.
class LayerTiles {
 public:
  /// Columns along a side of a tile. A bucket's dig touches one to four of them.
  static constexpr int kSide = 64;
  /// Of no layer at all.
  LayerTiles() = default;
  /// Unknown everywhere.
  LayerTiles(int nx, int ny);

  bool empty() const { return tiles_.empty(); }
  /// Of a column of the site; nothing is checked.
  float at(int ix, int iy) const {
    const Tile* tile = tiles_[tile_of(ix, iy)].get();
    return tile != nullptr ? tile->values[place(ix, iy)] : kUnknown;
  }
  /// The values of columns ix to the end of their tile's row, null where the tile is unknown; `count` says how many.
  const float* row(int ix, int iy, int& count) const {
    count = kSide - ix % kSide;
    const Tile* tile = tiles_[tile_of(ix, iy)].get();
    return tile != nullptr ? tile->values.data() + place(ix, iy) : nullptr;
  }
  /// A tile as it lies in memory, rows along y, columns along x.
  using View = Eigen::Map<const Eigen::Array<float, kSide, kSide, Eigen::RowMajor>>;
  /// Tile (tx, ty), columns 64 tx to 64 tx + 63: no copy, valid as long as a map that has it. Beyond the site's edge,
  /// and where nothing was written, unknown.
  View view(int tx, int ty) const;
  /// Writes one column; costs a copy of its tile where a map of an earlier edition may hold that.
  void set(int ix, int iy, float value, std::uint64_t edition);

 private:
  struct Tile {
    std::array<float, static_cast<std::size_t>(kSide) * kSide> values;
    std::uint64_t edition = 0;
  };
  std::size_t tile_of(int ix, int iy) const {
    return static_cast<std::size_t>(iy / kSide) * static_cast<std::size_t>(across_) +
           static_cast<std::size_t>(ix / kSide);
  }
  static std::size_t place(int ix, int iy) { return static_cast<std::size_t>(iy % kSide * kSide + ix % kSide); }
  int across_ = 0;
  std::vector<std::shared_ptr<Tile>> tiles_;
};

/// Layers of a site at one instant: immutable, cheap to copy, to be read by any number of threads.
///
/// Columns are numbered as in heightfield::GroundSetup: (0, 0) has least x and least y, x runs fastest. Made by a
/// MapMaker, or of values from elsewhere.
class TerrainMap {
 public:
  /// Without any layer yet. Of `setup` the size, the place, the soils and the georeference are kept.
  TerrainMap(const heightfield::GroundSetup& setup, double time, std::uint64_t sequence);

  const heightfield::GroundSetup& setup() const { return *setup_; }
  int nx() const { return setup_->nx; }
  int ny() const { return setup_->ny; }
  double cell() const { return setup_->cell; }           ///< [m]
  const Vec2& origin() const { return setup_->origin; }  ///< W of the lower-left corner [m]
  double time() const { return time_; }                  ///< simulated [s]; NaN where what it was made of does not tell
  std::uint64_t sequence() const { return sequence_; }   ///< number of the update that made it
  heightfield::CellRect rect() const { return {0, 0, nx(), ny()}; }
  bool contains(int ix, int iy) const { return rect().contains(ix, iy); }

  /// Whether it was made with this layer; without it every value of it is unknown.
  bool has(Layer layer) const { return !tiles_[index_of(layer)].empty(); }
  /// Of one column; unknown (NaN) outside the site.
  float at(Layer layer, int ix, int iy) const {
    const LayerTiles& tiles = tiles_[index_of(layer)];
    return !tiles.empty() && contains(ix, iy) ? tiles.at(ix, iy) : kUnknown;
  }
  /// Dense copy over `rect`, x fastest, row 0 with least y; unknown where the rectangle leaves the site.
  std::vector<float> copy(Layer layer, const heightfield::CellRect& rect) const;
  std::vector<float> copy(Layer layer) const { return copy(layer, rect()); }
  /// The values themselves, tile by tile.
  const LayerTiles& tiles(Layer layer) const { return tiles_[index_of(layer)]; }

  /// This map with `values` (nx x ny, x fastest) as that layer. @throws Error when their number does not fit.
  TerrainMap with(Layer layer, std::span<const float> values) const;

 private:
  friend class MapMaker;
  // Shared between all maps of a site.
  std::shared_ptr<const heightfield::GroundSetup> setup_;
  double time_;
  std::uint64_t sequence_;
  std::array<LayerTiles, kLayers> tiles_;
};

}  // namespace navvy::planner
