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
  bool in_tree = false;
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
  joint.stiffness = axis->SpringStiffness();
  joint.rest = axis->SpringReference();
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

/// Reads a joint of the type gearbox.
Gearbox read_gearbox(const sdf::Joint& from, const Element& xml, Faults& faults) {
  Gearbox out;
  out.name = unveiled(from.Name());
  report(xml, from.ResolveParentLink(out.parent), faults);
  report(xml, from.ResolveChildLink(out.child), faults);
  out.parent = unveiled(out.parent);
  out.child = unveiled(out.child);
  out.reference = child_text(xml, "gearbox_reference_body");
  // check_joints has made sure that it is a number.
  if (const Element* ratio = xml.FirstChildElement("gearbox_ratio"))
    to_number(text_of(*ratio), out.ratio);
  for (const unsigned i : {0u, 1u}) {
    const sdf::JointAxis* axis = from.Axis(i);
    // A missing second axis is parallel to the first.
    if (axis == nullptr) axis = from.Axis(0);
    ignition::math::Vector3d xyz(0, 0, 1);
    if (axis != nullptr) report(xml, axis->ResolveXyz(xyz, "__model__"), faults);
    (i == 0 ? out.parent_axis : out.child_axis) = to_vec3(xyz).normalized();
  }
  return out;
}

/// Arranges links and joints as a tree. Joints into links that are part of it close loops.
class Tree {
 public:
  Tree(const Element& model, const std::vector<scene::Link>& links, std::vector<NamedJoint>& joints,
       scene::Machine& machine, Faults& faults)
      : model_(model), links_(links), joints_(joints), machine_(machine), faults_(faults) {}

  void build() {
    const scene::Link* base = find_base();
    if (base == nullptr) return;
    machine_.links.push_back(*base);
    grow(true);
    // Where the first joint into a link starts from a link that is not reached, another one may.
    while (machine_.links.size() < links_.size() && grow(false)) grow(true);
    if (machine_.links.size() < links_.size()) {
      // A separate loop is never reached from the base.
      const auto outside = std::find_if(links_.begin(), links_.end(), [&](const scene::Link& link) {
        return machine_.link_index(link.name) < 0;
      });
      report_ring(outside->name, " beside the base",
                  "connect one of its links to the base '" + base->name + "' by a joint");
      return;
    }
    close_loops();
    fix_to_world();
  }

 private:
  const Element& element_of(const char* kind, const std::string& name) const {
    const Element* element = named_child(model_, kind, name);
    return element ? *element : model_;
  }
  bool is_moved(const std::string& link) const {
    return std::any_of(joints_.begin(), joints_.end(), [&](const NamedJoint& joint) {
      return joint.parent != "world" && joint.child == link;
    });
  }
  bool is_held(const std::string& link) const {
    return std::any_of(joints_.begin(), joints_.end(), [&](const NamedJoint& joint) {
      return joint.parent == "world" && joint.child == link;
    });
  }

  /// Returns the joints of the ring above a link, from one link down to itself; empty without one.
  std::vector<const NamedJoint*> ring_above(std::string link) const {
    std::vector<const NamedJoint*> way;
    while (true) {
      const auto into = std::find_if(joints_.begin(), joints_.end(), [&](const NamedJoint& joint) {
        return joint.parent != "world" && joint.child == link;
      });
      if (into == joints_.end()) return {};
      const auto seen = std::find(way.begin(), way.end(), &*into);
      if (seen != way.end()) {
        way.erase(way.begin(), seen);
        std::reverse(way.begin(), way.end());
        return way;
      }
      way.push_back(&*into);
      link = into->parent;
    }
  }

  /// Reports the ring above a link at the last of its joints in the file.
  void report_ring(const std::string& link, const std::string& rule,
                   const std::string& remedy) const {
    constexpr std::size_t kNamed = 6;
    const std::vector<const NamedJoint*> ring = ring_above(link);
    if (ring.empty()) return faults_.error(model_, "", "the joints form a loop" + rule, remedy);
    std::string names;
    for (std::size_t i = 0; i < ring.size() && i < kNamed; ++i)
      names += (names.empty() ? "'" : ", '") + ring[i]->joint.name + "'";
    if (ring.size() > kNamed) names += " and " + std::to_string(ring.size() - kNamed) + " more";
    // All of them are in one vector, in the order of the file.
    const NamedJoint& last = **std::max_element(ring.begin(), ring.end());
    faults_.error(element_of("joint", last.joint.name), last.joint.name,
                  "the joints " + names + " form a loop" + rule, remedy);
  }

