// SPDX-License-Identifier: Apache-2.0
// Updates of a map as bytes for other processes.
#pragma once

#include <cstddef>
#include <functional>
#include <vector>

#include "map/update_feed.h"

namespace navvy::formats {

/// Takes the next bytes of a stream that is too large to be held; returning false ends it.
using PatchSink = std::function<bool(const char* bytes, std::size_t count)>;

/// Hands an update to `sink` as a patch (src/map/README.md, "Updates"): the magic "NAVVYMAP", the
/// length of the header (32 bits, little-endian), the header as JSON, and for each rectangle and
/// each layer its float32 rows, least y first. Pieces have at most 16 MiB or one row. Returns false
/// when the sink ended the stream.
bool send_patch(const map::MapUpdate& update, const std::vector<map::MapLayer>& layers,
                const PatchSink& sink);

}  // namespace navvy::formats
