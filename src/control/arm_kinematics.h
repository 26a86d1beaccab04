// SPDX-License-Identifier: Apache-2.0
// Kinematics of an excavator's arm in its swing plane: the plane that contains the swing axis,
// boom, stick and bucket.
#pragma once

#include <array>
#include <string>
#include <vector>

#include "core/math.h"
#include "scene/machine.h"

namespace navvy::control {

/// Pose of the bucket in the swing plane, in the frame S. The origin of S is on the swing axis, and
/// its z axis points along the swing axis.
struct BucketPose {
  /// Distance of the bucket's tip from the swing axis [m].
  double reach = 0;
  /// Height of the tip above the origin of S [m].
  double height = 0;
  /// Angle of the line from the bucket's pin to its tip [rad]: 0 points horizontally outward, -pi/2
  /// straight down.
  double angle = 0;
};

/// Joint angles of boom, stick and bucket, in this order [rad].
using ArmAngles = std::array<double, 3>;

/// Forward and inverse kinematics of boom, stick and bucket. The inverse uses the solution with the
/// elbow (the joint between boom and stick) up. Positive joint angles turn about -y of S, which
/// lifts the arm.
class ArmKinematics {
 public:
  /// Reads the lengths of the arm and the joint limits from the machine. @throws InputError if the
  /// machine has no swing, boom, stick or bucket joint, or no bucket.
  explicit ArmKinematics(const scene::Machine& machine);

  /// Returns the pose of the bucket at the joint angles `q`, whether or not these are within the
  /// joint limits.
  BucketPose forward(const ArmAngles& q) const;
  /// Returns a point on the line of the stick, `along` [m] from the bucket's pin towards the elbow:
  /// its distance from the swing axis and its height above the origin of S [m].
  Vec2 on_stick(const ArmAngles& q, double along) const;
  /// Computes the joint angles `q` that give the bucket the pose `pose`. Returns false if the pose
  /// is out of reach or violates a joint limit; the contents of `q` are undefined then.
  bool inverse(const BucketPose& pose, ArmAngles& q) const;
  /// Does the same as `inverse`, but if the angle of `pose` is not possible, replaces it with the
  /// nearest possible one, to 1e-6 rad. Returns false if none is possible within 120 deg; `pose` is
  /// unchanged then, and the contents of `q` are undefined.
  bool inverse_nearest(BucketPose& pose, ArmAngles& q) const;
  /// Returns the distance by which the lowest point of the bucket's shell is below the tip
  /// [m, >= 0], when the bucket is at `angle` [rad] (BucketPose::angle).
  double below_tip(double angle) const;
  /// Returns the horizontal distance by which the shell extends outward beyond the tip [m, >= 0],
  /// when the bucket is at `angle` [rad]. Only the part of the shell that is less than `height` [m]
  /// above the tip counts.
  double beyond_tip(double angle, double height) const;
  /// Returns true if a point of the swing plane is inside the outline of the bucket's shell with
  /// its mouth closed by a plane, or at most `margin` [m] outside of it. `from_tip` is the point
  /// relative to the bucket's tip, outward and up [m], with the bucket at `angle` [rad]. False if
  /// the shell is unknown.
  bool is_in_bucket(double angle, const Vec2& from_tip, double margin) const;
  /// Returns the inertia of upper structure and arm about the swing axis at the joint angles `q`,
  /// with soil of the mass `load` [kg] at the middle of the line from the bucket's pin to its tip
  /// [kg m2].
  double swing_inertia(const ArmAngles& q, double load) const;
  /// Returns the struck capacity of the bucket: the volume between its shell and the plane of its
  /// mouth [m3]. 0 if the shell is unknown.
  double struck_capacity() const { return struck_; }
  /// Returns the distance between the bucket's pin and its tip [m].
  double bucket_length() const { return bucket_; }
  /// Returns the maximum distance of the tip from the boom's pin, with the arm stretched [m].
  double longest() const { return boom_ + stick_ + bucket_; }

