// SPDX-License-Identifier: Apache-2.0
// The program step `drive_to`: drives along a straight line or a curve to a target.
#pragma once

#include "control/activity_step.h"
#include "control/pursuit.h"

namespace navvy::control {

/// Drives the base link's origin to `target` with pure pursuit (see Pursuit) and feedback of the
/// yaw rate (see CurvatureFeedback), then brakes and waits until the machine has stood still for
/// half a second. If it stands more than `tolerance` from the target, it backs off by up to four
/// wheelbases along the line that it follows and approaches the target a second time. A machine
/// that something holds within `tolerance` of the target has arrived.
///
/// The step fails if the machine ends more than `tolerance` from the target a second time, if it
/// makes no progress, or if one of these drives takes longer than 30 s plus three times the time
/// that the distance needs at the commanded speed.
struct DriveTo final : ActivityStep, DriveGoal {
  /// Name of the step's element in scene files.
  static constexpr const char* kElement = "drive_to";
  /// One-sentence description of the step for the reference of scene elements.
  static constexpr const char* kText = "Drives along a straight line or curve to a place.";
  /// Maximum distance of the base link's origin from the target at the end [m]; if it is exceeded,
  /// the step fails as out of reach.
  double tolerance = 0.15;

  /// Lists the child elements of the step with their ranges and descriptions.
  void describe(scene::Fields& f) override {
    f("target_m", target, {-1e6, 1e6}, "Target in W, on the site.", scene::kNeeded);
    f("heading_deg", heading, {-360, 360},
      "Heading at the target, from W's x; by default along the line from the start.",
      scene::given(has_heading));
    f("speed_m_per_s", speed, {-20, 20}, "Speed; negative: backwards.");
    f("tolerance_m", tolerance, {0.01, 5},
      "Distance from the target at the end that does not count as a failure.");
  }
  /// Reports an error if the speed is zero, the machine has no drive, or the target is not on the
  /// site.
  void check(const scene::StepSource& source) const;
  /// Returns the name of the step's element in scene files.
  const char* element() const override { return kElement; }
  /// Returns the target.
  std::vector<Vec2> places() const override { return {target}; }
  /// Returns an activity with the phases "drive" and "back_off". It commands only the drive.
  std::unique_ptr<Activity> activity(OperatorContext& place) const override;
  /// Reports an error if even a machine that rolls without slip would end too far from the target.
  void check_reach(ReachCheck& check) const override;
  /// Returns the predicted pose of the base link in W: upright at the target, at its current height
  /// above the ground.
  std::optional<Pose> station(const scene::Machine& machine, const Pose& X_WB,
                              const SurfaceView& surface) const override;
};

}  // namespace navvy::control
