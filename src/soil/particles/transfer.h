// SPDX-License-Identifier: Apache-2.0
// The three particle-grid kernels: scatter to tiles, tiles to node velocities, gather. A portable, unfused schedule:
// one work-item per block, each writing only what it owns, every sum in a fixed order.
#pragma once

#include <vector>

#include "core/math.h"
#include "device/buffer.h"
#include "device/program.h"
#include "soil/particles/particle_store.h"

namespace navvy::soil {

/// Arrays of node data that exist only in active blocks near shells.
struct NearNodes {
  int count = 0;                           ///< near active blocks
  device::Buffer<std::int32_t> list;       ///< their active indices, ascending
  device::Buffer<std::int32_t> slot;       ///< per active block: index into the near arrays or -1
  device::Buffer<std::int32_t> split;      ///< per near node: 0, 1 in front, 2 behind
  device::Buffer<float> before0, before1;  ///< float4 per near node: v after gravity, m
  device::Buffer<float> velocity1;         ///< float4 per near node: what particles behind a shell feel
  device::Buffer<Surface> surface;         ///< per near node: mean by mass of the homes around
};

class Transfer {
 public:
  /// `extended_law`: see needs_extended_law.
  Transfer(device::Device& device, bool extended_law);

  /// Takes over the block lists after a re-bin or a change of the near blocks. `near_slot` has one entry per active
  /// block; `tiles` is what ParticleStore::set_near returned.
  void set_blocks(const ParticleStore& store, const std::vector<int>& near_slot, int tiles);
  void set_floor(const std::vector<BlockFloor>& floors);

  /// Law and scatter, then node velocities after gravity: final in far blocks, before contact in near ones.
  void scatter(ParticleStore& store, NearNodes& near, double dt, double cell, const Vec3& gravity);
  /// Queues gather and motion.
  void gather(ParticleStore& store, NearNodes& near, double dt, double cell);
  /// Largest values over the home blocks after a step; waits.
  struct Largest {
    double speed = 0;  ///< velocity component [m/s]; infinite when a value was not finite
    double push = 0;   ///< out of a plate [cells]
    std::uint64_t crossed = 0;
  };
  Largest read_report(std::size_t homes) const;

  device::Buffer<float>& velocity() { return velocity_; }
  device::Buffer<Report>& report() { return report_; }
  device::Buffer<BlockFloor>& floor() { return floor_; }
  device::Buffer<std::array<std::int32_t, 4>>& active_keys() { return active_keys_; }
  std::size_t active() const { return active_; }

 private:
  device::Device& device_;
  device::Program scatter_program_, grid_program_, gather_program_;
  device::Kernel scatter_, grid_, grid_near_, gather_;
  std::size_t active_ = 0, far_ = 0;
  device::Buffer<float> tiles_, velocity_;
  device::Buffer<BlockFloor> floor_;
  device::Buffer<Report> report_;
  device::Buffer<std::int32_t> neighbours_, around_, far_list_, used_;
  device::Buffer<std::array<std::int32_t, 4>> active_keys_;
};

/// Makes room for `size` values, contents undefined.
template <class T>
void ensure(device::Device& device, device::Buffer<T>& buffer, std::size_t size) {
  if (buffer.size() < size || buffer.empty()) buffer = device::Buffer<T>(device, size + size / 2 + 1);
}
/// The same, then writes the values.
template <class T>
void upload(device::Device& device, device::Buffer<T>& buffer, const std::vector<T>& values) {
  ensure(device, buffer, values.size());
  buffer.write(values);
}

}  // namespace navvy::soil
