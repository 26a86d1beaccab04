// SPDX-License-Identifier: Apache-2.0
// Named arrays with time stamps: scans, images, grids. Names and look-ups work as for scalar
// channels (sim/channels.h).
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

/// Type of an array's elements. These five types are enough for scans, images, grids and labels;
/// each additional type would have to be supported by every client.
enum class ElementType { kUint8, kUint16, kInt32, kFloat32, kFloat64 };

/// Returns the element type that corresponds to the C++ type T. Does not compile for types without
/// one.
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

/// Returns the size of one element of this type [bytes].
std::size_t size_of(ElementType type);
/// Returns the name of the element type in NumPy, such as "float32".
const char* name_of(ElementType type);

/// Description of an array. It does not change after the array was declared. Name, unit, meaning
/// and frame are texts for people and for other programs; Navvy does not interpret them.
struct ArrayChannel {
  /// Name of the array, such as "excavator/height_grid".
  std::string name;
  /// Unit of the elements as text; "1" for dimensionless numbers.
  std::string unit;
  /// One-line description of the array.
  std::string meaning;
  /// Name of the frame F that values or grid points refer to: "world", a link such as
  /// "excavator/boom", or a frame of the sampler.
  std::string frame;
  /// Type of the elements.
  ElementType type = ElementType::kFloat32;
  /// Lengths of the dimensions in row-major order, the slowest dimension first: {rows, columns} of
  /// a grid, {height, width, 3} of a colour image.
  std::vector<int> shape;
  /// Publication rate in publications per second of simulated time; 0 means one after every step.
  double rate = 0;
  /// False: values are left out of the hash of the world's state (Sampler::hashed).
  bool hashed = true;

  /// Returns the number of elements; 0 if the shape is empty or contains a length that is not
  /// positive.
  std::size_t count() const;
  /// Returns element type and shape as one word: "float32[64,48]".
  std::string type_text() const;
};

/// Read-only view of an array's latest value, without a copy. It is valid until the world takes a
/// step, loads a snapshot, gets another sampler or is destroyed.
class ArrayView {
 public:
  /// Returns the description of the array: unit, frame and shape.
  const ArrayChannel& channel() const { return *channel_; }
  /// Returns the number of values published so far. It is 0 before the first one; all elements are
  /// then zero.
  std::uint64_t sequence() const { return sequence_; }
  /// Returns the simulated time at which the value was measured [s].
  double time() const { return time_; }
  /// Returns the simulated time at which the value was published [s]; later than `time()` for a
  /// sensor with latency.
  double delivered() const { return delivered_; }
  /// Returns the pose of the array's frame F in W at the time of the value.
  const Pose& X_WF() const { return *X_WF_; }
  /// Returns the elements as raw bytes in row-major order and native byte order, for language
  /// bindings and files.
  std::span<const std::byte> bytes() const { return bytes_; }
  /// Returns all elements in row-major order.
  /// @throws InputError if T is not the element type of the array.
  template <class T>
  std::span<const T> values() const {
    require(element_type<T>());
    return {reinterpret_cast<const T*>(bytes_.data()), bytes_.size() / sizeof(T)};
  }

 private:
  friend class ArrayOutputs;
  /// Checks that `type` is the element type of the array.
  /// @throws InputError if it is not.
  void require(ElementType type) const;
  const ArrayChannel* channel_ = nullptr;
  const Pose* X_WF_ = nullptr;
  /// Storage of the array's elements, owned by ArrayOutputs.
  std::span<const std::byte> bytes_;
  std::uint64_t sequence_ = 0;
  double time_ = 0, delivered_ = 0;
};

/// All arrays of a world. Clients read them; samplers fill them through a Publisher.
///
/// The storage of an array is allocated once and never moves. An array costs time only when it is
/// published. Not thread-safe.
class ArrayOutputs {
 public:
  /// Returns the descriptions of all arrays in the order of their indices.
  const std::vector<ArrayChannel>& channels() const { return channels_; }
  /// Returns the index of the array with this name, or -1 if there is none.
  int find(const std::string& name) const;
  /// Returns the index of the array with this name.
  /// @throws InputError if there is none; the message names the most similar array.
  int index(const std::string& name) const;
  /// Returns a view of the latest value of the array with the index `array`.
  /// @throws InputError for an index that does not exist.
  ArrayView view(int array) const;
  /// Returns a view of the latest value of the array with this name. Searches for the name in each
  /// call.
  /// @throws InputError if there is none.
  ArrayView view(const std::string& name) const { return view(index(name)); }

  /// Checks that the shape of an array has at least one element.
  /// @throws InputError if it has none.
  static void require_elements(const ArrayChannel& channel);
  /// Adds an array whose elements are zero and returns its index.
  /// @throws InputError for a shape without elements or a name that is in use.
  int add(ArrayChannel channel);
  /// Starts a new value of the array with the index `array` and returns its storage, which the
  /// caller must fill completely before anyone reads it. `time` is the simulated time of the
  /// measurement [s], `X_WF` the pose in W of the array's frame at that time, and `delivered` the
  /// present time [s].
  /// @throws InputError for an index that does not exist.
  std::span<std::byte> publish(int array, double time, const Pose& X_WF, double delivered);

  /// Visits sequence number, time stamp, frame pose and bytes of every array: everything that
  /// readers can see is part of the state. Loading requires a list of arrays with the same names,
  /// types and shapes.
  void visit(Archive& a);

 private:
  /// Latest value of one array.
  struct Value {
    /// Elements in row-major order and native byte order.
    std::vector<std::byte> bytes;
    /// Number of values published so far.
    std::uint64_t sequence = 0;
    /// Simulated times at which the value was measured and published [s].
    double time = 0, delivered = 0;
    /// Pose of the array's frame F in W at that time.
    Pose X_WF = Pose::Identity();
  };
  /// Descriptions of all arrays, in the order of their indices.
  std::vector<ArrayChannel> channels_;
  /// Latest value of each array, in the order of `channels_`.
  std::vector<Value> values_;
};

}  // namespace navvy::sim
