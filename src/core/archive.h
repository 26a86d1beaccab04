// SPDX-License-Identifier: Apache-2.0
// One list of a class's fields drives hash, save and load: `void visit(Archive&)`.
//
//   class Slump {
//    public:
//     void visit(Archive& a) {
//       a("debt", debt_);                                           // numbers, bool, enums, text,
//       Eigen, containers a.ranged("phase", phase_, Phase::kIdle, Phase::kLast);      // the same,
//       checked when it is loaded a("sliding", sliding_);                                     //
//       std::map; its values have a visit() of their own a.unhashed("only saves work: lists are
//       rebuilt from it", [&] { a("listed", listed_); }); if (a.loading()) rebuild_lists(); //
//       derived values are not visited but rebuilt
//     }
//
// How to write one:
// 1. Everything that two runs must agree in to go on alike is visited, in a fixed order. A part
//    with a life of its own wraps its fields in `a.section(tag, version, [&] { ... })`; another
//    order or another field raises the version. Sections nest.
// 2. What is saved and changes nothing that follows is `unhashed`, with the reason.
// 3. A value that must be what the scene says (number of tools, size of the site) is a `constant`;
//    a vector whose length the scene sets is `fixed`. A saved value that could lead outside of an
//    array or into an endless loop is `ranged`, or checked by `require`. While loading, other
//    fields are still those of another moment: do not ask them before they have been visited.
// 4. What lives in a foreign object (a Bullet body, a device buffer) goes through `property(name,
//    get, set)`.
// 5. Virtual interfaces take `virtual void visit(Archive& a) = 0`. A class behind a pointer to its
//    state visits that.
// 6. Whoever wants the hash or the bytes calls `hash_of`, `saved` and `load_saved` of
//    core/saved_state.h.
// 7. Test the class with `flip_every_byte` of tests/flip_bytes.h.
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

/// A type that may be taken as one run of bytes, also many side by side. True of a struct only by a
/// specialisation of your own, which must assert that its members leave no gaps (padding would be
/// saved and hashed as noise).
template <class T>
inline constexpr bool kPlain = (std::is_arithmetic_v<T> && !std::is_same_v<T, bool> &&
                                sizeof(T) <= sizeof(std::uint64_t)) ||
                               std::is_enum_v<T>;
/// Arrays have no gaps between their elements, so they are as plain as what they hold.
template <class T, std::size_t N>
inline constexpr bool kPlain<std::array<T, N>> = kPlain<T>;
/// Matrices of fixed size whose storage is their elements and nothing else; an alignment that adds
/// bytes makes them another kind.
template <class T, int R, int C, int O>
inline constexpr bool kPlain<Eigen::Matrix<T, R, C, O, R, C>> =
    kPlain<T>&& R > 0 && C > 0 && sizeof(Eigen::Matrix<T, R, C, O, R, C>) == sizeof(T) * R* C;

/// What `visit` is handed: takes fields one after the other and hashes, saves or loads them, each
/// by its name.
///
/// Names are for errors and tests; they are not written. A field counts by its place, so the order
/// of a visit is a format: change it together with the section's version. Numbers are written as
/// they lie in memory (little-endian). Hashing and saving only read, loading only writes; a visit
/// asks `loading()` where it must know.
class Archive {
 public:
  // A visit is handed a reference; a copy would have a path and a place in the bytes of its own.
  Archive(const Archive&) = delete;
  Archive& operator=(const Archive&) = delete;
  virtual ~Archive() = default;

  /// True while fields are overwritten by what was saved.
  bool loading() const { return loading_; }

  /// One field: a number, bool or enum, std::string, Eigen matrix of fixed size, quaternion or
  /// Pose, a class with a member `visit(Archive&)` or a function `visit(Archive&, T&)` beside it,
  /// or std::array, vector, optional, variant, pair, map or set of those. Containers are replaced
  /// when loading. A std::span of constant plain values is taken like a vector, and loaded as one.
  /// A field whose type has no part here does not compile; give it a `visit`, or use `property`.
  /// @throws InputError naming the field, when loading meets the end of the section, a bool that is
  /// neither 0 nor 1 or keys that do not ascend.
  template <class T>
  void operator()(const char* name, T& field);

