// SPDX-License-Identifier: Apache-2.0
// Events that a scene forbids.
#pragma once

#include "scene/forbidden.h"
#include "scene_io/xml.h"

namespace navvy::scene_io {

/// Reads <navvy:forbid>. Warns of one that forbids nothing.
scene::Forbidden read_forbidden(Element& element, Faults& faults);

}  // namespace navvy::scene_io
