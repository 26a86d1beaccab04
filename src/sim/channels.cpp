// SPDX-License-Identifier: Apache-2.0
#include "sim/channels.h"

#include <cmath>

#include "core/error.h"
#include "sim/names.h"

namespace navvy::sim {
namespace {

/// Searches the list for the nearest name only when the map has no exact match.
template <class List>
int require_channel(const std::string& kind, const List& list, const std::string& name) {
  const int found = list.find(name);
  if (found >= 0) return found;
  return index_of(kind, list.channels(), name,
                  [](const Channel& channel) -> const std::string& { return channel.name; });
}

}  // namespace

int Inputs::index(const std::string& name) const { return require_channel("input", *this, name); }

void Inputs::set(int input, double value) {
  // Check the bounds first: the message below reads the name from the list.
  require_index("input", input, size());
  // A NaN would pass through a servo into every body and show only steps later, without a name.
  if (!std::isfinite(value))
    throw InputError(Fault{Fault::Severity::kError, "", 0,
                           channels()[static_cast<std::size_t>(input)].name, std::to_string(value),
                           "an input must be a finite number", "send a number"});
  function(input)(value);
}

int Outputs::index(const std::string& name) const { return require_channel("output", *this, name); }

double Outputs::get(int output) const {
  require_index("output", output, size());
  return function(output)();
}

}  // namespace navvy::sim