  /// A number or enum that must lie from `low` to `high` when it is loaded; NaN does not. Saving
  /// and hashing do not look at the range.
  /// @throws InputError naming the field.
  template <class T>
  void ranged(const char* name, T& field, const std::type_identity_t<T>& low,
              const std::type_identity_t<T>& high);

  /// A vector whose length the scene has set before: only its elements are state. For arrays that
  /// other arrays are sized by.
  /// @throws InputError when another length was saved.
  template <class T>
  void fixed(const char* name, std::vector<T>& field);

  /// A value that never changes during a run but must be equal where a state is loaded. It is
  /// saved, not hashed. It is saved so that a state of another scene is refused with a reason,
  /// before its fields are read into arrays that do not fit.
  /// @throws InputError with `rule` when another value was saved.
  template <class T>
  void constant(const char* name, const T& value, const std::string& rule);

  /// A field behind functions: `get()` answers its value, `set(value)` takes the loaded one. `get`
  /// is not called while loading, `set` at no other time; so an object that is only made when
  /// loaded can be behind it. The type of the value is that of `get`.
  template <class Get, class Set>
  void property(const char* name, const Get& get, const Set& set);

  /// Fields that are saved but change nothing a run computes afterwards; `reason` says why, and
  /// stands in the byte map. Fields under it that a run depends on would let two runs part unseen,
  /// so the reason is part of the review.
  template <class Body>
  void unhashed(const char* reason, const Body& body);

  /// A tagged part of the state with a version of its own. A tag has 1 to 15 characters, else Error
  /// is thrown. Versions are of sections and not of the whole state, so that a change in one class
  /// leaves the others' alone.
  /// @throws InputError when loading finds another tag or version, or the body reads more or less
  /// than was saved.
  template <class Body>
  void section(const char* tag, std::uint32_t version, const Body& body);

  /// For containers that an archive does not know: takes the number of elements, answers the saved
  /// one when loading; then `item(i, ...)` once each. The archive then knows nothing of the
  /// container; the caller makes room for what is loaded.
  /// @throws InputError for a number beyond the bytes left, before anything is allocated.
  std::uint64_t size(const char* name, std::uint64_t present);
  /// Element `number`; its place stands in the names of the fields that `body` visits.
  template <class Body>
  void item(std::uint64_t number, const Body& body);

  /// While loading, refuses the state unless `good`; at other times does nothing. For rules among
  /// several fields, after they were visited; for one field `ranged` says more.
  /// @throws InputError naming `field` and `rule`.
  void require(bool good, const char* field, const std::string& rule);

 protected:
  // Which of the three an archive is shows in `loading()` and in the virtual functions below,
  // nowhere else.
  explicit Archive(bool loading) : loading_(loading) {}

  // What the kinds of archive do with bytes. `data` is only read unless the archive loads.
  virtual void scalar(void* data, std::size_t size) = 0;  ///< one number, at most 8 bytes
  virtual void block(void* data, std::size_t size) = 0;   ///< many side by side
  // Sections nest; the four answer for the bytes, the templates above for types.
  virtual void begin_section(const char* tag, std::uint32_t version) = 0;
  virtual void end_section() = 0;
  /// Bytes that are left to load in the innermost section.
  virtual std::size_t left() const { return 0; }

  /// False within `unhashed` and `constant`; then `reason` says why (empty for constants).
  bool hashed() const { return unhashed_ == 0; }
  const char* reason() const { return reason_; }
  /// The field that is being visited: "world/tools[2]/force".
  std::string path() const;
  /// Refuses the state: throws InputError that names the field and `rule`.
  [[noreturn]] void fail(const std::string& rule) const;

 private:
  // The parts of types need the bytes and the path, which nobody else does.
  friend struct ArchiveParts;
  class Scope;     // one step deeper in the path, while it lives
  class Unhashed;  // keeps fields out of the hash, while it lives
  struct Place {
    const char* name = nullptr;  // null: an element, by number
    std::uint64_t number = 0;
  };

  // Settled at the start: an archive never turns from saving to loading.
  const bool loading_;
  // How deep `unhashed` and `constant` are nested.
  int unhashed_ = 0;
  const char* reason_ = "";
  // From the outermost to the field at hand; kept as pointers and numbers, so that a visit puts no
  // text together.
  std::vector<Place> places_;
};

}  // namespace navvy

#include "core/archive_parts.h"  // IWYU pragma: export
