// SPDX-License-Identifier: Apache-2.0
// Reads the links and joints of an SDF model. Only this file and sdf_schema use libsdformat.
#pragma once

#include <string>
#include <vector>

#include "scene/machine.h"
#include "scene_io/xml.h"

namespace navvy::scene_io {

/// A joint of SDF's type gearbox: it connects no links, but the angles of two joints. The angle of
/// `child` about `child_axis` is -ratio times that of `parent` about `parent_axis`; both count from
/// `reference`.
struct Gearbox {
  std::string name;                      ///< name of the joint
  std::string parent, child, reference;  ///< names of the links
  double ratio = 1;                      ///< ratio of the angles
  /// Unit vectors of the axes in the machine's frame, with all joints at position zero.
  Vec3 parent_axis = Vec3::UnitZ(), child_axis = Vec3::UnitZ();
};

/// Reads links, inertias, shapes and joints of a <model> into `machine` through libsdformat, which
/// resolves frames and relative poses. The links are ordered as a tree: the base first and every
/// parent before its children; the child of joint i is link i + 1. A joint into a link that another
/// joint moves already closes a loop: of the two, the one that comes first in the file is part of
/// the tree if its parent is. A fixed joint to the world sets `fixed_base`. Gearboxes are appended
/// to `gearboxes`. `check_sdf` must have found no error. Errors that only libsdformat finds are
/// reported at the element that their message names. Returns false after an error.
bool read_sdf_model(const Element& model, scene::Machine& machine, std::vector<Gearbox>& gearboxes,
                    Faults& faults);

}  // namespace navvy::scene_io
