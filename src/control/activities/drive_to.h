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
  /// Distance of the origin from the target at the end [m] above which a warning is logged.
  double tolerance = 0.15;

  /// Reads <target_m>, <heading_deg>, <speed_m_per_s>, <tolerance_m>; the target must be on the
  /// site.
  static DriveTo read(const scene::StepSource& source);
  const char* element() const override { return kElement; }
  /// Returns an activity with one phase, which commands only the drive.
  std::unique_ptr<Activity> activity(OperatorContext& place) const override;
  void check_reach(ReachCheck& check) const override;
  /// Returns the pose at the target, upright on the present ground.
  std::optional<Pose> station(const scene::Machine& machine, const Pose& X_WB,
                              const SurfaceView& surface) const override;
};

}  // namespace navvy::control
