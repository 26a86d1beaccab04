// SPDX-License-Identifier: Apache-2.0
#include "sim/array_outputs.h"

#include <utility>

#include "core/error.h"
#include "sim/names.h"

namespace navvy::sim {
namespace {

// Names as in numpy, so that bindings and files need no table of their own.
constexpr struct {
  const char* name;
  std::size_t size;
  // In the order of ElementType
} kTypes[] = {{"uint8", 1}, {"uint16", 2}, {"int32", 4}, {"float32", 4}, {"float64", 8}};

const auto kName = [](const ArrayChannel& channel) -> const std::string& { return channel.name; };

}  // namespace

std::size_t size_of(ElementType type) { return kTypes[static_cast<std::size_t>(type)].size; }
const char* name_of(ElementType type) { return kTypes[static_cast<std::size_t>(type)].name; }

/// A negative or missing length gives no elements, which `add` refuses.
std::size_t ArrayChannel::count() const {
  std::size_t out = shape.empty() ? 0 : 1;
  for (const int length : shape) out *= length > 0 ? static_cast<std::size_t>(length) : 0;
  return out;
}

std::string ArrayChannel::type_text() const {
  std::string out;
  for (const int length : shape) out += (out.empty() ? "" : ",") + std::to_string(length);
  return std::string(name_of(type)) + "[" + out + "]";
}

/// Elements are never converted: a float scan read as double would be another scan.
void ArrayView::require(ElementType type) const {
  if (type == channel_->type) return;
  throw InputError(Fault{Fault::Severity::kError, "", 0, channel_->name, name_of(type),
                         std::string("its elements are ") + name_of(channel_->type),
                         "read it as that type"});
}

/// There are few arrays, so a list is enough. Its order is that of the snapshot.
int ArrayOutputs::find(const std::string& name) const {
  for (std::size_t i = 0; i < channels_.size(); ++i)
    if (channels_[i].name == name) return static_cast<int>(i);
  return -1;
}

int ArrayOutputs::index(const std::string& name) const {
  return index_of("array", channels_, name, kName);
}

/// The view points into the lists: valid until an array is added or the next value published.
ArrayView ArrayOutputs::view(int array) const {
  // Report a wrong index like a wrong name.
  require_index("array", array, channels_.size());
  const auto i = static_cast<std::size_t>(array);
  ArrayView out;
  out.channel_ = &channels_[i];
  out.X_WF_ = &values_[i].X_WF;
  out.bytes_ = values_[i].bytes;
  out.sequence_ = values_[i].sequence;
  out.time_ = values_[i].time;
  out.delivered_ = values_[i].delivered;
  return out;
}

void ArrayOutputs::require_elements(const ArrayChannel& channel) {
  if (channel.count() > 0) return;
  // Such an array would look published and show nothing.
  throw InputError(Fault{Fault::Severity::kError, "", 0, channel.name, channel.type_text(),
                         "an array needs a shape with elements", "give it lengths > 0"});
}

// Allocates the storage once; publishing then never allocates.
int ArrayOutputs::add(ArrayChannel channel) {
  // Checked at the declaration, before the first step.
  require_elements(channel);
  if (find(channel.name) >= 0)
    throw InputError(Fault{Fault::Severity::kError, "", 0, channel.name, channel.name,
                           "there is already an array of this name", "choose another name"});
  Value value;
  // Zeros until the first value. The storage never moves again, so readers may store its address.
  value.bytes.resize(channel.count() * size_of(channel.type));
  channels_.push_back(std::move(channel));
  values_.push_back(std::move(value));
  return static_cast<int>(channels_.size()) - 1;
}

// Counts the publication, which readers use to detect a new value.
std::span<std::byte> ArrayOutputs::publish(int array, double time, const Pose& X_WF,
                                           double delivered) {
  require_index("array", array, channels_.size());
  Value& value = values_[static_cast<std::size_t>(array)];
  // Stamped before it is filled: the caller writes in place, which saves a copy of every image.
  ++value.sequence;
  value.time = time;
  value.delivered = delivered;
  value.X_WF = X_WF;
  return value.bytes;
}

// Everything that a reader can see is state: an operator may act on the scan that was current when
// the snapshot was taken.
void ArrayOutputs::visit(Archive& a) {
  const std::string rule =
      "the snapshot has other arrays than the world; add the same samplers, then load";
  // The snapshot must hold as many arrays, under the same names, in the same order.
  a.constant("count", channels_.size(), rule);
  const auto visit_value = [&](std::size_t i) {
    a.constant("name", channels_[i].name, rule);
    // The stamps too: an old scan with a new stamp would be another state.
    a("sequence", values_[i].sequence);
    a("time", values_[i].time);
    a("delivered", values_[i].delivered);
    a("X_WF", values_[i].X_WF);
    // The shape may differ under the same name.
    a.fixed("bytes", values_[i].bytes);
  };
  for (std::size_t i = 0; i < channels_.size(); ++i)
    a.item(i, [&] {
      if (channels_[i].hashed) return visit_value(i);
      a.unhashed("the sampler changes nothing that a run computes", [&] { visit_value(i); });
    });
}

}  // namespace navvy::sim
