// SPDX-License-Identifier: Apache-2.0
// Triangle mesh of the ground. It consists of tiles of 64 x 64 columns, each with the level of
// detail that the camera needs.
#pragma once

#include <array>
#include <vector>

#include "render/ground_surface.h"
#include "render/view.h"

namespace navvy::render {

/// Triangles with shared vertices. Every index list holds three vertex indices per triangle.
struct Mesh {
  /// Vertices of all triangles.
  std::vector<Vertex> vertices;
  /// All triangles except those in `walls` and `skirts`.
  std::vector<std::uint32_t> indices;
  /// Steep triangles, on which the grain texture is projected from the side.
  std::vector<std::uint32_t> walls;
  /// Vertical strips of triangles that hang down from the south, east, north and west edge, and
  /// hide gaps to neighbouring meshes. Each triangle has one colour, because colours interpolated
  /// over such narrow triangles would be smeared.
  std::array<std::vector<std::uint32_t>, 4> skirts;
};

/// A piece of the ground to draw.
struct GroundPart {
  /// Mesh of this piece of ground. TerrainMesh owns it; the pointer is valid until the next call of
  /// TerrainMesh::select or update.
  const Mesh* mesh = nullptr;
  /// True for each skirt that must be drawn: south, east, north, west.
  std::array<bool, 4> skirts = {true, true, true, true};
  /// Corners of the bounding box in W [m].
  Vec3f low = Vec3f::Zero(), high = Vec3f::Zero();
  /// True if the colours of the mesh contain the shadows of the machines.
  bool shadowed = false;
  /// Returns the number of triangles to draw, including the skirts that must be drawn.
  std::size_t triangles() const;
};

/// Mesh of the ground, divided into tiles. A tile is built when it is first visible at a level of
/// detail, and reused until the level or the columns of the tile change.
///
/// Level 0 has one vertex per column, and each further level doubles the distance between vertices.
/// Skirts hide the gaps between tiles of different levels. At level 0, walls (steep slopes) have
/// their own vertices, so that their edges look sharp.
class TerrainMesh {
 public:
  /// Number of columns along the edge of a tile.
  static constexpr int kTile = 64;
  /// Coarsest level of detail. At the levels 0 to 5, vertices are 1, 2, 4, ... 32 columns apart.
  static constexpr int kMaxLevel = 5;

  /// Creates a mesh without ground. `smooth` is that of GroundSurface.
  explicit TerrainMesh(bool smooth = true) : surface_(smooth) {}
  /// Updates the copy of the ground from a frame, and marks the tiles that have changed.
  void update(const scene::FrameGround& ground, const Lighting& lighting);
  /// Returns the tiles that are visible in `view`, nearest first, and builds their meshes where
  /// necessary. The levels of detail are chosen so that the total is about `budget` triangles at
  /// most. A tile needs a skirt on each side where the neighbour has another level.
  std::vector<GroundPart> select(const View& view, int budget);
  /// Returns the ground beyond the edge of the site. It starts at the heights of the edge and
  /// reaches out to where haze hides everything.
  GroundPart surroundings(const Lighting& lighting);

  /// Returns the copy of the ground from which the triangles are built.
  const GroundSurface& surface() const { return surface_; }
  /// Returns the number of tiles built since the last `update`.
  int rebuilt() const { return rebuilt_; }

 private:
  // A tile of the ground.
  struct Tile {
    // Triangles of the tile at the level `level`.
    Mesh mesh;
    // Level of detail of the mesh; -1 if there is no mesh or if it is out of date.
    int level = -1;
    // True if the tile contains walls or loose soil, which need a finer level.
    bool rough = false;
    // Corners of the bounding box in W [m].
    Vec3f low, high;
  };
  // Returns the number of cells of a tile in x direction: kTile, or fewer at the edge of the site.
  // A cell is the square between the centres of four neighbouring columns.
  int nodes_x(int tile) const {
    return std::min(surface_.nx() - 1, (tile + 1) * kTile) - tile * kTile;
  }
  // Returns the number of cells of a tile in y direction.
  int nodes_y(int tile) const {
    return std::min(surface_.ny() - 1, (tile + 1) * kTile) - tile * kTile;
  }
  // Computes the bounding box of a tile and whether it contains walls or loose soil.
  void measure(int tx, int ty);
  // Builds the mesh of a tile at a level of detail.
  void build(int tx, int ty, int level);
  // Returns the level of the tile at the offset (dx, dy) [tiles] from the tile with the index
  // `tile`; -1 beyond the edge of the site.
  int neighbour_level(int tile, int dx, int dy, const View& view, float pixels) const;
  // Returns the coarsest level at which a cell of the mesh covers at most `pixels` [pixels] in the
  // picture.
  int wanted_level(const Tile& tile, const View& view, float pixels) const;

  // Copy of the ground.
  GroundSurface surface_;
  // Number of tiles in x and y direction.
  int tiles_x_ = 0, tiles_y_ = 0;
  // All tiles, row by row in y direction; x varies fastest.
  std::vector<Tile> tiles_;
  // Ground beyond the edge of the site.
  Mesh surroundings_;
  // True if `surroundings_` must be built again.
  bool surroundings_stale_ = true;
  // Number of tiles built since the last `update`.
  int rebuilt_ = 0;
};

}  // namespace navvy::render
