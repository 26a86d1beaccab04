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
    // Share that soil fills at each corner, x fastest: read many times, so copied together.
    std::array<float, kCorners * kCorners * kCorners> all;
  };
  // What the colour of a vertex depends on.
  struct Scene {
    const scene::Frame& frame;
    const Lighting& lighting;
    const ShadowMap& shadows;
    const GroundSurface& surface;
  };

  // Copies the shares at the corners of a block's cells.
  void copy_corners(int block);
  // Adds the vertices of all cells of a block that the surface crosses.
  void add_vertices(const Scene& scene, int block);
  // Returns the point at which the surface crosses a cell, in nodes from the block's first one;
  // false if it does not, or if no loose soil is near.
  bool crossing(const DensityField::Block& block, const Eigen::Vector3i& cell, Vec3f& p) const;
  // Moves a point of the surface in W [m] back to the particles' side of the plates beside it.
  Vec3f kept_off_plates(const scene::FrameParticles& particles, const DensityField::Block& block,
                        Vec3f p_W) const;
  // Returns the colour of a vertex.
  Vec3f color(const Scene& scene, const DensityField::Block& block, const Vec3f& local,
              const Vec3f& p_W, const Vec3f& normal) const;
  // Adds the quadrilaterals across the edges that start at the nodes of a block.
  void add_faces(int block);
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
