// SPDX-License-Identifier: Apache-2.0
#include "sim/visible_soil.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <limits>
#include <optional>
#include <span>
#include <tuple>
#include <utility>

#include "sim/world_parts.h"

namespace navvy::sim {
namespace {

// Column of particles beyond the edge of the site: it sorts behind all others.
constexpr std::uint32_t kBeyond = std::numeric_limits<std::uint32_t>::max();

/// A particle in its column.
struct Listed {
  std::uint32_t column;    ///< number of the column, row by row, or kBeyond
  std::uint32_t particle;  ///< index of the particle
  double z;                ///< height in W [m]
};

/// Sorts by column, in passes of 11 bits; `spare` is memory. A pass in which all digits are equal
/// is left out.
void sort_by_column(std::vector<Listed>& list, std::vector<Listed>& spare) {
  constexpr int kBits = 11;
  std::array<std::uint32_t, 1 << kBits> count;
  for (int shift = 0; shift < 32; shift += kBits) {
    const auto digit = [shift](const Listed& one) {
      return (one.column >> shift) & ((1u << kBits) - 1);
    };
    count.fill(0);
    for (const Listed& one : list) ++count[digit(one)];
    if (!list.empty() && count[digit(list.front())] == list.size()) continue;
    std::uint32_t sum = 0;
    for (std::uint32_t& each : count) sum += std::exchange(each, sum);
    spare.resize(list.size());
    for (const Listed& one : list) spare[count[digit(one)]++] = one;
    list.swap(spare);
  }
}

}  // namespace

struct VisibleSoil::State {
  explicit State(const World& w) : world(w) {
    for (const auto& soil : world.description().soils)
      bank_volume.push_back(kilograms(1) / soil.bank_density);
  }

  Vec3 place(const Listed& one) const {
    return parts(world).soil.grid_origin() + world.ground().cell() * places[one.particle].grid;
  }
  double volume(const Listed& one) const {
    const soil::ParticlePlace& p = places[one.particle];
    return p.mass * static_cast<double>(p.j0) * bank_volume[p.soil];
  }
  void add_ball(const Listed& one) {
    // Most particles are as large as the one before.
    if (const double v = volume(one); v != ball_volume) {
      ball_volume = v;
      ball_radius = std::cbrt(static_cast<float>(v) * static_cast<float>(0.75 / kPi));
    }
    balls.push_back({(place(one) - origin).cast<float>(), ball_radius});
  }
  void list_particles();
  void stack();
  void take_column(std::span<Listed> column, const std::function<bool(const Vec3&)>& holds);

