// SPDX-License-Identifier: Apache-2.0
// Stamped arrays by name: scans, images, grids. The same names and look-ups as scalar channels
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

/// What one element is. Five types cover scans, images, grids and labels; others would need a
/// reader everywhere.
enum class ElementType { kUint8, kUint16, kInt32, kFloat32, kFloat64 };

/// Type of one element as C++ has it; other types do not compile.
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

/// Bytes of one element, and its name as numpy writes it ("float32").
std::size_t size_of(ElementType type);
const char* name_of(ElementType type);

/// Names, units and frames are texts for people and for other languages; nothing here interprets
/// them. What an array is; fixed from its declaration on.
struct ArrayChannel {
  std::string name;     ///< e.g. "excavator/height_grid"
  std::string unit;     ///< of every element: "m", "1"
  std::string meaning;  ///< one line for people
  /// Frame F that its numbers or its nodes count in: "world", "excavator/boom", one of its own.
  std::string frame;
  ElementType type = ElementType::kFloat32;
  /// Row major, slowest first: {rows, columns} of a grid, {height, width, 3} of an image.
  std::vector<int> shape;
  double rate = 0;  ///< [1/s] in simulated time; 0: every step

  /// Elements in all.
  std::size_t count() const;
  /// "float32[64,48]".
  /// Type and shape in one word, as `navvy channels` prints it:
  std::string type_text() const;
};

/// The latest value of an array, read in place. Valid until the world steps, loads, or ends.
class ArrayView {
 public:
  /// What it is: unit, frame, shape. Refers to the list of the world.
  const ArrayChannel& channel() const { return *channel_; }
  /// Counts publications; 0: none yet, the elements are zeros.
  std::uint64_t sequence() const { return sequence_; }
  /// Simulated time of what it shows [s].
  double time() const { return time_; }
  /// Where frame F was then.
  const Pose& X_WF() const { return *X_WF_; }
  /// Raw, row major, in the byte order of this machine: for bindings and files.
  std::span<const std::byte> bytes() const { return bytes_; }
  /// The elements, channel().count() of them. @throws InputError when T is not the channel's type.
  template <class T>
  std::span<const T> values() const {
    require(element_type<T>());
    return {reinterpret_cast<const T*>(bytes_.data()), bytes_.size() / sizeof(T)};
  }

 private:
  friend class ArrayOutputs;
  void require(ElementType type) const;
  const ArrayChannel* channel_ = nullptr;
  const Pose* X_WF_ = nullptr;
  std::span<const std::byte> bytes_;
  std::uint64_t sequence_ = 0;
  double time_ = 0;
};

/// Not thread-safe; costs nothing while nobody publishes. The storage of an array keeps its address
/// for life. The arrays of a world. Clients read them; samplers fill them through their Publisher.
class ArrayOutputs {
 public:
  /// In the order in which they were declared.
  const std::vector<ArrayChannel>& channels() const { return channels_; }
  /// -1 when there is none of this name.
  int find(const std::string& name) const;
  /// @throws InputError that names the nearest array.
  int index(const std::string& name) const;
  /// No copy, no memory. @throws InputError for an index that does not exist.
  ArrayView view(int array) const;
  ArrayView view(const std::string& name) const { return view(index(name)); }

  /// @throws InputError for a shape without elements.
  static void require_elements(const ArrayChannel& channel);
  /// A new array of zeros; returns its index. @throws InputError for a shape without elements or a
  /// name in use.
  int add(ArrayChannel channel);
  /// Storage of the next value, stamped `time` [s], of the frame at `X_WF`: the caller fills all of
  /// it now.
  std::span<std::byte> publish(int array, double time, const Pose& X_WF);

  /// Sequence, stamp, frame and bytes of every array: what a reader can see is state. Loads into
  /// the same list of arrays only.
  void visit(Archive& a);

 private:
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
