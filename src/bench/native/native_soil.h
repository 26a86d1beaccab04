// SPDX-License-Identifier: Apache-2.0
// Particle method as a plain C++ loop for one thread: the baseline that the OpenCL schedules must
// beat. It has the transfers, law, mixing and closing of kernels/soil, without tools, on level
// ground. Float4 nodes lie on a dense grid, and particles are sorted by cell.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "scene/soil.h"
#include "soil/particle_fields.h"
#include "soil/particles/interval.h"
#include "soil/particles/particle.h"

namespace navvy::bench {

struct Weights;

/// Steps soil of one kind. Built for speed with the instructions of the machine that compiles it;
/// on an older processor it may end the program.
class NativeSoil {
 public:
  /// Starts without particles. `ground`: height of the resting ground [cells of the grid frame].
  NativeSoil(const scene::Soil& soil, double cell, double ground);

  void insert(const std::vector<soil::Particle>& particles);
  /// Advances by dt [s] with gravity 9.81 m/s2 along -z.
  void step(double dt);
  /// Returns the particles in the order of their ids.
  std::vector<soil::Particle> particles() const;
  std::size_t size() const { return count_; }
  int sorts() const { return sorts_; }

 private:
  static constexpr std::size_t kLanes = 16;
  /// Fields of sixteen particles side by side; the run of each block begins at a pack.
  struct alignas(64) Pack {
#define PACK_ONE(NAME, member, rest) float member[kLanes];
#define PACK_MANY(NAME, member, count, rest) float member[count][kLanes];
    FLOAT_FIELDS(PACK_ONE, PACK_MANY)
#undef PACK_ONE
#undef PACK_MANY
    /// [kg].
    float mass[kLanes];
    std::uint32_t id[kLanes];
  };
  /// One 4^3 block of cells: its packs and the number of lanes with particles.
  struct ParticleBlock {
    std::size_t first = 0, count = 0;
    /// [cells of the window].
    int corner[3] = {0, 0, 0};
  };
  using Float4 = float __attribute__((vector_size(16)));

  void sort(const std::vector<soil::Particle>& particles);
  /// Appends to the last block.
  void append(const soil::Particle& p);
  bool sum_openings(const ParticleBlock& particle_block);
  void scatter(const ParticleBlock& particle_block, float dt, bool hold);
  void update_grid(float dt, bool hold);
  /// Moves particles by their recorded displacement.
  void end_transfer();
  /// Returns the fastest velocity component.
  float gather(const ParticleBlock& particle_block, float dt);
  /// Returns the first of the nodes around lane `l` of a pack of the block.
  std::size_t first_node(const Weights& weights, std::size_t l,
                         const ParticleBlock& particle_block) const;
  /// Returns the index of a node, x fastest.
  std::size_t node(const int* base) const {
    return static_cast<std::size_t>(base[0]) +
           row_ * (static_cast<std::size_t>(base[1]) + rows_ * static_cast<std::size_t>(base[2]));
  }

  scene::Soil soil_;
  float cell_, ground_;
  /// [s].
  double transfer_length_;
  soil::TransferInterval interval_;
  /// Cells that particles may have moved since the last sort.
  double drift_ = 0;
  int sorts_ = 0;
  std::size_t count_ = 0;
  std::vector<Pack> packs_;
  std::vector<ParticleBlock> particle_blocks_;
  /// Cell of the grid frame at the low corner of the window.
  std::array<int, 3> window_{};
  /// Nodes of the window along x, y, z.
  std::array<int, 3> nodes_{};
  std::size_t row_ = 0, rows_ = 0;
  /// Momentum and mass.
  std::vector<Float4> grid_;
  /// Velocity and mass per free volume.
  std::vector<Float4> velocity_;
  // Per cell of a block: volume, bank volume, 1 if any soil is open; mean opening, 0 if none is.
  std::vector<std::array<float, 3>> sums_;
  std::vector<float> openings_;
};

}  // namespace navvy::bench
