// SPDX-License-Identifier: Apache-2.0
#include "device/scarcity.h"

#include <fcntl.h>
#include <sys/resource.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <cstdlib>
#include <filesystem>
#include <system_error>

namespace navvy::device {
namespace {

namespace fs = std::filesystem;

/// Returns true if the OpenCL loader would find a driver, or if that cannot be read.
bool is_driver_installed() {
  for (const char* given : {"OCL_ICD_VENDORS", "OCL_ICD_FILENAMES"})
    if (std::getenv(given) != nullptr) return true;
  std::error_code error;
  const fs::directory_iterator files("/etc/OpenCL/vendors", error);
  if (error) return error != std::errc::no_such_file_or_directory;
  return files != fs::directory_iterator();
}

/// Returns true if the process cannot open as many files as a driver needs at once.
bool is_short_of_files() {
  std::array<int, 16> files{};
  int code = 0;
  for (int& file : files) {
    file = ::open("/dev/null", O_RDONLY | O_CLOEXEC);
    if (file < 0) code = errno;
  }
  for (const int file : files)
    if (file >= 0) ::close(file);
  return code == EMFILE || code == ENFILE;
}

}  // namespace

std::string scarcity() {
  if (!is_driver_installed()) return "";
  rlimit limit{};
  if (is_short_of_files() && getrlimit(RLIMIT_NOFILE, &limit) == 0)
    return "the process may open only " + std::to_string(limit.rlim_cur) +
           " files; raise the limit with `ulimit -n 1024`";
  // PoCL with its compiler maps some 600 MiB.
  constexpr rlim_t kMib = rlim_t{1} << 20;
  for (const auto& [resource, option] : {std::pair{RLIMIT_AS, "-v"}, {RLIMIT_DATA, "-d"}})
    if (getrlimit(resource, &limit) == 0 && limit.rlim_cur < 2048 * kMib)
      return "the memory of the process is limited to " + std::to_string(limit.rlim_cur / kMib) +
             " MiB, and a driver with its compiler needs about 700 MiB; raise the limit with "
             "`ulimit " +
             option + " unlimited`";
  return "";
}

}  // namespace navvy::device
