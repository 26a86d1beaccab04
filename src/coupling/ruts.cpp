// SPDX-License-Identifier: Apache-2.0
#include "coupling/ruts.h"

#include <algorithm>
#include <cmath>

namespace navvy::coupling {
namespace {

/// Lengths of tyre tread on the ground: the chord of the tyre's circle at its static deflection plus sinkage.
double contact_length(double radius, double depth) { return 2 * std::sqrt(std::max(0.0, 2 * radius * depth)); }

}  // namespace

double Ruts::sinkage(const scene::Soil& soil, double pressure, double width) {
  const double k = soil.bekker_kc / width + soil.bekker_kphi;
  if (!(pressure > 0) || !(k > 0)) return 0;
  return std::pow(pressure / k, 1 / soil.bekker_n);
}

double Ruts::bearing(const scene::Soil& soil, double z, double width) {
  return z > 0 ? (soil.bekker_kc / width + soil.bekker_kphi) * std::pow(z, soil.bekker_n) : 0;
}

void Ruts::press_column(int ix, int iy, double pressure, double width, double most) {
  const scene::Soil& soil = ground_.setup().soils[ground_.surface_soil(ix, iy)];
  Memory& memory = memory_[static_cast<std::int64_t>(iy) * ground_.nx() + ix];
  const double height = ground_.height(ix, iy);
  // Dug, filled or slumped since: fresh ground.
  if (std::abs(height - memory.height) > 1e-3) memory.pressure = 0;
  if (pressure <= memory.pressure) return;
  const double before = sinkage(soil, memory.pressure, width);
  double more = sinkage(soil, pressure, width) - before;
  if (more > most) {
    more = most;
    pressure = bearing(soil, before + most, width);
  }
  memory.pressure = pressure;
  if (more > 0) ground_.compact_to(ix, iy, height - more);
  memory.height = ground_.height(ix, iy);
}

void Ruts::press(const scene::Wheel& tyre, const vehicle::WheelState& wheel, double most) {
  const double load = wheel.force_W.z();
  if (!(load > 0)) return;
  const bool twin = tyre.twin_spacing > 0;
  const double share = twin ? 0.5 * load : load;
  const double deflection = load / tyre.stiffness;
  const scene::Soil& soil = [&]() -> const scene::Soil& {
    const Vec3 p = wheel.X_WWheel.translation();
    const Vec2i c = ground_.column_at(p.x(), p.y());
    const int ix = std::clamp(c.x(), 0, ground_.nx() - 1), iy = std::clamp(c.y(), 0, ground_.ny() - 1);
    return ground_.setup().soils[ground_.surface_soil(ix, iy)];
  }();
  // Sinking lengthens the patch, which lowers the pressure: a few fixed-point rounds settle it.
  double depth = 0, length = 0, pressure = 0;
  for (int round = 0; round < 8; ++round) {
    length = contact_length(tyre.radius, deflection + 0.5 * depth);
    if (!(length > 0)) return;
    pressure = share / (length * tyre.width);
    depth = 0.5 * (depth + sinkage(soil, pressure, tyre.width));
  }
  const Pose& X = wheel.X_WWheel;
  const double cell = ground_.cell();
  for (const double side : twin ? std::vector<double>{-0.5, 0.5} : std::vector<double>{0.0}) {
    const Vec3 center = X * Vec3(0, side * tyre.twin_spacing, 0);
    const Vec2 along = Vec2(X.linear()(0, 0), X.linear()(1, 0)).normalized();
    const Vec2 across(-along.y(), along.x());
    // Where the round tread leaves the ground; `length`, of the mean pressure, lies between it and the flat part.
    const double half = 0.5 * contact_length(tyre.radius, deflection + depth);
    const double reach = std::hypot(half, 0.5 * tyre.width);
    const Vec2i low = ground_.column_at(center.x() - reach, center.y() - reach);
    const Vec2i high = ground_.column_at(center.x() + reach, center.y() + reach);
    for (int iy = std::max(low.y(), 0); iy <= std::min(high.y(), ground_.ny() - 1); ++iy)
      for (int ix = std::max(low.x(), 0); ix <= std::min(high.x(), ground_.nx() - 1); ++ix) {
        const Vec2 d = ground_.origin() + cell * Vec2(ix + 0.5, iy + 0.5) - center.head<2>();
        const double x = d.dot(along);
        if (std::abs(x) > half || std::abs(d.dot(across)) > 0.5 * tyre.width) continue;
        // Ahead and behind no deeper than the tread: a step there would be a wall the tyre has to climb.
        const double tread = std::clamp(depth + deflection - x * x / (2 * tyre.radius), 0.0, depth);
        press_column(ix, iy, std::min(pressure, bearing(soil, tread, tyre.width)), tyre.width, most);
      }
  }
}

void Ruts::hash(StateHash& hash) const {
  for (const auto& [key, memory] : memory_) {
    hash.value(key);
    hash.value(memory.pressure);
    hash.value(memory.height);
  }
}

void Ruts::save(StateWriter& writer) const {
  writer.begin("ruts", 1);
  writer.value(static_cast<std::uint64_t>(memory_.size()));
  for (const auto& [key, memory] : memory_) {
    writer.value(key);
    writer.value(memory.pressure);
    writer.value(memory.height);
  }
  writer.end();
}

void Ruts::load(StateReader& reader) {
  reader.begin("ruts", 1);
  memory_.clear();
  for (auto n = reader.value<std::uint64_t>(); n > 0; --n) {
    const auto key = reader.value<std::int64_t>();
    Memory& memory = memory_[key];
    memory.pressure = reader.value<double>();
    memory.height = reader.value<double>();
  }
  reader.end();
}

}  // namespace navvy::coupling
