// SPDX-License-Identifier: Apache-2.0
#include "device/kernel_program.h"

#include <algorithm>
#include <cstdint>
#include <cstdio>
#include <cstring>

#include "core/long_work.h"
#include "device/kernel_cache.h"
#include "device/opencl_private.h"
#include "device/traffic_private.h"

namespace navvy::device {

// Shared by a program and its kernels, so that a kernel may outlive its Program object.
struct KernelProgram::State {
  std::shared_ptr<Device::State> device;
  std::string name;
  // Expanded source and compiler options, kept for the driver that has not been used yet.
  std::string source, flags;
  // One per driver, found when it is first needed: most runs use one driver only. They belong to
  // the context.
  cl_program programs[kDrivers] = {};

  /// Returns the program for the driver in use, and builds it if necessary.
  /// @throws DeviceError with options and build log
  cl_program built();
};

struct Kernel::State {
  /// Value of an argument, as last set.
  struct Argument {
    std::vector<unsigned char> value;
    std::size_t bytes = 0;      // size, also of local memory, which has no value
    std::uint64_t buffer = 0;   // number of the buffer; 0 for plain values
    bool known[kDrivers] = {};  // true for drivers whose kernel has this value
  };
  std::shared_ptr<KernelProgram::State> program;
  std::string name;
  // One per driver, created when it is first needed.
  cl_kernel kernels[kDrivers] = {};
  // Properties of the kernel, queried once so that a launch queries nothing.
  cl_uint count = 0;
  // Work-group size that the kernel requires.
  std::size_t group[3] = {1, 1, 1};
  std::vector<Argument> arguments;
  // True after the first launch on a driver.
  bool launched[kDrivers] = {};
  // Records of the launches on each driver; null before the first one.
  LaunchGuard::Record* records[kDrivers] = {};

