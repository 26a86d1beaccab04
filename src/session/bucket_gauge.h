// SPDX-License-Identifier: Apache-2.0
// What the soil does to a bucket, taken apart by what it costs. Private to the session.
#pragma once

#include "scene/machine.h"
#include "sim/world.h"

namespace navvy::session {

/// The low-passed soil force on a bucket [N].
struct BucketLoad {
  double whole = 0;  ///< its magnitude
  /// Its part against the lip's motion: what digging takes; 0 while the lip rests.
  double draft = 0;
  /// Its part upward: what the bucket bears on the ground, less the weight of its load; or 0.
  double uplift = 0;
};

/// `force` on a link whose lip is at `p_tip` in its frame [N], [m].
BucketLoad load_of(const Vec3& force, const vehicle::LinkState& link, const Vec3& p_tip);

/// A bucket with its link and lip.
class BucketGauge {
 public:
  BucketGauge(const sim::MachineHandle& machine, const scene::Bucket& bucket)
      : tool_(machine.tool(bucket.shell)), link_(machine.link(bucket.link)), p_tip_(bucket.p_tip) {}

  const sim::ToolHandle& tool() const { return tool_; }
  BucketLoad load() const { return load_of(tool_.smooth_force(), link_.state(), p_tip_); }

 private:
  sim::ToolHandle tool_;
  sim::LinkHandle link_;
  Vec3 p_tip_;
};

}  // namespace navvy::session
