// SPDX-License-Identifier: Apache-2.0
// Commands of the live page to a running simulation.
#pragma once

#include <condition_variable>
#include <mutex>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "sim/channels.h"

namespace navvy::link {

/// Checks commands of the page and keeps them until the run takes them, merged: the memory use does
/// not grow with their number. Thread-safe.
///
/// A command is a JSON object with one or more of these keys: `pause` (true, false), `step` (number
/// of base steps, after which the run is paused), `pace` (simulated seconds per second; 0: as fast
/// as possible) and `inputs` (numbers by the names of inputs).
class ViewCommands {
 public:
  /// Commands that were merged since the last call of `take`.
  struct Pending {
    std::optional<bool> pause;
    long steps = 0;
    std::optional<double> pace;
    /// Index and value of each input, in the order in which they were set last.
    std::vector<std::pair<int, double>> inputs;
  };

  /// Takes the names and bounds of `inputs`. `refusal` is the reason why the page may set none of
  /// them; empty if it may.
  ViewCommands(const sim::Inputs& inputs, std::string refusal);

  /// Adds the commands of one JSON object. @throws InputError for an invalid one, which then
  /// changes nothing.
  void add(const std::string& text);
  /// Returns the commands that arrived since the last call.
  Pending take();
  /// Waits at most `patience` [s] for a command.
  void wait(double patience);

  /// Maximum number of steps in one command.
  static constexpr long kMostSteps = 100'000;

 private:
  /// Copy of the inputs, which setting values does not use.
  sim::Inputs inputs_;
  std::string refusal_;
  std::mutex mutex_;
  std::condition_variable added_;
  Pending pending_;
  bool any_ = false;
};

}  // namespace navvy::link
