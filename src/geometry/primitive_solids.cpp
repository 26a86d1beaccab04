// SPDX-License-Identifier: Apache-2.0
#include "geometry/primitive_solids.h"

namespace navvy::geometry {
namespace {

/// Returns the properties about the origin, from the mean squares of the coordinates over the
/// volume.
SolidProperties from_squares(double volume, const Vec3& mean_squares) {
  SolidProperties out;
  out.volume = volume;
  const Vec3& s = mean_squares;
  out.inertia = (volume * Vec3(s.y() + s.z(), s.x() + s.z(), s.x() + s.y())).asDiagonal();
  return out;
}

/// Returns the inertia of a unit mass at r (parallel axis theorem).
Mat3 lever(const Vec3& r) { return r.squaredNorm() * Mat3::Identity() - r * r.transpose(); }

}  // namespace

SolidProperties solid_box(const Vec3& edges) {
  return from_squares(edges.prod(), edges.cwiseProduct(edges) / 12);
}

SolidProperties solid_sphere(double radius) {
  return from_squares(4.0 / 3 * kPi * radius * radius * radius,
                      Vec3::Constant(radius * radius / 5));
}

SolidProperties solid_cylinder(double radius, double length) {
  const double r2 = radius * radius / 4;
  return from_squares(kPi * radius * radius * length, Vec3(r2, r2, length * length / 12));
}

SolidProperties solid_cone(double radius, double length) {
  // Mean squares of the slices, weighted by their areas; along z about the centre of mass.
  const double r2 = 3 * radius * radius / 20;
  SolidProperties out =
      from_squares(kPi * radius * radius * length / 3, Vec3(r2, r2, 3 * length * length / 80));
  out.p_BCom = Vec3(0, 0, -length / 4);
  return out;
}

SolidProperties solid_capsule(double radius, double length) {
  const SolidProperties middle = solid_cylinder(radius, length);
  // The centre of mass of a hemisphere is 3/8 of the radius from its flat face, and its inertia
  // about the centre of that face is half of the sphere's.
  SolidProperties cap;
  cap.volume = 2.0 / 3 * kPi * radius * radius * radius;
  cap.inertia = 0.5 * solid_sphere(radius).inertia - cap.volume * lever(Vec3(0, 0, 3 * radius / 8));
  cap.p_BCom = Vec3(0, 0, 0.5 * length + 3 * radius / 8);
  SolidProperties lower = cap;
  lower.p_BCom = -cap.p_BCom;
  return joined(joined(middle, cap), lower);
}

SolidProperties placed(const SolidProperties& body, const Pose& X_AB) {
  SolidProperties out = body;
  out.p_BCom = X_AB * body.p_BCom;
  out.inertia = X_AB.linear() * body.inertia * X_AB.linear().transpose();
  return out;
}

SolidProperties joined(const SolidProperties& a, const SolidProperties& b) {
  SolidProperties out;
  out.volume = a.volume + b.volume;
  if (!(out.volume > 0)) return out;
  out.p_BCom = (a.volume * a.p_BCom + b.volume * b.p_BCom) / out.volume;
  out.inertia = a.inertia + a.volume * lever(a.p_BCom - out.p_BCom) + b.inertia +
                b.volume * lever(b.p_BCom - out.p_BCom);
  return out;
}

SolidProperties weighed(SolidProperties body, double density) {
  body.volume *= density;
  body.inertia *= density;
  return body;
}

}  // namespace navvy::geometry
