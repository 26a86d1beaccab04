// SPDX-License-Identifier: Apache-2.0
#include "soil/tools/contact.h"

#include <algorithm>
#include <cmath>

#include "soil/layout.h"
#include "soil/particles/schedule.h"

namespace navvy::soil {
namespace {

bool yields(const ToolMotion& motion) { return motion.inverse_mass.cwiseAbs().maxCoeff() > 0; }

}  // namespace

Contact::Contact(device::Device& device, double cell, const Vec3& origin_W, double slowest_sound)
    : device_(device),
      cell_(cell),
      origin_(origin_W),
      reference_step_(settings_.reference * cell / slowest_sound),
      shell_program_(device, kernel_path(device, "shell")),
      contact_program_(device, kernel_path(device, "contact")),
      nodes_kernel_(shell_program_, "shell_nodes"),
      particles_kernel_(shell_program_, "shell_particles"),
      sums_kernel_(contact_program_, "contact_sums"),
      twist_kernel_(contact_program_, "contact_twist"),
      apply_kernel_(contact_program_, "contact_apply") {}

int Contact::add_tool(const scene::Shell& shell) {
  Tool tool;
  tool.geometry = std::make_unique<ShellGeometry>(shell, cell_);
  if (!tools_.empty())
    tool.first_triangle = tools_.back().first_triangle + static_cast<int>(tools_.back().geometry->triangles().size());
  tool.area_factor = plate_area_factor(*tool.geometry, settings_, cell_);
  tools_.push_back(std::move(tool));
  return static_cast<int>(tools_.size()) - 1;
}

template <class... Tail>
void Contact::launch(device::Kernel& kernel, Transfer& transfer, int only, const Tail&... tail) {
  kernel
      .args(nodes_.list, transfer.active_keys(), nodes_.before0, nodes_.before1, nodes_.split, node_tool_, shell_,
            nodes_.surface, frame_, first_tool_, only, reach_, static_cast<float>(cell_), tail...)
      .enqueue_groups(static_cast<std::size_t>(nodes_.count));
}

void Contact::solve(Transfer& transfer, double dt) {
  if (nodes_.count == 0) return;
  reach_ = {static_cast<float>(settings_.reach),
            static_cast<float>(settings_.ramp),
            static_cast<float>(settings_.edge),
            static_cast<float>(settings_.edge_ramp),
            static_cast<float>(dt / reference_step_),
            static_cast<float>(dt * cell_ * cell_),
            static_cast<float>(settings_.opening * std::sqrt(kGravity * cell_))};
  for (const ToolMotion& motion : motions_) {
    if (!yields(motion)) continue;
    for (int sweep = 0; sweep < settings_.sweeps; ++sweep) {
      launch(sums_kernel_, transfer, motion.tool, sums_);
      twist_kernel_.args(frame_, first_tool_, motion.tool, sums_, nodes_.count).enqueue_groups(1);
    }
  }
  launch(apply_kernel_, transfer, -1, transfer.floor(), touched_, books_, transfer.velocity(), nodes_.velocity1);
}

namespace {

/// Sums of one tool over its nodes.
struct Momentum {
  Vec3 before = Vec3::Zero(), after = Vec3::Zero(), before_moment = Vec3::Zero(), after_moment = Vec3::Zero();
};

/// Books one node and field: `at` = v before, m, v after, normal impulse; r = arm from the tool's origin [m].
void book_node(const float* at, const Vec3& r, ToolImpulse& out, Momentum& sum) {
  const Vec3 before(at[0], at[1], at[2]), after(at[4], at[5], at[6]);
  const auto mass = static_cast<double>(at[3]), push = static_cast<double>(at[7]);
  const Vec3 J = mass * (after - before), L = r.cross(J);
  out.J_W -= J;
  out.L_W -= L;
  out.scale += J.norm();
  out.scale_moment += L.norm();
  out.normal += push;
  out.friction += std::sqrt(std::max(0.0, J.squaredNorm() - push * push));
  sum.before += mass * before;
  sum.after += mass * after;
  sum.before_moment += r.cross(mass * before);
  sum.after_moment += r.cross(mass * after);
}

}  // namespace

void Contact::read_later() {
  if (nodes_.count == 0 || motions_.empty()) return;
  const auto slots = static_cast<std::size_t>(nodes_.count);
  results_.emplace(Books{touched_.map_read_later(0, slots), node_tool_.map_read_later(0, slots * BLOCK_NODES),
                         books_.map_read_later(0, slots * BLOCK_NODES * 16)});
}

void Contact::book(std::span<ToolImpulse> impulses) {
  if (!results_) return;
  const Books read = std::move(*results_);
  results_.reset();
  const auto slots = static_cast<std::size_t>(nodes_.count);
  std::vector<int> motion_of(tools_.size(), -1);
  for (std::size_t m = 0; m < motions_.size(); ++m)
    motion_of[static_cast<std::size_t>(motions_[m].tool)] = static_cast<int>(m);
  std::vector<Momentum> momentum(motions_.size());
  const auto& [touched, tool_of, books] = read;
  if (std::none_of(touched.begin(), touched.end(), [](std::int32_t t) { return t != 0; })) return;

  for (std::size_t slot = 0; slot < slots; ++slot) {
    if (touched[slot] == 0) continue;
    const BlockKey& key = near_keys_[slot];
    for (std::size_t n = 0; n < BLOCK_NODES; ++n) {
      const std::size_t i = slot * BLOCK_NODES + n;
      for (std::size_t s = 0; s < 2; ++s) {
        const float* at = books.data() + 16 * i + 8 * s;
        if (at[0] == at[4] && at[1] == at[5] && at[2] == at[6]) continue;
        const auto m = static_cast<std::size_t>(motion_of[static_cast<std::size_t>(tool_of[i])]);
        const Vec3 grid(kBlockCells * key.x + static_cast<int>(n & 3),
                        kBlockCells * key.y + static_cast<int>((n >> 2) & 3),
                        kBlockCells * key.z + static_cast<int>(n >> 4));
        book_node(at, grid * cell_ + origin_ - impulses[m].p_W, impulses[m], momentum[m]);
      }
    }
  }
  for (std::size_t m = 0; m < motions_.size(); ++m) {
    impulses[m].residual = impulses[m].J_W + (momentum[m].after - momentum[m].before);
    impulses[m].residual_moment = impulses[m].L_W + (momentum[m].after_moment - momentum[m].before_moment);
  }
}

}  // namespace navvy::soil
