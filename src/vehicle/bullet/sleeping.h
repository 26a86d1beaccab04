// SPDX-License-Identifier: Apache-2.0
// Whether a loose body lies still: it then sleeps, and a step costs nothing for it.
#pragma once

#include <LinearMath/btVector3.h>

#include <cstdint>
#include <vector>

#include "core/archive.h"
#include "core/math.h"
#include "terramechanics/ground_query.h"

namespace navvy::vehicle {

/// Rest of one body: a machine of a single link that nothing holds.
///
/// It falls asleep when it has not come further than 1 mm (and 2 mrad) in half a second, and stays
/// where it is, with no speed. (Its speed would not tell: contacts are found anew in every step, in
/// which a body at rest trembles.) It wakes when something pushes it, when something that moves
/// comes as near as its box, and when the ground under it has changed: it feels another 32nd of its
/// nodes in every step. All of it is state: a loaded body sleeps on as the saved one.
class Rest {
 public:
  bool asleep() const { return asleep_; }
  /// Something pushes it.
  void disturb() { asleep_ = false, still_ = 0; }
  /// For how long it has lain still, no longer than it takes to fall asleep [s].
  double still() const;
  /// Something has come near that has been still for so long [s] (0 where it does not tire): it
  /// wakes and lies down again when that does, but not sooner than it would begin to fall if that
  /// went away.
  void wake(double still);

  /// After a step in which it was awake, which has brought it here. True when it falls asleep now.
  bool tire(const Pose& X_WB, double dt);
  /// Notes the ground under its box `low`, `high` [m].
  void lie_down(const terramechanics::GroundQuery& ground, const btVector3& low,
                const btVector3& high);
  /// Before a step in which it sleeps: wakes it where the ground under its box is another than it
  /// lay down on.
  void feel(const terramechanics::GroundQuery& ground, const btVector3& low, const btVector3& high);

  void visit(Archive& a);

 private:
  static constexpr std::uint32_t kParts = 32;

  bool asleep_ = false;
  double still_ = 0;  // for how long it has been near `near_` [s]
  Pose near_ = Pose::Identity();
  // Of the ground, which it felt last
  std::uint32_t part_ = 0;
  // Hashes of the heights it lay down on
  std::vector<std::uint64_t> ground_ = std::vector<std::uint64_t>(kParts);
};

}  // namespace navvy::vehicle
