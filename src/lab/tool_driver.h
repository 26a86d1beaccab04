// SPDX-License-Identifier: Apache-2.0
// Moves one shell along a prescribed twist and records the forces on it.
#pragma once

#include <vector>

#include "lab/lab_site.h"

namespace navvy::lab {

/// Forces on a tool, one entry per step; all four have one length. Vectors in W.
struct Trace {
  /// Time at the end of the step [s].
  std::vector<double> time;
  /// Path length of the frame's origin since the driver was created [m].
  std::vector<double> travel;
  /// Force of the soil on the tool, mean over the last completed transfer [N].
  std::vector<Vec3> force;
  /// About the frame's origin [N m].
  std::vector<Vec3> moment;
};

/// One shell on a prescribed path. All tools of the site move with every step. Each driver keeps
/// its own trace, so only one of two drivers may step. The site must outlive it.
class ToolDriver {
 public:
  /// Adds the shell to the site, at rest.
  ToolDriver(Site& site, const scene::Shell& shell, const Pose& X_WT);

  Site& site() { return *site_; }
  /// Returns its number in the site.
  int tool() const { return tool_; }
  /// Returns the present pose of the shell.
  const Pose& pose() const;
  /// Sets the twist until the next call; w turns about the frame's origin [m/s], [rad/s].
  void set_twist(const Vec3& v_W, const Vec3& w_W = Vec3::Zero());

  /// Makes another tool of the site follow every twist: a second shell of the same rig.
  void carry(int other) { carried_.push_back(other); }

  /// Advances by dt [s] and extends the trace.
  void step(double dt);
  /// Advances by `seconds` with the step limit or at most `dt`. Returns the mean force of that
  /// interval [N].
  Vec3 run(double seconds, double dt = 0);
  /// Moves along v for a path of `distance` [m]. Returns the mean force of that interval [N].
  Vec3 advance(double distance, const Vec3& v_W, double dt = 0);

  /// Accelerates from rest to v over `ramp` [m] of path at a constant rate (0: at once), then moves
  /// on at v until `distance` is done. A tool that starts at once sends a wave of rho c_p v through
  /// the soil. Returns the mean force of the whole [N].
  Vec3 start(double distance, const Vec3& v_W, double ramp);

  /// Returns the forces recorded so far.
  const Trace& trace() const { return trace_; }
  /// Adds time, travel and the components of the force (low-passed when `cutoff` [Hz] > 0) to the
  /// report's series.
  void write(Report& report, double cutoff = 0, const std::string& prefix = "") const;

 private:
  Site* site_;
  int tool_;
  std::vector<int> carried_;
  double travelled_ = 0;
  Trace trace_;
};

/// Returns the mean force while travel was in [from, to) [N]; NaN when no step lies there.
Vec3 mean_force(const Trace& trace, double from, double to);
/// Returns the root mean square of the force about its mean while travel was in [from, to), per
/// axis [N].
Vec3 force_scatter(const Trace& trace, double from, double to);
/// Returns values after a first-order low-pass, forward and backward (no lag). `cutoff` [Hz];
/// samples may be unevenly spaced in `time` [s].
std::vector<double> low_pass(const std::vector<double>& time, const std::vector<double>& values,
                             double cutoff);

}  // namespace navvy::lab
