// SPDX-License-Identifier: Apache-2.0
#include "lab/theory/wheel_formula.h"

#include <algorithm>
#include <cmath>

#include "core/math.h"

namespace navvy::lab {
namespace {

constexpr int kSlices = 400;  // of the arc

/// Sums over the arc from below the axle to the entry angle; `lift` is the load it carries [N].
struct Arc {
  double lift = 0, drawbar = 0, torque = 0;
};

Arc sum_arc(const WheelCase& wheel, const scene::Soil& soil, double entry) {
  const double r = wheel.radius, modulus = soil.bekker_kc / wheel.width + soil.bekker_kphi;
  const bool steel = soil.tool_friction_angle < soil.friction_angle;
  const double slope = std::tan(steel ? soil.tool_friction_angle : soil.friction_angle);
  const double bond = steel ? soil.adhesion : soil.residual_cohesion;
  // Ways against the soil depend on the ratio of speeds alone.
  const double rim = rim_speed(1.0, wheel.slip);  // of a wheel that goes at 1 m/s
  Arc out;
  const double slice = entry / kSlices;
  for (int i = 0; i < kSlices; ++i) {
    const double at = (i + 0.5) * slice;
    const double pressure = modulus * std::pow(r * (std::cos(at) - std::cos(entry)), soil.bekker_n);
    // Way of the rim against the soil since it entered; a locked rim is dragged on and on.
    const double moved =
        rim > 1e-6 ? r * ((entry - at) - (std::sin(entry) - std::sin(at)) / rim) : -1e3 * soil.janosi_k;
    const double shear =
        std::copysign(bond + pressure * slope, moved) * (1 - std::exp(-std::abs(moved) / soil.janosi_k));
    // Pressure acts along the radius, shear along the rim.
    const double area = r * wheel.width * slice;
    out.lift += (pressure * std::cos(at) + shear * std::sin(at)) * area;
    out.drawbar += (shear * std::cos(at) - pressure * std::sin(at)) * area;
    out.torque += shear * r * area;
  }
  return out;
}

}  // namespace

double rim_speed(double speed, double slip) { return slip >= 0 ? speed / (1 - slip) : speed * (1 + slip); }

WheelForce rigid_wheel(const WheelCase& wheel, const scene::Soil& soil) {
  // The load grows with the entry angle: bisect.
  double low = 0, high = kPi / 2;
  WheelForce out;
  out.carried = sum_arc(wheel, soil, high).lift >= wheel.load;
  for (int i = 0; i < 60 && out.carried; ++i) {
    const double middle = 0.5 * (low + high);
    (sum_arc(wheel, soil, middle).lift < wheel.load ? low : high) = middle;
  }
  const Arc arc = sum_arc(wheel, soil, high);
  out.sinkage = wheel.radius * (1 - std::cos(high));
  out.drawbar = arc.drawbar;
  out.torque = arc.torque;
  return out;
}

}  // namespace navvy::lab
