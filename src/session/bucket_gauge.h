// SPDX-License-Identifier: Apache-2.0
// Measures the components of the soil force on a bucket. Private to the session.
#pragma once

#include "scene/machine.h"
#include "sim/world.h"

namespace navvy::session {

/// Components of the low-pass filtered force of the soil on a bucket [N].
struct BucketLoad {
  /// Magnitude of the force [N].
  double whole = 0;
  /// Component opposite to the velocity of the cutting edge: the digging resistance [N, >= 0]. It
  /// is 0 while the edge moves slower than 0.05 m/s, because its direction is not reliable then.
  double draft = 0;
  /// Vertical component, if it points up, else 0 [N]. The soil pushes the bucket up when the bucket
  /// presses on the ground; the weight of the soil in the bucket reduces this force.
  double uplift = 0;
};

/// Returns the components of `force` [N] in W, which acts on the bucket's link. `link` is the state
/// of that link, and `p_tip` the position of the cutting edge in its frame [m].
BucketLoad load_of(const Vec3& force, const vehicle::LinkState& link, const Vec3& p_tip);

/// Measures the soil force on one bucket. It holds handles into the world, which must remain valid.
class BucketGauge {
 public:
  /// Makes the gauge of `bucket`, one of the buckets of `machine`.
  BucketGauge(const sim::MachineHandle& machine, const scene::Bucket& bucket)
      : tool_(machine.tool(bucket.shell)), link_(machine.link(bucket.link)), p_tip_(bucket.p_tip) {}

  /// Returns the handle of the bucket's shell.
  const sim::ToolHandle& tool() const { return tool_; }
  /// Returns the components of the force at the end of the last step.
  BucketLoad load() const { return load_of(tool_.smooth_force(), link_.state(), p_tip_); }

 private:
  // The bucket's shell.
  sim::ToolHandle tool_;
  // The link that carries the shell.
  sim::LinkHandle link_;
  // Position of the cutting edge in the frame of the link [m].
  Vec3 p_tip_;
};

}  // namespace navvy::session
