// SPDX-License-Identifier: Apache-2.0
// Completes worlds of other simulators: soil, ground, planes, frames, bodies without joints.
#include <algorithm>
#include <cmath>
#include <cstring>
#include <functional>
#include <map>
#include <set>

#include "scene_io/element_reader.h"
#include "scene_io/foreign.h"
#include "scene_io/foreign_private.h"

namespace navvy::scene_io {

namespace {

/// Ground under a world that names no soil: firm for wheels and bodies, as in a yard of gravel.
constexpr const char* kFirmSoil = "gravel";

std::string numbers_text(std::initializer_list<double> values) {
  std::string text;
  for (const double value : values) text += (text.empty() ? "" : " ") + scene::exact_text(value);
  return text;
}

/// Replaces the pose of an element.
void write_pose(Document& document, Element& owner, const Pose& X) {
  if (Element* old = owner.FirstChildElement("pose")) owner.DeleteChild(old);
  append(document, owner, "pose", owner, pose_text(X));
}

/// Completes one world.
class World {
 public:
  World(Document& document, Element& world, Faults& faults)
      : document_(document), world_(world), faults_(faults) {}

  void complete() {
    place_by_frames();
    for (Element* e : children_of(world_, {"model"})) split(*e);
    take_planes();
    add_soil();
    add_ground();
    leave_out();
    for (Element* e : children_of(world_, {"model"}))
      if (!has(*e, "navvy:on_ground")) append(document_, *e, "navvy:on_ground", *e, "false");
    add_camera();
    ignored_.report(faults_);
  }

 private:
  /// Replaces poses in frames of the world, or relative to other models, by poses in the world.
  void place_by_frames() {
    std::map<std::string, Element*> named;
    const std::vector<Element*> all = children_of(world_, {"frame", "model", "include"});
    for (Element* e : all) {
      const std::string own = attribute(*e, "name");
      named.try_emplace(own.empty() ? child_text(*e, "name") : own, e);
    }
    // Frames may hang on each other in any order, at most as deep as there are frames.
    std::function<bool(const Element&, Pose&, std::size_t)> pose_in_world =
        [&](const Element& e, Pose& X, std::size_t depth) {
          const Element* pose = e.FirstChildElement("pose");
          X = Pose::Identity();
          Faults unread;  // check_sdf reports what is no pose
          if (pose != nullptr && !text_of(*pose).empty() && !read_pose(*pose, X, unread))
            return false;
          std::string base = pose != nullptr ? attribute(*pose, "relative_to") : "";
          if (base.empty()) base = attribute(e, "attached_to");
          if (base.empty() || base == "world") return true;
          const auto at = named.find(base);
          Pose X_base;
          if (at == named.end() || depth > named.size() ||
              !pose_in_world(*at->second, X_base, depth + 1))
            return false;
          X = X_base * X;
          return true;
        };
    std::vector<std::pair<Element*, Pose>> placed;
    for (Element* e : all) {
      const Element* pose = e->FirstChildElement("pose");
      Pose X;
      if (pose != nullptr && pose->Attribute("relative_to") != nullptr && pose_in_world(*e, X, 0))
        placed.emplace_back(e, X);
    }
    for (const auto& [e, X] : placed) write_pose(document_, *e, X);
    for (Element* e : children_of(world_, {"frame"})) world_.DeleteChild(e);
  }

  /// Returns the links of a model in groups that joints connect, in the order of the file.
  static std::vector<std::vector<std::string>> groups_of(const Element& model) {
    std::map<std::string, std::string> above;
    std::function<std::string(const std::string&)> top = [&](std::string name) {
      while (above.at(name) != name) name = above.at(name);
      return name;
    };
    for (const Element* e = model.FirstChildElement("link"); e; e = e->NextSiblingElement("link"))
      above.try_emplace(attribute(*e, "name"), attribute(*e, "name"));
    for (const Element* e = model.FirstChildElement("joint"); e;
         e = e->NextSiblingElement("joint")) {
      const std::string a = child_text(*e, "parent"), b = child_text(*e, "child");
      if (above.count(a) > 0 && above.count(b) > 0) above[top(b)] = top(a);
    }
    std::vector<std::vector<std::string>> groups;
    std::map<std::string, std::size_t> place;
    for (const Element* e = model.FirstChildElement("link"); e; e = e->NextSiblingElement("link")) {
      const std::string name = attribute(*e, "name");
      const auto [at, is_new] = place.try_emplace(top(name), groups.size());
      if (is_new) groups.emplace_back();
      groups[at->second].push_back(name);
    }
    return groups;
  }

