// SPDX-License-Identifier: Apache-2.0
#include "record/array_file.h"

#include <fcntl.h>
#include <unistd.h>

#include <Eigen/Geometry>
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

/// Returns an element type as a NumPy type string.
const char* descr_of(sim::ElementType type) {
  switch (type) {
    case sim::ElementType::kUint8:
      return "|u1";
    case sim::ElementType::kUint16:
      return "<u2";
    case sim::ElementType::kInt32:
      return "<i4";
    case sim::ElementType::kFloat32:
      return "<f4";
    case sim::ElementType::kFloat64:
      break;
  }
  return "<f8";
}

/// Returns the type of a record: stamp, pose, values.
std::string record_descr(const sim::ArrayChannel& channel) {
  // NumPy writes a tuple of one as (3,), so every extent is followed by a comma.
  std::string shape;
  for (const int extent : channel.shape) shape += std::to_string(extent) + ",";
  return std::string("[('sequence', '<u8'), ('time_s', '<f8'), ('position_m', '<f8', (3,)), ") +
         "('quaternion_wxyz', '<f8', (4,)), ('values', '" + descr_of(channel.type) + "', (" +
         shape + "))]";
}

/// Returns the header of format 1.0. Its length does not depend on `records`.
std::string header_of(const std::string& descr, std::uint64_t records) {
  // 20 digits hold every 64-bit count, so the header can be rewritten in place as records are
  // added.
  char count[24];
  std::snprintf(count, sizeof count, "%20llu", static_cast<unsigned long long>(records));
  std::string dict =
      "{'descr': " + descr + ", 'fortran_order': False, 'shape': (" + count + ",), }";
  // Magic, version and length count too; the data begin at a multiple of 64 bytes.
  dict.append(63 - (10 + dict.size()) % 64, ' ');
  dict += '\n';
  std::string out("\x93NUMPY\x01\x00", 8);
  out += static_cast<char>(dict.size() & 0xFF);
  out += static_cast<char>(dict.size() >> 8);
  return out + dict;
}

/// Appends the bytes of a number.
template <class T>
void put(std::string& out, const T& value) {
  out.append(reinterpret_cast<const char*>(&value), sizeof value);
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

ArrayFile::ArrayFile(std::string path, const sim::ArrayChannel& channel)
    : path_(std::move(path)),
      descr_(record_descr(channel)),
      // 8 bytes each for sequence, time, three of position and four of the quaternion.
      record_bytes_(8 * 9 + channel.count() * sim::size_of(channel.type)) {}

ArrayFile::~ArrayFile() {
  if (file_ >= 0) ::close(file_);
}

void ArrayFile::add(const sim::ArrayView& value) {
  // The order of fields is that of record_descr.
  const Eigen::Quaterniond q(value.X_WF().linear());
  const Vec3 p = value.X_WF().translation();
  put(waiting_, value.sequence());
  put(waiting_, value.time());
  for (const double number : {p.x(), p.y(), p.z(), q.w(), q.x(), q.y(), q.z()})
    put(waiting_, number);
  waiting_.append(reinterpret_cast<const char*>(value.bytes().data()), value.bytes().size());
  ++records_;
  if (waiting_.size() >= kMaxWaiting) flush();
}

void ArrayFile::fail(const char* action, int code) const {
  throw FileError(std::string("cannot ") + action + " '" + path_ + "': " + std::strerror(code));
}

void ArrayFile::flush() {
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
void ArrayFile::append() {
  // Readers ignore what follows the counted records, so a failure in between does no harm.
  if (const int code = write_at(file_, waiting_, header_bytes_ + written_ * record_bytes_))
    fail("append to", code);
  const std::uint64_t count = written_ + waiting_.size() / record_bytes_;
  if (const int code = write_at(file_, header_of(descr_, count), 0)) fail("update", code);
  written_ = count;
  waiting_.clear();
}

void ArrayFile::move_to(const std::string& path) {
  if (file_ >= 0) {
    const int copy = copy_to_new_file(file_, path, 0);
    ::close(std::exchange(file_, copy));
  }
  path_ = path;
}

void ArrayFile::sync() {
  flush();
  if (file_ >= 0 && ::fsync(file_) != 0) fail("flush", errno);
}

}  // namespace navvy::record
