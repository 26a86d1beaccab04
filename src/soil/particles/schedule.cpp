// SPDX-License-Identifier: Apache-2.0
#include "soil/particles/schedule.h"

#include <charconv>
#include <cstdlib>
#include <limits>
#include <string_view>

#include "core/error.h"

namespace navvy::soil {
namespace {

/// Number of particles at which the caller's thread and two worker threads are equally fast.
/// tuned: soil_bench threads
constexpr double kEqualForTwoThreads = 20000;

}  // namespace

Schedule schedule_for(const device::Device& device) {
  const char* text = std::getenv("NAVVY_SOIL_SCHEDULE");
  const std::string wanted = text == nullptr ? "" : text;
  if (wanted == "lanes") return Schedule::kLanes;
  if (wanted == "groups") return Schedule::kGroups;
  if (wanted.empty())
    return device.info().kind == device::Kind::kGpu ? Schedule::kGroups : Schedule::kLanes;
  Fault fault;
  fault.element = "NAVVY_SOIL_SCHEDULE";
  fault.value = wanted;
  fault.rule = "lanes or groups; unset, the device decides";
  throw InputError(fault);
}

std::string kernel_path(const device::Device& device, const std::string& stage) {
  return (schedule_for(device) == Schedule::kGroups ? "soil/groups/" : "soil/lanes/") + stage +
         ".cl";
}

double few_particles(const device::Device& device) {
  if (const char* variable = std::getenv("NAVVY_FEW_PARTICLES")) {
    const std::string_view text(variable);
    double number = 0;
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), number);
    // Written so that NaN is refused, too.
    if (error == std::errc() && end == text.data() + text.size() && number >= 0) return number;
    Fault fault;
    fault.element = "NAVVY_FEW_PARTICLES";
    fault.value = variable;
    fault.rule = "a number of particles from 0 upwards; unset, the device decides";
    throw InputError(fault);
  }
  // A single thread saves nothing; n threads save 1 - 1 / n of the work, two of them a half.
  const int threads = device.info().compute_units;
  if (threads < 2) return std::numeric_limits<double>::infinity();
  return kEqualForTwoThreads * 0.5 * threads / (threads - 1);
}

}  // namespace navvy::soil
