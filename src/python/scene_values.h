// SPDX-License-Identifier: Apache-2.0
// Values of a scene by the names of its schema, as Python objects.
#pragma once

#include <nanobind/nanobind.h>

#include "scene/scene.h"

namespace navvy::python {

/// Returns the values of a scene as nested dictionaries, keyed by element names without "navvy:"
/// and in the units of the file. A repeated element is a list of dictionaries, each with its
/// `name`.
nanobind::dict scene_values(scene::Scene& scene);

}  // namespace navvy::python
