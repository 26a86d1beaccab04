// SPDX-License-Identifier: Apache-2.0
#include "record/record_file.h"

#include <fcntl.h>
#include <unistd.h>

#include <algorithm>
#include <bit>
#include <cerrno>
#include <cstdio>
#include <cstring>
#include <utility>

#include "core/error.h"
#include "core/file.h"
#include "record/file_copy.h"

namespace navvy::record {
namespace {

static_assert(std::endian::native == std::endian::little,
              "numbers are written as they are in memory");

/// Returns a text as NumPy's header quotes it.
std::string quoted(const std::string& text) {
  std::string out = "'";
  for (const char c : text) {
    if (c == '\'' || c == '\\') out += '\\';
    out += c;
  }
  return out + "'";
}

/// Returns the type of a record in NumPy's notation.
std::string descr_of(const std::vector<RecordField>& fields) {
  std::string out = "[";
  for (const RecordField& field : fields) {
    if (out.size() > 1) out += ", ";
    out += "(" + quoted(field.name) + ", " + quoted(field.type);
    // NumPy writes a tuple of one as (3,), so every extent is followed by a comma.
    std::string shape;
    for (const int extent : field.shape) shape += std::to_string(extent) + ",";
    out += shape.empty() ? ")" : ", (" + shape + "))";
  }
  return out + "]";
}

/// Returns the header. Its length does not depend on `records`.
std::string header_of(const std::string& descr, std::uint64_t records) {
  // 20 digits hold every 64-bit count, so the header can be rewritten in place as records are
  // added.
  char count[24];
  std::snprintf(count, sizeof count, "%20llu", static_cast<unsigned long long>(records));
  std::string dict =
      "{'descr': " + descr + ", 'fortran_order': False, 'shape': (" + count + ",), }";
  // Format 1.0 has two bytes for the length, 2.0 has four, 3.0 has UTF-8 as well.
  const bool ascii = std::all_of(dict.begin(), dict.end(),
                                 [](char c) { return static_cast<unsigned char>(c) < 128; });
  const int version = !ascii ? 3 : dict.size() > 65000 ? 2 : 1;
  const std::size_t before = version == 1 ? 10 : 12;
  // The data begin at a multiple of 64 bytes.
  dict.append(63 - (before + dict.size()) % 64, ' ');
  dict += '\n';
  std::string out = "\x93NUMPY";
  out += static_cast<char>(version);
  out += '\0';
  for (std::size_t i = 0; i < before - 8; ++i) out += static_cast<char>(dict.size() >> (8 * i));
  return out + dict;
}

/// Writes all of `text` at `offset`. Returns 0 or the errno of the failure.
int write_at(int file, const std::string& text, std::uint64_t offset) {
  for (std::size_t done = 0; done < text.size();) {
    const ssize_t n =
        ::pwrite(file, text.data() + done, text.size() - done, static_cast<off_t>(offset + done));
    // A signal may interrupt a write before any byte.
    if (n < 0 && errno == EINTR) continue;
    if (n <= 0) return n < 0 ? errno : ENOSPC;
    done += static_cast<std::size_t>(n);
  }
  return 0;
}

}  // namespace

RecordFile::RecordFile(std::string path, const std::vector<RecordField>& fields,
                       std::size_t record_bytes)
    : path_(std::move(path)), descr_(descr_of(fields)), record_bytes_(record_bytes) {}

RecordFile::~RecordFile() {
  if (file_ >= 0) ::close(file_);
}

void RecordFile::add(std::string_view record) {
  if (record.size() != record_bytes_)
    throw Error("a record of " + std::to_string(record.size()) + " bytes for '" + path_ +
                "', whose records have " + std::to_string(record_bytes_));
  waiting_ += record;
  ++records_;
  if (waiting_.size() >= kMaxWaiting) flush();
}

void RecordFile::fail(const char* action, int code) const {
  throw FileError(std::string("cannot ") + action + " '" + path_ + "': " + std::strerror(code));
}

void RecordFile::flush() {
  if (file_ >= 0 && waiting_.empty()) return;
  if (file_ < 0) {
    // A file of an earlier run is replaced as a whole, never overwritten in part.
    const std::string header = header_of(descr_, 0);
    write_file_atomically(path_, header);
    file_ = ::open(path_.c_str(), O_RDWR | O_CLOEXEC);
    if (file_ < 0) fail("open", errno);
    header_bytes_ = header.size();
  }
  append();
}

/// Writes at absolute positions, so a retry after a failure repeats the same bytes.
void RecordFile::append() {
  // Readers ignore what follows the counted records, so a failure in between does no harm.
  if (const int code = write_at(file_, waiting_, header_bytes_ + written_ * record_bytes_))
    fail("append to", code);
  const std::uint64_t count = written_ + waiting_.size() / record_bytes_;
  if (const int code = write_at(file_, header_of(descr_, count), 0)) fail("update", code);
  written_ = count;
  waiting_.clear();
}

void RecordFile::move_to(const std::string& path) {
  if (file_ >= 0) {
    const int copy = copy_to_new_file(file_, path, 0);
    ::close(std::exchange(file_, copy));
  }
  path_ = path;
}

void RecordFile::sync() {
  flush();
  if (file_ >= 0 && ::fsync(file_) != 0) fail("flush", errno);
}

}  // namespace navvy::record
