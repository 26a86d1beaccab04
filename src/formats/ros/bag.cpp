// SPDX-License-Identifier: Apache-2.0
#include "formats/ros/bag.h"

namespace navvy::formats::ros {

// The numbers are those of DDS in rmw: history unknown (3), reliable (1), transient local (1), and
// infinite times. Players set the history themselves.
std::string Bag::Topic::offered_qos() const {
  if (!latched) return "";
  const std::string forever = ":\n    sec: 9223372036\n    nsec: 854775807\n";
  return "- history: 3\n  depth: 0\n  reliability: 1\n  durability: 1\n  deadline" + forever +
         "  lifespan" + forever + "  liveliness: 1\n  liveliness_lease_duration" + forever +
         "  avoid_ros_namespace_conventions: false";
}

}  // namespace navvy::formats::ros
