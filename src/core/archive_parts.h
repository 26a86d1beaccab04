// SPDX-License-Identifier: Apache-2.0
// How an Archive takes each type of field. Included by core/archive.h; do not include it directly.
//
// Every container writes its length before its elements, so no element can be mistaken for the
// length of another list. Loading does not trust a length: it is compared with the remaining bytes,
// and containers of classes grow element by element, so memory use follows the data that is really
// there.
//
// Bytes written for each type:
//   bool                        one byte, 0 or 1
//   number, enum                its bytes as in memory (little-endian)
//   Eigen matrix, quaternion    its numbers in storage order
//   Pose                        12 doubles: the rotation column by column, then the translation
//   string, vector, span        length (8 bytes), elements
//   array, pair                 elements
//   optional                    flag (one byte), value if there is one
//   variant                     index of the alternative (4 bytes), its value
//   map, set                    length (8 bytes), keys in ascending order, each with its value
//   class with a visit          its fields
#pragma once

#include <map>
#include <optional>
#include <set>
#include <span>
#include <variant>

#include "core/archive.h"

namespace navvy {

/// A type with a member function `visit(Archive&)`, which lists the fields of the type. It takes
/// precedence over a free function, so that a class may override the free function of its base.
template <class T>
concept Visitable = requires(T& object, Archive& archive) {
  object.visit(archive);
};
/// A type with a free function `visit(Archive&, T&)`. Use it for types of other libraries, and for
/// plain structs that should not depend on archives.
template <class T>
concept VisitableBeside = requires(T& object, Archive& archive) {
  visit(archive, object);
};

/// Appends an element to the path of the current field, which appears in error messages and byte
/// maps, and removes it on destruction. It only stores a pointer or an index; text is built only
/// when it is needed. Names must therefore be string literals or exist as long. Scopes must be
/// destroyed in reverse order of construction; they are local variables and cannot be copied.
class Archive::Scope {
 public:
  /// Appends the name of a field or the tag of a section.
  Scope(Archive& archive, const char* name) : archive_(archive) {
    archive_.places_.push_back({name, 0});
  }
  /// Appends the index `number` of an element in a container.
  Scope(Archive& archive, std::uint64_t number) : archive_(archive) {
    archive_.places_.push_back({nullptr, number});
  }
  ~Scope() { archive_.places_.pop_back(); }
  Scope(const Scope&) = delete;
  Scope& operator=(const Scope&) = delete;

  // The archive outlives every scope, since scopes live within a visit.
 private:
  Archive& archive_;
};

/// Excludes fields from the hash for as long as the object exists. Objects may be nested: the
/// reason of the innermost one applies, and its destruction restores the outer one. Saving and
/// loading are not affected.
class Archive::Unhashed {
 public:
  /// Starts to exclude fields, for `reason`.
  Unhashed(Archive& archive, const char* reason) : archive_(archive), before_(archive.reason_) {
    ++archive_.unhashed_;
    archive_.reason_ = reason;
  }
  ~Unhashed() {
    --archive_.unhashed_;
    archive_.reason_ = before_;
  }
  Unhashed(const Unhashed&) = delete;
  Unhashed& operator=(const Unhashed&) = delete;

  // The state to restore on destruction.
 private:
  Archive& archive_;
  const char* before_;  ///< reason that applied before, restored on destruction
};

/// One overload of `part` per type of field. They are static members of a struct, so that each
/// overload can use all others in any order, as containers contain containers. The bytes that an
/// overload writes are part of every saved state: a change requires new versions of all sections.
struct ArchiveParts {
  /// Visits the length of a container, whose current value is `present`. Returns the saved length
  /// when loading, otherwise `present`. As each element takes at least one byte, a length above the
  /// number of remaining bytes is invalid. The length is also hashed, so that for example the lists
  /// {1, 2} and {1} followed by the number 2 have different hashes.
  static std::uint64_t count(Archive& a, std::uint64_t present) {
    a.scalar(&present, sizeof present);
    if (a.loading_ && present > a.left()) a.fail("a length exceeds the rest of the section");
    return present;
  }

