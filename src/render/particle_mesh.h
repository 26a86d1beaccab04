// SPDX-License-Identifier: Apache-2.0
// Loose soil as lit, irregular lumps of a few triangles; lumps buried in others are left out.
#pragma once

#include <vector>

#include "render/ground_surface.h"
#include "render/shadow_map.h"
#include "render/terrain_mesh.h"
#include "render/view.h"

namespace navvy::render {

/// Builds one mesh of all visible particles. Its cost grows with the particles on the outside of
/// the soil: it skips particles enclosed by others and those outside the picture.
class ParticleMesh {
 public:
  /// Number of triangles above which lumps have eight faces instead of twenty, whatever their size.
  static constexpr int kTriangleBudget = 100000;

  /// Builds the mesh, which is valid until the next call. Position, size and colour of a lump
  /// follow from the particle's number (or id), so that a lump keeps its appearance. @throws Error
  /// when the frame's arrays do not match each other.
  const Mesh& build(const scene::Frame& frame, const Lighting& lighting, const ShadowMap& shadows,
                    const GroundSurface& surface, const View& view);
  /// Number of lumps in the last mesh.
  int drawn() const { return drawn_; }

 private:
  // A lump to draw: its position, the direction out of the heap, and how much of the sky it sees.
  struct Lump {
    // In W [m]; `outward` is a unit vector.
    Vec3f center, outward;
    // Share of the sky, 0 to 1, and distance from the eye [m].
    float open, distance;
    // Largest radius that does not reach through a plate [m].
    float most;
    std::uint32_t seed;
    // Index of the soil, for its colour.
    std::uint8_t soil;
  };
  // A set of the cells that hold particles. Only occupancy is ever asked for, so particles are not
  // sorted.
  void fill_table(const scene::FrameParticles& particles);
  bool occupied(std::int32_t x, std::int32_t y, std::int32_t z) const;
  // Returns true when all cells towards the eye are occupied.
  bool hidden(const Vec3f& local, const Vec3f& to_eye) const;
  void look_around(const Vec3f& local, Vec3f& outward, float& open) const;
  // Adds the lump's lit corners and its faces.
  void add_lump(const Lump& lump, float radius, int detail, const Vec3f& albedo,
                const Lighting& lighting, float sun);

  // Kept from picture to picture to reuse its memory.
  Mesh mesh_;
  // Open addressing; 0 = free.
  std::vector<std::uint64_t> table_;
  // The table's size is a power of two, so that a mask gives the index.
  std::size_t table_mask_ = 0;
  // Edge length of a cell of the set: a particle's width [m].
  float pitch_ = 0.06f;
  std::vector<Lump> lumps_;
  int drawn_ = 0;
};

}  // namespace navvy::render
