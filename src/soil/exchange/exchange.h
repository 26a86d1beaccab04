// SPDX-License-Identifier: Apache-2.0
// Exchange between resting columns and particles: activation, deposition and slumping. It runs on
// the host, preserves mass exactly, and is repeatable.
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
/// The ground under a tool must be particles before the tool reaches it, while soil at rest should
/// be columns, which cost nothing. Three rules activate columns: in a zone ahead of tools (A),
/// beside resting soil that starts to move (B), and at over-steep slopes near active soil (C).
/// Blocks of particles at rest become layers again; over-steep columns far from active soil slide
/// as columns.
///
/// Every operation preserves the mass of each soil exactly. Results do not depend on the order of
/// particles or tools. Cost is linear in the number of particles, tools and changed columns, and
/// does not grow with the site. Between checks the exchange stores how long blocks have been at
/// rest, what was deposited recently and which columns slide; this state is saved and hashed.
class Exchange {
 public:
  /// Creates the exchange of a ground, which must outlive this object; the ground is not changed
  /// yet. `world` provides the particle budget and the treatment of steep ground.
  /// @throws InputError when a particle of one of the soils would exceed the range of its integer
  /// mass.
  Exchange(const scene::Scene& world, heightfield::Ground& ground,
           const SchemeConstants& scheme = kScheme);
  ~Exchange();

  /// Result of one check. The counts are for progress and telemetry.
  struct Result {
    /// New particles. The solver assigns their IDs.
    std::vector<Particle> born;
    /// One flag per particle given to `check`: not 0 if the particle was deposited and must be
    /// removed.
    std::vector<std::uint8_t> removed;
    /// Numbers of activated columns, deposited blocks of particles, and columns changed by sliding.
    int activated_columns = 0, deposited_blocks = 0, slumped_columns = 0;
    /// Number of columns that received soil because a wheel or track is about to reach them.
    int support_columns = 0;
  };
  /// Wheels and tracks on the ground, for one check.
  struct Standing {
    /// Support areas of all wheels and tracks.
    std::span<const SupportArea> support_areas;
    /// Longest time until the next check [s].
    double interval = 0;
  };
  /// Runs one check. The ground has changed when the call returns, but the particles have not: the
  /// caller must add and remove particles before the next step.
  ///
  /// `particles`: all particles, in a repeatable order; `tools`: regions of all tools; `time`:
  /// simulated time [s]; `elapsed`: simulated time since the last check [s]. The rules are written
  /// in simulated time, so the frequency of checks matters little. Cost is linear in the number of
  /// particles, of columns near tools and of changes since the last check.
  Result check(std::span<const Particle> particles, std::span<const ToolRegion> tools, double time,
               double elapsed, const Standing& standing);
  /// Runs one check without support areas.
  Result check(std::span<const Particle> particles, std::span<const ToolRegion> tools, double time,
               double elapsed) {
    return check(particles, tools, time, elapsed, Standing{});
  }
  /// Turns the soil above `z_bottom` [m in W] of all columns in `rect` into particles, whatever the
  /// particle budget, and returns them. `resting`: existing particles; those on the columns load
  /// the new ones. For tests and for scenes that start with active soil.
  std::vector<Particle> activate(const heightfield::CellRect& rect, double z_bottom,
                                 std::span<const Particle> resting = {});

  /// Visits the state between checks, in the section "soil-exchange". Together with ground and
  /// particles this state determines all later checks. To load it, create the exchange for the same
  /// scene first.
  /// @throws InputError for impossible times and positions.
  void visit(Archive& a);

 private:
  /// State and rules of the exchange (exchange.cpp).
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace navvy::soil
