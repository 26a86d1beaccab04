// SPDX-License-Identifier: Apache-2.0
#include "soil/exchange/exchange.h"

#include <algorithm>
#include <cmath>
#include <set>
#include <string>

#include "core/archive.h"
#include "core/log.h"
#include "soil/exchange/activation.h"
#include "soil/exchange/activation_rules.h"
#include "soil/exchange/carried_load.h"
#include "soil/exchange/deposit.h"
#include "soil/exchange/exchange_index.h"
#include "soil/exchange/slump.h"
#include "soil/exchange/support_deposit.h"

namespace navvy::soil {
namespace {

/// The motion rule leaves deposited columns alone for this long [s], so that
/// activation and deposition do not alternate. Tuned by
/// ExchangeDeposit.WakingAndBookingBackAgainAndAgainChangesNothing.
constexpr double kRestAfterDeposit = 1.0;
/// Tiles of changed ground that one check examines; the others wait, so that a
/// check remains cheap. Tuned: 48 tiles of flat ground take about a
/// millisecond.
constexpr std::size_t kTilesPerCheck = 48;
/// No site has tiles beyond this: a side has at most 2^30 columns. Zones of
/// tools may extend a little beyond the site.
constexpr int kFarthestTile = (1 << 30) / SlumpScan::kTile;

// Returns the squared distance in plan from a column to a tool's box
// [columns^2]. Squares have the order of the roots, and stay exact.
double distance_to(const heightfield::CellRect& box, int ix, int iy) {
  const double dx = std::max({box.x0 - ix, ix - (box.x1 - 1), 0}),
               dy = std::max({box.y0 - iy, iy - (box.y1 - 1), 0});
  return dx * dx + dy * dy;
}

// Keys are (y, x), as everywhere in the exchange.
PlanKey tile_of(int ix, int iy) { return {iy / SlumpScan::kTile, ix / SlumpScan::kTile}; }

}  // namespace

// Persistent state, and the parts that work on it. The order of the members is
// that of construction: the parts need grid and ground.
struct Exchange::State {
  State(const scene::Scene& world, heightfield::Ground& ground_in, const SchemeConstants& scheme)
      : ground(ground_in),
        grid(plan_grid(world, ground_in)),
        activator(ground_in, grid, -world.gravity.z()),
        table(ground_in.setup().soils, ground_in.cell(), -world.gravity.z()),
        standing(grid),
        scan(ground_in, table, standing, world.ground.steep == scene::SteepGround::kHold),
        slump(ground_in, table),
        max_particles(static_cast<std::size_t>(std::max(world.solver.max_particles, 0))),
        active_zone(world.solver.active_zone),
        densest(scheme.min_density_state),
        seen(ground_in.sequence()) {}

  // Returns true if the motion rule must leave a column alone, because its
  // block was deposited within the last second. Where a tool stands it may
  // become active at once.
  bool rests_since_deposit(int ix, int iy, std::span<const ToolZone> zones, double time) const;
  std::set<PlanKey> tiles_to_scan(const ColumnIndex& index, std::span<const ToolZone> zones);
  void plan_slopes(const ColumnIndex& index, std::span<const ToolZone> zones, ActivationPlan& plan);
  void plan_slope(const OverSteep& found, const ColumnIndex& index, std::span<const ToolZone> zones,
                  ActivationPlan& plan);
  void fit_budget(std::span<const ToolZone> zones, std::size_t active, double time,
                  ActivationPlan& plan);
  void activate_planned(const ColumnIndex& index, const ActivationPlan& plan, Result& result);
  void deposit(const ColumnIndex& index, std::span<const ToolZone> zones,
               const ActivationPlan& plan, double time, Result& result);
  /// Deposits and marks the soil under support areas. Returns false when there
  /// is none.
  bool deposit_under(const ColumnIndex& index, std::span<const ToolZone> zones,
                     std::span<const SupportPlacement> support_areas, double time, Result& result);
  /// Applies all other rules to the particles of the index.
  void decide(const ColumnIndex& index, std::span<const ToolZone> zones,
              std::span<const SupportPlacement> support_areas, double time, double elapsed,
              Result& result);
  /// Runs a check as Exchange::check, on the particles that no tool carries: `carried` has one flag
  /// per particle, not 0 for those of tools.
  Result check(std::span<const Particle> particles, const std::vector<std::uint8_t>& carried,
               std::span<const ToolRegion> tools, double time, double elapsed,
               const Standing& around);
  int run_slump(const ColumnIndex& index, std::span<const ToolZone> zones,
                const ActivationPlan& plan, double elapsed);
  void visit(Archive& a);

