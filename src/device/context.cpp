// SPDX-License-Identifier: Apache-2.0
#include <utility>

#include "device/context_private.h"
#include "device/process_fork.h"
#include "device/programs_built.h"

namespace navvy::device {
namespace {

/// Contexts that a device uses, or has used, by their drivers.
struct Contexts {
  std::mutex mutex;
  std::map<SharedContext::Drivers, std::weak_ptr<SharedContext>> of;
};

Contexts& contexts() {
  static Contexts all;
  return all;
}

std::atomic<std::uint64_t>& built() {
  static std::atomic<std::uint64_t> count{0};
  return count;
}

}  // namespace

std::uint64_t programs_built() { return built(); }

std::shared_ptr<SharedContext> SharedContext::of(cl_platform_id platform, const Drivers& drivers,
                                                 cl_int& code) {
  const std::lock_guard<std::mutex> alone(contexts().mutex);
  std::weak_ptr<SharedContext>& known = contexts().of[drivers];
  code = CL_SUCCESS;
  if (std::shared_ptr<SharedContext> present = known.lock(); present && !present->abandoned())
    return present;
  // Without a named platform, the meaning of a context is up to the driver.
  const cl_context_properties properties[] = {CL_CONTEXT_PLATFORM,
                                              reinterpret_cast<cl_context_properties>(platform), 0};
  const cl_context made = clCreateContext(properties, drivers[1] != nullptr ? 2 : 1, drivers.data(),
                                          nullptr, nullptr, &code);
  if (code != CL_SUCCESS) return nullptr;
  auto out = std::make_shared<SharedContext>(made, drivers);
  known = out;
  return out;
}

namespace {

/// Returns the OpenCL version of a driver as text; empty if that fails.
std::string version_of(cl_device_id driver) {
  char text[256] = "";
  clGetDeviceInfo(driver, CL_DEVICE_VERSION, sizeof text - 1, text, nullptr);
  return text;
}

}  // namespace

SharedContext::SharedContext(cl_context context, const Drivers& drivers)
    : drivers_(drivers),
      context_(context),
      guard_(LaunchGuard::needed_by(version_of(drivers.front()))) {}

SharedContext::~SharedContext() {
  if (abandoned()) return;
  for (const auto& [key, program] : programs_) clReleaseProgram(program);
  clReleaseContext(context_);
}

bool SharedContext::abandoned() const { return lost_ || forked_after_start(); }

cl_program SharedContext::program(const std::string& key,
                                  const std::function<cl_program()>& build) {
  const std::lock_guard<std::mutex> alone(mutex_);
  const auto it = programs_.find(key);
  if (it != programs_.end()) return it->second;
  const cl_program program = programs_.emplace(key, build()).first->second;
  ++built();
  news_ = true;
  return program;
}

void SharedContext::note_launch(cl_program program, const std::string& kernel) {
  const std::lock_guard<std::mutex> alone(mutex_);
  if (launched_.emplace(program, kernel).second) news_ = true;
}

bool SharedContext::take_news() {
  const std::lock_guard<std::mutex> alone(mutex_);
  return std::exchange(news_, false);
}

}  // namespace navvy::device