  /// Visits a number, bool, enum or class. The branches are ordered from special to general: a
  /// class with a `visit` is visited even if it could be saved as raw bytes, as its author has
  /// chosen which members to include. Types with padding do not compile, because padding bytes
  /// would make two equal states differ.
  template <class T>
  static void part(Archive& a, T& v) {
    if constexpr (std::is_same_v<T, bool>) {
      // Any other byte in a bool is undefined behaviour, so it goes through an integer.
      auto byte = static_cast<std::uint8_t>(!a.loading_ && v);
      a.scalar(&byte, 1);
      if (a.loading_ && byte > 1) a.fail("must be 0 or 1");
      if (a.loading_) v = byte != 0;
      // Enums are stored by number, so the order of enumerators is part of the format. The caller
      // rejects numbers that are no enumerator, with `ranged`.
    } else if constexpr (std::is_arithmetic_v<T> || std::is_enum_v<T>) {
      static_assert(kPlain<T>, "long double has padding");
      a.scalar(&v, sizeof v);
    } else if constexpr (Visitable<T>) {
      v.visit(a);
    } else if constexpr (VisitableBeside<T>) {
      visit(a, v);
    } else {
      static_assert(kPlain<T>, "give the type a visit(Archive&)");
      a.block(&v, sizeof v);
    }
  }

  /// Visits a matrix of fixed size as raw bytes in its storage order, which is part of the type.
  template <class T, int R, int C, int O>
  static void part(Archive& a, Eigen::Matrix<T, R, C, O, R, C>& v) {
    static_assert(kPlain<Eigen::Matrix<T, R, C, O, R, C>>, "matrices of fixed size only");
    a.block(v.data(), sizeof(T) * R * C);
  }
  /// Visits the elements x y z w of a quaternion as stored, without normalising it: that would
  /// change the last bits at every load, so that a run resumed from a snapshot would diverge from
  /// the original run.
  static void part(Archive& a, Eigen::Quaterniond& q) {
    a.block(q.coeffs().data(), 4 * sizeof(double));
  }
  /// Visits the rotation and the translation of a pose column by column. The last row is always 0 0
  /// 0 1; it is not saved, and `makeAffine` sets it after loading. A loaded rotation that contains
  /// a scale is refused, as all code relies on rigid poses.
  static void part(Archive& a, Pose& X) {
    // One scalar at a time: the last row is not saved, so there is no single run of bytes.
    for (int c = 0; c < 4; ++c)
      for (int r = 0; r < 3; ++r) a.scalar(&X.matrix()(r, c), sizeof(double));
    if (!a.loading_) return;
    X.makeAffine();
    if (!is_rigid(X)) a.fail("must be a finite rigid pose");
  }

  /// Visits a text as its length and bytes, in any encoding.
  static void part(Archive& a, std::string& text) {
    // When saving, this resizes to the present length, which does nothing.
    text.resize(count(a, text.size()));
    a.block(text.data(), text.size());
  }

