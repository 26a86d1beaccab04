// SPDX-License-Identifier: Apache-2.0
// Converts URDF to SDF elements that keep their file and line. libsdformat has a converter, too,
// but it drops massless links with their joints and names no lines.
#include <algorithm>
#include <cmath>
#include <cstring>
#include <map>
#include <set>

#include "core/limits.h"
#include "scene/fields.h"
#include "scene_io/foreign_private.h"

namespace navvy::scene_io {

namespace {

/// Returns the words of an attribute; those of `otherwise` if it is missing.
std::string attribute_or(const Element* element, const char* name, const char* otherwise) {
  const char* value = element != nullptr ? element->Attribute(name) : nullptr;
  return value != nullptr ? value : otherwise;
}

/// Returns the text of an SDF <pose> for a URDF <origin>, which may be missing.
std::string pose_of(const Element* origin) {
  return attribute_or(origin, "xyz", "0 0 0") + " " + attribute_or(origin, "rpy", "0 0 0");
}

/// Converts one <robot>.
class Converter {
 public:
  Converter(Document& document, IgnoredKinds& ignored, Faults& faults)
      : document_(document), robot_(*document.root()), ignored_(ignored), faults_(faults) {}

  bool convert() {
    if (!read_names() || !find_bases()) return false;
    Element& sdf = *document_.create("sdf", robot_);
    sdf.SetAttribute("version", "1.9");
    sdf.SetAttribute("xmlns:navvy", "navvy");
    Element& model = append(document_, sdf, "model", robot_);
    model.SetAttribute("name", attribute_or(&robot_, "name", "robot").c_str());
    for (const Element* e = robot_.FirstChildElement("link"); e; e = e->NextSiblingElement("link"))
      add_link(model, *e);
    for (const Element* e = robot_.FirstChildElement("joint"); e;
         e = e->NextSiblingElement("joint"))
      add_joint(model, *e);
    add_closing_joints(model);
    add_ground(model);
    add_shapes_of_frames();
    ignore_rest();
    document_.replace_root(sdf);
    return true;
  }

 private:
  /// Collects materials, links and the joint above each link. Returns false after an error.
  bool read_names() {
    const std::size_t before = faults_.error_count();
    for (const Element* e = robot_.FirstChildElement("material"); e;
         e = e->NextSiblingElement("material"))
      materials_[attribute(*e, "name")] = e;
    for (const Element* e = robot_.FirstChildElement("link"); e;
         e = e->NextSiblingElement("link")) {
      // A material is defined at its first use as well.
      for (const Element* v = e->FirstChildElement("visual"); v;
           v = v->NextSiblingElement("visual"))
        if (const Element* m = v->FirstChildElement("material"); m && m->FirstChildElement("color"))
          materials_.try_emplace(attribute(*m, "name"), m);
      if (!links_.try_emplace(attribute(*e, "name"), e).second)
        faults_.error(*e, attribute(*e, "name"), "names of links must be unique", "rename it");
    }
    // The walks below are quadratic in these numbers.
    for (const auto& [kind, most] :
         {std::pair{"link", limits::kLinks}, std::pair{"joint", limits::kLinks}})
      if (count(kind) > most) {
        faults_.error(robot_, std::to_string(count(kind)),
                      "at most " + std::to_string(most) + " <" + kind + "> in one <robot>",
                      "docs/reference/limits.md lists the limits of files");
        return false;
      }
    read_gazebo();
    if (links_.empty())
      faults_.error(robot_, "", "a <robot> needs at least one <link>", "add a <link>");
    for (const Element* e = robot_.FirstChildElement("joint"); e;
         e = e->NextSiblingElement("joint"))
      read_joint(*e);
    return faults_.error_count() == before;
  }

  std::size_t count(const char* kind) const {
    std::size_t found = 0;
    for (const Element* e = robot_.FirstChildElement(kind); e; e = e->NextSiblingElement(kind))
      ++found;
    return found;
  }

  /// Collects what <gazebo reference="NAME"> gives: the friction of a link as <mu1>, and the spring
  /// of a joint.
  void read_gazebo() {
    for (const Element* e = robot_.FirstChildElement("gazebo"); e;
         e = e->NextSiblingElement("gazebo")) {
      if (const Element* mu = e->FirstChildElement("mu1"))
        frictions_.try_emplace(attribute(*e, "reference"), mu);
      if (e->FirstChildElement("springStiffness") != nullptr)
        springs_.try_emplace(attribute(*e, "reference"), e);
    }
  }

