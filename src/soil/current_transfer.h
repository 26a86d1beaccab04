// SPDX-License-Identifier: Apache-2.0
// The transfer that is in progress in a solver: its length, and the node velocities that it carries
// from step to step.
#pragma once

#include <vector>

#include "soil/particles/interval.h"
#include "soil/particles/particle_store.h"
#include "soil/particles/transfer.h"
#include "soil/tools/contact.h"

namespace navvy {
class Archive;
}

namespace navvy::soil {

/// The transfer in progress: a group of consecutive steps during which particles keep their
/// positions and nodes keep their velocities [docs/soil.md, transfer]. The node velocities are part
/// of the saved state, so that a run resumed from a snapshot equals the uninterrupted run.
///
/// The caller asks `holds` before each step. If the step does not fit, the caller calls `end`,
/// which moves the particles; the next `record_step` then begins a new transfer. Block lists,
/// particle sides and tool plates may only change between `end` and the first step of the next
/// transfer.
class CurrentTransfer {
 public:
  /// Starts without a transfer in progress. `store`, `transfer` and `contact` must outlive this
  /// object. `length`: longest duration of a transfer [s]. `max_motion`: longest displacement of a
  /// particle or a tool during a transfer [cells].
  CurrentTransfer(ParticleStore& store, Transfer& transfer, Contact& contact, double length,
                  double max_motion)
      : store_(store),
        transfer_(transfer),
        contact_(contact),
        length_(length),
        max_motion_(max_motion) {}

  /// Returns the longest allowed duration of a transfer [s].
  double length() const { return length_; }
  /// Returns the longest displacement that a particle or a tool may make during a transfer [cells].
  double max_motion() const { return max_motion_; }
  /// Returns true if a transfer is in progress and a step of dt [s] still fits into it. `cell`:
  /// edge of a cell [m]; `tool_speed`: speed of the fastest tool [m/s]; `gravity`: magnitude of
  /// gravity [m/s2].
  bool holds(double dt, double cell, double tool_speed, double gravity) const {
    return interval_.holds(dt, length_, cell, tool_speed, gravity, max_motion_);
  }
  /// Adds a step of dt [s] to the transfer, after that step has run. `cell`: edge of a cell [m];
  /// `fastest`: largest particle speed after the step [m/s]; `tool_speed`: speed of the fastest
  /// tool in the step [m/s].
  void record_step(double dt, double cell, double fastest, double tool_speed) {
    interval_.count_step(dt, cell, fastest, tool_speed);
  }
  /// Ends the transfer and moves the particles by the displacements that its steps recorded.
  /// Returns an upper bound of those displacements [cells], or 0 if no transfer was in progress.
  double end();

  /// Visits the time and displacement of the transfer and, while one is in progress, the velocities
  /// of its nodes.
  void visit(Archive& a);
  /// Writes the node velocities that `visit` loaded to the device. The block lists must already
  /// have been rebuilt.
  /// @throws InputError when the number of loaded velocities does not match the blocks.
  void restore(Archive& a);

 private:
  /// Visits the node velocities: the front field of all active blocks, then the back field of the
  /// blocks near a tool.
  void visit_nodes(Archive& a);

  /// Particles that move when the transfer ends.
  ParticleStore& store_;
  /// Kernels and node velocities of the front field.
  Transfer& transfer_;
  /// Contact of the tools, which owns the node velocities of the back field.
  Contact& contact_;
  /// `length_`: longest allowed duration of a transfer [s]. `max_motion_`: longest displacement
  /// that a particle or a tool may make during it [cells].
  double length_, max_motion_;
  /// Time and displacements since the transfer began; reset by `end`.
  TransferInterval interval_;
  /// Node velocities between `visit` and `restore` of a load: [0] front field, [1] back field, each
  /// four floats per node.
  std::vector<float> loaded_[2];
};

}  // namespace navvy::soil