  /// Visits a vector as its length and elements; loading discards the previous content. Plain
  /// elements are loaded at once, after the number of remaining bytes has been checked. Other
  /// elements may have any size and are loaded one by one; with a wrong length, loading then fails
  /// at the end of the section.
  template <class T>
  static void part(Archive& a, std::vector<T>& v) {
    static_assert(!std::is_same_v<T, bool>,
                  "std::vector<bool> has no elements to refer to; use std::uint8_t");
    const std::uint64_t n = count(a, v.size());
    if (!a.loading_) return elements(a, v);
    // An element may take eight bytes where `count` assumes one, so the bound is checked again; by
    // division, as a product could overflow.
    if constexpr (kPlain<T>) {
      if (n > a.left() / sizeof(T)) a.fail("a length exceeds the rest of the section");
      v.resize(n);
      elements(a, v);
    } else {
      v.clear();
      for (std::uint64_t i = 0; i < n; ++i) {
        // The element's index is part of the path in errors below.
        const Archive::Scope scope(a, i);
        part(a, v.emplace_back());
      }
    }
  }
  /// Visits memory that another object owns, such as a mapped device buffer, so that it need not be
  /// copied to be hashed or saved. A span cannot be loaded; a vector must be visited instead.
  template <class T>
  static void part(Archive& a, std::span<const T>& v) {
    static_assert(kPlain<T>, "plain values only");
    if (a.loading_) a.fail("a view cannot be loaded");
    count(a, v.size());
    // Archives that do not load only read.
    a.block(const_cast<T*>(v.data()), v.size_bytes());
  }
  /// Visits the elements of an array; the length is part of the type and is not written.
  template <class T, std::size_t N>
  static void part(Archive& a, std::array<T, N>& v) {
    elements(a, v);
  }
  /// Visits the elements of a vector or array, without their number. Plain elements are handled as
  /// one block, so that a state of 100 MB is hashed word by word.
  template <class List>
  static void elements(Archive& a, List& v) {
    if constexpr (kPlain<typename List::value_type>) {
      a.block(v.data(), v.size() * sizeof(typename List::value_type));
    } else {
      for (std::size_t i = 0; i < v.size(); ++i) {
        const Archive::Scope scope(a, i);
        part(a, v[i]);
      }
    }
  }

  /// Visits the two members of a pair without names, like two consecutive fields.
  template <class A, class B>
  static void part(Archive& a, std::pair<A, B>& v) {
    part(a, v.first);
    part(a, v.second);
  }

  /// Visits a flag, and then the value if there is one. Loading creates the value with its default
  /// constructor before it is visited.
  template <class T>
  static void part(Archive& a, std::optional<T>& v) {
    // Goes through `part`, which checks that the flag is 0 or 1.
    bool held = v.has_value();
    part(a, held);
    if (a.loading_) v = held ? std::optional<T>(std::in_place) : std::nullopt;
    if (v) part(a, *v);
  }

  /// Visits the index of the current alternative, and then its value. Loading creates the value
  /// with its default constructor before it is visited. The order of the alternatives is part of
  /// the format, so append new ones at the end.
  template <class... T>
  static void part(Archive& a, std::variant<T...>& v) {
    auto index = static_cast<std::uint32_t>(v.index());
    // Checked before use: an invalid index from a damaged file would select nothing and load bytes
    // into the old alternative.
    a.scalar(&index, sizeof index);
    if (a.loading_ && index >= sizeof...(T)) a.fail("must be the index of an alternative");
    if (a.loading_) emplace(v, index, std::index_sequence_for<T...>());
    std::visit([&a](auto& held) { part(a, held); }, v);
  }
  /// Creates the alternative with the run-time index `index` in `v`; I are the indices of all
  /// alternatives.
  template <class Variant, std::size_t... I>
  static void emplace(Variant& v, std::uint32_t index, std::index_sequence<I...>) {
    ((index == I ? static_cast<void>(v.template emplace<I>()) : void()), ...);
  }

