// SPDX-License-Identifier: Apache-2.0
// Rules for elements of SDF 1.9: which are used, and what happens with the others.
#pragma once

#include <string>
#include <vector>

#include "scene_io/xml.h"

namespace navvy::scene_io {

/// Walks the SDF part of a file (everything outside `navvy:`) below `element` and reports unknown
/// elements, unsupported elements (an error if ignoring them would change the physics, else a
/// warning), values that are no numbers or out of range, and missing names. Of extension elements
/// only the place is checked.
void check_sdf(const Element& element, Faults& faults);

/// Returns true for elements of SDF that Navvy uses, false for extension elements, unknown and
/// ignored ones.
bool is_used_sdf(const Element& element);
/// Returns the same for an element `name` below an element `parent`.
bool is_used_sdf(const char* parent, const char* name);

/// Use of elements of SDF, for the reference. Names are separated by blanks.
struct SdfUse {
  std::string parents, names;
  std::string use;  ///< read, ignored or refused
  std::string why;
};
/// Returns the rules in the order of the table.
std::vector<SdfUse> sdf_uses();

/// Checks that the root is <sdf> of a version that is understood. Returns false after a fault.
bool check_root(const Element& root, Faults& faults);

}  // namespace navvy::scene_io
