// SPDX-License-Identifier: Apache-2.0
// Near lists: blocks near each triangle, and the triangles in the frame of the kernels.
#include <algorithm>
#include <cmath>
#include <utility>

#include "core/archive.h"
#include "core/limits.h"
#include "soil/particles/buffers.h"
#include "soil/tools/contact.h"

namespace navvy::soil {
namespace {

/// Cells that a particle may have drifted from the range [0.5, 4.5) of its block before a re-bin.
constexpr double kDrift = 1.0;

/// Rounds a vector of doubles for the device.
void put(float (&out)[3], const Vec3& v) {
  for (int a = 0; a < 3; ++a) out[a] = static_cast<float>(v[a]);
}

/// Returns a face, edge or corner as the kernels use it: outward direction, and whether it is a
/// free edge.
ShellFeature feature(const Vec3& normal, bool free) {
  ShellFeature out{};
  put(out.normal, normal);
  out.free = free ? 1.0f : 0.0f;
  return out;
}

/// Coordinates go to the device in steps of 2^-18 cell (0.4 micrometres at 0.1 m). That is finer
/// than a float at the far end of a tool and coarser than the rounding of a double a kilometre from
/// the origin, so that the same dig elsewhere is the same dig.
constexpr double kSteps = 1 << 18;
Vec3 snapped(const Vec3& cells) { return (cells * kSteps).array().round().matrix() / kSteps; }

/// Returns the block that holds the coordinate. It is snapped first: round numbers lie on the edges
/// of blocks. All coordinates beyond any ground share a block.
int floor_div(double cells) {
  // Its cells are an int, too.
  constexpr double kFarthestBlock = 1e8;
  return static_cast<int>(std::clamp(std::floor(std::round(cells * kSteps) / kSteps / kBlockCells),
                                     -kFarthestBlock, kFarthestBlock));
}

/// Marks the triangle at every block of `index` whose box [low, high] (cells from its corner) meets
/// the given box.
void offer(const Vec3& box_low, const Vec3& box_high, double low, double high, int triangle,
           const BlockIndex& index, Marks& marks) {
  // A block is listed if its range [low, high) of cells can meet the box: the first such block is
  // the one after floor(box_low - high).
  const BlockKey from = {floor_div(box_low.x() - high) + 1, floor_div(box_low.y() - high) + 1,
                         floor_div(box_low.z() - high) + 1};
  const BlockKey to = {floor_div(box_high.x() - low), floor_div(box_high.y() - low),
                       floor_div(box_high.z() - low)};
  for (int z = from.z; z <= to.z; ++z)
    for (int y = from.y; y <= to.y; ++y)
      for (int x = from.x; x <= to.x; ++x) {
        const int block = index.find({x, y, z});
        if (block >= 0)
          marks.set(static_cast<std::size_t>(block), static_cast<std::size_t>(triangle));
      }
}

}  // namespace

// Lists reach farther than the contact by a margin, within which they remain valid.
bool Contact::moved_far() const {
  for (const Registered& tool : tools_) {
    if (tool.present != tool.listed) return true;
    if (!tool.present) continue;
    for (const Vec3& v : tool.geometry->shell().vertices)
      if ((tool.X * v - tool.X_listed * v).norm() > scheme_.contact_margin * cell_) return true;
  }
  return false;
}

void Contact::set_window(Registered& tool) const {
  const Vec3 p = to_grid(tool.X.translation());
  tool.window = {floor_div(p.x()), floor_div(p.y()), floor_div(p.z())};
}

bool Contact::moves_same(std::span<const ToolMotion> motions) const {
  const auto present = std::count_if(tools_.begin(), tools_.end(),
                                     [](const Registered& tool) { return tool.present; });
  return static_cast<std::size_t>(present) == motions.size() &&
         std::all_of(motions.begin(), motions.end(), [this](const ToolMotion& motion) {
           return tools_.at(static_cast<std::size_t>(motion.tool)).present;
         });
}

void Contact::set_twists(std::span<const ToolMotion> motions) {
  motions_.assign(motions.begin(), motions.end());
  for (const ToolMotion& motion : motions)
    tools_.at(static_cast<std::size_t>(motion.tool)).X_now = motion.X_WT;
  if (nodes_.count == 0) return;
  std::vector<Tool> now;
  for (std::size_t t = 0; t < tools_.size(); ++t) now.push_back(tool_now(t));
  shells_.set_twists(std::move(now));
}

void Contact::resume(Transfer& transfer) {
  for (Registered& tool : tools_) {
    tool.X_now = tool.X;
    set_window(tool);
  }
  if (nodes_.count == 0) return;
  upload_tools();
  place_edges();
  shells_.enqueue_nodes(transfer, nodes_, scheme_.contact_band);
  // The next step may replace the uploaded data.
  device_.finish();
}

bool Contact::set_motions(std::span<const ToolMotion> motions, const BlockTable& table,
                          bool blocks_changed) {
  motions_.assign(motions.begin(), motions.end());
  for (Registered& tool : tools_) tool.present = false;
  for (const ToolMotion& motion : motions) {
    Registered& tool = tools_.at(static_cast<std::size_t>(motion.tool));
    tool.present = true;
    tool.X = tool.X_now = motion.X_WT;
    set_window(tool);
  }
  // New blocks have no lists yet, and tools that moved far have left theirs.
  const bool again = blocks_changed || moved_far();
  if (again) {
    for (Registered& tool : tools_) {
      tool.listed = tool.present;
      tool.X_listed = tool.X;
    }
    list_near(table);
  }
  if (nodes_.count > 0) {
    upload_tools();
    place_edges();
  }
  return again;
}

void Contact::find_candidates(const BlockTable& table, Marks& nodes, Marks& particle_blocks) const {
  // Boxes of the pieces, extended by the band. Pieces are short, so boxes waste little.
  // The margin keeps the lists valid while tools move by less than it (moved_far).
  const double far = scheme_.contact_band + scheme_.contact_margin;
  for (const Registered& tool : tools_) {
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
      // Nodes of a block lie in 0..3, its particles in [0.5, 4.5) plus drift.
      offer(low, high, 0.0, 3.0, triangle, table.active_index, nodes);
      offer(low, high, 0.5 - kDrift, 4.5 + kDrift, triangle, table.particle_block_index,
            particle_blocks);
    }
  }
}

