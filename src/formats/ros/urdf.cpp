// SPDX-License-Identifier: Apache-2.0
#include "formats/ros/urdf.h"

#include <cctype>
#include <charconv>
#include <cmath>
#include <cstdio>

namespace navvy::formats::ros {
namespace {

using scene::Geometry;

/// Thickness of the plate that stands for a plane [m].
constexpr double kPlate = 0.001;

/// Returns the shortest text that reads back as the same number.
std::string number(double value) {
  char text[32];
  const auto [end, error] = std::to_chars(text, text + sizeof text, value);
  return error == std::errc() ? std::string(text, end) : "0";
}

std::string numbers(const Vec3& v) {
  return number(v.x()) + " " + number(v.y()) + " " + number(v.z());
}

/// Returns ` name="text"` with the characters escaped that XML reserves.
std::string attribute(const std::string& name, const std::string& text) {
  std::string out = " " + name + "=\"";
  for (const char c : text)
    out += c == '&'   ? "&amp;"
           : c == '<' ? "&lt;"
           : c == '>' ? "&gt;"
           : c == '"' ? "&quot;"
                      : std::string(1, c);
  return out + "\"";
}

/// Returns the URI of a file: bytes other than unreserved characters and slashes become %XX.
std::string file_uri(const std::string& path) {
  std::string out = "file://";
  for (const char c : path) {
    const auto byte = static_cast<unsigned char>(c);
    if ((byte < 128 && std::isalnum(byte) != 0) ||
        std::string("/-._~").find(c) != std::string::npos) {
      out += c;
      continue;
    }
    char text[4];
    std::snprintf(text, sizeof text, "%%%02X", static_cast<unsigned>(byte));
    out += text;
  }
  return out;
}

/// Returns the angles roll, pitch and yaw of make_pose [rad]. Unlike fixed_angles it is exact to
/// rounding where the pitch is a right angle, at which machines have bodies that lie on their side.
Vec3 exact_angles(const Mat3& R) {
  const double cosine = std::hypot(R(0, 0), R(1, 0));
  const double pitch = std::atan2(-R(2, 0), cosine);
  // At a right angle only the sum or difference of roll and yaw has a meaning: yaw becomes zero.
  if (cosine < 1e-9) return {std::atan2(-R(1, 2), R(1, 1)), pitch, 0};
  return {std::atan2(R(2, 1), R(2, 2)), pitch, std::atan2(R(1, 0), R(0, 0))};
}

std::string origin(const Pose& X) {
  return "<origin" + attribute("xyz", numbers(X.translation())) +
         attribute("rpy", numbers(exact_angles(X.linear()))) + "/>";
}

std::string cylinder(double radius, double length) {
  return "<cylinder" + attribute("radius", number(radius)) + attribute("length", number(length)) +
         "/>";
}

/// A shape of URDF and its pose in the frame of Navvy's shape.
struct Part {
  std::string geometry;
  Pose X_VP = Pose::Identity();
};

/// Returns the shapes of URDF that make up a shape.
std::vector<Part> parts_of(const Geometry& geometry) {
  switch (geometry.kind) {
    case Geometry::Kind::kBox:
      return {{"<box" + attribute("size", numbers(geometry.size)) + "/>"}};
    case Geometry::Kind::kPlane:
      return {{"<box" + attribute("size", numbers({geometry.size.x(), geometry.size.y(), kPlate})) +
                   "/>",
               make_pose(0, 0, -kPlate / 2)}};
    case Geometry::Kind::kSphere:
      return {{"<sphere" + attribute("radius", number(geometry.radius)) + "/>"}};
    case Geometry::Kind::kMesh:
      if (geometry.made) {
        const geometry::Box box = geometry::bounds(*geometry.made);
        const Vec3 middle = 0.5 * (box.low + box.high), size = box.high - box.low;
        return {{"<box" + attribute("size", numbers(size)) + "/>",
                 make_pose(middle.x(), middle.y(), middle.z())}};
      }
      return {{"<mesh" + attribute("filename", file_uri(geometry.mesh_file)) +
               attribute("scale", numbers(geometry.scale)) + "/>"}};
    case Geometry::Kind::kCapsule: {
      const std::string ball = "<sphere" + attribute("radius", number(geometry.radius)) + "/>";
      return {{cylinder(geometry.radius, geometry.length)},
              {ball, make_pose(0, 0, geometry.length / 2)},
              {ball, make_pose(0, 0, -geometry.length / 2)}};
    }
    case Geometry::Kind::kCylinder:
    case Geometry::Kind::kCone:
      break;
  }
  return {{cylinder(geometry.radius, geometry.length)}};
}

/// Returns the elements of one visual or collision: several if URDF lacks its shape.
std::string shape(const std::string& kind, const std::string& name, const Geometry& geometry,
                  const Pose& X_LV, const std::string& material) {
  std::string out;
  int count = 0;
  for (const Part& part : parts_of(geometry)) {
    const std::string unique = count == 0 ? name : name + "_" + std::to_string(count);
    ++count;
    out += "    <" + kind + attribute("name", unique) + ">" + origin(X_LV * part.X_VP) +
           "<geometry>" + part.geometry + "</geometry>" + material + "</" + kind + ">\n";
  }
  return out;
}

/// Returns the material of a color; URDF wants equal materials to have equal names.
std::string material(const scene::Color& color) {
  const std::string rgba =
      number(color.r) + " " + number(color.g) + " " + number(color.b) + " " + number(color.a);
  return "<material" + attribute("name", "rgba " + rgba) + "><color" + attribute("rgba", rgba) +
         "/></material>";
}

std::string inertial(const scene::Link& link) {
  Pose X_LCom = Pose::Identity();
  X_LCom.translation() = link.p_LCom;
  const Mat3& I = link.inertia;
  return "    <inertial>" + origin(X_LCom) + "<mass" + attribute("value", number(link.mass)) +
         "/><inertia" + attribute("ixx", number(I(0, 0))) + attribute("ixy", number(I(0, 1))) +
         attribute("ixz", number(I(0, 2))) + attribute("iyy", number(I(1, 1))) +
         attribute("iyz", number(I(1, 2))) + attribute("izz", number(I(2, 2))) + "/></inertial>\n";
}

std::string link_element(const scene::Machine& machine, const MachineFrame& frame) {
  const scene::Link& link = machine.links.at(static_cast<std::size_t>(frame.link));
  // Frames beside that of a link have no body: readers warn of a root with inertia.
  if (frame.name != link.name) return "  <link" + attribute("name", frame.name) + "/>\n";
  std::string out = "  <link" + attribute("name", frame.name) + ">\n" + inertial(link);
  for (const scene::Visual& visual : link.visuals)
    out += shape("visual", visual.name, visual.geometry, visual.X_LV, material(visual.color));
  for (const scene::Collision& collision : link.collisions)
    out += shape("collision", collision.name, collision.geometry, collision.X_LC, "");
  return out + "  </link>\n";
}

const char* type_of(const scene::Joint& joint) {
  switch (joint.type) {
    case scene::Joint::Type::kRevolute:
      return joint.has_limits ? "revolute" : "continuous";
    case scene::Joint::Type::kPrismatic:
      return "prismatic";
    case scene::Joint::Type::kBall:
      return "floating";
    case scene::Joint::Type::kFixed:
      break;
  }
  return "fixed";
}

/// Returns axis, limits and dynamics of a joint that turns or slides.
std::string motion(const scene::Joint& joint) {
  const Vec3 axis_L = joint.X_LcJ.linear() * joint.axis;
  std::string out = "<axis" + attribute("xyz", numbers(axis_L)) + "/><limit";
  // URDF requires limits of a prismatic joint.
  const bool slides = joint.type == scene::Joint::Type::kPrismatic;
  if (joint.has_limits || slides)
    out += attribute("lower", number(joint.has_limits ? joint.lower : -1e9)) +
           attribute("upper", number(joint.has_limits ? joint.upper : 1e9));
  return out + attribute("effort", number(joint.effort)) +
         attribute("velocity", number(joint.velocity)) + "/><dynamics" +
         attribute("damping", number(joint.damping)) +
         attribute("friction", number(joint.friction)) + "/>";
}

std::string joint_element(const scene::Machine& machine, const std::vector<MachineFrame>& frames,
                          const MachineFrame& frame) {
  std::string name = frame.name + "_fixed", type = "fixed", about;
  if (frame.joint >= 0) {
    const scene::Joint& joint = machine.joints.at(static_cast<std::size_t>(frame.joint));
    name = joint.name;
    type = type_of(joint);
    if (type != "fixed" && type != "floating") about = motion(joint);
    for (const scene::JointGear& gear : machine.gears)
      if (gear.follower == frame.joint)
        about += "<mimic" +
                 attribute("joint", machine.joints.at(static_cast<std::size_t>(gear.leader)).name) +
                 attribute("multiplier", number(gear.ratio)) +
                 attribute("offset", number(gear.offset)) + "/>";
  } else {
    while (machine.joint_index(name) >= 0) name += "_";
  }
  const MachineFrame& parent = frames.at(static_cast<std::size_t>(frame.parent));
  return "  <joint" + attribute("name", name) + attribute("type", type) + "><parent" +
         attribute("link", parent.name) + "/><child" + attribute("link", frame.name) + "/>" +
         origin(pose_in_parent(machine, frames, frame)) + about + "</joint>\n";
}

}  // namespace

std::string urdf(const scene::Machine& machine, const std::vector<MachineFrame>& frames) {
  std::string out = "<?xml version=\"1.0\"?>\n<robot" + attribute("name", machine.name) + ">\n";
  for (const MachineFrame& frame : frames) out += link_element(machine, frame);
  for (const MachineFrame& frame : frames)
    if (frame.parent >= 0) out += joint_element(machine, frames, frame);
  return out + "</robot>\n";
}

}  // namespace navvy::formats::ros
