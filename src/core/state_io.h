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

/// Collects the bytes of a snapshot in memory. What a class is made of is given piece by piece, in an order that its
/// reader repeats; nothing in the bytes says what a number means. New code lists its fields once in a `visit` instead
/// (core/archive.h), which takes hash, save and load from one list.
class StateWriter {
 public:
  /// Opens a section; sections do not nest. `tag` at most 15 characters. @throws Error for a section within a section
  /// or a bad tag, which are mistakes of the program.
  void begin(const std::string& tag, std::uint32_t version);
  /// Closes the section and writes its size into its head. @throws Error without a section.
  void end();

  /// One value as it lies in memory. It must have no padding, or the same state would give different files. A compiler
  /// cannot see padding, so the rule is for whoever writes the struct.
  template <class T>
  void value(const T& v) {
    static_assert(std::is_trivially_copyable_v<T>);
    const auto* p = reinterpret_cast<const char*>(&v);
    bytes_.insert(bytes_.end(), p, p + sizeof v);
  }
  /// Its length first, 64 bits, then the elements side by side. Nothing tells an empty vector from one that was never
  /// filled.
  template <class T>
  void vector(const std::vector<T>& v) {
    static_assert(std::is_trivially_copyable_v<T>);
    value(static_cast<std::uint64_t>(v.size()));
    // A pointer to the elements of an empty vector may be null.
    if (v.empty()) return;
    const auto* p = reinterpret_cast<const char*>(v.data());
    bytes_.insert(bytes_.end(), p, p + v.size() * sizeof(T));
  }
  /// The bytes of the text with their number before them; no encoding is assumed.
  void text(const std::string& s) { vector(std::vector<char>(s.begin(), s.end())); }
  /// Three doubles, x y z.
  void vec3(const Vec3& v) {
    for (int i = 0; i < 3; ++i) value(v[i]);
  }
  /// Twelve doubles, row by row, the place at the end of each row. The last row of the matrix is always 0 0 0 1.
  /// Archives go column by column, so a pose of one format is not one of the other.
  void pose(const Pose& X) {
    for (int r = 0; r < 3; ++r)
      for (int c = 0; c < 4; ++c) value(X.matrix()(r, c));
  }
  /// Everything so far. It is a whole state only when no section is open.
  const std::vector<char>& bytes() const { return bytes_; }

 private:
  std::vector<char> bytes_;
  // Where the open section's size stands: end() writes it when it is known.
  std::size_t section_ = 0;
  bool open_ = false;
};

/// Reads what StateWriter wrote. Every fault throws InputError naming the section. It is safe against any content:
/// nothing is read beyond the innermost section, and no memory is taken for a length that the bytes do not bear out.
/// Whether the values make sense is for its caller to check.
class StateReader {
 public:
  /// Takes the bytes over; parts that are not read yet stay here until they are.
  explicit StateReader(std::vector<char> bytes) : bytes_(std::move(bytes)) {}

  /// Enters the next section, which must carry this tag and this version. @throws InputError naming both when another
  /// is found; what was read before stays as it is.
  void begin(const std::string& tag, std::uint32_t known);
  /// Leaves the section; throws if bytes of it were left unread. A section that was read to its end is what shows that
  /// writer and reader agree.
  void end();

  /// The next value. An enum or a bool is read as a number and checked by the caller: any other byte in one is
  /// undefined.
  template <class T>
  T value() {
    static_assert(std::is_trivially_copyable_v<T>);
    T v;
    need(sizeof v);
    // By a copy, as the bytes lie at any address.
    std::memcpy(&v, bytes_.data() + at_, sizeof v);
    at_ += sizeof v;
    return v;
  }
  /// A length and its elements, as StateWriter::vector wrote them.
  template <class T>
  std::vector<T> vector() {
    const auto n = value<std::uint64_t>();
    // By division, as a huge length times the size could wrap around and pass.
    if (n > bytes_.size() / sizeof(T)) fail("a length is beyond the end of the snapshot");
    need(n * sizeof(T));
    std::vector<T> v(n);
    if (n > 0) std::memcpy(v.data(), bytes_.data() + at_, n * sizeof(T));
    at_ += n * sizeof(T);
    return v;
  }
  // The composed ones are the mirrors of the writer's; a pose is taken bit by bit and not made orthonormal again, so
  // that a continued run agrees with the one it came from. Any bytes may stand in a text; nothing is assumed of its
  // end.
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
  // Names the section that was entered last, or "header" before the first.
  [[noreturn]] void fail(const std::string& rule) const;
  // The innermost limit: the section's end where one is open, else the file's.
  void need(std::size_t size) const {
    const std::size_t limit = open_ ? section_end_ : bytes_.size();
    if (size > limit - at_) fail("the section ends too early");
  }
  // at_ never passes the limit, so the difference in `need` cannot wrap around.
  std::vector<char> bytes_;
  std::size_t at_ = 0;
  std::size_t section_end_ = 0;
  std::string tag_ = "header";
  bool open_ = false;
};

}  // namespace navvy
