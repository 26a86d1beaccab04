// SPDX-License-Identifier: Apache-2.0
// Contact of tools with the soil: lists of blocks near tools, particle sides, and contact impulses
// at nodes, solved together with the motion of the tools.
#pragma once

#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "core/math.h"
#include "device/buffer.h"
#include "device/kernel_program.h"
#include "soil/particles/particle_store.h"
#include "soil/particles/transfer.h"
#include "soil/tools/edge.h"
#include "soil/tools/marks.h"
#include "soil/tools/shell.h"
#include "soil/tools/shell_geometry.h"
#include "soil/tools/tool_motion.h"

namespace navvy {
class Archive;
}

namespace navvy::soil {

/// Returns the area of a shell divided by the area that the nodes along it stand for (contact_inner
/// in kernels/soil/contact_law.h): above 1 for plates with corners, at most 2. `cell`: edge of a
/// cell [m].
double plate_area_factor(const ShellGeometry& geometry, double cell,
                         const SchemeConstants& scheme = kScheme);

/// Computes the contact of any number of tools with the soil. Nodes beside a plate have two
/// velocity fields, one for the soil in front of the plate and one for the soil behind it (back).
/// Each field must keep up with a share of the plate's speed [docs/tools.md, contact shares].
///
/// A transfer is a group of consecutive steps in which particles keep their positions. The calls of
/// a step come in this order: `set_motions` in the first step of a transfer, or `set_twists` in a
/// later one; `classify` in the first step only; `solve` between the scatter and the gather of
/// Transfer; `queue_read`; and, after Transfer::read_report, `sum_impulses` and `add_impulses`.
/// `end_transfer` follows the last step of a transfer.
///
/// A block is near if the shell of a tool may touch its nodes or particles. Near lists contain the
/// triangles that may touch each near block. They reach farther than the contact, so that a tool
/// may move by the scheme's contact_margin before they must be rebuilt. Cost per step is linear in
/// the number of nodes and particles in near blocks.
class Contact {
 public:
  /// Builds the kernels. `cell`: edge of a cell [m]; `origin_W`: origin of the grid frame G in W
  /// [m]; `gravity` in W [m/s2]: its direction decides which plates rest on soil below them.
  Contact(device::Device& device, double cell, const Vec3& origin_W, const Vec3& gravity,
          const SchemeConstants& scheme = kScheme);

  /// Registers a tool with this shell. Returns the tool's index: 0 for the first tool, then 1, 2,
  /// ...
  int add_tool(const scene::Shell& shell);
  /// Returns the geometry of the shell of tool `tool`.
  const ShellGeometry& geometry(int tool) const {
    return *tools_[static_cast<std::size_t>(tool)].geometry;
  }

  /// Sets the poses and twists of the tools at the start of a transfer. Rebuilds the near lists
  /// (triangles near each block) if `blocks_changed` is true or if a tool has moved too far.
  /// Returns true if the lists were rebuilt; the caller must then call ParticleStore::set_near and
  /// Transfer::set_blocks.
  bool set_motions(std::span<const ToolMotion> motions, const BlockTable& table,
                   bool blocks_changed);
  /// Sets the poses and twists of the tools in a later step of a transfer. Near lists, node sides
  /// and plate positions remain those of the transfer's start; only lever arms follow the current
  /// poses.
  void set_twists(std::span<const ToolMotion> motions);
  /// Returns true if `motions` belong to the same tools as in the last `set_motions`.
  bool moves_same(std::span<const ToolMotion> motions) const;
  /// Recomputes on the device the node sides and distances of a transfer in progress, after `visit`
  /// has loaded a state and `list_near` has built the lists.
  void resume(Transfer& transfer);
  /// Builds the near lists for the poses for which they were last built, as `visit` has loaded
  /// them.
  void list_near(const BlockTable& table);
  /// Returns one flag per particle block: 1 if the block is near a shell, else 0.
  const std::vector<std::uint8_t>& near_particle_blocks() const { return near_particle_blocks_; }
  /// Returns one entry per active block: its index in the near arrays, or -1 if the block is not
  /// near a shell.
  const std::vector<int>& near_slot() const { return near_slot_; }
  /// Returns the arrays of the near nodes.
  NearNodes& nodes() { return nodes_; }
  /// Returns the contacts of the last step and their changes of the nodes: those of near block b
  /// are records()[first()[b]] .. records()[first()[b + 1] - 1], in ascending order of nodes.
  const device::Buffer<ContactRecord>& records() const { return records_; }
  /// Returns the index of the first record of each near block, and the number of all records.
  const device::Buffer<std::int32_t>& first() const { return first_; }

