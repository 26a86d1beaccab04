// SPDX-License-Identifier: Apache-2.0
// Machines and grounds for the tests of the vehicle module.
#pragma once

#include <functional>

#include "scene/machine.h"
#include "terramechanics/grounds.h"
#include "vehicle/physics_engine.h"

namespace navvy::vehicle::testing {

/// A box of a link: mass [kg], centre of mass, edges [m].
scene::Link box_link(const std::string& name, const Pose& X_ML, double mass, const Vec3& center,
                     const Vec3& edges);
scene::Joint revolute(const std::string& name, int parent, int child, const Vec3& axis);

/// Cart of 2000 kg with four wheels, wheelbase 2.8 m, track 1.94 m, rear drive, front steering.
scene::Machine cart();
/// Robot of 46 kg with two driven wheels of 0.1 m on a track of 0.4 m and a ball behind them that
/// slips with `caster`.
scene::Machine robot(double caster = 0);
/// The machine on tyres that grip with `friction` [-].
scene::Machine with_grip(scene::Machine machine, double friction);
/// Fixed base, boom 5 m / 1200 kg and stick 3 m / 600 kg on pitch joints (axis -y), no cylinders.
scene::Machine arm();
/// A single box of 1 m edges and 1000 kg that collides.
scene::Machine box();
/// The shipped excavator, arm joints moved to these angles [rad] (initial positions).
scene::Machine ew180(double boom = 0.75, double stick = -2.2, double bucket = -1.3,
                     double swing = 0);

/// The shipped dumper.
scene::Machine dumper();

using terramechanics::flat;
using terramechanics::FunctionGround;
using terramechanics::slope;

/// Steps an engine for a time; calls `each` after every step.
void run(PhysicsEngine& engine, const GroundQuery& ground, double duration, double dt,
         const std::function<void(double)>& each = {});
std::uint64_t digest(const PhysicsEngine& engine);

}  // namespace navvy::vehicle::testing
