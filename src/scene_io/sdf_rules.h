// SPDX-License-Identifier: Apache-2.0
// Rules for elements of SDF 1.9: which of them Navvy uses, and how it treats the others.
#pragma once

#include <string>
#include <vector>

#include "scene_io/xml.h"

namespace navvy::scene_io {

/// Checks all SDF elements (those outside the namespace `navvy:`) below `element`. Reports unknown
/// elements, unsupported elements (an error if ignoring them would change the physics, otherwise a
/// warning), values that are not numbers or are out of range, and missing names. Of extension
/// elements it only checks that they are allowed at their position.
void check_sdf(const Element& element, Faults& faults);

/// Returns true if `element` is an SDF element that Navvy uses; false for extension elements,
/// unknown elements and ignored ones.
bool is_used_sdf(const Element& element);
/// Returns true if Navvy uses the SDF element `name` inside an element `parent`.
bool is_used_sdf(const char* parent, const char* name);

/// Treatment of some SDF elements, for the reference page.
struct SdfUse {
  /// Names of parent elements, and names of the elements inside them to which the rule applies;
  /// each list is separated by blanks.
  std::string parents, names;
  std::string use;  ///< treatment: read, ignored or refused
  std::string why;  ///< reason for the treatment
};
/// Returns the treatment of all SDF elements, in the order of the rules' table.
std::vector<SdfUse> sdf_uses();

/// Checks that the root element is <sdf> with a supported version. Returns false after an error.
bool check_root(const Element& root, Faults& faults);

}  // namespace navvy::scene_io
