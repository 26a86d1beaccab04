// SPDX-License-Identifier: Apache-2.0
// How an Archive takes each kind of field. Comes with core/archive.h; do not include it alone.
//
// Every container writes its length first, then its elements in their order, so that nothing an element says can be
// taken for another list's. Loading believes no length: it is compared with the bytes left, and containers of classes
// grow element by element, so memory follows what is really there.
#pragma once

#include <map>
#include <optional>
#include <set>
#include <variant>

#include "core/archive.h"

namespace navvy {

/// A type that lists its own fields, as a member or as a function beside it.
template <class T>
concept Visitable = requires(T& object, Archive& archive) {
  object.visit(archive);
};
template <class T>
concept VisitableBeside = requires(T& object, Archive& archive) {
  visit(archive, object);
};

/// Names are string literals or as long-lived: only the pointer is kept.
class Archive::Scope {
 public:
  Scope(Archive& archive, const char* name) : archive_(archive) { archive_.places_.push_back({name, 0}); }
  Scope(Archive& archive, std::uint64_t number) : archive_(archive) { archive_.places_.push_back({nullptr, number}); }
  ~Scope() { archive_.places_.pop_back(); }
  Scope(const Scope&) = delete;
  Scope& operator=(const Scope&) = delete;

 private:
  Archive& archive_;
};

/// They nest: what lies inside stays out of the hash until the outermost ends.
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

 private:
  Archive& archive_;
  const char* before_;
};

/// One function `part` a kind of field. A struct of static members, so that each sees all others whatever their order:
/// containers hold containers.
struct ArchiveParts {
  /// A length. Every element takes a byte at least, so a longer one than the bytes left is a lie.
  static std::uint64_t count(Archive& a, std::uint64_t present) {
    a.scalar(&present, sizeof present);
    if (a.loading_ && present > a.left()) a.fail("a length is beyond the end of the section");
    return present;
  }

