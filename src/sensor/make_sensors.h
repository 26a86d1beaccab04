// SPDX-License-Identifier: Apache-2.0
// Makes the sensors that a scene describes.
#pragma once

#include <memory>
#include <vector>

#include "core/error.h"
#include "scene/scene.h"
#include "sim/sampler.h"
#include "sim/world.h"

namespace navvy::sensor {

/// Returns a sampler for each sensor of the scene of `world`, in the order of machines, links and
/// sensors; `add` them to the world or its session in this order, before a snapshot is loaded. They
/// share one ray scene and refer to `world`, which must outlive them.
///
/// A sensor changes nothing in the world, and the hash of the world's state is the same with and
/// without sensors. Its random numbers depend only on the seed of the scene and on its name.
/// A sensor that is inside its own machine at the start is logged as a warning.
/// @throws InputError with file and line of every sensor whose rate is above that of the base step,
/// whose sweep lasts longer than the time between two readings, or that is inside another body or
/// below the ground at the start.
std::vector<std::unique_ptr<sim::Sampler>> make_sensors(const sim::World& world);

/// Returns the errors and warnings that `make_sensors` has for a world of this scene, found without
/// a world and without a device. A scene whose ground or meshes cannot be made gives their
/// errors, if one of its sensors needs a free view.
std::vector<Fault> check_sensors(const scene::Scene& scene);

}  // namespace navvy::sensor
