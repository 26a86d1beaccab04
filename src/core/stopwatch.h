// SPDX-License-Identifier: Apache-2.0
// Wall time of stages. It never enters the state of a simulation.
#pragma once

#include <chrono>

namespace navvy {

/// Measures the wall time since construction or `restart`. The clock is monotonic and unaffected by
/// changes of the system time. Reading it costs some tens of nanoseconds: measure stages with it,
/// not single particles.
class Stopwatch {
 public:
  /// Returns the elapsed time [s] without stopping the clock.
  double seconds() const { return std::chrono::duration<double>(Clock::now() - start_).count(); }
  /// Restarts from zero.
  void restart() { start_ = Clock::now(); }

 private:
  // Not the time of day, which jumps when the clock is set.
  using Clock = std::chrono::steady_clock;
  Clock::time_point start_ = Clock::now();
};

/// Adds its lifetime [s] to a sum, also when an exception leaves the scope. The sum must outlive
/// it. It measures host time: work queued on a device is not waited for. Laps of one sum must not
/// nest, or time counts twice.
///
///   double rendering = 0;
///   {
///     const Lap lap(rendering);
///     draw(frame);
///   }
class Lap {
 public:
  /// Starts the clock; the destructor adds the time to `sum` [s].
  explicit Lap(double& sum) : sum_(sum) {}
  ~Lap() { sum_ += watch_.seconds(); }
  Lap(const Lap&) = delete;
  Lap& operator=(const Lap&) = delete;

 private:
  // Written once, in the destructor; until then the sum holds the finished laps.
  double& sum_;
  Stopwatch watch_;
};

}  // namespace navvy
