// SPDX-License-Identifier: Apache-2.0
// The contact of kernels/soil/contact_law.h compiled for doubles.
#pragma once

#include <algorithm>
#include <cmath>

#include "core/math.h"

namespace navvy::soil::reference {

#define CONTACT_T double
#define CONTACT_LIT(x) (x)
#define CONTACT_MIN(a, b) std::fmin(a, b)
#define CONTACT_MAX(a, b) std::fmax(a, b)
#define CONTACT_ABS(a) std::fabs(a)
#define CONTACT_FN inline
#include "soil/contact_law.h"  // NOLINT: on purpose inside the namespace
#undef CONTACT_T
#undef CONTACT_LIT
#undef CONTACT_MIN
#undef CONTACT_MAX
#undef CONTACT_ABS
#undef CONTACT_FN

/// One node on one side of a plate, as contact.cl's Node.
struct ContactNode {
  Vec3 v = Vec3::Zero(), n = Vec3::UnitZ();  ///< relative to the plate [m/s]; away from the plate
  double m = 0, b = 1, mu = 0, stick = 0;    ///< [kg], weight, tan of the friction angle, shear without push [N s]
  double opening = 0;                        ///< [m/s], see Reach
};

/// Impulse on the node [N s]: twin of `impulse` in kernels/soil/contact_node.h.
inline Vec3 contact_impulse(const ContactNode& node) {
  const double approach = node.v.dot(node.n);
  if (approach >= (node.stick > 0 ? node.opening : 0)) return Vec3::Zero();
  const double push = std::max(0.0, -node.m * approach);
  const Vec3 slip = node.v - approach * node.n;
  const double most = node.mu * push + node.stick, speed = slip.norm();
  const Vec3 shear = node.m * speed <= most ? Vec3(node.m * slip) : Vec3(slip * (most / speed));
  return node.b * (push * node.n - shear);
}

}  // namespace navvy::soil::reference