  State() = default;
  State(const State&) = delete;
  State& operator=(const State&) = delete;
  ~State() {
    for (cl_kernel kernel : kernels)
      if (kernel != nullptr && !program->device->shared->abandoned()) clReleaseKernel(kernel);
  }
  /// Returns the kernel for the driver in use, and creates it if necessary.
  cl_kernel made();
  /// Passes an argument to the kernel of the driver in use, unless that has it already.
  void pass(unsigned index);
};

namespace {

/// PoCL compiles kernels for less than this number of work-items along each axis, where the first
/// two of a launch have less. It does not look at the third.
constexpr std::size_t kMostDeep = 1 << 16;

/// Returns a notice that is logged if the driver takes long to compile `what`.
std::unique_ptr<SlowCall> log_if_slow(const Device::State& device, const std::string& what) {
  const std::string& folder = prepare_kernel_cache().folder;
  return std::make_unique<SlowCall>(
      "the OpenCL driver (" + device.info.platform + ") is still compiling " + what + " for " +
      device.info.name + ", after " + std::to_string(static_cast<int>(SlowCall::kPatience)) +
      " s; some drivers take minutes" +
      (folder.empty() ? "" : ", once: the result is cached in " + folder));
}

/// Returns the build log without trailing zeros and empty lines, which would split an error's text.
std::string build_log(cl_program program, const Device::State& device) {
  const cl_device_id driver = device.shared->driver(device.driver);
  std::size_t size = 0;
  if (clGetProgramBuildInfo(program, driver, CL_PROGRAM_BUILD_LOG, 0, nullptr, &size) != CL_SUCCESS)
    return "";
  std::string log(size, '\0');
  if (clGetProgramBuildInfo(program, driver, CL_PROGRAM_BUILD_LOG, size, log.data(), nullptr) !=
      CL_SUCCESS) {
    return "";
  }
  while (!log.empty() && (log.back() == '\0' || log.back() == '\n')) log.pop_back();
  return log;
}

/// Builds a program for the driver in use. Compilers are written in C++ and allocate with `new`:
/// when out of memory they throw through the driver's C code, which then keeps its locks for ever.
/// All objects of the driver are then given up, since releasing any program would wait for a lock.
cl_int build_or_give_up(const KernelProgram::State& state, cl_program program) {
  const Device::State& device = *state.device;
  const cl_device_id driver = device.shared->driver(device.driver);
  const LongWork work("the OpenCL driver was busy compiling kernels");
  try {
    return clBuildProgram(program, 1, &driver, state.flags.c_str(), nullptr, nullptr);
  } catch (const std::exception& error) {
    device.shared->lose();
    throw DeviceError("the OpenCL driver threw an exception (" + std::string(error.what()) +
                          ") while building kernels/" + state.name +
                          "; check whether the machine is out of memory",
                      CL_OUT_OF_HOST_MEMORY);
  }
}

/// Builds the program of `state` for the driver in use.
/// @throws DeviceError with options and build log.
cl_program build_program(const KernelProgram::State& state) {
  const Device::State& device = *state.device;
  const char* data = state.source.c_str();
  const std::size_t size = state.source.size();
  cl_int code = CL_SUCCESS;
  const cl_program program =
      clCreateProgramWithSource(device.shared->context(), 1, &data, &size, &code);
  check(code, "clCreateProgramWithSource", device, state.name);
  // The notice ends with this scope, also when the build fails.
  const auto slow = log_if_slow(device, "kernels/" + state.name);
  code = build_or_give_up(state, program);
  if (code == CL_SUCCESS) return program;
  const std::string log = with_files(build_log(program, device), state.source);
  // Not kept: a later launch would report the missing machine code instead of the log.
  clReleaseProgram(program);
  throw DeviceError("kernels/" + state.name + " does not build: " + error_name(code) +
                        ", on device " + device.info.name + ", options: " + state.flags + "\n" +
                        log,
                    code);
}

/// Builds a program from a text.
/// @throws DeviceError with options and build log.
std::shared_ptr<KernelProgram::State> build(Device& device, const std::string& name,
                                            const std::string& text,
                                            const std::vector<std::string>& options) {
  auto state = std::make_shared<KernelProgram::State>();
  state->device = device.state();
  state->name = name;
  state->source = expand_includes(name, text);
  for (const std::string& flag : compiler_flags(device.info())) state->flags += flag + " ";
  for (const std::string& option : options) state->flags += option + " ";
  // Built at once, so that errors appear where the program is constructed.
  state->built();
  return state;
}

}  // namespace

// Worlds of one process share their programs: building them takes ten times as long as all else.
cl_program KernelProgram::State::built() {
  cl_program& program = programs[device->driver];
  if (program == nullptr) {
    require_no_fork();
    const std::string key = std::to_string(device->driver) + '\n' + flags + '\n' + source;
    program = device->shared->program(key, [this] { return build_program(*this); });
  }
  return program;
}

std::string define(const std::string& name, int value) {
  return "-D" + name + "=" + std::to_string(value);
}

std::string define(const std::string& name, float value) {
  // Hexadecimal digits keep every bit. Brackets separate a sign from what precedes the name.
  char text[64];
  std::snprintf(text, sizeof text, "=(%af)", static_cast<double>(value));
  return "-D" + name + text;
}

std::vector<std::string> compiler_flags(const DeviceInfo& device) {
  std::vector<std::string> flags;
  // The common denominator of PoCL and the GPU vendors; the kernels are written in it.
  flags.emplace_back("-cl-std=CL1.2");
  // Without it a GPU may round quotients to 2.5 ulp and roots to 3 ulp, each vendor differently.
  if (device.correct_divide_sqrt) flags.emplace_back("-cl-fp32-correctly-rounded-divide-sqrt");
  // Deliberately absent: -cl-fast-relaxed-math, -cl-finite-math-only,
  // -cl-unsafe-math-optimizations, -cl-mad-enable. They gain nothing measurable, hide NaNs and
  // change bits. common/portable.h switches off contraction, for which OpenCL C has a pragma and no
  // flag.
  return flags;
}

KernelProgram::KernelProgram(Device& device, const std::string& path,
                             const std::vector<std::string>& options)
    : state_(build(device, path, kernel_source(path), options)) {}

KernelProgram KernelProgram::from_text(Device& device, const std::string& name,
                                       const std::string& text,
                                       const std::vector<std::string>& options) {
  KernelProgram program;
  program.state_ = build(device, name, text, options);
  return program;
}

Kernel::Kernel(const KernelProgram& program, const std::string& name)
    : state_(std::make_shared<State>()) {
  state_->program = program.state();
  state_->name = name;
  const Device::State& device = *state_->program->device;
  const cl_kernel kernel = state_->made();
  check(clGetKernelInfo(kernel, CL_KERNEL_NUM_ARGS, sizeof state_->count, &state_->count, nullptr),
        "clGetKernelInfo", device, name);
  state_->arguments.resize(state_->count);
  check(clGetKernelWorkGroupInfo(kernel, device.shared->driver(device.driver),
                                 CL_KERNEL_COMPILE_WORK_GROUP_SIZE, sizeof state_->group,
                                 state_->group, nullptr),
        "clGetKernelWorkGroupInfo", device, name);
  // 0: the kernel requires none.
  for (std::size_t& size : state_->group) size = std::max<std::size_t>(size, 1);
}

cl_kernel Kernel::State::made() {
  cl_kernel& kernel = kernels[program->device->driver];
  if (kernel != nullptr) return kernel;
  cl_int code = CL_SUCCESS;
  kernel = clCreateKernel(program->built(), name.c_str(), &code);
  // The message names the file, as a wrong name is usually one that was renamed there.
  check(code, "clCreateKernel", *program->device, name + " of kernels/" + program->name);
  return kernel;
}

void Kernel::State::pass(unsigned index) {
  Argument& argument = arguments[index];
  bool& known = argument.known[program->device->driver];
  if (known) return;
  const void* data = argument.value.empty() ? nullptr : argument.value.data();
  const cl_int code = clSetKernelArg(made(), index, argument.bytes, data);
  // The text of an error is built only if there is one.
  if (code != CL_SUCCESS)
    check(code, "clSetKernelArg", *program->device, name + ", argument " + std::to_string(index));
  known = true;
}

void Kernel::expect(std::size_t count) const {
  if (count == state_->count) return;
  throw DeviceError("kernel " + state_->name + " takes " + std::to_string(state_->count) +
                        " arguments, " + std::to_string(count) + " were given",
                    CL_INVALID_KERNEL_ARGS);
}

void Kernel::set_buffer(unsigned index, const RawBuffer& buffer) {
  // A cl_mem is a pointer; its value is the argument.
  void* memory = buffer.handle();
  set_bytes(index, &memory, sizeof(void*), buffer.number());
}

void Kernel::set_bytes(unsigned index, const void* data, std::size_t bytes, std::uint64_t buffer) {
  if (index >= state_->count)
    check(CL_INVALID_ARG_INDEX, "clSetKernelArg", *state_->program->device,
          state_->name + ", argument " + std::to_string(index));
  State::Argument& argument = state_->arguments[index];
  // Most arguments are those of the launch before. A buffer is compared by its number, too: a new
  // one may have the address of one that is gone, and the driver may hold more than the address.
  const std::size_t held = data == nullptr ? 0 : bytes;
  const bool same = argument.bytes == bytes && argument.buffer == buffer &&
                    argument.value.size() == held &&
                    (held == 0 || std::memcmp(argument.value.data(), data, held) == 0);
  if (!same) {
    const auto* first = static_cast<const unsigned char*>(data);
    argument.value.assign(first, first + held);
    argument.bytes = bytes;
    argument.buffer = buffer;
    for (bool& known : argument.known) known = false;
  }
  state_->pass(index);
}

void Kernel::enqueue(WorkSize global) { launch(global, nullptr); }

void Kernel::enqueue(WorkSize global, WorkSize local) {
  for (int axis = 0; axis < 3; ++axis) {
    if (local.n[axis] == 0)
      throw DeviceError("kernel " + state_->name + ": a work-group needs at least one work-item");
    // The kernel guards its index against the work-items that this adds.
    global.n[axis] = (global.n[axis] + local.n[axis] - 1) / local.n[axis] * local.n[axis];
  }
  launch(global, local.n);
}

// PoCL before version 6 loads a copy of a kernel for each new largest number of work-items along
// the first and second axis, and after 128 copies unloads and loads one at almost every launch in
// the caller's thread: 28 % of the processor time in jobs/pit. It does not look
// at the third axis, so groups are counted along that.
void Kernel::enqueue_groups(std::size_t groups) {
  const std::size_t* group = state_->group;
  if (groups < kMostDeep && group[2] == 1 &&
      state_->program->device->shared->guard().keeps_copies()) {
    launch(WorkSize(group[0], group[1], groups), group);
    return;
  }
  launch(WorkSize(groups * group[0], group[1], group[2]), group);
}

void Kernel::launch(const WorkSize& global, const std::size_t* local) {
  if (global.n[0] == 0 || global.n[1] == 0 || global.n[2] == 0) return;
  require_no_fork();
  Device::State& device = *state_->program->device;
  const cl_kernel kernel = state_->made();
  // After a change of the driver its kernel may lack arguments that were set before. Those that
  // were never set are left for the launch to report.
  for (unsigned i = 0; i < state_->count; ++i)
    if (state_->arguments[i].bytes > 0) state_->pass(i);
  cl_event event = nullptr;
  // The driver may compile machine code at the first launch instead of at the build; the notice
  // ends at the next wait.
  bool& launched = state_->launched[device.driver];
  if (!launched) {
    device.shared->note_launch(state_->program->built(), state_->name);
    if (!device.compiling) device.compiling = log_if_slow(device, "kernel " + state_->name);
  }
  launched = true;
  LaunchGuard& guard = device.shared->guard();
  LaunchGuard::Record*& record = state_->records[device.driver];
  if (record == nullptr) record = &guard.record(state_->program->built(), state_->name);
  const LongWork work("the OpenCL driver was busy compiling or starting a kernel");
  // With fewer axes a driver may choose better work-groups.
  const cl_uint axes = global.n[2] > 1 ? 3 : global.n[1] > 1 ? 2 : 1;
  const auto enqueue = [&] {
    return clEnqueueNDRangeKernel(device.queue, kernel, axes, nullptr, global.n, local, 0, nullptr,
                                  device.profiling ? &event : nullptr);
  };
  // The driver with index 1 runs kernels in the caller's thread.
  const cl_int code = device.driver == 1
                          ? guard.launch_in_caller(device.queue, *record, enqueue)
                          : guard.launch(device.queue, *record, local, global.n, enqueue);
  check(code, "clEnqueueNDRangeKernel", device, state_->name);
  traffic_counters().launch();
  if (event == nullptr) return;
  device.events.emplace_back(state_->name, event);
  // Bounds the number of live events in a long profiled run.
  constexpr std::size_t kMostEvents = 4096;
  if (device.events.size() >= kMostEvents) device.finish();
}

}  // namespace navvy::device
