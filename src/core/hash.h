// SPDX-License-Identifier: Apache-2.0
// State hash: 64-bit FNV-1a over the bytes of plain values, in the order in which they are added.
//
//   StateHash hash;
//   hash.value(step);
//   hash.bytes(heights.data(), heights.size() * sizeof(float));
//   log_info(hash.hex());
#pragma once

#include <cstddef>
#include <cstdint>
#include <cstring>
#include <string>
#include <type_traits>

namespace navvy {

/// Hash of a simulation state, with which two runs can be compared without storing their states.
///
/// It detects accidental differences, not deliberate collisions. It compares bits, not values: -0.0
/// and 0.0 differ, and so do two NaNs with different payloads, because a run that agrees in values
/// but not in bits has diverged somewhere. The result depends on the order in which values are
/// added and is the same on all little-endian machines.
class StateHash {
 public:
  /// Adds an array of `size` bytes together with its size, so that arrays of zeros with different
  /// lengths have different hashes. An array that is added in several parts gives a different hash.
  void bytes(const void* data, std::size_t size) {
    // The length comes first, so that bytes that move from one array to the next change the hash.
    mix(size);
    const auto* p = static_cast<const unsigned char*>(data);
    // Hashing words keeps a 100 MB state affordable; the tail is hashed bytewise.
    for (; size >= 8; size -= 8, p += 8) {
      // Copied, since the data may be unaligned.
      std::uint64_t word;
      std::memcpy(&word, p, 8);
      mix(word);
    }
    // One byte per round for the tail.
    for (; size > 0; --size, ++p) mix(*p);
  }
  /// Adds one number or enum, extended with zeros to 8 bytes; an int and a byte of the same
  /// positive value therefore have the same hash. Structs do not compile, as their padding bytes
  /// are arbitrary.
  template <class T>
  void value(const T& v) {
    static_assert(std::is_arithmetic_v<T> || std::is_enum_v<T>, "hash only values without padding");
    static_assert(sizeof v <= sizeof(std::uint64_t), "long double has padding");
    std::uint64_t word = 0;
    std::memcpy(&word, &v, sizeof v);
    mix(word);
  }
  /// Returns the hash of everything added so far; more may be added afterwards.
  std::uint64_t digest() const { return state_; }
  /// Returns the digest as 16 lower-case hexadecimal digits, as in hashes.csv and in manifests.
  std::string hex() const;

 private:
  // One round of FNV-1a on a word instead of a byte, which needs an eighth of the multiplications.
  void mix(std::uint64_t word) {
    state_ ^= word;
    state_ *= 0x100000001b3ULL;
    // FNV alone leaves the high bits of a 64-bit word in the high half.
    state_ ^= state_ >> 29;
  }
  // FNV's 64-bit offset: the hash of an empty state is not zero.
  std::uint64_t state_ = 0xcbf29ce484222325ULL;
};

}  // namespace navvy
