// SPDX-License-Identifier: Apache-2.0
#include "terramechanics/tyre_patch.h"

#include <algorithm>
#include <cmath>

#include "terramechanics/plate.h"

namespace navvy::terramechanics {
namespace {

// Each round halves the error of the sinkage: eight leave 4e-3 of the first guess, at most 1 mm.
constexpr int kRounds = 8;

}  // namespace

double chord_length(double radius, double depth) {
  return 2 * std::sqrt(std::max(0.0, 2 * radius * depth));
}

double TyrePatch::tread_depth(double ahead) const {
  return std::clamp(sinkage + deflection - ahead * ahead / (2 * radius), 0.0, sinkage);
}

// Iterates length, pressure and sinkage, which depend on each other.
TyrePatch tyre_patch(const scene::Wheel& tyre, const scene::Soil& soil, double load) {
  TyrePatch patch;
  patch.radius = tyre.radius;
  patch.width = tyre.width;
  if (!(load > 0)) return patch;
  // The stiffness is the pair's, so the whole load gives the deflection and half of it the
  // pressure.
  const double share = tyre.twin_spacing > 0 ? 0.5 * load : load;
  patch.deflection = load / tyre.stiffness;
  for (int round = 0; round < kRounds; ++round) {
    const double length = chord_length(tyre.radius, patch.deflection + 0.5 * patch.sinkage);
    if (!(length > 0)) return patch;
    patch.pressure = share / (length * tyre.width);
    patch.sinkage = 0.5 * (patch.sinkage + plate_sinkage(soil, patch.pressure, tyre.width));
  }
  // Half length to where the round tread leaves the ground. The length of the mean pressure is
  // between this and the flat part.
  patch.half_length = 0.5 * chord_length(tyre.radius, patch.deflection + patch.sinkage);
  return patch;
}

}  // namespace navvy::terramechanics
