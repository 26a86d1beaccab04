// SPDX-License-Identifier: Apache-2.0
// Drives and steering of machines, one struct per kind. Plain data: vehicle/drive/ computes them.
#pragma once

#include <optional>
#include <variant>
#include <vector>

#include "core/limits.h"
#include "scene/fields.h"

namespace navvy::scene {

/// Motor and brakes of a drive: one motor with a speed governor, in SI units. All types of drives
/// have these fields.
struct Powertrain {
  double max_speed = 2.5;
  double tractive_force = 100e3;
  double power = 90e3;
  double brake_force = 150e3;
  /// Power of an engine that drives both wheels and pump [W]; 0 if each has an engine of its own.
  double engine_power = 0;

  void describe(Fields& f) {
    f("max_speed_m_per_s", max_speed, {0.01, 50}, "Top speed, forwards and backwards.");
    f("tractive_force_n", tractive_force, {0.1, 1e7},
      "Greatest tractive force of all driven wheels together.");
    f("power_w", power, {0.1, 1e7}, "Greatest power at the wheels.");
    f("brake_force_n", brake_force, {0, 1e7}, "Braking force of all wheels together.");
    f("engine_power_w", engine_power, {0.1, 1e7},
      "Power of one engine for drive and pump, which is served first; 0: each has its own.");
  }
};

/// An engine with gears that replaces the governed motor of a drive, in SI units. It has either a
/// torque curve or a constant speed up to its maximum torque (speed source).
struct CombustionEngine {
  enum class Kind { kTorqueCurve, kSpeedSource };
  struct Point {
    /// Engine speed [rad/s].
    double speed = 0;
    /// Torque at full throttle [N m].
    double torque = 0;

    void describe(Fields& f) {
      f("speed_rpm", speed, {1, 1e5}, "Engine speed.", kNeeded);
      f("torque_nm", torque, {0, 1e6}, "Torque at full throttle.", kNeeded);
    }
  };
  Kind kind = Kind::kTorqueCurve;
  /// Points of the torque curve, by rising speed; linear in between.
  std::vector<Point> curve;
  double braking_torque = 0;
  /// Maximum speed of a speed source [rad/s].
  double max_speed = 0;
  /// Maximum torque of a speed source [N m].
  double max_torque = 0;
  /// Ratios of the gears (engine speed / output speed), from the first gear to the last; each is
  /// smaller than the one before.
  std::vector<double> gears;
  double final_ratio = 1;
  double efficiency = 0.9;
  bool shared_with_pump = false;

  void describe(Fields& f) {
    f("kind", kind, {{"torque_curve", Kind::kTorqueCurve}, {"speed_source", Kind::kSpeedSource}},
      "Kind of the engine.", kNeeded);
    f("point", curve, limits::kLinks,
      "Points of a torque curve, two or more, from idle to the governed speed.");
    f("braking_torque_nm", braking_torque, {0, 1e6},
      "Torque that turns an engine with a torque curve without fuel; needed with one.");
    f("shared_with_pump", shared_with_pump,
      "An engine with a torque curve also drives the pump, which is served first.");
    f("max_speed_rpm", max_speed, {1, 1e5}, "Top speed of a speed source; needed with one.");
    f("max_torque_nm", max_torque, {1e-4, 1e6}, "Top torque of a speed source; needed with one.");
    f("gear_ratios", gears, {0.001, 1e4},
      "Engine speed / speed of the shaft behind the gears, falling from the first gear.", kNeeded);
    f("final_ratio", final_ratio, {0.001, 1e4},
      "Speed of the shaft behind the gears / speed of the differential carrier.");
    f("efficiency", efficiency, {0.05, 1}, "Efficiency of all gears together.");
  }
};
/// Returns the point of maximum power on the engine's torque curve.
CombustionEngine::Point rated_point(const CombustionEngine& engine);

/// Lets two shafts of a drive line turn at different speeds. The slower shaft gets more torque than
/// the faster one; the difference is the locking torque. It is zero for an open differential,
/// unlimited for a locked one, and with limited slip at most preload + bias x transmitted torque
/// [Wong 2008, section 5.1].
struct Differential {
  enum class Kind { kOpen, kLocked, kLimitedSlip };
  Kind kind = Kind::kOpen;
  /// Locking torque without load [N m], with limited slip.
  double preload = 0;
  double bias = 0;

  void describe(Fields& f) {
    f("kind", kind,
      {{"open", Kind::kOpen}, {"locked", Kind::kLocked}, {"limited_slip", Kind::kLimitedSlip}},
      "Kind of the differential.", kNeeded);
    f("preload_nm", preload, {0, 1e6}, "Locking torque without load, with limited slip.");
    f("bias", bias, {0, 1}, "Locking torque / torque through it, with limited slip.");
  }
};

/// Drive of trucks and wheeled excavators: steered front wheels, and a differential between the
/// driven wheels.
///
/// The steering command is a bicycle angle [rad], positive to the left: the angle of one virtual
/// wheel in the middle of the front axle. The machine frame's origin is on the ground below the
/// middle of the rear axle, which is not steered.
struct AckermannDrive : Powertrain {
  static constexpr const char* kName = "ackermann";  ///< type in a file
  static constexpr const char* kSteerUnit = "rad";
  static constexpr const char* kSteerMeaning = "bicycle angle, positive to the left";

