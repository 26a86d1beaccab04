// SPDX-License-Identifier: Apache-2.0
// NumPy's NPY as a map: one array of two axes, rows of the map after each other.
#pragma once

#include <string>
#include <vector>

namespace navvy::heightfield {

/// What NPY calls '<f4', '<f8', '<i2', '<i4', '<u2' and '|u1': all that maps are kept in.
/// Little-endian, as we are.
enum class NpyType { kFloat32, kFloat64, kInt16, kInt32, kUint16, kUint8 };

/// An array as it stands in the file.
struct NpyGrid {
  NpyType type = NpyType::kFloat32;
  int rows = 0, columns = 0;
  std::vector<char> bytes;  ///< rows x columns numbers, the columns of row 0 first
};

/// Whether the file begins as every NPY does. False where it cannot be read.
bool is_npy_file(const std::string& path);

/// Reads all of it.
/// @throws InputError naming file, offset in it or key, value and remedy: for Fortran order,
/// another type, other than two axes, a size that is not that of the shape, a header that is none,
/// or more bytes than core/limits.h allows.
NpyGrid read_npy(const std::string& path);

}  // namespace navvy::heightfield
