// SPDX-License-Identifier: Apache-2.0
#include "sim/sampler.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "core/error.h"
#include "sim/names.h"
#include "sim/timing.h"

namespace navvy::sim {

// Scalars and arrays share one name space, so that a client may look a name up without knowing
// which of them it is.
void Publisher::require_new(const std::string& name) const {
  const auto called = [&](const auto& channel) { return channel.name == name; };
  const bool declared = std::any_of(new_numbers_.begin(), new_numbers_.end(), called) ||
                        std::any_of(new_arrays_.begin(), new_arrays_.end(), called);
  if (!declared && outputs_.find(name) < 0 && arrays_.find(name) < 0) return;
  throw InputError(Fault{Fault::Severity::kError, "", 0, "output", name,
                         "there is already an output of this name",
                         "put the sampler's own name before it"});
}

/// The declared type is what readers in other languages were told.
void Publisher::require(int array, ElementType type) const {
  const ArrayChannel& channel = arrays_.view(array).channel();
  if (channel.type == type) return;
  throw InputError(Fault{Fault::Severity::kError, "", 0, channel.name, name_of(type),
                         std::string("it was declared as ") + name_of(channel.type),
                         "fill it with that type"});
}

int Publisher::declare(Channel channel) {
  require_new(channel.name);
  // The output reads through a pointer: each number has an address that a growing list does not
  // move.
  numbers_.push_back(std::make_unique<double>(0.0));
  new_numbers_.push_back(std::move(channel));
  return static_cast<int>(numbers_.size()) - 1;
}

int Publisher::declare(ArrayChannel channel) {
  require_new(channel.name);
  // The rate is the sampler's, whatever the channel said.
  channel.rate = rate_;
  ArrayOutputs::require_elements(channel);
  new_arrays_.push_back(std::move(channel));
  return static_cast<int>(arrays_.channels().size() + new_arrays_.size()) - 1;
}

void Publisher::commit() {
  // The first of the new numbers is the first that no output reads yet.
  std::size_t next = numbers_.size() - new_numbers_.size();
  for (Channel& channel : new_numbers_)
    outputs_.add(std::move(channel), [value = numbers_[next++].get()] { return *value; });
  for (ArrayChannel& channel : new_arrays_) arrays_.add(std::move(channel));
  new_numbers_.clear();
  new_arrays_.clear();
}

/// Into the same declarations: their count is all that can differ, as the sampler's name was
/// compared before.
void Publisher::visit(Archive& a) {
  a.constant("count", numbers_.size(),
             "the snapshot has a sampler with another number of outputs; add the same samplers, "
             "then load");
  for (std::size_t i = 0; i < numbers_.size(); ++i) a.item(i, [&] { a("value", *numbers_[i]); });
}

SamplerSlot::SamplerSlot(std::unique_ptr<Sampler> sampler, Outputs& outputs, ArrayOutputs& arrays)
    : sampler_(std::move(sampler)),
      // Name and rate are asked once: a sampler that changed them would change what its channels
      // say.
      name_(sampler_->name()),
      rate_(sampler_->rate()),
      publisher_(outputs, arrays, rate_) {
  if (!std::isfinite(rate_) || rate_ < 0)
    throw InputError(Fault{Fault::Severity::kError, "", 0, name_, std::to_string(rate_),
                           "samples per second must be a number not below 0",
                           "0 samples after every step"});
  sampler_->declare(publisher_);
  publisher_.commit();
}

bool SamplerSlot::due(std::uint64_t step, double dt) const {
  return rate_ == 0 || sample_due(step, dt, rate_);
}

void SamplerSlot::sample(const World& world, double time) {
  // The world's time, so that all samples of one step carry the same stamp.
  publisher_.stamp(time);
  sampler_->sample(world, publisher_);
}

/// Numbers first: a sampler without state of its own still has what it published. Under the
/// sampler's name, by which a load finds out that it meets another one.
void SamplerSlot::visit(Archive& a) {
  a.constant("name", name_,
             "the snapshot has another sampler here, the world has '" + name_ +
                 "'; add the same samplers in the same order, then load");
  a("numbers", publisher_);
  a("sampler", *sampler_);
}

}  // namespace navvy::sim
