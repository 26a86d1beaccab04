// SPDX-License-Identifier: Apache-2.0
// Measurement of the wall-clock time that stages of a run take. It never affects the state of a
// simulation.
#pragma once

#include <chrono>

namespace navvy {

/// Measures the wall-clock time since construction or the last `restart`. The clock is monotonic,
/// so changes of the system time do not affect it. Reading it takes some tens of nanoseconds: use
/// it for stages, not for single particles.
class Stopwatch {
 public:
  /// Returns the elapsed time [s]; the clock continues.
  double seconds() const { return std::chrono::duration<double>(Clock::now() - start_).count(); }
  /// Sets the elapsed time to zero.
  void restart() { start_ = Clock::now(); }

 private:
  // A monotonic clock; the time of day jumps when the system clock is set.
  using Clock = std::chrono::steady_clock;
  Clock::time_point start_ = Clock::now();  ///< time of construction or of the last `restart`
};

/// Adds the time from construction to destruction [s] to a sum, also if an exception leaves the
/// scope. The sum must exist longer than this object. It measures time on the host and does not
/// wait for work queued on a device. Objects that add to the same sum must not be nested, as time
/// would then count twice.
///
///   double rendering = 0;
///   {
///     const Lap lap(rendering);
///     draw(frame);
///   }
class Lap {
 public:
  /// Starts the clock; the destructor adds the elapsed time to `sum` [s].
  explicit Lap(double& sum) : sum_(sum) {}
  ~Lap() { sum_ += watch_.seconds(); }
  Lap(const Lap&) = delete;
  Lap& operator=(const Lap&) = delete;

 private:
  /// Sum to which the destructor adds the elapsed time [s]; it is not changed before.
  double& sum_;
  Stopwatch watch_;  ///< clock, started at construction
};

}  // namespace navvy
