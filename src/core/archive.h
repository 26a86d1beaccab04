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

/// True for types that an archive saves and hashes as raw bytes, single values as well as arrays of
/// them. Specialise it for a struct only together with an assertion that the struct has no padding,
/// because padding bytes have arbitrary values.
template <class T>
inline constexpr bool kPlain = (std::is_arithmetic_v<T> && !std::is_same_v<T, bool> &&
                                sizeof(T) <= sizeof(std::uint64_t)) ||
                               std::is_enum_v<T>;
/// An array is plain if its elements are, as there are no gaps between them.
template <class T, std::size_t N>
inline constexpr bool kPlain<std::array<T, N>> = kPlain<T>;
/// A matrix of fixed size is plain if its storage consists of its elements only, without extra
/// bytes for alignment.
template <class T, int R, int C, int O>
inline constexpr bool kPlain<Eigen::Matrix<T, R, C, O, R, C>> =
    kPlain<T>&& R > 0 && C > 0 && sizeof(Eigen::Matrix<T, R, C, O, R, C>) == sizeof(T) * R* C;

/// Visitor of the fields of a class: it hashes, saves or loads them one after the other.
///
/// Each field has a name, which is used only in error messages and tests and is not saved. A saved
/// field is identified by its position, so the order of fields in a visit defines a file format:
/// whoever changes the order must also change the version of the section. Numbers are stored as in
/// memory (little-endian). Hashing and saving only read the fields, loading only writes them; a
/// `visit` that must distinguish the two calls `loading()`.
class Archive {
 public:
  // Not copyable: a copy would have its own path and its own position in the bytes.
  Archive(const Archive&) = delete;
  Archive& operator=(const Archive&) = delete;
  virtual ~Archive() = default;

  /// Returns true if this archive loads, that is overwrites fields with saved values; false if it
  /// hashes or saves.
  bool loading() const { return loading_; }

  /// Visits one field. Its type may be a number, bool, enum, std::string, Eigen matrix of fixed
  /// size, quaternion or Pose; a class with a member function `visit(Archive&)` or a free function
  /// `visit(Archive&, T&)`; or a std::array, vector, optional, variant, pair, map or set of these.
  /// Loading replaces the content of a container. A std::span of constant plain values is saved
  /// like a vector, and a vector must be visited to load it. Other types do not compile: give them
  /// a `visit`, or use `property`.
  /// @throws InputError naming the field if, on loading, the section ends early, a bool is neither
  /// 0 nor 1, or keys are not in ascending order
  template <class T>
  void operator()(const char* name, T& field);

  /// Visits a number or enum. When loading, the value must be in the range from `low` to `high`,
  /// bounds included; NaN is out of range. Saving and hashing do not check it.
  /// @throws InputError naming the field if the loaded value is out of range
  template <class T>
  void ranged(const char* name, T& field, const std::type_identity_t<T>& low,
              const std::type_identity_t<T>& high);

  /// Visits the elements of a vector whose length the scene has already set. Use it for arrays that
  /// determine the size of others.
  /// @throws InputError if the saved length differs from that of `field`
  template <class T>
  void fixed(const char* name, std::vector<T>& field);

  /// Saves a value that is constant during a run and is determined by the scene; it is not hashed.
  /// Loading compares the saved value with `value`, so that a state of a different scene is refused
  /// before its fields are read into arrays of another size.
  /// @throws InputError with the text `rule` if the saved value differs
  template <class T>
  void constant(const char* name, const T& value, const std::string& rule);

  /// Visits a field that is accessible only through two functions: `get()` returns its value, and
  /// `set(value)` stores a loaded value. `get` is called only when hashing or saving and `set` only
  /// when loading, so the object that they access may be created by loading. The type of the field
  /// is the return type of `get`.
  template <class Get, class Set>
  void property(const char* name, const Get& get, const Set& set);

