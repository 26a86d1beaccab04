// SPDX-License-Identifier: Apache-2.0
// Share of space that soil fills, at the nodes of a sparse grid: loose particles by a smooth
// kernel, the ground by its columns.
#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <unordered_map>
#include <vector>

#include "render/ground_surface.h"
#include "scene/frame.h"

namespace navvy::render {

/// Field of the share of space (0 to 1) that soil fills. Its nodes are half a column apart, at
/// multiples of that distance in W, so that a region that grows does not shift them. Only blocks of
/// nodes that a particle reaches are stored: soil at two places 30 m apart costs no more than at
/// one.
class DensityField {
 public:
  /// Number of nodes along the edge of a block, and in a block.
  static constexpr int kEdge = 8, kNodes = kEdge * kEdge * kEdge;
  /// Number of nodes along the edge of a block with those around it: one before and two beyond, so
  /// that the field and its gradient are known in all cells that begin in the block.
  static constexpr int kWide = kEdge + 3;
  /// Reach of a particle along each axis [columns]; its share of a node falls smoothly to zero
  /// there.
  static constexpr float kReach = 1;
  /// Distance from a plate below which a particle is beside it [columns].
  static constexpr float kBeside = 0.75f;

  /// A particle beside a plate.
  struct AtPlate {
    Vec3f p_W;     ///< position in W [m]
    Vec3f away;    ///< unit vector in W from the plate to the particle
    float offset;  ///< the plate's face is where `away` times the position in W is this [m]
  };

  /// A block of nodes. Node (x, y, z) of a block is at index x + kEdge * (y + kEdge * z).
  struct Block {
    /// Number of the block along each axis, from the origin of W.
    Eigen::Vector3i place = Eigen::Vector3i::Zero();
    /// Number of the block in the field, from 0.
    int number = 0;
    /// Share of each node that particles fill; above 1 in dense soil.
    std::array<float, kNodes> soil;
    /// Share of each node that particles and ground fill, at most 1, with the nodes around the
    /// block: node (x, y, z), from -1 to kEdge + 1, is at `wide_index`.
    std::array<float, kWide * kWide * kWide> all;
    /// Index of the soil at each node; meaningful where `soil` is above 0.
    std::array<std::uint8_t, kNodes> kind;
    /// True if particles of more than one kind reach into the block.
    bool mixed = false;
    /// Particles beside a plate that reach into the block.
    std::vector<AtPlate> at_plates;
    /// The block itself and its 26 neighbours, null where there is none: (x + 1) + 3 * ((y + 1) + 3
    /// * (z + 1)) for the offset (x, y, z) of -1 to 1.
    std::array<Block*, 27> around = {};
  };

  /// Returns the index of the node (x, y, z), each from -1 to kEdge + 1, in Block::all.
  static constexpr std::size_t wide_index(int x, int y, int z) {
    return static_cast<std::size_t>(x + 1 + kWide * (y + 1 + kWide * (z + 1)));
  }

  /// Builds the field of `particles` over the ground `surface`. Particles without a finite position
  /// are ignored. Both arguments must outlive the next calls.
  void build(const scene::FrameParticles& particles, const GroundSurface& surface);

  /// Returns the distance between two nodes [m].
  float spacing() const { return spacing_; }
  /// Returns the number of stored blocks.
  int blocks() const { return static_cast<int>(used_); }
  /// Returns a block by number, in the order in which particles first reached them.
  const Block& block(int i) const { return *pool_[static_cast<std::size_t>(i)]; }
  /// Returns the share that particles fill at the node (x, y, z) relative to the first node of
  /// `block`; each of the three from -kEdge to 2 * kEdge - 1.
  float soil(const Block& block, int x, int y, int z) const;
  /// Returns the index of the soil at a node where `soil` is above 0; arguments as for `soil`.
  std::uint8_t kind(const Block& block, int x, int y, int z) const;
  /// Returns the interpolated share filled at the point `p`, in nodes from the first node of
  /// `block`, from -kEdge to 2 * kEdge - 1 along each axis. Without a block there, the ground
  /// decides.
  float sample(const Block& block, const Vec3f& p) const;
  /// Returns the interpolated share filled at the position of a particle in W [m].
  float sample(const Vec3f& p_W) const;
  /// Returns the position in W of the first node of a block [m].
  Vec3f first_node(const Block& block) const {
    return block.place.cast<float>() * (spacing_ * kEdge);
  }

 private:
  /// Returns the block at a place, null if there is none.
  Block* find(const Eigen::Vector3i& place) const;
  /// Returns the block at a place; makes an empty one of the soil `kind` where there is none.
  Block& obtain(const Eigen::Vector3i& place, std::uint8_t kind);
  /// Adds one particle to the nodes that it reaches. `at_plate` is null if no plate is beside it.
  void add(const Vec3f& p_W, std::uint8_t kind, float weight, const AtPlate* at_plate);
  /// Adds up the shares of particles and ground at the nodes of a block and around it.
  void fill(Block& block) const;
  /// Copies the shares of particles at the nodes of a block and around it to Block::all.
  static void copy_soil(Block& block);
  /// Returns the share that the ground fills at a point of W [m].
  float ground_share(const Vec3f& p_W) const;
  /// Returns the neighbour of `block` that holds the node (x, y, z), and the node's index there.
  static std::pair<const Block*, std::size_t> locate(const Block& block, int x, int y, int z);

  // Ground below and beside the particles.
  const GroundSurface* surface_ = nullptr;
  // Distance between two nodes [m].
  float spacing_ = 0.05f;
  // Blocks, of which the first `used_` belong to the field; the others keep their memory.
  std::vector<std::unique_ptr<Block>> pool_;
  std::size_t used_ = 0;
  // Number of a block by its place.
  std::unordered_map<std::uint64_t, std::uint32_t> index_;
  // The blocks found last, by the parities of their places: neighbours in memory are neighbours in
  // space, and of the blocks that a particle reaches no two have equal parities.
  mutable std::array<Block*, 8> recent_ = {};
};

}  // namespace navvy::render