  void read_joint(const Element& joint) {
    for (const char* end : {"parent", "child"}) {
      const Element* at = joint.FirstChildElement(end);
      const std::string name = attribute_or(at, "link", "");
      if (links_.count(name) == 0)
        faults_.error(
            at != nullptr ? *at : joint, name,
            std::string("a joint needs <") + end + " link=\"...\"/> with a link of the robot",
            at != nullptr ? faults_.nearest(name, link_names()) : "add it");
    }
    const std::string child = attribute_or(joint.FirstChildElement("child"), "link", "");
    const auto [at, is_new] = above_.try_emplace(child, &joint);
    if (!is_new)
      faults_.error(joint, child,
                    "a link can be the child of one joint only; joint '" +
                        attribute(*at->second, "name") + "' moves it already",
                    "in URDF links form a tree: write the joint that closes the loop in SDF, as "
                    "<gazebo><joint name=... type=...><parent>...</parent><child>...</child>"
                    "<axis>...</axis></joint></gazebo>");
  }

  std::vector<std::string> link_names() const {
    std::vector<std::string> names;
    for (const auto& [name, link] : links_) names.push_back(name);
    return names;
  }

  /// Finds the one link without a parent.
  bool find_bases() {
    std::vector<const Element*> bases;
    for (const Element* e = robot_.FirstChildElement("link"); e; e = e->NextSiblingElement("link"))
      if (above_.count(attribute(*e, "name")) == 0) bases.push_back(e);
    if (bases.empty()) {
      faults_.error(robot_, "", "the joints form a loop: no link is the base",
                    "remove the joint that closes it: links form a tree");
      return false;
    }
    for (std::size_t i = 1; i < bases.size(); ++i)
      faults_.error(*bases[i], attribute(*bases[i], "name"),
                    "a robot has one root link, here '" + attribute(*bases[0], "name") +
                        "'; no joint connects this link to it",
                    "add a joint (type fixed to weld it), or make it a robot of its own");
    if (bases.size() > 1) return false;
    base_ = attribute(*bases[0], "name");
    return find_loops();
  }

  /// Reports a loop of joints beside the tree of the base.
  bool find_loops() {
    for (const auto& [name, link] : links_) {
      std::string at = name;
      std::size_t steps = 0;
      for (auto up = above_.find(at); up != above_.end(); up = above_.find(at)) {
        at = attribute_or(up->second->FirstChildElement("parent"), "link", "");
        if (++steps <= links_.size()) continue;
        faults_.error(*up->second, name, "the joints form a loop beside the base '" + base_ + "'",
                      "remove the joint that closes it: links form a tree");
        return false;
      }
    }
    return true;
  }

  /// Returns true for a link without mass that a fixed joint holds, or that is the root above one:
  /// it becomes a frame of its neighbour.
  bool is_frame(const std::string& name) const {
    if (is_world(name)) return true;
    if (has_mass(*links_.at(name))) return false;
    const auto joint = above_.find(name);
    if (joint != above_.end()) return attribute(*joint->second, "type") == "fixed";
    return !carried_by(name).empty();
  }

  /// Returns true for a massless root named world: by convention it stands for the ground.
  bool is_world(const std::string& name) const {
    return name == "world" && name == base_ && !has_mass(*links_.at(name));
  }

  /// Returns true unless the link has no mass, or one of zero, which means the same.
  static bool has_mass(const Element& link) {
    const Element* inertial = link.FirstChildElement("inertial");
    const Element* mass = inertial != nullptr ? inertial->FirstChildElement("mass") : nullptr;
    return mass != nullptr && loose_number(attribute(*mass, "value"), 1) != 0;
  }

  /// Returns the first link that a fixed joint connects to the massless root `name`.
  std::string carried_by(const std::string& name) const {
    for (const Element* e = robot_.FirstChildElement("joint"); e;
         e = e->NextSiblingElement("joint"))
      if (attribute_or(e->FirstChildElement("parent"), "link", "") == name &&
          attribute(*e, "type") == "fixed")
        return attribute_or(e->FirstChildElement("child"), "link", "");
    return "";
  }

