// SPDX-License-Identifier: Apache-2.0
#include "record/array_file.h"

#include <Eigen/Geometry>
#include <utility>

namespace navvy::record {
namespace {

/// Returns an element type as a NumPy type string.
const char* type_of(sim::ElementType type) {
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

}  // namespace

ArrayFile::ArrayFile(std::string path, const sim::ArrayChannel& channel)
    : file_(std::move(path),
            {{"sequence", "<u8", {}},
             {"time_s", "<f8", {}},
             {"position_m", "<f8", {3}},
             {"quaternion_wxyz", "<f8", {4}},
             {"values", type_of(channel.type), channel.shape}},
            // 8 bytes each for sequence, time, three of position and four of the quaternion.
            8 * 9 + channel.count() * sim::size_of(channel.type)) {}

void ArrayFile::add(const sim::ArrayView& value) {
  // The order is that of the fields.
  const Eigen::Quaterniond q(value.X_WF().linear());
  const Vec3 p = value.X_WF().translation();
  record_.clear();
  put_number(record_, value.sequence());
  put_number(record_, value.time());
  for (const double number : {p.x(), p.y(), p.z(), q.w(), q.x(), q.y(), q.z()})
    put_number(record_, number);
  record_.append(reinterpret_cast<const char*>(value.bytes().data()), value.bytes().size());
  file_.add(record_);
}

}  // namespace navvy::record
