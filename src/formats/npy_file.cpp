// SPDX-License-Identifier: Apache-2.0
#include "formats/npy_file.h"

#include <bit>
#include <cstddef>

namespace navvy::formats {
namespace {

static_assert(std::endian::native == std::endian::little,
              "numbers are written in the byte order of memory");

std::vector<std::uint64_t> shape_of(int nx, int ny) {
  return {static_cast<std::uint64_t>(ny), static_cast<std::uint64_t>(nx)};
}

// The numbers follow the header without a gap.
std::string with_header(const char* descr, std::span<const std::byte> data, int nx, int ny) {
  std::string out = npy_header(descr, shape_of(nx, ny));
  out.append(reinterpret_cast<const char*>(data.data()), data.size());
  return out;
}

}  // namespace

std::string npy_header(const std::string& descr, const std::vector<std::uint64_t>& shape) {
  // The header is a dictionary as Python prints it, where a tuple of one has a comma.
  std::string extents;
  for (const std::uint64_t length : shape)
    extents += (extents.empty() ? "" : ", ") + std::to_string(length);
  if (shape.size() == 1) extents += ",";
  std::string dict =
      "{'descr': '" + descr + "', 'fortran_order': False, 'shape': (" + extents + "), }";
  // The data begin at a multiple of 64 bytes, counting magic, version and length.
  dict.append(63 - (10 + dict.size()) % 64, ' ');
  dict += '\n';
  std::string out("\x93NUMPY\x01\x00", 8);
  out += static_cast<char>(dict.size() & 0xFF);
  out += static_cast<char>(dict.size() >> 8);
  return out + dict;
}

std::string npy_header(int nx, int ny) { return npy_header("<f4", shape_of(nx, ny)); }

std::string npy_bytes(std::span<const float> values, int nx, int ny) {
  return with_header("<f4", std::as_bytes(values), nx, ny);
}

std::string npy_bytes(std::span<const std::int8_t> values, int nx, int ny) {
  return with_header("|i1", std::as_bytes(values), nx, ny);
}

}  // namespace navvy::formats
