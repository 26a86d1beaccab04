// SPDX-License-Identifier: Apache-2.0
// Machines and grounds for the tests of the vehicle module.
#pragma once

#include <functional>

#include "scene/machine.h"
#include "vehicle/engine.h"

namespace navvy::vehicle::testing {

/// A box of a link: mass [kg], centre of mass, edges [m].
scene::Link box_link(const std::string& name, const Pose& X_ML, double mass, const Vec3& center, const Vec3& edges);
scene::Joint revolute(const std::string& name, int parent, int child, const Vec3& axis);

/// Cart of 2000 kg with four wheels, wheelbase 2.8 m, track 1.94 m, rear drive, front steering.
scene::Machine cart();
/// Fixed base, boom 5 m / 1200 kg and stick 3 m / 600 kg on pitch joints (axis -y), no cylinders.
scene::Machine arm();
/// A single box of 1 m edges and 1000 kg that collides.
scene::Machine box();
/// The shipped excavator, arm joints moved to these angles [rad] (initial positions).
scene::Machine ew180(double boom = 0.75, double stick = -2.2, double bucket = -1.3, double swing = 0);

/// The shipped dumper.
scene::Machine dumper();

/// Ground as a function of x and y; the normal by differences over 0.1 m.
class FunctionGround final : public GroundQuery {
 public:
  explicit FunctionGround(std::function<double(double, double)> height, double friction = -1)
      : height_(std::move(height)), friction_(friction) {}
  double height(double x, double y) const override { return height_(x, y); }
  Vec3 normal(double x, double y) const override;
  double friction(double, double) const override { return friction_; }

 private:
  std::function<double(double, double)> height_;
  double friction_;
};
FunctionGround flat(double friction = -1);
/// Plane that rises along x.
FunctionGround slope(double angle, double friction = -1);

/// Steps an engine for a time; calls `each` after every step.
void run(Engine& engine, const GroundQuery& ground, double duration, double dt,
         const std::function<void(double)>& each = {});
std::uint64_t digest(const Engine& engine);

}  // namespace navvy::vehicle::testing
