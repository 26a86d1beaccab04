// SPDX-License-Identifier: Apache-2.0
// Writes NumPy's NPY format 1.0; heightfield/npy.h reads it.
#pragma once

#include <cstdint>
#include <span>
#include <string>

namespace navvy::formats {

/// Returns the file of an array[iy, ix] of ny x nx numbers, row 0 first, of type '<f4' or '|i1'.
std::string npy_bytes(std::span<const float> values, int nx, int ny);
std::string npy_bytes(std::span<const std::int8_t> values, int nx, int ny);

/// Returns the header of a '<f4' array of ny x nx numbers, which precedes them in the file.
std::string npy_header(int nx, int ny);

}  // namespace navvy::formats
