// SPDX-License-Identifier: Apache-2.0
// The surface that an operator sees. Private to the dig.
#pragma once

#include "control/observation.h"
#include "control/surface.h"

namespace navvy::control {

/// Calls `use` with the surface that the operator sees: the view given, or the resting ground.
/// Returns what `use` returns.
template <class Use>
auto with_surface(const Observation& seen, const Use& use) {
  if (seen.surface != nullptr) return use(*seen.surface);
  const GroundSurfaceView resting(*seen.ground);
  return use(static_cast<const SurfaceView&>(resting));
}

}  // namespace navvy::control