  /// Returns the link of SDF that carries what belongs to the URDF link `name`.
  std::string carrier(std::string name) const {
    // Massless roots first: they hang on a link below them.
    while (name == base_ && is_frame(name)) {
      const std::string below = carried_by(name);
      if (below.empty()) return "";
      if (!is_frame(below) || below == base_) return below;
      // A chain of frames from the root down ends at the first link with a mass.
      for (std::string at = below;;) {
        const std::string next = carried_by(at);
        if (next.empty()) return at;
        if (!is_frame(next)) return next;
        at = next;
      }
    }
    while (is_frame(name)) {
      const std::string parent =
          attribute_or(above_.at(name)->FirstChildElement("parent"), "link", "");
      if (parent == base_ && is_frame(base_)) return carrier(base_);
      name = parent;
    }
    return name;
  }

  void add_link(Element& model, const Element& from) {
    const std::string name = attribute(from, "name");
    const auto joint = above_.find(name);
    const Element* origin =
        joint != above_.end() ? joint->second->FirstChildElement("origin") : nullptr;
    const std::string parent =
        joint != above_.end() ? attribute_or(joint->second->FirstChildElement("parent"), "link", "")
                              : "";
    const bool frame = is_frame(name) && carrier(name) != name;
    if (is_world(name)) return;
    Element& to = append(document_, model, frame ? "frame" : "link", from);
    to.SetAttribute("name", name.c_str());
    if (frame) to.SetAttribute("attached_to", carrier(name).c_str());
    Element& pose =
        append(document_, to, "pose", origin != nullptr ? *origin : from, pose_of(origin));
    // The frame of a link is that of its joint, given in the parent's.
    const bool in_model = parent.empty() || is_world(parent);
    pose.SetAttribute("relative_to", in_model ? "__model__" : parent.c_str());
    if (frame) {
      frames_.push_back(&from);
      return;
    }
    made_[name] = &to;
    add_inertial(to, from);
    add_shapes(to, from, "");
  }

  void add_inertial(Element& to, const Element& from) {
    const Element* inertial = from.FirstChildElement("inertial");
    Element& out = append(document_, to, "inertial", inertial != nullptr ? *inertial : from);
    if (!has_mass(from)) {
      // A joint moves this link, so it needs a mass; its inertia is that of a small ball.
      append(document_, out, "mass", from, "0.001");
      Element& inertia = append(document_, out, "inertia", from);
      for (const char* key : {"ixx", "iyy", "izz"}) append(document_, inertia, key, from, "1e-6");
      ignored_.add(from, "missing mass", "give it an <inertial>",
                   "a joint moves this link without mass: 1 g is assumed");
      return;
    }
    if (const Element* origin = inertial->FirstChildElement("origin"))
      append(document_, out, "pose", *origin, pose_of(origin));
    const Element* mass = inertial->FirstChildElement("mass");
    append(document_, out, "mass", mass != nullptr ? *mass : *inertial,
           attribute_or(mass, "value", "0"));
    const Element* given = inertial->FirstChildElement("inertia");
    if (given == nullptr) return;
    Element& inertia = append(document_, out, "inertia", *given);
    bool none = true;
    for (const char* key : {"ixx", "iyy", "izz"})
      none = none && loose_number(attribute_or(given, key, "1"), 1) == 0;
    if (none) {
      // Some files leave it to the reader. Here it is that of a ball of water of the same mass.
      const double m = std::max(loose_number(attribute_or(mass, "value", "1"), 1), 1e-6);
      const double radius = std::cbrt(3 * m / (4 * kPi * 1000));
      for (const char* key : {"ixx", "iyy", "izz"})
        append(document_, inertia, key, *given, scene::exact_text(0.4 * m * radius * radius));
      ignored_.add(*given, "inertia of zero", "give it the moments of inertia",
                   "has no inertia: that of a ball of water of this mass is assumed");
      return;
    }
    for (const char* key : {"ixx", "ixy", "ixz", "iyy", "iyz", "izz"})
      if (given->Attribute(key) != nullptr)
        append(document_, inertia, key, *given, attribute(*given, key));
  }

