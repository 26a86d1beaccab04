// SPDX-License-Identifier: Apache-2.0
#include "control/outcome.h"

#include <array>

namespace navvy::control {

const char* name_of(StepState state) {
  // In the order of the enum; files and messages share these names.
  static constexpr std::array<const char*, 12> names = {
      "running",     "done",   "blocked", "stalled", "tipped",   "out_of_reach",
      "out_of_time", "buried", "no_path", "moved",   "off_site", "replaced"};
  return names.at(static_cast<std::size_t>(state));
}

void Measurement::visit(Archive& a) {
  a("name", name);
  a("value", value);
}

void StepReport::visit(Archive& a) {
  a("step", step);
  a("element", element);
  // A state beyond the last has no name.
  a.ranged("state", state, StepState::kRunning, StepState::kReplaced);
  a("reason", reason);
  a("start", start);
  a("end", end);
  a("place", place);
  a("measurements", measurements);
}

}  // namespace navvy::control
