// SPDX-License-Identifier: Apache-2.0
// State hash: 64-bit FNV-1a over the bytes of plain values, in the order they are fed.
#pragma once

#include <cstddef>
#include <cstdint>
#include <cstring>
#include <string>
#include <type_traits>

namespace navvy {

class StateHash {
 public:
  /// The length is part of it: an array of zeros hashes differently from a longer one.
  void bytes(const void* data, std::size_t size) {
    mix(size);
    const auto* p = static_cast<const unsigned char*>(data);
    // Eight bytes at a time keeps hashing a 100 MB state affordable; the tail goes bytewise.
    for (; size >= 8; size -= 8, p += 8) {
      std::uint64_t word;
      std::memcpy(&word, p, 8);
      mix(word);
    }
    for (; size > 0; --size, ++p) mix(*p);
  }
  template <class T>
  void value(const T& v) {
    static_assert(std::is_arithmetic_v<T> || std::is_enum_v<T>, "hash only values without padding");
    static_assert(sizeof v <= sizeof(std::uint64_t), "long double has padding");
    std::uint64_t word = 0;
    std::memcpy(&word, &v, sizeof v);
    mix(word);
  }
  std::uint64_t digest() const { return state_; }
  /// 16 lower-case hex digits.
  std::string hex() const;

 private:
  void mix(std::uint64_t word) {
    state_ ^= word;
    state_ *= 0x100000001b3ULL;
    state_ ^= state_ >> 29;  // FNV alone leaves high bits of a 64-bit word in the high half
  }
  std::uint64_t state_ = 0xcbf29ce484222325ULL;
};

}  // namespace navvy
