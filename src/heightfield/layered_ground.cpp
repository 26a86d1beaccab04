// SPDX-License-Identifier: Apache-2.0
// Checks, changes, counts and saves columns. terrain.cpp reads their visible state, tiles.cpp
// stores them, column.cpp changes a single one.
#include "heightfield/layered_ground.h"

#include <algorithm>
#include <cmath>
#include <mutex>
#include <utility>

#include "core/archive.h"
#include "core/error.h"
#include "heightfield/change_log.h"
#include "heightfield/column.h"
#include "heightfield/terrain_view.h"
#include "heightfield/tiles.h"

namespace navvy::heightfield {
namespace {

// Rut zone: the top two cells carry most of the compaction by a tyre. tuned:
// Ground.CompactsTheTopFirstAndKeepsMass
constexpr double kCompactionCells = 2.0;

/// Collects all faults of a setup, so that one message reports them.
class SetupCheck {
 public:
  void require(bool good, const std::string& element, const std::string& value,
               const std::string& rule, const std::string& remedy = "") {
    if (!good) faults_.push_back({Fault::Severity::kError, "", 0, element, value, rule, remedy});
  }
  void finish() {
    if (!faults_.empty()) throw InputError(std::move(faults_));
  }

 private:
  std::vector<Fault> faults_;
};

// Every layer must name a soil and have a thickness; that of the last layer does not count.
void check_layers(const Ground::Setup& setup, const std::vector<scene::GroundLayer>& layers,
                  SetupCheck& check) {
  check.require(!layers.empty(), "ground/layers", "", "needs at least one layer",
                "add a navvy:layer");
  for (const scene::GroundLayer& layer : layers) {
    const bool known =
        std::any_of(setup.soils.begin(), setup.soils.end(),
                    [&](const scene::Soil& soil) { return soil.name == layer.soil; });
    check.require(known, "ground/layer/soil", layer.soil, "no soil of this name",
                  "name one of the scene's soils");
    check.require(std::isfinite(layer.thickness) && layer.thickness >= 0, "ground/layer/thickness",
                  std::to_string(layer.thickness), "must be a finite length >= 0 m");
  }
}

// Returns the setup unchanged, or throws one error with every fault.
Ground::Setup checked(Ground::Setup setup) {
  SetupCheck check;
  // Columns are numbered with int; 2^30 per side would be 100 000 km of 0.1 m cells.
  const int most = 1 << 30;
  check.require(setup.nx > 0 && setup.nx <= most && setup.ny > 0 && setup.ny <= most, "ground/size",
                std::to_string(setup.nx) + " x " + std::to_string(setup.ny) + " columns",
                "needs at least one column");
  check.require(std::isfinite(setup.cell) && setup.cell > 0, "ground/cell",
                std::to_string(setup.cell), "must be a finite length > 0 m");
  check.require(std::isfinite(setup.datum) && setup.origin.allFinite(), "ground/origin", "",
                "datum and origin must be finite");
  // The answers of the source are checked column by column on reading.
  check.require(setup.surface != nullptr, "ground/surface", "", "a source of heights is needed");
  check.require(!setup.soils.empty() && setup.soils.size() < 65536, "ground/soils",
                std::to_string(setup.soils.size()), "needs 1 to 65535 soils");
  for (const scene::Soil& soil : setup.soils)
    check.require(std::isfinite(soil.bank_density) && soil.bank_density > 0,
                  "soil[" + soil.name + "]/bank_density", std::to_string(soil.bank_density),
                  "must be > 0 kg/m3");
  check_layers(setup, setup.layers, check);
  for (const scene::GroundPatch& patch : setup.patches) check_layers(setup, patch.layers, check);
  check.finish();
  return setup;
}

}  // namespace

struct Ground::State {
  explicit State(const std::shared_ptr<const StartSite>& site) : tiles(site) {}
  Tiles tiles;
  ChangeLog changes;
  std::set<std::int64_t> held;  // iy * nx + ix
  std::mutex view;              // views may be taken from several threads
};

Ground::Ground(Setup setup)
    : Terrain(
          std::make_shared<StartHeights>(std::make_shared<StartSite>(checked(std::move(setup))))),
      state_(std::make_unique<State>(start_->shared_site())) {}
// Defined here, where State is complete.
Ground::~Ground() = default;
Ground::Ground(Ground&&) noexcept = default;
Ground& Ground::operator=(Ground&&) noexcept = default;

std::size_t Ground::touched_tiles() const { return state_->tiles.touched().size(); }

// Writing outside the site is an error of the caller; reading there is allowed.
void Ground::require_inside(int ix, int iy) const {
  if (!contains(ix, iy))
    throw Error("Ground: column (" + std::to_string(ix) + ", " + std::to_string(iy) +
                ") is outside the site of " + std::to_string(nx()) + " x " + std::to_string(ny()));
}

// Called after every change of the layers of a column.
void Ground::changed(int ix, int iy) {
  state_->tiles.update_surface(ix, iy, table_, *start_);
  state_->changes.add(ix, iy);
  sequence_ = state_->changes.sequence();
  // Reading must not discard cached heights, as others may be reading them. Here no one else reads,
  // and views keep their tiles.
  if (start_->worn()) start_ = std::make_shared<StartHeights>(start_->shared_site());
}

TerrainView Ground::view(double time) const {
  // Marks tiles as shared, which is why views are taken one at a time; readers of the ground are
  // not affected.
  const std::lock_guard lock(state_->view);
  table_.freeze();
  return TerrainView(*this, time);
}

void Ground::column(int ix, int iy, std::vector<SoilLayer>& out) const {
  require_inside(ix, iy);
  // Only changed columns are stored; the source computes all others.
  const Column* found = state_->tiles.find_column(ix, iy);
  if (found != nullptr)
    out = *found;
  else
    start_->site().column(ix, iy, out);
}

void Ground::start_column(int ix, int iy, std::vector<SoilLayer>& out) const {
  require_inside(ix, iy);
  start_->site().column(ix, iy, out);
}

std::vector<SoilLayer> Ground::layers(int ix, int iy) const {
  Column out;
  column(ix, iy, out);
  return out;
}

void Ground::take_above(int ix, int iy, double z, std::vector<SoilLayer>& taken) {
  require_inside(ix, iy);
  // There is nothing above: the column must not even be touched. This includes z that is NaN.
  if (!(z < height(ix, iy))) return;
  heightfield::take_above(state_->tiles.touch_column(ix, iy), z - datum(), state_->tiles.unit(),
                          taken);
  changed(ix, iy);
}

void Ground::put(int ix, int iy, const SoilLayer& layer) {
  require_inside(ix, iy);
  // Exchanges that round to no unit often add nothing; a negative mass is an error of the caller.
  if (layer.mass == 0) return;
  if (layer.mass < 0 || layer.soil >= setup().soils.size() ||
      !std::isfinite(layer.specific_volume) || !(layer.specific_volume > 0) ||
      !std::isfinite(layer.plastic_shear))
    throw Error("Ground::put: a layer of soil " + std::to_string(layer.soil) + ", mass " +
                std::to_string(layer.mass) + " units, specific volume " +
                std::to_string(layer.specific_volume) + " is not soil");
  heightfield::put(state_->tiles.touch_column(ix, iy), layer);
  changed(ix, iy);
}

void Ground::compact_to(int ix, int iy, double height_wanted, float min_specific_volume) {
  require_inside(ix, iy);
  // Ruts request any height; only soil above it takes work.
  const double drop = height(ix, iy) - height_wanted;
  if (!(drop > 0) || !(min_specific_volume > 0)) return;
  // Pressed by this distance and not to that height: the rut law gives the drop.
  compact(state_->tiles.touch_column(ix, iy), drop, kCompactionCells * cell(), min_specific_volume,
          state_->tiles.unit());
  changed(ix, iy);
}

void Ground::hold(std::set<std::int64_t> columns) {
  const auto place = [&](std::int64_t key) {
    return Vec2i(static_cast<int>(key % nx()), static_cast<int>(key / nx()));
  };
  // Keys ascend, so checking the first and the last suffices.
  if (!columns.empty() &&
      (*columns.begin() < 0 || *columns.rbegin() >= static_cast<std::int64_t>(nx()) * ny()))
    throw Error("Ground::hold: a column is outside the site of " + std::to_string(nx()) + " x " +
                std::to_string(ny()));
  // The columns themselves have not changed, but what may happen to them has; readers of changes
  // need no more.
  for (const std::int64_t key : state_->held)
    if (columns.count(key) == 0) state_->changes.add(place(key).x(), place(key).y());
  sequence_ = state_->changes.sequence();
  state_->held = std::move(columns);
}

void Ground::hold_more(const std::set<std::int64_t>& columns) {
  std::set<std::int64_t> all = state_->held;
  all.insert(columns.begin(), columns.end());
  hold(std::move(all));
}

bool Ground::held(int ix, int iy) const {
  return !state_->held.empty() &&
         state_->held.count(static_cast<std::int64_t>(iy) * nx() + ix) != 0;
}

std::vector<std::int64_t> Ground::mass_change() const {
  // Integers are exact: the ledger of a run must be zero, not nearly zero.
  std::vector<std::int64_t> sum = state_->tiles.start_mass();
  for (std::int64_t& mass : sum) mass = -mass;
  for (const auto& [key, tile] : state_->tiles.touched())
    for (const Column& column : tile->columns)
      for (const SoilLayer& layer : column) sum[layer.soil] += layer.mass;
  return sum;
}

CellRect Ground::changed_since(std::uint64_t sequence) const {
  return state_->changes.since(sequence, site_rect());
}

CellRect Ground::touched_rect() const {
  // Whole tiles, clipped at the edge of the site.
  CellRect rect;
  for (const auto& [key, tile] : state_->tiles.touched()) {
    const int x = static_cast<int>(key % state_->tiles.tiles_x()) * kTileSide;
    const int y = static_cast<int>(key / state_->tiles.tiles_x()) * kTileSide;
    rect.include(CellRect{x, y, std::min(x + kTileSide, nx()), std::min(y + kTileSide, ny())});
  }
  return rect;
}

// The order of the fields is part of the snapshot format.
void Ground::visit(Archive& a) {
  const Setup& s = setup();
  a.section("ground", 3, [&] {
    constexpr const char* kRule = "the site has another size or datum";
    a.constant("nx", s.nx, kRule);
    a.constant("ny", s.ny, kRule);
    a.constant("cell", s.cell, kRule);
    a.constant("datum", s.datum, kRule);
    // Layers suffice: heights and initial columns follow from them and from the source.
    a("tiles", state_->tiles);
    a("held", state_->held);
    const std::int64_t columns = static_cast<std::int64_t>(nx()) * ny();
    a.require(
        state_->held.empty() || (*state_->held.begin() >= 0 && *state_->held.rbegin() < columns),
        "held", "a column is off the site");
    // Includes the number and the list of edits, so that a resumed run sees the same changes as one
    // that never stopped.
    a("changes", state_->changes);
    a.require(state_->changes.lies_in(site_rect()), "changes", "an edit is outside the site");
  });
  if (!a.loading()) return;
  // Existing views keep their tiles; the table is rebuilt.
  table_.clear();
  state_->tiles.update_surfaces(table_, *start_);
  sequence_ = state_->changes.sequence();
}

}  // namespace navvy::heightfield
