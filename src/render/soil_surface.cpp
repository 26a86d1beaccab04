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
/// Height above the ground with its loose soil up to which soil lies on it, and from which it does
/// not [columns].
constexpr float kLies = 0.6f, kStands = 1.4f;
/// Height above the ground at which soil that lies on it is drawn, in front of it [m].
constexpr float kLift = 0.004f;
/// Range of the ground around a point up to which it is a slope, and from which a step [columns].
constexpr float kSlope = 1.2f, kWall = 2.0f;
/// Cells with less loose soil at all nodes belong to the ground alone.
constexpr float kLeastSoil = 0.0005f;

std::size_t cell_index(int x, int y, int z) {
  return static_cast<std::size_t>(x + kEdge * (y + kEdge * z));
}

/// Returns the index of a corner in SoilSurface::Cells::inside.
std::size_t corner_index(int x, int y, int z) {
  return static_cast<std::size_t>(x + (kEdge + 1) * (y + (kEdge + 1) * z));
}

/// Returns the sums of the eight corners of each cell of a row of cells, from the four rows of
/// corners around them.
std::array<std::uint8_t, kEdge> corners_inside(const std::uint8_t* row) {
  constexpr std::size_t kY = kEdge + 1, kZ = kY * kY;
  std::array<std::uint8_t, kEdge + 1> sum;
  for (std::size_t x = 0; x < kEdge + 1; ++x)
    sum[x] = static_cast<std::uint8_t>(row[x] + row[x + kY] + row[x + kZ] + row[x + kY + kZ]);
  std::array<std::uint8_t, kEdge> out;
  for (std::size_t x = 0; x < kEdge; ++x) out[x] = static_cast<std::uint8_t>(sum[x] + sum[x + 1]);
  return out;
}

// Steps along y and z in DensityField::Block::all.
constexpr int kStepY = DensityField::kWide, kStepZ = kStepY * kStepY;

/// Returns the point (0 to 1) at which the surface crosses a cell: the mean of where it crosses the
/// edges of the cell. `corner` is the share at the lowest corner.
Vec3f crossing(const float* corner) {
  Vec3f sum = Vec3f::Zero();
  float crossed = 0;
  for (int a = 0; a < 3; ++a) {
    constexpr std::array<int, 3> kStep = {1, kStepY, kStepZ};
    const auto along = static_cast<std::size_t>(a), u = (along + 1) % 3, v = (along + 2) % 3;
    for (int k = 0; k < 4; ++k) {
      const float* from = corner + (k & 1) * kStep[u] + (k >> 1) * kStep[v];
      const float low = from[0] - kSurface, high = from[kStep[along]] - kSurface;
      if ((low > 0) == (high > 0)) continue;
      sum[a] += low / (low - high);
      sum[(a + 1) % 3] += static_cast<float>(k & 1);
      sum[(a + 2) % 3] += static_cast<float>(k >> 1);
      crossed += 1;
    }
  }
  return sum / crossed;
}

