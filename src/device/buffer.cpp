// SPDX-License-Identifier: Apache-2.0
#include "device/buffer.h"

#include <array>
#include <cstdio>

#include "core/long_work.h"
#include "device/opencl_private.h"
#include "device/traffic_private.h"

namespace navvy::device {

namespace {

std::string mebibytes(std::uint64_t bytes) {
  std::array<char, 32> text{};
  std::snprintf(text.data(), text.size(), "%.1f MiB", static_cast<double>(bytes) / (1 << 20));
  return text.data();
}

}  // namespace

struct RawBuffer::Memory {
  // Keeps the context and the queue alive: a buffer may outlive its Device object.
  std::shared_ptr<Device::State> device;
  cl_mem memory = nullptr;
  std::size_t size = 0;
  std::uint64_t number = 0;

  Memory(std::shared_ptr<Device::State> owner, std::size_t bytes) : device(std::move(owner)) {
    require_no_fork();
    // Memory that host and device share is allocated where both reach it, so that mapping copies
    // nothing.
    const cl_mem_flags flags =
        CL_MEM_READ_WRITE | (device->info.shares_memory ? CL_MEM_ALLOC_HOST_PTR : 0);
    cl_int code = CL_MEM_OBJECT_ALLOCATION_FAILURE;
    // A CPU driver would over-commit and be killed for it later, so the total is limited here.
    if (bytes <= device->info.memory && device->memory_used <= device->info.memory - bytes)
      memory = clCreateBuffer(device->shared->context(), flags, bytes, nullptr, &code);
    if (code != CL_SUCCESS) {
      throw DeviceError(
          "clCreateBuffer of " + std::to_string(bytes) + " bytes failed: " + error_name(code) +
              ", on device " + device->info.text() + "; " + std::to_string(device->memory_used) +
              " bytes are in use, so that " + mebibytes(device->memory_used + bytes) +
              " are wanted and the device allows " + mebibytes(device->info.memory) +
              "; use a larger soil cell, a smaller max_particles, or a device with more memory",
          code);
    }
    size = bytes;
    number = ++device->buffers_made;
    device->memory_used += bytes;
  }
  Memory(const Memory&) = delete;
  Memory& operator=(const Memory&) = delete;
  ~Memory() {
    if (!device->shared->abandoned()) clReleaseMemObject(memory);
    // Queued commands may still use the memory; the driver releases it after the last of them.
    device->memory_used -= size;
  }
};

namespace {
// OpenCL has no empty buffers, but a kernel argument needs one.
constexpr std::size_t kLeastBytes = 16;
}  // namespace

RawBuffer::RawBuffer(Device& device, std::size_t bytes)
    : memory_(std::make_shared<Memory>(device.state(), std::max(bytes, kLeastBytes))),
      capacity_(std::max(bytes, kLeastBytes)) {}

void RawBuffer::reserve(std::size_t bytes, std::size_t keep) {
  if (!memory_) throw DeviceError("a buffer without a device cannot grow: construct it with one");
  // Copies the values only, on the device, after all queued work. The old memory may be released at
  // once, as the queue holds it until the copy is done.
  auto bigger = std::make_shared<Memory>(memory_->device, bytes);
  if (keep > 0) {
    const Device::State& device = *memory_->device;
    check(clEnqueueCopyBuffer(device.queue, memory_->memory, bigger->memory, 0, 0, keep, 0, nullptr,
                              nullptr),
          "clEnqueueCopyBuffer", device);
  }
  memory_ = std::move(bigger);
  capacity_ = bytes;
}

void RawBuffer::write(const void* data, std::size_t offset, std::size_t bytes, bool wait) {
  if (bytes == 0) return;
  require_no_fork();
  // With `wait` the driver has taken its copy of the data on return. Earlier work need not be done,
  // so the notice of a slow compilation stays.
  const Device::State& device = *memory_->device;
  traffic_counters().write(bytes);
  check(clEnqueueWriteBuffer(device.queue, memory_->memory, wait ? CL_TRUE : CL_FALSE, offset,
                             bytes, data, 0, nullptr, nullptr),
        "clEnqueueWriteBuffer", device);
}

void RawBuffer::read(void* data, std::size_t offset, std::size_t bytes) const {
  if (bytes == 0) return;
  require_no_fork();
  Device::State& device = *memory_->device;
  traffic_counters().read(bytes, true);
  const LongWork work("the OpenCL driver was busy or did not answer");
  check(clEnqueueReadBuffer(device.queue, memory_->memory, CL_TRUE, offset, bytes, data, 0, nullptr,
                            nullptr),
        "clEnqueueReadBuffer", device);
  // The queue is in order, so a blocking read returns after everything queued before it,
  // compilation included.
  device.compiling.reset();
}

void RawBuffer::fill(const void* pattern, std::size_t pattern_bytes, std::size_t offset,
                     std::size_t bytes) {
  if (bytes == 0) return;
  require_no_fork();
  const Device::State& device = *memory_->device;
  const bool power_of_two = (pattern_bytes & (pattern_bytes - 1)) == 0;
  if (power_of_two && pattern_bytes <= 128) {
    check(clEnqueueFillBuffer(device.queue, memory_->memory, pattern, pattern_bytes, offset, bytes,
                              0, nullptr, nullptr),
          "clEnqueueFillBuffer", device);
    return;
  }
  // OpenCL fills with powers of two only; the host repeats other structs. The write waits, since
  // the repeated values live in this call only.
  std::vector<char> values(bytes);
  const char* source = static_cast<const char*>(pattern);
  for (std::size_t at = 0; at < bytes; at += pattern_bytes) {
    std::copy(source, source + pattern_bytes, values.begin() + static_cast<std::ptrdiff_t>(at));
  }
  write(values.data(), offset, bytes);
}

void* RawBuffer::map(Access access, std::size_t offset, std::size_t bytes, bool wait) const {
  require_no_fork();
  Device::State& device = *memory_->device;
  traffic_counters().read(bytes, wait);
  if (access == Access::kUpdate) traffic_counters().write(bytes);
  const cl_map_flags flags = access == Access::kRead ? CL_MAP_READ : CL_MAP_READ | CL_MAP_WRITE;
  cl_int code = CL_SUCCESS;
  const LongWork work("the OpenCL driver was busy or did not answer");
  void* at = clEnqueueMapBuffer(device.queue, memory_->memory, wait ? CL_TRUE : CL_FALSE, flags,
                                offset, bytes, 0, nullptr, nullptr, &code);
  check(code, "clEnqueueMapBuffer", device);
  // As with a blocking read, all work queued before is done now.
  if (wait) device.compiling.reset();
  return at;
}

void RawBuffer::unmap(void* at) const noexcept {
  if (memory_->device->shared->abandoned()) return;
  // A failure appears at the next call on the queue; a destructor must not throw.
  clEnqueueUnmapMemObject(memory_->device->queue, memory_->memory, at, 0, nullptr, nullptr);
}

void* RawBuffer::handle() const { return memory_ ? memory_->memory : nullptr; }

std::uint64_t RawBuffer::number() const { return memory_ ? memory_->number : 0; }

}  // namespace navvy::device