  heightfield::Ground& ground;
  PlanGrid grid;
  Activator activator;
  SlumpTable table;
  StandingHeights standing;
  SlumpScan scan;
  Slump slump;
  std::size_t max_particles;
  double active_zone;
  // Lowest density state of a layer.
  double densest;
  // Number of particles that tools carry in this check, which count for the
  // budget only.
  std::size_t carried_count = 0;

  // State between checks. It is saved and hashed, together with `standing` and
  // `slump`; the rest follows from the scene. Ground sequence up to which
  // changes were noticed.
  std::uint64_t seen;
  // Changed tiles that are still to be examined.
  std::set<PlanKey> pending;
  // Position of the cyclic walk through them.
  PlanKey next_pending{0, 0};
  // [s] per block.
  RestTimes rest;
  // Time of the last deposit, per block [s].
  std::map<PlanKey, double> deposited;
  bool over_budget = false;
};

Exchange::Exchange(const scene::Scene& world, heightfield::Ground& ground,
                   const SchemeConstants& scheme)
    : state_(std::make_unique<State>(world, ground, scheme)) {}
Exchange::~Exchange() = default;

bool Exchange::State::rests_since_deposit(int ix, int iy, std::span<const ToolZone> zones,
                                          double time) const {
  const auto found = deposited.find(grid.block_of(ix, iy));
  if (found == deposited.end() || time - found->second >= kRestAfterDeposit) return false;
  return std::none_of(zones.begin(), zones.end(), [&](const ToolZone& tool) {
    return !tool.supported && tool.touches(ix, iy);
  });
}

// Returns tiles whose slopes may have changed: those with particles, and as
// many changed ones as one check can handle.
std::set<PlanKey> Exchange::State::tiles_to_scan(const ColumnIndex& index,
                                                 std::span<const ToolZone> zones) {
  const auto insert_tiles = [&](const heightfield::CellRect& rect) {
    if (rect.empty()) return;
    const PlanKey first = tile_of(rect.x0, rect.y0), last = tile_of(rect.x1 - 1, rect.y1 - 1);
    for (int ty = first.first; ty <= last.first; ++ty)
      for (int tx = first.second; tx <= last.second; ++tx) pending.insert({ty, tx});
  };
  // A rectangle around all changes since the last check. It may be larger than
  // they are, which costs time but not correctness.
  insert_tiles(ground.changed_since(seen));
  seen = ground.sequence();
  std::set<PlanKey> out;
  for (const PlanKey& block : index.blocks()) {
    // A tile is eight blocks wide, so a block extends over several tiles only
    // at its corners; the grid may be shifted against them.
    for (const int c :
         {0, kBlockCells - 1, kBlockCells * (kBlockCells - 1), kBlockCells * kBlockCells - 1}) {
      const int ix = grid.column_x(block, c), iy = grid.column_y(block, c);
      if (ground.contains(ix, iy)) out.insert(tile_of(ix, iy));
    }
  }
  // These tiles need not wait.
  for (const PlanKey& tile : out) pending.erase(tile);
  // The rest in turns, from where the last check stopped. Every changed tile is
  // examined within a bounded number of checks, in an order that depends on the
  // tiles alone.
  for (std::size_t n = 0; n < kTilesPerCheck && !pending.empty(); ++n) {
    auto next = pending.lower_bound(next_pending);
    if (next == pending.end()) next = pending.begin();
    next_pending = *next;
    out.insert(*next);
    pending.erase(next);
  }
  // What a tool holds back now is examined again when it has left.
  for (const ToolZone& tool : zones)
    if (tool.engaged) insert_tiles(tool.near);
  return out;
}

// Rule C: over-steep columns become active where soil is active or a tool
// works, and slide as columns elsewhere.
void Exchange::State::plan_slopes(const ColumnIndex& index, std::span<const ToolZone> zones,
                                  ActivationPlan& plan) {
  std::vector<OverSteep> found;
  for (const PlanKey& tile : tiles_to_scan(index, zones))
    scan.scan(tile.second, tile.first, index, zones, found);
  for (const OverSteep& slope : found) plan_slope(slope, index, zones, plan);
}

void Exchange::State::plan_slope(const OverSteep& found, const ColumnIndex& index,
                                 std::span<const ToolZone> zones, ActivationPlan& plan) {
  // Active soil in the block of any column along the drop, or in a block beside
  // it, counts as near: its particles take over what starts to slide.
  bool near = false;
  for (int l = 0; l <= found.steps; ++l) {
    const int ix = found.ix + l * found.dx, iy = found.iy + l * found.dy;
    const PlanKey block = grid.block_of(ix, iy);
    for (int by = -1; by <= 1; ++by)
      for (int bx = -1; bx <= 1; ++bx)
        near = near || index.find({block.first + by, block.second + bx}) >= 0;
    for (const ToolZone& tool : zones)
      near = near || (tool.engaged && ToolZone::contains(tool.zone, ix, iy));
  }
  // If the last check was over budget, nothing more may become active: the
  // slope slides as columns, which needs no particles.
  if (!near || over_budget) {
    slump.fail(found);
    return;
  }
  const double bottom = std::floor(found.low) - 1;
  for (int l = 0; l < found.steps; ++l) {
    const int ix = found.ix + l * found.dx, iy = found.iy + l * found.dy;
    // Lower columns in between stay.
    if ((ground.height(ix, iy) - ground.datum()) / ground.cell() > found.low)
      plan_activation(plan, ix, iy, bottom);
  }
}

// Drops the requests farthest from tools until the new particles fit the
// budget.
void Exchange::State::fit_budget(std::span<const ToolZone> zones, std::size_t active, double time,
                                 ActivationPlan& plan) {
  // An upper bound except for columns of many thin soils, so that the budget is
  // missed from below.
  const auto bound = [&](const ActivationPlan::value_type& entry) {
    const double bottom = ground.datum() + entry.second * ground.cell();
    return static_cast<std::size_t>(
        activator.particle_bound(ground.height(entry.first.second, entry.first.first) - bottom));
  };
  std::size_t sum = active;
  for (const auto& entry : plan) sum += bound(entry);
  if (sum <= max_particles) {
    over_budget = false;
    return;
  }
  struct Ranked {
    double distance;
    PlanKey column;
  };
  // The farthest from every tool goes first: the soil at a tool is what a run
  // is about. Without tools all are equally far, and the order of the columns
  // decides.
  std::vector<Ranked> ranked;
  for (const auto& entry : plan) {
    double nearest = 0;
    for (std::size_t t = 0; t < zones.size(); ++t) {
      const double d = distance_to(zones[t].box, entry.first.second, entry.first.first);
      nearest = t == 0 ? d : std::min(nearest, d);
    }
    ranked.push_back({nearest, entry.first});
  }
  // Ties are broken by the column's key, so that the same columns are dropped
  // in every run.
  std::sort(ranked.begin(), ranked.end(), [](const Ranked& a, const Ranked& b) {
    return a.distance != b.distance ? a.distance < b.distance : a.column < b.column;
  });
  const std::size_t wanted = plan.size();
  while (!ranked.empty() && sum > max_particles) {
    const auto entry = plan.find(ranked.back().column);
    sum -= bound(*entry);
    plan.erase(entry);
    ranked.pop_back();
  }
  // Log once, not at every check while it lasts.
  if (!over_budget)
    log_warning("soil: at " + std::to_string(time) + " s the active zone shrinks from " +
                std::to_string(wanted) + " to " + std::to_string(plan.size()) +
                " columns, or there would be more than " + std::to_string(max_particles) +
                " particles");
  over_budget = true;
}

// Columns become active in the order of the map, so new particles have the same
// order in every run.
void Exchange::State::activate_planned(const ColumnIndex& index, const ActivationPlan& plan,
                                       Result& result) {
  for (const auto& [column, bottom] : plan) {
    const std::size_t before = result.born.size();
    // Particles on a column load it, too. Without that, new particles would
    // settle under them.
    activator.activate(column.second, column.first, ground.datum() + bottom * ground.cell(),
                       kilograms(index.pile(column.second, column.first).mass), result.born);
    result.activated_columns += result.born.size() > before ? 1 : 0;
  }
}

void Exchange::State::deposit(const ColumnIndex& index, std::span<const ToolZone> zones,
                              const ActivationPlan& plan, double time, Result& result) {
  // New particles lie between the ground and resting particles of the same
  // blocks, or beside them.
  for (const auto& [column, bottom] : plan)
    for (int dy = -1; dy <= 1; ++dy)
      for (int dx = -1; dx <= 1; ++dx)
        rest.erase(grid.block_of(column.second + dx, column.first + dy));
  // All blocks are judged before any is deposited: a deposit must not make its
  // neighbour ready in the same check.
  std::vector<int> ready;
  for (int b = 0; b < static_cast<int>(index.blocks().size()); ++b)
    if (may_deposit(ground, index, zones, rest, b)) ready.push_back(b);
  std::set<PlanKey> done;
  for (const int b : Depositor(ground, index, densest).deposit(ready, rest)) {
    const PlanKey key = index.blocks()[static_cast<std::size_t>(b)];
    // Flagged, not erased: the solver compacts its arrays itself.
    for (const std::uint32_t i : index.block(b)) result.removed[i] = 1;
    rest.erase(key);
    deposited[key] = time;
    done.insert(key);
    ++result.deposited_blocks;
  }
  standing.remember(ground, index, done);
  // Older entries have no effect; dropping them keeps the list as short as a
  // second of digging.
  std::erase_if(deposited,
                [&](const auto& entry) { return time - entry.second >= kRestAfterDeposit; });
}

int Exchange::State::run_slump(const ColumnIndex& index, std::span<const ToolZone> zones,
                               const ActivationPlan& plan, double elapsed) {
  // A column slides only while nothing rests on it, nothing is to become active
  // in it, and no tool stands in it: particles and shells would not notice that
  // the ground below them is gone. Nor does a column under a tyre slide: the
  // tyre would press the soil again, for ever.
  const auto blocked = [&](int ix, int iy) {
    if (ground.held(ix, iy)) return true;
    if (!index.column(ix, iy).empty() || plan.count({iy, ix}) != 0) return true;
    const double top = (ground.height(ix, iy) - ground.datum()) / ground.cell();
    return std::any_of(zones.begin(), zones.end(), [&](const ToolZone& tool) {
      return tool.touches(ix, iy) && (tool.supported || tool.low < top);
    });
  };
  return slump.run(elapsed, blocked);
}

bool Exchange::State::deposit_under(const ColumnIndex& index, std::span<const ToolZone> zones,
                                    std::span<const SupportPlacement> support_areas, double time,
                                    Result& result) {
  if (support_areas.empty() || index.count() == 0) return false;
  std::set<PlanKey> blocks;
  result.support_columns =
      SupportDeposit(ground, index, zones, densest).deposit(support_areas, result.removed, blocks);
  // Motion beside a wheel does not activate at once what was deposited under
  // it.
  for (const PlanKey& block : blocks) deposited[block] = time;
  return result.support_columns > 0;
}

void Exchange::State::decide(const ColumnIndex& index, std::span<const ToolZone> zones,
                             std::span<const SupportPlacement> support_areas, double time,
                             double elapsed, Result& result) {
  // The plan collects all three rules before anything changes. Several may ask
  // for one column; the deepest request counts.
  ActivationPlan plan;
  activate_ahead_of_tools(ground, zones, plan);
  activate_around_motion(
      ground, index, motion_threshold(zones), zones,
      [&](int ix, int iy) { return !rests_since_deposit(ix, iy, zones, time); }, plan);
  plan_slopes(index, zones, plan);
  // Soil under a wheel would be deposited again at the next check, and the
  // wheel would have fallen meanwhile.
  std::erase_if(plan, [&](const ActivationPlan::value_type& entry) {
    return supports_machine(ground, index, zones, support_areas, entry.first.second,
                            entry.first.first);
  });
  fit_budget(zones, index.count() + carried_count, time, plan);

  update_rest(index, elapsed, rest);
  // Deposition comes before activation, because it refers to the given
  // particles: new ones are not among them. Columns slide last, on ground that
  // has both.
  deposit(index, zones, plan, time, result);
  activate_planned(index, plan, result);
  result.slumped_columns = run_slump(index, zones, plan, elapsed);
}

Exchange::Result Exchange::State::check(std::span<const Particle> particles,
                                        const std::vector<std::uint8_t>& carried,
                                        std::span<const ToolRegion> tools, double time,
                                        double elapsed, const Standing& around) {
  Result result;
  result.removed.assign(particles.size(), 0);
  const ColumnIndex index(particles, ground, grid, carried);
  const std::vector<ToolZone> zones = tool_zones(ground, index, tools, active_zone);
  const std::vector<SupportPlacement> support_areas =
      support_placements(around.support_areas, ground, around.interval);
  if (!deposit_under(index, zones, support_areas, time, result)) {
    decide(index, zones, support_areas, time, elapsed, result);
    return result;
  }
  // The other rules see the ground with the deposited soil, and the particles
  // without it.
  std::vector<std::uint8_t> gone = carried;
  for (std::size_t i = 0; i < gone.size(); ++i) gone[i] |= result.removed[i];
  const ColumnIndex left(particles, ground, grid, gone);
  decide(left, tool_zones(ground, left, tools, active_zone), support_areas, time, elapsed, result);
  return result;
}

Exchange::Result Exchange::check(std::span<const Particle> particles,
                                 std::span<const ToolRegion> tools, double time, double elapsed,
                                 const Standing& standing) {
  State& s = *state_;
  const std::vector<std::uint8_t> carried = carried_load(s.ground, s.grid, particles, tools);
  s.carried_count =
      particles.size() - static_cast<std::size_t>(std::count(carried.begin(), carried.end(), 0));
  return s.check(particles, carried, tools, time, elapsed, standing);
}

std::vector<Particle> Exchange::activate(const heightfield::CellRect& rect, double z_bottom,
                                         std::span<const Particle> resting) {
  State& s = *state_;
  std::vector<Particle> born;
  const ColumnIndex index(resting, s.ground, s.grid);
  // In the ground's own order of rows, so that new particles come in the same
  // order in every run.
  for (int iy = std::max(rect.y0, 0); iy < std::min(rect.y1, s.ground.ny()); ++iy)
    for (int ix = std::max(rect.x0, 0); ix < std::min(rect.x1, s.ground.nx()); ++ix)
      s.activator.activate(ix, iy, z_bottom, kilograms(index.pile(ix, iy).mass), born);
  return born;
}

void Exchange::State::visit(Archive& a) {
  a("rest", rest);
  a("deposited", deposited);
  a("pending", pending);
  a("next_pending", next_pending);
  a("seen", seen);
  a("over_budget", over_budget);
  a("standing", standing);
  a("slump", slump);
  // Times that are not numbers would keep blocks active or at rest for ever.
  for (const auto& [block, time] : rest) a.require(std::isfinite(time), "rest", "must be finite");
  for (const auto& [block, time] : deposited)
    a.require(std::isfinite(time), "deposited", "must be finite");
  const auto near = [](int tile) { return tile >= -kFarthestTile && tile <= kFarthestTile; };
  for (const PlanKey& tile : pending)
    a.require(near(tile.first) && near(tile.second), "pending", "lies off any site");
}

void Exchange::visit(Archive& a) {
  a.section("soil-exchange", 2, [&] { state_->visit(a); });
}

}  // namespace navvy::soil
