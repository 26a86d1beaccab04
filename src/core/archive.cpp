// SPDX-License-Identifier: Apache-2.0
#include "core/archive.h"

#include "core/error.h"

namespace navvy {

// Built only for errors and byte maps: a visit itself stores pointers and numbers.
std::string Archive::path() const {
  std::string out;
  for (const Place& place : places_) {
    if (place.name == nullptr) {
      out += "[" + std::to_string(place.number) + "]";
    } else {
      if (!out.empty()) out += "/";
      out += place.name;
    }
  }
  return out;
}

// A state that does not fit is bad input, not a bug: it may come from an older version or a broken
// disk. The message says where in the state the visit was and what to do.
void Archive::fail(const std::string& rule) const {
  throw InputError(Fault{Fault::Severity::kError, "snapshot", 0, path(), "", rule,
                         "it was written by another version of Navvy, for another scene, or "
                         "damaged; record it again"});
}

}  // namespace navvy
