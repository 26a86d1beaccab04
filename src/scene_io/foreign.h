// SPDX-License-Identifier: Apache-2.0
// Rewrites files of other simulators to the SDF 1.9 that the readers of this module understand.
#pragma once

#include "scene_io/loader.h"
#include "scene_io/xml.h"

namespace navvy::scene_io {

/// Rewrites the parsed file `document` in place, so that every later reader sees SDF 1.9. URDF
/// becomes a <model>. Files of SDF 1.3 to 1.6 and 1.10 to 1.12 are brought to 1.9. A file without
/// any element or attribute of `navvy:` counts as foreign: what has no effect in it is removed, in
/// silence where it equals SDF's default or only changes the look, otherwise with one warning for
/// all elements of a kind; `document` is then marked as foreign. Elements keep their file and line.
/// Returns false after an error that leaves nothing to read.
bool import_document(Document& document, Faults& faults);

/// Completes a foreign world after `overrides` were applied: the soil, the size of its ground, its
/// level planes (which are the ground), world frames, and joints to the world.
/// Does nothing for other files.
void complete_world(Document& document, Faults& faults);

/// Returns the text of a scene in which the machine of `file` stands alone, its origin `height` [m]
/// above the ground; the scene is named after the file. `complete_world` adds its ground.
std::string scene_around(const std::string& file, double height);

/// Returns the height above ground [m] at which the origin of a machine is so that its lowest
/// contact shape touches the ground; 0 for a machine without shapes and for one with wheels or
/// tracks of `navvy:`, whose tyres decide.
double height_to_stand(const scene::Machine& machine);

}  // namespace navvy::scene_io
