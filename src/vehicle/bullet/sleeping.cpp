// SPDX-License-Identifier: Apache-2.0
#include "vehicle/bullet/sleeping.h"

#include <algorithm>
#include <cmath>

#include "core/hash.h"

namespace navvy::vehicle {
namespace {

constexpr double kStill = 1e-3, kStillTurn = 2e-3, kStillFor = 0.5;  // [m], [rad], [s]
constexpr double kStartled = 0.2;   // [s] in which a falling body moves far more than kStill
constexpr double kMostCells = 256;  // along a side

/// Hashes the heights of every `of`-th node, starting at number `part`, among those that carry a
/// triangle under the box.
std::uint64_t hash_under(const terramechanics::GroundQuery& ground, const btVector3& low,
                         const btVector3& high, std::uint32_t part, std::uint32_t of) {
  const terramechanics::GroundLattice lattice = ground.lattice();
  // Nodes are skipped under a body of a hundred metres, as in its contacts.
  const double span = std::max(high.x() - low.x(), high.y() - low.y()) / lattice.spacing;
  const double step = lattice.spacing * std::max(1.0, std::ceil(span / kMostCells));
  const auto node = [&](double at, double first) { return std::floor((at - first) / step); };
  const double x0 = node(low.x(), lattice.node.x()), y0 = node(low.y(), lattice.node.y());
  const auto nx = static_cast<std::uint32_t>(node(high.x(), lattice.node.x()) + 2 - x0);
  const auto ny = static_cast<std::uint32_t>(node(high.y(), lattice.node.y()) + 2 - y0);
  StateHash hash;
  for (std::uint32_t k = part; k < nx * ny; k += of) {
    const std::uint32_t row = k / nx;
    const Vec2 p = lattice.node + step * Vec2(x0 + (k - row * nx), y0 + row);
    hash.value(ground.height(p.x(), p.y()));
  }
  return hash.digest();
}

}  // namespace

double Rest::still() const { return std::min(still_, kStillFor); }

void Rest::wake(double still) {
  asleep_ = false;
  still_ = std::min(still_, std::max(still, kStillFor - kStartled));
}

bool Rest::tire(const Pose& X_WB, double dt) {
  still_ += dt;
  const double turn = (X_WB.linear() - near_.linear()).norm() / std::sqrt(2.0);  // small angles
  if ((X_WB.translation() - near_.translation()).norm() > kStill || turn > kStillTurn)
    near_ = X_WB, still_ = 0;
  return asleep_ = still_ >= kStillFor;
}

void Rest::lie_down(const terramechanics::GroundQuery& ground, const btVector3& low,
                    const btVector3& high) {
  for (std::uint32_t part = 0; part < kParts; ++part)
    ground_[part] = hash_under(ground, low, high, part, kParts);
}

void Rest::feel(const terramechanics::GroundQuery& ground, const btVector3& low,
                const btVector3& high) {
  part_ = (part_ + 1) % kParts;
  if (hash_under(ground, low, high, part_, kParts) != ground_[part_]) disturb();
}

void Rest::visit(Archive& a) {
  a("asleep", asleep_);
  a("still", still_);
  a("near", near_);
  a.ranged("part", part_, std::uint32_t{0}, kParts - 1);
  a.fixed("ground", ground_);
  a.require(std::isfinite(still_) && still_ >= 0, "still", "must be finite and not negative");
}

}  // namespace navvy::vehicle
