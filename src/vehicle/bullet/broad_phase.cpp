// SPDX-License-Identifier: Apache-2.0
#include "vehicle/bullet/broad_phase.h"

#include <BulletCollision/CollisionDispatch/btCollisionObject.h>

#include <algorithm>

namespace navvy::vehicle {

bool SweepBroadphase::is_active(int handle) const {
  return static_cast<const btCollisionObject*>(m_pHandles[handle].m_clientObject)->isActive();
}

// Sweeps along x, then sorts the pairs by number.
void SweepBroadphase::calculateOverlappingPairs(btDispatcher*) {
  // The engine drops all pairs after every step, so there are none to keep or to remove here.
  order_.clear();
  for (int i = 0; i <= m_LastHandleIndex; ++i)
    if (m_pHandles[i].m_clientObject) order_.push_back(i);
  const auto low = [&](int i) { return m_pHandles[i].m_aabbMin.x(); };
  std::sort(order_.begin(), order_.end(),
            [&](int a, int b) { return low(a) != low(b) ? low(a) < low(b) : a < b; });
  active_.clear();
  pairs_.clear();
  for (const int i : order_) {
    // A box that ends before this one begins overlaps no later one.
    std::erase_if(active_, [&](int j) { return m_pHandles[j].m_aabbMax.x() < low(i); });
    for (const int j : active_)
      if ((is_active(i) || is_active(j)) && aabbOverlap(&m_pHandles[i], &m_pHandles[j]))
        pairs_.emplace_back(std::min(i, j), std::max(i, j));
    active_.push_back(i);
  }
  std::sort(pairs_.begin(), pairs_.end());
  for (const auto& [i, j] : pairs_)
    if (!m_pairCache->findPair(&m_pHandles[i], &m_pHandles[j]))
      m_pairCache->addOverlappingPair(&m_pHandles[i], &m_pHandles[j]);
}

}  // namespace navvy::vehicle
