// SPDX-License-Identifier: Apache-2.0
// Which elements of SDF 1.9 Navvy uses, and what happens with the others.
#pragma once

#include "scene_io/xml.h"

namespace navvy::scene_io {

/// Walks the SDF part of a file (everything outside `navvy:`) below `element` and reports unknown
/// elements, elements that are not supported (error where ignoring them would change the physics,
/// warning where not), values that are no numbers or out of range, and missing names. Extension
/// elements are checked for their place only.
void check_sdf(const Element& element, Faults& faults);

/// True for elements of SDF that Navvy uses; false for extension elements, unknown and ignored
/// ones.
bool is_used_sdf(const Element& element);
/// The same by names: an element `name` below one called `parent`.
bool is_used_sdf(const char* parent, const char* name);

/// Root <sdf> with a version that is understood. False after a fault.
bool check_root(const Element& root, Faults& faults);

}  // namespace navvy::scene_io
