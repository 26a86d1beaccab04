// SPDX-License-Identifier: Apache-2.0
// Machines and grounds for the tests of the vehicle module.
#pragma once

#include <functional>

#include "scene/machine.h"
#include "terramechanics/grounds.h"
#include "vehicle/physics_engine.h"

namespace navvy::vehicle::testing {

/// Returns a box link: mass [kg], centre of mass, edges [m].
scene::Link box_link(const std::string& name, const Pose& X_ML, double mass, const Vec3& center,
                     const Vec3& edges);
scene::Joint revolute(const std::string& name, int parent, int child, const Vec3& axis);

/// Returns a cart of 2000 kg with four wheels, wheelbase 2.8 m, track width 1.94 m, rear drive,
/// front steering.
scene::Machine cart();
/// Returns a robot of 46 kg with two driven wheels of 0.1 m, track width 0.4 m, and a ball behind
/// them that slips with `caster`.
scene::Machine robot(double caster = 0);
/// Returns the machine with tyre friction `friction` [-].
scene::Machine with_grip(scene::Machine machine, double friction);
/// Returns a fixed base with boom 5 m / 1200 kg and stick 3 m / 600 kg on pitch joints (axis -y),
/// without cylinders.
scene::Machine arm();
/// Returns a single box with edges of 1 m and 1000 kg that collides.
scene::Machine box();
/// Returns the shipped excavator with its arm joints at these initial angles [rad].
scene::Machine ew180(double boom = 0.75, double stick = -2.2, double bucket = -1.3,
                     double swing = 0);

/// Returns the shipped dumper.
scene::Machine dumper();

using terramechanics::flat;
using terramechanics::FunctionGround;
using terramechanics::slope;

/// Steps an engine for a time; calls `each` after every step.
void run(PhysicsEngine& engine, const GroundQuery& ground, double duration, double dt,
         const std::function<void(double)>& each = {});
std::uint64_t digest(const PhysicsEngine& engine);

}  // namespace navvy::vehicle::testing
