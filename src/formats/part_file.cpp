// SPDX-License-Identifier: Apache-2.0
#include "formats/part_file.h"

#include <unistd.h>

#include <cerrno>
#include <cstring>

#include "core/error.h"
#include "core/file.h"

namespace navvy::formats {

PartFile::PartFile(const std::string& path)
    : path_(path), part_(partial_name(path)), file_(nullptr) {
  // Checked first, before gigabytes are written for a place that is then refused.
  require_writable(path);
  file_ = std::fopen(part_.c_str(), "wb");
  if (file_ == nullptr) fail();
}

// Also runs when an exception leaves the writer.
PartFile::~PartFile() {
  if (file_ == nullptr) return;
  std::fclose(file_);
  ::unlink(part_.c_str());
}

void PartFile::fail() { throw FileError("cannot write '" + path_ + "': " + std::strerror(errno)); }

// Buffered by the C library: pieces may be small.
void PartFile::write(const void* data, std::size_t count) {
  if (std::fwrite(data, 1, count, file_) != count) fail();
}

void PartFile::commit() {
  std::FILE* file = file_;
  file_ = nullptr;
  // Buffered bytes are written here, so a full disk may show only now.
  if (std::fclose(file) != 0) {
    const int code = errno;
    ::unlink(part_.c_str());
    errno = code;
    fail();
  }
  commit_file(path_);
}

}  // namespace navvy::formats
