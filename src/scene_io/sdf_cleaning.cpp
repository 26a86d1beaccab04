// SPDX-License-Identifier: Apache-2.0
// Removes from SDF files of other simulators what has no effect here.
#include <algorithm>
#include <cmath>
#include <cstring>

#include "scene/sensor.h"
#include "scene_io/element_reader.h"
#include "scene_io/foreign_private.h"
#include "scene_io/sdf_rules.h"

namespace navvy::scene_io {

namespace {

bool is_called(const Element& element, const char* name) {
  return std::strcmp(element.Name(), name) == 0;
}

bool is_one_of(const Element& element, std::initializer_list<const char*> names) {
  return std::any_of(names.begin(), names.end(),
                     [&](const char* name) { return is_called(element, name); });
}

/// Returns true if every word of the element, and of all elements inside it, is zero or false.
bool is_zero(const Element& element) {
  for (const std::string& word : words_of(text_of(element)))
    if (word != "false" && loose_number(word, 1) != 0) return false;
  for (const Element* e = element.FirstChildElement(); e; e = e->NextSiblingElement())
    if (!is_zero(*e)) return false;
  return true;
}

/// Returns true for an element whose value is SDF's default or has the effect of that, for elements
/// that are refused or ignored otherwise.
bool equals_default(const Element& parent, const Element& element) {
  const auto number = [&] { return loose_number(text_of(element), 0); };
  if (is_called(parent, "link") && is_called(element, "gravity")) return is_true(text_of(element));
  if (is_called(parent, "limit")) {
    // A stop of this stiffness is firm, and negative values mean that there is none.
    if (is_called(element, "stiffness")) return number() >= 1e8 || number() < 0;
    if (is_called(element, "dissipation")) return true;
  }
  // A directional light has no place.
  if (is_called(parent, "light") && is_called(element, "pose")) return true;
  // Gazebo's defaults of bodies that do not rebound.
  if (is_called(element, "threshold")) return number() >= 1e5;
  if (is_called(element, "mu2")) return text_of(element) == child_text(parent, "mu");
  if (is_called(parent, "joint")) {
    const std::string type = attribute(parent, "type");
    if (is_one_of(element, {"thread_pitch", "screw_thread_pitch"})) return type != "screw";
  }
  return is_one_of(element,
                   {"kinematic", "enable_wind", "self_collide", "must_be_base_link",
                    "velocity_decay", "restitution_coefficient", "slip1", "slip2", "fdir1",
                    "transparency", "laser_retro", "fluid_added_mass", "wind", "max_contacts"}) &&
         is_zero(element);
}

/// Returns true for an element that belongs to other types of joints: writers of SDF put it into
/// every joint.
bool is_of_other_joint(const Element& parent, const Element& element) {
  if (!is_called(parent, "joint")) return false;
  const std::string type = attribute(parent, "type");
  if (is_one_of(element, {"gearbox_ratio", "gearbox_reference_body"})) return type != "gearbox";
  return is_called(element, "axis2") && type != "revolute2" && type != "universal" &&
         type != "gearbox";
}

/// Returns true for an element that is refused in files of our own, but whose absence leaves a
/// foreign machine usable: it is ignored with a warning.
bool is_soft(const Element& parent, const Element& element) {
  if (is_one_of(parent, {"surface", "friction", "bounce", "ode", "limit"})) return true;
  return is_one_of(element, {"plugin", "wind", "actor", "fluid_added_mass", "velocity_decay",
                             "gripper", "must_be_base_link"});
}

/// Returns true for shapes that Navvy does not have.
bool lacks_shape(const Element& visual) {
  const Element* geometry = visual.FirstChildElement("geometry");
  if (geometry == nullptr || geometry->FirstChildElement() == nullptr) return true;
  const Element& shape = *geometry->FirstChildElement();
  return sdf_treatment("geometry", shape.Name()) != SdfTreatment::kRead ||
         (is_called(shape, "mesh") && shape.FirstChildElement("submesh") != nullptr);
}

/// Removes elements of one file.
class Cleaning {
 public:
  Cleaning(Document& document, IgnoredKinds& ignored) : document_(document), ignored_(ignored) {}