  /// Adds visuals and collisions; `frame` is the frame in which their origins are, or empty.
  void add_shapes(Element& to, const Element& from, const std::string& frame) {
    for (const char* kind : {"visual", "collision"}) {
      int place = 0;
      for (const Element* e = from.FirstChildElement(kind); e; e = e->NextSiblingElement(kind)) {
        Element& shape = append(document_, to, kind, *e);
        const std::string name = kind + std::string("_") + std::to_string(++place);
        shape.SetAttribute("name", (frame.empty() ? name : frame + "_" + name).c_str());
        const Element* origin = e->FirstChildElement("origin");
        Element& pose =
            append(document_, shape, "pose", origin != nullptr ? *origin : *e, pose_of(origin));
        if (!frame.empty()) pose.SetAttribute("relative_to", frame.c_str());
        add_geometry(shape, *e);
        if (std::strcmp(kind, "visual") == 0) add_color(shape, *e);
        if (std::strcmp(kind, "collision") == 0) add_friction(shape, attribute(from, "name"));
      }
    }
  }

  void add_geometry(Element& to, const Element& from) {
    const Element* geometry = from.FirstChildElement("geometry");
    const Element* shape = geometry != nullptr ? geometry->FirstChildElement() : nullptr;
    if (shape == nullptr) return;
    Element& out =
        append(document_, append(document_, to, "geometry", *geometry), shape->Name(), *shape);
    // Attributes of URDF are elements of SDF.
    for (const auto& [key, name] :
         {std::pair{"size", "size"}, std::pair{"radius", "radius"}, std::pair{"length", "length"},
          std::pair{"filename", "uri"}, std::pair{"scale", "scale"}})
      if (const char* value = shape->Attribute(key)) append(document_, out, name, *shape, value);
  }

  void add_color(Element& to, const Element& from) {
    const Element* material = from.FirstChildElement("material");
    if (material == nullptr) return;
    const Element* color = material->FirstChildElement("color");
    if (color == nullptr)
      if (const auto at = materials_.find(attribute(*material, "name")); at != materials_.end())
        color = at->second->FirstChildElement("color");
    if (color == nullptr) return;
    append(document_, append(document_, to, "material", *material), "diffuse", *color,
           attribute(*color, "rgba"));
  }

  /// Adds the friction of a link to one of its collisions.
  void add_friction(Element& to, const std::string& link) {
    const auto found = frictions_.find(link);
    if (found == frictions_.end()) return;
    const Element& mu = *found->second;
    Element* at = &to;
    for (const char* name : {"surface", "friction", "ode"}) at = &append(document_, *at, name, mu);
    append(document_, *at, "mu", mu, mu.Attribute("value") ? attribute(mu, "value") : text_of(mu));
  }

  void add_joint(Element& model, const Element& from) {
    const std::string child = attribute_or(from.FirstChildElement("child"), "link", "");
    const std::string parent = attribute_or(from.FirstChildElement("parent"), "link", "");
    const std::string type = attribute(from, "type");
    // Frames need no joint, and a floating root is a free machine.
    if (is_frame(child) || (is_world(parent) && type == "floating")) return;
    // The first link below a massless root is the base.
    const bool on_frame = is_frame(parent) && (!is_world(parent) || type == "fixed");
    const std::string on = on_frame ? carrier(parent) : parent;
    if (on == child) return;
    Element& to = append(document_, model, "joint", from);
    to.SetAttribute("name", attribute(from, "name").c_str());
    to.SetAttribute("type", type.c_str());
    append(document_, to, "parent", *from.FirstChildElement("parent"), on);
    append(document_, to, "child", *from.FirstChildElement("child"), child);
    if (type == "revolute" || type == "continuous" || type == "prismatic") add_axis(to, from, type);
  }

  void add_axis(Element& to, const Element& from, const std::string& type) {
    const Element* given = from.FirstChildElement("axis");
    Element& axis = append(document_, to, "axis", given != nullptr ? *given : from);
    append(document_, axis, "xyz", given != nullptr ? *given : from,
           attribute_or(given, "xyz", "1 0 0"));
    if (const Element* limit = from.FirstChildElement("limit")) {
      Element& out = append(document_, axis, "limit", *limit);
      for (const char* key : {"lower", "upper", "effort", "velocity"}) {
        const bool position = std::strcmp(key, "lower") == 0 || std::strcmp(key, "upper") == 0;
        if (position && type == "continuous") continue;
        // URDF's default of both positions is zero.
        const char* value = limit->Attribute(key);
        if (value != nullptr || position)
          append(document_, out, key, *limit, value != nullptr ? value : "0");
      }
    }
    add_dynamics(axis, from);
    if (const Element* mimic = from.FirstChildElement("mimic")) add_mimic(axis, *mimic);
  }

