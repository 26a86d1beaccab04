// SPDX-License-Identifier: Apache-2.0
// Part of a dig that loads a bed to a stated mass: sizes of the passes and their places.
#include "control/activities/dig/digging.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace navvy::control {
namespace {

// Share of a bucket by which a pass of a stated load may be planned larger.
constexpr double kMorePass = 0.25;
// Share of a stated load by which a pass may exceed what the bed lacks.
constexpr double kSurplus = 0.01;
constexpr double kMostShift = 0.4;  // by which a dump is laid elsewhere to centre a load [m]
constexpr double kResidue = 0.4;    // of a bucket: less soil in a bed is no pass

}  // namespace

void Digging::aim_at(double lack) {
  // The rest is divided into equal passes, so that no small one is left.
  if (dig_.has_load) m.wanted = lack / std::max(1.0, std::ceil(lack / m.full_mass - kMorePass));
}

double Digging::lacking(const Observation& seen) const {
  if (!dig_.has_load) return std::numeric_limits<double>::infinity();
  return dig_.load - (seen.load_of ? seen.load_of(dig_.into) : 0.0);
}

void Digging::learn_gain(double payload) {
  if (!dig_.has_load || m.wanted <= 0) return;
  // Half of the difference: scoops differ by more than places do.
  const double possible = std::min(m.wanted, m.full_mass);
  m.gain = std::clamp(m.gain * std::sqrt(payload / possible), kLeastGain, kMostGain);
  if (dig_.gain != nullptr) *dig_.gain = m.gain;
}

bool Digging::trims(const Observation& seen, double dt) {
  if (!dig_.has_load) return false;
  if (trim_.opening() == 0) learn_gain(seen.payload);
  // What a pass brings too much makes the next ones smaller: no more than the bed lacks is needed.
  const bool works = trim_.advance(seen.payload, lacking(seen) + kSurplus * dig_.load, dt);
  place_.handover.q[3] =
      std::clamp(place_.handover.q[3] + trim_.opening(), arm_.lower(2), arm_.upper(2));
  return works;
}

Vec2 Digging::dump_place(const Observation& seen) const {
  if (!dig_.has_load || dig_.spread.isZero()) return dig_.dump_at;
  // Equal passes are laid side by side along the bed: each at the middle of its share.
  const double share = (dig_.load - lacking(seen) + 0.5 * m.wanted) / dig_.load;
  return dig_.dump_at + std::clamp(2 * share - 1, -1.0, 1.0) * dig_.spread + off_centre(seen);
}

Vec2 Digging::off_centre(const Observation& seen) const {
  const double lack = lacking(seen), given = dig_.load - lack;
  // What a truck has not tipped says nothing of where passes land.
  if (given < kResidue * m.full_mass || !seen.load_centre_of) return Vec2::Zero();
  const std::optional<Vec2> centre = seen.load_centre_of(dig_.into);
  if (!centre) return Vec2::Zero();
  // Passes up to now, if each had landed in its place, lie about the middle of their share. Later
  // ones are assumed to miss theirs by as much, so they balance that, too.
  const Vec2 meant = dig_.dump_at + (given / dig_.load - 1) * dig_.spread;
  const Vec2 shift = (meant - *centre) * (dig_.load / std::max(lack, 0.1 * dig_.load));
  return shift * std::min(1.0, kMostShift / std::max(shift.norm(), kMostShift));
}

}  // namespace navvy::control