  /// Visits the number of entries, and then each key with its value in the order of the map. In
  /// paths, key and value both have the index of their entry. Keys are copied before they are
  /// visited, as an archive takes non-const references.
  template <class K, class V>
  static void part(Archive& a, std::map<K, V>& v) {
    if (a.loading_) {
      load_keys<K>(a, v,
                   [&](K key) { part(a, v.emplace_hint(v.end(), std::move(key), V{})->second); });
      return;
    }
    // Saving and hashing traverse the map in order; the index only serves the path.
    count(a, v.size());
    std::uint64_t i = 0;
    for (auto& [key, value] : v) {
      const Archive::Scope scope(a, i++);
      K copy = key;
      part(a, copy);
      part(a, value);
    }
  }
  /// Visits the number of keys, and then the keys in ascending order. Sorted containers with equal
  /// content write equal bytes, independent of the order of insertion; this does not hold for
  /// unordered containers, which are therefore not supported.
  template <class K>
  static void part(Archive& a, std::set<K>& v) {
    if (a.loading_) {
      load_keys<K>(a, v, [&](K key) { v.insert(v.end(), std::move(key)); });
      return;
    }
    count(a, v.size());
    std::uint64_t i = 0;
    // A copy, since keys are const.
    for (K key : v) {
      const Archive::Scope scope(a, i++);
      part(a, key);
    }
  }
  /// Loads the sorted container `v`, whose previous content is discarded. For each key, `add(key)`
  /// inserts the key and loads the value that belongs to it. Keys must be distinct and in ascending
  /// order, as SaveArchive writes them, so that each can be inserted at the end without a search.
  template <class K, class Container, class Add>
  static void load_keys(Archive& a, Container& v, const Add& add) {
    // The previous content is discarded.
    v.clear();
    // The present count is irrelevant when loading.
    const std::uint64_t n = count(a, 0);
    std::optional<K> last;
    for (std::uint64_t i = 0; i < n; ++i) {
      // The key and its value are one element of the path.
      const Archive::Scope scope(a, i);
      K key{};
      part(a, key);
      if (last && !v.key_comp()(*last, key)) a.fail("keys must be in ascending order");
      last = key;
      add(std::move(key));
    }
  }
};

// Members of Archive that depend on types. Each opens the field's scope first, so that errors name
// the field.
template <class T>
void Archive::operator()(const char* name, T& field) {
  const Scope scope(*this, name);
  ArchiveParts::part(*this, field);
}

template <class T>
void Archive::ranged(const char* name, T& field, const std::type_identity_t<T>& low,
                     const std::type_identity_t<T>& high) {
  const Scope scope(*this, name);
  ArchiveParts::part(*this, field);
  // NaN fails this comparison for every range.
  if (loading_ && !(field >= low && field <= high)) fail("is out of its range");
}

template <class T>
void Archive::fixed(const char* name, std::vector<T>& field) {
  const Scope scope(*this, name);
  // The length is hashed like any other. It differs from `count`'s result only when loading, since
  // other archives return what they are given.
  if (ArchiveParts::count(*this, field.size()) != field.size())
    fail("must have the same length as in the scene");
  ArchiveParts::elements(*this, field);
}

template <class T>
void Archive::constant(const char* name, const T& value, const std::string& rule) {
  const Scope scope(*this, name);
  // Two runs of one scene cannot differ in it, so hashing it is useless.
  const Unhashed silent(*this, "");
  // A copy, since a loading archive overwrites what it visits.
  T found = value;
  ArchiveParts::part(*this, found);
  if (loading_ && !(found == value)) fail(rule);
}

template <class Get, class Set>
void Archive::property(const char* name, const Get& get, const Set& set) {
  const Scope scope(*this, name);
  // `get` must not be called when loading, as the object may not exist yet. The value type must be
  // default constructible and cheap to copy.
  std::decay_t<decltype(get())> value{};
  if (!loading_) value = get();
  ArchiveParts::part(*this, value);
  if (loading_) set(value);
}

template <class Body>
void Archive::unhashed(const char* reason, const Body& body) {
  // Lasts until the body returns or throws.
  const Unhashed silent(*this, reason);
  body();
}

template <class Body>
void Archive::section(const char* tag, std::uint32_t version, const Body& body) {
  // The tag is in the path, so an error in the section's head names the section.
  const Scope scope(*this, tag);
  begin_section(tag, version);
  // An exception leaves the section open; the archive is unusable afterwards.
  body();
  end_section();
}

// Visits the length only; the caller visits the elements with `item`.
inline std::uint64_t Archive::size(const char* name, std::uint64_t present) {
  const Scope scope(*this, name);
  return ArchiveParts::count(*this, present);
}

template <class Body>
void Archive::item(std::uint64_t number, const Body& body) {
  const Scope scope(*this, number);
  body();
}

// The rule may involve several fields; `field` names the one to look at.
inline void Archive::require(bool good, const char* field, const std::string& rule) {
  if (good || !loading_) return;
  const Scope scope(*this, field);
  fail(rule);
}

}  // namespace navvy
