// SPDX-License-Identifier: Apache-2.0
#include "sim/visible_soil.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <optional>
#include <span>
#include <tuple>
#include <utility>

#include "sim/column_list.h"
#include "sim/world_parts.h"

namespace navvy::sim {

struct VisibleSoil::State {
  explicit State(const World& w) : world(w) {
    for (const auto& soil : world.description().soils)
      bank_volume.push_back(kilograms(1) / soil.bank_density);
  }

  Vec3 place(const ListedParticle& one) const {
    return parts(world).soil.grid_origin() + world.ground().cell() * places[one.particle].grid;
  }
  double volume(const ListedParticle& one) const {
    const soil::ParticlePlace& p = places[one.particle];
    return p.mass * static_cast<double>(p.j0) * bank_volume[p.soil];
  }
  void add_ball(const ListedParticle& one) {
    // Most particles are as large as the one before.
    if (const double v = volume(one); v != ball_volume) {
      ball_volume = v;
      ball_radius = std::cbrt(static_cast<float>(v) * static_cast<float>(0.75 / kPi));
    }
    balls.push_back({(place(one) - origin).cast<float>(), ball_radius});
  }
  void stack();
  void take_column(std::span<ListedParticle> column, const std::function<bool(const Vec3&)>& holds);

  const World& world;
  std::vector<double> bank_volume;  ///< volume of a unit of mass in bank state, by soil [m3]
  std::optional<heightfield::TerrainView> surface;
  Vec3 origin = Vec3::Zero();
  std::vector<SoilBall> balls;
  std::vector<ListedParticle> low;  ///< particles that may be part of the surface, column by column
  std::vector<soil::ParticlePlace> places;
  ColumnList list;
  double ball_volume = -1;  ///< volume of the last ball [m3]
  float ball_radius = 0;    ///< radius of the last ball [m]
};

/// Divides the particles of one column into balls and those that may be part of the surface.
void VisibleSoil::State::take_column(std::span<ListedParticle> column,
                                     const std::function<bool(const Vec3&)>& holds) {
  const heightfield::Terrain& ground = *surface;
  const int nx = ground.nx(), ix = static_cast<int>(column.front().column) % nx,
            iy = static_cast<int>(column.front().column) / nx;
  // Loose soil cannot be higher than all particles of the column together, so that those far above
  // need neither be sorted nor compared with tools: a full bed is high above its columns.
  double volumes = 0;
  for (const ListedParticle& one : column) volumes += volume(one);
  const double highest = ground.height(ix, iy) + heightfield::kLooseGap * ground.cell() +
                         volumes / (ground.cell() * ground.cell());
  const auto above = std::partition(column.begin(), column.end(),
                                    [&](const ListedParticle& one) { return one.z < highest; });
  std::for_each(above, column.end(), [&](const ListedParticle& one) { add_ball(one); });
  std::sort(column.begin(), above, [&](const ListedParticle& a, const ListedParticle& b) {
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
  const auto column_of = [&](const ListedParticle& one) {
    return Vec2i(static_cast<int>(one.column % nx), static_cast<int>(one.column / nx));
  };
  std::vector<heightfield::LooseGrain> grains;
  grains.reserve(low.size());
  for (const ListedParticle& one : low) {
    const soil::ParticlePlace& p = places[one.particle];
    const Vec2i at = column_of(one);
    grains.push_back({at.x(), at.y(), one.z, volume(one), p.soil, p.j0, p.mass});
  }
  surface.emplace(surface->with(heightfield::LooseSoil(*surface, std::move(grains))));
  // Particles below the surface are what makes it up.
  for (const ListedParticle& one : low) {
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
  s.list.take(s.world, s.places, [](const soil::ParticlePlace&) { return true; });
  std::vector<ListedParticle>& list = s.list.particles();
  // A corner of the first column: the same whichever of its particles is listed first.
  const Vec3& first = s.places[list.front().particle].grid;
  s.origin = parts(s.world).soil.grid_origin() +
             s.world.ground().cell() * Vec3(std::floor(first.x()), std::floor(first.y()), 0);
  s.low.clear();
  const std::function<bool(const Vec3&)> holds = parts(s.world).coupling.holding();
  for (std::size_t from = 0, to = 0; from < list.size(); from = to) {
    while (to < list.size() && list[to].column == list[from].column) ++to;
    const std::span<ListedParticle> column = std::span(list).subspan(from, to - from);
    if (column.front().column != ListedParticle::kBeyond)
      s.take_column(column, holds);
    else
      for (const ListedParticle& one : column) s.add_ball(one);
  }
  s.stack();
}

const heightfield::TerrainView& VisibleSoil::surface() const { return *state_->surface; }
const Vec3& VisibleSoil::origin() const { return state_->origin; }
const std::vector<SoilBall>& VisibleSoil::balls() const { return state_->balls; }

}  // namespace navvy::sim
