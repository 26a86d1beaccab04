// SPDX-License-Identifier: Apache-2.0
// A world with the built-in operators that run the programs of its scene.
#pragma once

#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "control/operator.h"
#include "sim/world.h"

namespace navvy::sim {

/// One scoop-swing-dump cycle of a machine; times [s] simulated, masses [kg].
struct Cycle {
  int machine = 0;
  double start = 0, lift_out = 0, dump_start = 0, end = 0;
  double payload_lift_out = 0, payload_dump = 0;
  double force_peak = 0;  ///< largest low-passed soil force on the bucket [N]
};

/// One tip of a machine's bed; times [s] simulated, masses [kg].
struct BedTip {
  int machine = 0;
  double start = 0, end = 0;
  double payload_start = 0, payload_end = 0;  ///< in the bed
};

/// Soil force on buckets over all steps in contact.
struct ForceStatistics {
  double peak = 0;  ///< of the low-passed force [N]
  double sum = 0;   ///< of |force| x steps in contact
  std::uint64_t steps = 0;
  double rock_peak = 0;     ///< of rock on any shell, low-passed [N]
  double residual_max = 0;  ///< largest |momentum residual| / scale of a nodal solve
  double mean() const { return steps > 0 ? sum / static_cast<double>(steps) : 0; }
};

/// World and operators as one thing that steps, ends, saves and hashes. A client of World like any other.
class Session {
 public:
  /// @throws InputError listing every target out of reach, before anything moves.
  Session(scene::World description, device::Device& device);
  ~Session();
  Session(const Session&) = delete;
  Session& operator=(const Session&) = delete;

  /// Operators decide, then the world takes one base step.
  void step();
  /// The machine of this input channel leaves its program for good and is driven by inputs alone: its joints stop, its
  /// drive brakes. Call it before the first input is set; nothing happens to a machine without a program.
  void take_over(const std::string& input);
  /// True when every program has ended and the settling time has passed, or the scene's duration is over.
  bool done() const;

  World& world();
  const World& world() const;
  const std::string& device_name() const;
  std::string phase(int machine) const;  ///< "idle" for a machine without a program, "inputs" after take_over
  const std::vector<Cycle>& cycles() const;
  const std::vector<BedTip>& tips() const;
  const ForceStatistics& force() const;
  double energy() const;        ///< work of all machines' drives and cylinders [J]
  double control_time() const;  ///< wall time [s]

  std::string state_hash() const;
  /// World::hash_parts, then the operators.
  std::vector<std::pair<std::string, std::string>> hash_parts() const;
  void save(StateWriter& writer) const;
  void load(StateReader& reader);
  /// Snapshot to and from a file; atomic. @throws FileError, InputError.
  void save(const std::string& path) const;
  void load(const std::string& path);

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace navvy::sim
