// SPDX-License-Identifier: Apache-2.0
// Drives and steering of machines, one struct per type of drive. The structs hold data only; the
// classes in vehicle/drive/ compute forces and torques from them.
#pragma once

#include <optional>
#include <variant>
#include <vector>

#include "core/limits.h"
#include "scene/fields.h"

namespace navvy::scene {

/// The motor and the brakes that every type of drive has: one motor with a speed governor. SI
/// units.
struct Powertrain {
  double max_speed = 2.5;         ///< top speed, forwards and backwards [m/s]
  double tractive_force = 100e3;  ///< maximum tractive force of all driven wheels together [N]
  double power = 90e3;            ///< maximum power at the wheels [W]
  double brake_force = 150e3;     ///< braking force of all wheels together [N]
  /// Power of one engine that supplies both drive and pump [W]; 0: drive and pump have separate
  /// engines.
  double engine_power = 0;

  /// Passes the fields of the powertrain to the visitor `f`.
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

/// An engine or electric motor that drives the wheels through gears and replaces the governed motor
/// of `Powertrain`. It has either a torque curve, or is a source of speed that holds the commanded
/// speed up to its maximum torque. SI units.
struct CombustionEngine {
  /// Selects the engine model: torque as a function of speed, or commanded speed with limited
  /// torque.
  enum class Kind { kTorqueCurve, kSpeedSource };
  /// One point of the torque curve at full throttle.
  struct Point {
    double speed = 0;   ///< engine speed [rad/s]
    double torque = 0;  ///< torque at the engine speed `speed` [N m]

    /// Passes the fields of a <point> to the visitor `f`.
    void describe(Fields& f) {
      f("speed_rpm", speed, {1, 1e5}, "Engine speed.", kNeeded);
      f("torque_nm", torque, {0, 1e6}, "Torque at full throttle.", kNeeded);
    }
  };
  /// Type of the engine: with a torque curve, or a source of speed.
  Kind kind = Kind::kTorqueCurve;
  std::vector<Point> curve;  ///< torque curve, linear between its points; only for kTorqueCurve
  /// Torque needed to turn an engine with a torque curve without fuel [N m].
  double braking_torque = 0;
  double max_speed = 0;   ///< maximum speed of a speed source [rad/s]
  double max_torque = 0;  ///< maximum torque of a speed source [N m]
  /// Gear ratios: engine speed / speed of the gearbox output shaft [-], first gear first,
  /// decreasing.
  std::vector<double> gears;
  /// Speed of the gearbox output shaft / speed of the differential carrier [-].
  double final_ratio = 1;
  double efficiency = 0.9;  ///< efficiency of all gears together [-]
  /// true: the engine also drives the hydraulic pump, which is served first
  bool shared_with_pump = false;

  /// Passes the fields of an <engine> to the visitor `f`.
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
/// Returns the operating point of a torque curve at which speed x torque, the power, is highest.
CombustionEngine::Point rated_point(const CombustionEngine& engine);

/// A differential, which lets two output shafts turn at different speeds. The locking torque is the
/// excess of the torque on the slower shaft over that on the faster one: zero if the differential
/// is open, unlimited if it is locked, and at most preload + bias x transmitted torque if its slip
/// is limited [Wong 2008, section 5.1].
struct Differential {
  /// Selects how the locking torque is limited.
  enum class Kind { kOpen, kLocked, kLimitedSlip };
  Kind kind = Kind::kOpen;  ///< type of the differential
  double preload = 0;       ///< locking torque without load, for limited slip [N m]
  double bias = 0;          ///< locking torque / transmitted torque, for limited slip [-]

  /// Passes the fields of a differential to the visitor `f`.
  void describe(Fields& f) {
    f("kind", kind,
      {{"open", Kind::kOpen}, {"locked", Kind::kLocked}, {"limited_slip", Kind::kLimitedSlip}},
      "Kind of the differential.", kNeeded);
    f("preload_nm", preload, {0, 1e6}, "Locking torque without load, with limited slip.");
    f("bias", bias, {0, 1}, "Locking torque / torque through it, with limited slip.");
  }
};

/// Drive with steered wheels and differentials between the driven wheels, as of trucks and wheeled
/// excavators.
///
/// The steering command is the bicycle angle: the angle of an imaginary wheel in the middle of the
/// front axle [rad], positive to the left. The origin of the machine's frame lies on the ground
/// below the middle of the rear axle, which is not steered.
struct AckermannDrive : Powertrain {
  static constexpr const char* kName = "ackermann";  ///< value of the attribute `type` in a file
  static constexpr const char* kSteerUnit = "rad";   ///< unit of the steering command
  /// Meaning of the steering command, for people.
  static constexpr const char* kSteerMeaning = "bicycle angle, positive to the left";

  double max_steer = radians(35);   ///< maximum steering angle of the inner wheel [rad]
  double wheelbase = 2.8;           ///< distance between the axles [m]
  double track = 1.94;              ///< distance between the king pins [m]
  double steer_rate = radians(30);  ///< maximum rate of a wheel's steering angle [rad/s]
  Differential axles;               ///< differential between the wheels of each driven axle
  /// Differential between the foremost driven axle and the other driven axles.
  Differential centre;
  /// Engine with gears; empty: the governed motor of `Powertrain` drives the wheels.
  std::optional<CombustionEngine> engine;

