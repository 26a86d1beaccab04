// SPDX-License-Identifier: Apache-2.0
#include "scene_io/arm_import.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "geometry/bucket_profile.h"
#include "scene/fields.h"
#include "scene/scaled_mesh.h"
#include "scene_io/element_reader.h"
#include "scene_io/foreign_private.h"
#include "scene_io/found_arm.h"

namespace navvy::scene_io {

namespace {

using scene::exact_text;
using scene::short_text;

std::string vector_text(const Vec3& v) {
  return short_text(v.x()) + " " + short_text(v.y()) + " " + short_text(v.z());
}

/// What one joint does in the arm.
struct Role {
  const char* element;  ///< in <navvy:arm>
  const char* word;     ///< in the report
  int joint;            ///< index of the joint; -1: none
};

class ArmMaker {
 public:
  ArmMaker(Document& document, Element& model, scene::Machine& machine, const FoundArm& arm)
      : document_(document), model_(model), machine_(machine), arm_(arm) {
    R_MS_.col(0) = arm_.forward;
    R_MS_.col(2) = Vec3::UnitZ();
    R_MS_.col(1) = R_MS_.col(2).cross(R_MS_.col(0));
    roles_ = {Role{"swing_joint", "swing", arm_.swing}, Role{"boom_joint", "boom", arm_.boom},
              Role{"stick_joint", "stick", arm_.stick},
              Role{"bucket_joint", "bucket", arm_.bucket}};
  }

  std::vector<std::string> make(bool weighed) {
    name_roles();
    for (const Role& role : roles_)
      if (role.joint >= 0) turn_axis(role);
    if (!keep_bucket()) add_bucket();
    if (!weighed) {
      say("left out: torques, speeds and cylinders of the arm follow from masses, and some are "
          "placeholders; import again with --masses or --mass-from-density");
      return std::move(report_);
    }
    for (const Role& role : roles_)
      if (role.joint >= 0) limit_motor(role);
    for (const Role& role : roles_)
      if (role.joint >= 0 && role.joint != arm_.swing) add_cylinder(role);
    return std::move(report_);
  }

 private:
  void say(const std::string& sentence) { report_.push_back(sentence); }
  scene::Joint& joint(int i) { return machine_.joints[static_cast<std::size_t>(i)]; }
  scene::Link& child_of(int i) { return machine_.links[static_cast<std::size_t>(joint(i).child)]; }
  scene::Link& parent_of(int i) {
    return machine_.links[static_cast<std::size_t>(joint(i).parent)];
  }
  Pose pose_of(int i) { return child_of(i).X_ML * joint(i).X_LcJ; }
  Vec3 pin(int i) { return pose_of(i).translation(); }
  /// Returns a point of the arm's plane, (x, z) from the pin of a joint, in the machine's frame.
  Vec3 in_machine(int at, const Vec2& p) { return pin(at) + R_MS_ * Vec3(p.x(), 0, p.y()); }

  Element* element_of(const char* kind, const std::string& name) {
    for (Element* e : children_of(model_, {kind}))
      if (attribute(*e, "name") == name) return e;
    return nullptr;
  }
  Element& child(Element& parent, const char* name) {
    Element* found = parent.FirstChildElement(name);
    return found != nullptr ? *found : append(document_, parent, name, parent);
  }
  void set(Element& parent, const char* name, const std::string& text) {
    child(parent, name).SetText(text.c_str());
  }

  void name_roles() {
    Element& out = append(document_, model_, "navvy:arm", model_);
    std::string names;
    for (const Role& role : roles_) {
      if (role.joint < 0) continue;
      append(document_, out, role.element, model_, joint(role.joint).name);
      names +=
          std::string(names.empty() ? "" : ", ") + role.word + " '" + joint(role.joint).name + "'";
    }
    machine_.arm = {arm_.swing >= 0 ? joint(arm_.swing).name : "", joint(arm_.boom).name,
                    joint(arm_.stick).name, joint(arm_.bucket).name};
    say("made: an arm: " + names);
    if (arm_.swing < 0)
      say("not recognised: no joint about the vertical carries the arm; digging needs a "
          "swing_joint");
  }

