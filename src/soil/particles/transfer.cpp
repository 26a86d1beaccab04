// SPDX-License-Identifier: Apache-2.0
#include "soil/particles/transfer.h"

#include <algorithm>
#include <limits>
#include <string>

#include "soil/layout.h"
#include "soil/particles/schedule.h"
#include "soil/particles/soil_table.h"

namespace navvy::soil {

Transfer::Transfer(device::Device& device, bool extended_law)
    : device_(device),
      scatter_program_(device, kernel_path(device, "particle_to_grid"),
                       extended_law ? std::vector{device::define("LAW_EXTENDED", 1)} : std::vector<std::string>{}),
      grid_program_(device, kernel_path(device, "grid_update")),
      gather_program_(device, kernel_path(device, "grid_to_particle")),
      scatter_(scatter_program_, "particle_to_grid"),
      grid_(grid_program_, "grid_update"),
      grid_near_(grid_program_, "grid_update_near"),
      gather_(gather_program_, "grid_to_particle") {}

void Transfer::set_blocks(const ParticleStore& store, const std::vector<int>& near_slot, int tiles) {
  const BlockTable& table = store.table();
  active_ = table.active.size();
  upload(device_, neighbours_, table.neighbours);
  upload(device_, around_, table.around);
  std::vector<std::int32_t> far;
  std::vector<std::array<std::int32_t, 4>> keys(active_);
  for (std::size_t b = 0; b < active_; ++b) {
    if (near_slot[b] < 0) far.push_back(static_cast<std::int32_t>(b));
    keys[b] = {table.active[b].x, table.active[b].y, table.active[b].z, 0};
  }
  far_ = far.size();
  upload(device_, far_list_, far);
  upload(device_, active_keys_, keys);
  ensure(device_, tiles_, static_cast<std::size_t>(tiles) * 4 * TILE_NODES);
  ensure(device_, used_, table.homes.size());
  ensure(device_, velocity_, active_ * 4 * BLOCK_NODES);
  ensure(device_, report_, table.homes.size());
}

void Transfer::set_floor(const std::vector<BlockFloor>& floors) { upload(device_, floor_, floors); }

void Transfer::scatter(ParticleStore& store, NearNodes& near, double dt, double cell, const Vec3& gravity) {
  const auto dt_f = static_cast<float>(dt), cell_f = static_cast<float>(cell);
  const Vec3 dv = gravity * dt;
  const std::array<float, 4> dv_f = {static_cast<float>(dv.x()), static_cast<float>(dv.y()), static_cast<float>(dv.z()),
                                     0.0f};
  scatter_
      .args(store.state(), store.capacity(), store.soils(), store.homes_buffer(), tiles_, used_, report_, dt_f, cell_f,
            static_cast<float>(std::min(1.0, dt / mixing_time())))
      .enqueue_groups(store.homes().size());
  grid_.args(far_list_, around_, store.homes_buffer(), tiles_, used_, floor_, velocity_, dv_f).enqueue_groups(far_);
  if (near.count == 0) return;
  grid_near_
      .args(near.list, around_, store.homes_buffer(), tiles_, used_, store.home_surface(), near.split, near.before0,
            near.before1, near.surface, dv_f)
      .enqueue_groups(static_cast<std::size_t>(near.count));
}

void Transfer::gather(ParticleStore& store, NearNodes& near, double dt, double cell) {
  gather_
      .args(store.state(), store.capacity(), store.homes_buffer(), neighbours_, velocity_, near.velocity1, near.slot,
            near.split, used_, report_, static_cast<float>(dt), static_cast<float>(cell),
            static_cast<float>(packed_mass(store.densest(), cell)),
            static_cast<float>(std::min(1.0, dt / closing_time())))
      .enqueue_groups(store.homes().size());
}

Transfer::Largest Transfer::read_report(std::size_t homes) const {
  Largest out;
  for (const Report& home : report_.map_read(0, homes)) {
    out.speed = std::max(out.speed, static_cast<double>(home.speed));
    if (home.broken != 0) out.speed = std::numeric_limits<double>::infinity();
    out.push = std::max(out.push, static_cast<double>(home.push));
    out.crossed += static_cast<std::uint64_t>(home.crossed);
  }
  return out;
}

}  // namespace navvy::soil
