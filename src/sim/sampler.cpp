// SPDX-License-Identifier: Apache-2.0
#include "sim/sampler.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "core/error.h"
#include "sim/names.h"
#include "sim/timing.h"

namespace navvy::sim {

// Scalars and arrays share one name space, so that a client may look up a name without knowing its
// kind.
void Publisher::require_new(const std::string& name) const {
  const auto called = [&](const auto& channel) { return channel.name == name; };
  const bool declared = std::any_of(new_numbers_.begin(), new_numbers_.end(), called) ||
                        std::any_of(new_arrays_.begin(), new_arrays_.end(), called);
  if (!declared && outputs_.find(name) < 0 && arrays_.find(name) < 0) return;
  throw InputError(Fault{Fault::Severity::kError, "", 0, "output", name,
                         "there is already an output of this name",
                         "begin the name with the sampler's own"});
}

/// Readers in other languages rely on the declared type.
void Publisher::require(int array, ElementType type) const {
  const ArrayChannel& channel = arrays_.view(array).channel();
  if (channel.type == type) return;
  throw InputError(Fault{Fault::Severity::kError, "", 0, channel.name, name_of(type),
                         std::string("it was declared as ") + name_of(channel.type),
                         "fill it with that type"});
}

int Publisher::declare(Channel channel) {
  require_new(channel.name);
  // The output reads through a pointer, so each number needs an address that a growing list does
  // not change.
  numbers_.push_back(std::make_unique<double>(0.0));
  new_numbers_.push_back(std::move(channel));
  return static_cast<int>(numbers_.size()) - 1;
}

int Publisher::declare(ArrayChannel channel) {
  require_new(channel.name);
  // The rate is the sampler's. One that looks at every step may publish less often.
  if (rate_ > 0) channel.rate = rate_;
  channel.hashed = hashed_;
  ArrayOutputs::require_elements(channel);
  new_arrays_.push_back(std::move(channel));
  return static_cast<int>(arrays_.channels().size() + new_arrays_.size()) - 1;
}

// All names were checked at the declaration, so all channels are added or none.
void Publisher::commit() {
  // The first of the new numbers is the first without an output.
  std::size_t next = numbers_.size() - new_numbers_.size();
  for (Channel& channel : new_numbers_)
    outputs_.add(std::move(channel), [value = numbers_[next++].get()] { return *value; });
  for (ArrayChannel& channel : new_arrays_) arrays_.add(std::move(channel));
  new_numbers_.clear();
  new_arrays_.clear();
}

/// Loads into the same declarations. Only their count can differ, since the sampler's name was
/// compared before.
void Publisher::visit(Archive& a) {
  a.constant("count", numbers_.size(),
             "the snapshot has a sampler with another number of outputs; add the same samplers, "
             "then load");
  for (std::size_t i = 0; i < numbers_.size(); ++i) a.item(i, [&] { a("value", *numbers_[i]); });
}

// A sampler that throws in declare leaves no channel behind.
SamplerSlot::SamplerSlot(std::unique_ptr<Sampler> sampler, Outputs& outputs, ArrayOutputs& arrays)
    : sampler_(std::move(sampler)),
      // Read once: a sampler that changed its name or rate would contradict its channels.
      name_(sampler_->name()),
      rate_(sampler_->rate()),
      publisher_(outputs, arrays, rate_, sampler_->hashed()) {
  if (!std::isfinite(rate_) || rate_ < 0)
    throw InputError(Fault{Fault::Severity::kError, "", 0, name_, std::to_string(rate_),
                           "the rate must be a finite number of samples per second, not negative",
                           "give 0 to sample after every step"});
  sampler_->declare(publisher_);
  publisher_.commit();
}

bool SamplerSlot::due(std::uint64_t step, double dt) const {
  return rate_ == 0 || sample_due(step, dt, rate_);
}

void SamplerSlot::sample(const World& world, double time) {
  // The world's time, so that all samples of one step have the same stamp.
  publisher_.stamp(time);
  sampler_->sample(world, publisher_);
}

/// Visits the numbers first, since a sampler without state of its own still has them. The section's
/// name is the sampler's, which detects another sampler on loading.
void SamplerSlot::visit(Archive& a) {
  a.constant("name", name_,
             "the snapshot has another sampler here, the world has '" + name_ +
                 "'; add the same samplers in the same order, then load");
  a("numbers", publisher_);
  a("sampler", *sampler_);
}

}  // namespace navvy::sim
