// SPDX-License-Identifier: Apache-2.0
#include "soil/particles/grid_update.h"

#include "soil/particles/buffers.h"
#include "soil/particles/schedule.h"
#include "soil/scheme.h"

namespace navvy::soil {

GridUpdate::GridUpdate(device::Device& device, const SchemeConstants& scheme)
    : device_(device),
      program_(device, kernel_path(device, "grid_update"), scheme_options(scheme)),
      far_kernel_(program_, "grid_update"),
      near_kernel_(program_, "grid_update_near") {}

void GridUpdate::set_blocks(const BlockTable& table, const std::vector<int>& near_slot) {
  // Near blocks have their own kernel with two fields; all others take the short path.
  std::vector<std::int32_t> far;
  std::vector<std::array<std::int32_t, 4>> keys(table.active.size());
  for (std::size_t b = 0; b < table.active.size(); ++b) {
    if (near_slot[b] < 0) far.push_back(static_cast<std::int32_t>(b));
    keys[b] = {table.active[b].x, table.active[b].y, table.active[b].z, 0};
  }
  far_ = far.size();
  upload(device_, around_, table.around);
  upload(device_, far_list_, far);
  upload(device_, active_keys_, keys);
  ensure(device_, velocity_, table.active.size() * 4 * BLOCK_NODES);
}

void GridUpdate::set_floor(const std::vector<BlockFloor>& floors) {
  upload(device_, floors_, floors);
}

void GridUpdate::enqueue(ParticleStore& store, ParticleToGrid& scattered, NearNodes& near,
                         const Vec3& dv, bool hold) {
  const std::array<float, 4> dv_f = {static_cast<float>(dv.x()), static_cast<float>(dv.y()),
                                     static_cast<float>(dv.z()), 0.0f};
  far_kernel_
      .args(far_list_, around_, store.particle_blocks_buffer(), scattered.tiles(), scattered.used(),
            floors_, velocity_, dv_f, hold ? 1 : 0, near.renew ? 1 : 0)
      .enqueue_groups(far_);
  // The near kernel leaves the floor to contact_apply: tools act before the ground holds.
  if (near.count == 0) return;
  near_kernel_
      .args(near.list, around_, store.particle_blocks_buffer(), scattered.tiles(), scattered.used(),
            store.block_surface(), near.split, near.before0, near.before1, near.surface, velocity_,
            near.velocity1, dv_f, hold ? 1 : 0, near.renew ? 1 : 0)
      .enqueue_groups(static_cast<std::size_t>(near.count));
}

}  // namespace navvy::soil
