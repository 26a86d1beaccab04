// SPDX-License-Identifier: Apache-2.0
// Small repeatable random numbers: the same on every platform, state of one word, saved with the
// world.
#pragma once

#include <cstdint>

#include "core/archive.h"

namespace navvy {

/// SplitMix64, by Steele, Lea and Flood (2014, "Fast splittable pseudorandom number generators").
/// The generator is seeded by any number, also 0, and each seed has the full period of 2^64.
/// Drawing changes the state by one addition, so a saved state goes on exactly where it stopped.
/// Not for secrets, and not safe to share between threads: give each user of random numbers one of
/// its own, so that one that draws more leaves the others as they were.
class Random {
 public:
  explicit Random(std::uint64_t seed = 0) : state_(seed) {}
  /// All 64 bits are good. The constants are those of the paper and must never change: recorded
  /// runs depend on them.
  std::uint64_t next() {
    state_ += 0x9e3779b97f4a7c15ULL;
    // Three rounds of shift and multiply spread every bit of the counter over the word.
    std::uint64_t z = state_;
    z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9ULL;
    z = (z ^ (z >> 27)) * 0x94d049bb133111ebULL;
    return z ^ (z >> 31);
  }
  /// In [0, 1). The upper 53 bits times a power of two: exact, equally spaced, the same on every
  /// platform, unlike std::uniform_real_distribution. 53 bits are what a double holds below one, so
  /// no value is rounded up to 1.
  double uniform() { return static_cast<double>(next() >> 11) * 0x1.0p-53; }
  /// In [low, high), up to rounding: a range of few doubles may answer `high`.
  double uniform(double low, double high) { return low + (high - low) * uniform(); }
  /// For snapshots that hold the word themselves. A class with a `visit` needs neither of the two.
  std::uint64_t state() const { return state_; }
  /// Goes on as the generator did from which `state` was taken.
  void set_state(std::uint64_t state) { state_ = state; }
  /// The one word is all there is to save.
  void visit(Archive& a) { a("state", state_); }

 private:
  // A counter in effect: all that the future depends on.
  std::uint64_t state_;
};

}  // namespace navvy
