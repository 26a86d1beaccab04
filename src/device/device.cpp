// SPDX-License-Identifier: Apache-2.0
#include "device/device.h"

#include <algorithm>
#include <cctype>
#include <charconv>
#include <cstdio>
#include <cstdlib>
#include <mutex>
#include <string_view>

#include "core/long_work.h"
#include "core/printable.h"
#include "device/kernel_cache.h"
#include "device/opencl_private.h"
#include "device/scarcity.h"

namespace navvy::device {
namespace {

/// A device with its platform.
struct Found {
  cl_platform_id platform = nullptr;
  cl_device_id device = nullptr;
  DeviceInfo info;
  /// Device of the same processor whose kernels run in the caller's thread; null without one.
  cl_device_id caller = nullptr;
};

std::string lower(std::string text) {
  std::transform(text.begin(), text.end(), text.begin(),
                 [](unsigned char c) { return std::tolower(c); });
  return text;
}

/// Returns a text without the terminating zero that OpenCL counts, or "" if the driver refuses: one
/// broken platform must not hide the others.
std::string platform_text(cl_platform_id platform, cl_platform_info what) {
  std::size_t size = 0;
  if (clGetPlatformInfo(platform, what, 0, nullptr, &size) != CL_SUCCESS || size == 0) return "";
  std::string text(size, '\0');
  if (clGetPlatformInfo(platform, what, size, text.data(), nullptr) != CL_SUCCESS) return "";
  text.resize(size - 1);
  return text;
}

std::string device_text(cl_device_id device, cl_device_info what) {
  std::size_t size = 0;
  if (clGetDeviceInfo(device, what, 0, nullptr, &size) != CL_SUCCESS || size == 0) return "";
  std::string text(size, '\0');
  if (clGetDeviceInfo(device, what, size, text.data(), nullptr) != CL_SUCCESS) return "";
  text.resize(size - 1);
  return text;
}

template <class T>
T device_value(cl_device_id device, cl_device_info what) {
  T value{};
  // A value that the driver does not know stays zero, which disables the feature.
  clGetDeviceInfo(device, what, sizeof value, &value, nullptr);
  return value;
}

/// Queries all properties of a device.
DeviceInfo describe(cl_platform_id platform, cl_device_id device) {
  DeviceInfo info;
  const auto type = device_value<cl_device_type>(device, CL_DEVICE_TYPE);
  info.kind = (type & CL_DEVICE_TYPE_CPU)   ? Kind::kCpu
              : (type & CL_DEVICE_TYPE_GPU) ? Kind::kGpu
                                            : Kind::kOther;
  info.name = device_text(device, CL_DEVICE_NAME);
  info.platform = platform_text(platform, CL_PLATFORM_NAME);
  info.version = device_text(device, CL_DEVICE_VERSION);
  info.driver = device_text(device, CL_DRIVER_VERSION);
  info.compute_units = static_cast<int>(device_value<cl_uint>(device, CL_DEVICE_MAX_COMPUTE_UNITS));
  info.memory = device_value<cl_ulong>(device, CL_DEVICE_GLOBAL_MEM_SIZE);
  info.max_work_group = device_value<std::size_t>(device, CL_DEVICE_MAX_WORK_GROUP_SIZE);
  // True for CPUs and for graphics processors that are part of them; mapping costs no copy there.
  info.shares_memory = device_value<cl_bool>(device, CL_DEVICE_HOST_UNIFIED_MEMORY) == CL_TRUE;
  const auto floats = device_value<cl_device_fp_config>(device, CL_DEVICE_SINGLE_FP_CONFIG);
  info.correct_divide_sqrt = (floats & CL_FP_CORRECTLY_ROUNDED_DIVIDE_SQRT) != 0;
  return info;
}

/// Returns true for a version of PoCL whose driver without worker threads can be asked for. Builds
/// with drivers for GPUs are left alone, as a choice would leave those out; versions from 4 on have
/// other names.
bool has_basic_driver(const std::string& version) {
  const std::size_t at = version.find("PoCL ");
  if (at == std::string::npos || version.find("CUDA") != std::string::npos) return false;
  int major = 0;
  std::from_chars(version.data() + at + 5, version.data() + version.size(), major);
  return major >= 1 && major <= 3;
}

/// Asks PoCL for its driver without worker threads, which it offers on request only, while this
/// object lives. PoCL reads the request when a platform first shows its devices, and starts the
/// drivers that were asked for and no others, so a user's own choice is kept.
class CallerDriverRequest {
 public:
  explicit CallerDriverRequest(cl_platform_id platform)
      : asked_(std::getenv(kVariable) == nullptr &&
               has_basic_driver(platform_text(platform, CL_PLATFORM_VERSION))) {
    if (asked_) ::setenv(kVariable, "pthread basic", 1);
  }
  // Other OpenCL programs that this process starts see the devices that they expect.
  ~CallerDriverRequest() {
    if (asked_) ::unsetenv(kVariable);
  }
  CallerDriverRequest(const CallerDriverRequest&) = delete;
  CallerDriverRequest& operator=(const CallerDriverRequest&) = delete;

