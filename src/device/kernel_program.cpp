// SPDX-License-Identifier: Apache-2.0
#include "device/kernel_program.h"

#include <algorithm>
#include <cstdio>

#include "core/long_work.h"
#include "device/kernel_cache.h"
#include "device/opencl_private.h"

namespace navvy::device {

// Shared by a program and its kernels, so that a kernel may outlive its Program object.
struct KernelProgram::State {
  std::shared_ptr<Device::State> device;
  std::string name;
  cl_program program = nullptr;

  State() = default;
  State(const State&) = delete;
  State& operator=(const State&) = delete;
  ~State() {
    if (program != nullptr && !device->lost) clReleaseProgram(program);
  }
};

struct Kernel::State {
  std::shared_ptr<KernelProgram::State> program;
  std::string name;
  cl_kernel kernel = nullptr;
  // Properties of the kernel, queried once so that a launch queries nothing.
  cl_uint arguments = 0;
  // Work-group size that the kernel requires.
  std::size_t group[3] = {1, 1, 1};
  // True after the first launch.
  bool launched = false;

  State() = default;
  State(const State&) = delete;
  State& operator=(const State&) = delete;
  ~State() {
    if (kernel != nullptr && !program->device->lost) clReleaseKernel(kernel);
  }
};

namespace {

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
  std::size_t size = 0;
  if (clGetProgramBuildInfo(program, device.device, CL_PROGRAM_BUILD_LOG, 0, nullptr, &size) !=
      CL_SUCCESS)
    return "";
  std::string log(size, '\0');
  if (clGetProgramBuildInfo(program, device.device, CL_PROGRAM_BUILD_LOG, size, log.data(),
                            nullptr) != CL_SUCCESS) {
    return "";
  }
  while (!log.empty() && (log.back() == '\0' || log.back() == '\n')) log.pop_back();
  return log;
}

/// Builds a program. Compilers are written in C++ and allocate with `new`: when out of memory they
/// throw through the driver's C code, which then keeps its locks for ever. All objects of the
/// driver are then given up, since releasing any program would wait for a lock.
cl_int build_or_give_up(KernelProgram::State& state, const std::string& flags) {
  const LongWork work("the OpenCL driver was busy compiling kernels");
  try {
    return clBuildProgram(state.program, 1, &state.device->device, flags.c_str(), nullptr, nullptr);
  } catch (const std::exception& error) {
    state.program = nullptr;
    state.device->lost = true;
    throw DeviceError("the OpenCL driver threw an exception (" + std::string(error.what()) +
                          ") while building kernels/" + state.name +
                          "; check whether the machine is out of memory",
                      CL_OUT_OF_HOST_MEMORY);
  }
}

/// Builds a program from a text.
/// @throws DeviceError with options and build log.
std::shared_ptr<KernelProgram::State> build(Device& device, const std::string& name,
                                            const std::string& text,
                                            const std::vector<std::string>& options) {
  auto state = std::make_shared<KernelProgram::State>();
  state->device = device.state();
  state->name = name;
  const std::string source = expand_includes(name, text);
  const char* data = source.c_str();
  const std::size_t size = source.size();
  cl_int code = CL_SUCCESS;
  state->program = clCreateProgramWithSource(state->device->context, 1, &data, &size, &code);
  check(code, "clCreateProgramWithSource", *state->device, name);
  std::string flags;
  for (const std::string& flag : compiler_flags(device.info())) flags += flag + " ";
  for (const std::string& option : options) flags += option + " ";
  // The notice ends with this scope, also when the build fails.
  const auto slow = log_if_slow(*state->device, "kernels/" + name);
  code = build_or_give_up(*state, flags);
  if (code != CL_SUCCESS) {
    throw DeviceError("kernels/" + name + " does not build: " + error_name(code) + ", on device " +
                          device.info().name + ", options: " + flags + "\n" +
                          build_log(state->program, *state->device),
                      code);
  }
  return state;
}

}  // namespace

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
  cl_int code = CL_SUCCESS;
  state_->kernel = clCreateKernel(state_->program->program, name.c_str(), &code);
  // The message names the file, as a wrong name is usually one that was renamed there.
  check(code, "clCreateKernel", device, name + " of kernels/" + state_->program->name);
  check(clGetKernelInfo(state_->kernel, CL_KERNEL_NUM_ARGS, sizeof state_->arguments,
                        &state_->arguments, nullptr),
        "clGetKernelInfo", device, name);
  check(clGetKernelWorkGroupInfo(state_->kernel, device.device, CL_KERNEL_COMPILE_WORK_GROUP_SIZE,
                                 sizeof state_->group, state_->group, nullptr),
        "clGetKernelWorkGroupInfo", device, name);
  // 0: the kernel requires none.
  for (std::size_t& size : state_->group) size = std::max<std::size_t>(size, 1);
}

void Kernel::expect(std::size_t count) const {
  if (count == state_->arguments) return;
  throw DeviceError("kernel " + state_->name + " takes " + std::to_string(state_->arguments) +
                        " arguments, " + std::to_string(count) + " were given",
                    CL_INVALID_KERNEL_ARGS);
}

void Kernel::set_buffer(unsigned index, const RawBuffer& buffer) {
  // A cl_mem is a pointer; its value is the argument.
  void* memory = buffer.handle();
  set_bytes(index, &memory, sizeof(void*));
}

void Kernel::set_bytes(unsigned index, const void* data, std::size_t bytes) {
  // Called before every launch by some callers, so the text of an error is built only if there is
  // one.
  const cl_int code = clSetKernelArg(state_->kernel, index, bytes, data);
  if (code == CL_SUCCESS) return;
  check(code, "clSetKernelArg", *state_->program->device,
        state_->name + ", argument " + std::to_string(index));
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

void Kernel::enqueue_groups(std::size_t groups) {
  const std::size_t* group = state_->group;
  launch(WorkSize(groups * group[0], group[1], group[2]), group);
}

void Kernel::launch(const WorkSize& global, const std::size_t* local) {
  if (global.n[0] == 0 || global.n[1] == 0 || global.n[2] == 0) return;
  Device::State& device = *state_->program->device;
  cl_event event = nullptr;
  // The driver may compile machine code at the first launch instead of at the build; the notice
  // ends at the next wait.
  if (!state_->launched && !device.compiling)
    device.compiling = log_if_slow(device, "kernel " + state_->name);
  state_->launched = true;
  const LongWork work("the OpenCL driver was busy compiling or starting a kernel");
  // With fewer axes a driver may choose better work-groups.
  const cl_uint axes = global.n[2] > 1 ? 3 : global.n[1] > 1 ? 2 : 1;
  check(clEnqueueNDRangeKernel(device.queue, state_->kernel, axes, nullptr, global.n, local, 0,
                               nullptr, device.profiling ? &event : nullptr),
        "clEnqueueNDRangeKernel", device, state_->name);
  if (event == nullptr) return;
  device.events.emplace_back(state_->name, event);
  // Bounds the number of live events in a long profiled run.
  constexpr std::size_t kMostEvents = 4096;
  if (device.events.size() >= kMostEvents) device.finish();
}

}  // namespace navvy::device
