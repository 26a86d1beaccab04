// SPDX-License-Identifier: Apache-2.0
// The ground as triangles: tiles of 64 x 64 columns, each at the level of detail that the camera
// needs.
#pragma once

#include <array>
#include <vector>

#include "render/ground_surface.h"
#include "render/view.h"

namespace navvy::render {

/// Triangles over shared vertices.
struct Mesh {
  std::vector<Vertex> vertices;
  std::vector<std::uint32_t> indices;
  std::vector<std::uint32_t> walls;  ///< steep triangles: the grain lies on them from the side
  /// Strips hanging from the south, east, north and west edge, triangles of one colour each
  /// (slivers would smear shaded colours).
  std::array<std::vector<std::uint32_t>, 4> skirts;
};

/// One piece of ground to draw: its mesh, which of its skirts are needed, and the box it lies in.
struct GroundPart {
  const Mesh* mesh = nullptr;
  std::array<bool, 4> skirts = {true, true, true, true};
  Vec3f low = Vec3f::Zero(), high = Vec3f::Zero();
  /// With those of the skirts that are needed.
  std::size_t triangles() const;
};

/// Tiles are made when first seen at a level and kept until their columns change. Seams between
/// levels are closed by skirts. At full detail walls get triangles of their own, so that an edge
/// stays sharp in light.
class TerrainMesh {
 public:
  static constexpr int kTile = 64;     ///< columns along a tile
  static constexpr int kMaxLevel = 5;  ///< strides 1, 2, 4 ... 32

  /// Brings the copy of the ground up to date.
  void update(const scene::FrameGround& ground, const Lighting& lighting);
  /// Chooses and builds the tiles that `view` needs, nearest first, at most about `budget`
  /// triangles. Skirts are wanted where the neighbour has another level.
  std::vector<GroundPart> select(const View& view, int budget);
  /// Ground beyond the site's edge, from the edge's heights out to the haze.
  GroundPart surroundings(const Lighting& lighting);

  /// The copy of the ground that the triangles are made from.
  const GroundSurface& surface() const { return surface_; }
  /// Tiles built since the last update, for tests and benches.
  int rebuilt() const { return rebuilt_; }

 private:
  struct Tile {
    Mesh mesh;
    int level = -1;      ///< of the mesh; -1: none or stale
    bool rough = false;  ///< holds walls: wants finer detail
    Vec3f low, high;
  };
  /// Cells along a tile; fewer at the far edges.
  int nodes_x(int tile) const {
    return std::min(surface_.nx() - 1, (tile + 1) * kTile) - tile * kTile;
  }
  int nodes_y(int tile) const {
    return std::min(surface_.ny() - 1, (tile + 1) * kTile) - tile * kTile;
  }
  /// Finds the box of a tile and whether it holds walls.
  void measure(int tx, int ty);
  /// Makes the mesh of a tile at a stride of 2^level columns.
  void build(int tx, int ty, int level);
  /// Level of the neighbour at (dx, dy) of a tile, -1 beyond the site's edge.
  int neighbour_level(int tile, int dx, int dy, const View& view, float pixels) const;
  /// The coarsest level at which a cell covers no more than `pixels` of the picture.
  int wanted_level(const Tile& tile, const View& view, float pixels) const;

  GroundSurface surface_;
  int tiles_x_ = 0, tiles_y_ = 0;
  std::vector<Tile> tiles_;
  Mesh surroundings_;
  bool surroundings_stale_ = true;
  int rebuilt_ = 0;
};

}  // namespace navvy::render
