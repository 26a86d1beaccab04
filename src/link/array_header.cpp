// SPDX-License-Identifier: Apache-2.0
#include "link/array_header.h"

#include <Eigen/Geometry>
#include <bit>
#include <nlohmann/json.hpp>

namespace navvy::link {

using nlohmann::json;

json array_description(const sim::ArrayChannel& channel) {
  return {{"type", sim::name_of(channel.type)},
          {"shape", channel.shape},
          {"unit", channel.unit},
          {"frame", channel.frame},
          {"rate_hz", channel.rate},
          {"meaning", channel.meaning}};
}

json array_header(const sim::ArrayView& view) {
  static_assert(std::endian::native == std::endian::little,
                "arrays are sent as they are in memory");
  // Pose of the array's frame in W at the time of its stamp.
  const Eigen::Quaterniond q(view.X_WF().linear());
  const Vec3 p = view.X_WF().translation();
  json out = array_description(view.channel());
  out["sequence"] = view.sequence();
  out["time"] = view.time();
  out["delivered"] = view.delivered();
  out["position_m"] = {p.x(), p.y(), p.z()};
  out["quaternion_wxyz"] = {q.w(), q.x(), q.y(), q.z()};
  return out;
}

}  // namespace navvy::link
