// SPDX-License-Identifier: Apache-2.0
#include "coupling/ruts.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "coupling/ground_view.h"
#include "terramechanics/plate.h"
#include "terramechanics/tyre_patch.h"

namespace navvy::coupling {
namespace {

constexpr double kSameHeight = 1e-3;  // [m] a surface nobody else moved since it was pressed

}  // namespace

void Ruts::press_column(int ix, int iy, double pressure, double width, double most) {
  const scene::Soil& soil = ground_.setup().soils[ground_.surface_soil(ix, iy)];
  Memory& memory = memory_[static_cast<std::int64_t>(iy) * ground_.nx() + ix];
  const double height = ground_.height(ix, iy);
  // Dug, filled or slumped since: fresh ground.
  if (std::abs(height - memory.height) > kSameHeight) memory.pressure = 0;
  if (pressure <= memory.pressure) return;
  // Only what the plate sinks beyond the largest pressure borne so far.
  const double before = terramechanics::plate_sinkage(soil, memory.pressure, width);
  double more = terramechanics::plate_sinkage(soil, pressure, width) - before;
  // Cut short, the column has borne no more than what its depth by now bears: the rest comes with the next press.
  if (more > most) {
    more = most;
    pressure = terramechanics::plate_pressure(soil, before + most, width);
  }
  memory.pressure = pressure;
  if (more > 0) ground_.compact_to(ix, iy, height - more);
  memory.height = ground_.height(ix, iy);
}

void Ruts::press(const std::vector<LoadedTyre>& tyres, double most) {
  under_.clear();
  for (const LoadedTyre& one : tyres) press_wheel(one.tyre, one.wheel, most);
  ground_.hold(std::exchange(under_, {}));
}

void Ruts::press_wheel(const scene::Wheel& tyre, const vehicle::WheelState& wheel, double most) {
  const Pose& X = wheel.X_WWheel;
  // The soil under the wheel's middle decides the size of the patch; each column then sinks by its own.
  const terramechanics::SoilState under =
      GroundView(ground_, ground_.setup().soils).soil(X.translation().x(), X.translation().y());
  const terramechanics::TyrePatch patch =
      terramechanics::tyre_patch(tyre, *under.soil, wheel.force_W.z() - wheel.body_W.z());
  if (!(patch.half_length > 0)) return;
  const bool twin = tyre.twin_spacing > 0;
  for (const double side : twin ? std::vector<double>{-0.5, 0.5} : std::vector<double>{0.0})
    press_patch(patch, *under.soil, X, side * tyre.twin_spacing, most);
}

void Ruts::press_patch(const terramechanics::TyrePatch& patch, const scene::Soil& soil, const Pose& X, double left,
                       double most) {
  const Vec3 center = X * Vec3(0, left, 0);
  // The patch is a rectangle in the plane, along the wheel's heading.
  const Vec2 along = Vec2(X.linear()(0, 0), X.linear()(1, 0)).normalized();
  const Vec2 across(-along.y(), along.x());
  const double reach = std::hypot(patch.half_length, 0.5 * patch.width);
  const Vec2i low = ground_.column_at(center.x() - reach, center.y() - reach);
  const Vec2i high = ground_.column_at(center.x() + reach, center.y() + reach);
  for (int iy = std::max(low.y(), 0); iy <= std::min(high.y(), ground_.ny() - 1); ++iy)
    for (int ix = std::max(low.x(), 0); ix <= std::min(high.x(), ground_.nx() - 1); ++ix) {
      const Vec2 d = ground_.origin() + ground_.cell() * Vec2(ix + 0.5, iy + 0.5) - center.head<2>();
      const double x = d.dot(along);
      if (std::abs(x) > patch.half_length || std::abs(d.dot(across)) > 0.5 * patch.width) continue;
      under_.insert(static_cast<std::int64_t>(iy) * ground_.nx() + ix);
      // Ahead and behind no deeper than the tread: a step there would be a wall the tyre has to climb.
      const double tread = terramechanics::plate_pressure(soil, patch.tread_depth(x), patch.width);
      press_column(ix, iy, std::min(patch.pressure, tread), patch.width, most);
    }
}

void Ruts::Memory::visit(Archive& a) {
  a("pressure", pressure);
  a("height", height);
}

void Ruts::visit(Archive& a) {
  a.section("ruts", 2, [&] {
    a("memory", memory_);
    // Keys ascend, so the first and the last tell of all.
    const std::int64_t columns = static_cast<std::int64_t>(ground_.nx()) * ground_.ny();
    a.require(memory_.empty() || (memory_.begin()->first >= 0 && memory_.rbegin()->first < columns), "memory",
              "a rut lies beside the site");
  });
}

}  // namespace navvy::coupling
