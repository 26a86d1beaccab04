// SPDX-License-Identifier: Apache-2.0
// NumPy's NPY format 1.0, written; heightfield/npy.h reads it.
#pragma once

#include <cstdint>
#include <span>
#include <string>

namespace navvy::formats {

/// The bytes of an array[iy, ix] of ny x nx numbers, those of row 0 first: '<f4' or '|i1'.
std::string npy_bytes(std::span<const float> values, int nx, int ny);
std::string npy_bytes(std::span<const std::int8_t> values, int nx, int ny);

/// What stands before the numbers of a '<f4' array of ny x nx.
std::string npy_header(int nx, int ny);

}  // namespace navvy::formats
