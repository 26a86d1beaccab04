// SPDX-License-Identifier: Apache-2.0
#include "formats/npy_file.h"

#include <bit>
#include <cstddef>

namespace navvy::formats {
namespace {

static_assert(std::endian::native == std::endian::little,
              "numbers are written in the byte order of memory");

std::string header(const char* descr, int nx, int ny) {
  // The header is a dictionary as Python prints it.
  std::string dict = std::string("{'descr': '") + descr + "', 'fortran_order': False, 'shape': (" +
                     std::to_string(ny) + ", " + std::to_string(nx) + "), }";
  // The data begin at a multiple of 64 bytes, counting magic, version and length.
  dict.append(63 - (10 + dict.size()) % 64, ' ');
  dict += '\n';
  std::string out("\x93NUMPY\x01\x00", 8);
  out += static_cast<char>(dict.size() & 0xFF);
  out += static_cast<char>(dict.size() >> 8);
  return out + dict;
}

// The numbers follow the header without a gap.
std::string with_header(const char* descr, std::span<const std::byte> data, int nx, int ny) {
  std::string out = header(descr, nx, ny);
  out.append(reinterpret_cast<const char*>(data.data()), data.size());
  return out;
}

}  // namespace

std::string npy_header(int nx, int ny) { return header("<f4", nx, ny); }

std::string npy_bytes(std::span<const float> values, int nx, int ny) {
  return with_header("<f4", std::as_bytes(values), nx, ny);
}

std::string npy_bytes(std::span<const std::int8_t> values, int nx, int ny) {
  return with_header("|i1", std::as_bytes(values), nx, ny);
}

}  // namespace navvy::formats
