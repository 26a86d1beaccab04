// SPDX-License-Identifier: Apache-2.0
// Moves one shell along a prescribed twist and keeps what it felt.
#pragma once

#include <vector>

#include "lab/lab_site.h"

namespace navvy::lab {

/// What a tool felt, one entry per step; all four have one length. Vectors in W.
struct Trace {
  std::vector<double> time;    ///< at the end of the step [s]
  std::vector<double> travel;  ///< path length of the frame's origin since the driver was made [m]
  std::vector<Vec3> force;     ///< soil on tool, mean over the last transfer that has ended [N]
  std::vector<Vec3> moment;    ///< about the frame's origin [N m]
};

/// One shell on a prescribed path. All tools of the site move with every step; each driver keeps
/// its own trace, so two drivers must not both step. The site must outlive it.
class ToolDriver {
 public:
  /// Adds the shell to the site, at rest.
  ToolDriver(Site& site, const scene::Shell& shell, const Pose& X_WT);

  Site& site() { return *site_; }
  int tool() const { return tool_; }  ///< its number in the site
  const Pose& pose() const;
  /// Kept until it is set again; w turns about the frame's origin [m/s], [rad/s].
  void set_twist(const Vec3& v_W, const Vec3& w_W = Vec3::Zero());

  /// A tool of the site that takes every twist of this one too: a second shell of the same rig.
  void carry(int other) { carried_.push_back(other); }

  /// One step; books the trace.
  void step(double dt);
  /// Steps for `seconds`, at the step limit or at most `dt`; returns the mean force of that stretch
  /// [N].
  Vec3 run(double seconds, double dt = 0);
  /// Moves along v for a path of `distance` [m]; returns the mean force of that stretch [N].
  Vec3 advance(double distance, const Vec3& v_W, double dt = 0);

  /// From rest to v over `ramp` [m] of path, evenly accelerated (0: at once), then on at v until
  /// `distance` is done. A tool that starts at once sends a wave of rho c_p v through the soil.
  /// Returns the mean force of it all [N].
  Vec3 start(double distance, const Vec3& v_W, double ramp);

  const Trace& trace() const { return trace_; }
  /// Adds time, travel and the force's components (low-passed when `cutoff` [Hz] > 0) to the
  /// report's series.
  void write(Report& report, double cutoff = 0, const std::string& prefix = "") const;

 private:
  Site* site_;
  int tool_;
  std::vector<int> carried_;
  double travelled_ = 0;
  Trace trace_;
};

/// Mean force while travel was in [from, to) [N]; NaN when no step lies there.
Vec3 mean_force(const Trace& trace, double from, double to);
/// Root mean square of the force about its mean while travel was in [from, to), per axis [N].
Vec3 force_scatter(const Trace& trace, double from, double to);
/// First-order low-pass, forward and backward (no lag). `cutoff` [Hz]; samples may be unevenly
/// spaced in `time` [s].
std::vector<double> low_pass(const std::vector<double>& time, const std::vector<double>& values,
                             double cutoff);

}  // namespace navvy::lab
