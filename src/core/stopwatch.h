// SPDX-License-Identifier: Apache-2.0
// Wall time of stages. Never enters the state of a simulation.
#pragma once

#include <chrono>

namespace navvy {

/// Seconds since construction or `restart`.
class Stopwatch {
 public:
  double seconds() const { return std::chrono::duration<double>(Clock::now() - start_).count(); }
  void restart() { start_ = Clock::now(); }

 private:
  using Clock = std::chrono::steady_clock;
  Clock::time_point start_ = Clock::now();
};

/// Adds its lifetime to a sum of seconds.
class Lap {
 public:
  explicit Lap(double& sum) : sum_(sum) {}
  ~Lap() { sum_ += watch_.seconds(); }
  Lap(const Lap&) = delete;
  Lap& operator=(const Lap&) = delete;

 private:
  double& sum_;
  Stopwatch watch_;
};

}  // namespace navvy