  /// Queues the kernels that find signed distances of near nodes and sides of particles, and that
  /// push particles out of plates. Push distances and crossings are added to the transfer's report.
  void classify(ParticleStore& store, Transfer& transfer);
  /// Queues the kernels that find the resistance of the soil on the edges of plates, the solve for
  /// the motion of tools that are not scripted, and then the contact impulses on the nodes in a
  /// step of dt [s]. The impulse on a tool is minus the momentum change of its
  /// nodes, exact up to rounding; the tests Momentum.* check that the machine receives it.
  void solve(ParticleStore& store, Transfer& transfer, double dt);
  /// Queues the transfer of the contact records to the host; does not wait.
  void queue_read();
  /// Adds the contact records of the last step to the impulses on the tools. Before the call, the
  /// host must have waited for the device after `queue_read`. `impulses` is parallel to the
  /// motions.
  void sum_impulses(std::span<ToolImpulse> impulses);

  /// Adds the impulses of a step of dt [s] to the sums of the current transfer, and writes the
  /// reported mean force and moment of each tool to `impulses`.
  void add_impulses(double dt, std::span<ToolImpulse> impulses);
  /// Returns the mean force on tool `tool` that was last reported, in W [N].
  const Vec3& force(int tool) const { return tools_[static_cast<std::size_t>(tool)].force_W; }
  /// Returns the part of force(tool) that acts on the edges of plates, in W [N].
  const Vec3& edge_force(int tool) const {
    return tools_[static_cast<std::size_t>(tool)].edge_force_W;
  }
  /// Returns the mean moment on tool `tool` that was last reported, about the origin of the tool's
  /// frame, axes of W [N m].
  const Vec3& moment(int tool) const { return tools_[static_cast<std::size_t>(tool)].moment_W; }
  /// Ends a transfer: the mean force and moment on each tool over that transfer become the reported
  /// ones.
  void end_transfer();

  /// Visits the state of all tools. It includes the poses for which the near lists were built and
  /// the poses at the start of the transfer, because lists and node sides depend on them.
  /// `list_near` and `resume` recompute the rest after loading.
  /// @throws InputError for a different number of tools than registered, and for an impossible
  /// pose.
  void visit(Archive& a);

