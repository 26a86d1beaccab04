// SPDX-License-Identifier: Apache-2.0
// What a <model> calls its parts, and the rule that whoever names one names one that is there.
#pragma once

#include <map>
#include <string>
#include <vector>

#include "scene_io/xml.h"

namespace navvy::scene_io {

/// Names of a <model> as written, known even where the SDF part has faults.
struct Names {
  std::vector<std::string> links, joints, frames, shells;
  std::map<std::string, std::string> joint_type;
};

Names names_of(const Element& model);

/// A child whose text must be one of `names`; an absent or empty child has been told by the
/// element's own table.
void require_name(const Element& element, const char* child_name, const char* what,
                  const std::vector<std::string>& names, Faults& faults);

/// The element must carry a name="...".
void require_attribute_name(const Element& element, Faults& faults);

}  // namespace navvy::scene_io
