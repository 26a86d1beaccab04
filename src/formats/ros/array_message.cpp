// SPDX-License-Identifier: Apache-2.0
#include "formats/ros/array_message.h"

#include <nlohmann/json.hpp>
#include <sstream>

#include "core/error.h"
#include "formats/ros/streams.h"

namespace navvy::formats::ros {
namespace {

/// Properties of an element type in messages.
struct ElementInfo {
  const char* name;
  std::size_t bytes;
  MessageKind kind;
};

const ElementInfo& element_info(ArrayElement element) {
  // In the order of the enumerators.
  static const ElementInfo table[] = {{"uint8", 1, MessageKind::kUint8Array},
                                      {"uint16", 2, MessageKind::kUint16Array},
                                      {"int32", 4, MessageKind::kInt32Array},
                                      {"float32", 4, MessageKind::kFloat32Array},
                                      {"float64", 8, MessageKind::kFloat64Array}};
  return table[static_cast<int>(element)];
}

/// Returns the topic of an array: "/excavator/height_grid" for "excavator/height_grid".
std::string topic_of(const std::string& name) {
  std::string out, part;
  for (std::istringstream parts(name); std::getline(parts, part, '/');)
    out += "/" + topic_part(part);
  return out;
}

}  // namespace

// A MultiArray has no header, so unit, frame and meaning go into a description, and the frame into
// /tf.
void write_array(Bag& bag, const ArrayMessage& array) {
  const ElementInfo& element = element_info(array.element);
  std::size_t count = 1;
  for (const int size : array.shape) count *= static_cast<std::size_t>(size);
  if (count * element.bytes != array.data.size())
    throw Error("write_array: " + std::to_string(array.data.size()) + " bytes do not fill the " +
                std::to_string(count) + " elements of '" + array.name + "'");
  const std::int64_t now = stamp(array.time);
  const std::string topic = topic_of(array.name);
  if (const std::string about = topic + "/description"; !bag.has(about))
    bag.write_latched(about, MessageKind::kString, now,
                      string_message(nlohmann::ordered_json{
                          {"name", array.name},
                          {"unit", array.unit},
                          {"meaning", array.meaning},
                          {"frame", array.frame},
                          {"type", element.name},
                          {"shape",
                           array.shape}}.dump()));
  if (array.frame != "world" && !array.frame_is_known)
    bag.write("/tf", MessageKind::kTf, now, tf({{kFrame, array.frame, array.X_WF}}, now));
  bag.write(topic, element.kind, now, multi_array(array.shape, element.bytes, array.data));
}

}  // namespace navvy::formats::ros