 private:
  /// Contact results of a step, mapped for the host.
  struct Results {
    /// Index of the first record of each near block, and the number of all records.
    device::Mapped<const std::int32_t> first;
    /// Records of the contacts, as many as were expected.
    device::Mapped<const ContactRecord> records;
  };
  /// State of one registered tool.
  struct Registered {
    /// Geometry of the tool's shell.
    std::unique_ptr<ShellGeometry> geometry;
    /// Index of the tool's first triangle in the list of the triangles of all tools.
    int first_triangle = 0;
    /// Area of the plates divided by the area that nodes stand for (plate_area_factor).
    double area_factor = 1;
    /// True if the tool takes part in the current transfer.
    bool present = false;
    /// True if the near lists include the tool.
    bool listed = false;
    /// Pose of the tool in W when the near lists were built.
    Pose X_listed = Pose::Identity();
    /// Pose of the tool in W at the start of the transfer.
    Pose X = Pose::Identity();
    /// Pose of the tool in W at the start of the step.
    Pose X_now = Pose::Identity();
    /// Block whose lower corner is the origin of the tool's coordinates on the device.
    BlockKey window;
    /// Sums over the current transfer: impulse J_W [N s] and angular impulse L_W about the tool's
    /// origin [N m s].
    Vec3 J_W = Vec3::Zero(), L_W = Vec3::Zero();
    /// Part of J_W that acted on edges [N s].
    Vec3 J_edge_W = Vec3::Zero();
    /// Time over which they were summed [s].
    double summed_time = 0;
    /// True if force_W and moment_W are means over a complete previous transfer.
    bool has_mean = false;
    /// Reported mean force [N] and moment [N m]: means over the previous transfer or, before there
    /// is one, over the steps so far.
    Vec3 force_W = Vec3::Zero(), moment_W = Vec3::Zero();
    /// Part of force_W that acts on edges [N].
    Vec3 edge_force_W = Vec3::Zero();
    /// Visits poses, sums and means of the tool.
    void visit(Archive& a);
  };
  /// Returns a position in G [cells] from a position in W [m].
  Vec3 to_grid(const Vec3& p_W) const { return (p_W - origin_) / cell_; }
  /// Returns true if a tool has moved by more than the margin of the near lists, or if a tool was
  /// added to or removed from the step.
  bool moved_far() const;
  /// Sets the tool's window to the block that contains the origin of the tool's frame.
  void set_window(Registered& tool) const;
  /// Marks the triangles near each block: `nodes` has one row per active block, `particle_blocks`
  /// one row per particle block; columns are triangle indices.
  void find_candidates(const BlockTable& table, Marks& nodes, Marks& particle_blocks) const;
  /// Queues the kernels that find the resistance of edges at the near nodes.
  void find_edges(ParticleStore& store, Transfer& transfer);
  /// Distributes the edges of the tools among the near nodes.
  void place_edges();
  /// Uploads the triangles, free edges and tools of this step.
  void upload_tools();
  /// Returns tool `index` in the form that the kernels read, with the tool's current twist.
  Tool tool_now(std::size_t index) const;
  /// Adds the records of a step to the impulses on the tools. `first`, `records`: as the functions
  /// of these names.
  void add_records(std::span<const std::int32_t> first, std::span<const ContactRecord> records,
                   std::span<ToolImpulse> impulses) const;

  /// Device that runs the kernels.
  device::Device& device_;
  /// Edge of a cell [m].
  double cell_;
  /// Origin of the grid frame G in W [m].
  Vec3 origin_;
  /// Unit vector of gravity in W; zero without gravity.
  Vec3 down_;
  /// Constants of the particle scheme.
  SchemeConstants scheme_;
  /// Registered tools, by tool index.
  std::vector<Registered> tools_;
  /// Motions of the current step.
  std::vector<ToolMotion> motions_;
  /// Downward component of gravity [m/s2]; negative for an upward one.
  double weight_;
  /// Kernels that find node and particle sides.
  ShellQuery shells_;
  /// Edges of the tools and the soil around them.
  Edges edges_;
  /// Compiled program of the contact kernels.
  device::KernelProgram contact_program_;
  /// Contact kernels: edges_kernel_ finds the resistance of edges, nodes_kernel_ lists the
  /// contacts, solve_kernel_ finds the twists of the tools, apply_kernel_ applies the impulses.
  device::Kernel edges_kernel_, nodes_kernel_, solve_kernel_, apply_kernel_;
  /// One flag per particle block: 1 if near a shell.
  std::vector<std::uint8_t> near_particle_blocks_;
  /// One entry per active block: its index in the near arrays, or -1.
  std::vector<int> near_slot_;
  /// Key of each near block.
  std::vector<BlockKey> near_keys_;
  /// Arrays of the near nodes.
  NearNodes nodes_;
  /// Contact parameters of the current step.
  ContactReach reach_{};
  /// Contacts of the current step, BLOCK_CONTACTS entries per near block, of which the first
  /// `counts_` are used (kernel contact_nodes).
  device::Buffer<NodeContact> contacts_;
  /// Number of contacts of each near block (kernel contact_nodes).
  device::Buffer<std::int32_t> counts_;
  /// Index of the first record of each near block, and the number of all (kernel contact_solve).
  device::Buffer<std::int32_t> first_;
  /// Records of the contacts, block by block (kernel contact_apply).
  device::Buffer<ContactRecord> records_;
  /// Number of records of the last step.
  std::size_t expected_ = 0;
  /// Results between `queue_read` and `sum_impulses`; empty otherwise.
  std::optional<Results> results_;
};

}  // namespace navvy::soil
