// SPDX-License-Identifier: Apache-2.0
#include "device/kernel_program.h"
#include "folder.h"
#include "paths.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <string>
#include <vector>

namespace navvy::device {
namespace {

const char* kAdd = R"(#include "common/portable.h"
kernel void add(global const float* a, global const float* b, global float* sum, int n) {
  const int i = get_global_id(0);
  if (i < n) sum[i] = a[i] + b[i];
}
)";

struct VectorAdd : testing::TestWithParam<std::size_t> {};

TEST_P(VectorAdd, EqualsTheHostOnOddSizesForAllWorkGroups) {
  Device device;
  const KernelProgram program = KernelProgram::from_text(device, "add.cl", kAdd);
  Kernel add(program, "add");
  const std::size_t n = GetParam();
  std::vector<float> a(n), b(n), expected(n);
  for (std::size_t i = 0; i < n; ++i) {
    a[i] = 0.1f * static_cast<float>(i);
    b[i] = 1.0f / static_cast<float>(i + 1);
    expected[i] = a[i] + b[i];
  }
  const Buffer<float> device_a(device, a), device_b(device, b);
  Buffer<float> sum(device, n);
  add.args(device_a, device_b, sum, static_cast<int>(n));
  for (std::size_t group : {1, 7, 64, 256}) {
    if (group > device.info().max_work_group) continue;
    sum.fill(-1);
    add.enqueue(n, group);
    EXPECT_EQ(sum.read(), expected) << "work-group " << group;
  }
  sum.fill(-1);
  add.enqueue(n);
  EXPECT_EQ(sum.read(), expected) << "work-group chosen by the driver";
}

INSTANTIATE_TEST_SUITE_P(Sizes, VectorAdd, testing::Values(0, 1, 2, 63, 1001, 65537));

std::string build_error(const std::string& name, const std::string& text) {
  Device device;
  try {
    KernelProgram::from_text(device, name, text);
  } catch (const DeviceError& error) {
    return error.what();
  }
  return "";
}

TEST(KernelProgram, NamesFileAndLineOfABuildError) {
  // The include is long; the line is counted in the file that includes it.
  const std::string text = build_error(
      "soil/broken.cl", "#include \"common/portable.h\"\n\nkernel void f() { int x = nope; }\n");
  EXPECT_NE(text.find("soil/broken.cl:3"), std::string::npos) << text;
  EXPECT_NE(text.find("CL_BUILD_PROGRAM_FAILURE"), std::string::npos) << text;
  EXPECT_NE(text.find("nope"), std::string::npos) << text;
}

TEST(KernelProgram, NamesFilesForACompilerThatCountsTheLinesOfTheWholeText) {
  const std::string text = expand_includes(
      "soil/broken.cl", "#include \"common/portable.h\"\n\nkernel void f() { int x = nope; }\n");
  const auto line =
      1 + std::count(text.begin(),
                     text.begin() + static_cast<std::ptrdiff_t>(text.find("kernel void f")), '\n');
  EXPECT_GT(line, 10);
  EXPECT_EQ(with_files("<kernel>:" + std::to_string(line) + ":27: error: nope\n ^", text),
            "soil/broken.cl:3:27: error: nope\n ^");
  EXPECT_EQ(with_files("<kernel>:3:1: a", text), "common/portable.h:1:1: a");
  // Lines that the text does not have stay as they are.
  EXPECT_EQ(with_files("<kernel>:99999:1: a, <kernel>:b", text), "<kernel>:99999:1: a, <kernel>:b");
}

TEST(KernelProgram, NamesTheLineOfAMissingInclude) {
  const std::string text = build_error("soil/x.cl", "\n#include \"common/absent.h\"\n");
  EXPECT_NE(text.find("soil/x.cl:2: no kernel file 'common/absent.h'"), std::string::npos) << text;
}

TEST(KernelProgram, EmbedsEveryKernelFile) {
  const std::filesystem::path root = std::filesystem::path(navvy::source_dir()) / "kernels";
  for (const auto& entry : std::filesystem::recursive_directory_iterator(root)) {
    const std::string extension = entry.path().extension();
    if (extension != ".cl" && extension != ".h") continue;
    const std::string path = entry.path().lexically_relative(root);
    std::ifstream file(entry.path());
    EXPECT_EQ(kernel_source(path), std::string(std::istreambuf_iterator<char>(file), {})) << path;
  }
}

TEST(KernelProgram, IncludesEachFileOnceAndKeepsLineNumbers) {
  const std::string text = expand_includes(
      "a.cl", "#include \"common/portable.h\"\n # include \"common/portable.h\"\nint x;\n");
  EXPECT_EQ(text.find("FP_CONTRACT"), text.rfind("FP_CONTRACT"));
  EXPECT_NE(text.find("#line 3 \"a.cl\"\nint x;"), std::string::npos) << text;
}

TEST(KernelProgram, ReadsKernelsFromTheFolderInTheEnvironment) {
  const test::Folder own;
  const std::filesystem::path& folder = own.path();
  std::filesystem::create_directories(folder / "common");
  std::ofstream(folder / "common/edited.cl")
      << "kernel void edited(global int* x) { x[0] = 42; }\n";
  ::setenv("NAVVY_KERNEL_DIR", folder.c_str(), 1);
  Device device;
  Buffer<int> x(device, 1);
  const KernelProgram program(device, "common/edited.cl");
  EXPECT_THROW(kernel_source("common/portable.h"), DeviceError);
  ::unsetenv("NAVVY_KERNEL_DIR");
  Kernel(program, "edited").args(x).enqueue(1);
  EXPECT_EQ(x.read(), std::vector<int>{42});
}

TEST(KernelSources, NameTheFilesThatAFolderChanges) {
  ::unsetenv("NAVVY_KERNEL_DIR");
  const KernelSources shipped = kernel_sources();
  EXPECT_EQ(shipped.hash.size(), 16u);
  EXPECT_EQ(shipped.folder, "");
  EXPECT_TRUE(shipped.changed.empty());
  const test::Folder own;
  std::filesystem::copy(navvy::source_dir() + "/kernels", own.path(),
                        std::filesystem::copy_options::recursive);
  ::setenv("NAVVY_KERNEL_DIR", own.path().c_str(), 1);
  const KernelSources copied = kernel_sources();
  std::ofstream(own / "soil/law.h", std::ios::app) << "\n";
  std::filesystem::remove(own / "common/portable.h");
  const KernelSources edited = kernel_sources();
  ::unsetenv("NAVVY_KERNEL_DIR");
  EXPECT_EQ(copied.hash, shipped.hash);
  EXPECT_EQ(copied.folder, own.path().string());
  EXPECT_TRUE(copied.changed.empty());
  EXPECT_NE(edited.hash, shipped.hash);
  EXPECT_EQ(edited.changed, (std::vector<std::string>{"common/portable.h", "soil/law.h"}));
}

TEST(KernelProgram, DoesNotContract) {
  Device device;
  const std::string text =
      "#include \"common/portable.h\"\n"
      "kernel void f(global const float* x, global float* y) { y[0] = x[0] * x[1] + x[2]; }\n";
  const KernelProgram program = KernelProgram::from_text(device, "f.cl", text);
  // (1 + 2^-12)^2 - 1 loses its last bit when the product is rounded, keeps it when fused.
  const float a = 1.0f + 0x1p-12f;
  const Buffer<float> x(device, std::vector<float>{a, a, -1.0f});
  Buffer<float> y(device, 1);
  Kernel(program, "f").args(x, y).enqueue(1);
  EXPECT_EQ(y.read().front(), 0x1p-11f);
}

TEST(KernelProgram, RoundsDivisionAndRootLikeTheHost) {
  Device device;
  if (!device.info().correct_divide_sqrt)
    GTEST_SKIP() << device.info().name << " cannot round them correctly";
  const KernelProgram program = KernelProgram::from_text(
      device, "f.cl",
      "kernel void f(global const float* x, global float* y) {\n"
      "  const int i = get_global_id(0); y[2 * i] = 1 / x[i]; y[2 * i + 1] = sqrt(x[i]); }\n");
  std::vector<float> x(1000), expected(2000);
  for (std::size_t i = 0; i < x.size(); ++i) {
    x[i] = 0.37f + 1.13f * static_cast<float>(i);
    expected[2 * i] = 1 / x[i];
    expected[2 * i + 1] = std::sqrt(x[i]);
  }
  const Buffer<float> in(device, x);
  Buffer<float> out(device, expected.size());
  Kernel(program, "f").args(in, out).enqueue(x.size());
  EXPECT_EQ(out.read(), expected);
}

TEST(Kernel, TakesScalarsStructsAndLocalMemory) {
  Device device;
  const KernelProgram program = KernelProgram::from_text(device, "f.cl", R"(
typedef struct { int a; float b; } Pair;
kernel void f(global float* out, Pair pair, long n, local float* scratch) {
  const int i = get_local_id(0);
  scratch[i] = pair.a + pair.b * i;
  barrier(CLK_LOCAL_MEM_FENCE);
  if (get_global_id(0) < n) out[get_global_id(0)] = scratch[get_local_size(0) - 1 - i];
})");
  struct Pair {
    int a;
    float b;
  };
  Buffer<float> out(device, 4);
  Kernel(program, "f")
      .args(out, Pair{3, 0.5f}, std::int64_t{4}, LocalMemory{4 * sizeof(float)})
      .enqueue(4, 4);
  EXPECT_EQ(out.read(), (std::vector<float>{4.5f, 4, 3.5f, 3}));
}

TEST(Kernel, RunsOverTwoAndThreeAxes) {
  Device device;
  const KernelProgram program = KernelProgram::from_text(device, "f.cl", R"(
kernel void f(global int* out) {
  const int x = get_global_id(0), y = get_global_id(1), z = get_global_id(2);
  if (x < 3 && y < 5 && z < 2) out[x + 3 * (y + 5 * z)] = 100 * z + 10 * y + x;
})");
  Buffer<int> out(device, 30);
  out.fill(-1);
  Kernel(program, "f").args(out).enqueue({3, 5, 2}, {2, 2, 1});
  const std::vector<int> values = out.read();
  EXPECT_EQ(values[0], 0);
  EXPECT_EQ(values[29], 142);
  EXPECT_EQ(std::count(values.begin(), values.end(), -1), 0);
}

TEST(Kernel, RunsEachGroupOnce) {
  Device device;
  const KernelProgram program = KernelProgram::from_text(device, "f.cl", R"(
#include "common/group_index.h"
kernel void one(global int* out) { ++out[group_index()]; }
__attribute__((reqd_work_group_size(4, 1, 1))) kernel void four(global int* out) {
  ++out[4 * group_index() + get_local_id(0)];
})");
  // Around 2^16 groups another axis counts them.
  constexpr std::size_t kMost = 65537;
  Buffer<int> out(device, 4 * kMost);
  for (const std::size_t groups :
       {std::size_t{0}, std::size_t{1}, std::size_t{63}, kMost - 2, kMost - 1, kMost})
    for (const std::size_t size : {1, 4}) {
      out.fill(0);
      Kernel(program, size == 1 ? "one" : "four").args(out).enqueue_groups(groups);
      const std::vector<int> found = out.read();
      const std::size_t end = size * groups;
      EXPECT_EQ(std::count(found.begin(), found.begin() + static_cast<std::ptrdiff_t>(end), 1),
                static_cast<std::ptrdiff_t>(end))
          << groups << " of " << size;
      EXPECT_EQ(std::count(found.begin(), found.end(), 0),
                static_cast<std::ptrdiff_t>(4 * kMost - end));
    }
}

TEST(Kernel, RefusesWrongArgumentsByName) {
  Device device;
  const KernelProgram program = KernelProgram::from_text(device, "add.cl", kAdd);
  EXPECT_THROW(Kernel(program, "subtract"), DeviceError);
  Kernel add(program, "add");
  try {
    add.args(1);
    FAIL() << "one argument was accepted for four";
  } catch (const DeviceError& error) {
    EXPECT_STREQ(error.what(), "kernel add takes 4 arguments, 1 were given");
  }
  Buffer<float> a(device, 1);
  EXPECT_THROW(add.args(a, a, a, 1.0), DeviceError) << "a double is not an int";
}

}  // namespace
}  // namespace navvy::device
