// SPDX-License-Identifier: Apache-2.0
#include "record/file_copy.h"

#include <fcntl.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <vector>

#include "core/error.h"

namespace navvy::record {
namespace {

/// Copies all bytes. Returns 0 or the errno of the failure.
int copy_all(int from, int to) {
  std::vector<char> buffer(std::size_t{1} << 20);
  for (off_t at = 0;;) {
    const ssize_t got = ::pread(from, buffer.data(), buffer.size(), at);
    if (got < 0 && errno == EINTR) continue;
    if (got <= 0) return got < 0 ? errno : 0;
    for (ssize_t done = 0; done < got;) {
      const ssize_t put = ::write(to, buffer.data() + done, static_cast<std::size_t>(got - done));
      if (put < 0 && errno == EINTR) continue;
      if (put < 0) return errno;
      done += put;
    }
    at += got;
  }
}

}  // namespace

int copy_to_new_file(int from, const std::string& path, int flags) {
  const int to = ::open(path.c_str(), O_RDWR | O_CREAT | O_EXCL | O_CLOEXEC | flags, 0644);
  const int code = to < 0 ? errno : copy_all(from, to);
  if (code == 0) return to;
  if (to >= 0) ::close(to);
  throw FileError("cannot write '" + path + "': " + std::strerror(code));
}

}  // namespace navvy::record
