// SPDX-License-Identifier: Apache-2.0
// Encodes map updates as bytes for other processes.
#pragma once

#include <cstddef>
#include <functional>
#include <vector>

#include "map/update_feed.h"

namespace navvy::formats {

/// Function that receives the next `count` bytes of a stream. It returns false to end the stream.
using PatchSink = std::function<bool(const char* bytes, std::size_t count)>;

/// Passes a map update to `sink` as a patch (src/map/README.md, "Updates"), in pieces of at most 16
/// MiB or one row. Returns false if the sink ended the stream.
///
/// A patch consists of the text "NAVVYMAP", the length of the header (32 bits, little-endian), the
/// header as JSON, and the values: for each rectangle of the update and each of `layers`, the
/// float32 values row by row, beginning with the row of smallest y.
bool send_patch(const map::MapUpdate& update, const std::vector<map::MapLayer>& layers,
                const PatchSink& sink);

}  // namespace navvy::formats
