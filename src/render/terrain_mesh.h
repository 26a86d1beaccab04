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
  /// Steep triangles, on which the grain texture is projected from the side.
  std::vector<std::uint32_t> walls;
  /// Strips hanging from the south, east, north and west edge, one colour per triangle (shaded
  /// slivers would smear colours).
  std::array<std::vector<std::uint32_t>, 4> skirts;
};

/// One piece of ground to draw: its mesh, the skirts it needs, and its bounding box [m].
struct GroundPart {
  const Mesh* mesh = nullptr;
  std::array<bool, 4> skirts = {true, true, true, true};
  Vec3f low = Vec3f::Zero(), high = Vec3f::Zero();
  /// Number of triangles, including the needed skirts.
  std::size_t triangles() const;
};

/// Ground as tiles, built when first seen at a level and kept until their columns change. Skirts
/// close the seams between levels. At full detail walls have triangles of their own, so that an
/// edge stays sharp in light.
class TerrainMesh {
 public:
  /// Columns along a tile.
  static constexpr int kTile = 64;
  /// Coarsest level; strides are 1, 2, 4 ... 32 columns.
  static constexpr int kMaxLevel = 5;

  /// Updates the copy of the ground.
  void update(const scene::FrameGround& ground, const Lighting& lighting);
  /// Selects and builds the tiles that `view` needs, nearest first, at most about `budget`
  /// triangles. A tile needs skirts where its neighbour has another level.
  std::vector<GroundPart> select(const View& view, int budget);
  /// Returns the ground beyond the site's edge, from the edge's heights out to the haze.
  GroundPart surroundings(const Lighting& lighting);

  /// Returns the copy of the ground from which the triangles are built.
  const GroundSurface& surface() const { return surface_; }
  /// Number of tiles built since the last update, for tests and benches.
  int rebuilt() const { return rebuilt_; }

 private:
  struct Tile {
    Mesh mesh;
    // Level of the mesh; -1: none or out of date.
    int level = -1;
    // True when it holds walls and needs finer detail.
    bool rough = false;
    Vec3f low, high;
  };
  /// Cells along a tile; fewer at the far edges.
  int nodes_x(int tile) const {
    return std::min(surface_.nx() - 1, (tile + 1) * kTile) - tile * kTile;
  }
  int nodes_y(int tile) const {
    return std::min(surface_.ny() - 1, (tile + 1) * kTile) - tile * kTile;
  }
  /// Computes the box of a tile and whether it holds walls.
  void measure(int tx, int ty);
  /// Builds the mesh of a tile at a stride of 2^level columns.
  void build(int tx, int ty, int level);
  /// Returns the level of the neighbour at (dx, dy) of a tile, -1 beyond the site's edge.
  int neighbour_level(int tile, int dx, int dy, const View& view, float pixels) const;
  /// Returns the coarsest level at which a cell covers at most `pixels` of the picture.
  int wanted_level(const Tile& tile, const View& view, float pixels) const;

  GroundSurface surface_;
  int tiles_x_ = 0, tiles_y_ = 0;
  std::vector<Tile> tiles_;
  Mesh surroundings_;
  bool surroundings_stale_ = true;
  int rebuilt_ = 0;
};

}  // namespace navvy::render
