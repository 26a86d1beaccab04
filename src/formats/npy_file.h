// SPDX-License-Identifier: Apache-2.0
// Writes NumPy's NPY format, version 1.0. (heightfield/map_files/npy.h reads it.)
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <vector>

namespace navvy::formats {

/// Returns an NPY file with an array of shape (ny, nx) and element type '<f4'. `values` contains nx
/// * ny values, row 0 first.
std::string npy_bytes(std::span<const float> values, int nx, int ny);
/// Returns an NPY file with an array of shape (ny, nx) and element type '|i1'. `values` contains nx
/// * ny values, row 0 first.
std::string npy_bytes(std::span<const std::int8_t> values, int nx, int ny);

/// Returns the header of an NPY file with an array of shape (ny, nx) and element type '<f4'. The
/// values follow it in the file.
std::string npy_header(int nx, int ny);
/// Returns the header of an NPY file with an array of any element type and shape. `descr`: element
/// type in NumPy's notation, such as "<f4".
std::string npy_header(const std::string& descr, const std::vector<std::uint64_t>& shape);

}  // namespace navvy::formats
