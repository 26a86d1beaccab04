// SPDX-License-Identifier: Apache-2.0
// Small repeatable random numbers: the same on every platform, state of one word, saved with the world.
#pragma once

#include <cstdint>

#include "core/archive.h"

namespace navvy {

/// SplitMix64 [Steele, Lea & Flood 2014, "Fast splittable pseudorandom number generators"].
class Random {
 public:
  explicit Random(std::uint64_t seed = 0) : state_(seed) {}
  std::uint64_t next() {
    state_ += 0x9e3779b97f4a7c15ULL;
    std::uint64_t z = state_;
    z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9ULL;
    z = (z ^ (z >> 27)) * 0x94d049bb133111ebULL;
    return z ^ (z >> 31);
  }
  /// In [0, 1).
  double uniform() { return static_cast<double>(next() >> 11) * 0x1.0p-53; }
  double uniform(double low, double high) { return low + (high - low) * uniform(); }
  std::uint64_t state() const { return state_; }
  void set_state(std::uint64_t state) { state_ = state; }
  void visit(Archive& a) { a("state", state_); }

 private:
  std::uint64_t state_;
};

}  // namespace navvy
