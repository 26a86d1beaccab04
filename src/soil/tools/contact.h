// SPDX-License-Identifier: Apache-2.0
// Tools in the soil: near lists, sides of particles, and the nodal contact solved together with the
// tool.
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
#include "soil/tools/marks.h"
#include "soil/tools/shell.h"
#include "soil/tools/shell_geometry.h"
#include "soil/tools/tool_motion.h"

namespace navvy {
class Archive;
}

namespace navvy::soil {

/// Returns the area of a shell / the area that nodes along it stand for (contact_inner of
/// kernels/soil/contact_law.h): above 1 for plates with corners, at most 2.
double plate_area_factor(const ShellGeometry& geometry, double cell,
                         const SchemeConstants& scheme = kScheme);

/// Contact of all tools with the soil: two nodal fields beside a plate, each of which keeps up with
/// its share of the plate's speed [docs/tools.md, contact shares]. Any number of tools.
///
/// Calls of a step come in this order: set_motions in the first step of a transfer or set_twists in
/// a held one; classify in the first step; solve between scatter and gather; queue_read; and, after
/// the report has been read, sum_impulses and add_impulses. end_transfer follows the last step of a
/// transfer.
///
/// Near lists name the triangles that may touch each block. They reach farther than the contact, so
/// that a tool may move by contact_margin before they are built again. Cost per step is linear in
/// the nodes and particles of near blocks.
class Contact {
 public:
  /// Builds the kernels. `gravity` [m/s2] decides which plates lie on soil.
  Contact(device::Device& device, double cell, const Vec3& origin_W, const Vec3& gravity,
          const SchemeConstants& scheme = kScheme);

  /// Registers a shell and returns its tool index.
  int add_tool(const scene::Shell& shell);
  /// Returns the geometry of a tool.
  const ShellGeometry& geometry(int tool) const {
    return *tools_[static_cast<std::size_t>(tool)].geometry;
  }

  /// Sets the tools' poses for the step and updates the near lists. Returns true when the lists
  /// changed: the caller then assigns tiles anew (near_particle_blocks, near_slot).
  bool set_motions(std::span<const ToolMotion> motions, const BlockTable& table,
                   bool blocks_changed);
  /// Sets the tools' twists and poses for a held step. Lists, sides of nodes and plates remain
  /// those of the transfer's start; lever arms are current.
  void set_twists(std::span<const ToolMotion> motions);
  /// Returns true if these are motions of the tools of the last `set_motions`.
  bool moves_same(std::span<const ToolMotion> motions) const;
  /// Queues what an open transfer knows of the shells, after `visit` has loaded and the lists are
  /// built.
  void resume(Transfer& transfer);
  /// Builds the near lists for the poses of their last build (after `visit` has loaded).
  void list_near(const BlockTable& table);
  /// Returns 1 for each particle block near a shell, else 0.
  const std::vector<std::uint8_t>& near_particle_blocks() const { return near_particle_blocks_; }
  /// Returns the index of each active block in the near arrays, or -1.
  const std::vector<int>& near_slot() const { return near_slot_; }
  /// Returns the arrays of near nodes.
  NearNodes& nodes() { return nodes_; }
  /// Returns the change of near nodes in the last step, two entries per node, valid in touched
  /// blocks.
  const device::Buffer<ContactRecord>& records() const { return records_; }
  const device::Buffer<std::int32_t>& touched() const { return touched_; }

  /// Queues signed distances of nodes, sides of particles, and pushes of particles out of plates
  /// (push and crossings go into the transfer's report).
  void classify(ParticleStore& store, Transfer& transfer);
  /// Queues the two-way solve and the impulses on the nodes. The recorded impulse of the tool is
  /// minus the change of the nodes, exact up to rounding; tests Momentum.* measure that the machine
  /// receives it.
  void solve(Transfer& transfer, double dt);
  /// Queues reading the results.
  void queue_read();
  /// Sums the impulses on the tools, after a wait that follows read_later; `impulses` parallel to
  /// the motions.
  void sum_impulses(std::span<ToolImpulse> impulses);

