// SPDX-License-Identifier: Apache-2.0
// Values of a replay as JSON.
#pragma once

#include <nlohmann/json.hpp>
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

/// Returns the position [m] and the quaternion w, x, y, z of a pose.
inline nlohmann::json json_of(const Pose& pose) {
  const Vec3 p = pose.translation();
  const Eigen::Quaterniond q(pose.linear());
  return {p.x(), p.y(), p.z(), q.w(), q.x(), q.y(), q.z()};
}

}  // namespace navvy::record