  /// Links without a joint between them are bodies of their own in SDF. In a static model they are
  /// welded together, otherwise each group becomes a model.
  void split(Element& model) {
    // Nested models and frames connect links in ways that are only known after assembly.
    if (has(model, "model") || has(model, "include") || has(model, "frame")) return;
    const auto groups = groups_of(model);
    if (groups.size() < 2) return;
    if (is_true(child_text(model, "static"))) {
      for (std::size_t i = 1; i < groups.size(); ++i) {
        Element& joint = append(document_, model, "joint", model);
        joint.SetAttribute("name", ("weld_of_" + groups[i][0]).c_str());
        joint.SetAttribute("type", "fixed");
        append(document_, joint, "parent", model, groups[0][0]);
        append(document_, joint, "child", model, groups[i][0]);
      }
      return;
    }
    for (std::size_t i = 1; i < groups.size(); ++i) move_out(model, groups[i]);
  }

  /// Moves links and the joints between them into a model of their own.
  void move_out(Element& model, const std::vector<std::string>& links) {
    Element& to = append(document_, world_, "model", model);
    to.SetAttribute("name", (attribute(model, "name") + "::" + links[0]).c_str());
    for (const char* name : {"pose", "self_collide"})
      if (const Element* e = model.FirstChildElement(name)) Document::append_copy(to, *e);
    const auto is_ours = [&](const std::string& name) {
      return std::find(links.begin(), links.end(), name) != links.end();
    };
    for (Element* e : children_of(model, {"link", "joint"})) {
      const bool joint = std::strcmp(e->Name(), "joint") == 0;
      if (!is_ours(joint ? child_text(*e, "child") : attribute(*e, "name"))) continue;
      Document::append_copy(to, *e);
      model.DeleteChild(e);
    }
  }

  /// Returns the position of a model; zero where it cannot be read.
  static Vec3 place_of_model(const Element& model) {
    Pose X = Pose::Identity();
    Faults unread;
    if (const Element* pose = model.FirstChildElement("pose"))
      if (!text_of(*pose).empty()) read_pose(*pose, X, unread);
    return X.translation();
  }

  /// Planes of static models are the ground: their shapes are removed, and the highest one gives
  /// the ground its height and slope.
  void take_planes() {
    for (Element* model : children_of(world_, {"model"})) {
      if (!is_true(child_text(*model, "static"))) continue;
      std::size_t left = 0, taken = 0;
      for (Element* link : children_of(*model, {"link"}))
        for (Element* shape : children_of(*link, {"collision", "visual"})) {
          if (!take_plane(*model, *link, *shape)) {
            ++left;
          } else {
            ++taken;
            link->DeleteChild(shape);
          }
        }
      if (taken > 0 && left == 0) world_.DeleteChild(model);
    }
  }

  /// Returns true if the shape is a plane that can be ground, and takes its height and slope.
  bool take_plane(const Element& model, const Element& link, const Element& shape) {
    const Element* geometry = shape.FirstChildElement("geometry");
    const Element* plane = geometry != nullptr ? geometry->FirstChildElement("plane") : nullptr;
    if (plane == nullptr) return false;
    Pose X = Pose::Identity();
    Faults unread;
    for (const Element* e : {&model, &link, &shape}) {
      Pose X_one = Pose::Identity();
      const Element* pose = e->FirstChildElement("pose");
      if (pose != nullptr && !text_of(*pose).empty() && read_pose(*pose, X_one, unread))
        X = X * X_one;
    }
    std::vector<double> normal = {0, 0, 1};
    if (const Element* n = plane->FirstChildElement("normal"))
      read_numbers(*n, 3, {}, normal, unread);
    const Vec3 up = X.linear() * Vec3(normal[0], normal[1], normal[2]).normalized();
    // The ground may slope by 60 degrees; a steeper plane is reported by later rules.
    if (normal.size() != 3 || !(up.z() > 0.5)) return false;
    if (std::strcmp(shape.Name(), "collision") != 0) return true;
    if (has_surface_ && X.translation().z() <= surface_) return true;
    has_surface_ = true;
    surface_ = X.translation().z();
    plane_up_ = up;
    plane_place_ = X.translation().head<2>();
    return true;
  }

