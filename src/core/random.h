// SPDX-License-Identifier: Apache-2.0
// Small repeatable random number generator. It gives the same numbers on every platform, and its
// state is one 64-bit word that is saved with the world.
#pragma once

#include <cstdint>

#include "core/archive.h"

namespace navvy {

/// The SplitMix64 generator of Steele, Lea and Flood (2014, "Fast splittable pseudorandom number
/// generators").
///
/// Every seed is suitable, including 0, and gives the full period of 2^64. The state is a counter
/// that each drawn number increments, so a loaded state continues exactly where it stopped. The
/// generator is neither cryptographically secure nor thread-safe. Give each user of random numbers
/// a generator of its own, so that one that draws more numbers does not affect the others.
class Random {
 public:
  /// Starts a sequence that `seed` determines.
  explicit Random(std::uint64_t seed = 0) : state_(seed) {}
  /// Returns 64 random bits. The constants are those of the paper and must never change, as
  /// recorded runs depend on them.
  std::uint64_t next() {
    state_ += 0x9e3779b97f4a7c15ULL;
    // Three rounds of shift and multiply mix every bit of the counter into the word.
    std::uint64_t z = state_;
    z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9ULL;
    z = (z ^ (z >> 27)) * 0x94d049bb133111ebULL;
    return z ^ (z >> 31);
  }
  /// Returns a uniformly distributed number in [0, 1): the upper 53 bits multiplied by a power of
  /// two. It is exact, never rounded up to 1, and the same on every platform, unlike the result of
  /// std::uniform_real_distribution.
  double uniform() { return static_cast<double>(next() >> 11) * 0x1.0p-53; }
  /// Returns a uniformly distributed number in [low, high). Rounding may give `high` if the range
  /// contains few doubles.
  double uniform(double low, double high) { return low + (high - low) * uniform(); }
  /// Hashes, saves or loads the state of the generator.
  void visit(Archive& a) { a("state", state_); }

 private:
  std::uint64_t state_;  ///< counter that determines all future numbers
};

}  // namespace navvy
