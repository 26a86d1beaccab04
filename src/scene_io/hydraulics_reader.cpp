// SPDX-License-Identifier: Apache-2.0
#include "scene_io/hydraulics_reader.h"

#include "scene_io/fields.h"

namespace navvy::scene_io {

namespace {
void read_linkage(Element& element, scene::Cylinder& cylinder, Faults& faults) {
  cylinder.has_linkage = true;
  Fields(element, faults)
      .vec3("rocker_pin_m", cylinder.p_rocker)
      .required("rocker_pin_m")
      .number("rocker_to_rod_m", cylinder.rocker_rod, {0.01, 10})
      .required("rocker_to_rod_m")
      .number("rocker_to_coupler_m", cylinder.rocker_coupler, {0.01, 10})
      .required("rocker_to_coupler_m")
      .number("coupler_length_m", cylinder.coupler, {0.01, 10})
      .required("coupler_length_m")
      .vec3("coupler_pin_m", cylinder.p_coupler)
      .required("coupler_pin_m")
      .finish();
}
}  // namespace

scene::Cylinder read_cylinder(Element& element, const Names& names, Faults& faults) {
  scene::Cylinder cylinder;
  cylinder.name = attribute(element, "name");
  require_attribute_name(element, faults);
  Fields fields(element, faults);
  fields.attribute("name")
      .text("joint", cylinder.joint)
      .required("joint")
      .text("base_link", cylinder.base_link)
      .required("base_link")
      .vec3("base_pin_m", cylinder.p_base)
      .required("base_pin_m")
      .text("rod_link", cylinder.rod_link)
      .required("rod_link")
      .vec3("rod_pin_m", cylinder.p_rod)
      .nested("linkage", [&](Element& linkage) { read_linkage(linkage, cylinder, faults); })
      .whole("count", cylinder.count, {1, 8})
      .number("bore_m", cylinder.bore, {0.005, 1})
      .number("rod_m", cylinder.rod, {0.002, 1})
      .number("pressure_pa", cylinder.pressure, {1e5, 1e8})
      .number("flow_m3_per_s", cylinder.flow, {1e-7, 1})
      .finish();
  if (fields.has("rod_pin_m") == fields.has("linkage"))
    faults.error(element, "",
                 "needs either <rod_pin_m> (acts directly) or <linkage> (acts through a rocker)");
  if (cylinder.rod >= cylinder.bore) faults.error(element, "", "rod_m must be less than bore_m");
  if (cylinder.base_link == cylinder.rod_link && !cylinder.base_link.empty())
    faults.error(element, cylinder.rod_link, "base_link and rod_link must be different links");
  require_name(element, "joint", "joint", names.joints, faults);
  require_name(element, "base_link", "link", names.links, faults);
  require_name(element, "rod_link", "link", names.links, faults);
  return cylinder;
}

void read_pump(Element& element, scene::Pump& pump, Faults& faults) {
  Fields(element, faults)
      .number("flow_m3_per_s", pump.flow, {1e-7, 10})
      .required("flow_m3_per_s")
      .number("power_w", pump.power, {0.1, 1e7})
      .required("power_w")
      .finish();
}

}  // namespace navvy::scene_io
