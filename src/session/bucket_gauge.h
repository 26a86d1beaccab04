// SPDX-License-Identifier: Apache-2.0
// Components of the soil force on a bucket. Private to the session.
#pragma once

#include "scene/machine.h"
#include "sim/world.h"

namespace navvy::session {

/// Components of the low-passed soil force on a bucket [N].
struct BucketLoad {
  /// Magnitude of the force.
  double whole = 0;
  /// Component against the motion of the cutting edge: the digging resistance. 0 while the edge
  /// moves slower than 0.05 m/s, as its direction is noise then.
  double draft = 0;
  /// Upward component, never negative: the push of the bucket on the ground less the weight of its
  /// load.
  double uplift = 0;
};

/// Returns the components of `force` (in W) [N] on a link whose cutting edge is at `p_tip` in the
/// link's frame [m].
BucketLoad load_of(const Vec3& force, const vehicle::LinkState& link, const Vec3& p_tip);

/// Measures the soil force on one bucket. Reads the world through handles, which must stay valid.
class BucketGauge {
 public:
  /// Looks up the shell and the link of `bucket` in `machine`.
  BucketGauge(const sim::MachineHandle& machine, const scene::Bucket& bucket)
      : tool_(machine.tool(bucket.shell)), link_(machine.link(bucket.link)), p_tip_(bucket.p_tip) {}

  /// Returns the bucket's shell.
  const sim::ToolHandle& tool() const { return tool_; }
  /// Returns the force of the last step.
  BucketLoad load() const { return load_of(tool_.smooth_force(), link_.state(), p_tip_); }

 private:
  sim::ToolHandle tool_;
  sim::LinkHandle link_;
  /// Position of the cutting edge in the frame of the link [m].
  Vec3 p_tip_;
};

}  // namespace navvy::session
