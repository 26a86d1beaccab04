// SPDX-License-Identifier: Apache-2.0
#include "device/traffic.h"

#include "device/traffic_private.h"

namespace navvy::device {

TrafficCounters& traffic_counters() {
  static TrafficCounters counters;
  return counters;
}

DeviceTraffic traffic() {
  const TrafficCounters& now = traffic_counters();
  return {now.launches, now.waits, now.read_bytes, now.written_bytes};
}

}  // namespace navvy::device
