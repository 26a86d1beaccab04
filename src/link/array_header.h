// SPDX-License-Identifier: Apache-2.0
// What is said of an array in JSON, beside its elements.
#pragma once

#include <nlohmann/json_fwd.hpp>

#include "sim/array_outputs.h"

namespace navvy::link {

/// Returns what an array is: type, shape, unit, frame, rate and meaning
/// (docs/reference/control_protocol.md).
nlohmann::json array_description(const sim::ArrayChannel& channel);

/// Returns what an array is and the stamps of its latest value: sequence number, times of
/// measurement and delivery, pose of its frame.
nlohmann::json array_header(const sim::ArrayView& view);

}  // namespace navvy::link
