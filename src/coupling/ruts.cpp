// SPDX-License-Identifier: Apache-2.0
#include "coupling/ruts.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "coupling/ground_view.h"
#include "terramechanics/bearing.h"
#include "terramechanics/plate.h"
#include "terramechanics/tyre_patch.h"

namespace navvy::coupling {
namespace {

constexpr double kStays = 1e-3;  // [m] negligible distance
// [s] several periods of a bouncing tyre (3 to 4 Hz); a machine sinks within a second. tuned:
// RideSoil.LoadsStayEvenInItsOwnRutForAnyCell
constexpr double kBearingTime = 0.3;

}  // namespace

// Excess soil leaves the column before the rest is compacted to its new height.
void Ruts::press_column(const PushedSoil::Place& place, double pressure, const Press& press) {
  const int ix = place.ix, iy = place.iy;
  const scene::Soil& soil = ground_.setup().soils[ground_.surface_soil(ix, iy)];
  const std::int64_t key = static_cast<std::int64_t>(iy) * ground_.nx() + ix;
  Memory& memory = memory_.at(ix, iy);
  const double height = ground_.height(ix, iy);
  memory.history.find(height);
  // Another pass begins when a tyre arrives on the column, not while one stays.
  if (under_.insert(key).second && !ground_.held(ix, iy)) {
    memory.sinking = {};
    memory.history.arrive(soil);
  }
  // Slip increases the sinkage like this factor on the pressure.
  const double softer = std::pow(press.softer, soil.bekker_n);
  const double width = press.patch.width;
  const auto [before, drop, work] = memory.history.press(soil, width, height, pressure * softer);
  if (!(drop > 0)) return;
  const double after = before + drop;
  memory.sinking.depth += drop;
  memory.sinking.work += work / softer;
  const terramechanics::SoilState state{&soil, ground_.specific_volume(ix, iy)};
  pushed_.take(place, terramechanics::pushed_depth(state, width, before, after));
  ground_.compact_to(ix, iy, height - drop);
  memory.history.height = ground_.height(ix, iy);
}

// Low-pass filters with the time constants described in the header.
void Ruts::Bearing::follow(const scene::Wheel& tyre, const vehicle::WheelState& wheel,
                           double interval) {
  const double now = wheel.force_W.z() - wheel.body_W.z();
  if (!std::isfinite(interval)) {
    *this = {now, wheel.slip};
    return;
  }
  load -= std::expm1(-interval / kBearingTime) * (now - load);
  // Slip excavates over the displacement of the rim: about a radius from one end of the patch to
  // the other.
  const double travel = interval * std::max(std::abs(wheel.spin) * tyre.radius, wheel.v_W.norm());
  slip -= std::expm1(-travel / tyre.radius) * (wheel.slip - slip);
}

// Lays displaced soil down after all tyres have pressed, then holds the columns under them.
void Ruts::press(const std::vector<LoadedTyre>& tyres, double interval) {
  under_.clear();
  bearing_.resize(tyres.size());
  for (std::size_t i = 0; i < tyres.size(); ++i) {
    const vehicle::WheelState& wheel = tyres[i].wheel;
    Bearing& bearing = bearing_[i];
    bearing.follow(tyres[i].tyre, wheel, interval);
    press_wheel(tyres[i].tyre, wheel, bearing, interval);
  }
  // Soil cannot be laid down under a track or another tyre.
  pushed_.deposit_down([this](int ix, int iy) {
    return ground_.held(ix, iy) ||
           under_.count(static_cast<std::int64_t>(iy) * ground_.nx() + ix) != 0;
  });
  ground_.hold(std::exchange(under_, {}));
}

// Derives the size of the patch from the soil under the wheel's middle.
void Ruts::press_wheel(const scene::Wheel& tyre, const vehicle::WheelState& wheel,
                       const Bearing& bearing, double interval) {
  const Pose& X = wheel.X_WWheel;
  // A tyre in the air presses nothing, whatever its earlier load.
  if (!(wheel.force_W.z() - wheel.body_W.z() > 0)) return;
  // The soil under the wheel's middle decides the size of the patch; each column then sinks by its
  // own soil.
  const terramechanics::SoilState under =
      GroundView(ground_, ground_.setup().soils).soil(X.translation().x(), X.translation().y());
  Press press{terramechanics::tyre_patch(tyre, *under.soil, bearing.load), *under.soil,
              terramechanics::slip_sinkage(bearing.slip)};
  if (!(press.patch.half_length > 0)) return;
  press.patch.sinkage *= press.softer;
  // Between two columns the surface is a chord, which is above the tread's arc by this much.
  press.patch.deflection += ground_.cell() * ground_.cell() / (8 * tyre.radius);
  press.patch.half_length =
      0.5 * terramechanics::chord_length(tyre.radius, press.patch.deflection + press.patch.sinkage);
  // The patch is a rectangle in the horizontal plane along the wheel's heading.
  const Vec2 along = Vec2(X.linear()(0, 0), X.linear()(1, 0)).normalized();
  const Vec2 rolled =
      std::isfinite(interval) ? Vec2(interval * wheel.v_W.head<2>()) : Vec2(Vec2::Zero());
  const bool twin = tyre.twin_spacing > 0;
  for (const double side : twin ? std::vector<double>{-0.5, 0.5} : std::vector<double>{0.0}) {
    // Below the axle in the machine's frame, which is not vertical on a slope.
    const double aside = side * tyre.twin_spacing;
    const Vec2 center = (X * Vec3(0, aside, -tyre.radius)).head<2>();
    press_patch(press, center, along, aside);
    // Also press where the tyre arrives before the next press. Otherwise it would meet unpressed
    // soil as a wall.
    if (!rolled.isZero(kStays)) press_patch(press, center + rolled, along, aside);
  }
}

// Visits every column whose centre is in the rectangle of the patch.
void Ruts::press_patch(const Press& press, const Vec2& center, const Vec2& along, double aside) {
  const terramechanics::TyrePatch& patch = press.patch;
  const Vec2 across(-along.y(), along.x());
  // Press at least one cell to either side, since the tyre senses the ground between those columns.
  const double half_width = std::max(0.5 * patch.width, ground_.cell());
  const double reach = std::hypot(patch.half_length, half_width);
  const Vec2i low = ground_.column_at(center.x() - reach, center.y() - reach);
  const Vec2i high = ground_.column_at(center.x() + reach, center.y() + reach);
  for (int iy = std::max(low.y(), 0); iy <= std::min(high.y(), ground_.ny() - 1); ++iy)
    for (int ix = std::max(low.x(), 0); ix <= std::min(high.x(), ground_.nx() - 1); ++ix) {
      const Vec2 d = ground_.origin() + ground_.cell() * Vec2(ix + 0.5, iy + 0.5) - center;
      const double x = d.dot(along);
      if (std::abs(x) > patch.half_length || std::abs(d.dot(across)) > half_width) continue;
      // Ahead and behind no deeper than the tread: a step there would be a wall for the tyre to
      // climb.
      const double tread = terramechanics::plate_pressure(
          press.soil, patch.tread_depth(x) / press.softer, patch.width);
      const double off = d.dot(across), outside = std::abs(aside) + 0.5 * patch.width;
      press_column({ix, iy, across, aside + off, outside, patch.width,
                    PushedSoil::covered(off, patch.width, ground_.cell())},
                   std::min(patch.pressure, tread), press);
    }
}

terramechanics::Sinkage Ruts::sinking(double x, double y) const {
  const Vec2i c = ground_.column_at(x, y);
  if (!ground_.contains(c.x(), c.y()) || !ground_.held(c.x(), c.y())) return {};
  const Memory* memory = memory_.find(c.x(), c.y());
  return memory != nullptr ? memory->sinking : terramechanics::Sinkage{};
}

void Ruts::Memory::visit(Archive& a) {
  a("history", history);
  a.ranged("work", sinking.work, 0.0, 1e12);
  a.ranged("depth", sinking.depth, 0.0, 1e6);
}

void Ruts::Bearing::visit(Archive& a) {
  a.ranged("load", load, -1e9, 1e9);
  a.ranged("slip", slip, -3.0, 3.0);
}

void Ruts::visit(Archive& a) {
  a.section("ruts", 6, [&] {
    a("memory", memory_);
    a("bearing", bearing_);
  });
}

}  // namespace navvy::coupling
