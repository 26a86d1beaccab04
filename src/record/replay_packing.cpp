// SPDX-License-Identifier: Apache-2.0
#include "record/replay_packing.h"

#include <nlohmann/json.hpp>

namespace navvy::record {

std::string replay_row(const nlohmann::json& value) {
  return value.dump(-1, ' ', false, nlohmann::json::error_handler_t::replace);
}

nlohmann::json json_of(const Pose& pose) {
  const Vec3 p = pose.translation();
  const Eigen::Quaterniond q(pose.linear());
  return {p.x(), p.y(), p.z(), q.w(), q.x(), q.y(), q.z()};
}

}  // namespace navvy::record
