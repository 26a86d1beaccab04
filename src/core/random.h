// SPDX-License-Identifier: Apache-2.0
// Small repeatable random number generator: equal on every platform, one word of state, saved with
// the world.
#pragma once

#include <cstdint>

#include "core/archive.h"

namespace navvy {

/// SplitMix64 by Steele, Lea and Flood (2014, "Fast splittable pseudorandom number generators").
///
/// Any seed is good, also 0, and has the full period of 2^64. Drawing a number is one addition to
/// the state, so a loaded state continues exactly where it stopped. It is neither cryptographically
/// secure nor thread-safe: give each user its own generator, so that one that draws more numbers
/// does not affect the others.
class Random {
 public:
  /// Seeds the generator.
  explicit Random(std::uint64_t seed = 0) : state_(seed) {}
  /// Returns 64 random bits. The constants are those of the paper and must never change: recorded
  /// runs depend on them.
  std::uint64_t next() {
    state_ += 0x9e3779b97f4a7c15ULL;
    // Three rounds of shift and multiply mix every bit of the counter into the word.
    std::uint64_t z = state_;
    z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9ULL;
    z = (z ^ (z >> 27)) * 0x94d049bb133111ebULL;
    return z ^ (z >> 31);
  }
  /// Returns a number in [0, 1): the upper 53 bits times a power of two, hence exact, equally
  /// spaced and equal on every platform, unlike std::uniform_real_distribution. A double has 53
  /// bits below one, so no value is rounded up to 1.
  double uniform() { return static_cast<double>(next() >> 11) * 0x1.0p-53; }
  /// Returns a number in [low, high); rounding may give `high` if the range holds few doubles.
  double uniform(double low, double high) { return low + (high - low) * uniform(); }
  /// Visits the state.
  void visit(Archive& a) { a("state", state_); }

 private:
  // A counter that determines all future numbers.
  std::uint64_t state_;
};

}  // namespace navvy