  /// Adds the impulses of a step of dt [s] to the current transfer and sets the mean force in
  /// `impulses`.
  void add_impulses(double dt, std::span<ToolImpulse> impulses);
  /// Return the mean force [N] and the moment about its origin [N m] that a tool last reported.
  const Vec3& force(int tool) const { return tools_[static_cast<std::size_t>(tool)].force_W; }
  const Vec3& moment(int tool) const { return tools_[static_cast<std::size_t>(tool)].moment_W; }
  /// Ends a transfer: its mean force becomes the reported one.
  void end_transfer();

  /// Visits the tools. Near lists depend on the poses when they were made, sides of nodes on those
  /// at the start of the transfer: both are state, and the rest follows (`list_near`, `resume`).
  /// @throws InputError for another number of tools than registered, or an impossible pose.
  void visit(Archive& a);

 private:
  /// Results of contact_apply and shell_nodes, mapped for the host.
  struct Results {
    device::Mapped<const std::int32_t> touched, tool_of;
    device::Mapped<const ContactRecord> records;
  };
  /// A tool: geometry, lists, poses and mean force.
  struct Registered {
    std::unique_ptr<ShellGeometry> geometry;
    int first_triangle = 0;
    /// Area of the plates / area that nodes stand for.
    double area_factor = 1;
    /// Has a motion in this transfer.
    bool present = false;
    /// The near lists contain it.
    bool listed = false;
    /// Pose when the lists were made.
    Pose X_listed = Pose::Identity();
    /// Pose at the start of the transfer.
    Pose X = Pose::Identity();
    /// Pose at the start of the step.
    Pose X_now = Pose::Identity();
    /// Block whose corner is the origin of its float coordinates.
    BlockKey window;
    // Sums over the current transfer, and means over the previous one; before there is one, over
    // the steps so far.
    Vec3 J_W = Vec3::Zero(), L_W = Vec3::Zero();
    /// Duration of the sums [s].
    double summed_time = 0;
    /// There is a previous transfer.
    bool has_mean = false;
    Vec3 force_W = Vec3::Zero(), moment_W = Vec3::Zero();
    void visit(Archive& a);
  };
  /// Returns a position in G [cells].
  Vec3 to_grid(const Vec3& p_W) const { return (p_W - origin_) / cell_; }
  /// Returns true if a tool has left the margin of its lists.
  bool moved_far() const;
  /// Sets the block whose corner is the origin of the tool's float coordinates.
  void set_window(Registered& tool) const;
  /// Marks the triangles near each active block and each particle block.
  void find_candidates(const BlockTable& table, Marks& nodes, Marks& particle_blocks) const;
  /// Uploads triangles, rims and tools of this step.
  void upload_tools();
  /// Returns a tool as the kernels take it, with its present twist.
  Tool tool_now(std::size_t index) const;
  /// Queues a contact kernel over the near blocks; `only`: tool whose nodes count, -1: all.
  template <class... Tail>
  void launch(device::Kernel& kernel, Transfer& transfer, int only, const Tail&... tail);

  device::Device& device_;
  double cell_;
  Vec3 origin_;
  /// Unit vector of gravity, or 0 without.
  Vec3 down_;
  SchemeConstants scheme_;
  std::vector<Registered> tools_;
  std::vector<ToolMotion> motions_;
  ShellQuery shells_;
  device::KernelProgram contact_program_;
  device::Kernel sums_kernel_, twist_kernel_, apply_kernel_;
  std::vector<std::uint8_t> near_particle_blocks_;
  std::vector<int> near_slot_;
  std::vector<BlockKey> near_keys_;
  NearNodes nodes_;
  ContactReach reach_{};
  // Results of the kernels of contact.cl.
  /// Two per near node, one per field (contact_apply).
  device::Buffer<ContactRecord> records_;
  /// One per near block (contact_sums).
  device::Buffer<ContactSums> sums_;
  /// One per near block: contact changed a node (contact_apply).
  device::Buffer<std::int32_t> touched_;
  std::optional<Results> results_;
};

}  // namespace navvy::soil
