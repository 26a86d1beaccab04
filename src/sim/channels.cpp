// SPDX-License-Identifier: Apache-2.0
#include "sim/channels.h"

#include <array>
#include <cmath>
#include <cstdio>

#include "core/error.h"
#include "scene/fields.h"
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

void Inputs::require(int input, double value) const {
  // The index comes first: the messages below read the name from the list.
  require_index("input", input, size());
  const Channel& channel = channels()[static_cast<std::size_t>(input)];
  // A NaN would pass through a servo into every body and show only steps later, without a name.
  if (!std::isfinite(value))
    throw InputError(Fault{Fault::Severity::kError, "", 0, channel.name, std::to_string(value),
                           "an input must be a finite number", "send a number"});
  // Programs allow the same slack, for rounded numbers.
  constexpr double kSlack = 1e-6;
  if (channel.clamped || (value >= channel.low - kSlack && value <= channel.high + kSlack)) return;
  std::array<char, 96> text{};
  std::snprintf(text.data(), text.size(), "must be from %.6g to %.6g (unit %s)", channel.low,
                channel.high, channel.unit.c_str());
  throw InputError(Fault{Fault::Severity::kError, "", 0, channel.name, scene::short_text(value),
                         text.data(), "send a value within the bounds of the input"});
}

void Inputs::set(int input, double value) {
  require(input, value);
  function(input)(value);
}

int Outputs::index(const std::string& name) const { return require_channel("output", *this, name); }

double Outputs::get(int output) const {
  require_index("output", output, size());
  return function(output)();
}

}  // namespace navvy::sim
