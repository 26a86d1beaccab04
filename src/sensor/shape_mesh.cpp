// SPDX-License-Identifier: Apache-2.0
#include "sensor/shape_mesh.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include "geometry/oriented_box.h"
#include "scene/scaled_mesh.h"

namespace navvy::sensor {
namespace {

using geometry::TriangleMesh;

/// Radius and height of a ring about z.
struct Ring {
  double radius, z;
};

/// Returns the number of sides of a circle with this radius [m] whose chords stay within
/// kRoundness.
int sides_of(double radius) {
  const double angle = std::acos(std::clamp(1 - kRoundness / std::max(radius, 1e-6), -1.0, 1.0));
  return std::clamp(static_cast<int>(std::ceil(kPi / std::max(angle, 1e-3))), 16, 720);
}

/// Returns the body of revolution between rings from bottom to top; rings of radius 0 are points.
TriangleMesh revolved(const std::vector<Ring>& rings, int sides) {
  TriangleMesh out;
  for (const Ring& ring : rings)
    for (int i = 0; i < sides; ++i) {
      const double angle = 2 * kPi * i / sides;
      out.vertices.emplace_back(ring.radius * std::cos(angle), ring.radius * std::sin(angle),
                                ring.z);
    }
  const int last = static_cast<int>(rings.size()) - 1;
  for (int r = 0; r < last; ++r)
    for (int i = 0; i < sides; ++i) {
      const int a = r * sides + i, b = r * sides + (i + 1) % sides, c = a + sides, d = b + sides;
      if (rings[static_cast<std::size_t>(r)].radius > 0) out.triangles.push_back({a, b, d});
      if (rings[static_cast<std::size_t>(r) + 1].radius > 0) out.triangles.push_back({a, d, c});
    }
  return out;
}

/// Appends the rings of a hemisphere: `top` is 1 for the upper and -1 for the lower one.
void add_hemisphere(double radius, double middle, int top, int rings, std::vector<Ring>& out) {
  for (int i = 0; i <= rings; ++i) {
    const double angle = 0.5 * kPi * (top > 0 ? i : rings - i) / rings;
    const bool pole = i == (top > 0 ? rings : 0);
    out.push_back({pole ? 0 : radius * std::cos(angle), middle + top * radius * std::sin(angle)});
  }
}

TriangleMesh box(const Vec3& size) {
  TriangleMesh out;
  for (const Vec3& corner : geometry::corners({Pose::Identity(), 0.5 * size}))
    out.vertices.push_back(corner);
  for (const auto& [a, b, c, d] :
       {std::array{0, 2, 3, 1}, std::array{4, 5, 7, 6}, std::array{0, 1, 5, 4},
        std::array{2, 6, 7, 3}, std::array{0, 4, 6, 2}, std::array{1, 3, 7, 5}}) {
    out.triangles.push_back({a, b, c});
    out.triangles.push_back({a, c, d});
  }
  return out;
}

TriangleMesh rectangle(const Vec3& size) {
  TriangleMesh out;
  const double x = 0.5 * size.x(), y = 0.5 * size.y();
  out.vertices = {{-x, -y, 0}, {x, -y, 0}, {x, y, 0}, {-x, y, 0}};
  out.triangles = {{0, 1, 2}, {0, 2, 3}};
  return out;
}

}  // namespace

TriangleMesh mesh_of(const scene::Geometry& shape) {
  using Kind = scene::Geometry::Kind;
  const double r = shape.radius, half = 0.5 * shape.length;
  // Balls are curved both ways, so that the gaps of both add up.
  const int sides = sides_of(r), both = sides + sides / 2;
  std::vector<Ring> rings;
  switch (shape.kind) {
    case Kind::kBox:
      return box(shape.size);
    case Kind::kCylinder:
      return revolved({{0, -half}, {r, -half}, {r, half}, {0, half}}, sides);
    case Kind::kCone:
      return revolved({{0, -half}, {r, -half}, {0, half}}, sides);
    case Kind::kSphere:
      add_hemisphere(r, 0, -1, both / 4, rings);
      rings.pop_back();  // the equator belongs to both halves
      add_hemisphere(r, 0, 1, both / 4, rings);
      return revolved(rings, both);
    case Kind::kCapsule:
      add_hemisphere(r, -half, -1, both / 4, rings);
      add_hemisphere(r, half, 1, both / 4, rings);
      return revolved(rings, both);
    case Kind::kPlane:
      return rectangle(shape.size);
    case Kind::kMesh:
      break;
  }
  return scene::scaled_mesh(shape);
}

void append(const TriangleMesh& part, const Pose& X_AP, TriangleMesh& whole) {
  const int first = static_cast<int>(whole.vertices.size());
  for (const Vec3& v : part.vertices) whole.vertices.push_back(X_AP * v);
  for (const auto& t : part.triangles)
    whole.triangles.push_back({t[0] + first, t[1] + first, t[2] + first});
}

namespace {

/// Returns what a link looks like: visuals, else collisions and shells.
TriangleMesh look_of(const scene::Machine& machine, const scene::Link& link) {
  TriangleMesh out;
  for (const scene::Visual& visual : link.visuals)
    append(mesh_of(visual.geometry), visual.X_LV, out);
  if (!link.visuals.empty()) return out;
  for (const scene::Collision& collision : link.collisions)
    // A plane that collides is the rock under the whole site.
    if (collision.geometry.kind != scene::Geometry::Kind::kPlane)
      append(mesh_of(collision.geometry), collision.X_LC, out);
  for (const scene::Shell& shell : machine.shells)
    if (shell.link == link.name) {
      TriangleMesh steel;
      steel.vertices = shell.vertices;
      steel.triangles = shell.triangles;
      append(steel, Pose::Identity(), out);
    }
  return out;
}

}  // namespace

void SolidBody::place(const Pose& X_WL) {
  X_LW = X_WL.inverse();
  const Vec3 centre = X_WL * middle, reach = X_WL.linear().cwiseAbs() * half;
  low = centre - reach;
  high = centre + reach;
}

bool SolidBody::contains(const Vec3& p_W) const {
  if ((p_W.array() < low.array()).any() || (p_W.array() > high.array()).any()) return false;
  const Vec3 p_L = X_LW * p_W;
  // From inside a closed body, every beam first meets the back of a face. Three beams show
  // whether a mesh is closed.
  bool inside = true;
  for (const Vec3& d : {Vec3(0.31, 0.17, 0.93), Vec3(-0.83, 0.41, -0.37), Vec3(0.2, -0.9, 0.4)}) {
    const auto hit = tree.first_hit(p_L, d);
    inside = inside && hit && hit->normal.dot(d) > 0;
  }
  return inside;
}

std::vector<SolidBody> solid_bodies(const scene::Scene& scene) {
  std::vector<SolidBody> out;
  for (std::size_t m = 0; m < scene.machines.size(); ++m) {
    const scene::Machine& machine = scene.machines[m].machine;
    for (std::size_t l = 0; l < machine.links.size(); ++l) {
      const TriangleMesh look = look_of(machine, machine.links[l]);
      if (look.triangles.empty()) continue;
      const geometry::Box box = geometry::bounds(look);
      out.push_back({static_cast<int>(m), static_cast<int>(l),
                     geometry::RayTree(look, scene.machines[m].name), 0.5 * (box.low + box.high),
                     0.5 * (box.high - box.low)});
      out.back().place(Pose::Identity());
    }
  }
  return out;
}

Enclosure around(const scene::Scene& scene, const heightfield::Terrain& surface,
                 const std::vector<SolidBody>& bodies, const Vec3& p_W) {
  const Vec2i column = surface.column_at(p_W.x(), p_W.y());
  if (surface.contains(column.x(), column.y()) && p_W.z() <= surface.sample(p_W.x(), p_W.y()))
    return {"the ground", -1};
  for (const SolidBody& body : bodies) {
    if (!body.contains(p_W)) continue;
    const scene::MachineInWorld& placed = scene.machines[static_cast<std::size_t>(body.machine)];
    return {"link '" + placed.machine.links[static_cast<std::size_t>(body.link)].name + "' of '" +
                placed.name + "'",
            body.machine};
  }
  return {};
}

}  // namespace navvy::sensor