  /// Passes the fields of an Ackermann drive to the visitor `f`.
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

/// Drive whose left and right wheels are driven independently, as of mobile robots, skid-steered
/// loaders and crawlers. The steering command is a yaw rate [rad/s], positive to the left; it is
/// available at any speed, even at standstill.
///
/// Wheels whose link has y > 0 belong to the left side. The origin of the machine's frame lies
/// between the driven wheels; the other wheels are casters that swivel freely, or they slip.
struct DifferentialDrive : Powertrain {
  /// Selects what turns the driven wheels of one side: one motor for all of them, which turn at the
  /// same speed as if joined by a chain, or one motor for each wheel.
  enum class SideWheels { kLocked, kIndependent };
  static constexpr const char* kName = "differential";  ///< value of the attribute `type` in a file
  static constexpr const char* kSteerUnit = "rad/s";    ///< unit of the steering command
  /// Meaning of the steering command, for people.
  static constexpr const char* kSteerMeaning = "yaw rate, positive to the left";

  /// Distance between the middles of left and right wheels [m]; for skid-steered machines an
  /// effective value, which includes the effect of lateral slip.
  double track = 0.5;
  /// Coupling of the driven wheels of one side. Independent wheels share the machine's force and
  /// power evenly, so that a wheel in the air takes nothing from the others and lends them nothing.
  SideWheels side_wheels = SideWheels::kLocked;

  /// Passes the fields of a differential drive to the visitor `f`.
  void describe(Fields& f) {
    Powertrain::describe(f);
    f("track_m", track, {0.01, 50}, "Distance between the middles of left and right wheels.",
      kNeeded);
    f("side_wheels", side_wheels,
      {{"locked", SideWheels::kLocked}, {"independent", SideWheels::kIndependent}},
      "Driven wheels of a side: locked by a chain to one motor, or independent, each with a motor "
      "of its own and an even share of force and power.");
  }
};

/// An AckermannDrive whose steering motor turns the two steered wheels through a trapezoid of two
/// steering arms and a tie rod. The axes of the wheels therefore meet only approximately in one
/// turning centre. The steering command is the position of the motor shaft [rad], positive to the
/// left.
struct LinkageDrive : AckermannDrive {
  static constexpr const char* kName = "linkage";   ///< value of the attribute `type` in a file
  static constexpr const char* kSteerUnit = "rad";  ///< unit of the steering command
  static constexpr const char* kSteerMeaning =      ///< meaning of the steering command, for people
      "position of the steering motor, positive to the left";

  double arm = 0.2;       ///< length of a steering arm, from king pin to tie rod [m]
  double tie_rod = 1.77;  ///< length of the tie rod [m]
  bool ahead = false;     ///< true: the arms point ahead of the axle; false: backwards
  double gear_ratio = 1;  ///< turns of the motor / turns of the left king pin [-]

  /// Passes the fields of a drive with a steering linkage to the visitor `f`.
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
/// Returns the vector (x, y) from the left king pin to the tie-rod end of the left arm, in M with
/// the wheels straight [m]. The result is not finite if the tie rod is too short or too long to
/// connect both arms.
Vec2 steering_arm(const LinkageDrive& drive);
/// Returns true if the linkage can turn the inner wheel to `max_steer` without locking, that is
/// without the tie rod and an arm becoming collinear.
bool turns_freely(const LinkageDrive& drive);

/// The drive of a machine, of one of the three types.
using Drive = std::variant<AckermannDrive, DifferentialDrive, LinkageDrive>;

/// Returns the motor and brakes, which all types of drive have.
inline const Powertrain& powertrain(const Drive& drive) {
  return std::visit([](const Powertrain& common) -> const Powertrain& { return common; }, drive);
}

/// Returns the engine of a drive; null if the drive has a governed motor instead.
inline const CombustionEngine* drive_engine(const Drive& drive) {
  const auto* steered = std::get_if<AckermannDrive>(&drive);
  if (steered == nullptr) steered = std::get_if<LinkageDrive>(&drive);
  return steered != nullptr && steered->engine ? &*steered->engine : nullptr;
}

/// Returns the type of the drive as written in a file, e.g. "ackermann".
inline const char* drive_name(const Drive& drive) {
  return std::visit([](const auto& kind) { return kind.kName; }, drive);
}

/// Returns the unit of the steering command of `drive`, e.g. "rad".
inline const char* steer_unit(const Drive& drive) {
  return std::visit([](const auto& kind) { return kind.kSteerUnit; }, drive);
}
/// Returns the meaning of the steering command of `drive`, in words for people.
inline const char* steer_meaning(const Drive& drive) {
  return std::visit([](const auto& kind) { return kind.kSteerMeaning; }, drive);
}

/// Passes the attribute `type` of a <navvy:drive> and the fields of that type to the visitor `f`.
/// If `f` chooses another type, `drive` is replaced by a drive of that type with default values.
void describe_drive(Fields& f, Drive& drive);

}  // namespace navvy::scene
