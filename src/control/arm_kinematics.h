// SPDX-License-Identifier: Apache-2.0
// Geometry of an excavator's arm in its swing plane.
#pragma once

#include <array>
#include <string>
#include <vector>

#include "core/math.h"
#include "scene/machine.h"

namespace navvy::control {

/// Pose of the bucket in the swing plane, in the frame S of the swing axis (origin on the axis, z
/// along it).
struct BucketPose {
  /// Distance of the tip from the swing axis [m].
  double reach = 0;
  /// Height of the tip above S's origin [m].
  double height = 0;
  /// Angle of the line from pin to tip above the horizontal, positive outward [rad]; -pi/2 points
  /// down.
  double angle = 0;
};

/// Joint angles of boom, stick and bucket [rad].
using ArmAngles = std::array<double, 3>;

/// Forward and inverse kinematics of boom, stick and bucket, elbow up. Pitch joints turn about -y.
class ArmKinematics {
 public:
  /// Reads lengths and limits from the machine. @throws InputError naming the missing joint role.
  explicit ArmKinematics(const scene::Machine& machine);

  /// Returns the bucket's pose at these joint angles, whether or not they are within the limits.
  BucketPose forward(const ArmAngles& q) const;
  /// Computes the joint angles of a pose. Returns false when it is out of reach or beyond the
  /// limits; `q` is undefined then.
  bool inverse(const BucketPose& pose, ArmAngles& q) const;
  /// Does the same with the possible bucket angle nearest to the wanted one, within 120 deg, and
  /// changes `pose.angle` to it. Continuous where a limit acts: the angle is found to 1e-6 rad.
  bool inverse_nearest(BucketPose& pose, ArmAngles& q) const;
  /// Returns how far the shell's lowest point hangs below the tip when the bucket is at `angle`
  /// [m], >= 0.
  double below_tip(double angle) const;
  /// Returns how far the part of the shell less than `height` [m] above the tip reaches outward of
  /// it [m], >= 0.
  double beyond_tip(double angle, double height) const;
  /// Distance from pin to tip [m].
  double bucket_length() const { return bucket_; }
  /// Largest possible distance of the tip from the boom's pin [m].
  double longest() const { return boom_ + stick_ + bucket_; }

  // Indices and limits as in scene::Machine, for code that commands the joints.
  int swing_joint() const { return swing_; }
  /// Joint indices of boom, stick and bucket.
  const std::array<int, 3>& joints() const { return joints_; }
  /// Pose of S in the base link (links[0]) at zero swing.
  const Pose& X_BS() const { return X_BS_; }
  /// Direction of the cutting edge relative to the line from pin to tip [rad].
  double cut_angle() const { return cut_angle_; }
  const scene::Bucket& bucket() const { return bucket_data_; }
  /// Limits of boom (0), stick (1) and bucket (2) [rad]; half a turn either way where a joint has
  /// none.
  double lower(int i) const { return lower_[static_cast<std::size_t>(i)]; }
  double upper(int i) const { return upper_[static_cast<std::size_t>(i)]; }
  /// Returns false when the upper structure turns endlessly; the swing bounds mean nothing then.
  bool swing_limited() const { return swing_limited_; }
  double swing_lower() const { return swing_lower_; }
  double swing_upper() const { return swing_upper_; }

 private:
  // Indices into scene::Machine::joints and links.
  int swing_ = -1;
  std::array<int, 3> joints_{};
  std::array<double, 3> lower_{}, upper_{};
  bool swing_limited_ = false;
  double swing_lower_ = 0, swing_upper_ = 0;
  Pose X_BS_ = Pose::Identity();
  // Lengths [m] of the bars between the pins, the last one to the bucket's tip.
  double pin_reach_ = 0, pin_height_ = 0;  // boom foot in S
  double boom_ = 0, stick_ = 0, bucket_ = 0;
  double cut_angle_ = 0, tip_angle_ = 0;
  scene::Bucket bucket_data_;
  // The shell in the swing plane, bucket at angle 0: vertices from the tip [m], edges between them.
  std::vector<Vec2> profile_;
  std::vector<std::array<int, 2>> profile_edges_;
};

}  // namespace navvy::control