  /// Returns the one link that no joint moves; in a ring, the one that is fixed to the world. Null
  /// after an error.
  const scene::Link* find_base() const {
    std::vector<const scene::Link*> bases;
    for (const scene::Link& link : links_)
      if (!is_moved(link.name)) bases.push_back(&link);
    if (bases.empty())
      for (const scene::Link& link : links_)
        if (is_held(link.name)) bases.push_back(&link);
    if (bases.empty()) {
      report_ring(links_[0].name, ": no link is the base",
                  "fix one of its links to the world by a fixed joint, exchange <parent> and "
                  "<child> of the joint into the link that is to be the base, or remove a joint");
      return nullptr;
    }
    for (std::size_t i = 1; i < bases.size(); ++i)
      faults_.error(element_of("link", bases[i]->name), bases[i]->name,
                    "no joint connects this link to the base '" + bases[0]->name + "'",
                    way_to(bases[i]->name));
    return bases.size() == 1 ? bases[0] : nullptr;
  }

  /// Returns how a link that is no child can become one.
  std::string way_to(const std::string& link) const {
    for (const NamedJoint& joint : joints_)
      if (joint.parent == link)
        return "exchange <parent> and <child> of joint '" + joint.joint.name +
               "', or add a joint to this link";
    return "add a joint (type fixed to weld it), or make it a model of its own";
  }

  /// Returns true if a joint comes before all others into its link.
  bool is_first(std::size_t joint) const {
    for (std::size_t j = 0; j < joint; ++j)
      if (joints_[j].child == joints_[joint].child && joints_[j].parent != "world") return false;
    return true;
  }

  /// Adds links, breadth first from those in the tree, below one parent in the order of the file:
  /// with `first`, all that the first joint into them reaches, otherwise one that another one does.
  /// Returns true if there was any.
  bool grow(bool first) {
    bool any = false;
    for (std::size_t i = 0; i < machine_.links.size(); ++i)
      for (std::size_t j = 0; j < joints_.size(); ++j) {
        NamedJoint& joint = joints_[j];
        // Taken anew for each joint, as the push_back below may move the links.
        if (joint.parent != machine_.links[i].name || machine_.link_index(joint.child) >= 0 ||
            (first && !is_first(j)))
          continue;
        const auto child = std::find_if(links_.begin(), links_.end(), [&](const scene::Link& link) {
          return link.name == joint.child;
        });
        if (child == links_.end()) continue;
        joint.joint.parent = static_cast<int>(i);
        joint.joint.child = static_cast<int>(machine_.links.size());
        joint.in_tree = true;
        machine_.joints.push_back(joint.joint);
        machine_.links.push_back(*child);
        any = true;
        if (!first) return true;
      }
    return any;
  }

  /// Makes the joints that the tree does not need the closing ones.
  void close_loops() {
    for (const NamedJoint& joint : joints_) {
      if (joint.in_tree || joint.parent == "world") continue;
      scene::LoopJoint loop;
      loop.name = joint.joint.name;
      // Both types have the same values.
      loop.type = static_cast<scene::LoopJoint::Type>(joint.joint.type);
      loop.parent = machine_.link_index(joint.parent);
      loop.child = machine_.link_index(joint.child);
      loop.axis = joint.joint.axis;
      loop.X_LcJ = joint.joint.X_LcJ;
      loop.X_LpJ = machine_.links[static_cast<std::size_t>(loop.parent)].X_ML.inverse() *
                   machine_.links[static_cast<std::size_t>(loop.child)].X_ML * loop.X_LcJ;
      check_closing(joint.joint);
      machine_.loops.push_back(loop);
    }
  }

  /// Reports what a joint that closes a loop cannot have.
  void check_closing(const scene::Joint& joint) const {
    const Element& element = element_of("joint", joint.name);
    const std::string remedy = "write it before the other joint into link '" +
                               child_text(element, "child") + "', which then closes the loop";
    if (joint.stiffness > 0)
      faults_.error(element, joint.name, "a joint that closes a loop has no spring", remedy);
    else if (joint.has_limits || joint.damping > 0 || joint.friction > 0)
      faults_.warning(element, joint.name,
                      "limits, damping and friction of a joint that closes a loop have no effect",
                      remedy);
  }

  void fix_to_world() {
    for (const NamedJoint& joint : joints_) {
      if (joint.parent != "world") continue;
      if (joint.joint.type == scene::Joint::Type::kFixed && joint.child == machine_.links[0].name) {
        machine_.fixed_base = true;
      } else {
        faults_.error(element_of("joint", joint.joint.name), joint.child,
                      "only the base link can be joined to the world, by a fixed joint",
                      "put a small link between, fix that to the world");
      }
    }
  }

  const Element& model_;
  const std::vector<scene::Link>& links_;
  std::vector<NamedJoint>& joints_;
  scene::Machine& machine_;
  Faults& faults_;
};

}  // namespace

bool read_sdf_model(const Element& model, scene::Machine& machine, std::vector<Gearbox>& gearboxes,
                    Faults& faults) {
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
      const Element* xml = named_child(model, "joint", unveiled(joint.Name()));
      if (xml == nullptr) continue;
      if (joint.Type() == sdf::JointType::GEARBOX)
        gearboxes.push_back(read_gearbox(joint, *xml, faults));
      else
        joints.push_back(read_joint(joint, *xml, faults));
    }
    // A faulty model has no tree.
    if (faults.error_count() == before) Tree(model, links, joints, machine, faults).build();
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
