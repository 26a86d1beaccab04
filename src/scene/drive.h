// SPDX-License-Identifier: Apache-2.0
// Drives and steering of machines, one struct per kind. Plain data: vehicle/drive/ computes them.
#pragma once

#include <optional>
#include <variant>
#include <vector>

#include "core/limits.h"
#include "scene/fields.h"

namespace navvy::scene {

/// The motor and the brakes of every drive: one motor with a speed governor. SI units.
struct Powertrain {
  double max_speed = 2.5;
  double tractive_force = 100e3;
  double power = 90e3;
  double brake_force = 150e3;
  double engine_power = 0;  ///< [W]; 0: drive and pump have engines of their own

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

/// A combustion engine or motor that turns a drive line through gears, in place of the governed
/// motor: either with a torque curve, or a source of speed up to its largest torque. SI units.
struct CombustionEngine {
  enum class Kind { kTorqueCurve, kSpeedSource };
  struct Point {
    double speed = 0;   ///< [rad/s]
    double torque = 0;  ///< [N m]

    void describe(Fields& f) {
      f("speed_rpm", speed, {1, 1e5}, "Engine speed.", kNeeded);
      f("torque_nm", torque, {0, 1e6}, "Torque at full throttle.", kNeeded);
    }
  };
  Kind kind = Kind::kTorqueCurve;
  std::vector<Point> curve;  ///< linear between the points
  double braking_torque = 0;
  double max_speed = 0;       ///< [rad/s]
  double max_torque = 0;      ///< [N m]
  std::vector<double> gears;  ///< falling
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
/// Returns the point of greatest power of a torque curve.
CombustionEngine::Point rated_point(const CombustionEngine& engine);

/// Lets two shafts of a drive line turn at different speeds. The slower one gets more torque than
/// the faster one by the locking torque: zero if open, any if locked, and at most preload + bias x
/// the torque through it with limited slip [Wong 2008, section 5.1].
struct Differential {
  enum class Kind { kOpen, kLocked, kLimitedSlip };
  Kind kind = Kind::kOpen;
  double preload = 0;  ///< [N m]
  double bias = 0;

  void describe(Fields& f) {
    f("kind", kind,
      {{"open", Kind::kOpen}, {"locked", Kind::kLocked}, {"limited_slip", Kind::kLimitedSlip}},
      "Kind of the differential.", kNeeded);
    f("preload_nm", preload, {0, 1e6}, "Locking torque without load, with limited slip.");
    f("bias", bias, {0, 1}, "Locking torque / torque through it, with limited slip.");
  }
};

/// A differential between the driven wheels, and steered wheels: trucks, wheeled excavators.
///
/// It steers by a bicycle angle: that of one wheel in the middle of the front axle [rad], positive
/// to the left. The origin of the machine's frame is on the ground under the middle of the rear
/// axle, which is not steered.
struct AckermannDrive : Powertrain {
  static constexpr const char* kName = "ackermann";  ///< type in a file
  static constexpr const char* kSteerUnit = "rad";
  static constexpr const char* kSteerMeaning = "bicycle angle, positive to the left";

  double max_steer = radians(35);  ///< [rad]
  double wheelbase = 2.8;
  double track = 1.94;
  double steer_rate = radians(30);         ///< [rad/s]
  Differential axles;                      ///< between the wheels of each driven axle
  Differential centre;                     ///< between the foremost driven axle and the others
  std::optional<CombustionEngine> engine;  ///< without: the governed motor of Powertrain

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

/// Left and right wheels driven each side by itself: mobile robots, skid-steered loaders, crawlers.
/// It steers by a yaw rate [rad/s], positive to the left, at any speed, also on the spot.
///
/// The driven wheels of a side turn alike. Those with their link at y > 0 are the left side. The
/// origin of the machine's frame is between the driven wheels; others are casters that swivel
/// freely, or slip.
struct DifferentialDrive : Powertrain {
  static constexpr const char* kName = "differential";
  static constexpr const char* kSteerUnit = "rad/s";
  static constexpr const char* kSteerMeaning = "yaw rate, positive to the left";

  double track = 0.5;  ///< [m]; of skid-steered machines an effective one

  void describe(Fields& f) {
    Powertrain::describe(f);
    f("track_m", track, {0.01, 50}, "Distance between the middles of left and right wheels.",
      kNeeded);
  }
};

/// An AckermannDrive whose motor turns the two steered wheels through a trapezoid of arms and tie
/// rod, which meets a common centre only nearly. It steers by the motor's position [rad, at the
/// motor], positive to the left.
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
/// Returns the end of the left arm in M, from the left king pin, with the wheels straight [m]. It
/// is not finite if the tie rod does not reach.
Vec2 steering_arm(const LinkageDrive& drive);
/// Returns true if the linkage turns the inner wheel to `max_steer` without locking.
bool turns_freely(const LinkageDrive& drive);

using Drive = std::variant<AckermannDrive, DifferentialDrive, LinkageDrive>;

/// Returns the fields that all kinds share.
inline const Powertrain& powertrain(const Drive& drive) {
  return std::visit([](const Powertrain& common) -> const Powertrain& { return common; }, drive);
}

/// Returns the engine of a drive, null if it has a governed motor.
inline const CombustionEngine* drive_engine(const Drive& drive) {
  const auto* steered = std::get_if<AckermannDrive>(&drive);
  if (steered == nullptr) steered = std::get_if<LinkageDrive>(&drive);
  return steered != nullptr && steered->engine ? &*steered->engine : nullptr;
}

/// Returns the type of the drive as a file writes it.
inline const char* drive_name(const Drive& drive) {
  return std::visit([](const auto& kind) { return kind.kName; }, drive);
}

/// Returns the unit of the steer command of this drive.
inline const char* steer_unit(const Drive& drive) {
  return std::visit([](const auto& kind) { return kind.kSteerUnit; }, drive);
}
/// Returns the meaning of the steer command of this drive.
inline const char* steer_meaning(const Drive& drive) {
  return std::visit([](const auto& kind) { return kind.kSteerMeaning; }, drive);
}

/// Lists the type of a drive and the fields of this type.
void describe_drive(Fields& f, Drive& drive);

}  // namespace navvy::scene
