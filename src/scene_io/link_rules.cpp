// SPDX-License-Identifier: Apache-2.0
#include "scene_io/link_rules.h"

#include <Eigen/Eigenvalues>
#include <cmath>
#include <set>
#include <sstream>

#include "core/math.h"
#include "scene_io/bucket_reader.h"

namespace navvy::scene_io {

namespace {

// Checks the principal moments: positive, and none larger than the sum of the other two.
void check_inertia(const Element& inertial, Faults& faults) {
  const Element* inertia = inertial.FirstChildElement("inertia");
  if (!inertia) return;
  auto value = [&](const char* name, double otherwise) {
    double number = otherwise;
    to_number(child_text(*inertia, name), number);
    return number;
  };
  // These are SDF's defaults: a unit tensor.
  const double xx = value("ixx", 1), yy = value("iyy", 1), zz = value("izz", 1);
  const double xy = value("ixy", 0), xz = value("ixz", 0), yz = value("iyz", 0);
  Mat3 tensor;
  tensor << xx, xy, xz, xy, yy, yz, xz, yz, zz;
  // check_sdf has reported numbers that are not finite; such a tensor has no eigenvalues.
  if (!tensor.allFinite()) return;
  const Vec3 moments =
      Eigen::SelfAdjointEigenSolver<Mat3>(tensor, Eigen::EigenvaluesOnly).eigenvalues();
  // Eigenvalues come in ascending order. The second condition holds for every distribution of mass:
  // the moment about one axis is the sum of integrals that the other two contain.
  if (moments[0] > 0 && moments[2] <= moments[0] + moments[1]) return;
  auto text = [](double number) {
    std::ostringstream stream;
    stream << number;
    return stream.str();
  };
  faults.error(*inertia, text(moments[0]) + " " + text(moments[1]) + " " + text(moments[2]),
               "the principal moments of inertia must be positive, none larger than the sum of the "
               "other two",
               "a disc has iyy = ixx + izz at most; mind the rounding");
}

/// Returns true for a density of the link or of one of its shapes.
bool has_density(const Element& link) {
  // derived_parts.cpp takes the value of the same element once the shapes are known.
  constexpr const char* kName = "navvy:density_kg_per_m3";
  if (link.FirstChildElement(kName)) return true;
  for (const char* kind : {"visual", "collision"})
    for (const Element* e = link.FirstChildElement(kind); e; e = e->NextSiblingElement(kind))
      if (e->FirstChildElement(kName)) return true;
  return false;
}

/// Reports an end of a joint that is missing, or that no link or frame is.
void check_ends(const Element& joint, const std::vector<std::string>& ends, Faults& faults) {
  for (const char* end : {"parent", "child"}) {
    const Element* at = joint.FirstChildElement(end);
    if (!at) {
      faults.error(joint, "", std::string("needs an element <") + end + ">");
      continue;
    }
    // The world may only be a parent, as nothing moves it.
    const bool world = std::string(end) == "parent" && text_of(*at) == "world";
    if (!world && !text_of(*at).empty())
      require_name(*at, text_of(*at), "link or frame of this name in the model", ends, faults);
  }
  const std::string parent = child_text(joint, "parent");
  if (!parent.empty() && parent == child_text(joint, "child"))
    faults.error(joint, parent, "parent and child must be different links",
                 "name the link that moves in <child>");
}

/// Reports an axis without direction, limits in the wrong order, and a spring that pushes away.
void check_axis(const Element& axis, Faults& faults) {
  // check_sdf has reported what is no number; ones keep the length above zero in that case.
  std::vector<double> xyz(3, 1.0);
  if (const Element* e = axis.FirstChildElement("xyz")) {
    const auto words = words_of(text_of(*e));
    for (std::size_t i = 0; i < 3 && i < words.size(); ++i) to_number(words[i], xyz[i]);
    if (std::hypot(xyz[0], xyz[1], xyz[2]) < 1e-9)
      faults.error(*e, text_of(*e), "an axis must not be zero", "e.g. 0 0 1");
  }
  if (const Element* dynamics = axis.FirstChildElement("dynamics")) {
    double stiffness = 0;
    const Element* e = dynamics->FirstChildElement("spring_stiffness");
    if (e != nullptr && to_number(text_of(*e), stiffness) && stiffness < 0)
      faults.error(*e, text_of(*e), "the stiffness of a spring must not be negative",
                   "give its magnitude: the spring draws the joint towards <spring_reference>");
  }
  double lower = -1e16, upper = 1e16;
  if (const Element* limit = axis.FirstChildElement("limit")) {
    to_number(child_text(*limit, "lower"), lower);
    to_number(child_text(*limit, "upper"), upper);
    if (lower > upper)
      faults.error(*limit, child_text(*limit, "lower"), "lower must not exceed upper",
                   "exchange them");
  }
}

/// Reports parts of a gearbox that are missing, or that another joint has.
void check_gearbox(const Element& joint, const std::string& type, const Names& names,
                   Faults& faults) {
  if (type != "gearbox") {
    if (const Element* axis2 = joint.FirstChildElement("axis2"))
      faults.error(*axis2, "", "is not supported: joints have one axis",
                   "use two joints and a small link");
    for (const char* name : {"gearbox_ratio", "gearbox_reference_body"})
      if (const Element* e = joint.FirstChildElement(name))
        faults.error(*e, text_of(*e), "only a joint of type gearbox has it", "remove it");
    return;
  }
  const Element* body = joint.FirstChildElement("gearbox_reference_body");
  if (body == nullptr)
    faults.error(joint, "", "a gearbox needs <gearbox_reference_body>",
                 "the link on which both of its shafts turn");
  else if (!text_of(*body).empty())
    require_name(*body, text_of(*body), "link of this name in the model", names.links, faults);
  double ratio = 1;
  const Element* e = joint.FirstChildElement("gearbox_ratio");
  if (e != nullptr && to_number(text_of(*e), ratio) && ratio == 0)
    faults.error(*e, text_of(*e), "the ratio of a gearbox must not be 0",
                 "give the angle of the child per angle of the parent, with the sign reversed");
}

}  // namespace

void check_joints(const Element& model, const Names& names, Faults& faults) {
  static const std::set<std::string> types = {"fixed",     "revolute", "continuous",
                                              "prismatic", "ball",     "gearbox"};
  // A joint may be attached to a frame, which libsdformat resolves to its link.
  std::vector<std::string> ends = names.links;
  ends.insert(ends.end(), names.frames.begin(), names.frames.end());
  for (const Element* joint = model.FirstChildElement("joint"); joint;
       joint = joint->NextSiblingElement("joint")) {
    const std::string type = attribute(*joint, "type");
    if (types.count(type) == 0)
      faults.error(
          *joint, type,
          "the type of a joint must be fixed, revolute, continuous, prismatic, ball or gearbox");
    check_ends(*joint, ends, faults);
    check_gearbox(*joint, type, names, faults);
    const Element* axis = joint->FirstChildElement("axis");
    if (axis) check_axis(*axis, faults);
    if (const Element* axis2 = joint->FirstChildElement("axis2")) check_axis(*axis2, faults);
    if (!axis && type != "fixed" && type != "ball" && types.count(type) > 0)
      faults.error(*joint, "", "needs an element <axis> with <xyz>");
  }
}

void check_links(const Element& model, bool needs_mass, Faults& faults) {
  if (!model.FirstChildElement("link"))
    faults.error(model, "", "a machine needs at least one <link>",
                 "add a <link> with its <inertial>");
  for (const Element* link = model.FirstChildElement("link"); link;
       link = link->NextSiblingElement("link")) {
    const Element* inertial = link->FirstChildElement("inertial");
    // Masses of kinematic and static links are never used, so files may leave them out.
    if (needs_mass && !has_density(*link) && !bucket_weighs(model, attribute(*link, "name")) &&
        (!inertial || !inertial->FirstChildElement("mass")))
      faults.error(*link, "", "a moving link needs <inertial> with <mass> and <inertia>",
                   "or <navvy:density_kg_per_m3>, by which they follow from its shapes");
    if (inertial) check_inertia(*inertial, faults);
    for (const char* kind : {"visual", "collision"})
      for (const Element* e = link->FirstChildElement(kind); e; e = e->NextSiblingElement(kind))
        if (!e->FirstChildElement("geometry") ||
            !e->FirstChildElement("geometry")->FirstChildElement())
          faults.error(*e, "", "needs <geometry> with a shape",
                       "add <geometry><box><size>X Y Z</size></box></geometry>, or another shape");
  }
}

}  // namespace navvy::scene_io
