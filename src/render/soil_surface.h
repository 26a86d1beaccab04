// SPDX-License-Identifier: Apache-2.0
// Draws active soil as one surface that continues into the resting ground.
#pragma once

#include <vector>

#include "render/density_field.h"
#include "render/shadow_map.h"
#include "render/terrain_mesh.h"

namespace navvy::render {

/// Builds one mesh of the surface of all loose soil that lies together: in heaps, in buckets, and
/// in clods that fall. Particles too few for a surface are left to ParticleMesh.
///
/// The surface is where soil fills about half of space (DensityField), found by surface nets
/// [Gibson 1998]: one vertex in each cell of nodes that it crosses, one quadrilateral across each
/// edge. Beside the plates of a tool vertices stay on the particles' side of the plate.
class SoilSurface {
 public:
  /// Returns the mesh, valid until the next call. @throws Error if the sizes of the frame's
  /// particle arrays do not match.
  const Mesh& build(const scene::Frame& frame, const Lighting& lighting, const ShadowMap& shadows,
                    const GroundSurface& surface);
  /// Returns for each particle of the last frame whether it belongs to no surface (1) or to one
  /// (0).
  const std::vector<std::uint8_t>& lone() const { return lone_; }
  /// Returns the mesh as a part to draw with the ground; nothing hangs from its edges.
  GroundPart part() const;

 private:
  // Number that marks a cell without a vertex.
  static constexpr std::uint32_t kNone = 0xffffffffu;
  // Nodes along the edge of a block with the first ones of the next block.
  static constexpr int kCorners = DensityField::kEdge + 1;
  // The cells of a block; a cell is named by its lowest node.
  struct Cells {
    // Vertex of each cell.
    std::array<std::uint32_t, DensityField::kNodes> vertex;
    // 1 for each corner within the soil, x fastest.
    std::array<std::uint8_t, kCorners * kCorners * kCorners> inside;
    // False if the surface crosses no cell of the block.
    bool crossed;
  };
  // What the colour of a vertex depends on.
  struct Scene {
    const Lighting& lighting;
    const ShadowMap& shadows;
    const GroundSurface& surface;
  };

  // A vertex of the surface.
  struct Place {
    const DensityField::Block& block;
    // Position in nodes from the first one of `block`, and in W [m].
    Vec3f local, p_W;
    // Unit normal in W.
    Vec3f normal;
    // Index of the soil.
    std::uint8_t soil;
    // Ground below, and how far the vertex is from lying on it (apart_from).
    GroundLook ground;
    float apart;
  };

  // Finds which corners of a block's cells are within the soil.
  void find_inside(int block);
  // Adds the vertices of all cells of a block that the surface crosses.
  void add_vertices(const Scene& scene, int block);
  // Adds the vertex of the cell (x, y, z), which the surface crosses; nothing if no loose soil is
  // near. Returns its index, or kNone.
  std::uint32_t add_vertex(const Scene& scene, const DensityField::Block& block, int x, int y,
                           int z);
  // Moves a point of the surface in W [m] back to the particles' side of the plates beside it.
  Vec3f kept_off_plates(const DensityField::Block& block, Vec3f p_W) const;
  // Returns how far soil at the height `z` [m] is from lying on the ground below it: 0 to 1.
  float apart_from(const GroundLook& ground, float z) const;
  // Returns the colour of a vertex.
  Vec3f color(const Scene& scene, const Place& at) const;
  // Adds the quadrilaterals across the edges that start at the nodes of a block.
  void add_faces(int block);
  // Adds the quadrilateral across the edge that starts at a node of a block along `axis`; `inside`:
  // its first node is within the soil.
  void add_face(const DensityField::Block& block, const Eigen::Vector3i& node, int axis,
                bool inside);
  // Returns the vertex of a cell at (x, y, z) from the block's first node, -1 to 7 each.
  std::uint32_t vertex(const DensityField::Block& block, const Eigen::Vector3i& cell) const;

  // Share of space that soil fills.
  DensityField field_;
  // One entry per block of the field, in its order.
  std::vector<Cells> cells_;
  // The last mesh; reused in order to reuse its memory.
  Mesh mesh_;
  // One entry per vertex: 1 if the surface is steep there.
  std::vector<std::uint8_t> steep_;
  // One entry per particle.
  std::vector<std::uint8_t> lone_;
  // Corners of the mesh's bounding box in W [m].
  Vec3f low_ = Vec3f::Zero(), high_ = Vec3f::Zero();
};

}  // namespace navvy::render
