// SPDX-License-Identifier: Apache-2.0
// How a machine's wheels are driven and steered, one struct a kind. Plain data: what a kind does
// stands in vehicle/drive/, how it is written in a file in scene_io/drive_reader.cpp.
#pragma once

#include <optional>
#include <variant>
#include <vector>

#include "core/math.h"

namespace navvy::scene {

/// What every kind of drive has: one motor with a speed governor, and brakes.
struct Powertrain {
  double max_speed = 2.5;         ///< [m/s], forwards and backwards
  double tractive_force = 100e3;  ///< all driven wheels together [N]
  double power = 90e3;            ///< at the wheels [W]
  double brake_force = 150e3;     ///< all wheels together, each braked [N]
  /// Of an engine that also drives the pump, for both together [W]; 0: the drive's own.
  double engine_power = 0;
};

/// An engine that turns a drive line through gears, in place of the governed motor: either one with
/// a torque curve, or a source of speed, which keeps to its speed up to its largest torque.
struct CombustionEngine {
  enum class Kind { kTorqueCurve, kSpeedSource };
  struct Point {
    double speed = 0;   ///< [rad/s]
    double torque = 0;  ///< at full throttle [N m]
  };
  Kind kind = Kind::kTorqueCurve;
  std::vector<Point> curve;   ///< from idle to the governed speed, linear between
  double braking_torque = 0;  ///< with a torque curve: that takes to turn it without fuel [N m]
  double max_speed = 0;       ///< of a source of speed [rad/s]
  double max_torque = 0;      ///< likewise [N m]
  /// falling: turns of the engine for one of the shaft behind the gears.
  std::vector<double> gears;
  double final_ratio = 1;   ///< of that shaft for one of the differential's cage
  double efficiency = 0.9;  ///< of all gears together [-]
};
/// Where the curve's torque x speed is largest.
CombustionEngine::Point rated_point(const CombustionEngine& engine);

/// What lets two shafts of a drive line turn at different speeds. The slower one gets more torque
/// than the faster one by the locking torque: none of an open one, whatever it takes of a locked
/// one, and of one with limited slip at most preload + bias x the torque that goes through it
/// [Wong 2008, section 5.1].
struct Differential {
  enum class Kind { kOpen, kLocked, kLimitedSlip };
  Kind kind = Kind::kOpen;
  double preload = 0;  ///< [N m]
  double bias = 0;     ///< [-]
};

/// A differential between the driven wheels, and wheels that are turned to steer: trucks, wheeled
/// excavators.
///
/// It steers by a bicycle angle: that of one wheel in the middle of the front axle [rad], positive
/// to the left. The machine's frame stands on the ground under the middle of the rear axle, which
/// is not steered.
struct AckermannDrive : Powertrain {
  static constexpr const char* kName = "ackermann";  ///< type in a file
  static constexpr const char* kSteerUnit = "rad";
  static constexpr const char* kSteerMeaning = "bicycle angle, positive to the left";

  double max_steer = radians(35);          ///< of the inner wheel [rad]
  double wheelbase = 2.8;                  ///< [m]
  double track = 1.94;                     ///< between king pins [m]
  double steer_rate = radians(30);         ///< of a steered wheel [rad/s]
  Differential axles;                      ///< between the wheels of each driven axle
  Differential centre;                     ///< between the foremost driven axle and the others
  std::optional<CombustionEngine> engine;  ///< without: the governed motor of Powertrain
};

/// Left and right wheels driven each side by itself: most mobile robots, skid-steered loaders. It
/// steers by a yaw rate [rad/s], positive to the left, at any speed: it also turns on the spot.
///
/// The driven wheels of a side turn alike. Those with their link left of the machine's middle (y >
/// 0) are the left side. The machine's frame stands between the driven wheels; others, if any, are
/// casters that swivel freely, or slip.
struct DifferentialDrive : Powertrain {
  static constexpr const char* kName = "differential";
  static constexpr const char* kSteerUnit = "rad/s";
  static constexpr const char* kSteerMeaning = "yaw rate, positive to the left";

  /// Between the middles of left and right wheels [m]; of skid-steered machines an effective one.
  double track = 0.5;
};

/// As AckermannDrive, but one motor turns the two steered wheels through a trapezoid of arms and
/// tie rod, which meets a common centre only nearly. It steers by the motor's position
/// [rad, at the motor], positive to the left.
struct LinkageDrive : AckermannDrive {
  static constexpr const char* kName = "linkage";
  static constexpr const char* kSteerUnit = "rad";
  static constexpr const char* kSteerMeaning =
      "position of the steering motor, positive to the left";

  double arm = 0.2;       ///< from a king pin to the tie rod [m]
  double tie_rod = 1.77;  ///< [m]; shorter than the track behind the axle, longer ahead of it
  bool ahead = false;     ///< the arms point ahead, else backwards
  double gear_ratio = 1;  ///< turns of the motor for one of the left wheel's king pin
};
/// From the left king pin to its arm's end in M with the wheels straight [m]; not finite where the
/// tie rod does not reach.
Vec2 steering_arm(const LinkageDrive& drive);
/// Whether the linkage turns the inner wheel as far as `max_steer` without locking.
bool turns_freely(const LinkageDrive& drive);

using Drive = std::variant<AckermannDrive, DifferentialDrive, LinkageDrive>;

/// What all kinds share.
inline const Powertrain& powertrain(const Drive& drive) {
  return std::visit([](const Powertrain& common) -> const Powertrain& { return common; }, drive);
}

/// Its engine, null where the drive has a governed motor.
inline const CombustionEngine* drive_engine(const Drive& drive) {
  const auto* steered = std::get_if<AckermannDrive>(&drive);
  if (steered == nullptr) steered = std::get_if<LinkageDrive>(&drive);
  return steered != nullptr && steered->engine ? &*steered->engine : nullptr;
}

/// Name of the kind in a file.
inline const char* drive_name(const Drive& drive) {
  return std::visit([](const auto& kind) { return kind.kName; }, drive);
}

/// Unit and meaning of the steer command of this drive, for inputs that carry it by name.
inline const char* steer_unit(const Drive& drive) {
  return std::visit([](const auto& kind) { return kind.kSteerUnit; }, drive);
}
inline const char* steer_meaning(const Drive& drive) {
  return std::visit([](const auto& kind) { return kind.kSteerMeaning; }, drive);
}

}  // namespace navvy::scene
