// SPDX-License-Identifier: Apache-2.0
// How an Archive takes each kind of field. Comes with core/archive.h; do not include it alone.
//
// Every container writes its length first, then its elements in their order, so that nothing an
// element says can be taken for another list's. Loading believes no length: it is compared with the
// bytes left, and containers of classes grow element by element, so memory follows what is really
// there.
#pragma once

#include <map>
#include <optional>
#include <set>
#include <span>
#include <variant>

#include "core/archive.h"

namespace navvy {

/// A type that lists its own fields, as a member or as a function beside it. The member wins where
/// a type has both, so a class may hide a free function of its base.
template <class T>
concept Visitable = requires(T& object, Archive& archive) {
  object.visit(archive);
};
/// The other way: for types of foreign libraries, and for structs of data that shall not know
/// archives.
template <class T>
concept VisitableBeside = requires(T& object, Archive& archive) {
  visit(archive, object);
};

/// Names are string literals or as long-lived: only the pointer is kept. A scope is an element of
/// the path that an error or a byte map names, and costs a push and a pop: no text is put together
/// unless somebody asks for it. It must end in reverse order of its beginning, which is why it can
/// only live on the stack and cannot be copied.
class Archive::Scope {
 public:
  /// A named field, or the tag of a section.
  Scope(Archive& archive, const char* name) : archive_(archive) {
    archive_.places_.push_back({name, 0});
  }
  // An element of a container, by its place; it costs no text either.
  Scope(Archive& archive, std::uint64_t number) : archive_(archive) {
    archive_.places_.push_back({nullptr, number});
  }
  ~Scope() { archive_.places_.pop_back(); }
  Scope(const Scope&) = delete;
  Scope& operator=(const Scope&) = delete;

  // The archive outlives every scope on it, as scopes live within a visit.
 private:
  Archive& archive_;
};

/// They nest: what lies inside stays out of the hash until the outermost ends. The reason that is
/// in force is that of the innermost, and the outer one comes back when it ends. Nothing else is
/// switched: fields under it are saved and loaded like any other.
class Archive::Unhashed {
 public:
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

  // What held before, for the way back: reasons nest as scopes do.
 private:
  Archive& archive_;
  const char* before_;
};

/// One function `part` a kind of field. A struct of static members, so that each sees all others
/// whatever their order: containers hold containers. The order of the overloads does not matter to
/// the format; what each writes does, and is part of every saved state: change one and every
/// section's version has to rise.
struct ArchiveParts {
  /// A length. Every element takes a byte at least, so a longer one than the bytes left is a lie.
  /// Hashed as well, so that a list of two and a list of one followed by a number of the same value
  /// differ. Where an archive loads, the number it is handed is overwritten by the saved one;
  /// elsewhere it comes back as it was.
  static std::uint64_t count(Archive& a, std::uint64_t present) {
    a.scalar(&present, sizeof present);
    if (a.loading_ && present > a.left()) a.fail("a length is beyond the end of the section");
    return present;
  }

