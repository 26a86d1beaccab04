// SPDX-License-Identifier: Apache-2.0
// Versioned binary state of modules. A snapshot is a sequence of sections {tag, version, size, bytes}; a reader refuses
// a version it does not know and a section that is longer or shorter than it reads. Little-endian hosts only
// (asserted).
#pragma once

#include <cstdint>
#include <cstring>
#include <string>
#include <type_traits>
#include <vector>

#include "core/error.h"
#include "core/math.h"

namespace navvy {

/// Collects the bytes of a snapshot in memory.
class StateWriter {
 public:
  /// Opens a section; sections do not nest. `tag` at most 15 characters.
  void begin(const std::string& tag, std::uint32_t version);
  void end();

  template <class T>
  void value(const T& v) {
    static_assert(std::is_trivially_copyable_v<T>);
    const auto* p = reinterpret_cast<const char*>(&v);
    bytes_.insert(bytes_.end(), p, p + sizeof v);
  }
  template <class T>
  void vector(const std::vector<T>& v) {
    static_assert(std::is_trivially_copyable_v<T>);
    value(static_cast<std::uint64_t>(v.size()));
    if (v.empty()) return;
    const auto* p = reinterpret_cast<const char*>(v.data());
    bytes_.insert(bytes_.end(), p, p + v.size() * sizeof(T));
  }
  void text(const std::string& s) { vector(std::vector<char>(s.begin(), s.end())); }
  void vec3(const Vec3& v) {
    for (int i = 0; i < 3; ++i) value(v[i]);
  }
  void pose(const Pose& X) {
    for (int r = 0; r < 3; ++r)
      for (int c = 0; c < 4; ++c) value(X.matrix()(r, c));
  }
  const std::vector<char>& bytes() const { return bytes_; }

 private:
  std::vector<char> bytes_;
  std::size_t section_ = 0;
  bool open_ = false;
};

/// Reads what StateWriter wrote. Every fault throws InputError naming the section.
class StateReader {
 public:
  explicit StateReader(std::vector<char> bytes) : bytes_(std::move(bytes)) {}

  /// Enters the next section, which must carry this tag and this version.
  void begin(const std::string& tag, std::uint32_t known);
  /// Leaves the section; throws if bytes of it were left unread.
  void end();

  template <class T>
  T value() {
    static_assert(std::is_trivially_copyable_v<T>);
    T v;
    need(sizeof v);
    std::memcpy(&v, bytes_.data() + at_, sizeof v);
    at_ += sizeof v;
    return v;
  }
  template <class T>
  std::vector<T> vector() {
    const auto n = value<std::uint64_t>();
    if (n > bytes_.size() / sizeof(T)) fail("a length is beyond the end of the snapshot");
    need(n * sizeof(T));
    std::vector<T> v(n);
    if (n > 0) std::memcpy(v.data(), bytes_.data() + at_, n * sizeof(T));
    at_ += n * sizeof(T);
    return v;
  }
  std::string text() {
    const auto v = vector<char>();
    return std::string(v.begin(), v.end());
  }
  Vec3 vec3() {
    Vec3 v;
    for (int i = 0; i < 3; ++i) v[i] = value<double>();
    return v;
  }
  Pose pose() {
    Pose X = Pose::Identity();
    for (int r = 0; r < 3; ++r)
      for (int c = 0; c < 4; ++c) X.matrix()(r, c) = value<double>();
    return X;
  }

 private:
  [[noreturn]] void fail(const std::string& rule) const;
  void need(std::size_t size) const {
    const std::size_t limit = open_ ? section_end_ : bytes_.size();
    if (size > limit - at_) fail("the section ends too early");
  }
  std::vector<char> bytes_;
  std::size_t at_ = 0;
  std::size_t section_end_ = 0;
  std::string tag_ = "header";
  bool open_ = false;
};

}  // namespace navvy