  void clean(Element& parent) {
    for (Element* e = parent.FirstChildElement(); e != nullptr;) {
      Element* next = e->NextSiblingElement();
      if (drops(parent, *e)) {
        parent.DeleteChild(e);
      } else if (is_part(parent, *e) ||
                 sdf_treatment(parent.Name(), e->Name()) == SdfTreatment::kRead) {
        // These have readers of their own, with rules of their own.
        if (!is_one_of(*e, {"sensor", "mimic"})) clean(*e);
        complete(*e);
      }
      e = next;
    }
  }

 private:
  /// Decides whether a child of `parent` is removed, and counts it where users should know.
  bool drops(Element& parent, Element& element) {
    if (is_called(element, "sensor")) return drops_sensor(element);
    if (is_called(element, "density") && is_called(parent, "collision")) {
      take_density(parent, element);
      return true;
    }
    if (is_of_other_joint(parent, element)) return true;
    // assembly.h merges models inside models.
    if (is_part(parent, element)) return false;
    const bool shape = is_one_of(element, {"visual", "collision"});
    if (shape && lacks_shape(element)) return drops_shape(element);
    if (shape && is_one_of(parent, {"link"})) name_shape(parent, element);
    const std::string kind = parent.Name() + std::string("/") + element.Name();
    std::string why;
    switch (sdf_treatment(parent.Name(), element.Name(), &why)) {
      case SdfTreatment::kRead:
        return false;
      case SdfTreatment::kLook:
        return true;
      case SdfTreatment::kUnknown:
        // Elements of other simulators, such as gz:..., have no meaning in SDF.
        if (std::strchr(element.Name(), ':') == nullptr)
          ignored_.add(element, kind,
                       "SDF 1.9 has no such element here, or Navvy does not know it");
        return true;
      default:
        break;
    }
    if (equals_default(parent, element)) return true;
    const bool refused = sdf_treatment(parent.Name(), element.Name()) == SdfTreatment::kRefused;
    // Without its shape a collision would be reported for lacking one.
    if (refused && is_called(parent, "geometry")) return false;
    // A static model is moved by nothing.
    if (refused && !is_soft(parent, element) && !is_in_static(element)) return false;
    ignored_.add(element, kind, why);
    return true;
  }

  /// Returns true for a model or include inside a model.
  static bool is_part(const Element& parent, const Element& element) {
    return is_called(parent, "model") && is_one_of(element, {"model", "include"});
  }

  static bool is_in_static(const Element& element) {
    for (const auto* up = element.Parent(); up && up->ToElement(); up = up->Parent())
      if (is_called(*up->ToElement(), "model") && is_true(child_text(*up->ToElement(), "static")))
        return true;
    return false;
  }

  /// Sensors keep what our instruments know; the others are counted by type.
  bool drops_sensor(Element& sensor) {
    const std::string type = attribute(sensor, "type");
    const auto& known = scene::sensor_types();
    const bool is_known = std::any_of(known.begin(), known.end(), [&](const auto& one) {
      return type == one.name && std::strchr(one.name, ':') == nullptr;
    });
    if (!is_known) {
      ignored_.add(sensor, "sensor of type " + type, "sensors of this type are not simulated");
      return true;
    }
    for (Element* part : {&sensor, sensor.FirstChildElement("contact")})
      for (const char* name : {"plugin", "topic", "visualize", "always_on", "alwaysOn",
                               "enable_metrics", "gz_frame_id", "ignition_frame_id", "frame_id"})
        while (Element* e = part != nullptr ? part->FirstChildElement(name) : nullptr)
          part->DeleteChild(e);
    if (!has(sensor, "update_rate")) {
      // SDF means every step of its physics engine, which for a laser would be a thousand scans.
      append(document_, sensor, "update_rate", sensor, "10");
      ignored_.add(sensor, "sensor without update_rate", "give it one",
                   "has no update_rate: 10 Hz are assumed");
    }
    return false;
  }