void Contact::list_near(const BlockTable& table) {
  // Over all tools.
  std::size_t triangles = 0;
  for (const Registered& tool : tools_) triangles += tool.geometry->triangles().size();
  // Bits, block by triangle: a triangle is listed once, however many of its pieces are near.
  Marks node_marks(table.active.size(), triangles),
      particle_block_marks(table.particle_blocks.size(), triangles);
  find_candidates(table, node_marks, particle_block_marks);
  near_slot_.assign(table.active.size(), -1);
  near_particle_blocks_.assign(table.particle_blocks.size(), 0);
  near_keys_.clear();
  // Candidate triangles per near block, in ascending order of blocks.
  std::vector<std::int32_t> near_list, near_particle_blocks;
  CandidateRows node_candidates, particle_candidates;
  for (std::size_t b = 0; b < table.active.size(); ++b) {
    if (!node_marks.any(b)) continue;
    near_slot_[b] = static_cast<int>(near_list.size());
    near_list.push_back(static_cast<int>(b));
    near_keys_.push_back(table.active[b]);
    node_candidates.first.push_back(static_cast<std::int32_t>(node_candidates.triangles.size()));
    node_marks.each(b, [&](std::size_t triangle) {
      node_candidates.triangles.push_back(static_cast<std::int32_t>(triangle));
    });
  }
  node_candidates.first.push_back(static_cast<std::int32_t>(node_candidates.triangles.size()));
  // Without near blocks no contact kernel runs, and no buffer is needed.
  nodes_.count = static_cast<int>(near_list.size());
  if (nodes_.count == 0) return;
  for (std::size_t h = 0; h < table.particle_blocks.size(); ++h) {
    // A block is also near when its tile reaches into a near block: split nodes need its three
    // tiles.
    bool near = particle_block_marks.any(h);
    for (std::size_t n = 0; n < 27 && !near; ++n)
      near = near_slot_[static_cast<std::size_t>(table.neighbours[27 * h + n])] >= 0;
    if (!near) continue;
    near_particle_blocks_[h] = 1;
    near_particle_blocks.push_back(static_cast<std::int32_t>(h));
    particle_candidates.first.push_back(
        static_cast<std::int32_t>(particle_candidates.triangles.size()));
    particle_block_marks.each(h, [&](std::size_t triangle) {
      particle_candidates.triangles.push_back(static_cast<std::int32_t>(triangle));
    });
  }
  particle_candidates.first.push_back(
      static_cast<std::int32_t>(particle_candidates.triangles.size()));

  // Buffers only grow, so a tool that moves does not allocate in every list.
  upload(device_, nodes_.list, near_list);
  upload(device_, nodes_.slot, near_slot_);
  shells_.set_near(node_candidates, particle_candidates, near_particle_blocks);
  edges_.set_near(table, near_list);
  const std::size_t nodes = near_list.size() * BLOCK_NODES;
  ensure(device_, nodes_.split, nodes);
  ensure(device_, nodes_.before0, 4 * nodes);
  ensure(device_, nodes_.before1, 4 * nodes);
  ensure(device_, nodes_.velocity1, 4 * nodes);
  ensure(device_, nodes_.surface, nodes);
  ensure(device_, contacts_, near_list.size() * BLOCK_CONTACTS);
  ensure(device_, records_, near_list.size() * BLOCK_CONTACTS);
  ensure(device_, counts_, near_list.size());
  ensure(device_, first_, near_list.size() + 1);
}