  /// Links whose pose hangs on the joint keep their place.
  void fix_poses(const std::string& name) {
    for (Element* e : children_of(model_, {"link"})) {
      Element* pose = e->FirstChildElement("pose");
      const int index = machine_.link_index(attribute(*e, "name"));
      if (pose == nullptr || index < 0 || attribute(*pose, "relative_to") != name) continue;
      pose->SetText(pose_text(machine_.links[static_cast<std::size_t>(index)].X_ML).c_str());
      pose->SetAttribute("relative_to", "__model__");
    }
  }

  /// Gives the joint a frame with x forward and z up, in which the swing turns about z and the
  /// other joints about -y, so that a positive angle lifts.
  void turn_axis(const Role& role) {
    scene::Joint& j = joint(role.joint);
    const Vec3 was = pose_of(role.joint).linear() * j.axis;
    const Vec3 wanted = role.joint == arm_.swing ? Vec3(Vec3::UnitZ()) : Vec3(-Vec3::UnitY());
    const bool turned = was.dot(R_MS_ * wanted) < 0;
    const Pose X_ML = child_of(role.joint).X_ML;
    j.X_LcJ.linear() = X_ML.linear().transpose() * R_MS_;
    j.axis = wanted;
    if (turned) {
      std::swap(j.lower, j.upper);
      j.lower = -j.lower;
      j.upper = -j.upper;
      j.initial = -j.initial;
    }
    Element* element = element_of("joint", j.name);
    if (element == nullptr) return;
    fix_poses(j.name);
    Element& pose = child(*element, "pose");
    while (const auto* at = pose.FirstAttribute()) pose.DeleteAttribute(at->Name());
    pose.SetText(pose_text(j.X_LcJ).c_str());
    pose.SetAttribute("relative_to", child_of(role.joint).name.c_str());
    Element& axis = child(*element, "axis");
    Element& xyz = child(axis, "xyz");
    xyz.DeleteAttribute("expressed_in");
    xyz.SetText(vector_text(wanted).c_str());
    if (!j.has_limits) return;
    Element& limit = child(axis, "limit");
    set(limit, "lower", exact_text(j.lower));
    set(limit, "upper", exact_text(j.upper));
    if (turned)
      say("repaired: the axis of joint '" + j.name +
          "' was turned with its limits: a positive angle " +
          (role.joint == arm_.swing ? "turns to the left" : "lifts"));
  }

  /// Returns the meshes of the bucket's link in a frame at its pin with the axes of the arm.
  geometry::TriangleMesh bucket_mesh() {
    geometry::TriangleMesh out;
    const scene::Link& link = child_of(arm_.bucket);
    const Vec3 at = pin(arm_.bucket);
    const auto add = [&](const scene::Geometry& shape, const Pose& X_LS) {
      if (shape.kind != scene::Geometry::Kind::kMesh) return;
      const geometry::TriangleMesh mesh = scene::scaled_mesh(shape);
      const int first = static_cast<int>(out.vertices.size());
      for (const Vec3& v : mesh.vertices)
        out.vertices.push_back(R_MS_.transpose() * (link.X_ML * (X_LS * v) - at));
      for (const auto& t : mesh.triangles)
        out.triangles.push_back({first + t[0], first + t[1], first + t[2]});
    };
    for (const scene::Visual& visual : link.visuals) add(visual.geometry, visual.X_LV);
    if (out.vertices.empty())
      for (const scene::Collision& one : link.collisions) add(one.geometry, one.X_LC);
    return out;
  }

