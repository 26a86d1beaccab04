// SPDX-License-Identifier: Apache-2.0
// Archive: one list of a class's fields, `void visit(Archive&)`, drives its hash, saving and
// loading.
//
//   class Slump {
//    public:
//     void visit(Archive& a) {
//       // Numbers, bool, enums, text, Eigen types and containers.
//       a("debt", debt_);
//       // The same, with a range that is checked on loading.
//       a.ranged("phase", phase_, Phase::kIdle, Phase::kLast);
//       // std::map; its values have a visit() of their own.
//       a("sliding", sliding_);
//       a.unhashed("a cache that is rebuilt from `sliding`", [&] { a("listed", listed_); });
//       // Derived values are rebuilt, not visited.
//       if (a.loading()) rebuild_lists();
//     }
//
// How to write a visit:
// 1. Visit all state that determines the future of a run, in a fixed order. A part that evolves on
// its own wraps its fields in `a.section(tag, version, [&] { ... })`; reordering or adding a field
// raises the version. Sections nest.
// 2. State that is saved but does not affect the future is `unhashed`, with the reason.
// 3. A value that must equal the scene's (number of tools, size of the site) is a `constant`; a
// vector whose length the scene sets is `fixed`. A saved value that could index outside an array or
// cause an endless loop is `ranged`, or is checked by `require`. During loading, fields that were
// not visited yet still hold old values: do not use them.
// 4. State inside a foreign object (a Bullet body, a device buffer) goes through `property(name,
// get, set)`.
// 5. Virtual interfaces declare `virtual void visit(Archive& a) = 0`. A class with a pointer to its
// state visits that state.
// 6. Call `hash_of`, `saved` and `load_saved` from core/saved_state.h to get the hash or the bytes.
// 7. Test the class with `flip_every_byte` from tests/flip_bytes.h.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <string>
#include <type_traits>
#include <utility>
#include <vector>

#include "core/math.h"

namespace navvy {

/// True for types that an archive may take as one run of bytes, also many side by side. Specialise
/// it for a struct only together with an assertion that the struct has no padding; padding would be
/// saved and hashed as noise.
template <class T>
inline constexpr bool kPlain = (std::is_arithmetic_v<T> && !std::is_same_v<T, bool> &&
                                sizeof(T) <= sizeof(std::uint64_t)) ||
                               std::is_enum_v<T>;
/// An array has no gaps between its elements, so it is plain if its elements are.
template <class T, std::size_t N>
inline constexpr bool kPlain<std::array<T, N>> = kPlain<T>;
/// Fixed-size matrices are plain if their storage is exactly their elements, without bytes added
/// for alignment.
template <class T, int R, int C, int O>
inline constexpr bool kPlain<Eigen::Matrix<T, R, C, O, R, C>> =
    kPlain<T>&& R > 0 && C > 0 && sizeof(Eigen::Matrix<T, R, C, O, R, C>) == sizeof(T) * R* C;

/// Visitor of a class's fields: hashes, saves or loads them one after the other, each with a name.
///
/// Names appear in errors and tests only; they are not written. A field is identified by its
/// position, so the order of a visit is a file format: change it together with the section's
/// version. Numbers are stored as in memory (little-endian). Hashing and saving only read the
/// fields, loading only writes them; a visit that must know which asks `loading()`.
class Archive {
 public:
  // Not copyable: a copy would have its own path and its own position in the bytes.
  Archive(const Archive&) = delete;
  Archive& operator=(const Archive&) = delete;
  virtual ~Archive() = default;

  /// Returns true while fields are being overwritten by saved values.
  bool loading() const { return loading_; }

  /// Visits one field: a number, bool or enum, std::string, Eigen matrix of fixed size, quaternion
  /// or Pose, a class with a member `visit(Archive&)` or a free function `visit(Archive&, T&)`, or
  /// a std::array, vector, optional, variant, pair, map or set of those. Loading replaces the
  /// content of containers. A std::span of constant plain values is saved like a vector and is
  /// loaded as a vector. A field of any other type does not compile; give it a `visit`, or use
  /// `property`.
  /// @throws InputError naming the field if, on loading, the section ends early, a bool is neither
  /// 0 nor 1, or keys are not in ascending order.
  template <class T>
  void operator()(const char* name, T& field);

