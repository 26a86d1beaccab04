// SPDX-License-Identifier: Apache-2.0
#include "core/file.h"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <cstdio>
#include <cstring>

#include "core/error.h"

namespace navvy {
namespace {

// The code is handed in, as closing and unlinking on the way here may change errno.
[[noreturn]] void fail(const std::string& action, const std::string& path, int code) {
  throw FileError("cannot " + action + " '" + path + "': " + std::strerror(code));
}

// Until the rename of commit_file a reader of `path` sees the old content; whatever fails before it leaves no partial
// file behind.
void write_bytes(const std::string& path, const char* data, std::size_t size) {
  const std::string part = partial_name(path);
  const int fd = ::open(part.c_str(), O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC, 0644);
  if (fd < 0) fail("create", part, errno);
  while (size > 0) {
    // A write may be interrupted by a signal or take a part only; neither is an error.
    const ssize_t n = ::write(fd, data, size);
    if (n < 0) {
      if (errno == EINTR) continue;
      const int code = errno;
      ::close(fd);
      ::unlink(part.c_str());
      fail("write", part, code);
    }
    data += n;
    size -= static_cast<std::size_t>(n);
  }
  // Network file systems may report a full disk only here.
  if (::close(fd) != 0) {
    const int code = errno;
    ::unlink(part.c_str());
    fail("close", part, code);
  }
  commit_file(path);
}

}  // namespace

std::string partial_name(const std::string& path) { return path + ".part"; }

void commit_file(const std::string& path) {
  const std::string part = partial_name(path);
  const int fd = ::open(part.c_str(), O_RDONLY | O_CLOEXEC);
  // Without the flush a crash of the machine could leave the new name on an empty file: the rename may reach the disk
  // before the data does.
  if (fd < 0) {
    const int cause = errno;
    ::unlink(part.c_str());
    fail("open", part, cause);
  }
  const int flushed = ::fsync(fd);
  const int code = errno;
  ::close(fd);
  if (flushed != 0) {
    ::unlink(part.c_str());
    fail("flush", part, code);
  }
  if (std::rename(part.c_str(), path.c_str()) != 0) {
    const int cause = errno;
    ::unlink(part.c_str());
    fail("rename to", path, cause);
  }
}

void require_writable(const std::string& path) {
  struct stat found = {};
  // A folder of that name would let the partial file be made and only the rename at the end of the run fail.
  if (::stat(path.c_str(), &found) == 0 && S_ISDIR(found.st_mode)) fail("write", path, EISDIR);
  const std::string part = partial_name(path);
  const int fd = ::open(part.c_str(), O_WRONLY | O_CREAT | O_CLOEXEC, 0644);
  if (fd < 0) fail("create", part, errno);
  ::close(fd);
  ::unlink(part.c_str());
}

void write_file_atomically(const std::string& path, const std::string& content) {
  write_bytes(path, content.data(), content.size());
}
void write_file_atomically(const std::string& path, const std::vector<char>& content) {
  write_bytes(path, content.data(), content.size());
}

void require_regular(const std::string& path) {
  struct stat found = {};
  if (::stat(path.c_str(), &found) != 0 || S_ISREG(found.st_mode)) return;
  const char* what = S_ISDIR(found.st_mode)    ? "a directory"
                     : S_ISFIFO(found.st_mode) ? "a pipe"
                     : S_ISSOCK(found.st_mode) ? "a socket"
                                               : "a device";
  throw FileError("cannot read '" + path + "': it is " + what + ", a plain file is needed");
}

std::vector<char> read_file(const std::string& path, std::size_t most) {
  // Asked before it is opened: opening a pipe waits, and some devices act on it.
  require_regular(path);
  std::FILE* file = std::fopen(path.c_str(), "rb");
  if (file == nullptr) fail("read", path, errno);
  std::vector<char> content;
  char buffer[65536];
  std::size_t n;
  while ((n = std::fread(buffer, 1, sizeof buffer, file)) > 0) {
    // Counted while reading, as some files do not tell their size.
    if (n > most - content.size()) {
      std::fclose(file);
      throw FileError("cannot read '" + path + "': it has more than " + std::to_string(most) + " bytes");
    }
    content.insert(content.end(), buffer, buffer + n);
  }
  // Asked for before fclose, after which the stream is gone and errno may be another.
  const bool bad = std::ferror(file) != 0;
  const int code = errno;
  std::fclose(file);
  if (bad) fail("read", path, code);
  return content;
}

}  // namespace navvy