  /// Maximum steering angle of the inner wheel [rad].
  double max_steer = radians(35);
  double wheelbase = 2.8;
  double track = 1.94;
  /// Maximum steering rate of a wheel [rad/s].
  double steer_rate = radians(30);
  /// Differential between the wheels of each driven axle.
  Differential axles;
  /// Differential between the foremost driven axle and the other driven axles.
  Differential centre;
  /// Engine with gears; if empty, the drive has the governed motor of Powertrain.
  std::optional<CombustionEngine> engine;

  void describe(Fields& f) {
    Powertrain::describe(f);
    f("max_steer_deg", max_steer, {0, 80}, "Greatest steering angle of the inner wheel.");
    f("wheelbase_m", wheelbase, {0.01, 50}, "Distance between the axles.");
    f("track_m", track, {0.01, 50}, "Distance between the king pins.");
    f("steer_rate_deg_per_s", steer_rate, {0.1, 1000}, "Steering rate of a wheel.");
    f("axle_differential", axles, "Differential between the wheels of each driven axle.");
    f("centre_differential", centre,
      "Differential between the foremost driven axle and the others.");
    f("engine", engine,
      "Engine with gears, in place of tractive_force_n, power_w and engine_power_w.");
  }
};

/// Drive of mobile robots, skid-steered loaders and crawlers: left and right wheels are driven
/// independently. The steering command is a yaw rate [rad/s], positive to the left; the machine can
/// also turn on the spot.
///
/// All driven wheels of a side turn at the same speed. Wheels whose link has y > 0 in the machine
/// frame are on the left side. The machine frame's origin is between the driven wheels. Other
/// wheels are casters, which swivel freely, or they slip.
struct DifferentialDrive : Powertrain {
  static constexpr const char* kName = "differential";
  static constexpr const char* kSteerUnit = "rad/s";
  static constexpr const char* kSteerMeaning = "yaw rate, positive to the left";

  /// Distance between the middles of left and right wheels [m]; an effective value for skid-steered
  /// machines.
  double track = 0.5;

  void describe(Fields& f) {
    Powertrain::describe(f);
    f("track_m", track, {0.01, 50}, "Distance between the middles of left and right wheels.",
      kNeeded);
  }
};

/// An AckermannDrive in which one motor turns both steered wheels through a trapezoidal linkage of
/// two arms and a tie rod. The wheel axes then intersect only approximately in one point. The
/// steering command is the motor's position [rad], positive to the left.
struct LinkageDrive : AckermannDrive {
  static constexpr const char* kName = "linkage";
  static constexpr const char* kSteerUnit = "rad";
  static constexpr const char* kSteerMeaning =
      "position of the steering motor, positive to the left";

  double arm = 0.2;
  double tie_rod = 1.77;
  bool ahead = false;
  double gear_ratio = 1;

  void describe(Fields& f) {
    AckermannDrive::describe(f);
    f("arm_m", arm, {0.001, 5}, "Distance from a king pin to the tie rod.", kNeeded);
    f("tie_rod_m", tie_rod, {0.01, 50},
      "Length of the tie rod; shorter than the track behind the axle, longer ahead of it.",
      kNeeded);
    f("ahead", ahead, "The arms point ahead of the axle, not backwards.");
    f("gear_ratio", gear_ratio, {0.001, 1e4}, "Turns of the motor / turns of the left king pin.");
  }
};
/// Returns the vector from the left king pin to the end of the left steering arm, in the machine
/// frame [m], with the wheels straight. Its components are not finite if the tie rod is too short
/// or too long.
Vec2 steering_arm(const LinkageDrive& drive);
/// Returns true if the linkage can turn the inner wheel to `max_steer` without locking.
bool turns_freely(const LinkageDrive& drive);

using Drive = std::variant<AckermannDrive, DifferentialDrive, LinkageDrive>;

/// Returns the fields that all types of drives share.
inline const Powertrain& powertrain(const Drive& drive) {
  return std::visit([](const Powertrain& common) -> const Powertrain& { return common; }, drive);
}

/// Returns the drive's engine with gears; null if the drive has a governed motor.
inline const CombustionEngine* drive_engine(const Drive& drive) {
  const auto* steered = std::get_if<AckermannDrive>(&drive);
  if (steered == nullptr) steered = std::get_if<LinkageDrive>(&drive);
  return steered != nullptr && steered->engine ? &*steered->engine : nullptr;
}

/// Returns the drive's type as written in scene files, e.g. "ackermann".
inline const char* drive_name(const Drive& drive) {
  return std::visit([](const auto& kind) { return kind.kName; }, drive);
}

/// Returns the unit of the drive's steering command: "rad" or "rad/s".
inline const char* steer_unit(const Drive& drive) {
  return std::visit([](const auto& kind) { return kind.kSteerUnit; }, drive);
}
/// Returns a short description of the drive's steering command.
inline const char* steer_meaning(const Drive& drive) {
  return std::visit([](const auto& kind) { return kind.kSteerMeaning; }, drive);
}

/// Visits the attribute `type` of a drive and the fields of the drive's current type.
void describe_drive(Fields& f, Drive& drive);

}  // namespace navvy::scene
