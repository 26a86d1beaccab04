// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "scene_io/loader.h"
#include "scene_io/xml.h"

namespace navvy::scene_io {

/// Writes the overrides into the document, so that reading checks them like the file's own values.
/// Elements written here have line 0. Reports objects that do not exist. Single settings come last,
/// so a setting wins over an option that means the same value.
void apply_overrides(Document& document, const Overrides& overrides, Faults& faults);

}  // namespace navvy::scene_io