// Floats are relative to the window's corner, a block's, so that they are as exact far from the
// site's origin.
Tool Contact::tool_now(std::size_t index) const {
  const Registered& tool = tools_[index];
  const scene::Shell& shell = tool.geometry->shell();
  Tool out{};
  const Vec3 corner(kBlockCells * tool.window.x, kBlockCells * tool.window.y,
                    kBlockCells * tool.window.z);
  out.window[0] = tool.window.x;
  out.window[1] = tool.window.y;
  out.window[2] = tool.window.z;
  out.active = tool.present ? 1 : 0;
  put(out.origin, snapped(to_grid(tool.X_now.translation()) - corner));
  out.half_thickness = static_cast<float>(shell.half_thickness / cell_);
  out.friction = static_cast<float>(shell.friction_share);
  out.adhesion = static_cast<float>(shell.adhesion_share * tool.area_factor);
  // A registered tool without a motion in this step keeps a twist of zero and is not active.
  for (const ToolMotion& motion : motions_) {
    if (motion.tool != static_cast<int>(index)) continue;
    for (int a = 0; a < 3; ++a) {
      out.twist[a] = out.start[a] = static_cast<float>(motion.w_WT[a]);
      out.twist[3 + a] = out.start[3 + a] = static_cast<float>(motion.v_WT[a]);
    }
    for (int r = 0; r < 6; ++r)
      for (int c = 0; c < 6; ++c)
        out.inverse_mass[6 * r + c] = static_cast<float>(motion.inverse_mass(r, c));
  }
  return out;
}

// Directions turn with the tool; the kernels use the axes of W only.
void Contact::upload_tools() {
  ToolShells shells;
  // One array for all tools, in the order of their registration; triangle numbers refer to it.
  for (std::size_t t = 0; t < tools_.size(); ++t) {
    const Registered& tool = tools_[t];
    const Vec3 corner(kBlockCells * tool.window.x, kBlockCells * tool.window.y,
                      kBlockCells * tool.window.z);
    const auto place = [&](const Vec3& p_T) { return snapped(to_grid(tool.X * p_T) - corner); };
    const Mat3 R = tool.X.linear();
    for (const ShellGeometry::Triangle& tri : tool.geometry->triangles()) {
      ShellTriangle out{};
      put(out.a, place(tri.corner[0]));
      put(out.b, place(tri.corner[1]));
      put(out.c, place(tri.corner[2]));
      out.tool = static_cast<int>(t);
      out.radius = static_cast<float>(tri.radius / cell_);
      out.feature[0] = feature(R * tri.normal, false);
      for (std::size_t i = 0; i < 3; ++i) {
        out.feature[1 + i] = feature(R * tri.edge_normal[i], tri.edge_free[i]);
        out.feature[4 + i] = feature(R * tri.corner_normal[i], tri.corner_free[i]);
      }
      shells.triangles.push_back(out);
    }
    for (const auto& rim : tool.geometry->rims()) {
      ShellRim out{};
      put(out.start, place(rim[0]));
      out.tool = static_cast<int>(t);
      put(out.along, R * (rim[1] - rim[0]) / cell_);
      shells.rims.push_back(out);
    }
    shells.tools.push_back(tool_now(t));
  }
  shells_.set_tools(std::move(shells));
}

void Contact::place_edges() {
  std::vector<Edges::Placed> placed;
  for (std::size_t t = 0; t < tools_.size(); ++t)
    if (tools_[t].present)
      placed.push_back(
          {static_cast<int>(t), to_grid(tools_[t].X.translation()), tools_[t].X.linear()});
  edges_.place(placed);
}

void Contact::classify(ParticleStore& store, Transfer& transfer) {
  if (nodes_.count == 0) return;
  shells_.enqueue(store, transfer, nodes_, scheme_.contact_band, scheme_.contact_max_push);
}

// An invalid pose would make candidate boxes larger than any memory.
void Contact::Registered::visit(Archive& a) {
  a("listed", listed);
  a("X_listed", X_listed);
  a("present", present);
  a("X", X);
  a("J_W", J_W);
  a("L_W", L_W);
  a("J_edge_W", J_edge_W);
  a("felt_for", summed_time);
  a("has_mean", has_mean);
  a("force_W", force_W);
  a("moment_W", moment_W);
  a("edge_force_W", edge_force_W);
  a.require(std::isfinite(summed_time) && summed_time >= 0, "felt_for",
            "must be finite and not negative");
  a.require(std::max(X_listed.translation().norm(), X.translation().norm()) < limits::kFarthest,
            "X_listed", "must be a place on the site, as must X");
}

void Contact::visit(Archive& a) { a.fixed("tools", tools_); }

}  // namespace navvy::soil