  /// Returns the index of the swing joint in scene::Machine::joints.
  int swing_joint() const { return swing_; }
  /// Returns the indices of the boom, stick and bucket joints in scene::Machine::joints.
  const std::array<int, 3>& joints() const { return joints_; }
  /// Returns the pose of S in the frame of the base link (links[0]) at a swing angle of zero.
  const Pose& X_BS() const { return X_BS_; }
  /// Returns the angle from the line between pin and tip to the direction in which the cutting edge
  /// points [rad].
  double cut_angle() const { return cut_angle_; }
  /// Returns the machine's first bucket, which this arm digs with.
  const scene::Bucket& bucket() const { return bucket_data_; }
  /// Returns the lower limit of boom (i = 0), stick (1) or bucket (2) [rad]; -pi if the joint has
  /// no limits.
  double lower(int i) const { return lower_[static_cast<std::size_t>(i)]; }
  /// Returns the upper limit of boom (i = 0), stick (1) or bucket (2) [rad]; pi if the joint has no
  /// limits.
  double upper(int i) const { return upper_[static_cast<std::size_t>(i)]; }
  /// Returns true if the swing joint has limits; otherwise the upper structure can turn endlessly.
  bool swing_limited() const { return swing_limited_; }
  /// Returns the lower limit of the swing joint [rad]; meaningless without limits.
  double swing_lower() const { return swing_lower_; }
  /// Returns the upper limit of the swing joint [rad]; meaningless without limits.
  double swing_upper() const { return swing_upper_; }
  /// Returns true if the swing joint can turn to the angle `swing` [rad]. Whole turns count as they
  /// stand, as the physics engine limits the joint.
  bool swings_to(double swing) const {
    return !swing_limited_ || (swing >= swing_lower_ && swing <= swing_upper_);
  }

 private:
  // Index of the swing joint in scene::Machine::joints.
  int swing_ = -1;
  // Indices of the boom, stick and bucket joints in scene::Machine::joints.
  std::array<int, 3> joints_{};
  // Joint limits of boom, stick and bucket [rad].
  std::array<double, 3> lower_{}, upper_{};
  // True if the swing joint has limits.
  bool swing_limited_ = false;
  // Limits of the swing joint [rad]; meaningless without limits.
  double swing_lower_ = 0, swing_upper_ = 0;
  // Pose of the swing axis frame S in the frame of the base link, at a swing angle of zero.
  Pose X_BS_ = Pose::Identity();
  // Links that move as one with upper structure, boom, stick and bucket, for the swing inertia.
  struct Part {
    // Mass [kg], and first moments of mass about the pin, along and across the part [kg m].
    double mass = 0, along = 0, across = 0;
    // Second moments of mass about the pin: along x along, along x across, across x across, and
    // across the swing plane [kg m2].
    double xx = 0, xz = 0, zz = 0, yy = 0;
  };
  // Sums the links of `machine` into `parts_`; `X_MS` is the pose of S in the machine's frame, and
  // `pins` are the pins of boom, stick and bucket in S, with all joints at position zero.
  void weigh(const scene::Machine& machine, const Pose& X_MS, const std::array<Vec3, 3>& pins);
  // Takes the bucket's struck capacity, and the outline of its shell seen from the side, rotated so
  // that the line from pin to tip is level. `tip` is the tip in S, with all joints at position
  // zero.
  void take_outline(const scene::Machine& machine, const Pose& X_MS, const Vec3& tip);
  // Upper structure (about the swing axis), boom, stick and bucket (about their pins, in the axes
  // of S with all joints at position zero).
  std::array<Part, 4> parts_{};
  // Struck capacity of the bucket [m3].
  double struck_ = 0;
  // Position of the boom's pin in S: distance from the swing axis and height [m].
  double pin_reach_ = 0, pin_height_ = 0;
  // Distances between successive pins [m]; the last one is from the bucket's pin to its tip.
  double boom_ = 0, stick_ = 0, bucket_ = 0;
  // Angle from the line between pin and tip to the direction of the cutting edge, and angle of that
  // line above the horizontal with all joints at zero [rad].
  double cut_angle_ = 0, tip_angle_ = 0;
  // The machine's first bucket, which this arm digs with.
  scene::Bucket bucket_data_;
  // Vertices of the bucket's shell, projected onto the swing plane with the line from pin to tip
  // horizontal, relative to the tip [m].
  std::vector<Vec2> profile_;
  // Edges of the shell as pairs of indices into `profile_`.
  std::vector<std::array<int, 2>> profile_edges_;
};

}  // namespace navvy::control
