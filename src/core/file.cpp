// SPDX-License-Identifier: Apache-2.0
#include "core/file.h"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <cstdio>
#include <cstring>
#include <filesystem>

#include "core/error.h"

namespace navvy {
namespace {

namespace fs = std::filesystem;

/// Longest chain of symbolic links that is followed; the system follows as many.
constexpr int kMostLinks = 40;

/// Throws with the system's reason. The code is a parameter, since closing and unlinking on the way
/// here may change errno.
[[noreturn]] void fail(const std::string& action, const std::string& path, int code) {
  throw FileError("cannot " + action + " '" + path + "': " + std::strerror(code));
}

/// Returns what a file is, as words of a message.
const char* kind_of(const struct stat& found) {
  return S_ISDIR(found.st_mode)    ? "a directory"
         : S_ISFIFO(found.st_mode) ? "a pipe"
         : S_ISSOCK(found.st_mode) ? "a socket"
                                   : "a device";
}

/// Refuses a target that a rename must not replace: the users of a pipe or a device node would not
/// notice.
/// @throws FileError unless `path` is missing or a regular file.
void require_replaceable(const std::string& path) {
  struct stat found = {};
  if (::stat(path.c_str(), &found) != 0) {
    if (errno == ELOOP) fail("write", path, ELOOP);
    return;
  }
  if (!S_ISREG(found.st_mode))
    throw FileError("cannot write '" + path + "': it is " + kind_of(found) +
                    ", and only a plain file can be replaced (name a file)");
}

/// Reports why the partial file of `path` could not be created; a missing folder is the most
/// frequent reason.
[[noreturn]] void fail_to_create(const std::string& path, int code) {
  const fs::path folder = fs::path(followed(path)).parent_path();
  std::error_code ignored;
  if (code == ENOENT && !folder.empty() && !fs::exists(folder, ignored))
    throw FileError("cannot write '" + path + "': there is no folder '" + folder.string() +
                    "' (create it: mkdir -p '" + folder.string() + "')");
  fail("create", partial_name(path), code);
}

// Writes the partial file and commits it. Readers of `path` see the old content until the rename in
// commit_file, and no failure leaves a partial file behind.
void write_bytes(const std::string& path, const char* data, std::size_t size) {
  require_replaceable(path);
  const std::string part = partial_name(path);
  const int fd = ::open(part.c_str(), O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC, 0644);
  if (fd < 0) fail_to_create(path, errno);
  while (size > 0) {
    // A write may be interrupted by a signal or write only a part; neither is an error.
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

std::string followed(const std::string& path) {
  fs::path at = path;
  std::error_code code;
  for (int links = 0; fs::is_symlink(fs::symlink_status(at, code)); ++links) {
    const fs::path to = fs::read_symlink(at, code);
    if (code || links == kMostLinks) return path;
    // A relative target is relative to the folder of the link.
    at = at.parent_path() / to;
  }
  return at.string();
}

std::string partial_name(const std::string& path) { return followed(path) + ".part"; }

void commit_file(const std::string& path) {
  const std::string part = partial_name(path);
  const int fd = ::open(part.c_str(), O_RDONLY | O_CLOEXEC);
  // Without the flush, a crash of the machine could leave the new name on an empty file, as the
  // rename may reach the disk before the data.
  if (fd < 0) {
    const int cause = errno;
    ::unlink(part.c_str());
    fail("open", part, cause);
  }
  // Failures below remove the partial file; `path` still holds the old content then.
  const int flushed = ::fsync(fd);
  const int code = errno;
  ::close(fd);
  if (flushed != 0) {
    ::unlink(part.c_str());
    fail("flush", part, code);
  }
  try {
    require_replaceable(path);
  } catch (...) {
    ::unlink(part.c_str());
    throw;
  }
  if (std::rename(part.c_str(), followed(path).c_str()) != 0) {
    const int cause = errno;
    ::unlink(part.c_str());
    fail("rename to", path, cause);
  }
}

void require_writable(const std::string& path) {
  // For a target that is no regular file, creating the partial file would succeed and only the
  // rename at the end of the run would fail.
  require_replaceable(path);
  const std::string part = partial_name(path);
  const int fd = ::open(part.c_str(), O_WRONLY | O_CREAT | O_CLOEXEC, 0644);
  if (fd < 0) fail_to_create(path, errno);
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
  throw FileError("cannot read '" + path + "': it is " + kind_of(found) +
                  ", a plain file is needed");
}

bool same_file(const std::string& a, const std::string& b) {
  std::error_code code;
  return !a.empty() && !b.empty() && fs::equivalent(a, b, code) && !code;
}

std::vector<char> read_file(const std::string& path, std::size_t most) {
  // Checked before opening: opening a pipe blocks, and some devices act on it.
  require_regular(path);
  std::FILE* file = std::fopen(path.c_str(), "rb");
  if (file == nullptr) fail("read", path, errno);
  std::vector<char> content;
  char buffer[65536];
  std::size_t n;
  while ((n = std::fread(buffer, 1, sizeof buffer, file)) > 0) {
    // Counted while reading, since some files do not report their size.
    if (n > most - content.size()) {
      std::fclose(file);
      throw FileError("cannot read '" + path + "': it has more than " + std::to_string(most) +
                      " bytes");
    }
    content.insert(content.end(), buffer, buffer + n);
  }
  // Queried before fclose, which invalidates the stream and may change errno.
  const bool bad = std::ferror(file) != 0;
  const int code = errno;
  std::fclose(file);
  if (bad) fail("read", path, code);
  return content;
}

}  // namespace navvy
