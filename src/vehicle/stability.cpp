// SPDX-License-Identifier: Apache-2.0
#include "vehicle/stability.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "geometry/plane_hull.h"

namespace navvy::vehicle {
namespace {

double cross(const Vec2& a, const Vec2& b) { return a.x() * b.y() - a.y() * b.x(); }

/// Support point of a machine with its force in the last step.
struct Bearing {
  Vec3 p_W = Vec3::Zero(), f_W = Vec3::Zero();
};

/// Axle of a wheel: its middle and its unit axis.
struct Axle {
  Vec3 p_W = Vec3::Zero(), axis_W = Vec3::UnitY();
};

/// Where a machine's parts are: the poses of its links, and the axles of its wheels.
struct Placed {
  std::vector<Pose> X_WL;
  std::vector<Axle> axles;
};

Axle axle_of(const WheelState& wheel) {
  return {wheel.X_WWheel.translation(), wheel.X_WWheel.linear().col(1)};
}

std::vector<Pose> links_of(const scene::Machine& machine, const PhysicsEngine& engine, int index) {
  std::vector<Pose> out;
  for (std::size_t l = 0; l < machine.links.size(); ++l)
    out.push_back(engine.link(index, static_cast<int>(l)).X_WL);
  return out;
}

std::vector<WheelState> wheels_of(const scene::Machine& machine, const PhysicsEngine& engine,
                                  int index) {
  std::vector<WheelState> out;
  for (std::size_t w = 0; w < machine.wheels.size(); ++w)
    out.push_back(engine.wheel(index, static_cast<int>(w)));
  return out;
}

Placed placed_at(const scene::Machine& machine, const std::vector<Pose>& X_WL) {
  Placed out{X_WL, {}};
  for (const scene::Wheel& wheel : machine.wheels) {
    const scene::Joint& spin =
        machine.joints[static_cast<std::size_t>(machine.joint_index(wheel.joint))];
    const Pose X_WJ = X_WL[static_cast<std::size_t>(spin.child)] * spin.X_LcJ;
    out.axles.push_back({X_WJ.translation(), X_WJ.linear() * spin.axis.normalized()});
  }
  return out;
}

/// Returns the point straight below the middle of an axle, in the plane of its wheel: for a
/// tilted axle it is to the side.
Vec3 lowest_point(const scene::Wheel& wheel, const Axle& axle) {
  const Vec3 down = -(Vec3::UnitZ() - axle.axis_W.z() * axle.axis_W);
  return axle.p_W + wheel.radius * down.stableNormalized();
}

/// Returns the support points of wheel `w`: one, or the ends of its track's lower run.
std::vector<Vec3> support_points_of(const scene::Machine& machine, const Placed& placed,
                                    std::size_t w) {
  const scene::Wheel& wheel = machine.wheels[w];
  if (!wheel.track) return {lowest_point(wheel, placed.axles[w])};
  const int joint = machine.joint_index(wheel.joint);
  const Pose& X_WC =
      placed.X_WL[static_cast<std::size_t>(machine.joints[static_cast<std::size_t>(joint)].parent)];
  const std::array<Vec3, 2> run = wheel.track->lower_run();
  return {X_WC * run[0], X_WC * run[1]};
}

/// Returns all support points. The force of a track is divided as its rollers press.
std::vector<Bearing> bearings(const scene::Machine& machine, const PhysicsEngine& engine, int index,
                              const std::vector<WheelState>& wheels) {
  std::vector<Bearing> out;
  for (std::size_t w = 0; w < machine.wheels.size(); ++w) {
    const WheelState& wheel = wheels[w];
    if (!machine.wheels[w].track) {
      out.push_back({lowest_point(machine.wheels[w], axle_of(wheel)), wheel.force_W});
      continue;
    }
    const std::vector<terramechanics::TrackPatch> patches =
        track_patches(engine, index, static_cast<int>(w));
    double load = 0;
    for (const terramechanics::TrackPatch& patch : patches) load += patch.load;
    for (const terramechanics::TrackPatch& patch : patches)
      out.push_back({patch.p_W, patch.load / load * (wheel.force_W - wheel.body_W)});
    if (!wheel.body_W.isZero(0)) out.push_back({wheel.body_p_W, wheel.body_W});
  }
  return out;
}

/// Computes the centre of pressure on the ground: the point at the height of the support points
/// about which all ground forces have no horizontal moment.
bool centre_of_pressure(const std::vector<Bearing>& bearings, Vec2& out) {
  double load = 0, height = 0;
  for (const Bearing& one : bearings) {
    load += one.f_W.z();
    height += one.p_W.z() / static_cast<double>(bearings.size());
  }
  if (!(load > 0)) return false;
  out.setZero();
  for (const Bearing& one : bearings)
    out += (one.f_W.z() * one.p_W.head<2>() - (one.p_W.z() - height) * one.f_W.head<2>()) / load;
  return true;
}

/// Machines stand on parts that reach down to within this share of a wheel's radius of its lowest
/// point.
constexpr double kStanding = 0.25;

/// Returns the lowest point of a collision shape against `up`, both in the frame of its link.
Vec3 lowest(const scene::Collision& collision, const Vec3& up) {
  using Kind = scene::Geometry::Kind;
  const scene::Geometry& shape = collision.geometry;
  const Vec3 local = collision.X_LC.linear().transpose() * up;
  Vec3 down = Vec3::Zero();
  if (shape.kind == Kind::kSphere) down = -shape.radius * local;
  if (shape.kind == Kind::kBox)
    for (int i = 0; i < 3; ++i) down[i] = (local[i] > 0 ? -0.5 : 0.5) * shape.size[i];
  if (shape.kind == Kind::kCapsule)
    down = Vec3(0, 0, local.z() > 0 ? -0.5 : 0.5) * shape.length - shape.radius * local;
  if (shape.kind == Kind::kCylinder) {
    const Vec2 side = local.head<2>();
    down.z() = (local.z() > 0 ? -0.5 : 0.5) * shape.length;
    if (side.norm() > 1e-9) down.head<2>() = -shape.radius * side.normalized();
  }
  return collision.X_LC * down;
}

/// Returns whether a link keeps its height above the base: the base itself, and links fixed to it
/// or on a ball joint at it.
bool goes_with_base(const scene::Machine& machine, int link) {
  using Type = scene::Joint::Type;
  return link == 0 ||
         std::any_of(machine.joints.begin(), machine.joints.end(), [&](const scene::Joint& joint) {
           return joint.child == link && joint.parent == 0 &&
                  (joint.type == Type::kFixed || joint.type == Type::kBall);
         });
}

/// Returns the points of such links' collision shapes that are as low as the wheels, in W:
/// skids and caster balls.
/// @param bottom mean height of the wheels' support points along the base's z axis
/// @param radius of the smallest wheel [m]
std::vector<Vec3> skids(const scene::Machine& machine, const Placed& placed, double bottom,
                        double radius) {
  using Kind = scene::Geometry::Kind;
  const Vec3 up = placed.X_WL[0].linear().col(2);
  std::vector<Vec3> out;
  for (int l = 0; l < static_cast<int>(machine.links.size()); ++l) {
    const std::vector<scene::Collision>& shapes =
        machine.links[static_cast<std::size_t>(l)].collisions;
    if (shapes.empty() || !goes_with_base(machine, l)) continue;
    const Pose& X_WL = placed.X_WL[static_cast<std::size_t>(l)];
    for (const scene::Collision& collision : shapes) {
      const Kind kind = collision.geometry.kind;
      if (kind == Kind::kMesh || kind == Kind::kPlane || kind == Kind::kCone) continue;
      const Vec3 p = X_WL * lowest(collision, X_WL.linear().transpose() * up);
      if (up.dot(p) < bottom + kStanding * radius) out.push_back(p);
    }
  }
  return out;
}

/// Returns all points on which a machine stands.
std::vector<Vec3> all_support_points(const scene::Machine& machine, const Placed& placed) {
  const Vec3 up = placed.X_WL[0].linear().col(2);
  std::vector<Vec3> out;
  double height = 0, radius = std::numeric_limits<double>::infinity();
  for (std::size_t w = 0; w < machine.wheels.size(); ++w) {
    const std::vector<Vec3> own = support_points_of(machine, placed, w);
    for (const Vec3& point : own) {
      out.push_back(point);
      height += up.dot(point) / double(machine.wheels.size() * own.size());
    }
    radius = std::min(radius, machine.wheels[w].radius);
  }
  for (const Vec3& p : skids(machine, placed, height, radius)) out.push_back(p);
  return out;
}

}  // namespace

// Inside, the nearest edge counts; outside, the distance to the polygon.
double support_margin(std::vector<Vec2> support_points, const Vec2& p) {
  const std::vector<Vec2> hull = support_points.size() < 3
                                     ? std::vector<Vec2>{}
                                     : geometry::plane_hull(std::move(support_points));
  if (hull.size() < 3) return 0;
  bool inside = true;
  double least = std::numeric_limits<double>::infinity();
  for (std::size_t i = 0; i < hull.size(); ++i) {
    const Vec2& a = hull[i];
    const Vec2 edge = hull[(i + 1) % hull.size()] - a;
    inside = inside && cross(edge, p - a) >= 0;
    // Distance to the edge, not to its line: outside a corner the corner is nearest.
    const double t = std::clamp((p - a).dot(edge) / edge.squaredNorm(), 0.0, 1.0);
    least = std::min(least, (p - a - t * edge).norm());
  }
  return inside ? least : -least;
}

// Takes the minimum over all edges of the polygon.
TippingLoad tipping_load(std::vector<Vec2> support_points, const Vec2& centre, double mass,
                         const Vec2& load_point) {
  TippingLoad out;
  const std::vector<Vec2> hull = support_points.size() < 3
                                     ? std::vector<Vec2>{}
                                     : geometry::plane_hull(std::move(support_points));
  if (hull.size() < 3) return {0, Vec2::Zero()};
  for (std::size_t i = 0; i < hull.size(); ++i) {
    const Vec2 edge = (hull[(i + 1) % hull.size()] - hull[i]).normalized();
    const Vec2 outward(edge.y(), -edge.x());
    const double inside = -outward.dot(centre - hull[i]), lever = outward.dot(load_point - hull[i]);
    if (inside <= 0) return {0, outward};
    if (lever <= 0 || mass * inside >= out.load * lever) continue;
    out = {mass * inside / lever, outward};
  }
  return out;
}

// Each edge of the polygon is an axis; the moment of the force about it grows with the factor.
double tipping_factor(std::vector<Vec2> support_points, double ground, const Vec2& centre,
                      double weight, const Vec3& p, const Vec3& f) {
  double out = std::numeric_limits<double>::infinity();
  const std::vector<Vec2> hull = support_points.size() < 3
                                     ? std::vector<Vec2>{}
                                     : geometry::plane_hull(std::move(support_points));
  if (hull.size() < 3) return 0;
  for (std::size_t i = 0; i < hull.size(); ++i) {
    const Vec2 edge = (hull[(i + 1) % hull.size()] - hull[i]).normalized();
    const Vec2 outward(edge.y(), -edge.x());
    const double inside = -outward.dot(centre - hull[i]);
    if (inside <= 0) return 0;
    // A force down outside the edge tips, and so does a push outwards above the ground.
    const double moment =
        -f.z() * outward.dot(p.head<2>() - hull[i]) + outward.dot(f.head<2>()) * (p.z() - ground);
    if (moment > 0) out = std::min(out, weight * inside / moment);
  }
  return out;
}

std::vector<Vec3> support_points(const scene::Machine& machine, const std::vector<Pose>& X_WL) {
  return all_support_points(machine, placed_at(machine, X_WL));
}

// Weights the links' centres by their masses.
Vec3 centre_of_mass(const scene::Machine& machine, const std::vector<Pose>& X_WL) {
  Vec3 sum = Vec3::Zero();
  double mass = 0;
  for (std::size_t i = 0; i < machine.links.size(); ++i) {
    const scene::Link& link = machine.links[i];
    sum += link.mass * (X_WL[i] * link.p_LCom);
    mass += link.mass;
  }
  return mass > 0 ? Vec3(sum / mass) : X_WL[0].translation();
}

Vec3 centre_of_mass(const scene::Machine& machine, const PhysicsEngine& engine, int index) {
  return centre_of_mass(machine, links_of(machine, engine, index));
}

// Collects the support points first: margins and loads refer to their polygon.
Stability stability(const scene::Machine& machine, const PhysicsEngine& engine, int index) {
  Stability out;
  out.free = !machine.kinematic && !machine.fixed_base && !machine.wheels.empty();
  if (!out.free) return out;
  const LinkState base = engine.link(index, 0);
  const Vec3 up = base.X_WL.linear().col(2);
  out.tilt = std::acos(std::clamp(up.z(), -1.0, 1.0));
  // d/dt of up = w x up, and of its height cos(tilt). An upright axis has no direction of tilt.
  const double sine = std::sin(out.tilt);
  if (sine > 1e-6) out.tilt_rate = -base.w_WL.cross(up).z() / sine;
  const std::vector<WheelState> wheels = wheels_of(machine, engine, index);
  Placed placed{links_of(machine, engine, index), {}};
  for (const WheelState& wheel : wheels) placed.axles.push_back(axle_of(wheel));
  std::vector<Vec2> support_points;
  for (const Vec3& p : all_support_points(machine, placed)) support_points.push_back(p.head<2>());
  const Vec2 centre = centre_of_mass(machine, placed.X_WL).head<2>();
  out.margin = support_margin(support_points, centre);
  const int joint = machine.joint_index(machine.arm.bucket);
  if (joint < 0) return out;
  const scene::Joint& pin = machine.joints[static_cast<std::size_t>(joint)];
  const Vec3 load_point =
      placed.X_WL[static_cast<std::size_t>(pin.child)] * Vec3(pin.X_LcJ.translation());
  double mass = 0;
  for (const scene::Link& link : machine.links) mass += link.mass;
  const TippingLoad weakest = tipping_load(support_points, centre, mass, load_point.head<2>());
  out.tipping_load = weakest.load;
  const Vec2 ahead = base.X_WL.linear().col(0).head<2>(), left(-ahead.y(), ahead.x());
  out.tipping_heading = std::atan2(weakest.outward.dot(left), weakest.outward.dot(ahead));
  // Without ground forces, or for a machine that nothing moves, use the centre of mass.
  Vec2 pressure_centre = centre;
  centre_of_pressure(bearings(machine, engine, index, wheels), pressure_centre);
  out.loaded_margin = support_margin(std::move(support_points), pressure_centre);
  return out;
}

}  // namespace navvy::vehicle
