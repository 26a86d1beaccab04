// SPDX-License-Identifier: Apache-2.0
// Which blocks lie near which triangles, and the triangles in the kernels' frame.
#include <algorithm>
#include <bit>
#include <cmath>

#include "soil/layout.h"
#include "soil/tools/contact.h"

namespace navvy::soil {
namespace {

/// Cells a particle may have drifted from its home's base range [0.5, 4.5) before a re-bin.
constexpr double kDrift = 1.0;

void put(std::vector<float>& out, const Vec3& v, float w) {
  for (int a = 0; a < 3; ++a) out.push_back(static_cast<float>(v[a]));
  out.push_back(w);
}

/// Coordinates go to the device in steps of 2^-18 cell (0.4 micrometres at 0.1 m): finer than a float at the far end of
/// a tool, coarser than what a double loses a kilometre from the origin, so that the same dig elsewhere is the same
/// dig.
constexpr double kSteps = 1 << 18;
Vec3 snapped(const Vec3& cells) { return (cells * kSteps).array().round().matrix() / kSteps; }

/// Block that holds the coordinate, which is snapped first: round figures lie on the edges of blocks.
int floor_div(double cells) { return static_cast<int>(std::floor(std::round(cells * kSteps) / kSteps / kBlockCells)); }

/// Marks the triangle at every block of `index` whose box [low, high] (cells from its corner) meets the given box.
void offer(const Vec3& box_low, const Vec3& box_high, double low, double high, int triangle, const BlockIndex& index,
           Marks& marks) {
  const BlockKey from = {floor_div(box_low.x() - high) + 1, floor_div(box_low.y() - high) + 1,
                         floor_div(box_low.z() - high) + 1};
  const BlockKey to = {floor_div(box_high.x() - low), floor_div(box_high.y() - low), floor_div(box_high.z() - low)};
  for (int z = from.z; z <= to.z; ++z)
    for (int y = from.y; y <= to.y; ++y)
      for (int x = from.x; x <= to.x; ++x) {
        const int block = index.find({x, y, z});
        if (block >= 0) marks.set(static_cast<std::size_t>(block), static_cast<std::size_t>(triangle));
      }
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
  if (nodes_.count > 0) upload_frame();
  return again;
}

void Contact::find_candidates(const BlockTable& table, Marks& nodes, Marks& homes) const {
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
}

void Contact::list_near(const BlockTable& table) {
  std::size_t triangles = 0;  // of all tools, which count on from one another
  for (const Tool& tool : tools_) triangles += tool.geometry->triangles().size();
  Marks node_marks(table.active.size(), triangles), home_marks(table.homes.size(), triangles);
  find_candidates(table, node_marks, home_marks);
  near_slot_.assign(table.active.size(), -1);
  near_homes_.assign(table.homes.size(), 0);
  near_home_list_.clear();
  near_keys_.clear();
  // Compressed rows of candidate triangles per near block, in ascending order of blocks.
  std::vector<std::int32_t> near_list, node_first, node_list, home_first, home_list;
  for (std::size_t b = 0; b < table.active.size(); ++b) {
    if (!node_marks.any(b)) continue;
    near_slot_[b] = static_cast<int>(near_list.size());
    near_list.push_back(static_cast<int>(b));
    near_keys_.push_back(table.active[b]);
    node_first.push_back(static_cast<std::int32_t>(node_list.size()));
    node_marks.each(b, [&](std::size_t triangle) { node_list.push_back(static_cast<std::int32_t>(triangle)); });
  }
  node_first.push_back(static_cast<std::int32_t>(node_list.size()));
  nodes_.count = static_cast<int>(near_list.size());
  if (nodes_.count == 0) return;
  for (std::size_t h = 0; h < table.homes.size(); ++h) {
    bool near = home_marks.any(h);
    for (std::size_t n = 0; n < 27 && !near; ++n)
      near = near_slot_[static_cast<std::size_t>(table.neighbours[27 * h + n])] >= 0;
    if (!near) continue;
    near_homes_[h] = 1;
    near_home_list_.push_back(static_cast<int>(h));
    home_first.push_back(static_cast<std::int32_t>(home_list.size()));
    home_marks.each(h, [&](std::size_t triangle) { home_list.push_back(static_cast<std::int32_t>(triangle)); });
  }
  home_first.push_back(static_cast<std::int32_t>(home_list.size()));

  upload(device_, nodes_.list, near_list);
  upload(device_, nodes_.slot, near_slot_);
  upload(device_, node_first_, node_first);
  upload(device_, node_candidates_, node_list);
  upload(device_, home_list_, near_home_list_);
  upload(device_, home_first_, home_first);
  upload(device_, home_candidates_, home_list);
  const std::size_t nodes = near_list.size() * BLOCK_NODES;
  ensure(device_, nodes_.split, nodes);
  ensure(device_, nodes_.before0, 4 * nodes);
  ensure(device_, nodes_.before1, 4 * nodes);
  ensure(device_, nodes_.velocity1, 4 * nodes);
  ensure(device_, nodes_.surface, 4 * nodes);
  ensure(device_, node_tool_, nodes);
  ensure(device_, shell_, 8 * nodes);
  ensure(device_, books_, 16 * nodes);
  ensure(device_, sums_, near_list.size() * CONTACT_SUMS);
  ensure(device_, touched_, near_list.size());
}

void Contact::append_tool(std::size_t index, std::vector<float>& words) const {
  const std::size_t at = words.size();
  words.resize(at + TOOL_WORDS, 0.0f);
  const Tool& tool = tools_[index];
  const Vec3 corner(kBlockCells * tool.window.x, kBlockCells * tool.window.y, kBlockCells * tool.window.z);
  const Vec3 origin = snapped(to_grid(tool.X.translation()) - corner);
  const std::int32_t window[3] = {tool.window.x, tool.window.y, tool.window.z};
  words[at + TOOL_HALF] = static_cast<float>(tool.geometry->shell().half_thickness / cell_);
  words[at + TOOL_FRICTION] = static_cast<float>(tool.geometry->shell().friction_share);
  words[at + TOOL_ADHESION] = static_cast<float>(tool.geometry->shell().adhesion_share * tool.area_factor);
  words[at + TOOL_ACTIVE] = tool.present ? 1.0f : 0.0f;
  for (std::size_t a = 0; a < 3; ++a) {
    words[at + TOOL_WINDOW + a] = std::bit_cast<float>(window[a]);
    words[at + TOOL_ORIGIN + a] = static_cast<float>(origin[static_cast<int>(a)]);
  }
  for (const ToolMotion& motion : motions_) {
    if (motion.tool != static_cast<int>(index)) continue;
    for (std::size_t a = 0; a < 3; ++a) {
      const auto i = static_cast<int>(a);
      words[at + TOOL_SPIN + a] = words[at + TOOL_START + a] = static_cast<float>(motion.w_WT[i]);
      words[at + TOOL_SPEED + a] = words[at + TOOL_START + 3 + a] = static_cast<float>(motion.v_WT[i]);
    }
    for (int r = 0; r < 6; ++r)
      for (int c = 0; c < 6; ++c)
        words[at + TOOL_YIELD + static_cast<std::size_t>(6 * r + c)] = static_cast<float>(motion.inverse_mass(r, c));
  }
}

void Contact::upload_frame() {
  std::vector<float>& words = frame_words_;
  std::vector<float> rims, tools;
  words.clear();
  for (std::size_t t = 0; t < tools_.size(); ++t) {
    const Tool& tool = tools_[t];
    const Vec3 corner(kBlockCells * tool.window.x, kBlockCells * tool.window.y, kBlockCells * tool.window.z);
    const auto place = [&](const Vec3& p_T) { return snapped(to_grid(tool.X * p_T) - corner); };
    const auto index = std::bit_cast<float>(static_cast<std::int32_t>(t));
    const Mat3 R = tool.X.linear();
    for (const ShellGeometry::Triangle& tri : tool.geometry->triangles()) {
      put(words, place(tri.corner[0]), index);
      put(words, place(tri.corner[1]), static_cast<float>(tri.radius / cell_));
      put(words, place(tri.corner[2]), 0.0f);
      put(words, R * tri.normal, 0.0f);
      for (std::size_t i = 0; i < 3; ++i) put(words, R * tri.edge_normal[i], tri.edge_free[i] ? 1.0f : 0.0f);
      for (std::size_t i = 0; i < 3; ++i) put(words, R * tri.corner_normal[i], tri.corner_free[i] ? 1.0f : 0.0f);
    }
    for (const auto& rim : tool.geometry->rims()) {
      put(rims, place(rim[0]), index);
      put(rims, R * (rim[1] - rim[0]) / cell_, 0.0f);
    }
    append_tool(t, tools);
  }
  first_rim_ = static_cast<int>(words.size() / 4);
  words.insert(words.end(), rims.begin(), rims.end());
  first_tool_ = static_cast<int>(words.size() / 4);
  words.insert(words.end(), tools.begin(), tools.end());
  ensure(device_, frame_, words.size());
  frame_.write_later(words);
}

void Contact::classify(ParticleStore& store, Transfer& transfer) {
  if (nodes_.count == 0) return;
  const auto band = static_cast<float>(settings_.band);
  nodes_kernel_
      .args(nodes_.list, transfer.active_keys(), frame_, first_rim_, first_tool_, node_first_, node_candidates_, band,
            nodes_.split, node_tool_, shell_)
      .enqueue_groups(static_cast<std::size_t>(nodes_.count));
  particles_kernel_
      .args(store.state(), store.capacity(), home_list_, store.homes_buffer(), store.home_keys(), frame_, first_tool_,
            home_first_, home_candidates_, band, static_cast<float>(settings_.longest_push), transfer.report())
      .enqueue_groups(near_home_list_.size());
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
