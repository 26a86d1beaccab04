// SPDX-License-Identifier: Apache-2.0
// Draws single soil particles as irregular, lit lumps of a few triangles each.
#pragma once

#include <vector>

#include "render/ground_surface.h"
#include "render/shadow_map.h"
#include "render/terrain_mesh.h"
#include "render/view.h"

namespace navvy::render {

/// Checks the arrays of a frame, which come from a caller: one that is too short would be read
/// beyond its end. @throws Error if their sizes do not match.
void check_sizes(const scene::FrameParticles& particles);

/// Builds one mesh of all visible soil particles that belong to no surface (SoilSurface). Particles
/// that others enclose, that lie on the ground, or that are outside the picture get no triangles.
class ParticleMesh {
 public:
  /// Number of triangles in a picture above which every lump is drawn with 8 instead of 20 faces.
  static constexpr int kTriangleBudget = 100000;

  /// Returns the mesh of the frame's particles, valid until the next call. `lone` has one entry per
  /// particle: 0 for those that are drawn otherwise. The id of a particle (its index if the frame
  /// has no ids) determines the shape, size and colour of its lump, so that a particle always looks
  /// the same. @throws Error if the sizes of the frame's particle arrays do not match.
  const Mesh& build(const scene::Frame& frame, const Lighting& lighting, const ShadowMap& shadows,
                    const GroundSurface& surface, const View& view,
                    const std::vector<std::uint8_t>& lone);
  /// Returns the number of lumps in the last mesh.
  int drawn() const { return drawn_; }

 private:
  // A particle to draw.
  struct Lump {
    // Centre in W [m], and unit vector in W that points out of the heap.
    Vec3f center, outward;
    // Visible fraction of the sky (0 to 1), and distance from the camera [m].
    float open, distance;
    // Size as a share of that in the air (0 to 1).
    float size;
    // Maximum radius at which the lump does not protrude through a plate of a machine [m].
    float most;
    // Random number that determines the appearance of the lump.
    std::uint32_t seed;
    // Index of the soil, which determines the colour.
    std::uint8_t soil;
  };
  // Builds the set of grid cells that contain particles. Only this set is needed, so the particles
  // need not be sorted.
  void fill_table(const scene::FrameParticles& particles);
  // Returns true if the grid cell (x, y, z) contains a particle.
  bool occupied(std::int32_t x, std::int32_t y, std::int32_t z) const;
  // Returns true if the seven neighbouring cells towards the camera all contain particles. `local`
  // is the position relative to the frame's origin [m].
  bool hidden(const Vec3f& local, const Vec3f& to_eye) const;
  // Computes Lump::outward and Lump::open of a particle from the occupied cells around it.
  void look_around(const Vec3f& local, Vec3f& outward, float& open) const;
  // Adds the triangles of all visible lumps of particles of a radius [m].
  void add_lumps(const Lighting& lighting, const ShadowMap& shadows, const GroundSurface& surface,
                 const View& view, float radius);
  // Adds the triangles of a lump to the mesh. `detail` is 1 for 20 faces and 0 for 8 faces, `sun`
  // the visible fraction of the sun (0 to 1).
  void add_lump(const Lump& lump, float radius, int detail, const Vec3f& albedo,
                const Lighting& lighting, float sun);

  // The last mesh; reused in order to reuse its memory.
  Mesh mesh_;
  // Hash table (open addressing) of the keys of occupied cells; 0 marks a free slot.
  std::vector<std::uint64_t> table_;
  // Size of the table minus 1. The size is a power of two, so this mask converts a hash to an
  // index.
  std::size_t table_mask_ = 0;
  // Edge length of a grid cell: the diameter of a particle [m].
  float pitch_ = 0.06f;
  // Visible lumps of the picture being built.
  std::vector<Lump> lumps_;
  // Number of lumps in the last mesh.
  int drawn_ = 0;
};

}  // namespace navvy::render
