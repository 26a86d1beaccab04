// SPDX-License-Identifier: Apache-2.0
#include "record/row_file.h"

#include <fcntl.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <utility>

#include "core/error.h"
#include "core/file.h"
#include "record/file_copy.h"

namespace navvy::record {
namespace {

/// Throws the error of a system call.
[[noreturn]] void fail(const std::string& action, const std::string& path, int code) {
  throw FileError("cannot " + action + " '" + path + "': " + std::strerror(code));
}

}  // namespace

RowFile::RowFile(std::string path, std::string header)
    : path_(std::move(path)), waiting_(std::move(header)) {
  // The buffer gets its maximum size at once, so memory does not grow during a run. Unused pages
  // cost nothing.
  waiting_.reserve(kMostWaiting + kMostWaiting / 16);
  waiting_ += '\n';
}

RowFile::~RowFile() {
  if (file_ >= 0) ::close(file_);
}

/// Appending to memory is all that most rows cost.
void RowFile::add(std::string_view row) {
  waiting_ += row;
  waiting_ += '\n';
  ++rows_;
  if (waiting_.size() >= kMostWaiting) flush();
}

void RowFile::flush() {
  if (waiting_.empty()) return;
  if (file_ < 0) {
    // A file of an earlier run is replaced as a whole, never overwritten in part.
    write_file_atomically(path_, waiting_);
    file_ = ::open(path_.c_str(), O_RDWR | O_APPEND | O_CLOEXEC);
    if (file_ < 0) fail("open", path_, errno);
    on_disk_ = waiting_.size();
    waiting_.clear();
    return;
  }
  std::size_t done = 0;
  while (done < waiting_.size()) {
    const ssize_t n = ::write(file_, waiting_.data() + done, waiting_.size() - done);
    if (n < 0) {
      if (errno == EINTR) continue;
      const int code = errno;
      // A full disk may have written a part of the rows. If the file cannot be cut, readers leave
      // out the row without an end.
      if (done > 0 && ::ftruncate(file_, static_cast<off_t>(on_disk_)) != 0)
        fail("cut", path_, errno);
      fail("append to", path_, code);
    }
    done += static_cast<std::size_t>(n);
  }
  on_disk_ += waiting_.size();
  waiting_.clear();
}

void RowFile::move_to(const std::string& path) {
  if (file_ >= 0) {
    const int copy = copy_to_new_file(file_, path, O_APPEND);
    ::close(std::exchange(file_, copy));
  }
  path_ = path;
}

void RowFile::sync() {
  flush();
  if (file_ >= 0 && ::fsync(file_) != 0) fail("flush", path_, errno);
}

}  // namespace navvy::record
