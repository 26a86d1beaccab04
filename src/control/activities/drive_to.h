// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "control/activity_step.h"
#include "control/pursuit.h"

namespace navvy::control {

/// Drives (rear-wheel drive, Ackermann steering) until the machine's origin is at `target` with
/// heading `heading`; then brakes and stands for half a second. Gives up after 30 s plus three
/// times the time that the distance needs.
struct DriveTo final : ActivityStep, DriveGoal {
  /// Name in scene files.
  static constexpr const char* kElement = "drive_to";
  /// Sentence for the reference of scene elements.
  static constexpr const char* kText = "Drives along a straight line or curve to a place.";
  /// Distance of the origin from the target at the end [m] above which a warning is logged.
  double tolerance = 0.15;

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
  /// Returns an activity with one phase, which commands only the drive.
  std::unique_ptr<Activity> activity(OperatorContext& place) const override;
  void check_reach(ReachCheck& check) const override;
  /// Returns the pose at the target, upright on the present ground.
  std::optional<Pose> station(const scene::Machine& machine, const Pose& X_WB,
                              const SurfaceView& surface) const override;
};

}  // namespace navvy::control
