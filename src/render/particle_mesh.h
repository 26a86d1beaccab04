// SPDX-License-Identifier: Apache-2.0
// Loose soil as lit crumbs: irregular lumps of a few triangles; those buried in others are left
// out.
#pragma once

#include <vector>

#include "render/ground_surface.h"
#include "render/shadow_map.h"
#include "render/terrain_mesh.h"
#include "render/view.h"

namespace navvy::render {

/// Makes one mesh of all visible particles. Cost grows with the particles on the outside of the
/// soil. It hides what nobody can see: particles shut in by others, and those outside the picture.
class ParticleMesh {
 public:
  /// Above it lumps are drawn with eight faces instead of twenty, however large they are
  /// [triangles].
  static constexpr int kTriangleBudget = 100000;

  /// Positions, sizes and colours follow from the particle's number (or id), so that a lump keeps
  /// its looks. The mesh lives here until the next `build`.
  /// @throws Error when the frame's arrays do not fit each other.
  const Mesh& build(const scene::Frame& frame, const Lighting& lighting, const ShadowMap& shadows,
                    const GroundSurface& surface, const View& view);
  /// Lumps in the mesh of the last `build`.
  int drawn() const { return drawn_; }

 private:
  // A lump that will be drawn: where, which way is out of the heap, and how much of the sky it
  // sees.
  struct Lump {
    // In W [m]; `outward` is a unit vector.
    Vec3f center, outward;
    // Share of the sky, 0 to 1, and the distance from the eye [m].
    float open, distance;
    // Largest radius that does not reach through a plate [m].
    float most;
    std::uint32_t seed;
    // Number of the soil, for its colour.
    std::uint8_t soil;
  };
  // The set of cells that hold particles, for the three questions below. Only whether a cell holds
  // any is ever asked, so the particles are not sorted.
  void fill_table(const scene::FrameParticles& particles);
  bool occupied(std::int32_t x, std::int32_t y, std::int32_t z) const;
  // Whether the cells towards the eye are all taken.
  bool hidden(const Vec3f& local, const Vec3f& to_eye) const;
  void look_around(const Vec3f& local, Vec3f& outward, float& open) const;
  // Adds the lump's corners, lit, and its faces.
  void add_lump(const Lump& lump, float radius, int detail, const Vec3f& albedo,
                const Lighting& lighting, float sun);

  // Kept from picture to picture for its memory.
  Mesh mesh_;
  std::vector<std::uint64_t> table_;  ///< open addressing; 0 = free
  // The table is a power of two long, so that a mask finds the place.
  std::size_t table_mask_ = 0;
  // Edge of a cell of the set: a particle's width [m].
  float pitch_ = 0.06f;
  std::vector<Lump> lumps_;
  int drawn_ = 0;
};

}  // namespace navvy::render
