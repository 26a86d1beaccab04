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

/// Size of the head of a section [bytes]: tag, version and length of the content.
inline constexpr std::size_t kSectionHead = 16 + 4 + 8;

/// Assigns the bytes of a saved state to fields. Tests use it to name the field of a flipped byte,
/// and people to see where two states differ. It is not part of a saved state.
struct ByteMap {
  /// One saved field and the position of its bytes in the state.
  struct Field {
    /// Position of the first byte in the state, and number of bytes.
    std::size_t offset = 0, size = 0;
    std::string path;    ///< path of the field, e.g. "world/tools[2]/force"
    bool hashed = true;  ///< false: the hash does not include the field
    /// Reason why the field is not hashed; empty for hashed fields and for constants, which loading
    /// compares with the scene.
    std::string reason;
  };
  /// Fields in ascending order of offset. Heads of sections are not included. The length of a list
  /// is a field of its own; an empty list has no other field.
  std::vector<Field> fields;

  /// Returns the field that contains the byte at `offset`; null for a byte in the head of a section
  /// or beyond the end.
  const Field* at(std::size_t offset) const;
};

/// Type-erased implementation of the functions below, so that the archives are compiled once. The
/// call through std::function costs once per object, not once per field.
namespace saved_state {
/// A function that visits the fields of some object.
using Visit = std::function<void(Archive&)>;
/// Implements `add_to_hash`.
void hash(StateHash& sum, const Visit& visit);
/// Implements `saved`; `map` may be null.
std::vector<char> save(const Visit& visit, ByteMap* map);
/// Implements `load_saved`.
void load(std::vector<char> bytes, const Visit& visit);

/// Returns a function that visits a const object for hashing or saving. A `visit` must not change
/// the object in these cases, which the compiler cannot check; tests with flipped bytes detect
/// violations.
template <class T>
Visit reading(const T& object) {
  return [&object](Archive& archive) { const_cast<T&>(object).visit(archive); };
}
}  // namespace saved_state

/// Adds the state of an object to a hash: numbers one by one, plain arrays as bytes, lengths before
/// elements. Heads of sections, constants and `unhashed` fields are not included. On the same
/// device, two states with equal hashes have the same future.
template <class T>
void add_to_hash(StateHash& sum, const T& object) {
  saved_state::hash(sum, saved_state::reading(object));
}

/// Returns the hash of an object's state; call `.digest()` or `.hex()` on the result. It needs one
/// pass over the object's numbers and no memory.
template <class T>
StateHash hash_of(const T& object) {
  StateHash sum;
  add_to_hash(sum, object);
  return sum;
}

/// Returns the state of an object as bytes, without their total number. If `map` is not null, it
/// must be empty and receives the field of each byte, which is slow, as each field gets a text.
/// @throws Error for a section whose tag is empty or too long
template <class T>
std::vector<char> saved(const T& object, ByteMap* map = nullptr) {
  return saved_state::save(saved_state::reading(object), map);
}

/// Loads an object from bytes that `saved` returned. Any input is safe, whatever its length and
/// content: nothing is read beyond the end, memory use is limited by the number of bytes, and the
/// object's `visit` checks the values.
/// @throws InputError naming the field, also if bytes are left over; the object is then only partly
/// loaded and must be loaded again or destroyed
template <class T>
void load_saved(std::vector<char> bytes, T& object) {
  saved_state::load(std::move(bytes), [&object](Archive& archive) { object.visit(archive); });
}

}  // namespace navvy
