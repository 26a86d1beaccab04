// SPDX-License-Identifier: Apache-2.0
#include "earthwork/arm_reach.h"

#include <algorithm>
#include <cmath>

namespace navvy::earthwork {
namespace {

constexpr double kHeightStep = 0.1;  // [m]
// The machine stands so much nearer than its longest reach [m]: drives end up to 0.3 m off, and the
// tip needs to move.
constexpr double kReserve = 0.3;

}  // namespace

const control::TipReach& ArmReach::at(double height) const {
  const int key = static_cast<int>(std::lround(height / kHeightStep));
  const auto it = table_.find(key);
  if (it != table_.end()) return it->second;
  return table_.emplace(key, control::tip_reach(arm_, key * kHeightStep, 0)).first->second;
}

bool ArmReach::contains(double reach, double height) const {
  const control::TipReach& range = at(height);
  return reach >= std::max(control::kNearestDig, range.least) && reach <= range.most - kReserve;
}

}  // namespace navvy::earthwork
