// SPDX-License-Identifier: Apache-2.0
// Exchange between resting columns and particles: activation, deposition, slumping. Host only,
// mass-exact, repeatable.
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
#include "soil/scheme_constants.h"
#include "soil/tools/tool_motion.h"

namespace navvy {
class Archive;
}

namespace navvy::soil {

/// Decides at each check which columns become particles and which particles become columns.
///
/// Mass is exact per soil in every operation. Results do not depend on the order of particles or
/// tools. Cost is linear in particles, tools and changed columns, and does not grow with the site.
/// Between checks it keeps how long blocks have been at rest, what was deposited recently and which
/// columns slide; all of it is saved and hashed.
///
/// The ground under a tool must be particles before the tool reaches it, and soil at rest should be
/// columns, which cost nothing. Three rules activate columns: a zone ahead of tools (A), motion
/// beside resting soil (B), and over-steep slopes near active soil (C). Blocks that rest become
/// layers again; over-steep columns far from active soil slide as columns.
class Exchange {
 public:
  /// Creates the exchange of a ground, which must outlive it; neither world nor ground is changed.
  /// `max_particles` and the treatment of steep ground come from the world.
  /// @throws InputError when particles of these soils would be too heavy.
  Exchange(const scene::Scene& world, heightfield::Ground& ground,
           const SchemeConstants& scheme = kScheme);
  ~Exchange();

  /// Result of one check. The counts are for progress and telemetry; the mass moved is in the
  /// ground and in these lists.
  struct Result {
    /// New particles; the solver assigns their ids.
    std::vector<Particle> born;
    /// One flag per given particle: deposited into columns.
    std::vector<std::uint8_t> removed;
    /// Number of columns and blocks that each rule changed.
    int activated_columns = 0, deposited_blocks = 0, slumped_columns = 0;
    /// Columns that got soil because a wheel or track comes onto them.
    int support_columns = 0;
  };
  /// Support areas on the ground, and the longest time until the next check [s].
  struct Standing {
    std::span<const SupportArea> support_areas;
    double interval = 0;
  };
  /// Runs one check. `particles` come in a repeatable order; `time` is simulated [s] and `elapsed`
  /// the time since the last check [s]. The ground has changed when it returns, but particles have
  /// not: the caller adds and removes them before the next step. The rules are written in simulated
  /// time, so the frequency of checks matters little. Cost is linear in the particles, the columns
  /// near tools and the changes since the last check.
  Result check(std::span<const Particle> particles, std::span<const ToolRegion> tools, double time,
               double elapsed, const Standing& standing);
  /// Runs one check without support areas.
  Result check(std::span<const Particle> particles, std::span<const ToolRegion> tools, double time,
               double elapsed) {
    return check(particles, tools, time, elapsed, Standing{});
  }
  /// Turns columns above `z_bottom` [m in W] into particles unconditionally, without asking the
  /// budget. `resting` are the existing particles; those on the columns load the new ones. For
  /// tests and for scenes that start with active soil.
  std::vector<Particle> activate(const heightfield::CellRect& rect, double z_bottom,
                                 std::span<const Particle> resting = {});

  /// Visits the state between checks, in one section, "soil-exchange". With equal ground and
  /// particles, equal states have equal futures. Loading needs an exchange made for the same scene.
  /// @throws InputError for impossible times and positions.
  void visit(Archive& a);

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace navvy::soil
