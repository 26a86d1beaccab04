// SPDX-License-Identifier: Apache-2.0
// Rules for elements of SDF 1.9: which are used, and what happens with the others.
#pragma once

#include <string>
#include <vector>

#include "scene_io/xml.h"

namespace navvy::scene_io {

/// Checks all standard SDF elements below `element` (everything outside `navvy:`): unknown
/// elements, unsupported elements (an error if ignoring them would change the physics, otherwise a
/// warning), invalid values and missing names. For extension elements only the position in the file
/// is checked.
void check_sdf(const Element& element, Faults& faults);

/// Returns true if Navvy reads this standard SDF element; false for extension elements and for
/// unknown or ignored elements.
bool is_used_sdf(const Element& element);
/// Returns true if Navvy reads the SDF element `name` inside an element `parent`.
bool is_used_sdf(const char* parent, const char* name);

/// Treatment of some SDF elements, for the reference page. `parents` and `names` are lists
/// separated by blanks.
struct SdfUse {
  std::string parents, names;
  /// "read", "ignored, with a warning" or "refused".
  std::string use;
  std::string why;
};
/// Returns the treatment of all SDF elements.
std::vector<SdfUse> sdf_uses();

/// Checks that the root element is <sdf> with a supported version. Returns false after an error.
bool check_root(const Element& root, Faults& faults);

}  // namespace navvy::scene_io
