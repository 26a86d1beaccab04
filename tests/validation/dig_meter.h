// SPDX-License-Identifier: Apache-2.0
// Measures what a dig does with its bucket while it runs: loads, draft, and where its energy goes.
#pragma once

#include <string>
#include <vector>

#include "session/bucket_gauge.h"
#include "session/session.h"

namespace navvy::validation {

/// Follows the only machine of a session from step to step, and adds up its scoops.
class DigMeter {
 public:
  /// `session` must outlive the meter.
  explicit DigMeter(const session::Session& session);
  /// Measures the step that has just been made.
  void look();

  /// Returns the largest payload of each completed scoop, from penetration to the end of the curl
  /// [kg].
  const std::vector<double>& fullest() const { return fullest_; }
  /// Returns the share of the largest payloads that is lost before the swing, over all scoops [-].
  double lost() const;
  /// Returns the work of the bucket on the soil while it is in the ground [J]: penetrate, drag and
  /// curl.
  double cutting() const { return cutting_; }
  /// Returns the work of the bucket on its load from the lift to the dump [J].
  double lifting() const { return lifting_; }
  /// Returns the integral of the draft over the path of the cutting edge in the ground [J]; over
  /// the bank volume it is the mean draft over the cut area [Pa].
  double draft_work() const { return draft_work_; }
  /// Returns the work of the machine's drives and cylinders since the start of its first scoop [J].
  double work() const;
  /// Returns the soil's largest force on edges and teeth [N], and the mean over the path of the
  /// cutting edge of the part of the draft that they meet [-].
  double edge_peak() const { return edge_peak_; }
  double edge_part() const { return draft_work_ > 0 ? edge_work_ / draft_work_ : 0; }

 private:
  const session::Session& session_;
  const scene::Bucket& bucket_;
  session::BucketGauge gauge_;
  sim::LinkHandle link_;
  std::vector<double> fullest_;
  double most_ = 0, cutting_ = 0, lifting_ = 0, draft_work_ = 0, edge_work_ = 0, edge_peak_ = 0;
  double start_work_ = -1, time_ = 0;
  int steps_ = 0;
  std::string last_;
};

}  // namespace navvy::validation