  bool drops_shape(Element& element) {
    const Element* geometry = element.FirstChildElement("geometry");
    const Element* shape = geometry != nullptr ? geometry->FirstChildElement() : nullptr;
    if (shape == nullptr || is_called(*shape, "empty")) return true;
    // Bodies would pass through a missing collision; check_sdf reports it.
    if (is_called(element, "collision")) return false;
    ignored_.add(element, "visual of " + std::string(shape->Name()), "it is not drawn");
    return true;
  }

  /// Names a shape without a name, and one whose name another one has.
  void name_shape(const Element& link, Element& shape) {
    std::string name = attribute(shape, "name");
    bool is_new = !name.empty();
    int place = 0;
    for (const Element* e = link.FirstChildElement(shape.Name()); e != nullptr && e != &shape;
         e = e->NextSiblingElement(shape.Name()), ++place)
      is_new = is_new && attribute(*e, "name") != name;
    if (is_new) return;
    shape.SetAttribute("name",
                       (shape.Name() + std::string("_") + std::to_string(place + 1)).c_str());
  }

  /// Takes a density of SDF 1.11, by which mass and inertia follow from shapes.
  void take_density(Element& collision, const Element& density) {
    const Element* link = collision.Parent()->ToElement();
    const Element* inertial = link != nullptr ? link->FirstChildElement("inertial") : nullptr;
    if (inertial == nullptr || !is_true(attribute(*inertial, "auto"))) return;
    append(document_, collision, "navvy:density_kg_per_m3", density, text_of(density));
  }

  /// Adds what SDF means where an element is missing, and removes values that mean none.
  void complete(Element& element) {
    if (is_called(element, "link")) return complete_link(element);
    if (is_called(element, "limit")) return complete_limit(element);
    // Static links are moved by nothing, so their masses are never used.
    if (is_called(element, "model") && is_true(child_text(element, "static")))
      for (Element* link = element.FirstChildElement("link"); link;
           link = link->NextSiblingElement("link"))
        if (Element* inertial = link->FirstChildElement("inertial")) link->DeleteChild(inertial);
  }

  void complete_link(Element& link) {
    if (is_in_static(link)) return;
    Element* inertial = link.FirstChildElement("inertial");
    if (inertial != nullptr && is_true(attribute(*inertial, "auto"))) {
      link.DeleteChild(inertial);
      // SDF's default density is that of water.
      bool any = false;
      for (const Element* e = link.FirstChildElement("collision"); e;
           e = e->NextSiblingElement("collision"))
        any = any || has(*e, "navvy:density_kg_per_m3");
      if (!any) append(document_, link, "navvy:density_kg_per_m3", link, "1000");
      return;
    }
    if (inertial == nullptr) inertial = &append(document_, link, "inertial", link);
    if (has(*inertial, "mass")) return;
    // SDF's default is 1 kg with 1 kg m2 about each axis.
    append(document_, *inertial, "mass", *inertial, "1");
    ignored_.add(link, "missing mass", "give it an <inertial>",
                 "has no mass: SDF's default of 1 kg with 1 kg m2 is assumed");
  }

  /// Limits without end, which some files write as the largest number.
  static void complete_limit(Element& limit) {
    constexpr double kNone = 1e15;
    for (const char* name : {"lower", "upper"})
      if (Element* e = limit.FirstChildElement(name))
        if (const double value = loose_number(text_of(*e), 0); std::abs(value) > kNone)
          e->SetText(value < 0 ? "-1e16" : "1e16");
    for (const char* name : {"effort", "velocity"})
      if (Element* e = limit.FirstChildElement(name))
        if (std::abs(loose_number(text_of(*e), 0)) > kNone) limit.DeleteChild(e);
  }

  Document& document_;
  IgnoredKinds& ignored_;
};

}  // namespace

void clean_sdf(Document& document, IgnoredKinds& ignored) {
  Cleaning(document, ignored).clean(*document.root());
}

}  // namespace navvy::scene_io
