// SPDX-License-Identifier: Apache-2.0
// The kernel is the cubic B-spline of each axis: it is smooth, nearly round, and its shares of the
// nodes add up to one wherever the particle is. In soil of eight particles a column its sum is one
// but for some per cent, and half of that at a level surface of such soil.
#include "render/density_field.h"

#include <cmath>
#include <utility>

namespace navvy::render {
namespace {

constexpr int kEdge = DensityField::kEdge;

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

// Nodes along an axis that a particle reaches.
constexpr int kReached = 4;

/// Shares of a particle in the nodes that it reaches along one axis.
struct Reach {
  int first;                          // number of the first node, from the origin of W
  std::array<float, kReached> share;  // shares, which sum to 1

  explicit Reach(float q) {
    const float low = std::floor(q), t = q - low, u = 1 - t;
    first = static_cast<int>(low) - 1;
    share[0] = u * u * u * (1.0f / 6);
    share[3] = t * t * t * (1.0f / 6);
    share[1] = 2.0f / 3 - t * t * (1 - 0.5f * t);
    share[2] = 1 - share[0] - share[1] - share[3];
  }
  /// Returns the number of blocks that the nodes belong to: 1 or 2.
  int blocks() const { return block_of(first + kReached - 1) - block_of(first) + 1; }
  /// Returns the first and the end of the nodes (0 to kReached) in the block `k` of them.
  std::array<int, 2> part(int k) const {
    const int next = kEdge - (first & (kEdge - 1));
    return {k == 0 ? 0 : next, k == 0 ? std::min(kReached, next) : kReached};
  }
};

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

DensityField::Block& DensityField::obtain(const Eigen::Vector3i& place, std::uint8_t kind) {
  if (Block* block = find(place)) return *block;
  if (used_ == pool_.size()) pool_.push_back(std::make_unique<Block>());
  Block& block = *pool_[used_];
  block.number = static_cast<int>(used_);
  index_.emplace(key_of(place), static_cast<std::uint32_t>(used_++));
  block.place = place;
  block.soil.fill(0);
  block.kind.fill(kind);
  block.mixed = false;
  block.at_plates.clear();
  recent_[parity_of(place)] = &block;
  return block;
}

void DensityField::build(const scene::FrameParticles& particles, const GroundSurface& surface) {
  surface_ = &surface;
  spacing_ = 0.5f * surface.cell();
  used_ = 0;
  index_.clear();
  recent_.fill(nullptr);
  const Vec3f origin = particles.origin.cast<float>();
  const std::size_t count = particles.position.size() / 3;
  const float beside_plate = kBeside * surface.cell();
  for (std::size_t i = 0; i < count; ++i) {
    const float* local = &particles.position[3 * i];
    const Vec3f p = origin + Vec3f(local[0], local[1], local[2]);
    if (!p.allFinite()) continue;
    const std::uint32_t id = particles.id.empty() ? static_cast<std::uint32_t>(i) : particles.id[i];
    // Unlike weights make the surface uneven, and the unevenness moves with the soil.
    const float weight = 0.55f + 0.9f * hash_unit(id, 3);
    AtPlate at_plate;
    const bool beside = !particles.away.empty() && particles.clearance[i] < beside_plate;
    if (beside) {
      const Eigen::Map<const Vec3f> away(&particles.away[3 * i]);
      at_plate = {p, away, away.dot(p) - particles.clearance[i]};
    }
    add(p, particles.soil.empty() ? std::uint8_t{0} : particles.soil[i], weight,
        beside ? &at_plate : nullptr);
  }
  for (std::size_t b = 0; b < used_; ++b) {
    Block& block = *pool_[b];
    for (int k = 0; k < 27; ++k)
      block.around[static_cast<std::size_t>(k)] =
          find(block.place + Eigen::Vector3i(k % 3 - 1, k / 3 % 3 - 1, k / 9 - 1));
    fill(block);
  }
}

void DensityField::add(const Vec3f& p_W, std::uint8_t kind, float weight, const AtPlate* at_plate) {
  const float scale = 1 / spacing_;
  const Reach rx(scale * p_W.x()), ry(scale * p_W.y()), rz(scale * p_W.z());
  for (int bz = 0; bz < rz.blocks(); ++bz)
    for (int by = 0; by < ry.blocks(); ++by)
      for (int bx = 0; bx < rx.blocks(); ++bx) {
        const Eigen::Vector3i place(block_of(rx.first) + bx, block_of(ry.first) + by,
                                    block_of(rz.first) + bz);
        Block& block = obtain(place, kind);
        if (at_plate != nullptr) block.at_plates.push_back(*at_plate);
        // Most blocks hold one kind of soil and were painted when they were made.
        block.mixed = block.mixed || kind != block.kind[0];
        const Eigen::Vector3i first = Eigen::Vector3i(rx.first, ry.first, rz.first) - kEdge * place;
        const auto [x0, x1] = rx.part(bx);
        const auto [y0, y1] = ry.part(by);
        const auto [z0, z1] = rz.part(bz);
        // Four nodes of each row are added as one vector; the particle has no share of some of them
        // where it reaches into the next block.
        const int begin = std::clamp(first.x(), 0, kEdge - kReached);
        std::array<float, kReached> along = {};
        for (int x = x0; x < x1; ++x)
          along[static_cast<std::size_t>(first.x() + x - begin)] =
              weight * rx.share[static_cast<std::size_t>(x)];
        for (int z = z0; z < z1; ++z)
          for (int y = y0; y < y1; ++y) {
            const float share =
                rz.share[static_cast<std::size_t>(z)] * ry.share[static_cast<std::size_t>(y)];
            float* soil = &block.soil[node_index(begin, first.y() + y, first.z() + z)];
            for (std::size_t x = 0; x < kReached; ++x) soil[x] += share * along[x];
            if (block.mixed)
              std::fill_n(&block.kind[node_index(first.x() + x0, first.y() + y, first.z() + z)],
                          x1 - x0, kind);
          }
      }
}

void DensityField::copy_soil(Block& block) {
  for (int z = -1; z < kWide - 1; ++z)
    for (int y = -1; y < kWide - 1; ++y) {
      const std::size_t row = node_index(0, y & (kEdge - 1), z & (kEdge - 1)),
                        beside =
                            static_cast<std::size_t>(3 * (block_of(y) + 1 + 3 * (block_of(z) + 1)));
      float* out = &block.all[wide_index(-1, y, z)];
      const Block* before = block.around[beside];
      const Block* here = block.around[beside + 1];
      const Block* beyond = block.around[beside + 2];
      out[0] = before != nullptr ? before->soil[row + kEdge - 1] : 0;
      for (std::size_t x = 0; x < kEdge; ++x)
        out[x + 1] = here != nullptr ? here->soil[row + x] : 0;
      for (std::size_t x = 0; x < 2; ++x)
        out[kEdge + 1 + x] = beyond != nullptr ? beyond->soil[row + x] : 0;
    }
}

// By shares of the four columns around a node, as particles have shares: at the border of the
// active soil the two add up to full soil.
void DensityField::fill(Block& block) const {
  copy_soil(block);
  constexpr std::size_t kColumns = kWide * kWide;
  std::array<std::array<float, kColumns>, 4> height, share;
  const Vec3f first = first_node(block) - Vec3f::Constant(spacing_);
  float low = 1e30f, high = -1e30f;
  for (std::size_t k = 0; k < kColumns; ++k) {
    const std::size_t x = k % kWide, y = k / kWide;
    const ColumnShares columns = surface_->columns_at(first.x() + spacing_ * static_cast<float>(x),
                                                      first.y() + spacing_ * static_cast<float>(y));
    for (std::size_t c = 0; c < 4; ++c) {
      height[c][k] = columns.height[c];
      share[c][k] = columns.share[c];
      low = std::min(low, columns.height[c]);
      high = std::max(high, columns.height[c]);
    }
  }
  const float slope = -0.5f / spacing_;
  for (std::size_t z = 0; z < kWide; ++z) {
    float* all = &block.all[z * kColumns];
    const float level = first.z() + spacing_ * static_cast<float>(z);
    // Most layers of nodes are above all columns or below them.
    const float ground = level >= high + spacing_ ? 0.0f : 1.0f;
    if (ground == 0 || level <= low - spacing_) {
      for (std::size_t k = 0; k < kColumns; ++k) all[k] = std::min(1.0f, all[k] + ground);
      continue;
    }
    for (std::size_t c = 0; c < 4; ++c)
      for (std::size_t k = 0; k < kColumns; ++k)
        all[k] +=
            share[c][k] * std::min(1.0f, std::max(0.0f, 0.5f + slope * (level - height[c][k])));
    for (std::size_t k = 0; k < kColumns; ++k) all[k] = std::min(1.0f, all[k]);
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

float DensityField::soil(const Block& block, int x, int y, int z) const {
  const auto [holder, k] = locate(block, x, y, z);
  return holder == nullptr ? 0 : holder->soil[k];
}

std::uint8_t DensityField::kind(const Block& block, int x, int y, int z) const {
  const auto [holder, k] = locate(block, x, y, z);
  return holder == nullptr ? std::uint8_t{0} : holder->kind[k];
}

float DensityField::sample(const Block& block, const Vec3f& p) const {
  const Vec3f low(std::floor(p.x()), std::floor(p.y()), std::floor(p.z()));
  const Vec3f t = p - low;
  Eigen::Vector3i node = low.cast<int>();
  const Block* holder = &block;
  if (node.minCoeff() < -1 || node.maxCoeff() > kEdge) {
    const Eigen::Vector3i by(block_of(node.x()), block_of(node.y()), block_of(node.z()));
    holder =
        block
            .around[static_cast<std::size_t>((by.x() + 1) + 3 * ((by.y() + 1) + 3 * (by.z() + 1)))];
    if (holder == nullptr) return ground_share(first_node(block) + spacing_ * p);
    node -= kEdge * by;
  }
  const float* all = &holder->all[wide_index(node.x(), node.y(), node.z())];
  const auto along_x = [&](const float* row) { return row[0] + t.x() * (row[1] - row[0]); };
  const auto layer = [&](const float* row) {
    const float near = along_x(row);
    return near + t.y() * (along_x(row + kWide) - near);
  };
  const float below = layer(all);
  return below + t.z() * (layer(all + kWide * kWide) - below);
}

float DensityField::sample(const Vec3f& p_W) const {
  const Vec3f q = p_W / spacing_;
  const Eigen::Vector3i place(block_of(static_cast<int>(std::floor(q.x()))),
                              block_of(static_cast<int>(std::floor(q.y()))),
                              block_of(static_cast<int>(std::floor(q.z()))));
  const Block* block = find(place);
  if (block == nullptr) return ground_share(p_W);
  return sample(*block, q - (kEdge * place).cast<float>());
}

}  // namespace navvy::render
