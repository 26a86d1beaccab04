// SPDX-License-Identifier: Apache-2.0
#include "session/forbidden_watch.h"

#include <algorithm>
#include <array>
#include <cstdio>
#include <map>
#include <utility>

#include "control/watch.h"
#include "core/log.h"
#include "session/spill_area.h"
#include "sim/timing.h"
#include "sim/world_terrain.h"

namespace navvy::session {
namespace {

/// Measurements of the soil per simulated second: each is a pass over the particles.
constexpr double kSoilRate = 2;
/// Depth of a gain that counts, in cells: less is rounding of activated and deposited columns.
constexpr double kLeastGain = 0.05;

std::string quoted_name(const sim::World& world, int machine) {
  return "'" + world.machines().at(machine).name() + "'";
}

/// Returns true if the scene forbids the event with this name.
bool is_forbidden(const scene::Forbidden& forbidden, const std::string& event) {
  return (event == "collision" && forbidden.collision) ||
         (event == "off_site" && forbidden.off_site) || (event == "tip" && forbidden.tip) ||
         (event == "buried" && forbidden.buried) ||
         (event == "spill_outside" && forbidden.spill.has_value());
}

double mass_of(const std::vector<heightfield::SoilLayer>& column) {
  double sum = 0;
  for (const heightfield::SoilLayer& layer : column) sum += kilograms(layer.mass);
  return sum;
}

}  // namespace

std::string ForbiddenEvent::text() const {
  std::array<char, 32> when{};
  std::snprintf(when.data(), when.size(), " (%.2f s)", time);
  return "forbidden event " + event + ": " + reason + when.data();
}

void ForbiddenEvent::visit(Archive& a) {
  a("event", event);
  a("reason", reason);
  a("time", time);
}

ForbiddenWatch::ForbiddenWatch(const sim::World& world)
    : forbidden_(world.description().forbidden),
      was_on_site_(world.description().machines.size()) {}

bool ForbiddenWatch::needs_states() const { return forbidden_.tip || forbidden_.buried; }

void ForbiddenWatch::note(const sim::World& world, const char* event, const std::string& reason) {
  event_ = ForbiddenEvent{event, reason, world.time()};
  log(LogLevel::kError, event_->text() + ": the run ends, as the scene's <navvy:forbid> asks");
}

void ForbiddenWatch::look(const sim::World& world, const CollisionWatch& collisions,
                          const std::vector<MachineOutcome>& states, bool last) {
  if (event_ || !forbidden_.any()) return;
  // A resumed run lists collisions from before; only one of this step ends it.
  if (forbidden_.collision && collisions.touching())
    return note(world, "collision", text_of(*collisions.touching(), world));
  for (const MachineOutcome& one : states) {
    const bool tipped = one.state == control::StepState::kTipped;
    if (tipped ? !forbidden_.tip : !forbidden_.buried || one.state != control::StepState::kBuried)
      continue;
    return note(world, tipped ? "tip" : "buried",
                quoted_name(world, one.machine) + ": " + one.reason);
  }
  if (forbidden_.off_site) look_at_border(world);
  if (event_ || !forbidden_.spill) return;
  if (last || sim::sample_due(world.steps(), world.dt(), kSoilRate)) look_at_soil(world);
}

void ForbiddenWatch::look_at_border(const sim::World& world) {
  for (int m = 0; m < world.machines().count(); ++m) {
    // Structures around the site stand where they are.
    if (world.machines().at(m).description().fixed_base) continue;
    std::uint8_t& was = was_on_site_[static_cast<std::size_t>(m)];
    const Vec3 p = world.machines().at(m).link(0).pose().translation();
    const bool is = !control::is_off_site(world.ground(), p);
    if (was != 0 && !is)
      return note(world, "off_site",
                  "the base of " + quoted_name(world, m) + " is beyond the border of the site");
    was = is ? 1 : 0;
  }
}

/// Marks all columns at the first call.
bool ForbiddenWatch::is_allowed(const sim::World& world, int ix, int iy) {
  const std::vector<scene::SpillArea>& areas = forbidden_.spill->areas;
  if (areas.empty()) return true;
  const heightfield::Terrain& site = world.ground();
  const auto nx = static_cast<std::size_t>(site.nx()), ny = static_cast<std::size_t>(site.ny());
  if (allowed_.empty()) {
    allowed_.resize(nx * ny);
    for (const scene::SpillArea& area : areas)
      mark_inside(area.polygon, {site.origin(), site.cell(), site.nx(), site.ny()}, allowed_);
  }
  return allowed_[static_cast<std::size_t>(iy) * nx + static_cast<std::size_t>(ix)] != 0;
}

/// Only columns that were touched, or on which soil fell, can have gained mass.
void ForbiddenWatch::look_at_soil(const sim::World& world) {
  const heightfield::Ground& ground = world.ground();
  const heightfield::LooseSoil loose = sim::active_places(world).on_ground;
  std::map<std::pair<int, int>, double> active;
  for (const heightfield::LooseGrain& grain : loose.grains())
    active[{grain.ix, grain.iy}] += kilograms(grain.mass);
  heightfield::CellRect rect = ground.touched_rect();
  for (const heightfield::LooseSoil::Column& column : loose.columns())
    rect.include({column.ix, column.iy, column.ix + 1, column.iy + 1});
  const double column_volume = kLeastGain * ground.cell() * ground.cell() * ground.cell();
  double outside = 0, left = 0;
  std::vector<heightfield::SoilLayer> now, start;
  for (int iy = std::max(rect.y0, 0); iy < std::min(rect.y1, ground.ny()); ++iy)
    for (int ix = std::max(rect.x0, 0); ix < std::min(rect.x1, ground.nx()); ++ix) {
      if (is_allowed(world, ix, iy)) continue;
      ground.column(ix, iy, now);
      ground.start_column(ix, iy, start);
      const auto above = active.find({ix, iy});
      const double gain =
          mass_of(now) + (above == active.end() ? 0.0 : above->second) - mass_of(start);
      const auto soil = static_cast<std::size_t>(ground.surface_soil(ix, iy));
      if (gain > column_volume * ground.setup().soils[soil].bank_density) outside += gain;
    }
  for (const std::int64_t mass : world.soil().mass_ledger().left_site) left += kilograms(mass);
  if (outside + left <= forbidden_.spill->mass) return;
  std::array<char, 160> text{};
  std::snprintf(text.data(), text.size(),
                "%.4g kg of soil rest outside the areas and %.4g kg have left the site; %.4g kg "
                "are allowed",
                outside, left, forbidden_.spill->mass);
  note(world, "spill_outside", text.data());
}

void ForbiddenWatch::visit(Archive& a) {
  a("event", event_);
  // A run that is resumed with a scene that does not forbid this event continues.
  if (a.loading() && event_ && !is_forbidden(forbidden_, event_->event)) event_.reset();
  // As many as the scene has machines.
  a.fixed("was_on_site", was_on_site_);
}

}  // namespace navvy::session