  /// Adds damping and friction, and the spring that <gazebo reference="JOINT"> gives.
  void add_dynamics(Element& axis, const Element& from) {
    const Element* dynamics = from.FirstChildElement("dynamics");
    const auto spring = springs_.find(attribute(from, "name"));
    if (dynamics == nullptr && spring == springs_.end()) return;
    Element& out =
        append(document_, axis, "dynamics", dynamics != nullptr ? *dynamics : *spring->second);
    for (const char* key : {"damping", "friction"})
      if (const char* value = dynamics != nullptr ? dynamics->Attribute(key) : nullptr)
        append(document_, out, key, *dynamics, value);
    if (spring == springs_.end()) return;
    for (const auto& [key, name] : {std::pair{"springStiffness", "spring_stiffness"},
                                    std::pair{"springReference", "spring_reference"}})
      if (const Element* e = spring->second->FirstChildElement(key))
        append(document_, out, name, *e,
               e->Attribute("value") ? attribute(*e, "value") : text_of(*e));
  }

  /// Adds the element that SDF has had for it since 1.11.
  void add_mimic(Element& axis, const Element& from) {
    Element& out = append(document_, axis, "mimic", from);
    out.SetAttribute("joint", attribute(from, "joint").c_str());
    for (const char* key : {"multiplier", "offset"})
      if (const char* value = from.Attribute(key)) append(document_, out, key, from, value);
  }

  /// Adds the joints of SDF that <gazebo> without a reference holds: they close loops.
  void add_closing_joints(Element& model) {
    for (const Element* e = robot_.FirstChildElement("gazebo"); e;
         e = e->NextSiblingElement("gazebo"))
      for (const Element* joint = e->FirstChildElement("joint");
           joint != nullptr && e->Attribute("reference") == nullptr;
           joint = joint->NextSiblingElement("joint")) {
        Element& to = append(document_, model, "joint", *joint);
        for (const char* key : {"name", "type"})
          to.SetAttribute(key, attribute(*joint, key).c_str());
        for (const char* key : {"parent", "child", "pose", "axis"})
          if (const Element* part = joint->FirstChildElement(key)) Document::append_copy(to, *part);
      }
  }

  /// Fixes the base to the world where the root is a link named world above a fixed joint.
  void add_ground(Element& model) {
    const std::string held = is_world(base_) ? carrier(base_) : "";
    if (held.empty()) return;
    Element& joint = append(document_, model, "joint", *links_.at(base_));
    joint.SetAttribute("name", "world_joint");
    joint.SetAttribute("type", "fixed");
    append(document_, joint, "parent", *links_.at(base_), "world");
    append(document_, joint, "child", *links_.at(base_), held);
  }

  /// Gives the shapes of massless links to the links that carry them.
  void add_shapes_of_frames() {
    for (const Element* from : frames_)
      if (const auto to = made_.find(carrier(attribute(*from, "name"))); to != made_.end())
        add_shapes(*to->second, *from, attribute(*from, "name"));
  }

  void ignore_rest() {
    for (const Element* e = robot_.FirstChildElement(); e; e = e->NextSiblingElement()) {
      const std::string name = e->Name();
      if (name == "link" || name == "joint" || name == "material") continue;
      if (name == "gazebo" && e->FirstChildElement("plugin") == nullptr) continue;
      ignored_.add(*e, name,
                   name == "gazebo" ? "plugins of Gazebo are not run"
                                    : "it has no effect on bodies and joints");
    }
  }

  Document& document_;
  Element& robot_;
  IgnoredKinds& ignored_;
  Faults& faults_;
  std::map<std::string, const Element*> materials_, links_;
  std::map<std::string, const Element*> above_;      ///< the joint above each link but the root
  std::map<std::string, Element*> made_;             ///< links of SDF by name
  std::vector<const Element*> frames_;               ///< massless links
  std::map<std::string, const Element*> frictions_;  ///< <mu1> by the name of the link
  std::map<std::string, const Element*> springs_;    ///< <gazebo> by the name of the joint
  std::string base_;                                 ///< name of the root link
};

}  // namespace

bool convert_urdf(Document& document, IgnoredKinds& ignored, Faults& faults) {
  return Converter(document, ignored, faults).convert();
}

}  // namespace navvy::scene_io
