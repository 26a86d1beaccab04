// SPDX-License-Identifier: Apache-2.0
#include "scene_io/sdf_rules.h"

#include <cmath>
#include <cstdlib>
#include <cstring>
#include <set>

#include "scene_io/fields.h"

namespace navvy::scene_io {

namespace {

// kUsed is read; kWarn leaves the simulation as it would be without it; kError would change the
// physics if it were passed over.
enum class Support { kUsed, kWarn, kError };
// What an element's text must be. kElements holds elements and no text, kAny is not looked into.
enum class Type { kElements, kNumber, kNumbers3, kFlag, kText, kPose, kColor, kAny };

struct Rule {
  const char* parent;
  const char* name;
  Support support = Support::kUsed;
  Type type = Type::kElements;
  Range range = {-1e16, 1e16};
  const char* why = "";  ///< of what is not supported
};

constexpr auto kUsed = Support::kUsed;
constexpr auto kWarn = Support::kWarn;
constexpr auto kError = Support::kError;
constexpr Range kAnyRange = {-1e16, 1e16};
constexpr const char* kSensors = "sensors are not simulated yet";
constexpr const char* kLook = "only changes the look";

// One line an element: parent, name, what we do with it, what its text must be, range, reason.
const Rule kRules[] = {
    // Files hold a world, or a single model of a machine; soils are extension elements.
    {"sdf", "world"},
    {"sdf", "model"},
    {"sdf", "light", kWarn, Type::kAny, kAnyRange, "a light belongs into a world"},
    {"sdf", "actor", kError, Type::kAny, kAnyRange, "actors are not supported"},

    // What surrounds a machine in Gazebo: ignoring it leaves the machine as it is, but for wind and
    // what would add bodies.
    {"world", "include"},
    {"world", "model"},
    {"world", "gravity", kUsed, Type::kNumbers3, {-100, 100}},
    {"world", "light"},
    {"world", "physics", kWarn, Type::kAny, kAnyRange,
     "Navvy chooses its own engine; its steps are in navvy:solver"},
    {"world", "scene", kWarn, Type::kAny, kAnyRange, kLook},
    {"world", "gui", kWarn, Type::kAny, kAnyRange, "Navvy has no window"},
    {"world", "plugin", kWarn, Type::kAny, kAnyRange, "plugins of Gazebo are not run"},
    {"world", "audio", kWarn, Type::kAny, kAnyRange, "there is no sound"},
    {"world", "magnetic_field", kWarn, Type::kAny, kAnyRange, kSensors},
    {"world", "spherical_coordinates", kWarn, Type::kAny, kAnyRange,
     "the heightmap file says where it lies"},
    {"world", "atmosphere", kWarn, Type::kAny, kAnyRange, "there is no air drag"},
    {"world", "wind", kError, Type::kAny, kAnyRange, "wind is not supported"},
    {"world", "actor", kWarn, Type::kAny, kAnyRange, "actors are not supported"},
    {"world", "road", kWarn, Type::kAny, kAnyRange, "roads are not supported"},
    {"world", "population", kError, Type::kAny, kAnyRange,
     "populations are not supported; list the models"},
    {"world", "state", kError, Type::kAny, kAnyRange, "saved states of Gazebo cannot be loaded"},
    {"world", "frame", kError, Type::kAny, kAnyRange,
     "frames are supported in models only; give poses in the world"},

    // A machine from a file of its own; what is said here holds for this world alone.
    {"include", "uri", kUsed, Type::kText},
    {"include", "name", kUsed, Type::kText},
    {"include", "pose", kUsed, Type::kPose},
    {"include", "static", kUsed, Type::kFlag},
    {"include", "placement_frame", kError, Type::kText, kAnyRange,
     "not supported; place the model's origin"},
    {"include", "plugin", kError, Type::kAny, kAnyRange, "plugins are not run; use navvy:program"},

    // Only directional lights are drawn, and the first as the sun; what refines a light changes no
    // pixel's meaning.
    {"light", "direction", kUsed, Type::kNumbers3},
    {"light", "diffuse", kUsed, Type::kColor, {0, 1}},
    {"light", "pose", kWarn, Type::kPose, kAnyRange, "a directional light has no place"},
    {"light", "cast_shadows", kWarn, Type::kFlag, kAnyRange, kLook},
    {"light", "specular", kWarn, Type::kColor, {0, 1}, kLook},
    {"light", "intensity", kWarn, Type::kNumber, kAnyRange, kLook},
    {"light", "attenuation", kWarn, Type::kAny, kAnyRange, kLook},
    {"light", "spot", kWarn, Type::kAny, kAnyRange, kLook},
    {"light", "visualize", kWarn, Type::kAny, kAnyRange, kLook},
    {"light", "light_on", kWarn, Type::kAny, kAnyRange, kLook},

    // A machine. Whatever drives a model in Gazebo is refused, as it would stand still here without
    // a word.
    {"model", "static", kUsed, Type::kFlag},
    {"model", "pose", kUsed, Type::kPose},
    {"model", "link"},
    {"model", "joint"},
    {"model", "frame"},
    {"model", "self_collide", kWarn, Type::kFlag, kAnyRange, "links of one machine never collide"},
    {"model", "allow_auto_disable", kWarn, Type::kFlag, kAnyRange, "machines never sleep"},
    {"model", "enable_wind", kWarn, Type::kFlag, kAnyRange, "there is no wind"},
    {"model", "plugin", kError, Type::kAny, kAnyRange, "plugins are not run; use navvy:program"},
    {"model", "gripper", kError, Type::kAny, kAnyRange, "grippers are not supported"},
    {"frame", "pose", kUsed, Type::kPose},

    // What changes how a single link moves is refused, as it would move otherwise than its author
    // meant.
    {"link", "pose", kUsed, Type::kPose},
    {"link", "inertial"},
    {"link", "visual"},
    {"link", "collision"},
    {"link", "gravity", kError, Type::kFlag, kAnyRange, "gravity acts on every link"},
    {"link", "kinematic", kError, Type::kFlag, kAnyRange,
     "whole machines only: navvy:engine kinematic"},
    {"link", "velocity_decay", kError, Type::kAny, kAnyRange, "use the joints' damping"},
    {"link", "must_be_base_link", kError, Type::kFlag, kAnyRange,
     "the link without a parent joint is the base"},
    {"link", "self_collide", kWarn, Type::kFlag, kAnyRange, "links of one machine never collide"},
    {"link", "enable_wind", kWarn, Type::kFlag, kAnyRange, "there is no wind"},
    {"link", "sensor", kWarn, Type::kAny, kAnyRange,
     "sensors are not simulated yet; for pictures use navvy:camera"},
    {"link", "light", kWarn, Type::kAny, kAnyRange, kLook},
    {"link", "projector", kWarn, Type::kAny, kAnyRange, kLook},
    {"link", "particle_emitter", kWarn, Type::kAny, kAnyRange, kLook},
    {"link", "audio_source", kWarn, Type::kAny, kAnyRange, "there is no sound"},
    {"link", "audio_sink", kWarn, Type::kAny, kAnyRange, "there is no sound"},
    {"link", "battery", kWarn, Type::kAny, kAnyRange, "batteries are not simulated"},

    // The lower bounds keep the solver's divisions finite; a body of a milligram in a machine is a
    // slip.
    {"inertial", "mass", kUsed, Type::kNumber, {1e-6, 1e8}},
    {"inertial", "pose", kUsed, Type::kPose},
    {"inertial", "inertia"},
    {"inertial", "fluid_added_mass", kError, Type::kAny, kAnyRange, "there is no fluid"},
    {"inertia", "ixx", kUsed, Type::kNumber, {1e-12, 1e12}},
    {"inertia", "iyy", kUsed, Type::kNumber, {1e-12, 1e12}},
    {"inertia", "izz", kUsed, Type::kNumber, {1e-12, 1e12}},
    {"inertia", "ixy", kUsed, Type::kNumber, {-1e12, 1e12}},
    {"inertia", "ixz", kUsed, Type::kNumber, {-1e12, 1e12}},
    {"inertia", "iyz", kUsed, Type::kNumber, {-1e12, 1e12}},

    // What a link looks like: nothing here can be wrong in a way that matters to the motion.
    {"visual", "pose", kUsed, Type::kPose},
    {"visual", "geometry"},
    {"visual", "material"},
    {"visual", "cast_shadows", kWarn, Type::kFlag, kAnyRange, kLook},
    {"visual", "transparency", kWarn, Type::kNumber, {0, 1}, "use the alpha of diffuse"},
    {"visual", "laser_retro", kWarn, Type::kNumber, kAnyRange, kSensors},
    {"visual", "visibility_flags", kWarn, Type::kAny, kAnyRange, kLook},
    {"visual", "meta", kWarn, Type::kAny, kAnyRange, kLook},
    {"visual", "plugin", kWarn, Type::kAny, kAnyRange, kLook},
    {"material", "diffuse", kUsed, Type::kColor, {0, 1}},
    // Diffuse alone decides; ambient is usually its copy
    {"material", "ambient", kUsed, Type::kColor, {0, 1}},
    {"material", "specular", kUsed, Type::kColor, {0, 1}},
    {"material", "emissive", kWarn, Type::kColor, {0, 1}, kLook},
    {"material", "script", kWarn, Type::kAny, kAnyRange,
     "scripts of OGRE are not read; use diffuse"},
    {"material", "shader", kWarn, Type::kAny, kAnyRange, kLook},
    {"material", "pbr", kWarn, Type::kAny, kAnyRange, kLook},
    {"material", "lighting", kWarn, Type::kAny, kAnyRange, kLook},
    {"material", "shininess", kWarn, Type::kAny, kAnyRange, kLook},
    {"material", "double_sided", kWarn, Type::kAny, kAnyRange, kLook},
    {"material", "render_order", kWarn, Type::kAny, kAnyRange, kLook},

    // What touches: friction is one coefficient, and a body neither bounces nor gives way.
    {"collision", "pose", kUsed, Type::kPose},
    {"collision", "geometry"},
    {"collision", "surface"},
    {"collision", "laser_retro", kWarn, Type::kNumber, kAnyRange, kSensors},
    {"collision", "max_contacts", kWarn, Type::kNumber, kAnyRange, "the engine chooses"},
    {"surface", "friction"},
    {"surface", "contact", kWarn, Type::kAny, kAnyRange, "the engine chooses contact stiffness"},
    {"surface", "bounce"},
    {"surface", "soft_contact", kError, Type::kAny, kAnyRange, "soft bodies are not supported"},
    {"friction", "ode"},
    {"friction", "bullet", kError, Type::kAny, kAnyRange,
     "give the coefficient as friction/ode/mu"},
    {"friction", "torsional", kError, Type::kAny, kAnyRange, "torsional friction is not supported"},
    {"bounce", "restitution_coefficient", kError, Type::kNumber, kAnyRange,
     "bodies do not rebound by themselves: give it by pairs, in navvy:materials"},
    {"bounce", "threshold", kWarn, Type::kNumber, kAnyRange, "the engine chooses"},
    {"ode", "mu", kUsed, Type::kNumber, {0, 1000}},  // Gazebo's ground_plane has 100
    {"ode",
     "mu2",
     kWarn,
     Type::kNumber,
     {0, 1000},
     "friction is the same in all directions, that of mu"},
    {"ode", "fdir1", kError, Type::kAny, kAnyRange, "friction is the same in all directions"},
    {"ode", "slip1", kError, Type::kAny, kAnyRange, "not supported"},
    {"ode", "slip2", kError, Type::kAny, kAnyRange, "not supported"},

    // The shapes that both the engine and the pictures know.
    {"geometry", "box"},
    {"geometry", "cylinder"},
    {"geometry", "sphere"},
    {"geometry", "mesh"},
    {"geometry", "plane"},
    {"geometry", "capsule"},
    {"geometry", "cone"},
    {"geometry", "ellipsoid", kError, Type::kAny, kAnyRange, "use another shape, or mesh"},
    {"geometry", "heightmap", kError, Type::kAny, kAnyRange,
     "the ground of a world is navvy:ground/file"},
    {"geometry", "image", kError, Type::kAny, kAnyRange, "use another shape, or mesh"},
    {"geometry", "polyline", kError, Type::kAny, kAnyRange, "use another shape, or mesh"},
    {"geometry", "empty", kError, Type::kAny, kAnyRange, "remove the visual or collision"},
    {"box", "size", kUsed, Type::kNumbers3, {1e-4, 1e5}},
    {"cylinder", "radius", kUsed, Type::kNumber, {1e-4, 1e5}},
    {"cylinder", "length", kUsed, Type::kNumber, {1e-4, 1e5}},
    {"sphere", "radius", kUsed, Type::kNumber, {1e-4, 1e5}},
    {"capsule", "radius", kUsed, Type::kNumber, {1e-4, 1e5}},
    {"capsule", "length", kUsed, Type::kNumber, {1e-4, 1e5}},
    {"cone", "radius", kUsed, Type::kNumber, {1e-4, 1e5}},
    {"cone", "length", kUsed, Type::kNumber, {1e-4, 1e5}},
    {"mesh", "uri", kUsed, Type::kText},
    {"mesh", "scale", kUsed, Type::kNumbers3, {1e-6, 1e6}},
    {"mesh", "submesh", kError, Type::kAny, kAnyRange, "write the part into a file of its own"},
    {"plane", "normal", kUsed, Type::kNumbers3},
    {"plane", "size", kUsed, Type::kAny},

    // One axis a joint; what couples or springs joints would change the motion and is refused.
    {"joint", "parent", kUsed, Type::kText},
    {"joint", "child", kUsed, Type::kText},
    {"joint", "pose", kUsed, Type::kPose},
    {"joint", "axis"},
    {"joint", "axis2", kError, Type::kAny, kAnyRange,
     "joints have one axis; use two joints and a small link"},
    {"joint", "physics", kWarn, Type::kAny, kAnyRange, "settings of other engines"},
    {"joint", "sensor", kWarn, Type::kAny, kAnyRange, kSensors},
    {"joint", "thread_pitch", kError, Type::kNumber, kAnyRange, "screw joints are not supported"},
    {"joint", "screw_thread_pitch", kError, Type::kNumber, kAnyRange,
     "screw joints are not supported"},
    {"joint", "gearbox_ratio", kError, Type::kNumber, kAnyRange,
     "gearbox joints are not supported"},
    {"joint", "gearbox_reference_body", kError, Type::kText, kAnyRange,
     "gearbox joints are not supported"},
    {"axis", "xyz", kUsed, Type::kNumbers3, {-1e3, 1e3}},
    {"axis", "limit"},
    {"axis", "dynamics"},
    {"limit", "lower", kUsed, Type::kNumber},
    {"limit", "upper", kUsed, Type::kNumber},
    {"limit", "effort", kUsed, Type::kNumber},
    {"limit", "velocity", kUsed, Type::kNumber},
    {"limit", "stiffness", kError, Type::kNumber, kAnyRange, "joint stops are firm"},
    {"limit", "dissipation", kError, Type::kNumber, kAnyRange, "joint stops are firm"},
    {"dynamics", "damping", kUsed, Type::kNumber, {0, 1e12}},
    {"dynamics", "friction", kUsed, Type::kNumber, {0, 1e12}},
    {"dynamics", "spring_reference", kError, Type::kNumber, kAnyRange,
     "joint springs are not supported"},
    {"dynamics", "spring_stiffness", kError, Type::kNumber, kAnyRange,
     "joint springs are not supported"},
};

struct Extension {
  const char* parent;
  const char* name;
};
// Where each extension element belongs; its own table is in its reader.
const Extension kExtensions[] = {
    {"sdf", "navvy:soil"},
    {"sdf", "navvy:materials"},
    {"world", "navvy:materials"},
    {"link", "navvy:material"},
    {"joint", "navvy:ball"},
    {"joint", "navvy:brake"},
    {"world", "navvy:soil"},
    {"world", "navvy:ground"},
    {"world", "navvy:solver"},
    {"world", "navvy:recording"},
    {"world", "navvy:camera"},
    {"world", "navvy:hitch"},
    {"world", "navvy:seed"},
    {"include", "navvy:program"},
    {"world", "navvy:resolved"},
    {"include", "navvy:on_ground"},
    {"include", "navvy:load"},
    {"include", "navvy:joint"},
    {"model", "navvy:program"},
    {"model", "navvy:on_ground"},
    {"model", "navvy:joint"},
    {"model", "navvy:engine"},
    {"include", "navvy:engine"},
    {"model", "navvy:encoder"},
    {"model", "navvy:levers"},
    {"model", "navvy:arm"},
    {"model", "navvy:cylinder"},
    {"model", "navvy:wheel"},
    {"model", "navvy:track"},
    {"model", "navvy:drive"},
    {"model", "navvy:shell"},
    {"model", "navvy:bucket"},
    {"model", "navvy:bed"},
    {"model", "navvy:load"},
    {"model", "navvy:pump"},
    {"world", "navvy:design"},
    {"model", "navvy:traversability"},
    {"world", "navvy:record"},
    {"model", "navvy:derive_collisions"},
    {"link", "navvy:density_kg_per_m3"},
    {"visual", "navvy:density_kg_per_m3"},
    {"collision", "navvy:density_kg_per_m3"},
};

const Rule* find_rule(const char* parent, const char* name) {
  // Some two hundred comparisons an element: files are small and read once.
  for (const Rule& rule : kRules)
    if (std::strcmp(rule.parent, parent) == 0 && std::strcmp(rule.name, name) == 0) return &rule;
  return nullptr;
}

std::vector<std::string> names_in(const char* parent) {
  // For suggestions only, so what is not supported is not offered.
  std::vector<std::string> names;
  for (const Rule& rule : kRules)
    if (std::strcmp(rule.parent, parent) == 0 && rule.support == Support::kUsed)
      names.push_back(rule.name);
  for (const Extension& extension : kExtensions)
    if (std::strcmp(extension.parent, parent) == 0) names.push_back(extension.name);
  return names;
}

/// Angles of a pose are radians unless it says otherwise; more than a turn of them is likely meant
/// as degrees.
void ask_about_turns(const Element& element, Faults& faults) {
  constexpr double kTurn = 2 * kPi + 0.01;
  if (attribute(element, "degrees") == "true" || attribute(element, "degrees") == "1") return;
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

void check_value(const Element& element, const Rule& rule, Faults& faults) {
  std::vector<double> numbers;
  bool flag = false;
  Pose pose;
  // Only that the value can be read is asked for here; its reader takes it later, and what has a
  // fault keeps its default.
  switch (rule.type) {
    case Type::kNumber:
      read_numbers(element, 1, rule.range, numbers, faults);
      break;
    case Type::kNumbers3:
      read_numbers(element, 3, rule.range, numbers, faults);
      break;
    case Type::kColor:
      // Alpha may be left out in a colour.
      if (words_of(text_of(element)).size() == 3) {
        read_numbers(element, 3, rule.range, numbers, faults);
      } else {
        read_numbers(element, 4, rule.range, numbers, faults);
      }
      break;
    case Type::kFlag:
      read_flag(element, flag, faults);
      break;
    case Type::kPose:
      // SDF's short way to stand where another frame is.
      if (text_of(element).empty() && element.Attribute("relative_to")) break;
      if (read_pose(element, pose, faults)) ask_about_turns(element, faults);
      break;
    case Type::kText:
      if (text_of(element).empty()) faults.error(element, "", "must not be empty");
      break;
    case Type::kElements:
      if (!text_of(element).empty())
        faults.error(element, text_of(element), "text is not allowed between the elements here",
                     "remove it");
      break;
    case Type::kAny:
      break;
  }
  if (rule.type != Type::kElements && rule.type != Type::kAny && element.FirstChildElement())
    faults.error(element, element.FirstChildElement()->Name(), "must hold a value, not elements");
}

// Elements that may occur more than once below one parent.
bool may_repeat(const char* name) {
  // Named elements, whose names must differ, and lists of settings. The rest stands once, or the
  // reader would take the first and drop the others.
  for (const char* repeatable :
       {"model",        "include",        "light",        "link",         "joint",
        "frame",        "visual",         "collision",    "plugin",       "sensor",
        "physics",      "navvy:soil",     "navvy:camera", "navvy:record", "navvy:joint",
        "navvy:hitch",  "navvy:cylinder", "navvy:wheel",  "navvy:track",  "navvy:shell",
        "navvy:bucket", "navvy:encoder"})
    if (std::strcmp(name, repeatable) == 0) return true;
  return false;
}

void check_names(const Element& element, Faults& faults) {
  const std::string kind = element.Name();
  static const std::set<std::string> named = {"world", "model",  "link",     "joint",
                                              "frame", "visual", "collision"};
  if (named.count(kind) == 0) return;
  // An element without a name could not be meant by another, nor blamed in a message.
  const std::string name = attribute(element, "name");
  if (name.empty()) {
    faults.error(element, "", "needs an attribute name=\"...\"", "add it");
    // SDF keeps these for itself: they would name its own frames and scopes.
  } else if (name == "world" || (name.size() > 3 && name.rfind("__", 0) == 0)) {
    faults.error(element, name, "'world' and names that start with __ are reserved", "rename it");
  }
}

void check_children(const Element& element, Faults& faults) {
  std::set<std::string> once, names;
  for (const Element* child = element.FirstChildElement(); child;
       child = child->NextSiblingElement()) {
    const char* name = child->Name();
    // What is unknown is told as such, and once.
    const bool known = is_extension(*child) || find_rule(element.Name(), name);
    if (known && !may_repeat(name) && !once.insert(name).second)
      faults.error(*child, "", "must occur only once", "remove one of them");
    // Links, joints, frames and nested models share one space of names in SDF; visuals and
    // collisions have one each.
    const bool scoped = std::strcmp(name, "link") == 0 || std::strcmp(name, "joint") == 0 ||
                        std::strcmp(name, "frame") == 0 || std::strcmp(name, "model") == 0;
    const std::string key =
        scoped ? attribute(*child, "name") : std::string(name) + "/" + attribute(*child, "name");
    const bool counted =
        scoped || std::strcmp(name, "visual") == 0 || std::strcmp(name, "collision") == 0;
    if (counted && child->Attribute("name") && !names.insert(key).second)
      faults.error(*child, attribute(*child, "name"), "names must be unique here",
                   "rename one of them");
    check_sdf(*child, faults);
  }
}

}  // namespace

void check_sdf(const Element& element, Faults& faults) {
  const auto* parent_node = element.Parent() ? element.Parent()->ToElement() : nullptr;
  const char* parent = parent_node ? parent_node->Name() : "";
  const char* name = element.Name();
  if (parent_node && is_extension(element)) {
    // What is inside an extension element is the business of its own reader; here only its place is
    // judged.
    for (const Extension& extension : kExtensions)
      if (std::strcmp(extension.parent, parent) == 0 && std::strcmp(extension.name, name) == 0)
        return;
    faults.error(element, "", std::string("unknown extension element in <") + parent + ">",
                 faults.nearest(name, names_in(parent)));
    return;
  }
  if (parent_node) {
    const Rule* rule = find_rule(parent, name);
    if (!rule) {
      faults.error(element, text_of(element), std::string("unknown element in <") + parent + ">",
                   faults.nearest(name, names_in(parent)));
      return;
    }
    if (rule->support == Support::kError)
      faults.error(element, text_of(element), "is not supported", rule->why);
    if (rule->support == Support::kWarn)
      faults.warning(element, text_of(element), "is ignored", rule->why);
    // The value is checked also where it is ignored, as a fault there points to a misunderstanding.
    check_value(element, *rule, faults);
    if (rule->support != Support::kUsed) return;
    // Values have nothing below them; what is ignored is not looked into.
    if (rule->type != Type::kElements) return;
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
  // Without a rule it is unknown, and check_sdf has said so.
  return rule && rule->support == Support::kUsed;
}

bool check_root(const Element& root, Faults& faults) {
  if (std::strcmp(root.Name(), "sdf") != 0) {
    faults.error(
        root, root.Name(), "the outermost element must be <sdf version=\"1.9\">",
        std::strcmp(root.Name(), "robot") == 0 ? "convert URDF with `gz sdf -p FILE`" : "");
    return false;
  }
  const std::string version = attribute(root, "version");
  // libsdformat reads a model by the version that its file names. Before 1.7 joints had their axes
  // in other frames; what stands still, such as Gazebo's ground plane, reads alike.
  const auto* model = root.FirstChildElement("model");
  const bool old = version == "1.3" || version == "1.4" || version == "1.5" || version == "1.6";
  if (old && model != nullptr && !model->FirstChildElement("joint")) return true;
  if (version != "1.7" && version != "1.8" && version != "1.9") {
    faults.error(root, version, "the attribute version must be 1.9 (1.7 and 1.8 are understood)");
    return false;
  }
  return true;
}

}  // namespace navvy::scene_io
