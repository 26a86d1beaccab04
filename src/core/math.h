// SPDX-License-Identifier: Apache-2.0
// Vectors, poses and common constants. SI units, right-handed frames, z up.
#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <numbers>

namespace navvy {

// The host computes in doubles. Particles and grids on the device are floats in cells relative to
// their block, so that precision does not depend on the size of the site.
using Vec2 = Eigen::Vector2d;
using Vec3 = Eigen::Vector3d;
using Vec2i = Eigen::Vector2i;
using Mat3 = Eigen::Matrix3d;
using Vec6 = Eigen::Matrix<double, 6, 1>;
using Mat6 = Eigen::Matrix<double, 6, 6>;
/// Rigid pose: `X_WB * p_B` is the point p, given in B, expressed in W. Names hold their frames:
/// X_WB takes B to W, v_WB is the velocity of B measured and expressed in W. It contains no scale;
/// code that builds one must keep the rotation orthonormal. Poses compose as a chain of frames:
/// X_WB * X_BC is X_WC.
using Pose = Eigen::Isometry3d;

/// Standard gravity rounded to two decimals [m/s2], the default of scenes; the solver uses the
/// scene's value.
inline constexpr double kGravity = 9.81;
inline constexpr double kPi = std::numbers::pi;
/// Converts degrees to radians. Code uses radians throughout; degrees occur in files, options and
/// output only.
inline constexpr double radians(double degrees) { return degrees * (kPi / 180.0); }
/// Converts radians to degrees, for output.
inline constexpr double degrees(double radians) { return radians * (180.0 / kPi); }

/// Quantum of mass [kg]: mass is counted in integers of it. It is a power of two, 2^-24 kg or 60
/// micrograms, so that a float holds a particle's mass exactly; a particle in a 0.1 m cell has
/// about 0.2 kg. Sums of integers do not depend on their order, which makes the ledger exact and
/// runs repeatable [docs/exchange.md, mass quantum].
inline constexpr double kMassQuantum = 1.0 / (1 << 24);
/// Converts quanta to kilograms; exact up to 2^53 quanta, half a million tonnes.
inline double kilograms(std::int64_t units) { return static_cast<double>(units) * kMassQuantum; }
/// Converts kilograms to quanta, rounded to the nearest, halves away from zero. The result must be
/// below 2^63.
inline std::int64_t mass_units(double kg) {
  return static_cast<std::int64_t>(std::llround(kg / kMassQuantum));
}

/// Returns the pose with position x y z [m] and fixed-axis angles roll, pitch, yaw [rad], as in SDF
/// and URDF: roll about x is applied first, then pitch about y, then yaw about z, all about the
/// axes of the parent frame.
inline Pose make_pose(double x, double y, double z, double roll = 0, double pitch = 0,
                      double yaw = 0) {
  Pose X = Pose::Identity();
  // Yaw is applied last, so it is leftmost.
  X.linear() = (Eigen::AngleAxisd(yaw, Vec3::UnitZ()) * Eigen::AngleAxisd(pitch, Vec3::UnitY()) *
                Eigen::AngleAxisd(roll, Vec3::UnitX()))
                   .toRotationMatrix();
  X.translation() = Vec3(x, y, z);
  return X;
}
/// Returns true if X is finite and its rotation is orthonormal within the rounding that a run
/// accumulates.
inline bool is_rigid(const Pose& X) {
  const Mat3 R = X.linear();
  return X.matrix().allFinite() && (R * R.transpose()).isIdentity(1e-6);
}

/// Returns roll, pitch and yaw of a rotation as make_pose takes them [rad]: pitch within +-pi/2,
/// the others within +-pi.
inline Vec3 fixed_angles(const Mat3& R) {
  // Rounding may take the sine slightly beyond one.
  return {std::atan2(R(2, 1), R(2, 2)), std::asin(std::clamp(-R(2, 0), -1.0, 1.0)),
          std::atan2(R(1, 0), R(0, 0))};
}

}  // namespace navvy
