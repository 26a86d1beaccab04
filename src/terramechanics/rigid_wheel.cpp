// SPDX-License-Identifier: Apache-2.0
#include "terramechanics/rigid_wheel.h"

#include <algorithm>
#include <cmath>

#include "core/math.h"
#include "terramechanics/bearing.h"
#include "terramechanics/plate.h"
#include "terramechanics/shear.h"

namespace navvy::terramechanics {
namespace {

constexpr int kSlices = 400;  // slices of the arc
// Bisections of the entry angle: below the rounding of a double.
constexpr int kBisections = 60;

/// Sums over the arc from below the axle to the entry angle. `lift` is the load that it carries
/// [N].
struct Arc {
  double lift = 0, drawbar = 0, torque = 0, side = 0;
};

/// Returns the displacement of the rim over the soil since it entered, ahead and to the side [m].
Vec2 rim_displacement(const WheelCase& wheel, const scene::Soil& soil, double entry, double at) {
  // Displacements depend on the ratio of speeds alone.
  const double rim = rim_speed(1.0, wheel.slip);  // of a wheel that travels at 1 m/s
  const double aside = std::tan(wheel.slip_angle);
  // A locked rim is dragged without end.
  if (rim <= 1e-6) return 1e3 * soil.janosi_k * Vec2(-1, aside);
  const double r = wheel.radius, turned = entry - at;
  return {(r + wheel.grouser) * turned - r * (std::sin(entry) - std::sin(at)) / rim,
          r * turned * aside / rim};
}

// Sums pressure and shear over slices of the arc for one entry angle.
Arc sum_arc(const WheelCase& wheel, const scene::Soil& soil, double entry) {
  const double r = wheel.radius, shear_radius = r + wheel.grouser;
  const double modulus =
      plate_modulus(soil, wheel.width) /
      std::pow(slip_sinkage(wheel.slip, wheel.slip_sinkage), soil.bekker_n + 0.5);
  const ShearStrength strength =
      wheel.grouser > 0 ? surface_strength({&soil, 1}) : rim_strength(soil);
  Arc out;
  const double slice = entry / kSlices;
  for (int i = 0; i < kSlices; ++i) {
    // Use the middle of the slice: pressure has a kink below the axle and at the entry.
    const double at = (i + 0.5) * slice;
    const double pressure = modulus * std::pow(r * (std::cos(at) - std::cos(entry)), soil.bekker_n);
    const Vec2 rim_travel = rim_displacement(wheel, soil, entry, at);
    const double moved = rim_travel.norm();
    const double stress = shear_stress(strength, pressure, moved, soil.janosi_k);
    const double shear = moved > 0 ? stress * rim_travel.x() / moved : 0;
    // Pressure acts along the radius, shear along the rim.
    const double area = r * wheel.width * slice;
    out.lift += (pressure * std::cos(at) + shear * std::sin(at)) * area;
    out.drawbar += (shear * std::cos(at) - pressure * std::sin(at)) * area;
    out.torque += shear * shear_radius * area;
    out.side += moved > 0 ? stress * rim_travel.y() / moved * area : 0;
  }
  return out;
}

}  // namespace

double rim_speed(double speed, double slip) {
  return slip >= 0 ? speed / (1 - slip) : speed * (1 + slip);
}

// Finds the entry angle that carries the load, then reads all forces from its arc.
WheelForce rigid_wheel(const WheelCase& wheel, const scene::Soil& soil) {
  // The load grows with the entry angle: bisect between zero and the axle at the surface.
  double low = 0, high = kPi / 2;
  WheelForce out;
  out.carried = sum_arc(wheel, soil, high).lift >= wheel.load;
  for (int i = 0; i < kBisections && out.carried; ++i) {
    const double middle = 0.5 * (low + high);
    (sum_arc(wheel, soil, middle).lift < wheel.load ? low : high) = middle;
  }
  const Arc arc = sum_arc(wheel, soil, high);
  out.sinkage = wheel.radius * (1 - std::cos(high));
  out.bulldozing = bulldozing({&soil, 1}, wheel.width, wheel.radius, out.sinkage,
                              1 / rim_speed(1.0, wheel.slip));
  out.drawbar = arc.drawbar - out.bulldozing;
  out.torque = arc.torque;
  const double aside = std::tan(wheel.slip_angle);
  out.side_wall =
      std::copysign(side_wall_resistance({&soil, 1}, wheel.radius, out.sinkage, aside), aside);
  out.side = arc.side + out.side_wall;
  return out;
}

}  // namespace navvy::terramechanics
