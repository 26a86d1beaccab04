// SPDX-License-Identifier: Apache-2.0
#include "scene_io/overrides.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <map>

#include "core/renamed_names.h"
#include "core/utf8.h"
#include "scene_io/element_reader.h"
#include "scene_io/schema.h"
#include "scene_io/soil_reader.h"

namespace navvy::scene_io {

namespace {

/// One part of a key: `soil[loam]` has name "soil" and which "loam".
struct Part {
  std::string name, which;
};

bool split_key(const std::string& key, std::vector<Part>& parts) {
  std::size_t at = 0;
  // A dot begins a part, brackets select one of several.
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
    part.name = current_name(NameKind::kElement, part.name);
    parts.push_back(part);
    if (at++ == key.size()) break;
  }
  // The last part names the element.
  return parts.size() >= 2;
}

void key_fault(const std::string& key, const std::string& value, const std::string& rule,
               const std::string& remedy, Faults& faults) {
  // The key stands for the element.
  faults.add({Fault::Severity::kError, "command line", 0, key, value, rule, remedy});
}

/// Returns "ew180" for model://ew180, ../ew180/model.sdf, ew180/ and ew180.sdf.
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

/// Returns true if `which` names the element: by place, counted from 1 among those that match, by
/// its name, or by the name of what it refers to.
bool is_called(const Element& element, const std::string& which, int place) {
  if (which.empty() || which == std::to_string(place)) return true;
  if (attribute(element, "name") == which || child_text(element, "name") == which) return true;
  if (!element.Attribute("name") && attribute(element, "ref") == which) return true;
  // An included machine without a <name> has the name of its file's directory.
  return !has(element, "name") && model_of(child_text(element, "uri")) == which;
}

/// Machines are <include> or <model> in a scene; to a user they are machines.
bool matches(const Element& element, const std::string& name) {
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

/// Replaces a value by a new element, whose line 0 marks it as given on the command line.
void set_value(Element& parent, const std::string& name, const std::string& value) {
  while (Element* old = parent.FirstChildElement(name.c_str())) parent.DeleteChild(old);
  parent.InsertNewChildElement(name.c_str())->SetText(value.c_str());
}

// Sets x_m, y_m, z_m or yaw_deg of a machine, which are parts of its <pose>. Returns false for
// other names.
bool set_place(Element& machine, const std::string& name, const std::string& value) {
  const std::vector<std::string> names = {"x_m", "y_m", "z_m", "", "", "yaw_deg"};
  for (std::size_t i = 0; i < names.size(); ++i) {
    if (names[i].empty() || names[i] != name) continue;
    Element* pose = machine.FirstChildElement("pose");
    std::vector<std::string> words = pose ? words_of(text_of(*pose)) : std::vector<std::string>{};
    const bool in_degrees = pose && is_true(attribute(*pose, "degrees"));
    bool quaternion = pose && attribute(*pose, "rotation_format") == "quat_xyzw";
    // A new yaw replaces a quaternion by angles; a new place keeps it.
    Pose X;
    Faults unread;
    if (quaternion && i == 5 && read_pose(*pose, X, unread)) {
      const Vec3 turn = fixed_angles(X.linear());
      words.resize(6);
      for (int k = 0; k < 3; ++k)
        words[static_cast<std::size_t>(3 + k)] = scene::exact_text(turn[k]);
      quaternion = false;
    }
    // Missing numbers of a pose count as zeros.
    if (words.size() < 6) words.resize(6, "0");
    double number = 0;
    words[i] = value;
    // The key is in degrees, a pose usually in radians.
    if (i == 5 && !in_degrees && to_number(value, number))
      words[i] = scene::exact_text(number * kDegree);
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

/// Returns true if two texts hold equal numbers or words.
bool same_value(const std::string& a, const std::string& b) {
  const std::vector<std::string> left = words_of(a), right = words_of(b);
  return std::equal(left.begin(), left.end(), right.begin(), right.end(),
                    [](const std::string& x, const std::string& y) {
                      double u = 0, v = 0;
                      return x == y || (to_number(x, u) && to_number(y, v) && u == v);
                    });
}

/// Applies the settings of one command line, one after the other.
class Settings {
 public:
  Settings(Element& world, Faults& faults) : world_(world), faults_(faults) {}

  void apply(const std::string& key, const std::string& value) {
    std::vector<Part> parts;
    if (!check_text(key, value)) return;
    if (!split_key(key, parts) || !parts.back().which.empty())
      return key_fault(key, value, "a setting must look like object.element=value",
                       "e.g. soil.cohesion_pa=8000", faults_);
    std::string choice;
    if (!take_choice(key, value, parts, choice)) return;
    const SchemaNode* node = schema().root().child("world");
    std::vector<Element*> targets = {&world_};
    if (!find_targets(key, value, parts, targets, node)) return;
    // The node is null inside of a program: its steps are unknown here, and their reader checks
    // them.
    const std::string& leaf = parts.back().name;
    bool changed = false;
    for (Element* target : targets)
      changed = set(*target, node, {key, leaf, value, choice}) || changed;
    if (!changed)
      warn(key, value, "has no effect: the scene has this value already", "remove the setting");
  }

 private:
  /// One setting: its key, the element or attribute it names, its value, and the value of the
  /// element's attribute if the key ends in one.
  struct Setting {
    std::string key, leaf, value, choice;
  };

  /// Takes the last part of a key such as soil.friction_angle_deg.triaxial, where it is a value of
  /// an attribute of the element before it. Returns false after an error.
  bool take_choice(const std::string& key, const std::string& value, std::vector<Part>& parts,
                   std::string& choice) {
    if (parts.size() < 3) return true;
    const std::vector<const SchemaNode*>& own = schema().children(parts[parts.size() - 2].name);
    if (own.size() != 1 || !own[0]->attribute || own[0]->type != "choice") return true;
    choice = parts.back().name;
    const std::vector<std::string>& known = own[0]->choices;
    if (std::find(known.begin(), known.end(), choice) == known.end()) {
      key_fault(key, value, "unknown " + own[0]->name + " '" + choice + "'",
                faults_.nearest(choice, known), faults_);
      return false;
    }
    parts.pop_back();
    return true;
  }

  void warn(const std::string& key, const std::string& value, const std::string& rule,
            const std::string& remedy) {
    faults_.add({Fault::Severity::kWarning, "command line", 0, key, value, rule, remedy});
  }

  /// The scene is written out as it ran, so settings must be text that XML may hold.
  bool check_text(const std::string& key, const std::string& value) {
    const auto is_control = [](char c) {
      return (static_cast<unsigned char>(c) < 0x20 && c != '\t') || c == 0x7F;
    };
    const std::string all = key + value;
    if (first_bad_utf8(all) != std::string::npos)
      key_fault("", "", "a setting must be text in UTF-8", "check the terminal's encoding",
                faults_);
    else if (std::any_of(all.begin(), all.end(), is_control))
      key_fault("", "", "a setting must hold no control characters",
                "check how the shell has changed its value", faults_);
    else
      return true;
    return false;
  }

  /// Goes down from the world, part by part; each part may select several elements.
  bool find_targets(const std::string& key, const std::string& value,
                    const std::vector<Part>& parts, std::vector<Element*>& targets,
                    const SchemaNode*& node) {
    for (std::size_t i = 0; i + 1 < parts.size(); ++i) {
      const SchemaNode* child = node != nullptr ? node->child(parts[i].name) : nullptr;
      if (i == 0 && (child == nullptr || child->type != "element")) {
        key_fault(key, value, "unknown object '" + parts[0].name + "'",
                  faults_.nearest(parts[0].name, objects()), faults_);
        return false;
      }
      std::vector<Element*> next;
      for (Element* target : targets)
        for (Element* e : children_matching(*target, parts[i])) next.push_back(e);
      // A part that is no element may be the name of an object: machine.digger.uri.
      const bool by_name = i > 0 && next.empty() && child == nullptr && parts[i].which.empty();
      if (by_name)
        for (Element* target : targets)
          if (is_called(*target, parts[i].name, 0)) next.push_back(target);
      // An object that a scene has once, and may leave out, is created when it is needed.
      if (next.empty() && i == 0 && !child->repeats)
        next.push_back(world_.InsertNewChildElement(child->name.c_str()));
      if (next.empty()) {
        const std::string which = parts[i].which.empty() ? "" : "[" + parts[i].which + "]";
        key_fault(key, value, "the scene has no '" + parts[i].name + which + "'",
                  "see the names in the scene file", faults_);
        return false;
      }
      targets = std::move(next);
      if (by_name) continue;
      node = child != nullptr && child->name != "navvy:program" ? child : nullptr;
    }
    return true;
  }

  static std::vector<std::string> objects() {
    std::vector<std::string> out;
    for (const SchemaNode& child : schema().root().child("world")->children)
      if (child.type == "element" && child.name != "light" && child.name != "model")
        out.push_back(child.key);
    return out;
  }

  /// Sets one value of `target`; returns false if it had this value already.
  bool set(Element& target, const SchemaNode* node, const Setting& setting) {
    const auto& [key, leaf, value, choice] = setting;
    const SchemaNode* child = node != nullptr ? node->child(leaf) : nullptr;
    if (node != nullptr && node->key == "machine") {
      const std::string before = child_text(target, "pose");
      if (set_place(target, leaf, value)) return !same_value(before, child_text(target, "pose"));
      if (child == nullptr || child->type == "element") {
        std::vector<std::string> known = {"x_m", "y_m", "z_m", "yaw_deg"};
        for (const SchemaNode& one : node->children)
          if (one.type != "element") known.push_back(one.key);
        key_fault(key, value, "unknown element '" + leaf + "'", faults_.nearest(leaf, known),
                  faults_);
        return true;
      }
    }
    // An unknown name is written as it is, and the reader reports it.
    const std::string name = child != nullptr ? child->name : leaf;
    if (const auto [at, is_new] = written_.try_emplace({&target, name}, key); !is_new)
      warn(at->second, "", "has no effect: a later setting gives the value", "remove one of them");
    if (child != nullptr && child->attribute) {
      const std::string before = attribute(target, name.c_str());
      const bool changed = before != value;
      // A soil keeps the name by which layers and loads refer to it.
      const bool shipped = before.find(".sdf") == std::string::npos;
      if (name == "ref" && shipped && attribute(target, "name").empty())
        target.SetAttribute("name", before.c_str());
      target.SetAttribute(name.c_str(), value.c_str());
      return changed;
    }
    // The attribute of a value's element; an element with a value has no other children.
    const SchemaNode* own = child != nullptr && child->type != "element" && !child->children.empty()
                                ? &child->children[0]
                                : nullptr;
    const bool same_choice = own == nullptr || present_choice(target, *child) ==
                                                   (choice.empty() ? own->initial : choice);
    const bool changed = !same_choice || !same_value(value, present_value(target, child, name));
    // A soil's strength is given by one of two elements; the new one replaces the other.
    if (name == "friction_angle_deg" || name == "repose_angle_deg")
      for (const char* other : {"friction_angle_deg", "repose_angle_deg"})
        if (Element* old = target.FirstChildElement(other)) target.DeleteChild(old);
    set_value(target, name, value);
    if (own != nullptr && !choice.empty())
      target.FirstChildElement(name.c_str())->SetAttribute(own->name.c_str(), choice.c_str());
    return changed;
  }

  /// Returns what `read` finds in the element that gives `target` its value `name` without the
  /// setting: its own or that of the soil it refers to; without either, `initial`.
  template <class Read>
  static std::string present(const Element& target, const std::string& name,
                             const std::string& initial, const Read& read) {
    if (const Element* own = target.FirstChildElement(name.c_str())) return read(*own);
    const std::string ref = attribute(target, "ref");
    if (ref.empty()) return initial;
    Faults unread;
    const auto document = Document::open(soil_file(target, ref), unread);
    const Element* soil = document ? document->root()->FirstChildElement("navvy:soil") : nullptr;
    const Element* value = soil != nullptr ? soil->FirstChildElement(name.c_str()) : nullptr;
    return value != nullptr ? read(*value) : "";
  }
  static std::string present_value(const Element& target, const SchemaNode* child,
                                   const std::string& name) {
    return present(target, name, child != nullptr ? child->initial : "",
                   [](const Element& value) { return text_of(value); });
  }
  /// Returns the attribute of a value's element.
  static std::string present_choice(const Element& target, const SchemaNode& child) {
    const SchemaNode& own = child.children[0];
    return present(target, child.name, own.initial, [&own](const Element& value) {
      return value.Attribute(own.name.c_str()) != nullptr ? attribute(value, own.name.c_str())
                                                          : own.initial;
    });
  }

  Element& world_;
  Faults& faults_;
  /// Keys of settings by the value that they have written.
  std::map<std::pair<const Element*, std::string>, std::string> written_;
};

std::string pair_text(const Vec2& v) {
  return scene::exact_text(v.x()) + " " + scene::exact_text(v.y());
}

Element& section(Element& world, const char* name) {
  Element* found = world.FirstChildElement(name);
  return found ? *found : *world.InsertNewChildElement(name);
}

void apply_terrain(Element& world, const Overrides& overrides) {
  Element& ground = section(world, "navvy:ground");
  if (overrides.terrain) {
    // The file replaces shapes; layers and patches stay.
    for (const char* shape :
         {"slope", "hills", "stockpile", "trench", "bank", "block", "at_m", "at_local_m"})
      while (Element* old = ground.FirstChildElement(shape)) ground.DeleteChild(old);
    set_value(ground, "file", *overrides.terrain);
  }
  if (overrides.at) {
    for (const char* other : {"at_m", "at_local_m"})
      if (Element* old = ground.FirstChildElement(other)) ground.DeleteChild(old);
    set_value(ground, overrides.at_is_local ? "at_local_m" : "at_m", pair_text(*overrides.at));
  }
  if (overrides.size) set_value(ground, "size_m", pair_text(*overrides.size));
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

// Settings come last, so they win over options.
void apply_overrides(Document& document, const Overrides& overrides, Faults& faults) {
  Element* world = document.root()->FirstChildElement("world");
  if (!world) return;  // the reader reports it
  if (overrides.terrain || overrides.at || overrides.size) apply_terrain(*world, overrides);
  if (overrides.soil) {
    if (Element* soil = world->FirstChildElement("navvy:soil")) {
      if (soil->NextSiblingElement("navvy:soil") != nullptr)
        key_fault("--soil", *overrides.soil, "the scene has several soils",
                  "name one: --set soil[NAME].ref=" + *overrides.soil, faults);
      else
        Settings(*world, faults).apply("soil.ref", *overrides.soil);
    } else {
      world->InsertNewChildElement("navvy:soil")->SetAttribute("ref", overrides.soil->c_str());
    }
  }
  if (overrides.seed) set_value(*world, "navvy:seed", std::to_string(*overrides.seed));
  if (overrides.show) set_value(*world, "navvy:show", *overrides.show);
  if (overrides.duration)
    set_value(section(*world, "navvy:recording"), "duration_s",
              scene::exact_text(*overrides.duration));
  if (overrides.render)
    set_value(section(*world, "navvy:recording"), "render", *overrides.render ? "true" : "false");
  Settings settings(*world, faults);
  for (const auto& [key, value] : overrides.set) settings.apply(key, value);
}

void warn_of_unused_seed(Document& document, const Overrides& overrides, const scene::Scene& world,
                         Faults& faults) {
  const Element* element = document.root()->FirstChildElement("world");
  if (!overrides.seed || element == nullptr) return;
  bool used = false;
  for (const scene::GroundFeature& shape : world.ground.features)
    used = used || (shape.kind == scene::GroundFeature::Kind::kHills && !shape.has_seed);
  for (const scene::MachineInWorld& placed : world.machines)
    used = used || !placed.machine.encoders.empty() || placed.machine.has_sensors();
  if (!used)
    faults.add({Fault::Severity::kWarning, "command line", 0, "--seed",
                std::to_string(*overrides.seed),
                "has no effect: the scene has neither hills without a seed nor encoders or sensors",
                "remove it, or set ground.hills.seed"});
}

}  // namespace navvy::scene_io
