// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "control/program_step.h"
#include "control/pursuit.h"

namespace navvy::control {

/// Drive (rear-wheel drive, Ackermann steering) until the machine's origin is at `target`, facing
/// `heading`; then brake and stand for half a second. Gives up after 30 s and three times the way's
/// own time.
struct DriveTo final : ProgramStep, DriveGoal {
  /// Name in scene files.
  static constexpr const char* kElement = "drive_to";
  static constexpr const char* kText = "Drives along a straight line or curve to a place.";
  double tolerance = 0.15;  ///< of the origin from the target at the end; more is a warning [m]

  void describe(scene::Fields& f) override {
    f("target_m", target, {-1e6, 1e6}, "Target in W, on the site.", scene::kNeeded);
    f("heading_deg", heading, {-360, 360},
      "Heading at the target, from W's x; by default along the line from the start.",
      scene::given(has_heading));
    f("speed_m_per_s", speed, {-20, 20}, "Speed; negative: backwards.");
    f("tolerance_m", tolerance, {0.01, 5},
      "Distance from the target at the end that does not count as a failure.");
  }
  /// Checks the speed, that the machine has a drive, and that the target is on the site.
  void check(const scene::StepSource& source) const;
  const char* element() const override { return kElement; }
  /// One phase: commands the drive alone.
  std::unique_ptr<Activity> activity(OperatorContext& place) const override;
  void check_reach(ReachCheck& check) const override;
  /// Upright on the present ground, at the target.
  std::optional<Pose> station(const scene::Machine& machine, const Pose& X_WB,
                              const SurfaceView& surface) const override;
};

}  // namespace navvy::control
