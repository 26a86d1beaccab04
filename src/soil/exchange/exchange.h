// SPDX-License-Identifier: Apache-2.0
// Exchange between resting columns and particles: wake, deposit, slump. Host only, mass-exact,
// repeatable.
#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "core/math.h"
#include "heightfield/layered_ground.h"
#include "scene/scene.h"
#include "soil/exchange/support_area.h"
#include "soil/particles/particle.h"
#include "soil/tools/tool_motion.h"

namespace navvy {
class Archive;
}

namespace navvy::soil {

/// Decides at each check which columns wake and which particles are booked back.
///
/// Mass is exact per soil in every operation, results do not depend on the order of particles or
/// tools, and the cost follows particles, tools and changed columns, never the site. Between checks
/// it remembers how long blocks have been at rest, what was deposited just now and which columns
/// slide; all of it is saved and hashed.
class Exchange {
 public:
  /// The ground must outlive it. Neither the world nor the ground's columns are changed by it.
  /// `max_particles` and the way steep ground is treated are taken from the world. @throws
  /// InputError when particles of these soils would be too heavy.
  Exchange(const scene::Scene& world, heightfield::Ground& ground);
  ~Exchange();

  /// What one check did. The counts are for progress and telemetry; the mass moved is in the ground
  /// and in these lists.
  struct Result {
    std::vector<Particle> born;         ///< to be added (ids are given by the solver)
    std::vector<std::uint8_t> removed;  ///< one flag per particle given: booked into columns
    int activated_columns = 0, deposited_blocks = 0, slumped_columns = 0;
    int support_columns = 0;  ///< that got soil because a wheel or belt comes onto it
  };
  /// What stands and rolls on the ground, and how long at most until the next check [s].
  struct Standing {
    std::span<const SupportArea> support_areas;
    double interval = 0;
  };
  /// One check. `particles` in a repeatable order; `time` is simulated [s] and `elapsed` since the
  /// last check. The ground has changed when it returns, particles have not: the caller adds and
  /// removes them before the next step. How often it is called changes little, as the rules are
  /// written in simulated time. Costs the particles, the columns near tools and what changed since.
  Result check(std::span<const Particle> particles, std::span<const ToolRegion> tools, double time,
               double elapsed, const Standing& standing);
  /// Where nothing stands or rolls.
  Result check(std::span<const Particle> particles, std::span<const ToolRegion> tools, double time,
               double elapsed) {
    return check(particles, tools, time, elapsed, Standing{});
  }
  /// Turns columns above W height z_bottom into particles unconditionally. `resting` are the
  /// particles there are already; those on the columns weigh on what wakes. For scenes that start
  /// with soil awake and for tests; the budget is not asked.
  std::vector<Particle> wake(const heightfield::CellRect& rect, double z_bottom,
                             std::span<const Particle> resting = {});

  /// The state between checks, in one section, "soil-exchange": equal ones go on alike with equal
  /// ground and particles. Loading needs an exchange made for the same scene. @throws InputError
  /// for times and places that cannot be.
  void visit(Archive& a);

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace navvy::soil
