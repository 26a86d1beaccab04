// SPDX-License-Identifier: Apache-2.0
// Hash, bytes and loading of any object with a `visit(Archive&)`. Whoever visits needs
// core/archive.h only; this is for whoever asks.
#pragma once

#include <cstddef>
#include <functional>
#include <string>
#include <utility>
#include <vector>

#include "core/archive.h"
#include "core/hash.h"

namespace navvy {

/// Bytes of the head of a section: tag, version, length of what follows.
inline constexpr std::size_t kSectionHead = 16 + 4 + 8;

/// Which field the bytes of a saved state belong to; for tests and for whoever looks into a state.
/// It is how a test says which field a flipped byte belongs to, and how a person finds out what
/// differs between two states. It is never saved.
struct ByteMap {
  struct Field {
    std::size_t offset = 0, size = 0;  ///< [bytes]
    std::string path;                  ///< "world/tools[2]/force"
    bool hashed = true;
    std::string reason;  ///< why not; empty for constants, which loading compares with the scene
  };
  // Empty lists have no bytes and are in no field, though their length is in one.
  std::vector<Field> fields;  ///< ascending by offset; heads of sections are in none

  /// The field of byte `offset`; null in the head of a section and beyond the end.
  const Field* at(std::size_t offset) const;
};

/// What the functions below do for every type. Type-erased, so that the archives themselves are
/// compiled once. The call through std::function is paid once an object, not once a field. `save`
/// takes a null map where none is wanted.
namespace saved_state {
// A visit without its object's type.
using Visit = std::function<void(Archive&)>;
void hash(StateHash& sum, const Visit& visit);
std::vector<char> save(const Visit& visit, ByteMap* map);
void load(std::vector<char> bytes, const Visit& visit, bool whole);

/// Hashing and saving read only, which is the one promise of a visit that the compiler cannot
/// check. A visit that wrote while saving would change the run by looking at it; that is what the
/// tests with flipped bytes find.
template <class T>
Visit reading(const T& object) {
  return [&object](Archive& archive) { const_cast<T&>(object).visit(archive); };
}
}  // namespace saved_state

/// Feeds an object's state to a hash: numbers one by one, runs of plain values as bytes, lengths
/// before elements. Sections and constants count for nothing, fields under `unhashed` neither. Two
/// states of equal hash go on alike on one device, which is what every check of repeatability
/// relies on.
template <class T>
void add_to_hash(StateHash& sum, const T& object) {
  saved_state::hash(sum, saved_state::reading(object));
}

/// Hash of one object's state: `.digest()` or `.hex()`. One number for tests and prints; a world
/// feeds its parts to one sum instead. Costs one pass over the object's numbers, no memory.
template <class T>
StateHash hash_of(const T& object) {
  StateHash sum;
  add_to_hash(sum, object);
  return sum;
}

/// The bytes of one object's state; with a `map`, which field each belongs to (slow: a text a
/// field). The map is cleared by nobody: hand in a new one. The bytes carry no length of their own;
/// whoever writes them to a file frames them. Costs one pass and the bytes, which grow as they
/// come.
/// @throws Error for a section whose tag is empty or too long.
template <class T>
std::vector<char> saved(const T& object, ByteMap* map = nullptr) {
  return saved_state::save(saved_state::reading(object), map);
}

/// Loads an object from what `saved` answered. Input of any length and content is safe: nothing is
/// read beyond the end, and memory follows the bytes that are there. The object's own `require`s
/// decide whether their content is. Costs the bytes and one pass.
/// @throws InputError naming the field, also when bytes are left over; the object is then half
/// loaded and must be loaded again or thrown away.
template <class T>
void load_saved(std::vector<char> bytes, T& object) {
  saved_state::load(
      std::move(bytes), [&object](Archive& archive) { object.visit(archive); }, true);
}

/// The same for an object that reads no more than the first sections of a longer state; what
/// follows is left unread.
template <class T>
void load_front(std::vector<char> bytes, T& object) {
  saved_state::load(
      std::move(bytes), [&object](Archive& archive) { object.visit(archive); }, false);
}

}  // namespace navvy