  /// Returns true if the machine has a bucket on the arm's last link.
  bool keep_bucket() {
    const scene::Link& link = child_of(arm_.bucket);
    for (const scene::Bucket& bucket : machine_.buckets) {
      if (bucket.link != link.name) continue;
      capacity_ = bucket.capacity;
      tip_radius_ = (link.X_ML * bucket.p_tip - pin(arm_.bucket)).norm();
      say("kept: the bucket of link '" + link.name + "'");
      return true;
    }
    return false;
  }

  void add_bucket() {
    scene::Link& link = child_of(arm_.bucket);
    const auto profile = geometry::find_bucket_profile(bucket_mesh());
    if (!profile) {
      say("not recognised: no mesh of link '" + link.name +
          "' has the section of an open bucket; give it <navvy:bucket> with <width_m>, "
          "<capacity_m3> and <tip_m>, from which a shell follows");
      return;
    }
    // From the frame of the arm at the pin to that of the link.
    const auto to_link = [&](const Vec3& p) {
      return Vec3(link.X_ML.inverse() * Vec3(pin(arm_.bucket) + R_MS_ * p));
    };
    const auto direction = [&](const Vec2& d) {
      return Vec3(link.X_ML.linear().transpose() * (R_MS_ * Vec3(d.x(), 0, d.y())));
    };
    const geometry::TriangleMesh shell = geometry::shell_of(*profile);
    std::string vertices, triangles;
    for (const Vec3& v : shell.vertices)
      vertices += (vertices.empty() ? "" : "  ") + vector_text(to_link(v));
    for (const auto& t : shell.triangles)
      triangles += (triangles.empty() ? "" : "  ") + std::to_string(t[0]) + " " +
                   std::to_string(t[1]) + " " + std::to_string(t[2]);
    Element& out = append(document_, model_, "navvy:shell", model_);
    out.SetAttribute("name", link.name.c_str());
    append(document_, out, "link", model_, link.name);
    append(document_, out, "vertices_m", model_, vertices);
    append(document_, out, "triangles", model_, triangles);
    append(document_, out, "half_thickness_m", model_, "0.015");
    append(document_, out, "edge_share", model_, "1");
    write_bucket(*profile, to_link, direction);
    // The shell touches bodies and rock in their place.
    if (Element* element = element_of("link", link.name))
      for (Element* e : children_of(*element, {"collision"})) element->DeleteChild(e);
    link.collisions.clear();
  }

  template <class Place, class Turn>
  void write_bucket(const geometry::BucketProfile& profile, const Place& to_link,
                    const Turn& direction) {
    const scene::Link& link = child_of(arm_.bucket);
    const Vec2 edge = profile.points[0];
    const double width = profile.y_high - profile.y_low;
    capacity_ = geometry::heaped_capacity(profile);
    tip_radius_ = edge.norm();
    Element& out = append(document_, model_, "navvy:bucket", model_);
    append(document_, out, "link", model_, link.name);
    append(document_, out, "shell", model_, link.name);
    append(document_, out, "capacity_m3", model_, short_text(capacity_, 4));
    append(document_, out, "width_m", model_, short_text(width, 4));
    append(document_, out, "tip_m", model_,
           vector_text(to_link(Vec3(edge.x(), 0.5 * (profile.y_low + profile.y_high), edge.y()))));
    append(document_, out, "cut_direction", model_,
           vector_text(direction(geometry::cut_direction(profile))));
    append(document_, out, "opening", model_, vector_text(direction(geometry::opening(profile))));
    say("made: bucket '" + link.name + "' by the section of its mesh: " + short_text(capacity_, 3) +
        " m3 heaped, cuts " + short_text(width, 3) + " m, edge " + short_text(tip_radius_, 3) +
        " m from the pin");
    say("assumed: its plates are 30 mm thick, the edge is straight and blunt; its collisions are "
        "removed, the shell touches instead");
  }