  /// Returns true if the request was made.
  bool asked() const { return asked_; }

 private:
  static constexpr const char* kVariable = "POCL_DEVICES";
  bool asked_;
};

/// Hides the driver without worker threads from the list of devices: it becomes the `caller` of the
/// device with threads, and is no choice of its own.
void pair_drivers(std::vector<Found>& of_platform) {
  const auto named = [&](const char* prefix) {
    return std::find_if(of_platform.begin(), of_platform.end(),
                        [&](const Found& f) { return f.info.name.rfind(prefix, 0) == 0; });
  };
  const auto basic = named("basic-");
  const auto threads = named("pthread-");
  if (basic == of_platform.end() || threads == of_platform.end()) return;
  threads->caller = basic->device;
  of_platform.erase(basic);
}

/// Finds the devices of all platforms.
std::vector<Found> find_devices_once() {
  // Before the first OpenCL call: PoCL reads its cache folder from the environment when its
  // platform starts.
  prepare_kernel_cache();
  std::vector<Found> found;
  opencl_has_started();
  cl_uint platform_count = 0;
  if (clGetPlatformIDs(0, nullptr, &platform_count) != CL_SUCCESS || platform_count == 0)
    return found;
  std::vector<cl_platform_id> platforms(platform_count);
  if (clGetPlatformIDs(platform_count, platforms.data(), nullptr) != CL_SUCCESS) return found;
  for (cl_platform_id platform : platforms) {
    const CallerDriverRequest request(platform);
    // OpenCL wants two calls, the first for the number. A platform without devices reports an
    // error, so errors do not end the search.
    cl_uint count = 0;
    if (clGetDeviceIDs(platform, CL_DEVICE_TYPE_ALL, 0, nullptr, &count) != CL_SUCCESS ||
        count == 0)
      continue;
    std::vector<cl_device_id> devices(count);
    if (clGetDeviceIDs(platform, CL_DEVICE_TYPE_ALL, count, devices.data(), nullptr) != CL_SUCCESS)
      continue;
    std::vector<Found> of_platform;
    of_platform.reserve(devices.size());
    for (cl_device_id device : devices)
      of_platform.push_back({platform, device, describe(platform, device), nullptr});
    if (request.asked()) pair_drivers(of_platform);
    for (Found& entry : of_platform) {
      // The index counts over all platforms in the loader's order; it is what a user types.
      entry.info.index = static_cast<int>(found.size());
      found.push_back(std::move(entry));
    }
  }
  return found;
}

/// Returns the devices of all platforms. They are found once in a process: a platform keeps its
/// devices, and PoCL 3.1 shows them to a second thread before they have their names.
std::vector<Found> find_devices() {
  // A lock that another thread held at the fork would stay locked in the child.
  require_no_fork();
  static std::mutex first;
  static std::vector<Found> found;
  const std::lock_guard<std::mutex> alone(first);
  // Without any device another try may succeed, such as with a cache folder that can be written.
  if (found.empty()) found = find_devices_once();
  return found;
}

/// Returns the index of the device that `choice` selects, or -1.
int match(const std::vector<Found>& found, const std::string& choice) {
  const auto first = [&](auto&& accept) {
    const auto it = std::find_if(found.begin(), found.end(), accept);
    return it == found.end() ? -1 : static_cast<int>(it - found.begin());
  };
  const std::string wanted = lower(choice);
  const auto of_kind = [&](Kind kind) {
    return first([=](const Found& f) { return f.info.kind == kind; });
  };
  // A CPU comes first, as every machine can have that device.
  if (wanted.empty()) {
    if (const int cpu = of_kind(Kind::kCpu); cpu >= 0) return cpu;
    if (const int gpu = of_kind(Kind::kGpu); gpu >= 0) return gpu;
    return found.empty() ? -1 : 0;
  }
  if (wanted == "cpu") return of_kind(Kind::kCpu);
  if (wanted == "gpu") return of_kind(Kind::kGpu);
  if (wanted.size() < 6 &&
      std::all_of(wanted.begin(), wanted.end(), [](unsigned char c) { return std::isdigit(c); })) {
    const int index = std::stoi(wanted);
    return index < static_cast<int>(found.size()) ? index : -1;
  }
  return first([&](const Found& f) {
    return lower(f.info.name).find(wanted) != std::string::npos ||
           lower(f.info.platform).find(wanted) != std::string::npos;
  });
}

/// Reports that no device matches, lists the devices and says what to do.
[[noreturn]] void fail_to_match(const std::vector<Found>& found, const std::string& choice,
                                bool from_environment) {
  const KernelCacheStatus& cache = prepare_kernel_cache();
  if (found.empty() && cache.folder.empty()) {
    // PoCL offers no device if it cannot store its kernels; installing it again would not help.
    throw DeviceError(
        "no OpenCL device: PoCL needs a folder for compiled kernels, and no folder can be "
        "written: " +
        cache.trouble + "; set POCL_CACHE_DIR to a folder that can be written");
  }
  if (const std::string scarce = found.empty() ? scarcity() : ""; !scarce.empty())
    throw DeviceError("no OpenCL device: a driver is installed, but could not start: " + scarce);
  if (found.empty()) {
    throw DeviceError(
        "no OpenCL device: no platform is installed or none offers a device; install one, for "
        "example the CPU device "
        "with 'apt-get install pocl-opencl-icd' or your GPU vendor's OpenCL driver");
  }
  std::string text = "no OpenCL device matches '" + printable(choice) + "'";
  if (from_environment) text += " (from the environment variable NAVVY_DEVICE)";
  text += "; available devices:";
  for (const Found& f : found) text += "\n  " + f.info.text();
  text += "\nchoose cpu, gpu, an index or part of a name";
  throw DeviceError(text);
}

const char* kind_name(Kind kind) {
  return kind == Kind::kCpu ? "cpu" : kind == Kind::kGpu ? "gpu" : "other";
}

}  // namespace

// All calls whose failure matters go through here. The message names the OpenCL call, so that it
// can be looked up.
void check(cl_int code, const char* call, const Device::State& state, const std::string& kernel) {
  if (code == CL_SUCCESS) return;
  std::string text = std::string(call) + " failed: " + error_name(code);
  if (!kernel.empty()) text += ", kernel " + kernel;
  throw DeviceError(text + ", on device " + state.info.name, code);
}

std::string DeviceInfo::text() const {
  char memory_text[32];
  std::snprintf(memory_text, sizeof memory_text, "%.1f GiB",
                static_cast<double>(memory) / (1 << 30));
  return std::to_string(index) + ": " + kind_name(kind) + ", " + name + " (" + platform + ", " +
         version + "), " + std::to_string(compute_units) + " compute units, " + memory_text;
}

std::vector<DeviceInfo> list_devices() {
  std::vector<DeviceInfo> infos;
  for (Found& found : find_devices()) infos.push_back(std::move(found.info));
  return infos;
}

Device::State::~State() {
  if (shared == nullptr || shared->abandoned()) return;
  // Buffers, programs and kernels hold the state, so none of them is alive here. Queued work is
  // waited for, since releasing a queue does not wait.
  if (queue != nullptr) clFinish(queue);
  for (auto& [name, event] : events) clReleaseEvent(event);
  for (cl_command_queue one : queues) {
    if (one == nullptr) continue;
    shared->guard().remove(one);
    clReleaseCommandQueue(one);
  }
  // Seals now, in case the process is killed later: compiled kernels are then not compiled again.
  // That reads the whole folder, so it is done only if there is something new.
  if (shared->take_news()) seal_kernel_cache();
}

void Device::State::open_queues() {
  // Profiling cannot be switched on an existing queue, so new ones are created. The caller has
  // waited for the old ones.
  for (std::size_t i = 0; i < kDrivers; ++i) {
    if (queues[i] != nullptr) {
      shared->guard().remove(queues[i]);
      clReleaseCommandQueue(queues[i]);
    }
    queues[i] = nullptr;
    const cl_device_id driver_of_queue = shared->driver(i);
    if (driver_of_queue == nullptr) continue;
    cl_int code = CL_SUCCESS;
    queues[i] = clCreateCommandQueue(shared->context(), driver_of_queue,
                                     profiling ? CL_QUEUE_PROFILING_ENABLE : 0, &code);
    check(code, "clCreateCommandQueue", *this);
    shared->guard().add(queues[i]);
  }
  queue = queues[driver];
}

void Device::State::finish() {
  require_no_fork();
  const LongWork work("the OpenCL driver was busy or did not answer");
  check(clFinish(queue), "clFinish", *this);
  compiling.reset();
  collect();
}

void Device::State::collect() {
  for (auto& [name, event] : events) {
    // Times of the device's clock [ns]; a driver that does not know one leaves zero.
    cl_ulong start = 0, end = 0;
    clGetEventProfilingInfo(event, CL_PROFILING_COMMAND_START, sizeof start, &start, nullptr);
    clGetEventProfilingInfo(event, CL_PROFILING_COMMAND_END, sizeof end, &end, nullptr);
    // Every event holds driver memory until it is released.
    clReleaseEvent(event);
    KernelTime& time = times[name];
    time.name = name;
    ++time.launches;
    time.seconds += static_cast<double>(end - start) * 1e-9;
  }
  events.clear();
}

namespace {

/// Returns the part of a device's memory that the environment allows [bytes].
std::uint64_t allowed_memory(std::uint64_t memory) {
  // A limit below the device's memory lets tests cause out-of-memory errors, and a run leave memory
  // to others.
  const char* variable = std::getenv("NAVVY_DEVICE_MEMORY_MIB");
  if (variable == nullptr || *variable == '\0') return memory;
  std::uint64_t mebibytes = 0;
  const std::string_view text(variable);
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), mebibytes);
  // Refused rather than ignored: a typing mistake must not remove the limit.
  if (error != std::errc() || end != text.data() + text.size() || mebibytes == 0 ||
      mebibytes > (1ULL << 40))
    throw DeviceError("NAVVY_DEVICE_MEMORY_MIB is '" + std::string(text) +
                      "': it must be a whole number of MiB");
  return std::min(memory, mebibytes << 20);
}

}  // namespace