  /// Numbers, enums and classes. The branches go from the special to the general: a class that has
  /// a visit is visited even where it could be taken as bytes, since its author said which members
  /// count. Padding is the reason for every refusal here: bytes that no member owns would be hashed
  /// and saved as noise, and two equal states would differ.
  template <class T>
  static void part(Archive& a, T& v) {
    if constexpr (std::is_same_v<T, bool>) {
      // Any other byte in a bool is undefined behaviour, so it goes through an integer.
      auto byte = static_cast<std::uint8_t>(!a.loading_ && v);
      a.scalar(&byte, 1);
      if (a.loading_ && byte > 1) a.fail("must be 0 or 1");
      if (a.loading_) v = byte != 0;
      // Enums go by their number, so their order is part of the format. A loaded number that is no
      // enumerator is for the caller to refuse, by `ranged`.
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

  // A matrix goes in one run, in its own storage order. The order is part of the type, so two
  // fields of one type agree.
  template <class T, int R, int C, int O>
  static void part(Archive& a, Eigen::Matrix<T, R, C, O, R, C>& v) {
    static_assert(kPlain<Eigen::Matrix<T, R, C, O, R, C>>, "matrices of fixed size only");
    a.block(v.data(), sizeof(T) * R * C);
  }
  /// x y z w, as it lies in memory; not normalised, bits stay. Normalising here would change the
  /// last bit of a turn at every load, and a run continued from a snapshot would leave the run it
  /// came from.
  static void part(Archive& a, Eigen::Quaterniond& q) {
    a.block(q.coeffs().data(), 4 * sizeof(double));
  }
  /// Column by column: three of the turn, then the place; the last row is always 0 0 0 1.
  /// `makeAffine` sets that row again, which loading did not touch. A turn with a scale in it is
  /// refused: whoever has a pose counts on there being none.
  static void part(Archive& a, Pose& X) {
    // One scalar at a time: the affine matrix has a row that is not saved, so there is no single
    // run of bytes.
    for (int c = 0; c < 4; ++c)
      for (int r = 0; r < 3; ++r) a.scalar(&X.matrix()(r, c), sizeof(double));
    if (!a.loading_) return;
    X.makeAffine();
    if (!is_rigid(X)) a.fail("is no finite place of a rigid body");
  }

  /// As bytes, whatever they spell. No encoding is assumed: whoever shows the text decides what it
  /// means.
  static void part(Archive& a, std::string& text) {
    // While saving, the resize is to the present length and does nothing.
    text.resize(count(a, text.size()));
    a.block(text.data(), text.size());
  }

  // Two ways to load. Plain elements come in one copy, with the length checked in bytes before
  // memory is taken. Others are visited one by one and may be of any size, so the vector grows as
  // they arrive: a lie about the length runs into the end of the section after as many elements as
  // there are bytes. What was in the vector before is gone in both cases.
  template <class T>
  static void part(Archive& a, std::vector<T>& v) {
    static_assert(!std::is_same_v<T, bool>,
                  "std::vector<bool> has no elements to refer to; use std::uint8_t");
    const std::uint64_t n = count(a, v.size());
    if (!a.loading_) return elements(a, v);
    // An element may take eight bytes where `count` has reckoned with one, so the bound is asked
    // again, by division, as a product could wrap around.
    if constexpr (kPlain<T>) {
      if (n > a.left() / sizeof(T)) a.fail("a length is beyond the end of the section");
      v.resize(n);
      elements(a, v);
    } else {
      v.clear();
      for (std::uint64_t i = 0; i < n; ++i) {
        // The element's number stands in the path of whatever fails below.
        const Archive::Scope scope(a, i);
        part(a, v.emplace_back());
      }
    }
  }
  // Memory of someone else, taken where it lies: large arrays of a device need not be copied to be
  // hashed. Whoever loads visits a vector in its place.
  template <class T>
  static void part(Archive& a, std::span<const T>& v) {
    static_assert(kPlain<T>, "plain values only");
    if (a.loading_) a.fail("a view cannot be loaded");
    count(a, v.size());
    // Archives that do not load only read.
    a.block(const_cast<T*>(v.data()), v.size_bytes());
  }
  // The length is in the type, so it is not written.
  template <class T, std::size_t N>
  static void part(Archive& a, std::array<T, N>& v) {
    elements(a, v);
  }
  /// What lies side by side, in one run where the type allows it: a state of 100 MB is hashed a
  /// word at a time then. For vectors and arrays, whose elements both lie side by side.
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

  /// Without names of their own: "first" would tell a reader nothing. The pair is written as two
  /// fields in a row, which is also what a struct of two members would write.
  template <class A, class B>
  static void part(Archive& a, std::pair<A, B>& v) {
    part(a, v.first);
    part(a, v.second);
  }

  /// An empty one writes no value: nothing stale is saved or hashed. Loading makes the value anew
  /// by its default constructor first, so nothing of what the object held before survives.
  template <class T>
  static void part(Archive& a, std::optional<T>& v) {
    // A bool of its own and not a byte of the format's, so the check of 0 or 1 is that of `part`.
    bool held = v.has_value();
    part(a, held);
    if (a.loading_) v = held ? std::optional<T>(std::in_place) : std::nullopt;
    if (v) part(a, *v);
  }

  /// Which alternative, then that one; loading makes it anew. The number counts the alternatives in
  /// the order of the type's list, so that order is part of the format: add new ones at the end.
  template <class... T>
  static void part(Archive& a, std::variant<T...>& v) {
    auto index = static_cast<std::uint32_t>(v.index());
    // Compared before it is used: an index from a damaged file would choose nothing and leave the
    // old alternative with new bytes.
    a.scalar(&index, sizeof index);
    if (a.loading_ && index >= sizeof...(T)) a.fail("names an alternative that does not exist");
    if (a.loading_) emplace(v, index, std::index_sequence_for<T...>());
    std::visit([&a](auto& held) { part(a, held); }, v);
  }
  // The only way to choose an alternative by a number known at run time; folds into a chain of
  // comparisons.
  template <class Variant, std::size_t... I>
  static void emplace(Variant& v, std::uint32_t index, std::index_sequence<I...>) {
    ((index == I ? static_cast<void>(v.template emplace<I>()) : void()), ...);
  }

  // Keys are written with their values, in the order of the map. The key is copied because an
  // archive takes fields by reference and keys are constant; keys are numbers or short names, so
  // the copy is cheap. Each key and its value share one place in the path, the entry's number.
  template <class K, class V>
  static void part(Archive& a, std::map<K, V>& v) {
    if (a.loading_) {
      load_keys<K>(a, v,
                   [&](K key) { part(a, v.emplace_hint(v.end(), std::move(key), V{})->second); });
      return;
    }
    // Saving and hashing walk the map as it is; the numbers of elements serve the path only.
    count(a, v.size());
    std::uint64_t i = 0;
    for (auto& [key, value] : v) {
      const Archive::Scope scope(a, i++);
      K copy = key;
      part(a, copy);
      part(a, value);
    }
  }
  // The same without values. A set holds its own order, so two sets of equal content write equal
  // bytes, whatever the order in which they were filled; the same holds for a map. Unordered
  // containers have no part here for that reason.
  template <class K>
  static void part(Archive& a, std::set<K>& v) {
    if (a.loading_) {
      load_keys<K>(a, v, [&](K key) { v.insert(v.end(), std::move(key)); });
      return;
    }
    count(a, v.size());
    std::uint64_t i = 0;
    for (K key : v) {  // a copy: keys are constant, and an archive is never told apart by constness
      const Archive::Scope scope(a, i++);
      part(a, key);
    }
  }
  /// Loads a sorted container; `add` takes each key and reads what belongs to it. Only one order is
  /// ours: a state with another one, or with a key twice, was not written by a SaveArchive. The
  /// order of keys also keeps `emplace_hint` at the end from ever searching, and makes what is
  /// loaded the same container that was saved, bit for bit.
  template <class K, class Container, class Add>
  static void load_keys(Archive& a, Container& v, const Add& add) {
    // What was in it before is gone: a loaded state is the whole of what it says.
    v.clear();
    // Nothing is present yet, so the number handed in means nothing.
    const std::uint64_t n = count(a, 0);
    std::optional<K> last;
    for (std::uint64_t i = 0; i < n; ++i) {
      // The key and its value are one element of the path.
      const Archive::Scope scope(a, i);
      K key{};
      part(a, key);
      if (last && !v.key_comp()(*last, key)) a.fail("keys must ascend");
      last = key;
      add(std::move(key));
    }
  }
};

// What follows are the members of Archive that know types. Each opens the field's scope first, so
// that everything that goes wrong below it is told with the field's name. The one below is what
// most visits consist of; the others are for fields that need a word more.
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
  // Written so that a NaN is out of every range.
  if (loading_ && !(field >= low && field <= high)) fail("is out of its range");
}

template <class T>
void Archive::fixed(const char* name, std::vector<T>& field) {
  const Scope scope(*this, name);
  // The length is hashed like any other, although it cannot differ. The answer differs from the
  // length only when loading: other archives give back what they are handed.
  if (ArchiveParts::count(*this, field.size()) != field.size())
    fail("has another length than in the scene");
  ArchiveParts::elements(*this, field);
}

template <class T>
void Archive::constant(const char* name, const T& value, const std::string& rule) {
  const Scope scope(*this, name);
  // Two runs of one scene cannot differ in it, so it would tell a hash nothing.
  const Unhashed silent(*this, "");
  // A copy, as the value of a scene is constant and a loading archive would write over it.
  T found = value;
  ArchiveParts::part(*this, found);
  if (loading_ && !(found == value)) fail(rule);
}

template <class Get, class Set>
void Archive::property(const char* name, const Get& get, const Set& set) {
  const Scope scope(*this, name);
  // A loading archive must not ask for what may not exist yet. So the type behind a property has to
  // be default constructible and cheap to copy.
  std::decay_t<decltype(get())> value{};
  if (!loading_) value = get();
  ArchiveParts::part(*this, value);
  if (loading_) set(value);
}

template <class Body>
void Archive::unhashed(const char* reason, const Body& body) {
  // For as long as the body runs, also when it throws.
  const Unhashed silent(*this, reason);
  body();
}

template <class Body>
void Archive::section(const char* tag, std::uint32_t version, const Body& body) {
  // The tag is in the path, so that an error names the section even where its head is wrong.
  const Scope scope(*this, tag);
  begin_section(tag, version);
  // An exception leaves the section open; the archive is of no use then.
  body();
  end_section();
}

// Nothing but the length: the caller visits the elements by `item`, with names that it chooses.
inline std::uint64_t Archive::size(const char* name, std::uint64_t present) {
  const Scope scope(*this, name);
  return ArchiveParts::count(*this, present);
}

template <class Body>
void Archive::item(std::uint64_t number, const Body& body) {
  const Scope scope(*this, number);
  body();
}

// Out of line of the field itself: the rule may take several fields together, and `field` says
// which one to look at.
inline void Archive::require(bool good, const char* field, const std::string& rule) {
  if (good || !loading_) return;
  const Scope scope(*this, field);
  fail(rule);
}

}  // namespace navvy
