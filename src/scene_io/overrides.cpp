// SPDX-License-Identifier: Apache-2.0
#include "scene_io/overrides.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <cstring>

#include "core/utf8.h"
#include "scene_io/fields.h"

namespace navvy::scene_io {

namespace {

// The fewest digits that read back to the same number, so that a value given on the command line
// arrives unchanged.
std::string shortest(double value) {
  char text[40];
  const auto result = std::to_chars(text, text + sizeof text, value);
  return std::string(text, result.ptr);
}

/// One part of a key: `soil[loam]` has name "soil" and which "loam".
struct Part {
  std::string name, which;
};

bool split_key(const std::string& key, std::vector<Part>& parts) {
  std::size_t at = 0;
  // Written by hand, as keys hold two kinds of marks only: a dot begins a part, brackets hold which
  // of several.
  while (at <= key.size()) {
    Part part;
    while (at < key.size() && key[at] != '.' && key[at] != '[') part.name += key[at++];
    if (at < key.size() && key[at] == '[') {
      const std::size_t end = key.find(']', at);
      if (end == std::string::npos) return false;
      part.which = key.substr(at + 1, end - at - 1);
      at = end + 1;
    }
    if (part.name.empty() || (at < key.size() && key[at] != '.')) return false;
    parts.push_back(part);
    if (at++ == key.size()) break;
  }
  // An object alone sets nothing; the last part names the element.
  return parts.size() >= 2;
}

void key_fault(const std::string& key, const std::string& value, const std::string& rule,
               const std::string& remedy,
               // There is no file and no line; the key stands for the element.
               Faults& faults) {
  Fault fault;
  fault.file = "command line";
  fault.element = key;
  fault.value = value;
  fault.rule = rule;
  fault.remedy = remedy;
  faults.add(fault);
}

/// "ew180" of model://ew180, ../ew180/model.sdf, ew180/ and ew180.sdf.
std::string model_of(std::string uri) {
  const std::string file = "/model.sdf", ending = ".sdf";
  if (uri.size() >= file.size() && uri.compare(uri.size() - file.size(), file.size(), file) == 0)
    uri.resize(uri.size() - file.size());
  while (!uri.empty() && uri.back() == '/') uri.pop_back();
  uri = uri.substr(uri.rfind('/') == std::string::npos ? 0 : uri.rfind('/') + 1);
  if (uri.size() > ending.size() &&
      uri.compare(uri.size() - ending.size(), ending.size(), ending) == 0)
    uri.resize(uri.size() - ending.size());
  return uri;
}

bool is_called(const Element& element, const std::string& which, int place) {
  // By place, counted from 1 among those that match, by name, or by the name of what it refers to.
  if (which.empty() || which == std::to_string(place)) return true;
  if (attribute(element, "name") == which || child_text(element, "name") == which) return true;
  if (!element.Attribute("name") && attribute(element, "ref") == which) return true;
  // An included machine without a <name> goes by its file's directory.
  return !element.FirstChildElement("name") && model_of(child_text(element, "uri")) == which;
}

bool matches(const Element& element, const std::string& name) {
  // Machines stand in a scene as <include> or <model>; to a user they are machines.
  const std::string own = element.Name();
  if (own == name || own == "navvy:" + name) return true;
  return name == "machine" && (own == "include" || own == "model");
}

std::vector<Element*> children_matching(Element& parent, const Part& part) {
  std::vector<Element*> found;
  int place = 0;
  for (Element* e = parent.FirstChildElement(); e; e = e->NextSiblingElement())
    if (matches(*e, part.name) && is_called(*e, part.which, ++place)) found.push_back(e);
  return found;
}

// A value of the file is replaced by a new element, whose line 0 marks it as not of the file.
void set_value(Element& parent, const std::string& name, const std::string& value) {
  while (Element* old = parent.FirstChildElement(name.c_str())) parent.DeleteChild(old);
  parent.InsertNewChildElement(name.c_str())->SetText(value.c_str());
}

// x_m, y_m, z_m and yaw_deg of a machine are parts of its <pose>.
bool set_place(Element& machine, const std::string& name, const std::string& value) {
  const std::vector<std::string> names = {"x_m", "y_m", "z_m", "", "", "yaw_deg"};
  for (std::size_t i = 0; i < names.size(); ++i) {
    if (names[i].empty() || names[i] != name) continue;
    Element* pose = machine.FirstChildElement("pose");
    std::vector<std::string> words = pose ? words_of(text_of(*pose)) : std::vector<std::string>{};
    const bool in_degrees =
        pose && (attribute(*pose, "degrees") == "true" || attribute(*pose, "degrees") == "1");
    bool quaternion = pose && attribute(*pose, "rotation_format") == "quat_xyzw";
    // A quaternion stays as it is where only the place is set, and gives way to angles for a new
    // yaw.
    Pose X;
    Faults unread;
    if (quaternion && i == 5 && read_pose(*pose, X, unread)) {
      const Vec3 turn = fixed_angles(X.linear());
      words.resize(6);
      for (int k = 0; k < 3; ++k) words[static_cast<std::size_t>(3 + k)] = shortest(turn[k]);
      quaternion = false;
    }
    // A pose that is not there, or is shorter than six numbers, counts as zeros.
    if (words.size() < 6) words.resize(6, "0");
    double number = 0;
    words[i] = value;
    // A pose counts in radians unless it says otherwise; the key says degrees.
    if (i == 5 && !in_degrees && to_number(value, number)) words[i] = shortest(number * kDegree);
    std::string text;
    for (const std::string& word : words) text += (text.empty() ? "" : " ") + word;
    if (pose) machine.DeleteChild(pose);
    pose = machine.InsertNewChildElement("pose");
    pose->SetText(text.c_str());
    if (quaternion) pose->SetAttribute("rotation_format", "quat_xyzw");
    if (in_degrees) pose->SetAttribute("degrees", "true");
    return true;
  }
  return false;
}

void apply_setting(Element& world, const std::string& key, const std::string& value,
                   Faults& faults) {
  std::vector<Part> parts;
  if (!split_key(key, parts) || !parts.back().which.empty()) {
    key_fault(key, value, "a setting must look like object.element=value",
              "e.g. soil.cohesion_pa=8000", faults);
    return;
  }
  const std::vector<std::string> objects = {"soil",      "ground", "solver",
                                            "recording", "camera", "machine"};
  bool known = false;
  for (const std::string& object : objects) known = known || object == parts[0].name;
  if (first_bad_utf8(key + value) != std::string::npos) {
    key_fault("", "", "a setting must be text in UTF-8", "check the terminal's encoding", faults);
    return;
  }
  // The scene is written out as it ran, and no XML holds them.
  const auto is_control = [](char c) {
    return (static_cast<unsigned char>(c) < 0x20 && c != '\t') || c == 0x7F;
  };
  if (std::any_of(value.begin(), value.end(), is_control) ||
      std::any_of(key.begin(), key.end(), is_control)) {
    key_fault("", "", "a setting must hold no control characters",
              "look for what the shell made of its value", faults);
    return;
  }
  if (!known) {
    key_fault(key, value, "unknown object '" + parts[0].name + "'",
              faults.nearest(parts[0].name, objects), faults);
    return;
  }
  std::vector<Element*> targets = {&world};
  // A key goes down from the world, part by part; each part may pick several, and all of them are
  // set.
  for (std::size_t i = 0; i + 1 < parts.size(); ++i) {
    std::vector<Element*> next;
    for (Element* target : targets)
      for (Element* child : children_matching(*target, parts[i])) next.push_back(child);
    // Objects that a scene has once, and may leave out with all values at their defaults, are made
    // when they are needed; others must be there to be meant.
    const bool single =
        parts[i].name == "ground" || parts[i].name == "solver" || parts[i].name == "recording";
    if (next.empty() && i == 0 && single)
      next.push_back(world.InsertNewChildElement(("navvy:" + parts[0].name).c_str()));
    if (next.empty()) {
      const std::string part =
          parts[i].name + (parts[i].which.empty() ? "" : "[" + parts[i].which + "]");
      key_fault(key, value, "the scene has no '" + part + "'", "see the names in the scene file",
                faults);
      return;
    }
    targets = next;
  }
  const std::string& leaf = parts.back().name;
  for (Element* target : targets) {
    // One level below a machine only its place can be set; deeper keys reach what the scene says of
    // it, such as its program.
    if (parts[0].name == "machine" && parts.size() == 2) {
      if (!set_place(*target, leaf, value))
        key_fault(key, value, "unknown element '" + leaf + "'",
                  faults.nearest(leaf, {"x_m", "y_m", "z_m", "yaw_deg"}), faults);
      continue;
    }
    // A soil's strength is given by one of two elements; the new one replaces the other.
    if (leaf == "friction_angle_deg" || leaf == "repose_angle_deg")
      for (const char* other : {"friction_angle_deg", "repose_angle_deg"})
        if (Element* old = target->FirstChildElement(other)) target->DeleteChild(old);
    set_value(*target, leaf, value);
  }
}

std::string shortest(const Vec2& v) { return shortest(v.x()) + " " + shortest(v.y()); }

Element& section(Element& world, const char* name) {
  Element* found = world.FirstChildElement(name);
  return found ? *found : *world.InsertNewChildElement(name);
}

void apply_terrain(Element& world, const Overrides& overrides) {
  Element& ground = section(world, "navvy:ground");
  if (overrides.terrain) {
    // The file replaces the procedural shapes; layers and patches stay.
    for (const char* shape :
         {"slope", "hills", "stockpile", "trench", "bank", "block", "at_m", "at_local_m"})
      while (Element* old = ground.FirstChildElement(shape)) ground.DeleteChild(old);
    set_value(ground, "file", *overrides.terrain);
  }
  if (overrides.at) {
    for (const char* other : {"at_m", "at_local_m"})
      if (Element* old = ground.FirstChildElement(other)) ground.DeleteChild(old);
    set_value(ground, overrides.at_is_local ? "at_local_m" : "at_m", shortest(*overrides.at));
  }
  if (overrides.size) set_value(ground, "size_m", shortest(*overrides.size));
}

}  // namespace

std::pair<std::string, std::string> parse_setting(const std::string& text) {
  const std::size_t at = text.find('=');
  if (at == std::string::npos || at == 0) {
    Fault fault;
    fault.file = "command line";
    fault.value = text;
    fault.rule = "a setting must look like object.element=value";
    fault.remedy = "e.g. soil.cohesion_pa=8000";
    throw InputError(fault);
  }
  return {text.substr(0, at), text.substr(at + 1)};
}

// In this order a general option gives way to a setting that names the same value.
void apply_overrides(Document& document, const Overrides& overrides, Faults& faults) {
  Element* world = document.root()->FirstChildElement("world");
  if (!world) return;  // the reader reports it
  if (overrides.terrain || overrides.at || overrides.size) apply_terrain(*world, overrides);
  if (overrides.seed) set_value(*world, "navvy:seed", std::to_string(*overrides.seed));
  if (overrides.duration)
    set_value(section(*world, "navvy:recording"), "duration_s", shortest(*overrides.duration));
  if (overrides.render)
    set_value(section(*world, "navvy:recording"), "render", *overrides.render ? "true" : "false");
  for (const auto& [key, value] : overrides.set) apply_setting(*world, key, value, faults);
}

}  // namespace navvy::scene_io
