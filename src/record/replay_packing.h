// SPDX-License-Identifier: Apache-2.0
// Values of a replay as text and JSON.
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <span>
#include <string>
#include <vector>

#include "core/base64.h"
#include "core/math.h"

namespace navvy::record {

/// Returns the bytes of `values`, little-endian, as base64 text.
template <class T>
std::string packed(const std::vector<T>& values) {
  return base64(std::as_bytes(std::span(values)));
}

/// Returns one row of a replay, without a line end. Names may be in another encoding than UTF-8.
std::string replay_row(const nlohmann::json& value);

/// Returns the position [m] and the quaternion w, x, y, z of a pose.
nlohmann::json json_of(const Pose& pose);

}  // namespace navvy::record