/// Returns minus the gradient of the interpolated share at the point `t` (0 to 1) of a cell, by
/// differences over two nodes.
Vec3f descent(const float* corner, const Vec3f& t) {
  constexpr std::array<int, 3> kStep = {1, kStepY, kStepZ};
  Vec3f out;
  for (int a = 0; a < 3; ++a) {
    const int along = kStep[static_cast<std::size_t>(a)],
              u = kStep[static_cast<std::size_t>((a + 1) % 3)],
              v = kStep[static_cast<std::size_t>((a + 2) % 3)];
    const auto fall = [&](const float* p) {
      const float first = p[-along] - p[along], second = p[0] - p[2 * along];
      return first + t[a] * (second - first);
    };
    const float tu = t[(a + 1) % 3], tv = t[(a + 2) % 3];
    out[a] = (1 - tv) * ((1 - tu) * fall(corner) + tu * fall(corner + u)) +
             tv * ((1 - tu) * fall(corner + v) + tu * fall(corner + u + v));
  }
  return out;
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
    if (!p.allFinite()) continue;
    // Soil on the ground needs no look at the field.
    float height = 0, sun = 1;
    const bool lies = surface.sample(p.x(), p.y(), height, sun) && p.z() < height + surface.cell();
    lone_[i] = !lies && field_.sample(p) < kTogether ? 1 : 0;
  }
  cells_.resize(static_cast<std::size_t>(field_.blocks()));
  const Scene scene{lighting, shadows, surface};
  for (int b = 0; b < field_.blocks(); ++b) {
    find_inside(b);
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

void SoilSurface::find_inside(int b) {
  const DensityField::Block& block = field_.block(b);
  auto& inside = cells_[static_cast<std::size_t>(b)].inside;
  int count = 0;
  for (int z = 0; z < kCorners; ++z)
    for (int y = 0; y < kCorners; ++y) {
      const float* all = &block.all[DensityField::wide_index(0, y, z)];
      std::uint8_t* row = &inside[corner_index(0, y, z)];
      for (int x = 0; x < kCorners; ++x) row[x] = all[x] > kSurface ? 1 : 0;
      for (int x = 0; x < kCorners; ++x) count += row[x];
    }
  cells_[static_cast<std::size_t>(b)].crossed =
      count != 0 && count != static_cast<int>(inside.size());
}

void SoilSurface::add_vertices(const Scene& scene, int b) {
  const DensityField::Block& block = field_.block(b);
  Cells& cells = cells_[static_cast<std::size_t>(b)];
  cells.vertex.fill(kNone);
  if (!cells.crossed) return;
  for (int z = 0; z < kEdge; ++z)
    for (int y = 0; y < kEdge; ++y) {
      const auto inside = corners_inside(&cells.inside[corner_index(0, y, z)]);
      for (int x = 0; x < kEdge; ++x)
        if (const int count = inside[static_cast<std::size_t>(x)]; count != 0 && count != 8)
          cells.vertex[cell_index(x, y, z)] = add_vertex(scene, block, x, y, z);
    }
}

std::uint32_t SoilSurface::add_vertex(const Scene& scene, const DensityField::Block& block, int x,
                                      int y, int z) {
  // The corner with most loose soil knows its kind.
  float most = kLeastSoil;
  int kind = -1;
  for (int c = 0; c < 8; ++c) {
    const Eigen::Vector3i node = Eigen::Vector3i(x, y, z) + corner_of(c);
    const float soil = field_.soil(block, node.x(), node.y(), node.z());
    if (soil < most) continue;
    most = soil;
    kind = field_.kind(block, node.x(), node.y(), node.z());
  }
  if (kind < 0) return kNone;
  const float* corner = &block.all[DensityField::wide_index(x, y, z)];
  const Vec3f t = crossing(corner), fall = descent(corner, t);
  const Vec3f local =
      Vec3f(static_cast<float>(x), static_cast<float>(y), static_cast<float>(z)) + t;
  const Vec3f normal = fall.norm() > 1e-6f ? Vec3f(fall.normalized()) : Vec3f(Vec3f::UnitZ());
  Vec3f p = field_.first_node(block) + field_.spacing() * local;
  const GroundLook ground = scene.surface.look_at(p.x(), p.y());
  const float apart = apart_from(ground, p.z()), level = ground.height + kLift;
  p = kept_off_plates(block, {p.x(), p.y(), level + apart * (p.z() - level)});
  const Vec3f lit =
      color(scene, {block, local, p, normal, static_cast<std::uint8_t>(kind), ground, apart});
  mesh_.vertices.push_back(
      {p.x(), p.y(), p.z(), to_byte(lit.x()), to_byte(lit.y()), to_byte(lit.z()), 255});
  steep_.push_back(apart > 0.5f && std::abs(normal.z()) < 0.65f ? 1 : 0);
  low_ = low_.cwiseMin(p);
  high_ = high_.cwiseMax(p);
  return static_cast<std::uint32_t>(mesh_.vertices.size() - 1);
}

// A plate is level within the reach of a particle: the point may not be nearer to it than its face.
Vec3f SoilSurface::kept_off_plates(const DensityField::Block& block, Vec3f p_W) const {
  const float reach = DensityField::kReach * 2 * field_.spacing();
  for (const DensityField::AtPlate& at : block.at_plates) {
    const float beyond = at.offset - at.away.dot(p_W);
    if (beyond > 0 && (p_W - at.p_W).squaredNorm() <= reach * reach) p_W += beyond * at.away;
  }
  return p_W;
}

// Soil that lies on the ground is drawn as the ground with it is, at its height and in its colour,
// so that nothing changes where it comes to rest. At steps of the ground there is no such place.
float SoilSurface::apart_from(const GroundLook& ground, float z) const {
  const float cell = 2 * field_.spacing();
  return std::max(smooth_step(kLies, kStands, std::abs(z - ground.height) / cell),
                  smooth_step(kSlope, kWall, ground.range / cell));
}

Vec3f SoilSurface::color(const Scene& scene, const Place& at) const {
  // Sampled a little towards the sun, or soil would be in its own shadow.
  const float cell = 2 * field_.spacing();
  const float sun = scene.shadows.sun_at(at.p_W + 1.2f * cell * scene.lighting.to_sun, 0.6f * cell);
  const Vec3f lying = at.ground.color.cwiseProduct(shadow_tone(scene.lighting, sun));
  if (at.apart <= 0) return lying;
  // Soil in the direction of the sky takes light away, the less the farther off it is.
  const Vec3f out = (at.normal + Vec3f(0, 0, 0.6f)).normalized();
  const float hidden = 0.9f * field_.sample(at.block, at.local + 1.6f * out) +
                       0.6f * field_.sample(at.block, at.local + 3.2f * out) +
                       0.4f * field_.sample(at.block, at.local + 5.5f * out);
  const float open = 0.95f * std::clamp(1.0f - hidden, 0.3f, 1.0f);
  float height = 0, ground_sun = 1;
  if (!scene.surface.sample(at.p_W.x(), at.p_W.y(), height, ground_sun) ||
      at.p_W.z() >= height + 0.15f)
    ground_sun = 1;
  const Vec3f own = shade(scene.lighting, scene.surface.loose_albedo(at.p_W, at.soil), at.normal,
                          sun * ground_sun, open);
  return lying + (own - lying) * at.apart;
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
  const Cells& cells = cells_[static_cast<std::size_t>(b)];
  if (!cells.crossed) return;
  constexpr std::array<std::size_t, 3> kStep = {1, kCorners, kCorners * kCorners};
  for (int z = 0; z < kEdge; ++z)
    for (int y = 0; y < kEdge; ++y)
      for (int x = 0; x < kEdge; ++x) {
        const std::uint8_t* corner = &cells.inside[corner_index(x, y, z)];
        for (std::size_t a = 0; a < 3; ++a)
          if (corner[0] != corner[kStep[a]])
            add_face(block, {x, y, z}, static_cast<int>(a), corner[0] != 0);
      }
}

void SoilSurface::add_face(const DensityField::Block& block, const Eigen::Vector3i& node, int axis,
                           bool inside) {
  // The four cells around the edge.
  const Eigen::Vector3i u = Eigen::Vector3i::Unit((axis + 1) % 3),
                        v = Eigen::Vector3i::Unit((axis + 2) % 3);
  const std::array<std::uint32_t, 4> q = {vertex(block, node - u - v), vertex(block, node - v),
                                          vertex(block, node), vertex(block, node - u)};
  if (std::find(q.begin(), q.end(), kNone) != q.end()) return;
  int steep = 0;
  for (const std::uint32_t k : q) steep += steep_[k];
  std::vector<std::uint32_t>& list = steep >= 2 ? mesh_.walls : mesh_.indices;
  if (inside)
    list.insert(list.end(), {q[0], q[1], q[2], q[0], q[2], q[3]});
  else
    list.insert(list.end(), {q[0], q[2], q[1], q[0], q[3], q[2]});
}

}  // namespace navvy::render
