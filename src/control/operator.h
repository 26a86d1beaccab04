// SPDX-License-Identifier: Apache-2.0
// The built-in operator: runs a program of the scene by joint and drive commands, seeing only what a cab has.
#pragma once

#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "control/surface.h"
#include "core/error.h"
#include "core/hash.h"
#include "core/state_io.h"
#include "heightfield/ground.h"
#include "scene/machine.h"
#include "scene/program.h"
#include "vehicle/machine_state.h"

namespace navvy::control {

/// How far a machine's program has come.
struct Progress {
  int done = 0, steps = 0;
};

/// What the operator knows at one control step.
struct Observation {
  std::vector<vehicle::JointState> joints;  ///< as in scene::Machine::joints
  Pose X_WB = Pose::Identity();             ///< base link
  Vec3 v_WB = Vec3::Zero();                 ///< [m/s]
  const heightfield::Ground* ground = nullptr;
  const SurfaceView* surface = nullptr;  ///< the ground with loose soil on it; null: the resting ground alone
  double payload = 0;                    ///< soil in the bucket [kg]
  double force = 0;                      ///< low-passed soil force on the bucket [N]
  const std::map<std::string, Progress>* programs = nullptr;  ///< of all machines of the world, by name
};

/// What it wants; joints without an entry keep their last command.
struct Command {
  std::vector<std::optional<vehicle::JointInput>> joints;
  std::optional<vehicle::DriveInput> drive;
};

/// Moments of a digging cycle and of a tip, told once each.
enum class CycleEvent { kNone, kScoopStart, kLiftOut, kDumpStart, kCycleEnd, kTipStart, kTipEnd };

/// Runs one machine's program.
///
/// Deterministic: a function of its state and the observations. Never hangs: every phase has a time limit, after which
/// it says so in the log and goes on.
class Operator {
 public:
  /// @throws InputError when the machine lacks what the program needs.
  Operator(const scene::Machine& machine, const scene::Program& program);
  ~Operator();
  Operator(Operator&&) noexcept;

  /// `time` [s] simulated, `dt` [s] since the last call.
  Command update(const Observation& seen, double time, double dt);
  bool done() const;
  /// "drive", "return", "approach", "penetrate", "drag", "curl", "lift", "swing", "dump", "look", "wait", "tip",
  /// "wait_for", "trajectory" or "idle".
  const std::string& phase() const;
  int cycles() const;
  /// Steps of the program that are done, and how many it has.
  Progress progress() const;
  /// The event of the last update.
  CycleEvent event() const;

  void hash(StateHash& hash) const;
  void save(StateWriter& writer) const;
  void load(StateReader& reader);

 private:
  struct State;
  std::unique_ptr<State> state_;
};

/// Every target of the program that cannot be reached from where the machine will then stand: needed and possible
/// distances. `X_WB` is the base link's pose at the start, `surface` the ground that digs and drives look at.
std::vector<Fault> check_reach(const scene::Machine& machine, const scene::Program& program, const Pose& X_WB,
                               const SurfaceView& surface, const std::string& file);

/// Poses of the base link where a program makes the machine stand: `X_WB` at the start, then the end of every drive.
std::vector<Pose> stations(const scene::Machine& machine, const scene::Program& program, const Pose& X_WB,
                           const SurfaceView& surface);

}  // namespace navvy::control
