// SPDX-License-Identifier: Apache-2.0
// Edges of tools on the device: the nodes ahead of the free edges of plates, and the strength of
// the soil around them.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "core/math.h"
#include "device/buffer.h"
#include "device/kernel_program.h"
#include "soil/particles/block_table.h"
#include "soil/particles/particle_store.h"
#include "soil/particles/transfer.h"
#include "soil/tool.h"
#include "soil/tools/shell_geometry.h"

namespace navvy::soil {

/// Returns the bearing factors of an edge whose faces enclose the angle `bevel` [rad] (pi: blunt)
/// in soil with the friction angle `phi` [rad] in plane strain [docs/tools.md, edges].
EdgeFactors edge_factors(double phi, double bevel);

/// Edges of the tools, as the contact needs them: a plate is thinner than a cell, so its end is not
/// a face to the nodes. Instead, nodes ahead of a free edge receive an impulse up to the soil's
/// bearing resistance on the plate's end [docs/tools.md, edges].
///
/// Edges are divided into points at most half a cell apart. Each point distributes its area among
/// the eight nodes around a place ahead of the edge. The distribution is geometric and computed on
/// the host once per transfer; the strength of the soil and its weight above each node follow on
/// the device in every step. Cost is linear in the length of the edges.
class Edges {
 public:
  /// Builds the kernel. `cell`: edge of a cell [m].
  Edges(device::Device& device, double cell, const SchemeConstants& scheme = kScheme);

  /// Adds a tool with this shell; tools are numbered from 0.
  void add_tool(const ShellGeometry& geometry);
  /// A tool of the current transfer: its index and its pose in the grid frame G.
  struct Placed {
    /// Index of the tool.
    int tool = -1;
    /// Origin of the tool's frame in G [cells].
    Vec3 origin = Vec3::Zero();
    /// Axes of the tool's frame in W.
    Mat3 R = Mat3::Identity();
  };
  /// Sets the lists of near blocks: `near_list` holds their active-block indices. `table` must
  /// outlive the lists.
  void set_near(const BlockTable& table, const std::vector<std::int32_t>& near_list);
  /// Distributes the edges of the tools among the nodes of the near blocks.
  void place(std::span<const Placed> tools);

  /// Returns true if a near node is ahead of an edge.
  bool any() const { return any_; }
  /// Queues the kernel that sums the strength of the soil around the edges.
  void enqueue(ParticleStore& store);

  /// Returns one entry per near node: the edge that it stands for.
  device::Buffer<NodeEdge>& nodes() { return nodes_; }
  /// Returns the distinct shapes of edges of all tools.
  device::Buffer<EdgeProfile>& profiles() { return profiles_; }
  /// Returns the compressed rows of active blocks above each near block: first entries, blocks.
  device::Buffer<std::int32_t>& above_first() { return above_first_; }
  /// Returns the blocks of above_first().
  device::Buffer<std::int32_t>& above() { return above_; }
  /// Returns 8 indices into strength() per near block: for its lower neighbours and itself, x
  /// fastest; -1 where no soil is near an edge.
  device::Buffer<std::int32_t>& around() { return around_; }
  /// Returns four floats per block with soil near edges: sums of mass, mass x cohesion [Pa] and
  /// mass x sin phi (kernel edge_strength).
  device::Buffer<float>& strength() { return strength_; }
  /// Returns four floats per near node: outward direction of the edge, and its largest force
  /// [Pa cell faces] (kernel edge_nodes).
  device::Buffer<float>& force() { return force_; }

 private:
  /// Point on an edge, in the frame of its tool.
  struct Point {
    /// Position [m].
    Vec3 p_T = Vec3::Zero();
    /// Outward direction in the plane of the plate.
    Vec3 outward_T = Vec3::Zero();
    /// Area of the plate's end that the point stands for [m2].
    double area = 0;
    /// Index of its profile.
    int profile = 0;
  };
  /// Returns the index of the profile of edges with this bevel [rad], which is added if it is new.
  int profile_of(double bevel);
  /// Distributes the area of a point of tool `tool` among the nodes around it. `p`: position of the
  /// point in G [cells]; `outward`: direction in W. Returns true if one of them is a near node.
  bool distribute(int tool, const Point& point, const Vec3& p, const Vec3& outward);
  /// Lists the particle blocks that have soil around the points `points` in G [cells].
  void list_blocks(const std::vector<Vec3>& points);
  /// Writes what `place` has computed to the device.
  void send();

  /// Device that runs the kernel.
  device::Device& device_;
  /// Edge of a cell [m].
  double cell_;
  /// Constants of the particle scheme.
  SchemeConstants scheme_;
  /// Compiled program and its kernel.
  device::KernelProgram program_;
  device::Kernel kernel_;
  /// Points on the edges of each tool.
  std::vector<std::vector<Point>> points_;
  /// Bevel of each profile [rad].
  std::vector<double> bevels_;
  /// Profiles on the host.
  std::vector<EdgeProfile> profile_rows_;
  /// Table of the blocks; null before the first list.
  const BlockTable* table_ = nullptr;
  /// Active-block index of each near block, and the index of each active block in the near arrays.
  std::vector<std::int32_t> near_list_, near_slot_;
  /// Edges of the near nodes; uploads do not wait, so the device may still be reading them.
  std::vector<NodeEdge> node_edges_;
  /// Lists on the host: listed blocks, compressed rows of points, indices around near blocks.
  std::vector<std::int32_t> block_list_, point_first_, around_list_;
  std::vector<std::array<float, 4>> point_list_;
  /// True if a near node is ahead of an edge; `clear_`: the device's nodes_ and force_ are zero.
  bool any_ = false, clear_ = false;
  /// Buffers on the device; see the functions with their names.
  device::Buffer<NodeEdge> nodes_;
  device::Buffer<EdgeProfile> profiles_;
  device::Buffer<std::int32_t> above_first_, above_, around_, blocks_, points_first_;
  device::Buffer<std::array<float, 4>> point_buffer_;
  device::Buffer<float> strength_, force_;
};

}  // namespace navvy::soil
