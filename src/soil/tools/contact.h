// SPDX-License-Identifier: Apache-2.0
// Tools in the soil: who is near, the side of particles, and the nodal contact solved together with
// the tool.
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

/// Lengths in cells [docs/tools.md, contact shares].
struct ContactSettings {
  double band = 2.5;          ///< how far from a shell particles keep a side
  double reach = 1.0;         ///< h: the share of nodes this far from the plate's face is a half,
  double ramp = 1.0;          ///< and falls from 1 to 0 over this length about it
  double edge = 0.6;          ///< the same along the plate, by the way to its free edge: squared,
  double edge_ramp = 1.0;     ///< from 1 inside to 0 over this length about `edge`
  double margin = 0.35;       ///< by how much near lists reach farther, so that they last a while
  double longest_push = 0.2;  ///< position correction per step
  int sweeps = 3;             ///< of the two-way solve
  /// Speed at which soil has let go, in units of sqrt(g cell); only matters to adhesion.
  double opening = 0.1;
  /// Speed at which soil comes nearer to a plate that does not advance, in the same units.
  double settling = 0.05;
  /// Speed at which a plate falls onto soil through nodes that bear nothing, likewise.
  double falling = 0.5;
};

/// Area of a shell / the area that nodes along it stand for (contact_inner of
/// kernels/soil/contact_law.h): above 1 for plates with corners, at most 2.
double plate_area_factor(const ShellGeometry& geometry, const ContactSettings& settings,
                         double cell);

/// Contact of all tools with the soil: two nodal fields beside a plate, each of which keeps up with
/// its share of the plate's speed [docs/tools.md, contact shares]. Any number of tools.
class Contact {
 public:
  /// `gravity` [m/s2] tells which plates lie on soil.
  Contact(device::Device& device, double cell, const Vec3& origin_W, const Vec3& gravity);

  int add_tool(const scene::Shell& shell);
  const ShellGeometry& geometry(int tool) const {
    return *tools_[static_cast<std::size_t>(tool)].geometry;
  }

  /// Takes the tools' poses for the step and brings near lists up to date. True when the lists
  /// changed: the caller then lays out tiles again (near_particle_blocks, near_slot).
  bool set_motions(std::span<const ToolMotion> motions, const BlockTable& table,
                   bool blocks_changed);
  /// Takes the tools' twists and places for a step that the transfer under way holds: lists, sides
  /// of nodes and plates stay those of its start, and levers are those of now.
  void set_twists(std::span<const ToolMotion> motions);
  /// Whether these are motions of the tools that the last `set_motions` had.
  bool moves_same(std::span<const ToolMotion> motions) const;
  /// Queues what a transfer under way knows of the shells, after `visit` has loaded and the lists
  /// are built.
  void go_on(Transfer& transfer);
  /// Builds the near lists for the poses they were last built for (after `visit` has loaded).
  void list_near(const BlockTable& table);
  const std::vector<std::uint8_t>& near_particle_blocks() const { return near_particle_blocks_; }
  const std::vector<int>& near_slot() const { return near_slot_; }
  NearNodes& nodes() { return nodes_; }
  /// What the last step did to near nodes, two entries a node; of blocks that are marked as
  /// touched.
  const device::Buffer<ContactRecord>& records() const { return records_; }
  const device::Buffer<std::int32_t>& touched() const { return touched_; }

  /// Queues: signed distances of nodes, sides of particles, particles pushed out of plates (the
  /// push and the crossings go into the transfer's report).
  void classify(ParticleStore& store, Transfer& transfer);
  /// Queues the two-way solve and the impulses on the nodes. What the books say of it is an
  /// identity up to rounding: the tool's impulse is minus the nodes' change. That the machine got
  /// it, Momentum.* measures.
  void solve(Transfer& transfer, double dt);
  /// Queues reading what the tools felt.
  void read_later();
  /// Sums what the tools felt, once a wait came after read_later; `impulses` parallel to the
  /// motions.
  void book(std::span<ToolImpulse> impulses);

  /// Adds what the tools felt in a step of dt [s] to the transfer under way, and tells their mean
  /// force.
  void feel(double dt, std::span<ToolImpulse> impulses);
  /// Mean force [N] and moment about its origin [N m] that a tool was last told.
  const Vec3& force(int tool) const { return tools_[static_cast<std::size_t>(tool)].force_W; }
  const Vec3& moment(int tool) const { return tools_[static_cast<std::size_t>(tool)].moment_W; }
  /// A transfer has ended: what was felt over it is the force that is told from now on.
  void end_transfer();

  /// Near lists hang on where tools were when they were made, sides of nodes on where they were
  /// when the transfer under way began: that is state, the rest follows from it (`list_near`,
  /// `go_on`).
  /// @throws InputError for another number of tools than are registered, or a pose that is none.
  void visit(Archive& a);

 private:
  /// Results of contact_apply and shell_nodes, mapped for the host.
  struct Results {
    device::Mapped<const std::int32_t> touched, tool_of;
    device::Mapped<const ContactRecord> records;
  };
  struct Registered {
    std::unique_ptr<ShellGeometry> geometry;
    int first_triangle = 0;
    double area_factor = 1;            ///< plate area / what nodes stand for
    bool present = false;              ///< has a motion in this transfer
    bool listed = false;               ///< near lists hold it
    Pose X_listed = Pose::Identity();  ///< where it was then
    Pose X = Pose::Identity();         ///< at the start of the transfer
    Pose X_now = Pose::Identity();     ///< at the start of the step
    BlockKey window;                   ///< block its float coordinates count from
    // Sums over the transfer under way, and the means over the one before; without one, over the
    // steps so far.
    Vec3 J_W = Vec3::Zero(), L_W = Vec3::Zero();
    double felt_for = 0;  ///< [s]
    bool told = false;    ///< there is a transfer before
    Vec3 force_W = Vec3::Zero(), moment_W = Vec3::Zero();
    void visit(Archive& a);
  };
  Vec3 to_grid(const Vec3& p_W) const { return (p_W - origin_) / cell_; }
  bool moved_far() const;
  void set_window(Registered& tool) const;
  void find_candidates(const BlockTable& table, Marks& nodes, Marks& particle_blocks) const;
  void upload_tools();
  Tool tool_now(std::size_t index) const;
  template <class... Tail>
  void launch(device::Kernel& kernel, Transfer& transfer, int only, const Tail&... tail);

  device::Device& device_;
  double cell_;
  Vec3 origin_;
  Vec3 down_;  ///< of length 1, or 0 without gravity
  ContactSettings settings_;
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
  // What the kernels of contact.cl write.
  device::Buffer<ContactRecord> records_;  ///< two per near node, one per field (contact_apply)
  device::Buffer<ContactSums> sums_;       ///< one per near block (contact_sums)
  /// One per near block: whether contact changed a node (contact_apply).
  device::Buffer<std::int32_t> touched_;
  std::optional<Results> results_;
};

}  // namespace navvy::soil
