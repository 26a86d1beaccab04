// SPDX-License-Identifier: Apache-2.0
#include "soil/tools/contact.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <utility>

#include "soil/particles/schedule.h"
#include "soil/scheme.h"

namespace navvy::soil {
namespace {

/// Records beyond those of the last step that are read with them at the start of a transfer,
/// without another wait: an eighth of them, and this number.
constexpr std::size_t kMoreRecords = 64;

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
      nodes_kernel_(contact_program_, "contact_nodes"),
      solve_kernel_(contact_program_, "contact_solve"),
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
  const float patch = reach_.patch;
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
  const auto blocks = static_cast<std::size_t>(nodes_.count);
  // Contacts contain the impulse of adhesion in a step.
  const int renew = nodes_.renew || patch != reach_.patch ? 1 : 0;
  nodes_kernel_
      .args(nodes_.list, transfer.active_keys(), nodes_.before0, nodes_.before1, nodes_.split,
            shells_.node_tool(), shells_.node_shell(), nodes_.surface, edges_.force(),
            shells_.tools(), reach_, static_cast<float>(cell_), renew, contacts_, counts_)
      .enqueue_groups(blocks);
  solve_kernel_
      .args(shells_.tools(), static_cast<int>(tools_.size()), contacts_, counts_, nodes_.count,
            reach_, first_)
      .enqueue_groups(1);
  apply_kernel_
      .args(nodes_.list, nodes_.before0, nodes_.before1, nodes_.split, shells_.node_tool(),
            shells_.node_shell(), shells_.tools(), contacts_, first_, transfer.floors(), reach_,
            renew, records_, transfer.velocity(), nodes_.velocity1)
      .enqueue_groups(blocks);
}

namespace {

/// Sums of one tool over its nodes.
struct Momentum {
  Vec3 before = Vec3::Zero(), after = Vec3::Zero(), before_moment = Vec3::Zero(),
       after_moment = Vec3::Zero();
};

/// Adds one field of a node; r = lever arm from the tool's origin [m].
void add_record(const ContactRecord& record, const Vec3& r, ToolImpulse& out, Momentum& sum) {
  const Vec3 before(record.before[0], record.before[1], record.before[2]);
  const Vec3 after(record.after[0], record.after[1], record.after[2]);
  const auto mass = static_cast<double>(record.mass), push = static_cast<double>(record.push);
  // Soil gains J, so the tool gains -J.
  const Vec3 J = mass * (after - before), L = r.cross(J);
  out.J_W -= J;
  out.L_W -= L;
  if (CONTACT_EDGE(record.place) != 0) {
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

// Mapped without waiting: the read of the report waits for both.
void Contact::queue_read() {
  if (nodes_.count == 0 || motions_.empty()) return;
  const auto blocks = static_cast<std::size_t>(nodes_.count);
  // Contacts are listed at the start of a transfer; its later steps have as many.
  const std::size_t more = nodes_.renew ? expected_ / 8 + kMoreRecords : 0;
  results_.emplace(
      Results{first_.map_read_later(0, blocks + 1),
              records_.map_read_later(0, std::min(expected_ + more, blocks * BLOCK_CONTACTS))});
}

void Contact::sum_impulses(std::span<ToolImpulse> impulses) {
  if (!results_) return;
  // The maps end with this function: the next step may write the buffers.
  const Results read = std::move(*results_);
  results_.reset();
  const auto count = static_cast<std::size_t>(read.first[read.first.size() - 1]);
  expected_ = count;
  if (count == 0) return;
  if (count <= read.records.size())
    add_records(read.first.span(), read.records.span(), impulses);
  else
    add_records(read.first.span(), records_.map_read(0, count).span(), impulses);
}

void Contact::add_records(std::span<const std::int32_t> first,
                          std::span<const ContactRecord> records,
                          std::span<ToolImpulse> impulses) const {
  // A tool without a motion in this step touches nothing.
  std::vector<int> motion_of(tools_.size(), -1);
  for (std::size_t m = 0; m < motions_.size(); ++m)
    motion_of[static_cast<std::size_t>(motions_[m].tool)] = static_cast<int>(m);
  std::vector<Momentum> momentum(motions_.size());
  for (std::size_t near = 0; near + 1 < first.size(); ++near) {
    const BlockKey& key = near_keys_[near];
    for (std::int32_t i = first[near]; i < first[near + 1]; ++i) {
      const ContactRecord& record = records[static_cast<std::size_t>(i)];
      // A node with equal velocities before and after was touched by no tool.
      if (std::equal(std::begin(record.before), std::end(record.before), std::begin(record.after)))
        continue;
      const auto m =
          static_cast<std::size_t>(motion_of[static_cast<std::size_t>(CONTACT_TOOL(record.place))]);
      // Position of the node in doubles: lever arms are as exact as the impulses.
      const int n = CONTACT_NODE(record.place);
      const Vec3 grid(kBlockCells * key.x + (n & 3), kBlockCells * key.y + ((n >> 2) & 3),
                      kBlockCells * key.z + (n >> 4));
      add_record(record, grid * cell_ + origin_ - impulses[m].p_W, impulses[m], momentum[m]);
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
