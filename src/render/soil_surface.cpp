// SPDX-License-Identifier: Apache-2.0
#include "render/soil_surface.h"

#include <algorithm>
#include <cmath>

#include "render/particle_mesh.h"

namespace navvy::render {
namespace {

constexpr int kEdge = DensityField::kEdge;
/// Share of space that soil fills at its drawn surface: a little less than half, as dumped soil is
/// looser than the soil for which the share is 1.
constexpr float kSurface = 0.42f;
/// A particle where less is filled stands alone and is drawn as a lump.
constexpr float kTogether = 0.36f;
/// Cells with less loose soil at all nodes belong to the ground alone.
constexpr float kLeastSoil = 0.0005f;

std::size_t cell_index(int x, int y, int z) {
  return static_cast<std::size_t>(x + kEdge * (y + kEdge * z));
}

/// Returns the index of a corner in SoilSurface::Cells::all.
std::size_t corner_index(int x, int y, int z) {
  return static_cast<std::size_t>(x + (kEdge + 1) * (y + (kEdge + 1) * z));
}

/// Returns the offset of a corner of a cell; the bits of `corner` are x, y and z.
Eigen::Vector3i corner_of(int corner) { return {corner & 1, corner >> 1 & 1, corner >> 2}; }

}  // namespace

const Mesh& SoilSurface::build(const scene::Frame& frame, const Lighting& lighting,
                               const ShadowMap& shadows, const GroundSurface& surface) {
  const scene::FrameParticles& particles = frame.particles;
  check_sizes(particles);
  mesh_.vertices.clear();
  mesh_.indices.clear();
  mesh_.walls.clear();
  steep_.clear();
  const std::size_t count = particles.position.size() / 3;
  lone_.assign(count, 1);
  low_ = Vec3f::Constant(1e30f);
  high_ = -low_;
  if (count == 0 || surface.nx() < 2 || surface.ny() < 2) return mesh_;
  field_.build(particles, surface);
  const Vec3f origin = particles.origin.cast<float>();
  for (std::size_t i = 0; i < count; ++i) {
    const float* local = &particles.position[3 * i];
    const Vec3f p = origin + Vec3f(local[0], local[1], local[2]);
    if (p.allFinite()) lone_[i] = field_.sample(p) < kTogether ? 1 : 0;
  }
  cells_.resize(static_cast<std::size_t>(field_.blocks()));
  const Scene scene{frame, lighting, shadows, surface};
  for (int b = 0; b < field_.blocks(); ++b) {
    copy_corners(b);
    add_vertices(scene, b);
  }
  for (int b = 0; b < field_.blocks(); ++b) add_faces(b);
  return mesh_;
}

GroundPart SoilSurface::part() const {
  GroundPart out{&mesh_, {false, false, false, false}, low_, high_};
  out.shadowed = true;
  return out;
}

void SoilSurface::copy_corners(int b) {
  const DensityField::Block& block = field_.block(b);
  std::array<float, kCorners* kCorners* kCorners>& all = cells_[static_cast<std::size_t>(b)].all;
  for (int z = 0; z < kCorners; ++z)
    for (int y = 0; y < kCorners; ++y) {
      float* row = &all[corner_index(0, y, z)];
      if (y < kEdge && z < kEdge)
        std::copy_n(&block.all[cell_index(0, y, z)], kEdge, row);
      else
        for (int x = 0; x < kEdge; ++x) row[x] = field_.all(block, x, y, z);
      row[kEdge] = field_.all(block, kEdge, y, z);
    }
}

void SoilSurface::add_vertices(const Scene& scene, int b) {
  const DensityField::Block& block = field_.block(b);
  const Vec3f first = field_.first_node(block);
  Cells& cells = cells_[static_cast<std::size_t>(b)];
  cells.vertex.fill(kNone);
  for (int z = 0; z < kEdge; ++z)
    for (int y = 0; y < kEdge; ++y)
      for (int x = 0; x < kEdge; ++x) {
        Vec3f local;
        if (!crossing(block, {x, y, z}, local)) continue;
        Vec3f normal;
        for (int a = 0; a < 3; ++a)
          normal[a] = field_.sample(block, local - Vec3f::Unit(a)) -
                      field_.sample(block, local + Vec3f::Unit(a));
        normal = normal.norm() > 1e-6f ? Vec3f(normal.normalized()) : Vec3f(Vec3f::UnitZ());
        const Vec3f p =
            kept_off_plates(scene.frame.particles, block, first + field_.spacing() * local);
        const Vec3f lit = color(scene, block, local, p, normal);
        cells.vertex[cell_index(x, y, z)] = static_cast<std::uint32_t>(mesh_.vertices.size());
        mesh_.vertices.push_back(
            {p.x(), p.y(), p.z(), to_byte(lit.x()), to_byte(lit.y()), to_byte(lit.z()), 255});
        steep_.push_back(std::abs(normal.z()) < 0.65f ? 1 : 0);
        low_ = low_.cwiseMin(p);
        high_ = high_.cwiseMax(p);
      }
}

bool SoilSurface::crossing(const DensityField::Block& block, const Eigen::Vector3i& cell,
                           Vec3f& p) const {
  const float* corners = &cells_[static_cast<std::size_t>(block.number)]
                              .all[corner_index(cell.x(), cell.y(), cell.z())];
  std::array<float, 8> over;
  int inside = 0;
  for (int c = 0; c < 8; ++c) {
    const auto k = static_cast<std::size_t>(c);
    over[k] = corners[corner_index(c & 1, c >> 1 & 1, c >> 2)] - kSurface;
    inside += over[k] > 0 ? 1 : 0;
  }
  if (inside == 0 || inside == 8) return false;
  float most = 0;
  Vec3f sum = Vec3f::Zero();
  int crossed = 0;
  for (int c = 0; c < 8; ++c) {
    const Eigen::Vector3i node = cell + corner_of(c);
    most = std::max(most, field_.soil(block, node.x(), node.y(), node.z()));
    // The three edges that start at this corner.
    for (int bit = 1; bit < 8; bit *= 2) {
      if ((c & bit) != 0) continue;
      const float a = over[static_cast<std::size_t>(c)],
                  b = over[static_cast<std::size_t>(c | bit)];
      if ((a > 0) == (b > 0)) continue;
      const Vec3f from = corner_of(c).cast<float>(), to = corner_of(c | bit).cast<float>();
      sum += from + a / (a - b) * (to - from);
      ++crossed;
    }
  }
  if (most < kLeastSoil) return false;
  p = cell.cast<float>() + sum / static_cast<float>(crossed);
  return true;
}

// A plate is level within the reach of a particle: the point may not be nearer to it than its face.
Vec3f SoilSurface::kept_off_plates(const scene::FrameParticles& particles,
                                   const DensityField::Block& block, Vec3f p_W) const {
  if (particles.away.empty()) return p_W;
  const float reach = DensityField::kReach * 2 * field_.spacing();
  const Vec3f origin = particles.origin.cast<float>();
  for (const std::uint32_t i : block.at_plates) {
    const Vec3f p = origin + Eigen::Map<const Vec3f>(&particles.position[3 * i]);
    if ((p_W - p).squaredNorm() > reach * reach) continue;
    const Eigen::Map<const Vec3f> away(&particles.away[3 * i]);
    const float beyond = (p - p_W).dot(away) - particles.clearance[i];
    if (beyond > 0) p_W += beyond * away;
  }
  return p_W;
}

Vec3f SoilSurface::color(const Scene& scene, const DensityField::Block& block, const Vec3f& local,
                         const Vec3f& p_W, const Vec3f& normal) const {
  // Soil in the direction of the sky takes light away, the less the farther off it is.
  float hidden = 0;
  const Vec3f out = (normal + Vec3f(0, 0, 0.6f)).normalized();
  hidden += 0.9f * field_.sample(block, local + 1.6f * out);
  hidden += 0.6f * field_.sample(block, local + 3.2f * out);
  hidden += 0.4f * field_.sample(block, local + 5.5f * out);
  const float open = 0.95f * std::clamp(1.0f - hidden, 0.3f, 1.0f);
  // Sampled a little towards the sun, or soil would be in its own shadow.
  const float cell = 2 * field_.spacing();
  float sun = scene.shadows.sun_at(p_W + 1.2f * cell * scene.lighting.to_sun, 0.6f * cell);
  float height = 0, ground_sun = 1;
  if (scene.surface.sample(p_W.x(), p_W.y(), height, ground_sun) && p_W.z() < height + 0.15f)
    sun *= ground_sun;
  const int x = static_cast<int>(local.x()), y = static_cast<int>(local.y()),
            z = static_cast<int>(local.z());
  std::uint8_t soil = block.kind[cell_index(x, y, z)];
  // The lowest node may be in the air; then one inside the soil knows its kind.
  for (int c = 1; c < 8 && block.soil[cell_index(x, y, z)] <= 0; ++c) {
    const Eigen::Vector3i node = Eigen::Vector3i(x, y, z) + corner_of(c);
    if (node.maxCoeff() >= kEdge) continue;
    soil = block.kind[cell_index(node.x(), node.y(), node.z())];
    if (block.soil[cell_index(node.x(), node.y(), node.z())] > 0) break;
  }
  return shade(scene.lighting, scene.surface.loose_albedo(p_W, soil), normal, sun, open);
}

std::uint32_t SoilSurface::vertex(const DensityField::Block& block,
                                  const Eigen::Vector3i& cell) const {
  // Cells before the first node belong to the block before.
  const Eigen::Vector3i offset =
      (cell.array() < 0).select(Eigen::Vector3i::Constant(-1), Eigen::Vector3i::Zero());
  const DensityField::Block* holder = block.around[static_cast<std::size_t>(
      (offset.x() + 1) + 3 * ((offset.y() + 1) + 3 * (offset.z() + 1)))];
  if (holder == nullptr) return kNone;
  const Eigen::Vector3i at = cell - kEdge * offset;
  return cells_[static_cast<std::size_t>(holder->number)]
      .vertex[cell_index(at.x(), at.y(), at.z())];
}

void SoilSurface::add_faces(int b) {
  const DensityField::Block& block = field_.block(b);
  const auto& all = cells_[static_cast<std::size_t>(b)].all;
  constexpr std::array<std::size_t, 3> kStep = {1, kCorners, kCorners * kCorners};
  for (int z = 0; z < kEdge; ++z)
    for (int y = 0; y < kEdge; ++y)
      for (int x = 0; x < kEdge; ++x) {
        const Eigen::Vector3i node(x, y, z);
        const std::size_t corner = corner_index(x, y, z);
        const bool in = all[corner] > kSurface;
        for (int a = 0; a < 3; ++a) {
          if (in == (all[corner + kStep[static_cast<std::size_t>(a)]] > kSurface)) continue;
          // The four cells around the edge.
          const Eigen::Vector3i u = Eigen::Vector3i::Unit((a + 1) % 3),
                                v = Eigen::Vector3i::Unit((a + 2) % 3);
          const std::array<std::uint32_t, 4> q = {vertex(block, node - u - v),
                                                  vertex(block, node - v), vertex(block, node),
                                                  vertex(block, node - u)};
          if (std::find(q.begin(), q.end(), kNone) != q.end()) continue;
          int steep = 0;
          for (const std::uint32_t k : q) steep += steep_[k];
          std::vector<std::uint32_t>& list = steep >= 2 ? mesh_.walls : mesh_.indices;
          if (in)
            list.insert(list.end(), {q[0], q[1], q[2], q[0], q[2], q[3]});
          else
            list.insert(list.end(), {q[0], q[2], q[1], q[0], q[3], q[2]});
        }
      }
}

}  // namespace navvy::render