  /// Returns the mass that a joint carries, and how far its centre can be from it [m].
  std::array<double, 2> load_of(int at) {
    double mass = 0, moment = 0;
    const std::array<int, 3> chain = {arm_.boom, arm_.stick, arm_.bucket};
    for (std::size_t l = 1; l < machine_.links.size(); ++l) {
      double reach = 0;
      // Stretched, a link is as far away as the pins between add up to.
      for (int j = static_cast<int>(l) - 1, last = -1; j >= 0; j = joint(j).parent - 1) {
        if (last < 0)
          reach = (machine_.links[l].X_ML * machine_.links[l].p_LCom - pin(j)).norm();
        else
          reach += (pin(last) - pin(j)).norm();
        last = j;
        if (j == at) {
          mass += machine_.links[l].mass;
          moment += machine_.links[l].mass * reach;
          break;
        }
      }
    }
    // The bucket is filled with soil of 1600 kg/m3.
    double reach = tip_radius_;
    for (std::size_t k = 0; k + 1 < chain.size(); ++k)
      if (chain[k] >= at) reach += (pin(chain[k + 1]) - pin(chain[k])).norm();
    mass += 1600 * capacity_;
    moment += 1600 * capacity_ * reach;
    return {mass, mass > 0 ? moment / mass : 0};
  }

  /// Gives a joint torque and speed where the file has none that can hold the arm (U): shares of
  /// the machine's weight as those of the shipped excavators.
  void limit_motor(const Role& role) {
    scene::Joint& j = joint(role.joint);
    const double weight = machine_.total_mass() * kGravity;
    const double stick = (pin(arm_.bucket) - pin(arm_.stick)).norm(),
                 boom = (pin(arm_.stick) - pin(arm_.boom)).norm(),
                 whole = boom + stick + tip_radius_;
    const auto [mass, reach] = load_of(role.joint);
    double torque = 2 * mass * kGravity * reach, least = 1.3 * mass * kGravity * reach, speed = 0.5;
    if (role.joint == arm_.boom) torque = std::max(torque, 0.27 * weight * whole);
    if (role.joint == arm_.stick)
      torque = std::max(torque, 0.5 * weight * (stick + tip_radius_)), speed = 0.7;
    if (role.joint == arm_.bucket)
      torque = std::max(torque, 0.65 * weight * tip_radius_), speed = 1;
    if (role.joint == arm_.swing)
      torque = 0.03 * weight * whole, least = 0.005 * weight * whole, speed = 0.9;
    Element* element = element_of("joint", j.name);
    if (element == nullptr || !(torque > 0)) return;
    Element& limit = child(child(*element, "axis"), "limit");
    if (!(j.effort < 1e8) || j.effort < least) {
      say("assumed: joint '" + j.name + "' has a torque of " + short_text(torque, 3) + " N m; " +
          (j.effort < 1e8 ? short_text(j.effort, 4) + " N m of the file cannot hold the arm"
                          : "the file gives none"));
      j.effort = torque;
      set(limit, "effort", short_text(torque, 4));
    }
    if (!(j.velocity < 20) || j.velocity < 0.02) {
      say("assumed: joint '" + j.name + "' turns at most " + short_text(speed) + " rad/s");
      j.velocity = speed;
      set(limit, "velocity", short_text(speed));
    }
  }

