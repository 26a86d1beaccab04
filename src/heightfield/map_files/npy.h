// SPDX-License-Identifier: Apache-2.0
// Reads height maps from NumPy's NPY files: one two-dimensional array, whose rows are the map's
// rows.
#pragma once

#include <string>
#include <vector>

namespace navvy::heightfield {

/// Element types that a height map may have: '<f4', '<f8', '<i2', '<i4', '<u2' and '|u1' in the
/// order of the enumerators, all little-endian.
enum class NpyType { kFloat32, kFloat64, kInt16, kInt32, kUint16, kUint8 };

/// A two-dimensional array as stored in an NPY file.
struct NpyGrid {
  /// Type of the elements of the array.
  NpyType type = NpyType::kFloat32;
  /// Number of rows and of columns of the array.
  int rows = 0, columns = 0;
  /// The rows * columns elements as stored in the file, row by row, not decoded.
  std::vector<char> bytes;
};

/// Returns true if the file begins with the NPY signature; false also if it cannot be read.
bool is_npy_file(const std::string& path);

/// Reads the NPY file `path`.
/// @throws InputError naming the file, the offending value and a remedy: for Fortran order, an
/// unsupported element type, an array that is not two-dimensional, a file size that does not match
/// the shape, an invalid header, or a file larger than core/limits.h allows.
NpyGrid read_npy(const std::string& path);

}  // namespace navvy::heightfield
