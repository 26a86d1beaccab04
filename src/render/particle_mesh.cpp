// SPDX-License-Identifier: Apache-2.0
#include "render/particle_mesh.h"

#include "core/error.h"

namespace navvy::render {
namespace {

/// A round body before it is dented: unit vertices and triangles.
struct Body {
  std::vector<Vec3f> points;
  std::vector<std::array<std::uint32_t, 3>> faces;
};

Body octahedron() {
  return {{{1, 0, 0}, {-1, 0, 0}, {0, 1, 0}, {0, -1, 0}, {0, 0, 1}, {0, 0, -1}},
          {{0, 2, 4}, {2, 1, 4}, {1, 3, 4}, {3, 0, 4}, {2, 0, 5}, {1, 2, 5}, {3, 1, 5}, {0, 3, 5}}};
}

// Corners of three golden rectangles. Back faces are culled, so the corners are ordered such that
// all faces point outwards.
Body icosahedron() {
  const float t = 0.5f * (1.0f + std::sqrt(5.0f));
  Body b{{{-1, t, 0},
          {1, t, 0},
          {-1, -t, 0},
          {1, -t, 0},
          {0, -1, t},
          {0, 1, t},
          {0, -1, -t},
          {0, 1, -t},
          {t, 0, -1},
          {t, 0, 1},
          {-t, 0, -1},
          {-t, 0, 1}},
         {{0, 11, 5},  {0, 5, 1},  {0, 1, 7},  {0, 7, 10}, {0, 10, 11}, {1, 5, 9}, {5, 11, 4},
          {11, 10, 2}, {10, 7, 6}, {7, 1, 8},  {3, 9, 4},  {3, 4, 2},   {3, 2, 6}, {3, 6, 8},
          {3, 8, 9},   {4, 9, 5},  {2, 4, 11}, {6, 2, 10}, {8, 6, 7},   {9, 8, 1}}};
  for (Vec3f& p : b.points) p.normalize();
  return b;
}

/// Farthest corner of a particle's body in units of its radius: dents go both ways, and a body of
/// eight faces is drawn larger.
constexpr float kFarthestCorner = 1.26f * 1.25f;

/// Returns the size of a lump at a point of W, as a share of that in the air: lumps sink into the
/// ground as they reach it, or the toe of a heap would be a string of beads.
float size_above(const GroundSurface& surface, const Vec3f& p_W) {
  // Height above the ground at which a lump is gone, and from which it has its size [columns].
  constexpr float kSunk = 1.0f, kFree = 1.8f;
  float height = 0, sun = 1;
  if (!surface.sample(p_W.x(), p_W.y(), height, sun)) return 1;
  return smooth_step(kSunk, kFree, (p_W.z() - height) / surface.cell());
}

/// Returns eight dented and rotated copies of a body, so that neighbours differ. Dents are up to a
/// quarter of the radius.
std::vector<Body> variants(const Body& base, std::uint32_t seed) {
  std::vector<Body> out;
  for (std::uint32_t v = 0; v < 8; ++v) {
    Body body = base;
    const Eigen::Quaternionf turn =
        Eigen::AngleAxisf(6.28f * hash_unit(v, 1, seed), Vec3f::UnitZ()) *
        Eigen::AngleAxisf(6.28f * hash_unit(v, 2, seed), Vec3f::UnitX());
    for (std::uint32_t i = 0; i < body.points.size(); ++i)
      body.points[i] = turn * body.points[i] * (0.74f + 0.52f * hash_unit(v, i + 3, seed));
    out.push_back(body);
  }
  return out;
}

// Packs the three indices of a cell in 21 bits each, with an offset for negative ones. The highest
// bit keeps a key from being 0, which marks a free slot. A cell more than a million cells from the
// origin would wrap around; sites are far smaller.
std::uint64_t key(std::int32_t x, std::int32_t y, std::int32_t z) {
  constexpr std::uint64_t kMask = (1u << 21) - 1;
  const auto part = [](std::int32_t k) {
    return (static_cast<std::uint64_t>(static_cast<std::uint32_t>(k + (1 << 20)))) & kMask;
  };
  return (1ull << 63) | part(x) << 42 | part(y) << 21 | part(z);
}

std::size_t slot(std::uint64_t k) {
  // Multiplying mixes the low bits into the high ones, which select the slot.
  k *= 0x9E3779B97F4A7C15ull;
  return static_cast<std::size_t>(k >> 20);
}

// A position that is not finite, or beyond any site, is put into the outermost cell.
std::int32_t cell_of(float x, float pitch) {
  constexpr float kFarthest = 1 << 20;
  const float cell = std::floor(x / pitch);
  return static_cast<std::int32_t>(cell > -kFarthest ? std::min(cell, kFarthest) : -kFarthest);
}

}  // namespace

void ParticleMesh::fill_table(const scene::FrameParticles& particles) {
  // At most a quarter full, so that a search soon reaches a free slot.
  const std::size_t n = particles.position.size() / 3;
  std::size_t size = 1024;
  while (size < 4 * n) size *= 2;
  table_.assign(size, 0);
  table_mask_ = size - 1;
  for (std::size_t i = 0; i < n; ++i) {
    const float* p = &particles.position[3 * i];
    const std::uint64_t k =
        key(cell_of(p[0], pitch_), cell_of(p[1], pitch_), cell_of(p[2], pitch_));
    std::size_t s = slot(k) & table_mask_;
    while (table_[s] != 0 && table_[s] != k) s = (s + 1) & table_mask_;
    table_[s] = k;
  }
}

bool ParticleMesh::occupied(std::int32_t x, std::int32_t y, std::int32_t z) const {
  const std::uint64_t k = key(x, y, z);
  std::size_t s = slot(k) & table_mask_;
  while (table_[s] != 0) {
    if (table_[s] == k) return true;
    s = (s + 1) & table_mask_;
  }
  return false;
}

// A particle is hidden if the seven neighbouring cells towards the camera all hold soil. Only
// particles within the soil are omitted; one that would show through a gap between its neighbours
// is missing, which is not noticeable.
bool ParticleMesh::hidden(const Vec3f& local, const Vec3f& to_eye) const {
  const std::int32_t x = cell_of(local.x(), pitch_), y = cell_of(local.y(), pitch_),
                     z = cell_of(local.z(), pitch_);
  const int sx = to_eye.x() > 0 ? 1 : -1, sy = to_eye.y() > 0 ? 1 : -1,
            sz = to_eye.z() > 0 ? 1 : -1;
  for (int k = 1; k < 8; ++k)
    if (!occupied(x + ((k & 1) ? sx : 0), y + ((k & 2) ? sy : 0), z + ((k & 4) ? sz : 0)))
      return false;
  return true;
}

// `outward` points away from the neighbours, `open` is the share of sky that they leave.
void ParticleMesh::look_around(const Vec3f& local, Vec3f& outward, float& open) const {
  const std::int32_t x = cell_of(local.x(), pitch_), y = cell_of(local.y(), pitch_),
                     z = cell_of(local.z(), pitch_);
  outward.setZero();
  int above = 0;
  for (int dz = -1; dz <= 1; ++dz)
    for (int dy = -1; dy <= 1; ++dy)
      for (int dx = -1; dx <= 1; ++dx) {
        if ((dx | dy | dz) == 0 || !occupied(x + dx, y + dy, z + dz)) continue;
        // Neighbours above hide more of the sky than those at the side.
        above += dz >= 0 ? 1 + dz : 0;
        outward -= Vec3f(static_cast<float>(dx), static_cast<float>(dy), static_cast<float>(dz));
      }
  // A particle enclosed from all sides and above keeps a third of the sky.
  open = 1.0f - 0.025f * static_cast<float>(above);
  const float length = outward.norm();
  outward = length > 0.5f ? Vec3f(outward / length) : Vec3f(0, 0, 1);
}

void ParticleMesh::add_lump(const Lump& lump, float radius, int detail, const Vec3f& albedo,
                            const Lighting& lighting, float sun) {
  static const std::vector<Body> kFine = variants(icosahedron(), 11),
                                 kCoarse = variants(octahedron(), 12);
  const Body& body = (detail > 0 ? kFine : kCoarse)[lump.seed & 7];
  // A body of eight faces has less volume than one of twenty with the same radius.
  const float size = radius * (detail > 0 ? 1.0f : 1.25f);
  const auto first = static_cast<std::uint32_t>(mesh_.vertices.size());
  for (const Vec3f& point : body.points) {
    // A blend of the particle's own roundness and the slope of the heap.
    const Vec3f normal = (0.75f * point + 0.6f * lump.outward).normalized();
    // Undersides are darker, as if light came from above only.
    const float low = 0.86f + 0.14f * point.z();
    const Vec3f color = shade(lighting, albedo, normal, sun, lump.open * low);
    const Vec3f p = lump.center + size * point;
    mesh_.vertices.push_back(
        {p.x(), p.y(), p.z(), to_byte(color.x()), to_byte(color.y()), to_byte(color.z()), 255});
  }
  for (const auto& f : body.faces)
    mesh_.indices.insert(mesh_.indices.end(), {first + f[0], first + f[1], first + f[2]});
}

void check_sizes(const scene::FrameParticles& particles) {
  const std::size_t n = particles.position.size() / 3;
  if (particles.position.size() % 3 != 0 ||
      (!particles.soil.empty() && particles.soil.size() != n) ||
      (!particles.id.empty() && particles.id.size() != n) ||
      (!particles.clearance.empty() && particles.clearance.size() != n) ||
      (!particles.away.empty() && (particles.away.size() != 3 * n || particles.clearance.empty())))
    throw Error("the frame's particle arrays do not fit each other");
}

const Mesh& ParticleMesh::build(const scene::Frame& frame, const Lighting& lighting,
                                const ShadowMap& shadows, const GroundSurface& surface,
                                const View& view, const std::vector<std::uint8_t>& lone) {
  const scene::FrameParticles& particles = frame.particles;
  check_sizes(particles);
  const std::size_t n = particles.position.size() / 3;
  mesh_.vertices.clear();
  mesh_.indices.clear();
  lumps_.clear();
  drawn_ = 0;
  if (n == 0) return mesh_;
  const auto radius = static_cast<float>(particles.radius);
  const Vec3f origin = particles.origin.cast<float>();
  // The grid of occupied cells is as wide as a particle.
  pitch_ = 2.0f * radius;
  fill_table(particles);

  for (std::size_t i = 0; i < n; ++i) {
    const Vec3f local(particles.position[3 * i], particles.position[3 * i + 1],
                      particles.position[3 * i + 2]);
    // A particle without finite position is a fault of the run, not of the picture.
    if (!local.allFinite() || lone[i] == 0) continue;
    Lump lump;
    lump.center = origin + local;
    const Vec3f around = Vec3f::Constant(2 * radius);
    if (!view.sees(lump.center - around, lump.center + around)) continue;
    lump.size = size_above(surface, lump.center);
    if (lump.size <= 0) continue;
    if (hidden(local, view.eye - lump.center)) continue;
    look_around(local, lump.outward, lump.open);
    lump.distance = (lump.center - view.eye).norm();
    // Seeded by id, so that a particle keeps its appearance when the list is sorted again.
    lump.seed = hash_u32(particles.id.empty() ? static_cast<std::uint32_t>(i) : particles.id[i]);
    lump.soil = particles.soil.empty() ? std::uint8_t{0} : particles.soil[i];
    // A particle on a plate keeps a minimum size that remains visible.
    lump.most = particles.clearance.empty()
                    ? 2 * radius
                    : std::max(particles.clearance[i] / kFarthestCorner, 0.2f * radius);
    lumps_.push_back(lump);
  }
  add_lumps(lighting, shadows, surface, view, radius);
  return mesh_;
}

void ParticleMesh::add_lumps(const Lighting& lighting, const ShadowMap& shadows,
                             const GroundSurface& surface, const View& view, float radius) {
  // Twenty faces if a particle is larger than a few pixels and the budget allows it, eight
  // otherwise. The budget bounds the cost of a picture when a whole heap is in view.
  const bool many = 20 * lumps_.size() > kTriangleBudget;
  mesh_.vertices.reserve(12 * lumps_.size());
  mesh_.indices.reserve(60 * lumps_.size());
  for (const Lump& lump : lumps_) {
    const float unit = static_cast<float>(lump.seed >> 8) / 16777216.0f;
    const float pixels = 2 * radius * view.pixels_per_radian / std::max(lump.distance, 0.1f);
    const Vec3f albedo =
        surface.loose_albedo(lump.center, lump.soil) * (0.80f + 0.22f * hash_unit(lump.seed, 5));
    // Sampled a little towards the sun, or a particle would be in its own shadow.
    const Vec3f sunward = lump.center + 1.5f * radius * lighting.to_sun;
    float sun = shadows.sun_at(sunward, 2.5f * radius), height = 0, ground_sun = 1;
    // Close to the ground the shadow of the ground counts as well.
    if (surface.sample(lump.center.x(), lump.center.y(), height, ground_sun) &&
        lump.center.z() < height + 0.25f)
      sun *= 0.35f + 0.65f * ground_sun;
    add_lump(lump, lump.size * std::min(lump.most, radius * (0.45f + 0.50f * unit * unit)),
             pixels > 7 && !many ? 1 : 0, albedo, lighting, sun);
  }
  drawn_ = static_cast<int>(lumps_.size());
}

}  // namespace navvy::render