  /// Visits a number or enum that must lie within [low, high] when it is loaded; NaN is out of
  /// range. Saving and hashing do not check the range.
  /// @throws InputError naming the field.
  template <class T>
  void ranged(const char* name, T& field, const std::type_identity_t<T>& low,
              const std::type_identity_t<T>& high);

  /// Visits the elements of a vector whose length the scene has already set, such as arrays that
  /// determine the size of others.
  /// @throws InputError if the saved length differs.
  template <class T>
  void fixed(const char* name, std::vector<T>& field);

  /// Saves a value that is constant during a run and must be equal where a state is loaded; it is
  /// not hashed. A state of a different scene is thereby refused with a reason, before its fields
  /// are read into arrays that do not fit.
  /// @throws InputError with `rule` if the saved value differs.
  template <class T>
  void constant(const char* name, const T& value, const std::string& rule);

  /// Visits a field behind two functions: `get()` returns its value, `set(value)` stores the loaded
  /// one. `get` is called only when hashing or saving and `set` only when loading, so the object
  /// behind them may be created by loading. The type of the value is the return type of `get`.
  template <class Get, class Set>
  void property(const char* name, const Get& get, const Set& set);

  /// Visits fields that are saved but do not affect anything a run computes afterwards. `reason`
  /// says why; it is listed in the byte map and is part of the review, since a field wrongly placed
  /// here lets two runs diverge unnoticed.
  template <class Body>
  void unhashed(const char* reason, const Body& body);

  /// Visits a tagged part of the state with its own version, so that a change in one class leaves
  /// the formats of the others alone.
  /// @param tag 1 to 15 characters.
  /// @throws Error for a tag of another length.
  /// @throws InputError if loading finds another tag or version, or if the body reads more or fewer
  /// bytes than were saved.
  template <class Body>
  void section(const char* tag, std::uint32_t version, const Body& body);

  /// Visits the number of elements of a container type that the archive does not know, and returns
  /// the saved number when loading. Call `item(i, ...)` once per element afterwards; the caller
  /// resizes the container.
  /// @throws InputError for a number that exceeds the remaining bytes, before anything is
  /// allocated.
  std::uint64_t size(const char* name, std::uint64_t present);
  /// Visits element `number`; the number appears in the paths of the fields that `body` visits.
  template <class Body>
  void item(std::uint64_t number, const Body& body);

  /// Checks a rule when loading and does nothing otherwise. Use it for rules that involve several
  /// fields, after they were visited; `ranged` gives a better message for one field.
  /// @throws InputError naming `field` and `rule` if `good` is false.
  void require(bool good, const char* field, const std::string& rule);

 protected:
  // The kind of an archive is visible in `loading()` and in the virtual functions below only.
  explicit Archive(bool loading) : loading_(loading) {}

  /// Handles one number of at most 8 bytes. `data` is written only if the archive loads.
  virtual void scalar(void* data, std::size_t size) = 0;
  /// Handles many plain values side by side.
  virtual void block(void* data, std::size_t size) = 0;
  // Sections nest.
  virtual void begin_section(const char* tag, std::uint32_t version) = 0;
  virtual void end_section() = 0;
  /// Returns the number of bytes left to load in the innermost section.
  virtual std::size_t left() const { return 0; }

  /// Returns false within `unhashed` and `constant`; `reason` then gives the reason (empty for
  /// constants).
  bool hashed() const { return unhashed_ == 0; }
  const char* reason() const { return reason_; }
  /// Returns the path of the field that is being visited, e.g. "world/tools[2]/force".
  std::string path() const;
  /// Refuses the state.
  /// @throws InputError naming the field and `rule`, always.
  [[noreturn]] void fail(const std::string& rule) const;

 private:
  // ArchiveParts implements the types and needs the bytes and the path.
  friend struct ArchiveParts;
  // Extends the path by one element during its lifetime.
  class Scope;
  // Excludes fields from the hash during its lifetime.
  class Unhashed;
  struct Place {
    // Null for an element, which is identified by its number.
    const char* name = nullptr;
    std::uint64_t number = 0;
  };

  // Fixed at construction: an archive never changes from saving to loading.
  const bool loading_;
  // Nesting depth of `unhashed` and `constant`.
  int unhashed_ = 0;
  const char* reason_ = "";
  // Path from the outermost field to the current one, as pointers and numbers, so that a visit
  // builds no text.
  std::vector<Place> places_;
};

}  // namespace navvy

#include "core/archive_parts.h"  // IWYU pragma: export
