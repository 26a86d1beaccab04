// SPDX-License-Identifier: Apache-2.0
#include "scene_io/sdf_rules.h"

#include <cmath>
#include <cstdlib>
#include <cstring>
#include <map>
#include <set>
#include <string_view>

#include "scene_io/element_reader.h"
#include "scene_io/schema.h"

namespace navvy::scene_io {

namespace {

// Ignoring an element of kWarn leaves the simulation as it is; ignoring one of kError would change
// the physics. An element of kOwn has a reader of its own, which checks its inside.
enum class Support { kUsed, kOwn, kWarn, kError };
// Text of an element. kElements: elements and no text, kAny: not checked.
enum class Type { kElements, kNumber, kNumbers3, kFlag, kText, kPose, kColor, kAny };
using enum Support;
using enum Type;

/// Rule for each element of `names` in each element of `parents`, both separated by blanks.
struct Rule {
  const char* parents;
  const char* names;
  Support support = kUsed;
  Type type = kElements;
  const char* why = "";  ///< remedy for an element that is not supported
  // SDF writes a missing limit of a joint as 1e16, so this value must pass.
  Range range = {-1e16, 1e16};
};

constexpr const char* kLook = "only changes the look";

const Rule kRules[] = {
    // A file holds a world, or a single model of a machine.
    {"sdf", "world model"},
    {"sdf", "light", kWarn, kAny, "a light belongs into a world"},
    {"sdf", "actor", kError, kAny, "actors are not supported"},

    {"world", "include model light"},
    {"world", "gravity", kUsed, kNumbers3, "", {-100, 100}},
    {"world", "physics", kWarn, kAny, "Navvy has its own engines; the steps are in navvy:solver"},
    {"world", "scene", kWarn, kAny, kLook},
    {"world", "gui", kWarn, kAny, "Navvy has no window"},
    {"world", "plugin", kWarn, kAny, "plugins of Gazebo are not run"},
    {"world", "audio", kWarn, kAny, "there is no sound"},
    {"world", "magnetic_field", kWarn, kAny, "there is no magnetometer"},
    {"world", "spherical_coordinates", kWarn, kAny, "the heightmap file holds its coordinates"},
    {"world", "atmosphere", kWarn, kAny, "there is no air drag"},
    {"world", "wind", kError, kAny, "wind is not supported"},
    {"world", "actor", kWarn, kAny, "actors are not supported"},
    {"world", "road", kWarn, kAny, "roads are not supported"},
    {"world", "population", kError, kAny, "populations are not supported; list the models"},
    {"world", "state", kError, kAny, "saved states of Gazebo cannot be loaded"},
    {"world", "frame", kError, kAny, "frames are for models only; give poses in the world"},

    {"include", "uri name", kUsed, kText},
    {"include model", "static", kUsed, kFlag},
    {"include", "placement_frame", kError, kText, "not supported; place the model's origin"},
    {"include model", "plugin", kError, kAny, "plugins are not run; use navvy:program"},
    {"include model frame link visual collision inertial joint", "pose", kUsed, kPose},

    // Only directional lights are drawn, the first one as the sun.
    {"light", "direction", kUsed, kNumbers3},
    {"light", "diffuse", kUsed, kColor, "", {0, 1}},
    {"light", "pose", kWarn, kPose, "a directional light has no place"},
    {"light", "cast_shadows", kWarn, kFlag, kLook},
    {"light", "specular", kWarn, kColor, kLook, {0, 1}},
    {"light", "intensity", kWarn, kNumber, kLook},
    {"light", "attenuation spot visualize light_on", kWarn, kAny, kLook},

    // Elements that move a model in Gazebo are refused: here it would stand still.
    {"model", "link joint frame"},
    {"model link", "self_collide", kWarn, kFlag, "links of one machine never collide"},
    {"model link", "enable_wind", kWarn, kFlag, "there is no wind"},
    {"model", "allow_auto_disable", kWarn, kFlag, "machines never sleep"},
    {"model", "gripper", kError, kAny, "grippers are not supported"},
    {"link", "inertial visual collision"},
    {"link", "gravity", kError, kFlag, "gravity acts on every link"},
    {"link", "kinematic", kError, kFlag, "whole machines only: navvy:physics kinematic"},
    {"link", "velocity_decay", kError, kAny, "use the joints' damping"},
    {"link", "must_be_base_link", kError, kFlag, "the link without a parent joint is the base"},
    {"link", "sensor", kOwn, kAny},
    {"link", "light projector particle_emitter", kWarn, kAny, kLook},
    {"link", "audio_source audio_sink", kWarn, kAny, "there is no sound"},
    {"link", "battery", kWarn, kAny, "batteries are not simulated"},

    // The lower bounds keep the solver's divisions finite.
    {"inertial", "inertia"},
    {"inertial", "mass", kUsed, kNumber, "", {1e-6, 1e8}},
    {"inertial", "fluid_added_mass", kError, kAny, "there is no fluid"},
    {"inertia", "ixx iyy izz", kUsed, kNumber, "", {1e-12, 1e12}},
    {"inertia", "ixy ixz iyz", kUsed, kNumber, "", {-1e12, 1e12}},

    {"visual", "geometry material"},
    {"visual", "cast_shadows", kWarn, kFlag, kLook},
    {"visual", "transparency", kWarn, kNumber, "use the alpha of diffuse", {0, 1}},
    {"visual collision", "laser_retro", kWarn, kNumber, "intensities are not simulated"},
    {"visual", "visibility_flags meta plugin", kWarn, kAny, kLook},
    // Pictures use diffuse; ambient is usually its copy.
    {"material", "diffuse ambient specular", kUsed, kColor, "", {0, 1}},
    {"material", "emissive", kWarn, kColor, kLook, {0, 1}},
    {"material", "script", kWarn, kAny, "scripts of OGRE are not read; use diffuse"},
    {"material", "shader pbr lighting shininess double_sided render_order", kWarn, kAny, kLook},

    // Friction is one coefficient; a body neither bounces nor deforms.
    {"collision", "geometry surface"},
    {"collision", "max_contacts", kWarn, kNumber, "the physics engine chooses"},
    {"surface", "friction bounce"},
    {"surface", "contact", kWarn, kAny, "the physics engine chooses contact stiffness"},
    {"surface", "soft_contact", kError, kAny, "soft bodies are not supported"},
    {"friction", "ode"},
    {"friction", "bullet", kError, kAny, "give the coefficient as friction/ode/mu"},
    {"friction", "torsional", kError, kAny, "torsional friction is not supported"},
    {"bounce", "restitution_coefficient", kError, kNumber,
     "bodies do not rebound by themselves: give it by pairs, in navvy:materials"},
    {"bounce", "threshold", kWarn, kNumber, "the physics engine chooses"},
    {"ode", "mu", kUsed, kNumber, "", {0, 1000}},  // 100 in Gazebo's ground_plane
    {"ode", "mu2", kWarn, kNumber, "friction is the same in all directions, that of mu", {0, 1000}},
    {"ode", "fdir1", kError, kAny, "friction is the same in all directions"},
    {"ode", "slip1 slip2", kError, kAny, "not supported"},

    {"geometry", "box cylinder sphere mesh plane capsule cone"},
    {"geometry", "ellipsoid image polyline", kError, kAny, "use another shape, or mesh"},
    {"geometry", "heightmap", kError, kAny, "the ground of a world is navvy:ground/file"},
    {"geometry", "empty", kError, kAny, "remove the visual or collision"},
    {"box", "size", kUsed, kNumbers3, "", {1e-4, 1e5}},
    {"cylinder capsule cone sphere", "radius", kUsed, kNumber, "", {1e-4, 1e5}},
    {"cylinder capsule cone", "length", kUsed, kNumber, "", {1e-4, 1e5}},
    {"mesh", "uri", kUsed, kText},
    {"mesh", "scale", kUsed, kNumbers3, "", {1e-6, 1e6}},
    {"mesh", "submesh", kError, kAny, "write the part into a file of its own"},
    {"plane", "normal", kUsed, kNumbers3},
    {"plane", "size", kUsed, kAny},

    // A joint has one axis, but the gearbox's angles have one each.
    {"joint", "parent child", kUsed, kText},
    {"joint", "axis"},
    {"joint", "axis2"},
    {"joint", "physics", kWarn, kAny, "settings of other engines"},
    {"joint", "sensor", kWarn, kAny, "give a link a sensor of type navvy:joint"},
    {"joint", "thread_pitch screw_thread_pitch", kError, kNumber, "screw joints are not supported"},
    {"joint", "gearbox_ratio", kUsed, kNumber, "", {-1e6, 1e6}},
    {"joint", "gearbox_reference_body", kUsed, kText},
    {"axis axis2", "xyz", kUsed, kNumbers3, "", {-1e3, 1e3}},
    {"axis", "mimic", kOwn, kAny},
    {"axis axis2", "limit dynamics"},
    {"limit", "lower upper effort velocity", kUsed, kNumber},
    {"limit", "stiffness dissipation", kError, kNumber, "joint stops are firm"},
    {"dynamics", "damping friction", kUsed, kNumber, "", {0, 1e12}},
    {"dynamics", "spring_stiffness", kUsed, kNumber, "", {-1e12, 1e12}},
    {"dynamics", "spring_reference", kUsed, kNumber, "", {-1e6, 1e6}},
};

/// Rules by the names of parent and element.
/// Two maps, one in the other, so that suggestions have the names that one parent may have.
const std::map<std::string, std::map<std::string, const Rule*>, std::less<>>& rules() {
  static const auto table = [] {
    std::map<std::string, std::map<std::string, const Rule*>, std::less<>> out;
    for (const Rule& rule : kRules)
      for (const std::string& parent : words_of(rule.parents))
        for (const std::string& name : words_of(rule.names)) out[parent][name] = &rule;
    return out;
  }();
  return table;
}

const Rule* find_rule(std::string_view parent, const std::string& name) {
  const auto children = rules().find(parent);
  if (children == rules().end()) return nullptr;
  const auto rule = children->second.find(name);
  return rule == children->second.end() ? nullptr : rule->second;
}

/// Returns the names that a parent may have, for suggestions.
std::vector<std::string> names_in(const std::string& parent) {
  std::vector<std::string> names;
  if (const auto children = rules().find(parent); children != rules().end())
    for (const auto& [name, rule] : children->second)
      if (rule->support == kUsed || rule->support == kOwn) names.push_back(name);
  for (const std::string& name : schema().extensions(parent)) names.push_back(name);
  return names;
}

/// Warns of a pose whose angles exceed a turn in radians: they are likely degrees.
void warn_of_degrees(const Element& element, Faults& faults) {
  // 0.01 rad beyond a turn allows for 6.2832 and similar rounding.
  constexpr double kTurn = 2 * kPi + 0.01;
  if (is_true(attribute(element, "degrees"))) return;
  if (attribute(element, "rotation_format") == "quat_xyzw") return;
  const std::vector<std::string> words = words_of(text_of(element));
  for (std::size_t i = 3; i < 6 && i < words.size(); ++i) {
    if (std::abs(std::strtod(words[i].c_str(), nullptr)) <= kTurn) continue;
    faults.warning(element, text_of(element),
                   "the angles of a pose are in radians: " + words[i] +
                       " is more than a whole turn; were degrees meant?",
                   "write <pose degrees=\"true\">, or give radians");
    return;
  }
}

/// Checks that the text of an element can be read; its reader takes the value later.
void check_value(const Element& element, const Rule& rule, Faults& faults) {
  const std::string text = text_of(element);
  std::vector<double> numbers;
  bool flag = false;
  Pose pose;
  switch (rule.type) {
    case kNumber:
      read_numbers(element, 1, rule.range, numbers, faults);
      break;
    case kNumbers3:
      // The range holds for each component.
      read_numbers(element, 3, rule.range, numbers, faults);
      break;
    case kColor:  // alpha may be left out
      read_numbers(element, words_of(text).size() == 3 ? 3 : 4, rule.range, numbers, faults);
      break;
    case kFlag:
      read_flag(element, flag, faults);
      break;
    case kPose:
      // SDF's short form for the origin of another frame.
      if (text.empty() && element.Attribute("relative_to")) break;
      if (read_pose(element, pose, faults)) warn_of_degrees(element, faults);
      break;
    case kText:
      if (text.empty()) faults.error(element, "", "must not be empty");
      break;
    case kElements:
      if (!text.empty())
        faults.error(element, text, "text is not allowed between the elements here", "remove it");
      break;
    case kAny:
      break;
  }
  // Elements inside a value would be ignored, for instance a <size> written into the wrong place.
  if (rule.type != kElements && rule.type != kAny && element.FirstChildElement())
    faults.error(element, element.FirstChildElement()->Name(), "must hold a value, not elements");
}

/// Returns true for elements that may occur more than once below one parent.
bool may_repeat(const std::string& parent, const std::string& name) {
  static const std::set<std::string> repeatable = {"model",  "include", "light",  "link",
                                                   "joint",  "frame",   "visual", "collision",
                                                   "plugin", "sensor",  "physics"};
  return repeatable.count(name) > 0 || schema().repeats(parent, name);
}

void check_names(const Element& element, Faults& faults) {
  const std::string kind = element.Name();
  static const std::set<std::string> named = {"world", "model",  "link",     "joint",
                                              "frame", "visual", "collision"};
  if (named.count(kind) == 0) return;
  const std::string name = attribute(element, "name");
  if (name.empty())
    faults.error(element, "", "needs an attribute name=\"...\"", "add it");
  else if (name == "world" || (name.size() > 3 && name.rfind("__", 0) == 0))
    // SDF reserves these for its own frames and scopes.
    faults.error(element, name, "'world' and names that start with __ are reserved", "rename it");
}

void check_children(const Element& element, Faults& faults) {
  static const std::set<std::string> scoped = {"link", "joint", "frame", "model"};
  std::set<std::string> once, names;
  for (const Element* child = element.FirstChildElement(); child;
       child = child->NextSiblingElement()) {
    const std::string kind = child->Name();
    // An unknown element is reported as such, and once.
    const bool known = is_extension(*child) || find_rule(element.Name(), kind);
    if (known && !may_repeat(element.Name(), kind) && !once.insert(kind).second)
      faults.error(*child, "", "must occur only once", "remove one of them");
    // Links, joints, frames and nested models share one space of names in SDF; visuals and
    // collisions have one each.
    const std::string name = attribute(*child, "name");
    const bool counted = scoped.count(kind) > 0 || kind == "visual" || kind == "collision";
    const std::string key = scoped.count(kind) > 0 ? name : kind + "/" + name;
    if (counted && child->Attribute("name") && !names.insert(key).second)
      faults.error(*child, name, "names must be unique here", "rename one of them");
    check_sdf(*child, faults);
  }
}

}  // namespace

void check_sdf(const Element& element, Faults& faults) {
  // The root has no parent: check_root has looked at it, and its children are checked below.
  const auto* parent_node = element.Parent() ? element.Parent()->ToElement() : nullptr;
  const std::string parent = parent_node ? parent_node->Name() : "";
  const std::string name = element.Name();
  if (parent_node && is_extension(element)) {
    // The reader of an extension element checks its inside; here only its place is checked.
    if (!schema().allows(parent, name))
      faults.error(element, "", "unknown extension element in <" + parent + ">",
                   faults.nearest(name, names_in(parent)));
    return;
  }
  if (parent_node) {
    const Rule* rule = find_rule(parent, name);
    if (!rule) {
      faults.error(element, text_of(element), "unknown element in <" + parent + ">",
                   faults.nearest(name, names_in(parent)));
      return;
    }
    if (rule->support == kError)
      faults.error(element, text_of(element), "is not supported", rule->why);
    if (rule->support == kWarn) faults.warning(element, text_of(element), "is ignored", rule->why);
    // A faulty value of an ignored element points to a misunderstanding.
    check_value(element, *rule, faults);
    // An unsupported element has been reported as a whole, and a value has no children.
    if (rule->support != kUsed || rule->type != kElements) return;
  }
  check_names(element, faults);
  check_children(element, faults);
}

bool is_used_sdf(const Element& element) {
  const auto* parent = element.Parent() ? element.Parent()->ToElement() : nullptr;
  if (is_extension(element)) return false;
  return !parent || is_used_sdf(parent->Name(), element.Name());
}

bool is_used_sdf(const char* parent, const char* name) {
  const Rule* rule = find_rule(parent, name);
  return rule && rule->support == kUsed;
}

SdfTreatment sdf_treatment(const char* parent, const char* name, std::string* why) {
  const Rule* rule = find_rule(parent, name);
  if (rule == nullptr) return SdfTreatment::kUnknown;
  if (why != nullptr) *why = rule->why;
  if (rule->support == kError) return SdfTreatment::kRefused;
  if (rule->support != kWarn) return SdfTreatment::kRead;
  return rule->why == kLook ? SdfTreatment::kLook : SdfTreatment::kIgnored;
}

std::vector<SdfUse> sdf_uses() {
  std::vector<SdfUse> out;
  for (const Rule& rule : kRules)
    out.push_back({rule.parents, rule.names,
                   rule.support == kUsed || rule.support == kOwn ? "read"
                   : rule.support == kWarn                       ? "ignored, with a warning"
                                                                 : "refused",
                   rule.why});
  return out;
}

bool check_root(const Element& root, Faults& faults) {
  if (std::strcmp(root.Name(), "sdf") != 0) {
    faults.error(root, root.Name(),
                 "the outermost element must be <sdf version=\"1.9\">, or <robot> of URDF");
    return false;
  }
  const std::string version = attribute(root, "version");
  // import_document has brought other versions that it knows to 1.9.
  if (version != "1.7" && version != "1.8" && version != "1.9") {
    faults.error(root, version, "the attribute version must be 1.9 (1.3 to 1.12 are understood)");
    return false;
  }
  return true;
}

}  // namespace navvy::scene_io