  const World& world;
  std::vector<double> bank_volume;  ///< volume of a unit of mass in bank state, by soil [m3]
  std::optional<heightfield::TerrainView> surface;
  Vec3 origin = Vec3::Zero();
  std::vector<SoilBall> balls;
  std::vector<Listed> low;  ///< particles that may be part of the surface, column by column
  std::vector<soil::ParticlePlace> places;
  std::vector<Listed> list, spare;
  double ball_volume = -1;  ///< volume of the last ball [m3]
  float ball_radius = 0;    ///< radius of the last ball [m]
};

void VisibleSoil::State::list_particles() {
  const heightfield::Ground& ground = world.ground();
  const soil::PlanGrid& grid = parts(world).soil.grid();
  const double cell = ground.cell(), bottom = parts(world).soil.grid_origin().z();
  list.resize(places.size());
  for (std::size_t i = 0; i < places.size(); ++i) {
    const Vec3& p = places[i].grid;
    const int ix = grid.x + static_cast<int>(std::floor(p.x())),
              iy = grid.y + static_cast<int>(std::floor(p.y()));
    const bool inside = ground.contains(ix, iy);
    list[i] = {inside ? static_cast<std::uint32_t>(iy) * static_cast<std::uint32_t>(ground.nx()) +
                            static_cast<std::uint32_t>(ix)
                      : kBeyond,
               static_cast<std::uint32_t>(i), bottom + cell * p.z()};
  }
  sort_by_column(list, spare);
}

/// Divides the particles of one column into balls and those that may be part of the surface.
void VisibleSoil::State::take_column(std::span<Listed> column,
                                     const std::function<bool(const Vec3&)>& holds) {
  const heightfield::Terrain& ground = *surface;
  const int nx = ground.nx(), ix = static_cast<int>(column.front().column) % nx,
            iy = static_cast<int>(column.front().column) / nx;
  // Loose soil cannot be higher than all particles of the column together, so that those far above
  // need neither be sorted nor compared with tools: a full bed is high above its columns.
  double volumes = 0;
  for (const Listed& one : column) volumes += volume(one);
  const double highest = ground.height(ix, iy) + heightfield::kLooseGap * ground.cell() +
                         volumes / (ground.cell() * ground.cell());
  const auto above = std::partition(column.begin(), column.end(),
                                    [&](const Listed& one) { return one.z < highest; });
  std::for_each(above, column.end(), [&](const Listed& one) { add_ball(one); });
  std::sort(column.begin(), above, [&](const Listed& a, const Listed& b) {
    return std::tie(a.z, places[a.particle].id) < std::tie(b.z, places[b.particle].id);
  });
  for (auto one = column.begin(); one != above; ++one)
    // Soil in a tool above a column is not on the column, however close it is.
    if (holds(place(*one)))
      add_ball(*one);
    else
      low.push_back(*one);
}

/// Stacks the particles that are left on the columns.
void VisibleSoil::State::stack() {
  const auto nx = static_cast<std::uint32_t>(surface->nx());
  const auto column_of = [&](const Listed& one) {
    return Vec2i(static_cast<int>(one.column % nx), static_cast<int>(one.column / nx));
  };
  std::vector<heightfield::LooseGrain> grains;
  grains.reserve(low.size());
  for (const Listed& one : low) {
    const soil::ParticlePlace& p = places[one.particle];
    const Vec2i at = column_of(one);
    grains.push_back({at.x(), at.y(), one.z, volume(one), p.soil, p.j0, p.mass});
  }
  surface.emplace(surface->with(heightfield::LooseSoil(*surface, std::move(grains))));
  // Particles below the surface are what makes it up.
  for (const Listed& one : low) {
    const Vec2i at = column_of(one);
    if (one.z > surface->height(at.x(), at.y())) add_ball(one);
  }
}

VisibleSoil::VisibleSoil(const World& world) : state_(std::make_unique<State>(world)) {}
VisibleSoil::~VisibleSoil() = default;

void VisibleSoil::update() {
  State& s = *state_;
  s.surface.emplace(s.world.ground().view(s.world.time()));
  s.balls.clear();
  parts(s.world).soil.places(s.places);
  if (s.places.empty()) return;
  s.list_particles();
  // A corner of the first column: the same whichever of its particles is listed first.
  const Vec3& first = s.places[s.list.front().particle].grid;
  s.origin = parts(s.world).soil.grid_origin() +
             s.world.ground().cell() * Vec3(std::floor(first.x()), std::floor(first.y()), 0);
  s.low.clear();
  const std::function<bool(const Vec3&)> holds = parts(s.world).coupling.holding();
  for (std::size_t from = 0, to = 0; from < s.list.size(); from = to) {
    while (to < s.list.size() && s.list[to].column == s.list[from].column) ++to;
    const std::span<Listed> column = std::span(s.list).subspan(from, to - from);
    if (column.front().column != kBeyond)
      s.take_column(column, holds);
    else
      for (const Listed& one : column) s.add_ball(one);
  }
  s.stack();
}

const heightfield::TerrainView& VisibleSoil::surface() const { return *state_->surface; }
const Vec3& VisibleSoil::origin() const { return state_->origin; }
const std::vector<SoilBall>& VisibleSoil::balls() const { return state_->balls; }

}  // namespace navvy::sim
