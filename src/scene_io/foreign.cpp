// SPDX-License-Identifier: Apache-2.0
#include "scene_io/foreign.h"

#include <algorithm>
#include <cctype>
#include <cmath>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <limits>
#include <utility>

#include "scene/scaled_mesh.h"
#include "scene_io/element_reader.h"
#include "scene_io/foreign_private.h"
#include "scene_io/xml_limits.h"

namespace navvy::scene_io {

namespace {

/// Returns true if the element, its attributes or anything inside it is of the namespace `navvy:`.
bool holds_extension(const Element& element) {
  if (is_extension(element)) return true;
  for (const auto* at = element.FirstAttribute(); at; at = at->Next())
    if (std::strstr(at->Name(), "navvy") != nullptr) return true;
  for (const Element* e = element.FirstChildElement(); e; e = e->NextSiblingElement())
    if (holds_extension(*e)) return true;
  return false;
}

/// Returns the z of the lowest point of a shape at the pose `X` [m].
double lowest_of(const scene::Geometry& shape, const Pose& X) {
  using Kind = scene::Geometry::Kind;
  const double z = X.translation().z();
  // The vertical in the shape's frame: a support point lies farthest against it.
  const Vec3 up = X.linear().transpose() * Vec3::UnitZ();
  const double rim = shape.radius * std::hypot(up.x(), up.y()), half = shape.length / 2;
  switch (shape.kind) {
    case Kind::kBox:
      return z - (shape.size / 2).cwiseProduct(up.cwiseAbs()).sum();
    case Kind::kCylinder:
      return z - half * std::abs(up.z()) - rim;
    case Kind::kCone:
      return z + std::min(half * up.z(), -half * up.z() - rim);
    case Kind::kCapsule:
      return z - half * std::abs(up.z()) - shape.radius;
    case Kind::kSphere:
      return z - shape.radius;
    case Kind::kPlane:
      return z;
    case Kind::kMesh:
      break;
  }
  double lowest = std::numeric_limits<double>::infinity();
  for (const Vec3& v : scene::scaled_mesh(shape).vertices) lowest = std::min(lowest, (X * v).z());
  return lowest;
}

}  // namespace

void IgnoredKinds::add(const Element& at, const std::string& kind, const std::string& why,
                       const std::string& rule) {
  Kind& one = kinds_[kind];
  if (++one.count > 1) return;
  const Place place = place_of(at);
  one.first.severity = Fault::Severity::kWarning;
  one.first.file = place.file != nullptr ? *place.file : "";
  one.first.line = place.line;
  one.first.element = element_path(at);
  // Long texts, such as settings of a plugin, are of no use here.
  const std::string value = text_of(at);
  if (value.size() <= 40) one.first.value = value;
  one.first.rule = rule;
  one.first.remedy = why;
}

void IgnoredKinds::report(Faults& faults) const {
  for (const auto& [kind, one] : kinds_) {
    Fault fault = one.first;
    if (one.count > 1)
      fault.rule += ", here and in " + std::to_string(one.count - 1) + " more places";
    // A file that is opened again says the same again.
    const auto same = [&fault](const Fault& other) {
      return other.file == fault.file && other.line == fault.line &&
             other.element == fault.element && other.rule == fault.rule;
    };
    if (std::none_of(faults.list().begin(), faults.list().end(), same)) faults.add(fault);
  }
}

bool check_expanded(const Element& element, Faults& faults) {
  const bool sdf = std::strcmp(element.GetDocument()->RootElement()->Name(), "sdf") == 0;
  // Plugins are not run, and their settings have a syntax of their own.
  if (sdf && std::strcmp(element.Name(), "plugin") == 0) return true;
  const auto refuse = [&](const std::string& text, const std::string& what) {
    faults.error(
        element, text, what,
        std::string("run `xacro FILE > robot.") + (sdf ? "sdf" : "urdf") + "` and load its result");
    return false;
  };
  const auto check_text_of = [&](const std::string& text) {
    for (const char* one : {"$(optenv", "$(env", "$(find", "$(arg", "$(eval", "$(dirname"})
      if (text.find(one) != std::string::npos)
        return refuse(text, std::string(one) + " ...) is a substitution of ROS that was not made");
    if (text.find("${") != std::string::npos)
      return refuse(text, "${...} is an expression of xacro that was not expanded");
    return true;
  };
  if (std::strncmp(element.Name(), "xacro:", 6) == 0)
    return refuse(element.Name(), "the file is xacro that was not expanded");
  for (const auto* at = element.FirstAttribute(); at; at = at->Next())
    if (!check_text_of(at->Value())) return false;
  if (!check_text_of(text_of(element))) return false;
  // The first one says it all: a file of xacro is full of them.
  for (const Element* e = element.FirstChildElement(); e; e = e->NextSiblingElement())
    if (!check_expanded(*e, faults)) return false;
  return true;
}

double loose_number(const std::string& text, double otherwise) {
  char* end = nullptr;
  const double value = std::strtod(text.c_str(), &end);
  return end == text.c_str() || *end != '\0' ? otherwise : value;
}

std::string pose_text(const Pose& X) {
  const Vec3 angles = fixed_angles(X.linear());
  std::string out;
  for (const Vec3& part : {Vec3(X.translation()), angles})
    for (int k = 0; k < 3; ++k) out += (out.empty() ? "" : " ") + scene::exact_text(part[k]);
  return out;
}

Element& append(Document& document, Element& parent, const char* name, const Element& from,
                const std::string& text) {
  Element* element = document.create(name, from);
  if (!text.empty()) element->SetText(text.c_str());
  parent.InsertEndChild(element);
  return *element;
}

void anchor_joints(Document& document) {
  std::vector<Element*> models;
  for (Element* root : {document.root(), document.root()->FirstChildElement("world")})
    if (root != nullptr)
      for (Element* model : children_of(*root, {"model"})) models.push_back(model);
  for (Element* model : models) {
    std::vector<Element*> held;
    bool moves = false;
    for (Element* joint : children_of(*model, {"joint"})) {
      if (child_text(*joint, "parent") != "world") continue;
      held.push_back(joint);
      moves = moves || attribute(*joint, "type") != "fixed";
    }
    if (held.size() < 2 && !moves) continue;
    const std::string name = "world_anchor";
    Element& link = append(document, *model, "link", *held[0]);
    link.SetAttribute("name", name.c_str());
    Element& inertial = append(document, link, "inertial", *held[0]);
    append(document, inertial, "mass", *held[0], "1");
    Element& joint = append(document, *model, "joint", *held[0]);
    joint.SetAttribute("name", "world_anchor_joint");
    joint.SetAttribute("type", "fixed");
    append(document, joint, "parent", *held[0], "world");
    append(document, joint, "child", *held[0], name);
    for (Element* one : held) one->FirstChildElement("parent")->SetText(name.c_str());
  }
}

bool import_document(Document& document, Faults& faults) {
  Element& root = *document.root();
  const bool urdf = std::strcmp(root.Name(), "robot") == 0;
  const bool sdf = std::strcmp(root.Name(), "sdf") == 0;
  if (!urdf && !sdf) return true;
  const bool foreign = !holds_extension(root);
  IgnoredKinds ignored;
  if (urdf) {
    if (!check_expanded(root, faults) || !convert_urdf(document, ignored, faults)) return false;
  } else {
    // Before cleaning, which drops elements of other namespaces.
    if (foreign && !check_expanded(root, faults)) return false;
    upgrade_sdf(document);
  }
  if (foreign || urdf) {
    document.mark_foreign();
    if (sdf) clean_sdf(document, ignored);
    anchor_joints(document);
  }
  ignored.report(faults);
  // The limits hold for what was made of the file as well.
  return !(foreign || urdf) || check_tree(*document.root(), faults);
}

std::string scene_around(const std::string& file, double height) {
  std::string name = std::filesystem::path(file).stem().string();
  // model.sdf is named after its folder.
  if (name == "model" && std::filesystem::path(file).has_parent_path())
    name = std::filesystem::path(file).parent_path().filename().string();
  for (char& c : name)
    if (std::isalnum(static_cast<unsigned char>(c)) == 0 && c != '_' && c != '-') c = '_';
  if (name.empty()) name = "machine";
  std::string uri = std::filesystem::absolute(file).string();
  for (const auto& [plain, escaped] :
       {std::pair{"&", "&amp;"}, std::pair{"<", "&lt;"}, std::pair{">", "&gt;"}})
    for (std::size_t at = uri.find(plain); at != std::string::npos;
         at = uri.find(plain, at + std::strlen(escaped)))
      uri.replace(at, 1, escaped);
  return "<sdf version=\"1.9\"><world name=\"" + name + "\"><include><uri>" + uri +
         "</uri><pose>0 0 " + scene::exact_text(height) + " 0 0 0</pose></include></world></sdf>";
}

double height_to_stand(const scene::Machine& machine) {
  if (!machine.wheels.empty() || machine.fixed_base) return 0;
  double lowest = std::numeric_limits<double>::infinity();
  for (const scene::Link& link : machine.links)
    for (const scene::Collision& shape : link.collisions)
      lowest = std::min(lowest, lowest_of(shape.geometry, link.X_ML * shape.X_LC));
  return std::isfinite(lowest) ? -lowest : 0;
}

}  // namespace navvy::scene_io
