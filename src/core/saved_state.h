// SPDX-License-Identifier: Apache-2.0
// Hash, bytes and loading of any object with a `visit(Archive&)`. A class that is visited includes
// core/archive.h only; this header is for those who call the functions.
//
//   const std::vector<char> state = saved(world);
//   world.step();
//   load_saved(state, world);  // back to the saved state
//   hash_of(world).hex();      // equal for equal states
#pragma once

#include <cstddef>
#include <functional>
#include <string>
#include <utility>
#include <vector>

#include "core/archive.h"
#include "core/hash.h"

namespace navvy {

/// Size of a section's head [bytes]: tag, version and length of the content.
inline constexpr std::size_t kSectionHead = 16 + 4 + 8;

/// Maps the bytes of a saved state to fields. Tests use it to name the field of a flipped byte, and
/// people to see where two states differ. It is never saved itself.
struct ByteMap {
  struct Field {
    /// Place in the state [bytes].
    std::size_t offset = 0, size = 0;
    /// Path of the field, e.g. "world/tools[2]/force".
    std::string path;
    bool hashed = true;
    /// Reason why the field is not hashed; empty for constants, which loading compares with the
    /// scene.
    std::string reason;
  };
  /// Fields in ascending order of offset, without the heads of sections. An empty list has no entry
  /// of its own; its length belongs to one.
  std::vector<Field> fields;

  /// Returns the field of byte `offset`, or null in the head of a section and beyond the end.
  const Field* at(std::size_t offset) const;
};

/// Type-erased implementation of the functions below, so that the archives are compiled once. The
/// call through std::function costs once per object, not once per field.
namespace saved_state {
// A visit without its object's type.
using Visit = std::function<void(Archive&)>;
/// Implements add_to_hash.
void hash(StateHash& sum, const Visit& visit);
/// Implements `saved`. A null `map` is not filled.
std::vector<char> save(const Visit& visit, ByteMap* map);
/// Implements load_saved.
void load(std::vector<char> bytes, const Visit& visit);

/// Wraps the visit of a const object. Hashing and saving only read, which is the one promise of a
/// visit that the compiler cannot check; the tests with flipped bytes find a visit that writes.
template <class T>
Visit reading(const T& object) {
  return [&object](Archive& archive) { const_cast<T&>(object).visit(archive); };
}
}  // namespace saved_state

/// Adds an object's state to a hash: numbers one by one, runs of plain values as bytes, lengths
/// before elements. Heads of sections, constants and `unhashed` fields are left out. On one device,
/// two states of equal hash have the same future.
template <class T>
void add_to_hash(StateHash& sum, const T& object) {
  saved_state::hash(sum, saved_state::reading(object));
}

/// Returns the hash of one object's state; call `.digest()` or `.hex()` on it. Costs one pass over
/// the object's numbers and no memory.
template <class T>
StateHash hash_of(const T& object) {
  StateHash sum;
  add_to_hash(sum, object);
  return sum;
}

/// Returns the state of an object as bytes, and fills `map`, which must be empty, if it is given
/// (slow: one text per field). The bytes hold no length of their own.
/// @throws Error for a section whose tag is empty or too long.
template <class T>
std::vector<char> saved(const T& object, ByteMap* map = nullptr) {
  return saved_state::save(saved_state::reading(object), map);
}

/// Loads an object from the bytes that `saved` returned. Input of any length and content is safe:
/// nothing is read beyond the end, and memory use follows the number of bytes; the object's own
/// `require`s check the content.
/// @throws InputError naming the field, also if bytes are left over. The object is then half
/// loaded; load it again or discard it.
template <class T>
void load_saved(std::vector<char> bytes, T& object) {
  saved_state::load(std::move(bytes), [&object](Archive& archive) { object.visit(archive); });
}

}  // namespace navvy
