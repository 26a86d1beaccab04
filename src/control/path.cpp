// SPDX-License-Identifier: Apache-2.0
#include "control/path.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace navvy::control {
namespace {

/// Moves from `at` by a signed length [m] along an arc.
PlanePose moved(const PlanePose& at, double length, double curvature) {
  // The chord of an arc that turns by 2 h is its length times sin(h) / h, along the mean heading.
  const double h = 0.5 * length * curvature;
  const double chord = length * (std::abs(h) < 1e-9 ? 1 : std::sin(h) / h);
  return {at.p + chord * Vec2(std::cos(at.yaw + h), std::sin(at.yaw + h)), at.yaw + 2 * h};
}

}  // namespace

Path::Path(const PlanePose& start, std::vector<PathPiece> pieces)
    : start_(start), pieces_(std::move(pieces)) {
  find_legs();
}

void Path::find_legs() {
  legs_.clear();
  double s = 0;
  for (const PathPiece& piece : pieces_) {
    if (piece.length == 0) continue;
    const double sense = piece.length < 0 ? -1 : 1;
    if (legs_.empty() || legs_.back().sense != sense) legs_.push_back({s, s, sense});
    s += std::abs(piece.length);
    legs_.back().end = s;
  }
}

PlanePose Path::at(double s) const {
  PlanePose at = start_;
  for (const PathPiece& piece : pieces_) {
    const double size = std::abs(piece.length);
    // The last piece takes what rounding leaves.
    if (s <= 0) break;
    const double part = std::min(s, size);
    at = moved(at, piece.length < 0 ? -part : part, piece.curvature);
    s -= size;
  }
  return at;
}

double Path::curvature(const PathLeg& leg, double s, double half) const {
  const double low = std::max(leg.begin, s - half), high = std::min(leg.end, s + half);
  double sum = 0, begin = 0, here = 0;
  for (const PathPiece& piece : pieces_) {
    const double end = begin + std::abs(piece.length);
    sum += piece.curvature * std::max(0.0, std::min(end, high) - std::max(begin, low));
    // Where the leg is a point, take the piece on which it lies.
    if (low >= begin && low <= end && end > leg.begin && begin < leg.end) here = piece.curvature;
    begin = end;
  }
  return high > low ? sum / (high - low) : here;
}

void Path::visit(Archive& a) {
  a("start_p", start_.p);
  a("start_yaw", start_.yaw);
  a("pieces", pieces_);
  if (a.loading()) find_legs();
}

}  // namespace navvy::control
