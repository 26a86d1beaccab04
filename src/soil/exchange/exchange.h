// SPDX-License-Identifier: Apache-2.0
// Exchange between resting columns and particles: wake, deposit, slump. Host only, mass-exact, repeatable.
#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "core/hash.h"
#include "core/math.h"
#include "core/state_io.h"
#include "heightfield/ground.h"
#include "scene/world.h"
#include "soil/particles/particle.h"
#include "soil/tools/tool_motion.h"

namespace navvy::soil {

/// Decides at each check which columns wake and which particles are booked back.
///
/// Mass is exact per soil in every operation, results do not depend on the order of particles or tools, and the cost
/// follows particles, tools and changed columns, never the site. Between checks it remembers how long blocks have been
/// at rest, what was deposited just now and which columns slide; all of it is saved and hashed.
class Exchange {
 public:
  /// The ground must outlive it. @throws InputError when particles of these soils would be too heavy.
  Exchange(const scene::World& world, heightfield::Ground& ground);
  ~Exchange();

  struct Result {
    std::vector<Particle> born;         ///< to be added (ids are given by the solver)
    std::vector<std::uint8_t> removed;  ///< one flag per particle given: booked into columns
    int woken_columns = 0, deposited_blocks = 0, slumped_columns = 0;
  };
  /// One check. `particles` in a repeatable order; `time` is simulated [s] and `elapsed` since the last check.
  Result check(std::span<const Particle> particles, std::span<const ToolRegion> tools, double time, double elapsed);
  /// Turns columns above W height z_bottom into particles unconditionally. `resting` are the particles there are
  /// already; those on the columns weigh on what wakes.
  std::vector<Particle> wake(const heightfield::CellRect& rect, double z_bottom,
                             std::span<const Particle> resting = {});

  void hash(StateHash& hash) const;
  void save(StateWriter& writer) const;
  void load(StateReader& reader);

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace navvy::soil
