// SPDX-License-Identifier: Apache-2.0
// The kernel (1 - r^2 / R^2)^3 is smooth and needs no root. In soil of eight particles a column its
// sum is constant but for some per cent, and half of it at a level surface of such soil.
#include "render/density_field.h"

#include <cmath>
#include <utility>

namespace navvy::render {
namespace {

constexpr int kEdge = DensityField::kEdge;

/// Sum of the kernel in undisturbed soil: eight particles a column, times the integral of the
/// kernel over its ball, 64 pi / 315 of the cubed reach.
constexpr float kBulk =
    8 * 0.63830f * DensityField::kReach * DensityField::kReach * DensityField::kReach;

std::uint64_t key_of(const Eigen::Vector3i& place) {
  constexpr std::uint64_t kMask = (1u << 21) - 1;
  const auto part = [](int k) {
    return static_cast<std::uint64_t>(static_cast<std::uint32_t>(k + (1 << 20))) & kMask;
  };
  return part(place.x()) << 42 | part(place.y()) << 21 | part(place.z());
}

std::size_t parity_of(const Eigen::Vector3i& place) {
  return static_cast<std::size_t>((place.x() & 1) | (place.y() & 1) << 1 | (place.z() & 1) << 2);
}

/// Returns floor(k / kEdge), also for negative numbers.
int block_of(int node) { return node >> 3; }
static_assert(kEdge == 8);

std::size_t node_index(int x, int y, int z) {
  return static_cast<std::size_t>(x + kEdge * (y + kEdge * z));
}

}  // namespace

DensityField::Block* DensityField::find(const Eigen::Vector3i& place) const {
  Block*& recent = recent_[parity_of(place)];
  if (recent != nullptr && recent->place == place) return recent;
  const auto found = index_.find(key_of(place));
  if (found == index_.end()) return nullptr;
  recent = pool_[found->second].get();
  return recent;
}

DensityField::Block& DensityField::obtain(const Eigen::Vector3i& place) {
  if (Block* block = find(place)) return *block;
  if (used_ == pool_.size()) pool_.push_back(std::make_unique<Block>());
  Block& block = *pool_[used_];
  block.number = static_cast<int>(used_);
  index_.emplace(key_of(place), static_cast<std::uint32_t>(used_++));
  block.place = place;
  block.soil.fill(0);
  block.kind.fill(0);
  block.at_plates.clear();
  recent_[parity_of(place)] = &block;
  return block;
}

void DensityField::build(const scene::FrameParticles& particles, const GroundSurface& surface) {
  surface_ = &surface;
  spacing_ = 0.5f * surface.cell();
  reach_ = kReach * surface.cell();
  used_ = 0;
  index_.clear();
  recent_.fill(nullptr);
  const Vec3f origin = particles.origin.cast<float>();
  const std::size_t count = particles.position.size() / 3;
  for (std::size_t i = 0; i < count; ++i) {
    const float* local = &particles.position[3 * i];
    const Vec3f p = origin + Vec3f(local[0], local[1], local[2]);
    if (!p.allFinite()) continue;
    const std::uint32_t id = particles.id.empty() ? static_cast<std::uint32_t>(i) : particles.id[i];
    // Unlike weights make the surface uneven, and the unevenness moves with the soil.
    const float weight = 0.55f + 0.9f * hash_unit(id, 3);
    add(static_cast<std::uint32_t>(i), p,
        particles.soil.empty() ? std::uint8_t{0} : particles.soil[i], weight / kBulk,
        !particles.clearance.empty() && particles.clearance[i] < reach_);
  }
  for (std::size_t b = 0; b < used_; ++b) {
    Block& block = *pool_[b];
    for (int k = 0; k < 27; ++k)
      block.around[static_cast<std::size_t>(k)] =
          find(block.place + Eigen::Vector3i(k % 3 - 1, k / 3 % 3 - 1, k / 9 - 1));
    add_ground(block);
  }
}

void DensityField::add(std::uint32_t index, const Vec3f& p_W, std::uint8_t kind, float weight,
                       bool at_plate) {
  // Distances are in units of the reach.
  const float inverse = 1 / spacing_, scale = spacing_ / reach_;
  const Vec3f q = p_W * inverse;
  const Eigen::Vector3i low = (q.array() - reach_ * inverse).ceil().cast<int>(),
                        high = (q.array() + reach_ * inverse).floor().cast<int>();
  // A particle reaches fewer nodes than a block has, so at most two blocks along each axis.
  for (int bz = block_of(low.z()); bz <= block_of(high.z()); ++bz)
    for (int by = block_of(low.y()); by <= block_of(high.y()); ++by)
      for (int bx = block_of(low.x()); bx <= block_of(high.x()); ++bx) {
        Block& block = obtain({bx, by, bz});
        if (at_plate) block.at_plates.push_back(index);
        const Eigen::Vector3i first = kEdge * block.place;
        const Eigen::Vector3i from = (low - first).cwiseMax(0),
                              to = (high - first).cwiseMin(kEdge - 1);
        const Vec3f local = q - first.cast<float>();
        // Squared distances along x of a whole row of nodes, so that rows are added as vectors.
        std::array<float, kEdge> along;
        for (int x = 0; x < kEdge; ++x) {
          const float dx = (static_cast<float>(x) - local.x()) * scale;
          along[static_cast<std::size_t>(x)] = dx * dx;
        }
        for (int z = from.z(); z <= to.z(); ++z)
          for (int y = from.y(); y <= to.y(); ++y) {
            const float dz = (static_cast<float>(z) - local.z()) * scale,
                        dy = (static_cast<float>(y) - local.y()) * scale;
            const float side = 1 - dz * dz - dy * dy;
            if (side <= 0) continue;
            float* soil = &block.soil[node_index(0, y, z)];
            for (std::size_t x = 0; x < kEdge; ++x) {
              const float t = std::max(0.0f, side - along[x]);
              soil[x] += weight * t * t * t;
            }
            for (int x = from.x(); x <= to.x(); ++x) block.kind[node_index(x, y, z)] = kind;
          }
      }
}

// By shares of the four columns around a node, as particles have shares: at the border of the
// active soil the two add up to full soil.
void DensityField::add_ground(Block& block) const {
  const Vec3f first = first_node(block);
  for (int y = 0; y < kEdge; ++y)
    for (int x = 0; x < kEdge; ++x) {
      const ColumnShares columns =
          surface_->columns_at(first.x() + spacing_ * static_cast<float>(x),
                               first.y() + spacing_ * static_cast<float>(y));
      for (int z = 0; z < kEdge; ++z) {
        const std::size_t k = node_index(x, y, z);
        const float ground = columns.filled(first.z() + spacing_ * static_cast<float>(z), spacing_);
        block.all[k] = std::min(1.0f, block.soil[k] + ground);
      }
    }
}

float DensityField::ground_share(const Vec3f& p_W) const {
  return surface_->columns_at(p_W.x(), p_W.y()).filled(p_W.z(), spacing_);
}

std::pair<const DensityField::Block*, std::size_t> DensityField::locate(const Block& block, int x,
                                                                        int y, int z) {
  const int bx = block_of(x), by = block_of(y), bz = block_of(z);
  const Block* holder =
      block.around[static_cast<std::size_t>((bx + 1) + 3 * ((by + 1) + 3 * (bz + 1)))];
  return {holder, node_index(x & (kEdge - 1), y & (kEdge - 1), z & (kEdge - 1))};
}

float DensityField::all(const Block& block, int x, int y, int z) const {
  const auto [holder, k] = locate(block, x, y, z);
  if (holder != nullptr) return holder->all[k];
  return ground_share(first_node(block) + spacing_ * Vec3f(static_cast<float>(x),
                                                           static_cast<float>(y),
                                                           static_cast<float>(z)));
}

float DensityField::soil(const Block& block, int x, int y, int z) const {
  const auto [holder, k] = locate(block, x, y, z);
  return holder == nullptr ? 0 : holder->soil[k];
}

float DensityField::sample(const Block& block, const Vec3f& p) const {
  const int x = static_cast<int>(std::floor(p.x())), y = static_cast<int>(std::floor(p.y())),
            z = static_cast<int>(std::floor(p.z()));
  const Vec3f t = p - Vec3f(static_cast<float>(x), static_cast<float>(y), static_cast<float>(z));
  float sum = 0;
  for (int c = 0; c < 8; ++c) {
    const int i = c & 1, j = c >> 1 & 1, k = c >> 2;
    const float share =
        (i != 0 ? t.x() : 1 - t.x()) * (j != 0 ? t.y() : 1 - t.y()) * (k != 0 ? t.z() : 1 - t.z());
    sum += share * all(block, x + i, y + j, z + k);
  }
  return sum;
}

float DensityField::sample(const Vec3f& p_W) const {
  const Vec3f q = p_W / spacing_;
  const Eigen::Vector3i node = q.array().floor().cast<int>();
  const Block* block = find({block_of(node.x()), block_of(node.y()), block_of(node.z())});
  if (block == nullptr) return ground_share(p_W);
  return sample(*block, q - (kEdge * block->place).cast<float>());
}

}  // namespace navvy::render
