// SPDX-License-Identifier: Apache-2.0
// Reads the data of a page as its scripts do.
#pragma once

#include <gtest/gtest.h>
#include <zlib.h>

#include <cstdint>
#include <cstring>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "core/base64.h"
#include "text_of.h"

namespace navvy::report::testing {

/// Returns the data of a page; null if there is none.
inline nlohmann::json data_of(const std::string& page) {
  const std::string head = "<script type=\"application/json\" id=\"navvy-data\">";
  const std::size_t begin = page.find(head);
  if (begin == std::string::npos) return nullptr;
  const std::size_t first = begin + head.size();
  return nlohmann::json::parse(page.substr(first, page.find("</script>", first) - first), nullptr,
                               false);
}

/// Returns the values of a text that is base64 of gzip.
template <class T>
std::vector<T> unpacked(const std::string& text) {
  const std::string bytes = base64_bytes(text).value_or("");
  std::string out;
  z_stream stream{};
  constexpr int kGzip = 16;
  EXPECT_EQ(inflateInit2(&stream, MAX_WBITS + kGzip), Z_OK);
  std::string input = bytes;
  stream.next_in = reinterpret_cast<Bytef*>(input.data());
  stream.avail_in = static_cast<uInt>(input.size());
  int state = input.empty() ? Z_STREAM_END : Z_OK;
  while (state == Z_OK) {
    char part[4096];
    stream.next_out = reinterpret_cast<Bytef*>(part);
    stream.avail_out = sizeof part;
    state = inflate(&stream, Z_NO_FLUSH);
    out.append(part, sizeof part - stream.avail_out);
  }
  inflateEnd(&stream);
  EXPECT_EQ(state, Z_STREAM_END);
  EXPECT_EQ(out.size() % sizeof(T), 0u);
  std::vector<T> values(out.size() / sizeof(T));
  if (!values.empty()) std::memcpy(values.data(), out.data(), out.size());
  return values;
}

/// Returns the heights [m] of a run in a page at the latest frame that is not after `time`.
inline std::vector<double> heights_at(const nlohmann::json& run, double time) {
  const nlohmann::json& grid = run.at("grid");
  const auto nx = grid.at("nx").get<std::size_t>(), ny = grid.at("ny").get<std::size_t>();
  auto numbers = unpacked<std::int16_t>(run.at("start"));
  const auto tiles = unpacked<std::int16_t>(run.at("frames").at("tiles"));
  const auto counts = unpacked<std::uint32_t>(run.at("frames").at("tile_counts"));
  constexpr std::size_t kTile = 16;
  std::size_t at = 0;
  for (std::size_t f = 0; f < counts.size() && run.at("frames").at("times")[f] <= time; ++f)
    for (std::uint32_t n = 0; n < counts[f]; ++n, at += kTile * kTile + 2)
      for (std::size_t i = 0; i < kTile * kTile; ++i) {
        const std::size_t x = static_cast<std::size_t>(tiles[at]) * kTile + i % kTile,
                          y = static_cast<std::size_t>(tiles[at + 1]) * kTile + i / kTile;
        if (x < nx && y < ny) numbers[y * nx + x] = tiles[at + 2 + i];
      }
  std::vector<double> out;
  out.reserve(numbers.size());
  for (const std::int16_t number : numbers)
    out.push_back(grid.at("base_m").get<double>() + grid.at("unit_m").get<double>() * number);
  return out;
}

}  // namespace navvy::report::testing