Device::Device(const std::string& choice) : state_(std::make_shared<State>()) {
  const char* variable = std::getenv("NAVVY_DEVICE");
  // The program's choice takes precedence over the environment.
  const bool from_environment = choice.empty() && variable != nullptr && *variable != '\0';
  const std::string wanted = from_environment ? variable : choice;
  const std::vector<Found> found = find_devices();
  const int index = match(found, wanted);
  if (index < 0) fail_to_match(found, wanted, from_environment);
  const Found& pick = found[static_cast<std::size_t>(index)];
  state_->info = pick.info;
  state_->info.memory = allowed_memory(pick.info.memory);
  cl_int code = CL_SUCCESS;
  state_->shared = SharedContext::of(pick.platform, {pick.device, pick.caller}, code);
  check(code, "clCreateContext", *state_);
  state_->open_queues();
}

Device::~Device() = default;
Device::Device(Device&&) noexcept = default;
Device& Device::operator=(Device&&) noexcept = default;

const DeviceInfo& Device::info() const { return state_->info; }
std::uint64_t Device::memory_used() const { return state_->memory_used; }
void Device::finish() { state_->finish(); }

bool Device::has_caller_driver() const { return state_->shared->driver(1) != nullptr; }

void Device::run_in_caller(bool on) {
  const std::size_t wanted = on && has_caller_driver() ? 1 : 0;
  if (wanted == state_->driver) return;
  // Two queues have no common order, so the old one is emptied first.
  state_->finish();
  state_->driver = wanted;
  state_->queue = state_->queues[wanted];
}

void Device::set_profile(bool on) {
  if (on == state_->profiling) return;
  // The events of the old queue are collected before it is released.
  state_->finish();
  state_->profiling = on;
  state_->open_queues();
}

std::vector<KernelTime> Device::profile() {
  state_->finish();
  std::vector<KernelTime> rows;
  for (const auto& [name, time] : state_->times) rows.push_back(time);
  return rows;
}

void Device::clear_profile() {
  state_->finish();
  state_->times.clear();
}

}  // namespace navvy::device
