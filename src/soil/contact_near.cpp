// SPDX-License-Identifier: Apache-2.0
// Which blocks lie near which triangles, and the triangles in the kernels' frame.
#include <algorithm>
#include <bit>
#include <cmath>

#include "soil/contact.h"
#include "soil/layout.h"

namespace navvy::soil {
namespace {

/// Cells a particle may have drifted from its home's base range [0.5, 4.5) before a re-bin.
constexpr double kDrift = 1.0;

void put(std::vector<float>& out, const Vec3& v, float w) {
  for (int a = 0; a < 3; ++a) out.push_back(static_cast<float>(v[a]));
  out.push_back(w);
}

int floor_div(double cells) { return static_cast<int>(std::floor(cells / kBlockCells)); }

/// Adds `triangle` to the list of every block of `index` whose box [low, high] (cells from its corner) meets the box.
void offer(const Vec3& box_low, const Vec3& box_high, double low, double high, int triangle, const BlockIndex& index,
           std::vector<std::vector<int>>& lists) {
  BlockKey from, to;
  from = {floor_div(box_low.x() - high) + 1, floor_div(box_low.y() - high) + 1, floor_div(box_low.z() - high) + 1};
  to = {floor_div(box_high.x() - low), floor_div(box_high.y() - low), floor_div(box_high.z() - low)};
  for (int z = from.z; z <= to.z; ++z)
    for (int y = from.y; y <= to.y; ++y)
      for (int x = from.x; x <= to.x; ++x) {
        const int block = index.find({x, y, z});
        if (block < 0) continue;
        std::vector<int>& list = lists[static_cast<std::size_t>(block)];
        if (list.empty() || list.back() != triangle) list.push_back(triangle);
      }
}

void sort_unique(std::vector<int>& list) {
  std::sort(list.begin(), list.end());
  list.erase(std::unique(list.begin(), list.end()), list.end());
}

}  // namespace

bool Contact::moved_far() const {
  for (const Tool& tool : tools_) {
    if (tool.present != tool.listed) return true;
    if (!tool.present) continue;
    for (const Vec3& v : tool.geometry->shell().vertices)
      if ((tool.X * v - tool.X_listed * v).norm() > settings_.margin * cell_) return true;
  }
  return false;
}

bool Contact::set_motions(std::span<const ToolMotion> motions, const BlockTable& table, bool blocks_changed) {
  motions_.assign(motions.begin(), motions.end());
  for (Tool& tool : tools_) tool.present = false;
  for (const ToolMotion& motion : motions) {
    Tool& tool = tools_.at(static_cast<std::size_t>(motion.tool));
    tool.present = true;
    tool.X = motion.X_WT;
    const Vec3 p = to_grid(motion.X_WT.translation());
    tool.window = {floor_div(p.x()), floor_div(p.y()), floor_div(p.z())};
  }
  const bool again = blocks_changed || moved_far();
  if (again) {
    for (Tool& tool : tools_) {
      tool.listed = tool.present;
      tool.X_listed = tool.X;
    }
    list_near(table);
  }
  if (nodes_.count > 0) upload_triangles();
  return again;
}

void Contact::find_candidates(const BlockTable& table, std::vector<std::vector<int>>& nodes,
                              std::vector<std::vector<int>>& homes) const {
  const double far = settings_.band + settings_.margin;
  for (const Tool& tool : tools_) {
    if (!tool.listed) continue;
    for (const ShellGeometry::Piece& piece : tool.geometry->pieces()) {
      Vec3 low = to_grid(tool.X_listed * piece.corner[0]), high = low;
      for (std::size_t i = 1; i < 3; ++i) {
        const Vec3 p = to_grid(tool.X_listed * piece.corner[i]);
        low = low.cwiseMin(p);
        high = high.cwiseMax(p);
      }
      low.array() -= far;
      high.array() += far;
      const int triangle = tool.first_triangle + piece.triangle;
      offer(low, high, 0.0, 3.0, triangle, table.active_index, nodes);
      offer(low, high, 0.5 - kDrift, 4.5 + kDrift, triangle, table.home_index, homes);
    }
  }
  for (auto& list : nodes) sort_unique(list);
  for (auto& list : homes) sort_unique(list);
}

void Contact::list_near(const BlockTable& table) {
  std::vector<std::vector<int>> node_lists(table.active.size()), home_lists(table.homes.size());
  find_candidates(table, node_lists, home_lists);
  near_slot_.assign(table.active.size(), -1);
  near_homes_.assign(table.homes.size(), 0);
  near_home_list_.clear();
  near_keys_.clear();
  Rows node_rows, home_rows;
  std::vector<std::int32_t> near_list;
  for (std::size_t b = 0; b < table.active.size(); ++b) {
    if (node_lists[b].empty()) continue;
    near_slot_[b] = static_cast<int>(near_list.size());
    near_list.push_back(static_cast<std::int32_t>(b));
    near_keys_.push_back(table.active[b]);
    node_rows.first.push_back(static_cast<int>(node_rows.list.size()));
    node_rows.list.insert(node_rows.list.end(), node_lists[b].begin(), node_lists[b].end());
  }
  node_rows.first.push_back(static_cast<int>(node_rows.list.size()));
  nodes_.count = static_cast<int>(near_list.size());
  for (std::size_t h = 0; h < table.homes.size(); ++h) {
    bool near = !home_lists[h].empty();
    for (std::size_t n = 0; n < 27 && !near; ++n)
      near = near_slot_[static_cast<std::size_t>(table.neighbours[27 * h + n])] >= 0;
    if (!near) continue;
    near_homes_[h] = 1;
    near_home_list_.push_back(static_cast<int>(h));
    home_rows.first.push_back(static_cast<int>(home_rows.list.size()));
    home_rows.list.insert(home_rows.list.end(), home_lists[h].begin(), home_lists[h].end());
  }
  home_rows.first.push_back(static_cast<int>(home_rows.list.size()));
  if (nodes_.count == 0) return;

  upload(device_, nodes_.list, near_list);
  upload(device_, nodes_.slot, near_slot_);
  upload(device_, node_first_, node_rows.first);
  upload(device_, node_candidates_, node_rows.list);
  upload(device_, home_list_, near_home_list_);
  upload(device_, home_first_, home_rows.first);
  upload(device_, home_candidates_, home_rows.list);
  const std::size_t nodes = near_list.size() * BLOCK_NODES;
  ensure(device_, nodes_.split, nodes);
  ensure(device_, nodes_.before0, 4 * nodes);
  ensure(device_, nodes_.before1, 4 * nodes);
  ensure(device_, nodes_.velocity1, 4 * nodes);
  ensure(device_, nodes_.friction, nodes);
  ensure(device_, node_tool_, nodes);
  ensure(device_, shell_, 8 * nodes);
  ensure(device_, after0_, 4 * nodes);
  ensure(device_, after1_, 4 * nodes);
  ensure(device_, sums_, near_list.size() * CONTACT_SUMS);
  ensure(device_, moved_, near_home_list_.size());
  ensure(device_, crossed_, near_home_list_.size());
}

void Contact::upload_triangles() {
  std::vector<float> words, rims, halves;
  std::vector<std::array<std::int32_t, 4>> windows;
  for (std::size_t t = 0; t < tools_.size(); ++t) {
    const Tool& tool = tools_[t];
    const Vec3 corner(kBlockCells * tool.window.x, kBlockCells * tool.window.y, kBlockCells * tool.window.z);
    const auto place = [&](const Vec3& p_T) { return Vec3(to_grid(tool.X * p_T) - corner); };
    const auto index = std::bit_cast<float>(static_cast<std::int32_t>(t));
    const Mat3 R = tool.X.linear();
    for (const ShellGeometry::Triangle& tri : tool.geometry->triangles()) {
      for (const Vec3& p : tri.corner) put(words, place(p), index);
      put(words, R * tri.normal, 0.0f);
      for (std::size_t i = 0; i < 3; ++i) put(words, R * tri.edge_normal[i], tri.edge_free[i] ? 1.0f : 0.0f);
      for (std::size_t i = 0; i < 3; ++i) put(words, R * tri.corner_normal[i], tri.corner_free[i] ? 1.0f : 0.0f);
    }
    for (const auto& rim : tool.geometry->rims()) {
      put(rims, place(rim[0]), index);
      put(rims, R * (rim[1] - rim[0]) / cell_, 0.0f);
    }
    halves.push_back(static_cast<float>(tool.geometry->shell().half_thickness / cell_));
    windows.push_back({tool.window.x, tool.window.y, tool.window.z, 0});
  }
  rim_count_ = static_cast<int>(rims.size() / 8);
  upload(device_, triangles_, words);
  upload(device_, rims_, rims);
  upload(device_, half_thickness_, halves);
  upload(device_, windows_, windows);
}

double Contact::classify(ParticleStore& store, Transfer& transfer, std::uint64_t& crossings) {
  if (nodes_.count == 0) return 0;
  const auto band = static_cast<float>(settings_.band);
  nodes_kernel_
      .args(nodes_.list, transfer.active_keys(), triangles_, windows_, node_first_, node_candidates_, rims_, rim_count_,
            band, nodes_.split, node_tool_, shell_)
      .enqueue(static_cast<std::size_t>(nodes_.count), 1);
  const std::size_t homes = near_home_list_.size();
  particles_kernel_
      .args(store.state(), store.capacity(), home_list_, store.homes_buffer(), store.home_keys(), triangles_, windows_,
            half_thickness_, home_first_, home_candidates_, band, static_cast<float>(settings_.longest_push), moved_,
            crossed_)
      .enqueue(homes, 1);
  double farthest = 0;
  const auto moved = moved_.map_read(0, homes);
  const auto crossed = crossed_.map_read(0, homes);
  for (std::size_t h = 0; h < homes; ++h) {
    farthest = std::max(farthest, static_cast<double>(moved[h]));
    crossings += static_cast<std::uint64_t>(crossed[h]);
  }
  return farthest;
}

void Contact::save(StateWriter& writer) const {
  writer.value(static_cast<std::uint32_t>(tools_.size()));
  for (const Tool& tool : tools_) {
    writer.value(static_cast<std::uint8_t>(tool.listed));
    writer.pose(tool.X_listed);
  }
}

void Contact::load(StateReader& reader) {
  if (reader.value<std::uint32_t>() != tools_.size()) {
    Fault fault;
    fault.element = "snapshot/soil/tools";
    fault.value = "another number of tools";
    fault.rule = "the same tools must be registered before a snapshot is loaded";
    throw InputError(fault);
  }
  for (Tool& tool : tools_) {
    tool.listed = reader.value<std::uint8_t>() != 0;
    tool.X_listed = reader.pose();
  }
}

}  // namespace navvy::soil
