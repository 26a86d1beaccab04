// SPDX-License-Identifier: Apache-2.0
// Finds words that are not numbers in an ESRI ASCII grid, a text format for height maps.
#pragma once

#include <cstdint>
#include <string>

namespace navvy::heightfield {

/// Checks the header and the first `numbers` heights of the ESRI ASCII grid in file `path` for
/// words that are neither a header key nor a number. GDAL would silently read such a word as a
/// height of 0 m.
///
/// Every spelling that GDAL accepts counts as a number, including decimal commas and "nan". The
/// file is read in pieces, so it may be larger than memory.
/// @throws InputError naming file, line and word; also for a file that cannot be read or is larger
/// than limits::kMapTextBytes (core/limits.h).
void check_words(const std::string& path, std::int64_t numbers);

}  // namespace navvy::heightfield