  void add_soil() {
    if (has(world_, "navvy:soil")) return;
    append(document_, world_, "navvy:soil", world_).SetAttribute("ref", kFirmSoil);
    ignored_.add(world_, "missing soil", "--soil NAME gives it another",
                 "has no soil: it stands on firm gravel");
  }

  void add_ground() {
    Element* ground = world_.FirstChildElement("navvy:ground");
    if (ground == nullptr) ground = &append(document_, world_, "navvy:ground", world_);
    if (!has(*ground, "size_m") && !has(*ground, "file")) {
      // A margin beyond the outermost model, on a site as large as a yard at least.
      double half = 10;
      for (const Element* e : children_of(world_, {"model", "include"}))
        half = std::max(half, place_of_model(*e).head<2>().cwiseAbs().maxCoeff() + 5);
      half = std::min(std::ceil(half), 500.0);
      append(document_, *ground, "size_m", *ground, numbers_text({2 * half, 2 * half}));
    }
    if (has_surface_ && !has(*ground, "surface_m") && !has(*ground, "file"))
      append(document_, *ground, "surface_m", *ground, scene::exact_text(surface_));
    // 1e-6 allows for angles such as 3.14159.
    if (!has_surface_ || plane_up_.z() > 1 - 1e-6 || has(*ground, "file")) return;
    Element& slope = append(document_, *ground, "slope", *ground);
    append(document_, slope, "center_m", *ground,
           numbers_text({plane_place_.x(), plane_place_.y()}));
    append(document_, slope, "yaw_deg", *ground,
           scene::exact_text(degrees(std::atan2(-plane_up_.y(), -plane_up_.x()))));
    append(document_, slope, "angle_deg", *ground,
           scene::exact_text(degrees(std::acos(plane_up_.z()))));
  }

  /// Leaves out models beyond the site, which nothing on it can reach.
  void leave_out() {
    const Element& ground = *world_.FirstChildElement("navvy:ground");
    std::vector<double> size, origin;
    Faults unread;
    const Element* extent = ground.FirstChildElement("size_m");
    if (extent == nullptr || has(ground, "origin_m") || has(ground, "file") ||
        !read_numbers(*extent, 2, {}, size, unread))
      return;
    for (Element* e : children_of(world_, {"model", "include"})) {
      const Vec3 p = place_of_model(*e);
      if (std::abs(p.x()) <= size[0] / 2 && std::abs(p.y()) <= size[1] / 2) continue;
      ignored_.add(*e, "model beyond the site", "it is beyond the site: enlarge it by --size X,Y");
      world_.DeleteChild(e);
    }
  }

  /// A picture of the whole site, as the windows of other simulators show.
  void add_camera() {
    if (has(world_, "navvy:camera")) return;
    const Element* extent = world_.FirstChildElement("navvy:ground")->FirstChildElement("size_m");
    std::vector<double> size = {20, 20};
    Faults unread;
    if (extent != nullptr) read_numbers(*extent, 2, {}, size, unread);
    if (size.size() != 2) return;
    // Near enough to see a robot on a small site, and the whole of a large one.
    const double far = std::clamp(0.25 * std::max(size[0], size[1]), 2.0, 60.0);
    Element& camera = append(document_, world_, "navvy:camera", world_);
    camera.SetAttribute("name", "overview");
    append(document_, camera, "position_m", camera,
           numbers_text({-0.8 * far, -0.7 * far, surface_ + 0.6 * far}));
    append(document_, camera, "target_m", camera, numbers_text({0, 0, surface_}));
  }

  Document& document_;
  Element& world_;
  Faults& faults_;
  IgnoredKinds ignored_;
  bool has_surface_ = false;         ///< true: a plane gave the height of the ground
  double surface_ = 0;               ///< height of the highest plane's origin [m]
  Vec3 plane_up_ = Vec3::UnitZ();    ///< normal of that plane
  Vec2 plane_place_ = Vec2::Zero();  ///< origin of that plane [m]
};

}  // namespace

void complete_world(Document& document, Faults& faults) {
  Element* world = document.root()->FirstChildElement("world");
  if (document.foreign() && world != nullptr) World(document, *world, faults).complete();
}

}  // namespace navvy::scene_io
