// SPDX-License-Identifier: Apache-2.0
#include "scene_io/derived_parts.h"

#include <algorithm>
#include <cstdio>

#include "geometry/primitive_solids.h"
#include "scene/scaled_mesh.h"
#include "scene_io/mesh_path.h"

namespace navvy::scene_io {

namespace {

using Kind = scene::Geometry::Kind;

// link_rules.cpp asks for the same element before the model is read.
constexpr const char* kDensity = "navvy:density_kg_per_m3";

/// Returns a word for messages. There is no default label, so that the compiler names a kind that
/// is missing here.
const char* word_for(Kind kind) {
  switch (kind) {
    case Kind::kBox:
      return "box";
    case Kind::kCylinder:
      return "cylinder";
    case Kind::kSphere:
      return "sphere";
    case Kind::kMesh:
      return "mesh";
    case Kind::kPlane:
      return "plane";
    case Kind::kCone:
      return "cone";
    case Kind::kCapsule:
      return "capsule";
  }
  return "shape";
}

/// Returns true for links with a shell or tyre.
/// These touch by a law of their own; with a shape as well they would meet bodies twice.
bool touches_otherwise(const scene::Machine& machine, std::size_t link) {
  const std::string& name = machine.links[link].name;
  const auto spins_it = [&](const scene::Wheel& wheel) {
    const int joint = machine.joint_index(wheel.joint);
    return joint >= 0 &&
           machine.joints[static_cast<std::size_t>(joint)].child == static_cast<int>(link);
  };
  return std::any_of(machine.wheels.begin(), machine.wheels.end(), spins_it) ||
         std::any_of(machine.shells.begin(), machine.shells.end(),
                     [&](const scene::Shell& shell) { return shell.link == name; });
}

/// Checks that a visual can collide: no plane, and a mesh within the limits of hulls.
bool may_collide(const Element& visual, const scene::Geometry& shape, bool moves, Faults& faults) {
  if (shape.kind == Kind::kPlane) return false;
  if (shape.kind != Kind::kMesh) return true;
  // read_shapes leaves out visuals without <geometry>, so it is there.
  const Element* mesh = visual.FirstChildElement("geometry")->FirstChildElement("mesh");
  const Element* uri = mesh != nullptr ? mesh->FirstChildElement("uri") : nullptr;
  return uri != nullptr && check_mesh(*uri, shape.mesh_file, moves, faults);
}

void derive_collisions(const Element& model, scene::Machine& machine, Faults& faults) {
  for (std::size_t l = 0; l < machine.links.size(); ++l) {
    scene::Link& link = machine.links[l];
    const Element* element = named_child(model, "link", link.name);
    if (element == nullptr || touches_otherwise(machine, l)) continue;
    // Only moving meshes collide by their hulls, to which the limits of hulls apply.
    const bool moves = l > 0 || !machine.fixed_base;
    std::string shapes;
    for (const scene::Visual& visual : link.visuals) {
      const Element* from = named_child(*element, "visual", visual.name);
      if (from == nullptr || !may_collide(*from, visual.geometry, moves, faults)) continue;
      scene::Collision shape;
      shape.name = visual.name;
      shape.geometry = visual.geometry;
      shape.X_LC = visual.X_LV;
      // `weigh` reports faults of this shape at its <visual>, which it finds by this flag.
      shape.derived = true;
      shape.density = visual.density;
      link.collisions.push_back(shape);
      const bool hull = moves && visual.geometry.kind == Kind::kMesh;
      shapes += (shapes.empty() ? "" : ", ") +
                std::string(hull ? "hull of the mesh" : word_for(visual.geometry.kind)) + " '" +
                visual.name + "'";
    }
    if (!shapes.empty())
      machine.derived.push_back("link '" + link.name + "' collides as its visuals: " + shapes);
  }
}

/// Computes the solid of one shape in its link's frame, at 1 kg/m3. Returns false after a fault.
bool solid_of(const Element& at, const scene::Geometry& shape, const Pose& X_LS,
              geometry::SolidProperties& out, Faults& faults) {
  switch (shape.kind) {
    case Kind::kBox:
      out = geometry::solid_box(shape.size);
      break;
    case Kind::kCylinder:
      out = geometry::solid_cylinder(shape.radius, shape.length);
      break;
    case Kind::kSphere:
      out = geometry::solid_sphere(shape.radius);
      break;
    case Kind::kCone:
      out = geometry::solid_cone(shape.radius, shape.length);
      break;
    case Kind::kCapsule:
      out = geometry::solid_capsule(shape.radius, shape.length);
      break;
    case Kind::kPlane:
      faults.error(at, "plane", "a plane has no volume",
                   "give the link <inertial>, or another shape");
      return false;
    case Kind::kMesh:
      try {
        out = geometry::solid_properties(scene::scaled_mesh(shape), shape.mesh_file);
      } catch (const Error& error) {
        faults.error(at, shape.mesh_file, error.what(),
                     "only a closed mesh has a mass: close it, or give <inertial>");
        return false;
      }
  }
  out = geometry::placed(out, X_LS);
  return true;
}

/// Sets mass, centre of mass and inertia of a link from its shapes, if it or one of them has a
/// density.
void weigh(const Element& element, scene::Link& link, scene::Machine& machine, Faults& faults) {
  bool any = link.density > 0;
  geometry::SolidProperties sum;
  // Collisions are the shape of a link; visuals are often thinner or hollow.
  const auto add = [&](const char* kind, const auto& shape, const Pose& X_LS) {
    const Element* of = named_child(element, kind, shape.name);
    const double density = shape.density > 0 ? shape.density : link.density;
    any = any || shape.density > 0;
    geometry::SolidProperties solid;
    if (density > 0 && solid_of(of ? *of : element, shape.geometry, X_LS, solid, faults))
      sum = geometry::joined(sum, geometry::weighed(solid, density));
  };
  // A shape that cannot be weighed has been reported; a sum without it would be wrong in silence.
  const std::size_t before = faults.error_count();
  if (link.collisions.empty())
    for (const scene::Visual& visual : link.visuals) add("visual", visual, visual.X_LV);
  for (const scene::Collision& one : link.collisions)
    add(one.derived ? "visual" : "collision", one, one.X_LC);
  if (!any || faults.error_count() > before) return;
  if (element.FirstChildElement("inertial")) {
    faults.error(element, "", std::string("has both <inertial> and <") + kDensity + ">",
                 "remove one of them");
    return;
  }
  if (!(sum.volume > 0)) {
    faults.error(element, "", "a density needs shapes with a volume",
                 "give the link a <collision> or a <visual>, or <inertial>");
    return;
  }
  // `sum` was joined from solids times their densities, so its volume is a mass [kg].
  link.mass = sum.volume;
  link.p_LCom = sum.p_BCom;
  link.inertia = sum.inertia;
  std::array<char, 64> text{};
  std::snprintf(text.data(), text.size(), "%.4g kg", link.mass);
  machine.derived.push_back("link '" + link.name + "' weighs " + text.data() + " by its density");
}

}  // namespace

void derive_parts(const Element& model, scene::Machine& machine, Faults& faults) {
  // One <collision> anywhere shows that the author has chosen the shapes of all links.
  const bool given = std::any_of(machine.links.begin(), machine.links.end(),
                                 [](const scene::Link& link) { return !link.collisions.empty(); });
  if (machine.derive_collisions && !given) derive_collisions(model, machine, faults);
  // Weighing comes second, since derived shapes have masses too.
  for (scene::Link& link : machine.links)
    if (const Element* element = named_child(model, "link", link.name))
      weigh(*element, link, machine, faults);
}

}  // namespace navvy::scene_io
