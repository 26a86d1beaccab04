// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <charconv>

#include "device/launch_guard_private.h"

namespace navvy::device {

bool LaunchGuard::needed_by(const std::string& version) {
  const std::size_t at = version.find("PoCL ");
  if (at == std::string::npos) return false;
  int major = 0;
  std::from_chars(version.data() + at + 5, version.data() + version.size(), major);
  return major < 6;
}

void LaunchGuard::add(cl_command_queue queue) {
  const std::unique_lock<std::shared_mutex> alone(mutex_);
  queues_.insert(queue);
  finish_all();
}

void LaunchGuard::remove(cl_command_queue queue) {
  const std::unique_lock<std::shared_mutex> alone(mutex_);
  queues_.erase(queue);
}

LaunchGuard::Record& LaunchGuard::record(cl_program program, const std::string& kernel) {
  const std::unique_lock<std::shared_mutex> alone(mutex_);
  return records_[{program, kernel}];
}

std::array<std::size_t, 3> LaunchGuard::key_of(const std::size_t* local) {
  if (local == nullptr) return {0, 0, 0};
  return {local[0], local[1], local[2]};
}

std::size_t LaunchGuard::width_of(const std::size_t* global) {
  // A third axis does not make PoCL load a kernel again.
  return std::max(global[0], global[1]);
}

void LaunchGuard::finish_all() const {
  if (!needed_ || queues_.size() <= kOfOneDevice) return;
  for (cl_command_queue one : queues_) clFinish(one);
}

}  // namespace navvy::device
