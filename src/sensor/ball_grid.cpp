// SPDX-License-Identifier: Apache-2.0
#include "sensor/ball_grid.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace navvy::sensor {
namespace {

// Edge of a cell in radii of the largest ball; tuned: bench scan of 15 000 particles.
constexpr double kEdge = 4;
// Largest number of cells per ball; beyond it the cells grow.
constexpr double kMostCells = 4;

/// Distance at which a beam enters a ball, 0 inside, or a negative number.
double enter(const Vec3& p, const Vec3& d, const sim::SoilBall& ball) {
  const Vec3 c = ball.p_O.cast<double>() - p;
  const double along = c.dot(d), r2 = static_cast<double>(ball.radius) * ball.radius;
  const double outside = c.squaredNorm() - r2;
  if (outside <= 0) return 0;
  const double root = along * along - outside;
  return root < 0 || along < 0 ? -1 : along - std::sqrt(root);
}

}  // namespace

Eigen::Vector3i BallGrid::cell_at(const Vec3& p) const {
  const Vec3 q = ((p - low_) / edge_).array().floor().matrix();
  return q.cast<int>().cwiseMax(0).cwiseMin(size_ - Eigen::Vector3i::Ones());
}

void BallGrid::build(const Vec3& origin, const std::vector<sim::SoilBall>& balls) {
  origin_ = origin;
  size_.setZero();
  sorted_.clear();
  if (balls.empty()) return;
  float largest = 0;
  Eigen::Vector3f low = balls.front().p_O, high = low;
  for (const sim::SoilBall& ball : balls) {
    low = low.cwiseMin(ball.p_O);
    high = high.cwiseMax(ball.p_O);
    largest = std::max(largest, ball.radius);
  }
  const Vec3 around = Vec3::Constant(static_cast<double>(largest));
  low_ = low.cast<double>() - around;
  high_ = high.cast<double>() + around;
  // A few balls that are far apart must not make millions of cells.
  const double cells = kMostCells * static_cast<double>(balls.size());
  edge_ = std::max(kEdge * static_cast<double>(largest), std::cbrt((high_ - low_).prod() / cells));
  size_ = ((high_ - low_) / edge_).array().ceil().matrix().cast<int>().cwiseMax(1);
  const auto count = static_cast<std::size_t>(size_.prod());
  start_.assign(count + 1, 0);
  cell_.resize(balls.size());
  // In floats: a centre at the border of two cells may be in either, as edges are four radii.
  const Eigen::Vector3f corner = low_.cast<float>();
  const float scale = static_cast<float>(1 / edge_);
  const Eigen::Vector3i last = size_ - Eigen::Vector3i::Ones();
  for (std::size_t i = 0; i < balls.size(); ++i) {
    const Eigen::Vector3f at = scale * (balls[i].p_O - corner);
    cell_[i] = static_cast<std::uint32_t>(index(at.cast<int>().cwiseMax(0).cwiseMin(last)));
    ++start_[cell_[i]];
  }
  // Ends of the cells first, then entries from the last to the first: the order of the balls in a
  // cell is that of the list.
  std::uint32_t sum = 0;
  for (std::uint32_t& each : start_) each = sum += each;
  sorted_.resize(balls.size());
  for (std::size_t i = balls.size(); i-- > 0;) sorted_[--start_[cell_[i]]] = balls[i];
  ranges_.assign(count, {1, 0});
  reaching_.clear();
}

std::pair<std::uint32_t, std::uint32_t> BallGrid::reaching(const Eigen::Vector3i& cell) const {
  std::pair<std::uint32_t, std::uint32_t>& range = ranges_[index(cell)];
  if (range.first <= range.second) return range;
  range.first = static_cast<std::uint32_t>(reaching_.size());
  const Vec3 low = low_ + edge_ * cell.cast<double>(), high = low + Vec3::Constant(edge_);
  const Eigen::Vector3i a = (cell.array() - 1).matrix().cwiseMax(0),
                        b = (cell.array() + 1).matrix().cwiseMin(size_ - Eigen::Vector3i::Ones());
  for (int z = a.z(); z <= b.z(); ++z)
    for (int y = a.y(); y <= b.y(); ++y)
      // Cells along x follow each other in the list.
      for (std::uint32_t i = start_[index({a.x(), y, z})]; i < start_[index({b.x(), y, z}) + 1];
           ++i) {
        const Vec3 p = sorted_[i].p_O.cast<double>();
        const double r = static_cast<double>(sorted_[i].radius);
        if ((p.array() + r >= low.array()).all() && (p.array() - r <= high.array()).all())
          reaching_.push_back(sorted_[i]);
      }
  range.second = static_cast<std::uint32_t>(reaching_.size());
  return range;
}

std::optional<double> BallGrid::first_hit(const Vec3& p_W, const Vec3& direction_W,
                                          double reach) const {
  if (sorted_.empty()) return std::nullopt;
  const Vec3 p = p_W - origin_;
  const Vec3 inverse = direction_W.cwiseInverse();
  // Where the beam is inside the grid.
  double t0 = 0, t1 = reach;
  for (int k = 0; k < 3; ++k) {
    if (direction_W[k] == 0) {
      if (p[k] < low_[k] || p[k] > high_[k]) return std::nullopt;
      continue;
    }
    const double a = (low_[k] - p[k]) * inverse[k], b = (high_[k] - p[k]) * inverse[k];
    t0 = std::max(t0, std::min(a, b));
    t1 = std::min(t1, std::max(a, b));
  }
  if (t0 > t1) return std::nullopt;
  Eigen::Vector3i cell = cell_at(p + t0 * direction_W);
  Vec3 next;
  Eigen::Vector3i step;
  for (int k = 0; k < 3; ++k) {
    step[k] = direction_W[k] > 0 ? 1 : -1;
    next[k] = direction_W[k] == 0
                  ? std::numeric_limits<double>::infinity()
                  : (low_[k] + edge_ * (cell[k] + (step[k] > 0 ? 1 : 0)) - p[k]) * inverse[k];
  }
  double best = t1 + 1;
  while (true) {
    const auto [from, to] = reaching(cell);
    for (std::uint32_t i = from; i < to; ++i) {
      const double t = enter(p, direction_W, reaching_[i]);
      if (t >= 0 && t <= t1) best = std::min(best, t);
    }
    int axis = 0;
    const double leaves = next.minCoeff(&axis);
    // A ball may reach into cells behind, so only a hit in this cell or before it is the first.
    if (best <= leaves || leaves > t1) break;
    cell[axis] += step[axis];
    if (cell[axis] < 0 || cell[axis] >= size_[axis]) break;
    next[axis] += edge_ * std::abs(inverse[axis]);
  }
  return best <= t1 ? std::optional<double>(best) : std::nullopt;
}

}  // namespace navvy::sensor
