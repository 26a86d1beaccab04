// SPDX-License-Identifier: Apache-2.0
#include "scene_io/forbidden_reader.h"

#include "scene_io/design_reader.h"
#include "scene_io/element_reader.h"

namespace navvy::scene_io {

scene::Forbidden read_forbidden(Element& element, Faults& faults) {
  scene::Forbidden out;
  const std::size_t before = faults.error_count();
  read_element(element, out, nullptr, faults);
  if (out.spill) {
    std::size_t i = 0;
    for (const Element* area : children_of(*element.FirstChildElement("spill_outside"), {"area"})) {
      if (i == out.spill->areas.size()) break;
      scene::SpillArea& one = out.spill->areas[i++];
      if (const Element* polygon = area->FirstChildElement("polygon_m"))
        one.polygon = polygon_of(*polygon, one.polygon_numbers, faults);
    }
  }
  if (!out.any() && faults.error_count() == before)
    faults.warning(element, "", "forbids nothing",
                   "set collision, off_site, tip, buried or spill_outside");
  return out;
}

}  // namespace navvy::scene_io