  /// Numbers, enums and classes.
  template <class T>
  static void part(Archive& a, T& v) {
    if constexpr (std::is_same_v<T, bool>) {
      // Any other byte in a bool is undefined behaviour, so it goes through an integer.
      auto byte = static_cast<std::uint8_t>(!a.loading_ && v);
      a.scalar(&byte, 1);
      if (a.loading_ && byte > 1) a.fail("must be 0 or 1");
      if (a.loading_) v = byte != 0;
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

  template <class T, int R, int C, int O>
  static void part(Archive& a, Eigen::Matrix<T, R, C, O, R, C>& v) {
    static_assert(kPlain<Eigen::Matrix<T, R, C, O, R, C>>, "matrices of fixed size only");
    a.block(v.data(), sizeof(T) * R * C);
  }
  /// x y z w, as it lies in memory; not normalised, bits stay.
  static void part(Archive& a, Eigen::Quaterniond& q) { a.block(q.coeffs().data(), 4 * sizeof(double)); }
  /// Column by column: three of the turn, then the place; the last row is always 0 0 0 1.
  static void part(Archive& a, Pose& X) {
    for (int c = 0; c < 4; ++c)
      for (int r = 0; r < 3; ++r) a.scalar(&X.matrix()(r, c), sizeof(double));
    if (a.loading_) X.makeAffine();
  }

  /// As bytes, whatever they spell.
  static void part(Archive& a, std::string& text) {
    text.resize(count(a, text.size()));
    a.block(text.data(), text.size());
  }

  template <class T>
  static void part(Archive& a, std::vector<T>& v) {
    static_assert(!std::is_same_v<T, bool>, "std::vector<bool> has no elements to refer to; use std::uint8_t");
    const std::uint64_t n = count(a, v.size());
    if (!a.loading_) return elements(a, v);
    if constexpr (kPlain<T>) {
      if (n > a.left() / sizeof(T)) a.fail("a length is beyond the end of the section");
      v.resize(n);
      elements(a, v);
    } else {
      v.clear();
      for (std::uint64_t i = 0; i < n; ++i) {
        const Archive::Scope scope(a, i);
        part(a, v.emplace_back());
      }
    }
  }
  template <class T, std::size_t N>
  static void part(Archive& a, std::array<T, N>& v) {
    elements(a, v);
  }
  /// What lies side by side, in one run where the type allows it: a state of 100 MB is hashed a word at a time then.
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

  /// Without names of their own: "first" would tell a reader nothing.
  template <class A, class B>
  static void part(Archive& a, std::pair<A, B>& v) {
    part(a, v.first);
    part(a, v.second);
  }

  /// An empty one writes no value: nothing stale is saved or hashed.
  template <class T>
  static void part(Archive& a, std::optional<T>& v) {
    bool held = v.has_value();
    part(a, held);
    if (a.loading_) v = held ? std::optional<T>(std::in_place) : std::nullopt;
    if (v) part(a, *v);
  }

  /// Which alternative, then that one; loading makes it anew.
  template <class... T>
  static void part(Archive& a, std::variant<T...>& v) {
    auto index = static_cast<std::uint32_t>(v.index());
    a.scalar(&index, sizeof index);
    if (a.loading_ && index >= sizeof...(T)) a.fail("names an alternative that does not exist");
    if (a.loading_) emplace(v, index, std::index_sequence_for<T...>());
    std::visit([&a](auto& held) { part(a, held); }, v);
  }
  template <class Variant, std::size_t... I>
  static void emplace(Variant& v, std::uint32_t index, std::index_sequence<I...>) {
    ((index == I ? static_cast<void>(v.template emplace<I>()) : void()), ...);
  }

  template <class K, class V>
  static void part(Archive& a, std::map<K, V>& v) {
    if (a.loading_) {
      load_keys<K>(a, v, [&](K key) { part(a, v.emplace_hint(v.end(), std::move(key), V{})->second); });
      return;
    }
    count(a, v.size());
    std::uint64_t i = 0;
    for (auto& [key, value] : v) {
      const Archive::Scope scope(a, i++);
      K copy = key;
      part(a, copy);
      part(a, value);
    }
  }
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
  /// Loads a sorted container; `add` takes each key and reads what belongs to it. Only one order is ours: a state with
  /// another one, or with a key twice, was not written by a SaveArchive.
  template <class K, class Container, class Add>
  static void load_keys(Archive& a, Container& v, const Add& add) {
    v.clear();
    const std::uint64_t n = count(a, 0);
    std::optional<K> last;
    for (std::uint64_t i = 0; i < n; ++i) {
      const Archive::Scope scope(a, i);
      K key{};
      part(a, key);
      if (last && !v.key_comp()(*last, key)) a.fail("keys must ascend");
      last = key;
      add(std::move(key));
    }
  }
};

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
  // The length is hashed like any other, although it cannot differ.
  if (ArchiveParts::count(*this, field.size()) != field.size()) fail("has another length than in the scene");
  ArchiveParts::elements(*this, field);
}

template <class T>
void Archive::constant(const char* name, const T& value, const std::string& rule) {
  const Scope scope(*this, name);
  // Two runs of one scene cannot differ in it, so it would tell a hash nothing.
  const Unhashed silent(*this, "");
  T found = value;
  ArchiveParts::part(*this, found);
  if (loading_ && !(found == value)) fail(rule);
}

template <class Get, class Set>
void Archive::property(const char* name, const Get& get, const Set& set) {
  const Scope scope(*this, name);
  // A loading archive must not ask for what may not exist yet.
  std::decay_t<decltype(get())> value{};
  if (!loading_) value = get();
  ArchiveParts::part(*this, value);
  if (loading_) set(value);
}

template <class Body>
void Archive::unhashed(const char* reason, const Body& body) {
  const Unhashed silent(*this, reason);
  body();
}

template <class Body>
void Archive::section(const char* tag, std::uint32_t version, const Body& body) {
  const Scope scope(*this, tag);
  begin_section(tag, version);
  // An exception leaves the section open; the archive is of no use then.
  body();
  end_section();
}

inline std::uint64_t Archive::size(const char* name, std::uint64_t present) {
  const Scope scope(*this, name);
  return ArchiveParts::count(*this, present);
}

template <class Body>
void Archive::item(std::uint64_t number, const Body& body) {
  const Scope scope(*this, number);
  body();
}

inline void Archive::require(bool good, const char* field, const std::string& rule) {
  if (good || !loading_) return;
  const Scope scope(*this, field);
  fail(rule);
}

}  // namespace navvy
