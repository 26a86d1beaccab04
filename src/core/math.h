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

// The host computes in double precision. Particles and grids on the device are floats in units of
// cells relative to their block, so that precision does not depend on the size of the site.
using Vec2 = Eigen::Vector2d;
using Vec3 = Eigen::Vector3d;
using Vec2i = Eigen::Vector2i;
using Mat3 = Eigen::Matrix3d;
using Vec6 = Eigen::Matrix<double, 6, 1>;
using Mat6 = Eigen::Matrix<double, 6, 6>;
/// Rigid pose, a rotation and a translation. `X_WB * p_B` is the point p, given in frame B,
/// expressed in frame W. Names include the frames: X_WB transforms from B to W, and v_WB is the
/// velocity of B relative to W, expressed in W. Poses are composed as a chain of frames: X_WB *
/// X_BC = X_WC. A pose contains no scale; code that builds one must keep the rotation orthonormal.
using Pose = Eigen::Isometry3d;

/// Default gravity of scenes [m/s2]: standard gravity, rounded to two decimals. The solver uses the
/// value of the scene.
inline constexpr double kGravity = 9.81;
/// The number pi.
inline constexpr double kPi = std::numbers::pi;
/// Converts degrees to radians. The code uses radians everywhere; degrees occur only in files,
/// options and output.
inline constexpr double radians(double degrees) { return degrees * (kPi / 180.0); }
/// Converts radians to degrees, for output.
inline constexpr double degrees(double radians) { return radians * (180.0 / kPi); }

/// Unit in which all masses are stored as integers, the mass quantum [kg]. It is 2^-24 kg, about 60
/// micrograms. As it is a power of two, a float represents the mass of a particle exactly; a
/// particle in cells of 0.1 m has about 0.2 kg. Sums of integers do not depend on their order, so
/// that the mass balance is exact and runs are repeatable [docs/exchange.md, mass quantum].
inline constexpr double kMassQuantum = 1.0 / (1 << 24);
/// Converts mass quanta to kilograms. The result is exact up to 2^53 quanta, half a million tonnes.
inline double kilograms(std::int64_t units) { return static_cast<double>(units) * kMassQuantum; }
/// Converts kilograms to mass quanta, rounded to the nearest integer, with halves rounded away from
/// zero. The result must be below 2^63.
inline std::int64_t mass_units(double kg) {
  return static_cast<std::int64_t>(std::llround(kg / kMassQuantum));
}

/// Returns the pose with the position x y z [m] and the fixed-axis angles roll, pitch, yaw [rad],
/// as in SDF and URDF: first a rotation by roll about x, then by pitch about y, then by yaw about
/// z, all about the axes of the parent frame.
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
/// Returns true if all elements of X are finite and its rotation is orthonormal to within 1e-6,
/// which allows for the rounding errors that a run accumulates.
inline bool is_rigid(const Pose& X) {
  const Mat3 R = X.linear();
  return X.matrix().allFinite() && (R * R.transpose()).isIdentity(1e-6);
}

/// Returns the angles roll, pitch and yaw of a rotation, as make_pose takes them [rad]: pitch from
/// -pi/2 to pi/2, the others from -pi to pi.
inline Vec3 fixed_angles(const Mat3& R) {
  // Rounding may take the sine slightly beyond one.
  return {std::atan2(R(2, 1), R(2, 2)), std::asin(std::clamp(-R(2, 0), -1.0, 1.0)),
          std::atan2(R(1, 0), R(0, 0))};
}

}  // namespace navvy
