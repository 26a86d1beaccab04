// SPDX-License-Identifier: Apache-2.0
// What an operator is told to do, step by step.
#pragma once

#include <string>
#include <variant>
#include <vector>

#include "core/math.h"

namespace navvy::scene {

/// Drive (rear-wheel drive, Ackermann steering) until the machine's origin is at `target`, facing `heading`. Where no
/// heading is given, it ends as it arrives.
struct DriveTo {
  Vec2 target = Vec2::Zero();  ///< [m] in W
  bool has_heading = false;
  double heading = 0;       ///< [rad]
  double speed = 1.0;       ///< [m/s]; negative: backwards
  double tolerance = 0.15;  ///< [m]
};

/// Dig a straight trench by whole cycles (scoop, swing, dump, return) until floor and length are reached.
struct Dig {
  Vec2 from = Vec2::Zero(),
       to = Vec2::Zero();       ///< ends of the centre line at the surface [m] in W; far end first or not
  double depth = 0.8;           ///< below the surface at the start [m]
  double width = 1.05;          ///< one bucket wide by default [m]
  Vec2 dump_at = Vec2::Zero();  ///< where the spoil goes [m] in W
  double dump_height = 1.5;     ///< tip clearance over the ground there [m]
  double pass_depth = 0.25;     ///< depth of one slice [m]
  int max_cycles = 60;
};

/// Turn the upper structure to this angle of the swing joint, the bucket held.
struct Swing {
  double angle = 0;  ///< [rad]
};

/// Open the bucket where it is, then curl back.
struct Dump {
  double hold = 1.0;  ///< [s]
};

struct Wait {
  double duration = 1;  ///< [s]
};

/// Tip the bed to an angle of its joint, at the pace its cylinder allows, and keep it there for a while. It stays until
/// the next tip, also while the machine drives.
struct Tip {
  double angle = 0;  ///< [rad]
  double hold = 0;   ///< after it has arrived [s]
};

/// Wait until another machine of the world has done some or all steps of its program. That machine must not wait for
/// this one in turn: the loader looks for such circles.
struct WaitFor {
  std::string machine;
  int steps = 0;          ///< 0: all
  double longest = 3600;  ///< then it goes on, with a warning [s]
};

/// Open-loop joint positions over time, linear between knots; times count from the start of this step.
struct Trajectory {
  std::vector<std::string> joints;
  std::vector<double> times;                   ///< [s], increasing
  std::vector<std::vector<double>> positions;  ///< [knot][joint], [rad] or [m]
};

using ProgramStep = std::variant<DriveTo, Dig, Swing, Dump, Wait, Tip, WaitFor, Trajectory>;

/// Steps of one machine, done one after the other.
struct Program {
  std::vector<ProgramStep> steps;
  std::vector<int> lines;  ///< line in the scene file of each step, for messages; may be empty
};

}  // namespace navvy::scene
