// SPDX-License-Identifier: Apache-2.0
#include "soil/exchange/log_spiral.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "core/math.h"

namespace navvy::soil {
namespace {

// Smallest friction angle. A spiral becomes a circle in the limit, where the formulas are 0 / 0.
constexpr double kLeastFriction = radians(0.25);
constexpr double kNone = std::numeric_limits<double>::infinity();

/// Returns gamma H / c of the spiral r = r0 exp((theta - from) tan phi) through the toe, from the
/// crest's ray at `from` to the toe's at `to`: dissipation of cohesion over the work of the block's
/// weight. Lengths in r0 [Chen 1975].
double number_of(double tan_phi, double face, double from, double to) {
  const double grown = std::exp((to - from) * tan_phi);
  const double height = std::sin(to) * grown - std::sin(from);
  const double crest = std::sin(to - from) / std::sin(to) -
                       std::sin(to + face) / (std::sin(to) * std::sin(face)) * height;
  if (!(height > 0) || !(crest > 0)) return kNone;
  // Moments of the spiral's sector, minus the triangles between the pole and the crest, and the
  // pole and the face.
  const double t = 3 * tan_phi;
  const double sector = ((t * std::cos(to) + std::sin(to)) * grown * grown * grown -
                         t * std::cos(from) - std::sin(from)) /
                        (3 * (1 + t * t));
  const double above = crest / 6 * (2 * std::cos(from) - crest) * std::sin(from);
  const double before = grown / 6 * (std::sin(to - from) - crest * std::sin(to)) *
                        (std::cos(from) - crest + std::cos(to) * grown);
  const double driving = sector - above - before;
  return driving > 0 ? (grown * grown - 1) * height / (2 * tan_phi * driving) : kNone;
}

}  // namespace

double stability_number(double friction_angle, double face) {
  if (face <= friction_angle) return kNone;
  const double tan_phi = std::tan(std::max(friction_angle, kLeastFriction));
  // All spirals on a coarse lattice, then finer ones around the best: the number is flat around its
  // minimum.
  double least = kNone, best_from = 0.25 * kPi, best_to = 0.5 * kPi;
  double step = 0.1, from0 = 0.02, to0 = 0.04, from1 = 0.5 * kPi, to1 = kPi - 0.02;
  for (int level = 0; level < 5; ++level) {
    for (double from = from0; from <= from1; from += step)
      for (double to = std::max(to0, from + 0.01); to <= to1; to += step) {
        const double number = number_of(tan_phi, face, from, to);
        if (number < least) least = number, best_from = from, best_to = to;
      }
    from0 = std::max(0.002, best_from - step), from1 = best_from + step;
    to0 = std::max(0.004, best_to - step), to1 = std::min(kPi - 0.002, best_to + step);
    step *= 0.25;
  }
  return least;
}

FaceHeights::FaceHeights(double friction_angle)
    : friction_angle_(friction_angle), inverse_(kFaces + 1) {
  // The inverse goes to 0 at the friction angle, so that it can be interpolated.
  for (int i = 0; i <= kFaces; ++i)
    inverse_[static_cast<std::size_t>(i)] =
        1 / stability_number(friction_angle,
                             friction_angle + (0.5 * kPi - friction_angle) * i / kFaces);
}

double FaceHeights::inverse(double face) const {
  const double at = std::clamp((face - friction_angle_) / (0.5 * kPi - friction_angle_), 0.0, 1.0) *
                    static_cast<double>(kFaces);
  const auto i = std::min(static_cast<std::size_t>(at), inverse_.size() - 2);
  return inverse_[i] + (at - static_cast<double>(i)) * (inverse_[i + 1] - inverse_[i]);
}

double FaceHeights::height(double strength, double setback, double highest) const {
  if (!(strength > 0)) return 0;
  const auto stands = [&](double h) { return h * inverse(std::atan2(h, setback)) <= strength; };
  if (stands(highest)) return highest;
  // The allowed height falls as the face steepens, so there is one crossing; 40 bisections of 100 m
  // are below a nanometre.
  double low = 0, high = highest;
  for (int i = 0; i < 40; ++i) (stands(0.5 * (low + high)) ? low : high) = 0.5 * (low + high);
  return low;
}

}  // namespace navvy::soil
