// SPDX-License-Identifier: Apache-2.0
// The transfer that a solver is in: its length, and the node velocities that it keeps.
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

/// Several steps share one transfer [docs/soil.md, transfer]. Velocities of its nodes are state, so
/// that a run with snapshots equals the run without.
///
/// Each step asks `holds` first. If the step does not fit, `end` moves the particles and a new
/// transfer begins with that step; the next `record_step` opens it. Lists of blocks, sides of
/// particles and plates of tools may only change between `end` and the first step.
class CurrentTransfer {
 public:
  /// Store, transfer and contact must outlive it. `length`: longest time [s]; `max_motion`: longest
  /// displacement of a particle or tool [cells].
  CurrentTransfer(ParticleStore& store, Transfer& transfer, Contact& contact, double length,
                  double max_motion)
      : store_(store),
        transfer_(transfer),
        contact_(contact),
        length_(length),
        max_motion_(max_motion) {}

  /// Returns the longest time of a transfer [s].
  double length() const { return length_; }
  /// Returns the longest displacement in a transfer [cells].
  double max_motion() const { return max_motion_; }
  /// Returns true when a step of dt [s] may belong to it. `tool_speed` in m/s, `gravity` in m/s2.
  bool holds(double dt, double cell, double tool_speed, double gravity) const {
    return interval_.holds(dt, length_, cell, tool_speed, gravity, max_motion_);
  }
  /// Counts a step of dt [s] after which the fastest particle moves at `fastest` [m/s].
  void record_step(double dt, double cell, double fastest, double tool_speed) {
    interval_.count_step(dt, cell, fastest, tool_speed);
  }
  /// Moves the particles to where it takes them; blocks, lists and sides may change then. Returns
  /// the longest displacement [cells], 0 when no transfer is under way.
  double end();

  /// Visits the interval and, while a transfer is under way, the velocities of its nodes.
  void visit(Archive& a);
  /// Puts the loaded velocities onto the nodes, once the lists of blocks are made.
  void restore(Archive& a);

 private:
  /// Visits the velocities of the front and the back fields.
  void visit_nodes(Archive& a);

  ParticleStore& store_;
  Transfer& transfer_;
  Contact& contact_;
  double length_, max_motion_;
  TransferInterval interval_;
  /// While loading: velocities of the front and the back fields.
  std::vector<float> loaded_[2];
};

}  // namespace navvy::soil
