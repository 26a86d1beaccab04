// SPDX-License-Identifier: Apache-2.0
#include "core/archive.h"

#include "core/error.h"

namespace navvy {

// Put together only when something is wrong or a byte map is asked for: a visit itself keeps
// pointers and numbers.
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
// disk, so the message says what to do about it and where in the state the visit stood.
void Archive::fail(const std::string& rule) const {
  throw InputError(Fault{Fault::Severity::kError, "snapshot", 0, path(), "", rule,
                         "it was written by another version of Navvy, for another scene, or "
                         "damaged; record it again"});
}

}  // namespace navvy