  /// Adds a cylinder whose angle between the lines from the joint to its pins grows from 20 deg
  /// over the range of the joint; beyond 145 deg its lever would vanish.
  void add_cylinder(const Role& role) {
    scene::Joint& j = joint(role.joint);
    const double start = radians(20), range = j.upper - j.lower;
    if (!j.has_limits || range > radians(125) || range < radians(5)) {
      const std::string angle = short_text(degrees(range), 3) + " deg";
      say("assumed: joint '" + j.name + "' keeps a motor: " +
          (!j.has_limits        ? "it has no limits"
           : range < radians(5) ? "it hardly turns, by " + angle
                                : "a cylinder without linkage does not turn it by " + angle));
      return;
    }
    const bool lifts = role.joint == arm_.boom;
    const Vec2 to_next = plane_from(role);
    const double length = to_next.norm();
    // At its start the angle is least: the boom lowered, stick and bucket stretched.
    const double first = lifts ? j.lower : j.upper;
    double base_angle = 0, rod_angle = 0;
    if (lifts) {
      rod_angle = std::atan2(to_next.y(), to_next.x());
      base_angle = rod_angle + first - start;
    } else {
      base_angle = std::atan2(to_next.y(), to_next.x());
      rod_angle = base_angle - start - first;
    }
    const double base = (lifts ? 0.2 : 0.4) * length, rod = (lifts ? 0.4 : 0.2) * length;
    const double middle = start + 0.5 * range;
    const double span = std::sqrt(base * base + rod * rod - 2 * base * rod * std::cos(middle));
    const double lever = base * rod * std::sin(middle) / span;
    write_cylinder(role, base * Vec2(std::cos(base_angle), std::sin(base_angle)),
                   rod * Vec2(std::cos(rod_angle), std::sin(rod_angle)), lever, lifts ? 2 : 1);
    say("made: cylinder of '" + j.name + "', whose pins fit its limits and whose bore gives " +
        short_text(j.effort, 3) + " N m in the middle of its range");
  }

  /// Returns the line in the arm's plane along which the longer pin lies: from the boom's pin to
  /// the stick's, otherwise back from the pin to the one before.
  Vec2 plane_from(const Role& role) {
    const int other = role.joint == arm_.stick ? arm_.boom : arm_.stick;
    const Vec3 d = R_MS_.transpose() * (pin(other) - pin(role.joint));
    return {d.x(), d.z()};
  }

  void write_cylinder(const Role& role, const Vec2& base, const Vec2& rod, double lever,
                      int count) {
    constexpr double kPressure = 35e6;
    const scene::Joint& j = joint(role.joint);
    const scene::Link &carrier = parent_of(role.joint), &moved = child_of(role.joint);
    const double area = j.effort / (lever * kPressure * count);
    const double bore = std::clamp(std::sqrt(4 * area / kPi), 0.006, 1.0);
    Element& out = append(document_, model_, "navvy:cylinder", model_);
    out.SetAttribute("name", (j.name + "_cylinder").c_str());
    append(document_, out, "joint", model_, j.name);
    append(document_, out, "base_link", model_, carrier.name);
    append(document_, out, "base_pin_m", model_,
           vector_text(carrier.X_ML.inverse() * in_machine(role.joint, base)));
    append(document_, out, "rod_link", model_, moved.name);
    append(document_, out, "rod_pin_m", model_,
           vector_text(moved.X_ML.inverse() * in_machine(role.joint, rod)));
    append(document_, out, "count", model_, std::to_string(count));
    append(document_, out, "bore_m", model_, short_text(bore, 4));
    append(document_, out, "rod_m", model_, short_text(0.7 * bore, 4));
    append(document_, out, "pressure_pa", model_, short_text(kPressure));
    const double flow = j.velocity * lever * count * kPi * bore * bore / 4;
    append(document_, out, "flow_m3_per_s", model_, short_text(std::clamp(flow, 1e-7, 1.0), 4));
  }

  Document& document_;
  Element& model_;
  scene::Machine& machine_;
  FoundArm arm_;
  Mat3 R_MS_ = Mat3::Identity();  ///< axes of the arm: forward, left, up
  std::array<Role, 4> roles_{};
  double capacity_ = 0, tip_radius_ = 0;  ///< of the bucket; 0: none was found
  std::vector<std::string> report_;
};

}  // namespace

std::vector<std::string> import_arm(Document& document, Element& model, scene::Machine& machine,
                                    bool weighed) {
  if (!machine.arm.boom.empty()) return {"kept: the arm of the file"};
  const std::optional<FoundArm> arm = find_arm(machine);
  if (!arm) return {"not recognised: no three joints in a row about level axes make an arm"};
  return ArmMaker(document, model, machine, *arm).make(weighed);
}

}  // namespace navvy::scene_io
