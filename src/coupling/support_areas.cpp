// SPDX-License-Identifier: Apache-2.0
#include "coupling/support_areas.h"

#include <algorithm>

#include "terramechanics/tyre_strip.h"

namespace navvy::coupling {
namespace {

// Twins are two areas side by side.
void add_tyres(const scene::Wheel& tyre, const vehicle::WheelState& wheel, soil::SupportArea area,
               std::vector<soil::SupportArea>& support_areas) {
  const Pose& X = wheel.X_WWheel;
  // A tyre is round in every direction of travel: however the machine leans, its lowest point is
  // below the axle.
  area.ahead_W = Vec3(X.linear()(0, 0), X.linear()(1, 0), 0).normalized();
  area.left_W = X.linear().col(1);
  area.radius = tyre.radius;
  area.v_W = wheel.v_W;
  if (tyre.twin_spacing > 0) {
    for (const double side : {-0.5, 0.5}) {
      area.p_W = X * Vec3(0, side * tyre.twin_spacing, 0);
      support_areas.push_back(area);
    }
    return;
  }
  area.p_W = X.translation();
  support_areas.push_back(area);
}

/// Appends one area for the idler, one for the run from the first roller to the last, one for the
/// sprocket.
void add_track(const scene::Wheel& wheel, const vehicle::LinkState& carrier,
               const Vec3& p_WSprocket, soil::SupportArea area,
               std::vector<soil::SupportArea>& support_areas) {
  const scene::Track& track = *wheel.track;
  const Pose& X = carrier.X_WL;
  area.ahead_W = X.linear().col(0);
  area.left_W = X.linear().col(1);
  const auto add = [&](const Vec3& p_W, double radius, double half_run) {
    area.p_W = p_W;
    area.v_W = carrier.v_WL + carrier.w_WL.cross(p_W - X.translation());
    area.radius = radius + track.thickness;
    area.half_run = half_run;
    support_areas.push_back(area);
  };
  const Vec3 &first = track.rollers.front(), &last = track.rollers.back();
  add(X * track.p_idler, track.idler_radius, 0);
  add(X * Vec3(0.5 * (first + last)), track.roller_radius, 0.5 * (first - last).norm());
  add(p_WSprocket, wheel.radius, 0);
}

}  // namespace

// A crawler has its carrier's motion, a tyre its own.
void add_support_areas(const scene::Machine& machine, const vehicle::PhysicsEngine& engine,
                       int index, int wheel, double load, double ready,
                       std::vector<soil::SupportArea>& support_areas) {
  const scene::Wheel& about = machine.wheels[static_cast<std::size_t>(wheel)];
  const vehicle::WheelState state = engine.wheel(index, wheel);
  soil::SupportArea area;
  area.half_width = 0.5 * about.width;
  area.ready = ready;
  if (!about.track) {
    area.flattening =
        std::clamp(load / about.stiffness, 0.0, terramechanics::kMaxDeflection * about.radius);
    add_tyres(about, state, area, support_areas);
    return;
  }
  const scene::Joint& joint =
      machine.joints[static_cast<std::size_t>(machine.joint_index(about.joint))];
  area.flattening = std::max(0.0, state.force_W.z() / about.stiffness);
  add_track(about, engine.link(index, joint.parent), state.X_WWheel.translation(), area,
            support_areas);
}

}  // namespace navvy::coupling
