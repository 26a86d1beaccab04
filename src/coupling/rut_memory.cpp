// SPDX-License-Identifier: Apache-2.0
#include "coupling/rut_memory.h"

#include <algorithm>
#include <cmath>

#include "terramechanics/plate.h"

namespace navvy::coupling {
namespace {

constexpr double kSameHeight = 1e-3;  // [m] a surface nobody else moved since it was pressed

}  // namespace

void RutMemory::find(double surface) {
  if (std::abs(surface - height) <= kSameHeight) return;
  if (surface > height) {
    // The ground that has borne most is what counts below.
    if (pressure > floor_pressure) floor_pressure = pressure, floor_height = height;
    pressure = 0;
    return;
  }
  const bool on_floor = floor_pressure > 0 && std::abs(surface - floor_height) <= kSameHeight;
  pressure = on_floor ? floor_pressure : 0;
  if (on_floor || surface < floor_height) floor_pressure = floor_height = 0;
}

RutMemory::Sinking RutMemory::press(const scene::Soil& soil, double width, double surface,
                                    double borne, double at_most) {
  if (borne <= pressure) return {};
  const double before = terramechanics::plate_sinkage(soil, pressure, width);
  const double after = terramechanics::plate_sinkage(soil, borne, width);
  double drop = after - before;
  const bool down = floor_pressure > 0 && surface - drop <= floor_height;
  if (down)
    drop = std::min(drop, std::max(0.0, surface - floor_height) +
                              std::max(0.0, after - terramechanics::plate_sinkage(
                                                        soil, floor_pressure, width)));
  // Cut short, it has borne no more than what its depth by now bears.
  if (drop > at_most) {
    pressure = terramechanics::plate_pressure(soil, before + at_most, width);
    return {before, at_most};
  }
  pressure = down ? std::max(borne, floor_pressure) : borne;
  if (down) floor_pressure = floor_height = 0;
  return {before, drop};
}

void RutMemory::visit(Archive& a) {
  a.ranged("pressure", pressure, 0.0, 1e12);
  a("height", height);
  a.ranged("floor_pressure", floor_pressure, 0.0, 1e12);
  a("floor_height", floor_height);
}

}  // namespace navvy::coupling
