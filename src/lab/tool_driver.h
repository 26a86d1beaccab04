// SPDX-License-Identifier: Apache-2.0
// Moves a tool (a rigid shell) along a prescribed path through the soil and records the forces on
// it.
#pragma once

#include <vector>

#include "lab/lab_site.h"

namespace navvy::lab {

/// Recorded forces on a tool. All five lists have one entry per time step. Vectors have the axes of
/// the world frame W.
struct Trace {
  /// Simulated time at the end of each step [s].
  std::vector<double> time;
  /// Path length that the origin of the tool's frame has covered since the driver was created, at
  /// the end of each step [m].
  std::vector<double> travel;
  /// Force of the soil on the tool, averaged over the last completed transfer between particles and
  /// grid [N].
  std::vector<Vec3> force;
  /// Part of `force` that acts on the edges of the tool's plates [N].
  std::vector<Vec3> edge;
  /// Moment of the soil on the tool about the origin of the tool's frame, averaged like `force`
  /// [N m].
  std::vector<Vec3> moment;
};

/// Moves one tool of a site along a prescribed path and records the forces on it.
///
/// A step of the driver is a step of the whole site, in which all tools move. If a site has two
/// drivers, only one of them may call its stepping functions; the other one records nothing.
class ToolDriver {
 public:
  /// Adds a tool with this shell to `site`, at rest at the pose `X_WT`. The site must outlive the
  /// driver.
  ToolDriver(Site& site, const scene::Shell& shell, const Pose& X_WT);

  /// Returns the site that the tool was added to.
  Site& site() { return *site_; }
  /// Returns the index of the driven tool in its site, for Site::tool.
  int tool() const { return tool_; }
  /// Returns X_WT, the current pose of the tool.
  const Pose& pose() const;
  /// Sets the tool's velocity `v_W` [m/s] and angular velocity `w_W` [rad/s], both in axes of W; it
  /// keeps them until the next call. The tool rotates about the origin of its frame.
  void set_twist(const Vec3& v_W, const Vec3& w_W = Vec3::Zero());

  /// Makes the tool with the index `other` of the same site follow every twist that is set from now
  /// on, as a second shell rigidly joined to the driven one.
  void carry(int other) { carried_.push_back(other); }

  /// Advances the site by one step of `dt` [s] and appends an entry to the trace.
  void step(double dt);
  /// Advances the site by `seconds` in equal steps, which are at most Site::step_limit and, if `dt`
  /// is above 0, at most `dt` [s]. Returns the mean force on the tool over that time [N], axes of
  /// W.
  Vec3 run(double seconds, double dt = 0);
  /// Sets the velocity `v_W` [m/s] without rotation and advances the site until the tool has moved
  /// by `distance` [m]; `dt` as in `run`. Returns the mean force on the tool over that time [N],
  /// axes of W.
  Vec3 advance(double distance, const Vec3& v_W, double dt = 0);

  /// Accelerates the tool at a constant rate from rest to `v_W` [m/s] within the first `ramp` [m]
  /// of its path (0: at once), then moves it at `v_W` until `distance` [m] is covered. Returns the
  /// mean force over the whole path [N], axes of W.
  ///
  /// A ramp avoids the pressure wave rho c_p v that a tool sends through the soil if it starts
  /// at once.
  Vec3 start(double distance, const Vec3& v_W, double ramp);

  /// Returns the forces recorded since the driver was created.
  const Trace& trace() const { return trace_; }
  /// Appends the trace to the series of `report`: time, travel, and the three components in W of
  /// the force and of its part on edges.
  /// The forces are low-pass filtered if `cutoff` [Hz] is above 0. `prefix` is put before each
  /// series name.
  void write(Report& report, double cutoff = 0, const std::string& prefix = "") const;

 private:
  /// Site of the driven tool; not owned.
  Site* site_;
  /// Index of the driven tool in the site.
  int tool_;
  /// Indices of the tools that follow the twist of the driven tool.
  std::vector<int> carried_;
  /// Path length covered so far [m].
  double travelled_ = 0;
  /// Forces recorded so far.
  Trace trace_;
};

/// Returns the mean of the recorded forces whose travel is at least `from` and below `to` [m], per
/// axis of W [N]; NaN if the trace has no entry there.
Vec3 mean_force(const Trace& trace, double from, double to);
/// Returns the standard deviation of the recorded forces whose travel is at least `from` and below
/// `to` [m], per axis of W [N]; NaN if the trace has no entry there.
Vec3 force_scatter(const Trace& trace, double from, double to);
/// Returns `values` after a first-order low-pass filter with the cut-off frequency `cutoff` [Hz].
/// The filter runs forwards and backwards, so it causes no lag. `time` [s] has one entry per value;
/// its spacing may be uneven.
std::vector<double> low_pass(const std::vector<double>& time, const std::vector<double>& values,
                             double cutoff);

}  // namespace navvy::lab
