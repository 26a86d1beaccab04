// SPDX-License-Identifier: Apache-2.0
// Time-stamped arrays by name: scans, images, grids. Names and look-ups work as for scalar channels
// (sim/channels.h).
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <type_traits>
#include <vector>

#include "core/archive.h"
#include "core/math.h"

namespace navvy::sim {

/// Type of one element. Five types cover scans, images, grids and labels; each further type would
/// need a reader in every client.
enum class ElementType { kUint8, kUint16, kInt32, kFloat32, kFloat64 };

/// Returns the element type of a C++ type; other types do not compile.
template <class T>
constexpr ElementType element_type() {
  if constexpr (std::is_same_v<T, std::uint8_t>)
    return ElementType::kUint8;
  else if constexpr (std::is_same_v<T, std::uint16_t>)
    return ElementType::kUint16;
  else if constexpr (std::is_same_v<T, std::int32_t>)
    return ElementType::kInt32;
  else if constexpr (std::is_same_v<T, float>)
    return ElementType::kFloat32;
  else {
    static_assert(std::is_same_v<T, double>,
                  "an array holds uint8, uint16, int32, float or double");
    return ElementType::kFloat64;
  }
}

/// Returns the size of one element [bytes], or its name in numpy ("float32").
std::size_t size_of(ElementType type);
const char* name_of(ElementType type);

/// Description of an array, fixed from its declaration on. Names, units and frames are texts for
/// people and other languages; nothing here interprets them.
struct ArrayChannel {
  /// Name, e.g. "excavator/height_grid".
  std::string name;
  /// Unit of every element: "m", "1".
  std::string unit;
  /// Description in one line.
  std::string meaning;
  /// Frame F of its values or nodes: "world", "excavator/boom", or one of its own.
  std::string frame;
  ElementType type = ElementType::kFloat32;
  /// Shape, row major, slowest first: {rows, columns} of a grid, {height, width, 3} of an image.
  std::vector<int> shape;
  /// Publication rate [1/s] in simulated time; 0: every step.
  double rate = 0;

  /// Returns the number of elements.
  std::size_t count() const;
  /// Returns type and shape in one word, "float32[64,48]", as `navvy channels` prints it.
  std::string type_text() const;
};

/// Latest value of an array, read in place. Valid until the world steps, loads or is destroyed.
class ArrayView {
 public:
  /// Returns unit, frame and shape. Refers to the list of the world.
  const ArrayChannel& channel() const { return *channel_; }
  /// Returns the number of publications so far; 0: none, all elements are zero.
  std::uint64_t sequence() const { return sequence_; }
  /// Returns the simulated time of the value [s].
  double time() const { return time_; }
  /// Returns the pose of frame F at that time.
  const Pose& X_WF() const { return *X_WF_; }
  /// Returns the raw bytes, row major, in the byte order of this machine: for bindings and files.
  std::span<const std::byte> bytes() const { return bytes_; }
  /// Returns the elements, channel().count() of them. @throws InputError if T is not the channel's
  /// type.
  template <class T>
  std::span<const T> values() const {
    require(element_type<T>());
    return {reinterpret_cast<const T*>(bytes_.data()), bytes_.size() / sizeof(T)};
  }

 private:
  friend class ArrayOutputs;
  /// @throws InputError if `type` is not the channel's type.
  void require(ElementType type) const;
  const ArrayChannel* channel_ = nullptr;
  const Pose* X_WF_ = nullptr;
  std::span<const std::byte> bytes_;
  std::uint64_t sequence_ = 0;
  double time_ = 0;
};

/// Arrays of a world. Clients read them; samplers fill them through their Publisher.
///
/// The storage of an array never moves. Costs nothing while nothing is published. Not thread-safe.
class ArrayOutputs {
 public:
  /// Returns all arrays in the order of their declaration.
  const std::vector<ArrayChannel>& channels() const { return channels_; }
  /// Returns the index of an array, -1 if there is none of this name.
  int find(const std::string& name) const;
  /// Returns the index of an array. @throws InputError that names the nearest array.
  int index(const std::string& name) const;
  /// Returns a view of an array without copying. @throws InputError for an index that does not
  /// exist.
  ArrayView view(int array) const;
  /// Looks the array up by its name first.
  ArrayView view(const std::string& name) const { return view(index(name)); }

  /// Checks the shape. @throws InputError for a shape without elements.
  static void require_elements(const ArrayChannel& channel);
  /// Adds an array of zeros and returns its index. @throws InputError for a shape without elements
  /// or a name in use.
  int add(ArrayChannel channel);
  /// Returns the storage of the next value, stamped `time` [s], with its frame at `X_WF`. The
  /// caller fills all of it at once.
  std::span<std::byte> publish(int array, double time, const Pose& X_WF);

  /// Visits sequence, time stamp, frame and bytes of every array: everything that a reader can see
  /// is state. Loads only into the same list of arrays.
  void visit(Archive& a);

 private:
  /// Storage and stamp of one array.
  struct Value {
    std::vector<std::byte> bytes;
    std::uint64_t sequence = 0;
    double time = 0;
    Pose X_WF = Pose::Identity();
  };
  std::vector<ArrayChannel> channels_;
  std::vector<Value> values_;
};

}  // namespace navvy::sim
