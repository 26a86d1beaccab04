// SPDX-License-Identifier: Apache-2.0
#include "device/device.h"

#include <gtest/gtest.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cctype>
#include <cstdio>
#include <cstdlib>
#include <string>
#include <vector>

#include "device/buffer.h"
#include "device/kernel_program.h"
#include "device/programs_built.h"

namespace navvy::device {
namespace {

std::string message_of(const std::string& choice) {
  try {
    Device device(choice);
  } catch (const DeviceError& error) {
    return error.what();
  }
  return "";
}

/// Sets NAVVY_DEVICE for one test and restores it.
class Environment {
 public:
  explicit Environment(const char* value) {
    if (const char* old = std::getenv("NAVVY_DEVICE")) old_ = old;
    ::setenv("NAVVY_DEVICE", value, 1);
  }
  ~Environment() {
    if (old_.empty()) {
      ::unsetenv("NAVVY_DEVICE");
    } else {
      ::setenv("NAVVY_DEVICE", old_.c_str(), 1);
    }
  }

 private:
  std::string old_;
};

TEST(Device, ListsItselfUnderItsIndex) {
  const std::vector<DeviceInfo> devices = list_devices();
  ASSERT_FALSE(devices.empty());
  for (std::size_t i = 0; i < devices.size(); ++i) {
    EXPECT_EQ(devices[i].index, static_cast<int>(i));
    EXPECT_FALSE(devices[i].name.empty());
    EXPECT_GT(devices[i].compute_units, 0);
    EXPECT_EQ(Device(std::to_string(i)).info().name, devices[i].name);
  }
}

TEST(Device, IsSelectedByKindAndByPartOfItsNameInAnyCase) {
  const DeviceInfo first = list_devices().front();
  std::string part = first.platform.substr(0, 6);
  for (char& c : part) c = static_cast<char>(std::toupper(static_cast<unsigned char>(c)));
  EXPECT_EQ(Device(part).info().platform, first.platform);
  const char* kind = first.kind == Kind::kCpu ? "CPU" : "GPU";
  EXPECT_EQ(Device(kind).info().kind, first.kind);
}

TEST(Device, IsSelectedByTheEnvironmentUnlessOneIsNamed) {
  Environment environment("no-such-device");
  EXPECT_NE(message_of("").find("environment variable NAVVY_DEVICE"), std::string::npos);
  EXPECT_EQ(Device("0").info().index, 0);
}

TEST(Device, ListsTheDevicesWhenNoneMatches) {
  const std::string text = message_of("quantum");
  EXPECT_NE(text.find("no OpenCL device matches 'quantum'"), std::string::npos) << text;
  EXPECT_NE(text.find(list_devices().front().name), std::string::npos) << text;
  EXPECT_NE(text.find("choose cpu, gpu, an index or part of a name"), std::string::npos) << text;
  EXPECT_NE(message_of("99").find("matches '99'"), std::string::npos);
}

TEST(DeviceDeathTest, NamesPackagesToInstallWithoutAPlatform) {
  // main() has then opened a device, so that the loader reads no list any more.
  if (std::getenv("NAVVY_TEST_DEVICE") != nullptr) GTEST_SKIP() << "NAVVY_TEST_DEVICE is set";
  // The child process starts anew, so that the loader reads the empty list of drivers.
  testing::FLAGS_gtest_death_test_style = "threadsafe";
  const auto without_platform = [] {
    ::setenv("OCL_ICD_VENDORS", "/dev/null/none", 1);
    ::unsetenv("NAVVY_DEVICE");
    try {
      Device device;
    } catch (const DeviceError& error) {
      std::fputs(error.what(), stderr);
      std::exit(list_devices().empty() ? 3 : 4);
    }
    std::exit(5);
  };
  EXPECT_EXIT(without_platform(), testing::ExitedWithCode(3),
              "no OpenCL device: .*apt-get install pocl-opencl-icd");
}

TEST(Device, SharesProgramsWithOtherDevicesOfItsDrivers) {
  const std::string text = "kernel void set(global int* x, int value) { x[0] = value; }";
  Device first, second;
  const std::uint64_t before = programs_built();
  const KernelProgram program = KernelProgram::from_text(first, "set", text);
  const KernelProgram same = KernelProgram::from_text(second, "set", text);
  EXPECT_EQ(programs_built(), before + 1);
  KernelProgram::from_text(second, "set", text, {define("N", 1)});
  EXPECT_EQ(programs_built(), before + 2) << "other options make another program";
  // Each device has its own queue, and kernels of one program keep their own arguments.
  Buffer<int> x(first, 1), y(second, 1);
  Kernel one(program, "set"), two(same, "set");
  one.args(x, 1);
  two.args(y, 2).enqueue(1);
  one.enqueue(1);
  EXPECT_EQ(x.read(), std::vector<int>{1});
  EXPECT_EQ(y.read(), std::vector<int>{2});
}

TEST(Device, IsRefusedInAForkedProcess) {
  Device device;
  Buffer<int> x(device, 1);
  const pid_t child = ::fork();
  if (child == 0) {
    // Every call would wait for threads of the driver that this process does not have.
    int refused = 0;
    const auto refuse = [&](const auto& call) {
      try {
        call();
      } catch (const DeviceError& error) {
        refused += std::string(error.what()).find("spawn") != std::string::npos ? 1 : 0;
      }
    };
    refuse([] { Device again; });
    refuse([&] { x.read(); });
    refuse([&] { device.finish(); });
    refuse([&] { Buffer<int> more(device, 1); });
    ::_exit(refused);
  }
  int status = 0;
  ASSERT_EQ(::waitpid(child, &status, 0), child);
  ASSERT_TRUE(WIFEXITED(status));
  EXPECT_EQ(WEXITSTATUS(status), 4);
  x.fill(3);
  EXPECT_EQ(x.read(), std::vector<int>{3});
}

TEST(Device, SumsKernelTimesByNameOnlyWhileProfiling) {
  Device device;
  const KernelProgram program = KernelProgram::from_text(
      device, "spin",
      "kernel void spin(global int* x) { for (int i = 0; i < 1000; ++i) x[0] = x[0] * 3 + i; }");
  Buffer<int> x(device, 1);
  x.fill(0);
  Kernel spin(program, "spin");
  spin.args(x).enqueue(1);
  EXPECT_TRUE(device.profile().empty());
  device.set_profile(true);
  for (int i = 0; i < 3; ++i) spin.enqueue(1);
  const std::vector<KernelTime> rows = device.profile();
  ASSERT_EQ(rows.size(), 1u);
  EXPECT_EQ(rows[0].name, "spin");
  EXPECT_EQ(rows[0].launches, 3u);
  EXPECT_GT(rows[0].seconds, 0);
  device.clear_profile();
  EXPECT_TRUE(device.profile().empty());
}

TEST(Device, OutlivesItsOwnerWhileBuffersExist) {
  Buffer<int> buffer;
  {
    Device device;
    buffer = Buffer<int>(device, std::vector<int>{4, 5});
  }
  EXPECT_EQ(buffer.read(), (std::vector<int>{4, 5}));
}

/// Adds a number to each value in work-groups of one work-item, so that threads have work to share.
const char* const kAdd =
    "kernel void add(global int* x, int n, local int* l) { l[0] = n; x[get_global_id(0)] += l[0]; "
    "}";

TEST(Device, RunsKernelsInTheCallersThreadWithTheSameArguments) {
  Device device;
  Buffer<int> x(device, std::vector<int>{1, 2, 3});
  Kernel add(KernelProgram::from_text(device, "add", kAdd), "add");
  add.args(x, 10, LocalMemory{4}).enqueue(3, 1);
  device.run_in_caller(true);
  // Arguments persist over the change, buffers keep their content.
  add.enqueue(3, 1);
  add.args(x, 100, LocalMemory{4}).enqueue(3, 1);
  EXPECT_EQ(x.read(), (std::vector<int>{121, 122, 123}));
  device.run_in_caller(false);
  add.enqueue(3, 1);
  EXPECT_EQ(x.read(), (std::vector<int>{221, 222, 223}));
}

TEST(Device, PassesANewBufferInThePlaceOfOneThatIsGone) {
  Device device;
  Kernel add(KernelProgram::from_text(device, "add", kAdd), "add");
  for (int i = 0; i < 20; ++i) {
    // Drivers give freed addresses again, so that handles of the past come back.
    Buffer<int> x(device, std::vector<int>{i, i});
    add.args(x, 1, LocalMemory{4}).enqueue(2, 1);
    EXPECT_EQ(x.read(), (std::vector<int>{i + 1, i + 1}));
  }
}

TEST(Device, SignalsNoThreadForKernelsInTheCallersThread) {
  Device device;
  if (!device.has_caller_driver()) GTEST_SKIP() << "no driver for the caller's thread";
  Buffer<int> x(device, std::vector<int>(64));
  Kernel add(KernelProgram::from_text(device, "add", kAdd), "add");
  device.run_in_caller(true);
  add.args(x, 1, LocalMemory{4}).enqueue(64, 1);
  device.finish();
  rusage before{}, after{};
  getrusage(RUSAGE_SELF, &before);
  for (int i = 0; i < 1000; ++i) {
    add.enqueue(64, 1);
    device.finish();
  }
  getrusage(RUSAGE_SELF, &after);
  // With worker threads each wait is a switch at least.
  EXPECT_LT(after.ru_nvcsw - before.ru_nvcsw, 100);
}

TEST(Device, ListsOneDeviceForBothDriversOfAProcessor) {
  for (const DeviceInfo& info : list_devices()) EXPECT_NE(info.name.substr(0, 6), "basic-");
}

TEST(DeviceError, NamesErrorsSymbolically) {
  EXPECT_EQ(error_name(-5), "CL_OUT_OF_RESOURCES");
  EXPECT_EQ(error_name(-1001), "CL_PLATFORM_NOT_FOUND_KHR");
  EXPECT_EQ(error_name(-4711), "CL error -4711");
}

}  // namespace
}  // namespace navvy::device
