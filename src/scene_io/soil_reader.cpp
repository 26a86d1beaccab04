// SPDX-License-Identifier: Apache-2.0
#include "scene_io/soil_reader.h"

#include <algorithm>
#include <filesystem>

#include "scene/soil_values.h"
#include "scene_io/element_reader.h"
#include "scene_io/sdf_rules.h"
#include "scene_io/shipped_files.h"

namespace navvy::scene_io {

namespace {

// Reports broken relations at the element that the scene has, if any.
void check_values(Element& element, const scene::Soil& soil, Faults& faults) {
  for (const Fault& fault : scene::check_relations(soil)) {
    const Element* child =
        // The fault names the value by its path; the last part is the element.
        element.FirstChildElement(fault.element.substr(fault.element.rfind('/') + 1).c_str());
    faults.error(child != nullptr ? *child : element, fault.value, fault.rule, fault.remedy);
  }
}

/// Computes phi from the angle that the element gives, or that it inherits beside a new dilatancy.
void read_friction(const Element& element, scene::Soil& soil, Faults& faults) {
  // Each of the two gives phi, so only one may stand.
  const Element* angle = element.FirstChildElement("friction_angle_deg");
  const Element* repose = element.FirstChildElement("repose_angle_deg");
  if (angle != nullptr && repose != nullptr) {
    const bool steeper = soil.repose_angle > soil.friction_angle;
    faults.error(*repose, text_of(*repose),
                 std::string("give either repose_angle_deg or friction_angle_deg") +
                     (steeper ? "; no heap stands steeper than phi" : ""),
                 "remove one");
    return;
  }
  if (angle != nullptr) soil.tested_friction_angle = soil.friction_angle;
  if (repose != nullptr) {
    soil.friction_test = scene::FrictionTest::kRepose;
    soil.tested_friction_angle = soil.repose_angle;
  }
  if (const auto refused = scene::follow_friction_test(soil)) {
    const Element& dilatancy = child_or_self(element, "dilatancy_angle_deg");
    faults.error(angle != nullptr ? *angle : (repose != nullptr ? *repose : dilatancy),
                 refused->value, refused->rule, refused->remedy);
  }
}

bool inherit(Element& element, const std::string& ref, scene::Soil& soil, Faults& faults) {
  std::error_code ignored;
  const std::string file = soil_file(element, ref);
  if (file.empty() || !std::filesystem::is_regular_file(file, ignored)) {
    faults.error(element, ref, "no such soil", faults.nearest(ref, shipped_files("terrain/soils")));
    return false;
  }
  // Its faults have its own file name and lines.
  const std::vector<scene::Soil> soils = read_soil_file(file, faults);
  if (soils.empty()) return false;
  soil = soils.front();
  return true;
}

}  // namespace

std::string soil_file(const Element& element, const std::string& ref) {
  return data_file(Document::of(element).directory(), ref, "terrain/soils");
}

scene::Soil read_soil(Element& element, Faults& faults) {
  scene::Soil soil;
  const std::string ref = attribute(element, "ref");
  const std::string name = attribute(element, "name");
  // The soil of the reference comes first; the element then replaces its values.
  if (!ref.empty()) {
    // Soil files refer to no others, so there are no loops.
    if (!element.Parent()->ToElement() ||
        std::string(element.Parent()->ToElement()->Name()) == "sdf")
      faults.error(element, ref, "ref is for worlds; a soil file holds values",
                   "give the soil a name=\"...\" and its values");
    else
      inherit(element, ref, soil, faults);
  }
  if (!name.empty()) soil.name = name;
  if (ref.empty() && name.empty())
    faults.error(element, "",
                 "needs an attribute name=\"...\" (own values) or ref=\"...\" (a shipped soil)");
  // Needed below: values that are defaults of these follow the new ones.
  const double cohesion = soil.cohesion, residual = soil.residual_cohesion;
  read_element(element, soil, nullptr, faults);
  read_friction(element, soil, faults);
  // A residual cohesion that was not given follows the cohesion down, so that a clean sand needs
  // one line.
  if (!element.FirstChildElement("residual_cohesion_pa") && soil.cohesion < cohesion)
    soil.residual_cohesion = std::min(residual, soil.cohesion);
  const Element* loose = element.FirstChildElement("loose_cohesion_pa");
  if (loose == nullptr)
    scene::follow_residual_cohesion(soil, residual);
  else if (soil.loose_cohesion > soil.residual_cohesion)
    faults.error(*loose, text_of(*loose), "must not exceed the residual cohesion",
                 "loosening only weakens soil");
  const Element* stiffness = element.FirstChildElement("young_modulus_pa");
  if (stiffness == nullptr) scene::follow_cohesion(soil, cohesion);
  check_values(element, soil, faults);
  if (const auto soft = scene::too_soft(soil))
    faults.warning(stiffness != nullptr ? *stiffness : element, soft->value, soft->rule,
                   soft->remedy);
  return soil;
}

std::vector<scene::Soil> read_soil_file(const std::string& file, Faults& faults) {
  std::vector<scene::Soil> soils;
  const auto document = Document::open(file, faults);
  // A misspelt soil is reported as unknown before it is missing.
  if (!document || !check_root(*document->root(), faults)) return soils;
  check_sdf(*document->root(), faults);
  for (Element* e = document->root()->FirstChildElement("navvy:soil"); e;
       e = e->NextSiblingElement("navvy:soil"))
    soils.push_back(read_soil(*e, faults));
  if (soils.empty())
    faults.error(*document->root(), "", "a soil file needs a <navvy:soil name=\"...\">");
  return soils;
}

}  // namespace navvy::scene_io
