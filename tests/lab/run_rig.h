// SPDX-License-Identifier: Apache-2.0
// Runs a rig in a test and prints its rows as the validation table shows them.
#pragma once

#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>
#include <functional>
#include <map>
#include <string>

#include "device/device.h"
#include "lab/rig.h"

namespace navvy::lab {

/// Returns one device for all tests of a program: kernels build once.
inline device::Device& test_device() {
  static device::Device shared;
  return shared;
}

/// Runs `name` with these parameters instead of the defaults and prints every result.
inline Report run_rig(const std::string& name, const std::map<std::string, double>& geometry,
                      const std::function<void(Setup&)>& change = {}) {
  Setup setup = default_setup(find_rig(name), test_device());
  for (const auto& [parameter, value] : geometry) {
    EXPECT_EQ(setup.geometry.count(parameter), 1u) << name << " has no parameter " << parameter;
    setup.geometry[parameter] = value;
  }
  if (change) change(setup);
  // Checks the setup as the program does.
  const Report report = find_rig(name).run(setup);
  for (const Quantity& q : report.results) {
    // Every tolerance names its source; a style test checks that the reference resolves.
    EXPECT_TRUE(!q.has_tolerance() || q.source.find('[') != std::string::npos)
        << name << ", " << q.name << ": " << q.source;
    EXPECT_TRUE(q.in_range || !q.range.empty()) << name << ", " << q.name;
    std::printf("[ VALUE    ] %-8s %-40s %12.5g %-5s expected %g, tolerance %g .. %g %s (%s)\n",
                name.c_str(), q.name.c_str(), q.measured, q.unit.c_str(), q.expected, q.low, q.high,
                q.outside_tolerance() ? "outside"
                : q.in_range          ? ""
                                      : "not judged",
                q.source.c_str());
  }
  std::printf("[ VALUE    ] %-8s cell %g m, %d particles, %.2f s simulated, %.2f s\n", name.c_str(),
              setup.cell, report.particles_peak, report.simulated_time, report.wall_time);
  return report;
}

/// Returns the names of the results outside their tolerances, each followed by "; ".
inline std::string outside_tolerance(const Report& report) {
  std::string out;
  for (const Quantity& q : report.results)
    if (q.outside_tolerance()) out += q.name + "; ";
  return out;
}

/// Returns a result by name; NaN and a failed test if the rig has none.
inline double measured(const Report& report, const std::string& name) {
  const Quantity* q = report.find(name);
  EXPECT_NE(q, nullptr) << name;
  return q != nullptr ? q->measured : kNone;
}

}  // namespace navvy::lab
