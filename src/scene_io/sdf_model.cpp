// SPDX-License-Identifier: Apache-2.0
#include "scene_io/sdf_model.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <ignition/math/Inertial.hh>
#include <ignition/math/Pose3.hh>
#include <sdf/sdf.hh>

#include "scene_io/mesh_path.h"
#include "scene_io/sdf_rules.h"
#include "scene_io/sdf_schema_private.h"

namespace navvy::scene_io {

namespace {

Pose to_pose(const ignition::math::Pose3d& p) {
  Pose X = Pose::Identity();
  // The digits of a file give no exact unit quaternion.
  X.linear() = Eigen::Quaterniond(p.Rot().W(), p.Rot().X(), p.Rot().Y(), p.Rot().Z())
                   .normalized()
                   .toRotationMatrix();
  X.translation() = Vec3(p.Pos().X(), p.Pos().Y(), p.Pos().Z());
  return X;
}

// libsdformat reserves :: for nested models, which are parts of one model here. Two characters that
// no file uses stand for it.
// The two are U+E000 and U+E001 of Unicode's private use area.
constexpr const char kScope[] = "::", kVeiled[] = "\xEE\x80\x80\xEE\x80\x81";

std::string replaced(std::string text, const std::string& from, const std::string& to) {
  for (std::size_t at = text.find(from); at != std::string::npos;
       at = text.find(from, at + to.size()))
    text.replace(at, from.size(), to);
  return text;
}

std::string veiled(const std::string& text) { return replaced(text, kScope, kVeiled); }
std::string unveiled(const std::string& text) { return replaced(text, kVeiled, kScope); }

Vec3 to_vec3(const ignition::math::Vector3d& v) { return Vec3(v.X(), v.Y(), v.Z()); }

// Copies the elements that libsdformat reads: no extensions, and none that are ignored.
void copy_used(const Element& from, Element& to) {
  for (const auto* at = from.FirstAttribute(); at; at = at->Next())
    to.SetAttribute(at->Name(), veiled(at->Value()).c_str());
  bool has_elements = false;
  for (const Element* child = from.FirstChildElement(); child;
       child = child->NextSiblingElement()) {
    has_elements = true;
    // libsdformat 12 has no cone; a cylinder has the same values.
    const char* name = std::strcmp(child->Name(), "cone") == 0 ? "cylinder" : child->Name();
    if (is_used_sdf(*child)) copy_used(*child, *to.InsertNewChildElement(name));
  }
  // Only elements without children have values.
  if (!has_elements) to.SetText(veiled(text_of(from)).c_str());
}

/// Returns the model as the text of a file of its own, which is all that libsdformat is given.
std::string as_sdf_text(const Element& model) {
  tinyxml2::XMLDocument copy;
  Element* root = copy.NewElement("sdf");
  // libsdformat reads a model by the version of its file.
  root->SetAttribute("version", attribute(*model.GetDocument()->RootElement(), "version").c_str());
  copy.InsertEndChild(root);
  copy_used(model, *root->InsertNewChildElement("model"));
  tinyxml2::XMLPrinter printer;
  copy.Print(&printer);
  return printer.CStr();
}

// Returns the element that a message of libsdformat, which has no lines, names in brackets or
// quotes.
const Element& named_in(const Element& model, const std::string& message) {
  for (const Element* child = model.FirstChildElement(); child;
       child = child->NextSiblingElement()) {
    const std::string name = attribute(*child, "name");
    if (name.empty()) continue;
    // A bare name could be a part of another word.
    for (const std::string& mark :
         {"[" + name + "]", "'" + name + "'", "\"" + name + "\"", "named " + name + " "})
      if (message.find(mark) != std::string::npos) return *child;
  }
  return model;
}

void report(const Element& model, const sdf::Errors& errors, Faults& faults) {
  for (const sdf::Error& error : errors) {
    const std::string message = unveiled(error.Message());
    faults.error(named_in(model, message), "", "libsdformat: " + message);
  }
}

/// Reads one shape. `xml` is its <geometry>; `solid` states that a mesh must be fit for a hull.
bool read_geometry(const sdf::Geometry& from, const Element& xml, bool solid, scene::Geometry& to,
                   Faults& faults) {
  using Kind = scene::Geometry::Kind;
  if (const auto* box = from.BoxShape()) {
    to.kind = Kind::kBox;
    to.size = to_vec3(box->Size());
  } else if (const auto* cylinder = from.CylinderShape()) {
    to.kind = xml.FirstChildElement("cone") ? Kind::kCone : Kind::kCylinder;
    to.radius = cylinder->Radius();
    to.length = cylinder->Length();
  } else if (const auto* capsule = from.CapsuleShape()) {
    to.kind = Kind::kCapsule;
    to.radius = capsule->Radius();
    to.length = capsule->Length();
  } else if (const auto* sphere = from.SphereShape()) {
    to.kind = Kind::kSphere;
    to.radius = sphere->Radius();
  } else if (const auto* plane = from.PlaneShape()) {
    to.kind = Kind::kPlane;
    // The size is that of the drawn rectangle; as a collision shape, a plane becomes the rock under
    // the whole site.
    to.size = Vec3(plane->Size().X(), plane->Size().Y(), 0);
    // A pose turns a plane for physics and pictures alike.
    if (to_vec3(plane->Normal()).cross(Vec3::UnitZ()).norm() > 1e-9 || plane->Normal().Z() < 0)
      faults.error(xml, "", "the normal of a plane must be 0 0 1", "turn it with <pose>");
  } else if (const auto* mesh = from.MeshShape()) {
    to.kind = Kind::kMesh;
    to.scale = to_vec3(mesh->Scale());
    // libsdformat has found the mesh in the same element, so <mesh> exists.
    const Element* uri = xml.FirstChildElement("mesh")->FirstChildElement("uri");
    return uri && resolve_mesh(*uri, to.mesh_file, faults) &&
           check_mesh(*uri, to.mesh_file, solid, faults);
  } else {
    faults.error(xml, "", "needs one of box, cylinder, cone, capsule, sphere, plane, mesh",
                 "add one of them");
    return false;
  }
  return true;
}

void read_shapes(const sdf::Link& from, const Element& xml, bool moves, scene::Link& to,
                 Faults& faults) {
  for (std::uint64_t i = 0; i < from.VisualCount(); ++i) {
    const sdf::Visual& visual = *from.VisualByIndex(i);
    // The element holds line numbers and values that libsdformat does not return.
    const Element* element = named_child(xml, "visual", unveiled(visual.Name()));
    if (!element || !element->FirstChildElement("geometry")) continue;
    scene::Visual out;
    out.name = unveiled(visual.Name());
    ignition::math::Pose3d pose;
    // Resolve returns the pose in the frame of the link, whatever `relative_to` names.
    report(*element, visual.SemanticPose().Resolve(pose), faults);
    out.X_LV = to_pose(pose);
    if (const sdf::Material* material = visual.Material()) {
      const auto c = material->Diffuse();
      out.color = {c.R(), c.G(), c.B(), c.A()};
    }
    if (read_geometry(*visual.Geom(), *element->FirstChildElement("geometry"), false, out.geometry,
                      faults))
      to.visuals.push_back(out);
  }
  for (std::uint64_t i = 0; i < from.CollisionCount(); ++i) {
    const sdf::Collision& collision = *from.CollisionByIndex(i);
    const Element* element = named_child(xml, "collision", unveiled(collision.Name()));
    if (!element || !element->FirstChildElement("geometry")) continue;
    scene::Collision out;
    out.name = unveiled(collision.Name());
    ignition::math::Pose3d pose;
    report(*element, collision.SemanticPose().Resolve(pose), faults);
    out.X_LC = to_pose(pose);
    // libsdformat 12 has no accessor for friction.
    const Element* step = element;
    // Gazebo uses this coefficient for ODE. check_sdf has reported a bad number.
    for (const char* name : {"surface", "friction", "ode", "mu"})
      step = step ? step->FirstChildElement(name) : nullptr;
    if (step) to_number(text_of(*step), out.friction);
    // A moving mesh collides by its hull, a fixed one by its triangles.
    if (read_geometry(*collision.Geom(), *element->FirstChildElement("geometry"), moves,
                      out.geometry, faults))
      to.collisions.push_back(out);
  }
}

/// Reads a link. Its elements serve for messages and for values without accessors.
scene::Link read_link(const sdf::Link& from, const Element& xml, bool moves, Faults& faults) {
  scene::Link link;
  link.name = unveiled(from.Name());
  ignition::math::Pose3d pose;
  // In the frame of the model.
  report(xml, from.SemanticPose().Resolve(pose, "__model__"), faults);
  link.X_ML = to_pose(pose);
  const auto& inertial = from.Inertial();
  link.mass = inertial.MassMatrix().Mass();
  link.p_LCom = to_vec3(inertial.Pose().Pos());
  // In the axes of the link, about the centre of mass.
  const auto moi = inertial.Moi();
  for (int r = 0; r < 3; ++r)
    for (int c = 0; c < 3; ++c) link.inertia(r, c) = moi(r, c);
  read_shapes(from, xml, moves, link, faults);
  return link;
}

struct NamedJoint {
  scene::Joint joint;
  std::string parent, child;
};

void read_axis(const sdf::Joint& from, const Element& xml, scene::Joint& joint, Faults& faults) {
  const sdf::JointAxis* axis = from.Axis();
  if (!axis) return;
  ignition::math::Vector3d xyz;
  report(xml, axis->ResolveXyz(xyz, from.Name()), faults);
  // In the frame of the joint; SDF allows any length.
  joint.axis = to_vec3(xyz).normalized();
  const double lower = axis->Lower(), upper = axis->Upper();
  // In SDF 1e16 means no limit.
  joint.has_limits = from.Type() != sdf::JointType::CONTINUOUS && lower > -1e15 && upper < 1e15;
  if (joint.has_limits) {
    joint.lower = lower;
    joint.upper = upper;
  }
  // A negative or missing limit of SDF means none.
  if (std::isfinite(axis->Effort()) && axis->Effort() >= 0) joint.effort = axis->Effort();
  if (std::isfinite(axis->MaxVelocity()) && axis->MaxVelocity() >= 0)
    joint.velocity = axis->MaxVelocity();
  joint.damping = axis->Damping();
  joint.friction = axis->Friction();
}

NamedJoint read_joint(const sdf::Joint& from, const Element& xml, Faults& faults) {
  using Type = scene::Joint::Type;
  NamedJoint out;
  out.joint.name = unveiled(from.Name());
  switch (from.Type()) {
    case sdf::JointType::REVOLUTE:
    case sdf::JointType::CONTINUOUS:
      out.joint.type = Type::kRevolute;
      break;
    case sdf::JointType::PRISMATIC:
      out.joint.type = Type::kPrismatic;
      break;
    case sdf::JointType::BALL:
      out.joint.type = Type::kBall;
      break;
    // check_joints has refused all types but these and fixed.
    default:
      out.joint.type = Type::kFixed;
  }
  // Names of frames are resolved to their links.
  report(xml, from.ResolveParentLink(out.parent), faults);
  report(xml, from.ResolveChildLink(out.child), faults);
  ignition::math::Pose3d pose;
  report(xml, from.SemanticPose().Resolve(pose, out.child), faults);
  out.parent = unveiled(out.parent);
  out.child = unveiled(out.child);
  out.joint.X_LcJ = to_pose(pose);
  if (out.joint.type == Type::kRevolute || out.joint.type == Type::kPrismatic)
    read_axis(from, xml, out.joint, faults);
  return out;
}

// Orders links from the base outward; every other link must be the child of one joint.
void order_tree(const Element& model, std::vector<scene::Link> links,
                std::vector<NamedJoint> joints, scene::Machine& machine, Faults& faults) {
  auto element_of = [&](const char* kind, const std::string& name) -> const Element& {
    const Element* element = named_child(model, kind, name);
    return element ? *element : model;
  };
  const std::size_t before = faults.error_count();
  // All faults of the tree are reported before reading ends.
  std::vector<std::string> moved;
  for (const NamedJoint& joint : joints) {
    // A joint to the world moves no link in the tree; it only fixes the base.
    if (joint.parent == "world") continue;
    if (std::find(moved.begin(), moved.end(), joint.child) != moved.end())
      faults.error(element_of("joint", joint.joint.name), joint.child,
                   "a link can be the child of one joint only",
                   "closed loops such as cylinders are described by navvy:cylinder");
    moved.push_back(joint.child);
  }
  std::vector<std::size_t> bases;
  for (std::size_t i = 0; i < links.size(); ++i)
    if (std::find(moved.begin(), moved.end(), links[i].name) == moved.end()) bases.push_back(i);
  if (bases.empty())
    faults.error(model, "", "the joints form a loop: no link is the base",
                 "remove the joint that closes it: links form a tree");
  for (std::size_t i = 1; i < bases.size(); ++i)
    faults.error(element_of("link", links[bases[i]].name), links[bases[i]].name,
                 "no joint connects this link to the base '" + links[bases[0]].name + "'",
                 "add a joint (type fixed to weld it), or make it a model of its own");
  if (faults.error_count() > before) return;

  // Breadth first from the base; below one parent in the order of the file.
  machine.links.push_back(links[bases[0]]);
  for (std::size_t i = 0; i < machine.links.size(); ++i) {
    for (NamedJoint& joint : joints) {
      // Taken anew for each joint, as the push_back below may move the links.
      const scene::Link& parent = machine.links[i];
      if (joint.parent != parent.name) continue;
      const auto child = std::find_if(links.begin(), links.end(), [&](const scene::Link& link) {
        return link.name == joint.child;
      });
      joint.joint.parent = static_cast<int>(i);
      joint.joint.child = static_cast<int>(machine.links.size());
      machine.joints.push_back(joint.joint);
      machine.links.push_back(*child);
    }
  }
  // A separate loop is never reached from the base.
  if (machine.links.size() != links.size())
    faults.error(model, "", "the joints form a loop beside the base",
                 "remove the joint that closes it: links form a tree");

  for (const NamedJoint& joint : joints) {
    if (joint.parent != "world") continue;
    if (joint.joint.type == scene::Joint::Type::kFixed && joint.child == machine.links[0].name) {
      machine.fixed_base = true;
    } else {
      faults.error(element_of("joint", joint.joint.name), joint.child,
                   "only the base link can be joined to the world, by a fixed joint",
                   "put a small link between, fix that to the world");
    }
  }
}

}  // namespace

bool read_sdf_model(const Element& model, scene::Machine& machine, Faults& faults) {
  const std::size_t before = faults.error_count();
  // Its console would print beside our messages.
  sdf::Console::Instance()->SetQuiet(true);
  ++faults.work.models;
  sdf::Root root;
  try {
    report(model, parse_model(as_sdf_text(model), root), faults);
    if (faults.error_count() > before || !root.Model()) return false;
    const sdf::Model& from = *root.Model();
    machine.name = unveiled(from.Name());
    if (from.Static()) machine.fixed_base = true;
    std::vector<scene::Link> links;
    for (std::uint64_t i = 0; i < from.LinkCount(); ++i) {
      const sdf::Link& link = *from.LinkByIndex(i);
      if (const Element* xml = named_child(model, "link", unveiled(link.Name())))
        links.push_back(read_link(link, *xml, !from.Static(), faults));
    }
    std::vector<NamedJoint> joints;
    for (std::uint64_t i = 0; i < from.JointCount(); ++i) {
      const sdf::Joint& joint = *from.JointByIndex(i);
      if (const Element* xml = named_child(model, "joint", unveiled(joint.Name())))
        joints.push_back(read_joint(joint, *xml, faults));
    }
    // A faulty model has no tree.
    if (faults.error_count() == before)
      order_tree(model, std::move(links), std::move(joints), machine, faults);
  } catch (const std::exception& failure) {
    faults.error(model, "", std::string("libsdformat failed: ") + failure.what());
    // sdf::Exception is not a std::exception.
  } catch (const sdf::Exception& failure) {
    faults.error(model, "", std::string("libsdformat failed: ") + failure.GetErrorStr());
  }
  // Warnings do not count; a model with an error is not used.
  return faults.error_count() == before;
}

}  // namespace navvy::scene_io