  /// Excludes the fields that `body()` visits from the hash; they are saved and loaded. Use it for
  /// fields that do not affect anything a run computes afterwards. `reason` states why; it appears
  /// in the byte map and must be reviewed, because a field excluded by mistake lets two runs
  /// diverge unnoticed.
  template <class Body>
  void unhashed(const char* reason, const Body& body);

  /// Saves or loads the fields that `body()` visits as a section with a tag and a version of its
  /// own. A change to the fields of one class then leaves the formats of other sections unchanged.
  /// @param tag name of the section, 1 to 15 characters
  /// @param version version of the section's format
  /// @throws Error for a tag of another length
  /// @throws InputError if loading finds another tag or version, or if `body` reads more or fewer
  /// bytes than were saved
  template <class Body>
  void section(const char* tag, std::uint32_t version, const Body& body);

  /// Visits the length of a container whose type the archive does not support. `present` is the
  /// current length. Returns the saved length when loading, otherwise `present`. The caller then
  /// resizes the container and calls `item(i, ...)` once per element.
  /// @throws InputError if the saved length exceeds the number of remaining bytes
  std::uint64_t size(const char* name, std::uint64_t present);
  /// Visits the fields of one element by calling `body()`. `number` is the index of the element,
  /// which appears in the paths of these fields.
  template <class Body>
  void item(std::uint64_t number, const Body& body);

  /// Checks a condition when loading; does nothing when hashing or saving. Use it for conditions on
  /// several fields, after they have been visited; for a single field, `ranged` gives a better
  /// message.
  /// @throws InputError naming `field` and `rule` if `good` is false
  void require(bool good, const char* field, const std::string& rule);

 protected:
  // The type of an archive is visible only through `loading()` and the virtual functions below.
  explicit Archive(bool loading) : loading_(loading) {}

  /// Hashes, saves or loads one number of at most 8 bytes at the address `data`. `size` is its size
  /// [bytes]. Only a loading archive writes to `data`.
  virtual void scalar(void* data, std::size_t size) = 0;
  /// Hashes, saves or loads `size` bytes of consecutive plain values at the address `data`.
  virtual void block(void* data, std::size_t size) = 0;
  /// Begins the section `tag` with this format version; sections may be nested.
  virtual void begin_section(const char* tag, std::uint32_t version) = 0;
  /// Ends the innermost section.
  virtual void end_section() = 0;
  /// Returns the number of bytes left to load in the innermost section; 0 for archives that do not
  /// load.
  virtual std::size_t left() const { return 0; }

  /// Returns false while the fields of `unhashed` or `constant` are visited, otherwise true.
  bool hashed() const { return unhashed_ == 0; }
  /// Returns the reason given to `unhashed`; an empty text in `constant` and for hashed fields.
  const char* reason() const { return reason_; }
  /// Returns the path of the field that is being visited, e.g. "world/tools[2]/force".
  std::string path() const;
  /// Refuses the loaded state; never returns.
  /// @throws InputError naming the current field and `rule`, always
  [[noreturn]] void fail(const std::string& rule) const;

 private:
  // ArchiveParts implements the visits of all types and needs `scalar`, `block` and the path.
  friend struct ArchiveParts;
  /// Appends one element to the path of the current field for as long as the object exists.
  class Scope;
  /// Excludes fields from the hash for as long as the object exists.
  class Unhashed;
  /// One element of the path.
  struct Place {
    const char* name = nullptr;  ///< name of a field; null for an element of a container
    std::uint64_t number = 0;    ///< index of an element of a container
  };

  const bool loading_;       ///< true: the archive loads; fixed at construction
  int unhashed_ = 0;         ///< nesting depth of `unhashed` and `constant`
  const char* reason_ = "";  ///< reason given to the innermost `unhashed`; empty outside it
  /// Path from the outermost field to the current one. It stores pointers and indices, so that no
  /// text is built unless a path is needed.
  std::vector<Place> places_;
};

}  // namespace navvy

#include "core/archive_parts.h"  // IWYU pragma: export
