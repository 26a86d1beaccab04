// SPDX-License-Identifier: Apache-2.0
// Reads NumPy's NPY as a map: one array with two axes, whose rows are the rows of the map.
#pragma once

#include <string>
#include <vector>

namespace navvy::heightfield {

/// Element types that maps come in: '<f4', '<f8', '<i2', '<i4', '<u2' and '|u1'; all little-endian.
enum class NpyType { kFloat32, kFloat64, kInt16, kInt32, kUint16, kUint8 };

/// The array as the file holds it.
struct NpyGrid {
  /// Type of the elements.
  NpyType type = NpyType::kFloat32;
  /// Size of the array.
  int rows = 0, columns = 0;
  /// rows x columns numbers, the columns of row 0 first.
  std::vector<char> bytes;
};

/// Returns true when the file begins like an NPY file; false also when it cannot be read.
bool is_npy_file(const std::string& path);

/// Reads the whole file.
/// @throws InputError naming file, offset or key, value and remedy: for Fortran order, another
/// type, other than two axes, a size that differs from the shape, a broken header, or more bytes
/// than core/limits.h allows.
NpyGrid read_npy(const std::string& path);

}  // namespace navvy::heightfield
