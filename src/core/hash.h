// SPDX-License-Identifier: Apache-2.0
// State hash: 64-bit FNV-1a over the bytes of plain values, in the order they are fed.
#pragma once

#include <cstddef>
#include <cstdint>
#include <cstring>
#include <string>
#include <type_traits>

namespace navvy {

/// Sums up a state into one number, so that two runs can be compared without keeping either.
///
/// It is made for finding differences, not against intent: who wants a collision finds one. The
/// bits count, not the values: -0.0 and 0.0 differ, and so do two NaNs with other payloads; a run
/// that agrees in value and not in bits has diverged somewhere. The result depends on the order of
/// what is fed, so whoever feeds a set must have an order for it. It is the same on every
/// little-endian machine.
class StateHash {
 public:
  /// The length is part of it: an array of zeros hashes differently from a longer one. So an
  /// array that is fed in parts gives another hash than fed at once.
  void bytes(const void* data, std::size_t size) {
    // First of all, so that bytes that move from one array to its neighbour change the hash.
    mix(size);
    const auto* p = static_cast<const unsigned char*>(data);
    // Eight bytes at a time keeps hashing a 100 MB state affordable; the tail goes bytewise.
    for (; size >= 8; size -= 8, p += 8) {
      // Copied, as the data may lie at any address.
      std::uint64_t word;
      std::memcpy(&word, p, 8);
      mix(word);
    }
    // One byte a round for the few that are left.
    for (; size > 0; --size, ++p) mix(*p);
  }
  /// One number or enum, widened to a word with zeros above, so that its type does not show: an int
  /// of 1 and a byte of 1 hash alike. Structs are refused, as their padding is noise.
  template <class T>
  void value(const T& v) {
    static_assert(std::is_arithmetic_v<T> || std::is_enum_v<T>, "hash only values without padding");
    static_assert(sizeof v <= sizeof(std::uint64_t), "long double has padding");
    std::uint64_t word = 0;
    std::memcpy(&word, &v, sizeof v);
    mix(word);
  }
  /// What the hash is so far; more may be fed afterwards.
  std::uint64_t digest() const { return state_; }
  /// 16 lower-case hex digits. This is the form in hashes.csv and in manifests.
  std::string hex() const;

 private:
  // One round of FNV-1a on a word in place of a byte, an eighth of the multiplications.
  void mix(std::uint64_t word) {
    state_ ^= word;
    state_ *= 0x100000001b3ULL;
    state_ ^= state_ >> 29;  // FNV alone leaves high bits of a 64-bit word in the high half
  }
  // FNV's offset for 64 bits: a state of nothing does not hash to zero.
  std::uint64_t state_ = 0xcbf29ce484222325ULL;
};

}  // namespace navvy
