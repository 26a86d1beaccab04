// SPDX-License-Identifier: Apache-2.0
#include "soil/tools/contact.h"

#include <algorithm>
#include <cmath>
#include <iterator>

#include "soil/particles/schedule.h"
#include "soil/scheme.h"

namespace navvy::soil {
namespace {

/// Newton iterations of the two-way solve; contact is piecewise linear, so few are enough.
constexpr int kSweeps = 3;

/// Returns false for scripted tools: they have no mobility, and nothing is to be solved for.
bool yields(const ToolMotion& motion) { return motion.inverse_mass.cwiseAbs().maxCoeff() > 0; }

}  // namespace

Contact::Contact(device::Device& device, double cell, const Vec3& origin_W, const Vec3& gravity,
                 const SchemeConstants& scheme)
    : device_(device),
      cell_(cell),
      origin_(origin_W),
      down_(gravity.norm() > 0 ? Vec3(gravity.normalized()) : Vec3(Vec3::Zero())),
      scheme_(scheme),
      weight_(-gravity.z()),
      shells_(device, scheme),
      edges_(device, cell, scheme),
      contact_program_(device, kernel_path(device, "contact"), scheme_options(scheme)),
      edges_kernel_(contact_program_, "edge_nodes"),
      sums_kernel_(contact_program_, "contact_sums"),
      twist_kernel_(contact_program_, "contact_twist"),
      apply_kernel_(contact_program_, "contact_apply") {}

// Triangles are numbered over all tools, so that one number gives triangle and tool.
int Contact::add_tool(const scene::Shell& shell) {
  Registered tool;
  tool.geometry = std::make_unique<ShellGeometry>(shell, cell_);
  if (!tools_.empty())
    tool.first_triangle =
        tools_.back().first_triangle + static_cast<int>(tools_.back().geometry->triangles().size());
  // Adhesion acts per area of the shell, but the kernels sum over nodes.
  tool.area_factor = plate_area_factor(*tool.geometry, cell_, scheme_);
  edges_.add_tool(*tool.geometry);
  tools_.push_back(std::move(tool));
  return static_cast<int>(tools_.size()) - 1;
}

template <class... Tail>
void Contact::launch(device::Kernel& kernel, Transfer& transfer, int only, const Tail&... tail) {
  kernel
      .args(nodes_.list, transfer.active_keys(), nodes_.before0, nodes_.before1, nodes_.split,
            shells_.node_tool(), shells_.node_shell(), nodes_.surface, edges_.force(),
            shells_.tools(), only, reach_, static_cast<float>(cell_), tail...)
      .enqueue_groups(static_cast<std::size_t>(nodes_.count));
}

void Contact::find_edges(ParticleStore& store, Transfer& transfer) {
  if (!edges_.any()) return;
  edges_.enqueue(store);
  edges_kernel_
      .args(nodes_.before0, nodes_.before1, transfer.velocity(), nodes_.split, shells_.node_tool(),
            nodes_.surface, shells_.tools(), edges_.nodes(), edges_.profiles(),
            edges_.above_first(), edges_.above(), nodes_.slot, edges_.around(), edges_.strength(),
            static_cast<float>(weight_ / (cell_ * cell_)), static_cast<float>(cell_),
            edges_.force())
      .enqueue_groups(static_cast<std::size_t>(nodes_.count));
}

void Contact::solve(ParticleStore& store, Transfer& transfer, double dt) {
  if (nodes_.count == 0) return;
  find_edges(store, transfer);
  // Speeds of the scheme are in units of sqrt(g h), so that they scale with the cell.
  reach_ = {static_cast<float>(scheme_.contact_reach),
            static_cast<float>(scheme_.contact_ramp),
            static_cast<float>(scheme_.contact_edge),
            static_cast<float>(scheme_.contact_edge_ramp),
            static_cast<float>(dt * cell_ * cell_),
            static_cast<float>(scheme_.contact_opening * std::sqrt(kGravity * cell_)),
            static_cast<float>(scheme_.contact_settling * std::sqrt(kGravity * cell_)),
            static_cast<float>(scheme_.contact_falling * std::sqrt(kGravity * cell_)),
            static_cast<float>(scheme_.edge_slow * std::sqrt(kGravity * cell_)),
            static_cast<float>(down_.x()),
            static_cast<float>(down_.y()),
            static_cast<float>(down_.z())};
  // Newton on the twist of each tool that yields.
  for (const ToolMotion& motion : motions_) {
    if (!yields(motion)) continue;
    for (int sweep = 0; sweep < kSweeps; ++sweep) {
      launch(sums_kernel_, transfer, motion.tool, sums_);
      twist_kernel_.args(shells_.tools(), motion.tool, sums_, nodes_.count).enqueue_groups(1);
    }
  }
  // Apply all tools at once, with their final twists.
  launch(apply_kernel_, transfer, -1, transfer.floors(), touched_, records_, transfer.velocity(),
         nodes_.velocity1);
}

namespace {

/// Sums of one tool over its nodes.
struct Momentum {
  Vec3 before = Vec3::Zero(), after = Vec3::Zero(), before_moment = Vec3::Zero(),
       after_moment = Vec3::Zero();
};

/// Adds one field of a node; r = lever arm from the tool's origin [m]; edge: it is ahead of an
/// edge.
void add_record(const ContactRecord& record, const Vec3& r, bool edge, ToolImpulse& out,
                Momentum& sum) {
  const Vec3 before(record.before[0], record.before[1], record.before[2]);
  const Vec3 after(record.after[0], record.after[1], record.after[2]);
  const auto mass = static_cast<double>(record.mass), push = static_cast<double>(record.push);
  // Soil gains J, so the tool gains -J.
  const Vec3 J = mass * (after - before), L = r.cross(J);
  out.J_W -= J;
  out.L_W -= L;
  if (edge) {
    out.J_edge_W -= J;
    out.L_edge_W -= L;
  }
  out.scale += J.norm();
  out.scale_moment += L.norm();
  out.normal += push;
  // Friction is what remains of the impulse beside its normal part; rounding may make that
  // negative.
  out.friction += std::sqrt(std::max(0.0, J.squaredNorm() - push * push));
  sum.before += mass * before;
  sum.after += mass * after;
  sum.before_moment += r.cross(mass * before);
  sum.after_moment += r.cross(mass * after);
}

}  // namespace

// Mapped without waiting: the read of the report waits for all three.
void Contact::queue_read() {
  if (nodes_.count == 0 || motions_.empty()) return;
  const auto blocks = static_cast<std::size_t>(nodes_.count);
  results_.emplace(Results{touched_.map_read_later(0, blocks),
                           shells_.node_tool().map_read_later(0, blocks * BLOCK_NODES),
                           nodes_.split.map_read_later(0, blocks * BLOCK_NODES),
                           records_.map_read_later(0, 2 * blocks * BLOCK_NODES)});
}

void Contact::sum_impulses(std::span<ToolImpulse> impulses) {
  if (!results_) return;
  // The maps end with this copy: the next step may write the buffers.
  const Results read = std::move(*results_);
  results_.reset();
  const auto blocks = static_cast<std::size_t>(nodes_.count);
  // A tool without a motion in this step touches nothing.
  std::vector<int> motion_of(tools_.size(), -1);
  for (std::size_t m = 0; m < motions_.size(); ++m)
    motion_of[static_cast<std::size_t>(motions_[m].tool)] = static_cast<int>(m);
  std::vector<Momentum> momentum(motions_.size());
  const auto& [touched, tool_of, split, records] = read;
  if (std::none_of(touched.begin(), touched.end(), [](std::int32_t t) { return t != 0; })) return;

  for (std::size_t near = 0; near < blocks; ++near) {
    if (touched[near] == 0) continue;
    const BlockKey& key = near_keys_[near];
    for (std::size_t n = 0; n < BLOCK_NODES; ++n) {
      const std::size_t i = near * BLOCK_NODES + n;
      for (std::size_t s = 0; s < 2; ++s) {
        const ContactRecord& record = records[2 * i + s];
        // A node with equal velocities before and after was touched by no tool.
        if (std::equal(std::begin(record.before), std::end(record.before),
                       std::begin(record.after)))
          continue;
        const auto m = static_cast<std::size_t>(motion_of[static_cast<std::size_t>(tool_of[i])]);
        // Position of the node in doubles: lever arms are as exact as the impulses.
        const Vec3 grid(kBlockCells * key.x + static_cast<int>(n & 3),
                        kBlockCells * key.y + static_cast<int>((n >> 2) & 3),
                        kBlockCells * key.z + static_cast<int>(n >> 4));
        add_record(record, grid * cell_ + origin_ - impulses[m].p_W, at_edge(split[i]), impulses[m],
                   momentum[m]);
      }
    }
  }
  // Impulse on the tools plus momentum change of the nodes: only rounding remains.
  for (std::size_t m = 0; m < motions_.size(); ++m) {
    impulses[m].residual = impulses[m].J_W + (momentum[m].after - momentum[m].before);
    impulses[m].residual_moment =
        impulses[m].L_W + (momentum[m].after_moment - momentum[m].before_moment);
  }
}

void Contact::add_impulses(double dt, std::span<ToolImpulse> impulses) {
  for (std::size_t m = 0; m < motions_.size(); ++m) {
    Registered& tool = tools_[static_cast<std::size_t>(motions_[m].tool)];
    tool.J_W += impulses[m].J_W;
    tool.J_edge_W += impulses[m].J_edge_W;
    tool.L_W += impulses[m].L_W;
    tool.summed_time += dt;
    // In the first transfer of a contact there is no earlier mean, so the running mean is reported.
    if (!tool.has_mean) {
      tool.force_W = tool.J_W / tool.summed_time;
      tool.moment_W = tool.L_W / tool.summed_time;
      tool.edge_force_W = tool.J_edge_W / tool.summed_time;
    }
    impulses[m].force_W = tool.force_W;
    impulses[m].edge_force_W = tool.edge_force_W;
    impulses[m].moment_W = tool.moment_W;
  }
}

void Contact::end_transfer() {
  for (Registered& tool : tools_) {
    // The mean over a whole transfer is reported during the next one: within a transfer the
    // impulses of single steps vary.
    tool.has_mean = tool.summed_time > 0;
    tool.force_W = tool.has_mean ? Vec3(tool.J_W / tool.summed_time) : Vec3(Vec3::Zero());
    tool.moment_W = tool.has_mean ? Vec3(tool.L_W / tool.summed_time) : Vec3(Vec3::Zero());
    tool.edge_force_W = tool.has_mean ? Vec3(tool.J_edge_W / tool.summed_time) : Vec3(Vec3::Zero());
    tool.J_W = tool.L_W = tool.J_edge_W = Vec3::Zero();
    tool.summed_time = 0;
  }
}

}  // namespace navvy::soil
