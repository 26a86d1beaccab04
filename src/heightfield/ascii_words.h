// SPDX-License-Identifier: Apache-2.0
// What stands in an ESRI ASCII grid where numbers should.
#pragma once

#include <cstdint>
#include <string>

namespace navvy::heightfield {

/// Looks through the header and the first `numbers` heights for what is neither a key of the format
/// nor a number: GDAL reads such a word as 0 m and says nothing. Every spelling that GDAL takes is
/// a number, decimal commas and "nan" too. The file is read in pieces; one beyond the limit of
/// core/limits.h is refused.
/// @throws InputError naming file, line and word.
void check_words(const std::string& path, std::int64_t numbers);

}  // namespace navvy::heightfield
