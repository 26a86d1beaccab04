// SPDX-License-Identifier: Apache-2.0
#include "formats/map_patch.h"

#include <algorithm>
#include <cstdint>
#include <nlohmann/json.hpp>
#include <string>

namespace navvy::formats {
namespace {

using heightfield::CellRect;
using map::MapLayer;

/// Most values of one piece: 16 MiB.
constexpr std::int64_t kPieceValues = std::int64_t{1} << 22;

// JSON, because readers in any language can parse it and keys can be added.
std::string header_of(const map::MapUpdate& update, const std::vector<MapLayer>& layers) {
  const map::TerrainMap& map = update.map;
  nlohmann::ordered_json head = {{"format", 1},
                                 {"since", update.since},
                                 {"sequence", update.sequence},
                                 {"time_s", update.time},
                                 {"nx", map.nx()},
                                 {"ny", map.ny()},
                                 {"cell_m", map.cell()},
                                 {"origin_m", {map.origin().x(), map.origin().y()}},
                                 {"changed", update.changed},
                                 {"merged", update.merged},
                                 {"layers", nlohmann::ordered_json::array()},
                                 {"rects", nlohmann::ordered_json::array()}};
  for (const MapLayer layer : layers) head["layers"].push_back(map::info(layer).name);
  for (const CellRect& r : update.rects) head["rects"].push_back({r.x0, r.y0, r.x1, r.y1});
  std::string text = head.dump();
  // Numbers begin at a multiple of 4.
  text.append((4 - text.size() % 4) % 4, ' ');
  return text;
}

}  // namespace

bool send_patch(const map::MapUpdate& update, const std::vector<MapLayer>& layers,
                const PatchSink& sink) {
  const std::string head = header_of(update, layers);
  const auto length = static_cast<std::uint32_t>(head.size());
  std::string begin = "NAVVYMAP";
  for (int i = 0; i < 4; ++i) begin += static_cast<char>(length >> (8 * i) & 0xFF);
  begin += head;
  if (!sink(begin.data(), begin.size())) return false;
  // Some rows at a time: a whole map of a large site has many gigabytes.
  for (const CellRect& rect : update.rects)
    for (const MapLayer layer : layers) {
      const auto width = std::max<std::int64_t>(rect.x1 - rect.x0, 1);
      const int rows = static_cast<int>(std::clamp<std::int64_t>(kPieceValues / width, 1, 256));
      for (int y0 = rect.y0; y0 < rect.y1; y0 += rows) {
        const std::vector<float> values =
            update.map.copy(layer, {rect.x0, y0, rect.x1, std::min(y0 + rows, rect.y1)});
        if (!sink(reinterpret_cast<const char*>(values.data()), values.size() * sizeof(float)))
          return false;
      }
    }
  return true;
}

}  // namespace navvy::formats
