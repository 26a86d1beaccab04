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
  double tolerance = 0.15;  ///< of the origin from the target at the end; more is a warning [m]

  /// Elements: <target_m>, <heading_deg>, <speed_m_per_s>, <tolerance_m>; the target must lie on
  /// the site.
  static DriveTo read(const scene::StepSource& source);
  const char* element() const override { return kElement; }
  /// One phase: commands the drive alone.
  std::unique_ptr<Activity> activity(OperatorContext& place) const override;
  void check_reach(ReachCheck& check) const override;
  /// Upright on the present ground, at the target.
  std::optional<Pose> station(const scene::Machine& machine, const Pose& X_WB,
                              const SurfaceView& surface) const override;
};

}  // namespace navvy::control
