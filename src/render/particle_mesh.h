// SPDX-License-Identifier: Apache-2.0
// Loose soil as lit crumbs: irregular lumps of a few triangles; those buried in others are left out.
#pragma once

#include <vector>

#include "render/ground_surface.h"
#include "render/shadow_map.h"
#include "render/terrain.h"
#include "render/view.h"

namespace navvy::render {

/// Makes one mesh of all visible particles. Cost grows with the particles on the outside of the soil.
class ParticleMesh {
 public:
  static constexpr int kTriangleBudget = 100000;

  /// Positions, sizes and colours follow from the particle's number (or id), so that a lump keeps its looks.
  const Mesh& build(const scene::Frame& frame, const Lighting& lighting, const ShadowMap& shadows,
                    const GroundSurface& surface, const View& view);
  int drawn() const { return drawn_; }

 private:
  struct Lump {
    Vec3f center, outward;
    float open, distance;
    std::uint32_t seed;
    std::uint8_t soil;
  };
  void fill_table(const scene::FrameParticles& particles);
  bool occupied(std::int32_t x, std::int32_t y, std::int32_t z) const;
  bool hidden(const Vec3f& local, const Vec3f& to_eye) const;
  void look_around(const Vec3f& local, Vec3f& outward, float& open) const;
  void add_lump(const Lump& lump, float radius, int detail, const Vec3f& albedo, const Lighting& lighting, float sun);

  Mesh mesh_;
  std::vector<std::uint64_t> table_;  ///< open addressing; 0 = free
  std::size_t table_mask_ = 0;
  float pitch_ = 0.06f;
  std::vector<Lump> lumps_;
  int drawn_ = 0;
};

}  // namespace navvy::render
