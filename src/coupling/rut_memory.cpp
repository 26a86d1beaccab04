// SPDX-License-Identifier: Apache-2.0
#include "coupling/rut_memory.h"

#include <algorithm>
#include <cmath>

#include "terramechanics/plate.h"

namespace navvy::coupling {
namespace {

// [m] A surface this close has not been moved by others since it was pressed.
constexpr double kSameHeight = 1e-3;

}  // namespace

// Compares heights to detect soil that was added or removed since.
void RutMemory::find(double surface) {
  if (std::abs(surface - height) <= kSameHeight) return;
  if (surface > height) {
    // Below fresh soil the ground with the largest pressure counts.
    if (pressure > floor_pressure) floor_pressure = pressure, floor_height = height;
    pressure = 0;
    return;
  }
  const bool on_floor = floor_pressure > 0 && std::abs(surface - floor_height) <= kSameHeight;
  pressure = on_floor ? floor_pressure : 0;
  if (on_floor || surface < floor_height) floor_pressure = floor_height = 0;
}

// Fresh soil and the ground below it are pressed by the same plate, each from its own history.
RutMemory::Press RutMemory::press(const scene::Soil& soil, double width, double surface,
                                  double applied, double at_most) {
  if (applied <= pressure) return {};
  const double before = terramechanics::plate_sinkage(soil, pressure, width);
  const double after = terramechanics::plate_sinkage(soil, applied, width);
  double drop = after - before;
  const bool down = floor_pressure > 0 && surface - drop <= floor_height;
  if (down)
    drop = std::min(drop, std::max(0.0, surface - floor_height) +
                              std::max(0.0, after - terramechanics::plate_sinkage(
                                                        soil, floor_pressure, width)));
  // If the drop is limited, the record is only the pressure of the present depth.
  if (drop > at_most) {
    pressure = terramechanics::plate_pressure(soil, before + at_most, width);
    return {before, at_most};
  }
  pressure = down ? std::max(applied, floor_pressure) : applied;
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
