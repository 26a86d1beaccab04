// SPDX-License-Identifier: Apache-2.0
// Wall time of stages. Never enters the state of a simulation.
#pragma once

#include <chrono>

namespace navvy {

/// Seconds since construction or `restart`. The clock is monotonic: setting the machine's time does
/// not show. Reading it costs some tens of nanoseconds, so it belongs around a stage and not around
/// a particle.
class Stopwatch {
 public:
  /// Reading it does not stop it; ask as often as you like.
  double seconds() const { return std::chrono::duration<double>(Clock::now() - start_).count(); }
  /// Starts again from zero.
  void restart() { start_ = Clock::now(); }

 private:
  // Never the time of day, which jumps when the clock is set.
  using Clock = std::chrono::steady_clock;
  Clock::time_point start_ = Clock::now();
};

/// Adds its lifetime to a sum of seconds. The sum must outlive it. It counts also when the scope is
/// left by an exception, and what is queued on a device within it is not waited for: only the
/// host's time is meant. Laps of one sum must not nest, or time counts twice.
class Lap {
 public:
  explicit Lap(double& sum) : sum_(sum) {}
  ~Lap() { sum_ += watch_.seconds(); }
  Lap(const Lap&) = delete;
  Lap& operator=(const Lap&) = delete;

 private:
  // Written to once, at the end; reading the sum before gives the laps that are over.
  double& sum_;
  Stopwatch watch_;
};

}  // namespace navvy
