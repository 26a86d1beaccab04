// SPDX-License-Identifier: Apache-2.0
#include "soil/tools/edge.h"

#include <algorithm>
#include <cmath>

#include "core/log.h"
#include "soil/particles/buffers.h"
#include "soil/particles/schedule.h"
#include "soil/scheme.h"

namespace navvy::soil {
namespace {

/// Longest distance between two points on an edge [cells].
constexpr double kSpacing = 0.5;
/// Nodes less than this far ahead of an edge get less than their share [cells]: a node's share does
/// not jump when the edge passes it.
constexpr double kFadeIn = 0.5;
/// Directions are rounded like places (contact_near.cpp), so that the same dig elsewhere is the
/// same dig.
constexpr double kSteps = 1 << 18;
Vec3 snapped(const Vec3& v) { return (v * kSteps).array().round().matrix() / kSteps; }

using Vec3i = Eigen::Vector3i;
/// Returns whole numbers as integers.
Vec3i whole(const Eigen::Array3d& v) { return v.matrix().cast<int>(); }

int floor_div(int cells) {
  // Division of integers rounds towards 0; blocks below 0 need the floor.
  return cells >= 0 ? cells / kBlockCells : -((-cells + kBlockCells - 1) / kBlockCells);
}

/// Returns Nq of a smooth wedge whose faces are inclined by `half` to its direction of motion
/// [Prandtl 1920] [docs/tools.md, edges]; half = pi / 2: a flat strip.
double wedge_nq(double phi, double half) {
  const double t = std::tan(kPi / 4 + phi / 2);
  return t * t * std::exp(2 * half * std::tan(phi));
}

/// Returns Nc of the same wedge: (Nq - 1) cot phi, and its limit for phi = 0.
double wedge_nc(double phi, double half) {
  return phi < 1e-6 ? 2 + 2 * half : (wedge_nq(phi, half) - 1) / std::tan(phi);
}

/// Returns true if the free edge from a to a + ab, with this outward direction, is part of the
/// cutting edge.
bool on_cutting_edge(const scene::ToothedEdge& edge, const Vec3& a, const Vec3& ab,
                     const Vec3& outward) {
  // Meshes place the tip with some centimetres of tolerance.
  const Vec3 off = a + 0.5 * ab - edge.p_tip;
  return outward.normalized().dot(edge.ahead) > 0.9 && std::abs(off.dot(edge.ahead)) < 0.1 &&
         off.norm() < 0.6 * edge.width + 0.1;
}

}  // namespace

EdgeFactors edge_factors(double phi, double bevel) {
  const double half = std::min(bevel, kPi) / 2;
  return {static_cast<float>(wedge_nc(phi, kPi / 2)), static_cast<float>(wedge_nq(phi, kPi / 2)),
          static_cast<float>(wedge_nc(phi, half)), static_cast<float>(wedge_nq(phi, half))};
}

Edges::Edges(device::Device& device, double cell, const SchemeConstants& scheme)
    : device_(device),
      cell_(cell),
      scheme_(scheme),
      program_(device, kernel_path(device, "edge"), scheme_options(scheme)),
      kernel_(program_, "edge_strength") {}

int Edges::profile_of(double bevel) {
  const auto known = std::find(bevels_.begin(), bevels_.end(), bevel);
  if (known != bevels_.end()) return static_cast<int>(known - bevels_.begin());
  EdgeProfile row{};
  for (int i = 0; i < EDGE_ANGLES; ++i)
    // Row i is for sin phi = i EDGE_STEP: the kernel has the sine of a particle's soil at hand.
    row.at[i] = edge_factors(std::asin(i * static_cast<double>(EDGE_STEP)), bevel);
  row.cot = bevel < kPi ? static_cast<float>(1 / std::tan(bevel / 2)) : 0.0f;
  bevels_.push_back(bevel);
  profile_rows_.push_back(row);
  return static_cast<int>(bevels_.size()) - 1;
}

void Edges::add_tool(const ShellGeometry& geometry) {
  const scene::Shell& shell = geometry.shell();
  std::vector<Point>& points = points_.emplace_back();
  const double thickness = shell.edge_thickness();
  if (!(thickness > 0)) return;
  const int plain = profile_of(shell.edge_bevel);
  bool resists = false;
  for (const ShellGeometry::Triangle& t : geometry.triangles())
    for (std::size_t i = 0; i < 3; ++i) {
      if (!t.edge_free[i]) continue;
      const Vec3 a = t.corner[i], ab = t.corner[(i + 1) % 3] - a, u = ab.normalized();
      // The part of `inward` along the edge is removed, so that `outward` is in the plane of the
      // triangle and at right angles to the edge.
      const Vec3 inward = t.corner[(i + 2) % 3] - a, outward = -(inward - inward.dot(u) * u);
      // Teeth stand for the cutting edge: less area, farther ahead, with their own bevel.
      const bool cuts = shell.toothed && on_cutting_edge(*shell.toothed, a, ab, outward);
      // The rims of a bucket's side plates are sharp [docs/tools.md, edges].
      if (shell.toothed && !cuts) continue;
      resists = true;
      const scene::Teeth tooth = cuts ? shell.toothed->teeth : scene::Teeth{};
      const double share = cuts ? tooth.number * tooth.width / shell.toothed->width : 1;
      const Vec3 ahead = (cuts ? tooth.length : 0) * outward.normalized();
      const int profile = cuts ? profile_of(tooth.bevel) : plain;
      // Several rows of points: soil yields beside a strip that is narrower than its nodes.
      const double spread = thickness + scheme_.edge_spread * cell_;
      const int along = std::max(1, static_cast<int>(std::ceil(ab.norm() / (kSpacing * cell_)))),
                across = std::max(1, static_cast<int>(std::ceil(spread / (kSpacing * cell_))));
      for (int k = 0; k < along; ++k)
        for (int row = 0; row < across; ++row)
          // The area of the plate's end is shared among the points: length / along times thickness
          // / across.
          points.push_back({a + ahead + (k + 0.5) / along * ab +
                                ((row + 0.5) / across - 0.5) * spread * t.normal,
                            outward.normalized(), share * ab.norm() / along * thickness / across,
                            profile});
    }
  if (shell.toothed && !resists)
    log_warning("shell '" + shell.name +
                "': none of its free edges lies within 0.1 m of the bucket's tip_m and along "
                "cut_direction, so that its cutting edge meets no resistance; correct tip_m or "
                "cut_direction, or set edge_share to 0");
}

void Edges::set_near(const BlockTable& table, const std::vector<std::int32_t>& near_list) {
  const std::size_t nodes = near_list.size() * BLOCK_NODES;
  if (profile_rows_.empty()) {
    // No tool has an edge with a thickness: the contact only needs zeros to read.
    if (force_.size() >= 4 * nodes) return;
    ensure(device_, force_, 4 * nodes);
    force_.write(std::vector<float>(force_.size(), 0.0f));
    return;
  }
  table_ = &table;
  near_list_ = near_list;
  near_slot_.assign(table.active.size(), -1);
  std::vector<std::int32_t> first, above;
  for (std::size_t near = 0; near < near_list.size(); ++near) {
    const auto block = static_cast<std::size_t>(near_list[near]);
    near_slot_[block] = static_cast<std::int32_t>(near);
    first.push_back(static_cast<std::int32_t>(above.size()));
    BlockKey key = table.active[block] + BlockKey{0, 0, 1};
    for (int up = table.active_index.find(key); up >= 0; up = table.active_index.find(key)) {
      above.push_back(up);
      ++key.z;
    }
  }
  first.push_back(static_cast<std::int32_t>(above.size()));
  upload(device_, above_first_, first);
  upload(device_, above_, above);
  ensure(device_, nodes_, nodes);
  ensure(device_, force_, 4 * nodes);
  clear_ = false;
}

bool Edges::distribute(int tool, const Point& point, const Vec3& p, const Vec3& outward) {
  const Vec3 middle = p + scheme_.edge_ahead * outward;
  const Vec3i base = whole(middle.array().floor());
  double weight[8], sum = 0;
  for (int n = 0; n < 8; ++n) {
    const Vec3 node = (base + Vec3i(n & 1, (n >> 1) & 1, n >> 2)).cast<double>();
    const double hat = (1 - (node - middle).array().abs()).prod();
    weight[n] = hat * std::clamp((node - p).dot(outward) / kFadeIn, 0.0, 1.0);
    sum += weight[n];
  }
  if (!(sum > 0)) return false;
  // The low 16 bits hold tool + 1, so that 0 is no tool; the high bits hold the profile.
  const int tag = 1 + tool + (point.profile << 16);
  bool any = false;
  for (int n = 0; n < 8; ++n) {
    if (!(weight[n] > 0)) continue;
    const Vec3i node = base + Vec3i(n & 1, (n >> 1) & 1, n >> 2);
    const BlockKey key{floor_div(node.x()), floor_div(node.y()), floor_div(node.z())};
    const int block = table_->active_index.find(key);
    const int near = block < 0 ? -1 : near_slot_[static_cast<std::size_t>(block)];
    if (near < 0) continue;
    const Vec3i in_block = node - kBlockCells * Vec3i(key.x, key.y, key.z);
    NodeEdge& edge = node_edges_[static_cast<std::size_t>(near * BLOCK_NODES + in_block.x() +
                                                          4 * in_block.y() + 16 * in_block.z())];
    // A node has one tool, the closest; where two touch, the first is as good.
    if (edge.tag != 0 && ((edge.tag ^ tag) & 0xffff) != 0) continue;
    if (edge.tag == 0) edge.tag = tag;
    // In units of a cell's face. The share of a node that is not listed or has another tool is
    // lost.
    const double area = point.area / (cell_ * cell_) * weight[n] / sum;
    for (int a = 0; a < 3; ++a) edge.outward[a] += static_cast<float>(area * outward[a]);
    any = true;
  }
  return any;
}

void Edges::list_blocks(const std::vector<Vec3>& points) {
  std::vector<std::int32_t> entry_of(table_->particle_blocks.size(), -1);
  std::vector<std::vector<std::array<float, 4>>> rows;
  block_list_.clear();
  // Particles of a block lie between 0.5 and 4.5 cells from its corner.
  const double reach = scheme_.edge_around;
  for (const Vec3& p : points) {
    const Vec3i low = whole(((p.array() - 4.5 - reach) / kBlockCells).ceil()),
                high = whole(((p.array() - 0.5 + reach) / kBlockCells).floor());
    for (int z = low.z(); z <= high.z(); ++z)
      for (int y = low.y(); y <= high.y(); ++y)
        for (int x = low.x(); x <= high.x(); ++x) {
          const int block = table_->particle_block_index.find({x, y, z});
          if (block < 0) continue;
          std::int32_t& entry = entry_of[static_cast<std::size_t>(block)];
          if (entry < 0) {
            entry = static_cast<std::int32_t>(block_list_.size());
            block_list_.push_back(block);
            rows.emplace_back();
          }
          const Vec3 at = p - kBlockCells * Vec3(x, y, z);
          rows[static_cast<std::size_t>(entry)].push_back({static_cast<float>(at.x()),
                                                           static_cast<float>(at.y()),
                                                           static_cast<float>(at.z()), 0.0f});
        }
  }
  point_first_.assign(1, 0);
  point_list_.clear();
  for (const auto& row : rows) {
    point_list_.insert(point_list_.end(), row.begin(), row.end());
    point_first_.push_back(static_cast<std::int32_t>(point_list_.size()));
  }
  around_list_.clear();
  for (const std::int32_t active : near_list_)
    for (int n = 0; n < 8; ++n) {
      const int block = table_->around[static_cast<std::size_t>(27 * active + (n & 1) +
                                                                3 * ((n >> 1) & 1) + 9 * (n >> 2))];
      around_list_.push_back(block < 0 ? -1 : entry_of[static_cast<std::size_t>(block)]);
    }
}

void Edges::place(std::span<const Placed> tools) {
  any_ = false;
  if (near_list_.empty()) return;
  node_edges_.assign(near_list_.size() * BLOCK_NODES, NodeEdge{});
  std::vector<Vec3> places;
  for (const Placed& tool : tools)
    for (const Point& point : points_[static_cast<std::size_t>(tool.tool)]) {
      const Vec3 p = snapped(tool.origin + tool.R * point.p_T / cell_);
      if (distribute(tool.tool, point, p, snapped(tool.R * point.outward_T))) places.push_back(p);
    }
  any_ = !places.empty();
  if (any_) list_blocks(places);
  send();
}

void Edges::send() {
  if (any_) {
    upload(device_, nodes_, node_edges_);
    upload(device_, around_, around_list_);
    upload(device_, profiles_, profile_rows_);
    upload(device_, blocks_, block_list_);
    upload(device_, points_first_, point_first_);
    upload(device_, point_buffer_, point_list_);
    ensure(device_, strength_, 4 * block_list_.size());
  } else if (!clear_) {
    // Zeros are written once and stay until an edge is near soil or the list of blocks changes.
    force_.write(std::vector<float>(4 * node_edges_.size(), 0.0f));
  }
  clear_ = !any_;
}

void Edges::enqueue(ParticleStore& store) {
  // Blocks without soil around an edge are not listed; there may be none.
  if (block_list_.empty()) return;
  kernel_
      .args(store.state(), store.capacity(), store.soils(), static_cast<int>(store.soils().size()),
            store.particle_blocks_buffer(), blocks_, points_first_, point_buffer_, strength_)
      .enqueue_groups(block_list_.size());
}

}  // namespace navvy::soil
