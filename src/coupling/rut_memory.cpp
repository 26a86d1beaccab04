// SPDX-License-Identifier: Apache-2.0
#include "coupling/rut_memory.h"

#include <algorithm>
#include <cmath>

#include "terramechanics/plate.h"

namespace navvy::coupling {
namespace {

// [m] A surface this close has not been moved by others since it was pressed.
constexpr double kSameHeight = 1e-3;
// Of the work of a repeated pass, an even number: 1 % at the largest exponent.
constexpr int kSlices = 16;

/// Sinkage under a load that arrives on ground that earlier ones have pressed to the depth `before`
/// [m].
struct Passes {
  const scene::Soil& soil;
  double width, before;

  /// Returns whether earlier passes count.
  bool add_up() const { return soil.multi_pass_exponent > 0 && before > 0; }
  /// Returns the depth under a load that alone would sink by `alone` [m].
  double depth(double alone) const {
    if (!add_up()) return std::max(before, alone);
    // The power of a share of the larger depth is at most 1, so that nothing overflows.
    const double a = soil.multi_pass_exponent;
    const auto [less, more] = std::minmax(before, alone);
    return more * std::pow(1 + std::pow(less / more, a), 1 / a);
  }
  /// Returns the sinkage of the load alone that brings it to `depth` [m]; the inverse of depth().
  double alone(double depth) const {
    if (!(depth > before)) return 0;
    const double a = soil.multi_pass_exponent;
    return depth * std::pow(1 - std::pow(before / depth, a), 1 / a);
  }
  /// Returns the work of the load from one depth to another, per unit of area [J/m2].
  double work(double from, double to) const {
    if (!add_up())
      return terramechanics::plate_work(soil, to, width) -
             terramechanics::plate_work(soil, from, width);
    // By Simpson's rule over the sinkage of the load alone, y: its pressure times dz, and
    // dz/dy = (y / z)^(a - 1), which is finite because a is at least 1.
    const double start = alone(from), slice = (alone(to) - start) / kSlices;
    double sum = 0;
    for (int i = 0; i <= kSlices; ++i) {
      const double weight = i == 0 || i == kSlices ? 1.0 : i % 2 == 1 ? 4.0 : 2.0;
      const double y = start + i * slice;
      sum += weight * terramechanics::plate_pressure(soil, y, width) *
             std::pow(y / depth(y), soil.multi_pass_exponent - 1);
    }
    return slice / 3 * sum;
  }
};

}  // namespace

// Compares heights to detect soil that was added or removed since.
void RutMemory::find(double surface) {
  if (std::abs(surface - height) <= kSameHeight) return;
  if (surface > height) {
    // Below fresh soil the ground with the largest pressure counts.
    if (pressure > floor_pressure) {
      floor_pressure = pressure;
      floor_arrived = arrived;
      floor_height = height;
    }
    pressure = arrived = 0;
    return;
  }
  const bool on_floor = floor_pressure > 0 && std::abs(surface - floor_height) <= kSameHeight;
  pressure = on_floor ? floor_pressure : 0;
  arrived = on_floor ? floor_arrived : 0;
  if (on_floor || surface < floor_height) floor_pressure = floor_arrived = floor_height = 0;
}

// Fresh soil and the ground below it are pressed by the same plate, each from its own history.
RutMemory::Press RutMemory::press(const scene::Soil& soil, double width, double surface,
                                  double applied, double at_most) {
  if (arrived == 0 && applied <= pressure) return {};
  const Passes passes{soil, width, terramechanics::plate_sinkage(soil, arrived, width)};
  const double before = terramechanics::plate_sinkage(soil, pressure, width);
  const double alone = terramechanics::plate_sinkage(soil, applied, width);
  const double after = passes.depth(alone);
  if (!(after > before)) return {};
  double drop = after - before;
  const bool down = floor_pressure > 0 && surface - drop <= floor_height;
  const Passes floor{soil, width, terramechanics::plate_sinkage(soil, floor_arrived, width)};
  const double floor_before = terramechanics::plate_sinkage(soil, floor_pressure, width),
               floor_after = floor.depth(alone);
  if (down)
    drop = std::min(
        drop, std::max(0.0, surface - floor_height) + std::max(0.0, floor_after - floor_before));
  // If the drop is limited, the record is only the pressure of the present depth.
  if (drop > at_most) {
    pressure = terramechanics::plate_pressure(soil, before + at_most, width);
    return {before, at_most, passes.work(before, before + at_most)};
  }
  if (down) {
    // One ground again.
    const double repeated =
        floor.add_up() ? terramechanics::plate_pressure(soil, floor_after, width) : applied;
    pressure = std::max(repeated, floor_pressure);
    arrived = floor_arrived;
    floor_pressure = floor_arrived = floor_height = 0;
  } else {
    pressure = passes.add_up() ? terramechanics::plate_pressure(soil, after, width) : applied;
  }
  return {before, drop, passes.work(before, before + drop)};
}

void RutMemory::visit(Archive& a) {
  a.ranged("pressure", pressure, 0.0, 1e12);
  // Soil without repeated passes has the same hash as before there were any.
  bool repeats = arrived > 0 || floor_arrived > 0;
  a.unhashed("hashed by the pressures below where it is true", [&] { a("repeats", repeats); });
  if (!repeats) arrived = floor_arrived = 0;
  if (repeats) {
    a.ranged("arrived", arrived, 0.0, 1e12);
    a.ranged("floor_arrived", floor_arrived, 0.0, 1e12);
  }
  a("height", height);
  a.ranged("floor_pressure", floor_pressure, 0.0, 1e12);
  a("floor_height", floor_height);
}

}  // namespace navvy::coupling
