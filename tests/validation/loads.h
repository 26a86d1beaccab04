// SPDX-License-Identifier: Apache-2.0
// Loads of buckets against what the bucket holds.
#pragma once

#include <algorithm>
#include <cstddef>

#include "scene/scene.h"
#include "session/session.h"

namespace navvy::validation {

/// Returns the mean payload of the first `most` cycles at their dumps [kg].
inline double mean_payload(const session::Session& session, std::size_t most = SIZE_MAX) {
  const std::size_t count = std::min(most, session.cycles().size());
  double sum = 0;
  for (std::size_t i = 0; i < count; ++i) sum += session.cycles()[i].payload_dump;
  return sum / std::max<double>(1, static_cast<double>(count));
}

/// Returns the mass of the first soil that fills the first machine's bucket to its heaped capacity,
/// 1:1 over its rim [kg].
inline double heaped_load(const scene::Scene& scene) {
  const scene::Soil& soil = scene.soils.at(0);
  return scene.machines.at(0).machine.buckets.at(0).capacity / soil.swell * soil.bank_density;
}

}  // namespace navvy::validation
