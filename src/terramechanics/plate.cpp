// SPDX-License-Identifier: Apache-2.0
#include "terramechanics/plate.h"

#include <algorithm>
#include <cmath>

namespace navvy::terramechanics {
namespace {

// Largest slip times coefficient: 13 times as deep, where no wheel works any more.
constexpr double kMostSlip = 1.6;

}  // namespace

double plate_modulus(const scene::Soil& soil, double width) {
  return soil.bekker_kc / width + soil.bekker_kphi;
}

double plate_pressure(const scene::Soil& soil, double sinkage, double width) {
  return sinkage > 0 ? plate_modulus(soil, width) * std::pow(sinkage, soil.bekker_n) : 0;
}

double plate_work(const scene::Soil& soil, double sinkage, double width) {
  return plate_pressure(soil, sinkage, width) * sinkage / (soil.bekker_n + 1);
}

double plate_sinkage(const scene::Soil& soil, double pressure, double width) {
  const double k = plate_modulus(soil, width);
  // A negative k_c may make the modulus of a narrow plate negative. Return zero rather than a NaN.
  if (!(pressure > 0) || !(k > 0)) return 0;
  return std::pow(pressure / k, 1 / soil.bekker_n);
}

double slip_sinkage(double slip, double coefficient) {
  // Stay below the pole, which a coefficient near 2 reaches.
  const double s = std::min(coefficient * std::min(std::abs(slip), 1.0), kMostSlip);
  return (1 + s) / (1 - 0.5 * s);
}

}  // namespace navvy::terramechanics
