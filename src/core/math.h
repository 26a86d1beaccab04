// SPDX-License-Identifier: Apache-2.0
// Vectors, poses and the few constants everybody shares. SI units, right-handed frames, z up.
#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <numbers>

namespace navvy {

// Everything on the host is in doubles. Particles and grids on the device are floats, in units of
// the cell within a block, so that a site of kilometres costs no bits.
using Vec2 = Eigen::Vector2d;
using Vec3 = Eigen::Vector3d;
using Vec2i = Eigen::Vector2i;
using Vec3i = Eigen::Vector3i;
using Mat3 = Eigen::Matrix3d;
using Vec6 = Eigen::Matrix<double, 6, 1>;
using Mat6 = Eigen::Matrix<double, 6, 6>;
/// Rigid pose; `X_WB * p_B` is the point p given in B, expressed in W. Names carry their frames:
/// X_WB takes B to W, v_WB is the velocity of B measured and expressed in W. There is no scale in
/// it, and code that builds one must keep the turn orthonormal. Composition reads like a chain of
/// frames: X_WB * X_BC is X_WC.
using Pose = Eigen::Isometry3d;

// Standard gravity rounded to two decimals, what scenes default to; the solver takes what the scene
// says.
inline constexpr double kGravity = 9.81;  ///< [m/s^2]
inline constexpr double kPi = std::numbers::pi;
/// Angles are radians everywhere inside; degrees occur at the edges only, in files, options and
/// prints.
inline constexpr double radians(double degrees) { return degrees * (kPi / 180.0); }
/// For prints and files only.
inline constexpr double degrees(double radians) { return radians * (180.0 / kPi); }

/// Mass is counted in integers of this quantum [kg], a power of two so that float holds a
/// particle's mass exactly. 2^-24 kg is 60 micrograms, and a particle of a 0.1 m cell weighs about
/// 0.2 kg. Sums of such integers depend on no order, which is what makes the ledger exact and runs
/// repeatable [docs/exchange.md, mass quantum].
inline constexpr double kMassQuantum = 1.0 / (1 << 24);
/// Exact up to 2^53 quanta, half a million tonnes.
inline double kilograms(std::int64_t units) { return static_cast<double>(units) * kMassQuantum; }
/// Rounded to the nearest quantum, half away from zero. The caller sees to it that 2^63 quanta are
/// enough.
inline std::int64_t mass_units(double kg) {
  return static_cast<std::int64_t>(std::llround(kg / kMassQuantum));
}

/// Pose from x y z [m], roll pitch yaw [rad], fixed-axis order as in SDF and URDF. Roll about x is
/// applied first, then pitch about y, then yaw about z, all about the axes of the parent frame.
inline Pose make_pose(double x, double y, double z, double roll = 0, double pitch = 0,
                      double yaw = 0) {
  Pose X = Pose::Identity();
  // Yaw stands on the left, as it is the last to turn.
  X.linear() = (Eigen::AngleAxisd(yaw, Vec3::UnitZ()) * Eigen::AngleAxisd(pitch, Vec3::UnitY()) *
                Eigen::AngleAxisd(roll, Vec3::UnitX()))
                   .toRotationMatrix();
  X.translation() = Vec3(x, y, z);
  return X;
}
/// Whether X is finite and its turn orthonormal up to the rounding that a run gathers.
inline bool is_rigid(const Pose& X) {
  const Mat3 R = X.linear();
  return X.matrix().allFinite() && (R * R.transpose()).isIdentity(1e-6);
}

/// Roll, pitch and yaw of a turn, as make_pose takes them [rad]: pitch within +-pi/2, the others
/// within +-pi.
inline Vec3 fixed_angles(const Mat3& R) {
  // Rounding may take the sine a hair past one.
  return {std::atan2(R(2, 1), R(2, 2)), std::asin(std::clamp(-R(2, 0), -1.0, 1.0)),
          std::atan2(R(1, 0), R(0, 0))};
}

}  // namespace navvy
