// SPDX-License-Identifier: Apache-2.0
#include "soil/reference/plane_rigs.h"

#include <algorithm>
#include <cmath>

namespace navvy::soil::reference {
namespace {

struct Mean {
  double n = 0, sum = 0, squares = 0;
  void add(double x) {
    n += 1;
    sum += x;
    squares += x * x;
  }
  double mean() const { return n > 0 ? sum / n : 0; }
  double deviation() const {
    return n > 0 ? std::sqrt(std::max(squares / n - mean() * mean(), 0.0)) : 0;
  }
};

}  // namespace

BladeResult push_blade(const scene::Soil& soil, double cell, double courant,
                       const PlaneMethod& method, const PlaneBlade& blade) {
  // Soil reaches one depth below the tip, three ahead of the travel and six cells behind, where it
  // ends at the tip.
  const double depth = blade.depth / cell, floor = 3, back = 6;
  const double below = std::ceil(2 * depth - 1e-9), tip = floor + below - depth,
               top = floor + below;
  const double front = std::ceil((blade.travel + 3 * blade.depth) / cell), start = 3 + back;
  PlaneStrain plane(soil, cell, static_cast<int>(start + front) + 6,
                    static_cast<int>(top + 2 * depth) + 12, method);
  plane.floor = floor;
  plane.wall_x0 = 3;
  plane.wall_x1 = start + front;
  plane.has_plate = true;
  plane.plate = {start, tip, 0, blade.friction, 0};
  plane.fill(3, start + front, floor, top,
             [&](double x, double z) { return z < tip || x > start + 0.1; });
  plane.settle([&](double x) { return x > start ? top : tip; });

  const double dt = plane.longest_step(courant);
  Mean force;
  double travel = 0, highest = 0;
  int steps = 0;
  while (travel < blade.travel) {
    plane.plate.speed =
        blade.speed *
        (blade.ramp > 0 ? std::min(1.0, (travel + 1e-3 * blade.ramp) / blade.ramp) : 1);
    plane.step(dt);
    ++steps;
    plane.plate.x += dt * plane.plate.speed / cell;
    travel += dt * plane.plate.speed;
    if (travel >= blade.from) force.add(plane.plate.impulse / dt / cell);
  }
  for (const PlanePoint& p : plane.points)
    if (p.x > plane.plate.x + 0.5 && p.z > tip + 0.5 && p.x < plane.plate.x + 2 * depth)
      highest = std::max(highest, p.density);
  const double sin_phi = std::sin(soil.friction_angle), kp = (1 + sin_phi) / (1 - sin_phi);
  const double rankine = 0.5 * soil.bank_density * kGravity * blade.depth * blade.depth * kp +
                         2 * soil.cohesion * blade.depth * std::sqrt(kp);
  const PlaneEnergy& e = plane.energy();
  return {force.mean(),
          force.mean() / rankine,
          force.deviation() / force.mean(),
          (e.plastic + e.transfer) / (e.tool + e.gravity),
          e.transfer / e.tool,
          highest,
          static_cast<double>(steps) / plane.transfers()};
}

double shear_ratio(const scene::Soil& soil, double cell, double courant, const PlaneMethod& method,
                   double speed, double normal_stress, double strain) {
  const int length = 8, rows = 10;
  const double floor = 4, top = floor + rows;
  PlaneStrain plane(soil, cell, length, rows + 14, method, true);
  plane.floor = floor;
  plane.gravity = Vec2::Zero();
  plane.fill(0, length, floor, top + 2, nullptr);
  for (PlanePoint& p : plane.points) p.j = 1 - normal_stress / plane.law().bulk;
  // The rigid top moves along at `speed` and carries the normal stress as a weight of its own.
  const double area = length * cell * cell, weight = normal_stress * area, mass = weight / kGravity;
  double sinking = 0, along = 0, down = 0;
  plane.on_nodes = [&](PlaneStrain& p, double dt) {
    double total = 0, momentum = 0;
    along = down = 0;
    for (int k = 0; k < p.nz(); ++k)
      for (int i = 0; i < length; ++i) {
        PlaneStrain::Node& node = p.node(i, k);
        if (k <= floor + 0.25) {
          along += node.mass * node.vx;
          down -= node.mass * node.vz;
        } else if (k >= top - 0.25) {
          total += node.mass;
          momentum += node.mass * node.vz;
        }
      }
    sinking = (momentum + mass * sinking - dt * weight) / (total + mass);
    for (int k = static_cast<int>(std::ceil(top - 0.25)); k < p.nz(); ++k)
      for (int i = 0; i < length; ++i) {
        p.node(i, k).vx = speed;
        p.node(i, k).vz = sinking;
      }
  };
  const double dt = plane.longest_step(courant);
  const auto steps = static_cast<long>(strain * rows * cell / speed / dt);
  double sheared = 0, pressed = 0;
  for (long n = 0; n < steps; ++n) {
    plane.step(dt);
    if (n < steps / 2) continue;
    sheared += along;
    pressed += down;
  }
  return sheared / pressed;
}

RestResult rest_bed(const scene::Soil& soil, double cell, double courant, const PlaneMethod& method,
                    double height, double time) {
  const double floor = 3, top = floor + height / cell;
  PlaneStrain plane(soil, cell, 8, static_cast<int>(top) + 8, method, true);
  plane.floor = floor;
  plane.fill(0, 8, floor, top, nullptr);
  plane.settle([&](double) { return top; });
  const double dt = plane.longest_step(courant);
  for (double t = 0; t < time; t += dt) plane.step(dt);
  Mean stress;
  double squares = 0;
  for (const PlanePoint& p : plane.points) {
    squares += p.vx * p.vx + p.vz * p.vz;
    const double under = (top - p.z) * cell;
    if (under > 2 * cell)
      stress.add((p.pressure - p.s[2]) / (soil.bank_density * kGravity * under));
  }
  return {stress.mean(), stress.deviation(),
          std::sqrt(squares / static_cast<double>(plane.points.size()))};
}

double wave_kept_by_transfer(double cells) {
  // Soft soil, so that no stress answers within the one step; the wave is periodic over the length.
  scene::Soil soil;
  soil.young_modulus = 1e-6;
  soil.swell = 1;
  PlaneMethod method;
  method.mixing = false;
  method.crowding = PlaneMethod::Crowding::kNone;
  const int length = static_cast<int>(cells), rows = 12;
  PlaneStrain plane(soil, 1, length, rows + 8, method, true);
  plane.floor = -10;
  plane.gravity = Vec2::Zero();
  plane.fill(0, length, 4, 4 + rows, nullptr, 4);
  const double wave = 2 * kPi / cells;
  const auto amplitude = [&] {  // in the middle, away from free surfaces
    double sum = 0, n = 0;
    for (const PlanePoint& p : plane.points)
      if (p.z > 8 && p.z < 12) {
        sum += 2 * p.vz * std::sin(wave * p.x);
        n += 1;
      }
    return sum / n;
  };
  for (PlanePoint& p : plane.points) {
    p.vz = 1e-6 * std::sin(wave * p.x);
    p.c[6] = 1e-6 * wave * std::cos(wave * p.x);
  }
  // The first transfer brings velocity and gradient to the ratio that the method keeps; only
  // the second one counts.
  for (int n = 0; n < 20; ++n) plane.step(1e-6);
  const double before = amplitude();
  for (int n = 0; n < 10; ++n) plane.step(1e-6);
  return std::pow(amplitude() / before, 0.1);
}

}  // namespace navvy::soil::reference
