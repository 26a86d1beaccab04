// SPDX-License-Identifier: Apache-2.0
#include "sim/names.h"

#include "core/edit_distance.h"
#include "core/error.h"

namespace navvy::sim {

void throw_unknown(const std::string& kind, const std::string& name,
                   const std::vector<std::string>& known) {
  // Without a candidate the remedy says so.
  const std::string remedy =
      known.empty() ? "there is none at all" : "did you mean '" + nearest_name(known, name) + "'?";
  throw InputError(Fault{Fault::Severity::kError, "", 0, kind, name,
                         "there is no " + kind + " of this name", remedy});
}

void require_index(const std::string& kind, int index, std::size_t count) {
  if (index >= 0 && static_cast<std::size_t>(index) < count) return;
  throw InputError(Fault{Fault::Severity::kError, "", 0, kind, std::to_string(index),
                         "there is no " + kind + " of this index",
                         "there are " + std::to_string(count) + ", counted from 0"});
}

}  // namespace navvy::sim
