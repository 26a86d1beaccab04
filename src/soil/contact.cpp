// SPDX-License-Identifier: Apache-2.0
#include "soil/contact.h"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>

#include "soil/layout.h"

namespace navvy::soil {
namespace {

/// Twist of a motion, angular first.
Vec6 twist_of(const ToolMotion& motion) {
  Vec6 V;
  V << motion.w_WT, motion.v_WT;
  return V;
}

bool yields(const ToolMotion& motion) { return motion.inverse_mass.cwiseAbs().maxCoeff() > 0; }

}  // namespace

Contact::Contact(device::Device& device, double cell, const Vec3& origin_W, double slowest_sound)
    : device_(device),
      cell_(cell),
      origin_(origin_W),
      reference_step_(settings_.reference * cell / slowest_sound),
      shell_program_(device, "soil/shell.cl"),
      contact_program_(device, "soil/contact.cl"),
      nodes_kernel_(shell_program_, "shell_nodes"),
      particles_kernel_(shell_program_, "shell_particles"),
      sums_kernel_(contact_program_, "contact_sums"),
      apply_kernel_(contact_program_, "contact_apply") {}

int Contact::add_tool(const scene::Shell& shell) {
  Tool tool;
  tool.geometry = std::make_unique<ShellGeometry>(shell, cell_);
  if (!tools_.empty())
    tool.first_triangle = tools_.back().first_triangle + static_cast<int>(tools_.back().geometry->triangles().size());
  tools_.push_back(std::move(tool));
  return static_cast<int>(tools_.size()) - 1;
}

void Contact::write_tools(std::span<const ToolMotion> motions, const std::vector<Vec6>& twists, int only) {
  std::vector<float> words(tools_.size() * TOOL_WORDS, 0.0f);
  for (std::size_t m = 0; m < motions.size(); ++m) {
    const Tool& tool = tools_[static_cast<std::size_t>(motions[m].tool)];
    float* at = words.data() + static_cast<std::size_t>(motions[m].tool) * TOOL_WORDS;
    const Vec3 corner(kBlockCells * tool.window.x, kBlockCells * tool.window.y, kBlockCells * tool.window.z);
    const Vec3 origin = to_grid(tool.X.translation()) - corner;
    for (int a = 0; a < 3; ++a) {
      at[TOOL_ORIGIN + a] = static_cast<float>(origin[a]);
      at[TOOL_SPIN + a] = static_cast<float>(twists[m][a]);
      at[TOOL_SPEED + a] = static_cast<float>(twists[m][3 + a]);
    }
    at[TOOL_HALF] = static_cast<float>(tool.geometry->shell().half_thickness / cell_);
    at[TOOL_ACTIVE] = only < 0 || only == motions[m].tool ? 1.0f : 0.0f;
  }
  upload(device_, tools_buffer_, words);
}

template <class... Tail>
void Contact::launch(device::Kernel& kernel, Transfer& transfer, const Tail&... tail) {
  kernel
      .args(nodes_.list, transfer.active_keys(), nodes_.before0, nodes_.before1, nodes_.split, node_tool_, shell_,
            nodes_.friction, windows_, tools_buffer_, reach_, static_cast<float>(cell_), tail...)
      .enqueue(static_cast<std::size_t>(nodes_.count), 1);
}

Vec6 Contact::solve_twist(Transfer& transfer, std::span<const ToolMotion> motions, std::vector<Vec6>& twists,
                          std::size_t at) {
  // F(V) = V - V_pre + W sum J(V) = 0 with W the inverse mass; its slope is 1 + W K.
  const Vec6 start = twist_of(motions[at]);
  const Mat6& W = motions[at].inverse_mass;
  Vec6 V = start;
  for (int sweep = 0; sweep < settings_.sweeps; ++sweep) {
    twists[at] = V;
    write_tools(motions, twists, motions[at].tool);
    launch(sums_kernel_, transfer, sums_);
    Vec6 J = Vec6::Zero();
    Mat6 K = Mat6::Zero();
    const auto sums = sums_.map_read(0, static_cast<std::size_t>(nodes_.count) * CONTACT_SUMS);
    for (int slot = 0; slot < nodes_.count; ++slot) {
      const float* from = sums.data() + slot * CONTACT_SUMS;
      for (int i = 0; i < 6; ++i) J[i] += static_cast<double>(from[i]);
      for (int i = 0, k = 6; i < 6; ++i)
        for (int j = i; j < 6; ++j, ++k) K(i, j) += static_cast<double>(from[k]);
    }
    for (int i = 0; i < 6; ++i)
      for (int j = 0; j < i; ++j) K(i, j) = K(j, i);
    const Vec6 F = V - start + W * J;
    V -= (Mat6::Identity() + W * K).partialPivLu().solve(F);
  }
  return V;
}

void Contact::solve(Transfer& transfer, double dt, std::span<ToolImpulse> impulses) {
  for (std::size_t m = 0; m < motions_.size(); ++m) {
    impulses[m] = ToolImpulse{};
    impulses[m].p_W = motions_[m].X_WT.translation();
  }
  if (nodes_.count == 0) return;
  reach_ = {static_cast<float>(settings_.reach), static_cast<float>(settings_.ramp), static_cast<float>(settings_.edge),
            static_cast<float>(settings_.edge_ramp), static_cast<float>(dt / reference_step_)};
  std::vector<Vec6> twists;
  for (const ToolMotion& motion : motions_) twists.push_back(twist_of(motion));
  for (std::size_t m = 0; m < motions_.size(); ++m)
    if (yields(motions_[m])) twists[m] = solve_twist(transfer, motions_, twists, m);
  write_tools(motions_, twists, -1);
  launch(apply_kernel_, transfer, transfer.floor(), after0_, after1_, transfer.velocity(), nodes_.velocity1);
  book(transfer, motions_, impulses);
}

void Contact::book(const Transfer&, std::span<const ToolMotion> motions, std::span<ToolImpulse> impulses) const {
  const auto nodes = static_cast<std::size_t>(nodes_.count) * BLOCK_NODES;
  const auto split = nodes_.split.map_read(0, nodes);
  const auto tool_of = node_tool_.map_read(0, nodes);
  const auto shell = shell_.map_read(0, 8 * nodes);
  const auto before0 = nodes_.before0.map_read(0, 4 * nodes), before1 = nodes_.before1.map_read(0, 4 * nodes);
  const auto after0 = after0_.map_read(0, 4 * nodes), after1 = after1_.map_read(0, 4 * nodes);
  std::vector<int> motion_of(tools_.size(), -1);
  for (std::size_t m = 0; m < motions.size(); ++m)
    motion_of[static_cast<std::size_t>(motions[m].tool)] = static_cast<int>(m);
  struct Momentum {
    Vec3 before = Vec3::Zero(), after = Vec3::Zero(), before_moment = Vec3::Zero(), after_moment = Vec3::Zero();
  };
  std::vector<Momentum> momentum(motions.size());

  for (std::size_t i = 0; i < nodes; ++i) {
    if (split[i] == 0) continue;
    const int m = motion_of[static_cast<std::size_t>(tool_of[i])];
    if (m < 0) continue;
    ToolImpulse& out = impulses[static_cast<std::size_t>(m)];
    Momentum& sum = momentum[static_cast<std::size_t>(m)];
    const BlockKey& key = near_keys_[i / BLOCK_NODES];
    const int n = static_cast<int>(i % BLOCK_NODES);
    for (int s = 0; s < 2; ++s) {
      const float* b = (s == 0 ? before0 : before1).data() + 4 * i;
      const float* a = (s == 0 ? after0 : after1).data() + 4 * i;
      if (a[0] == b[0] && a[1] == b[1] && a[2] == b[2]) continue;
      const Vec3 vb(b[0], b[1], b[2]), va(a[0], a[1], a[2]);
      const auto mass = static_cast<double>(b[3]);
      const Vec3 grid(kBlockCells * key.x + (n & 3), kBlockCells * key.y + ((n >> 2) & 3),
                      kBlockCells * key.z + (n >> 4));
      const Vec3 r = grid * cell_ + origin_ - out.p_W;
      const Vec3 J = mass * (va - vb), L = r.cross(J);
      out.J_W -= J;
      out.L_W -= L;
      out.scale += J.norm();
      out.scale_moment += L.norm();
      const Vec3 normal(shell[8 * i], shell[8 * i + 1], shell[8 * i + 2]);
      const double push = J.dot(normal);
      out.normal += std::abs(push);
      out.friction += (J - push * normal).norm();
      sum.before += mass * vb;
      sum.after += mass * va;
      sum.before_moment += r.cross(mass * vb);
      sum.after_moment += r.cross(mass * va);
    }
  }
  for (std::size_t m = 0; m < motions.size(); ++m) {
    impulses[m].residual = impulses[m].J_W + (momentum[m].after - momentum[m].before);
    impulses[m].residual_moment = impulses[m].L_W + (momentum[m].after_moment - momentum[m].before_moment);
  }
}

}  // namespace navvy::soil
