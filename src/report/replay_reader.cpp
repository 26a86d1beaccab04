// SPDX-License-Identifier: Apache-2.0
#include "report/replay_reader.h"

#include <array>
#include <cstdint>
#include <cstring>
#include <fstream>
#include <map>
#include <nlohmann/json.hpp>
#include <optional>
#include <utility>
#include <vector>

#include "core/base64.h"
#include "core/error.h"
#include "report/packing.h"

namespace navvy::report {
namespace {

using nlohmann::json;

constexpr std::size_t kTile = 16 * 16;
/// Length of a longest row that is read [bytes]: the header of a site of 2048 x 2048 columns, with
/// its shapes, has 30 MB.
constexpr std::size_t kLongest = std::size_t{256} << 20;

[[noreturn]] void refuse(const std::string& file, const std::string& rule) {
  throw InputError(
      Fault{Fault::Severity::kError, file, 1, "replay", "", rule, "run the scene again"});
}

/// Returns the values of a base64 text; nothing if it is no whole number of them.
template <class T>
std::optional<std::vector<T>> unpacked(const json& text) {
  if (!text.is_string()) return std::nullopt;
  const auto bytes = base64_bytes(text.get_ref<const std::string&>());
  if (!bytes || bytes->size() % sizeof(T) != 0) return std::nullopt;
  std::vector<T> out(bytes->size() / sizeof(T));
  if (!out.empty()) std::memcpy(out.data(), bytes->data(), bytes->size());
  return out;
}

/// A row of the file that is a frame.
struct Frame {
  double time = 0;
  std::vector<std::int16_t> tiles, particles;
  std::vector<float> poses, cylinders, forces;
};

/// Numbers of links, cylinders and forces in each frame.
struct Counts {
  std::size_t links = 0, cylinders = 0, forces = 0;
};

/// Returns the frame of a row; nothing if the row is none.
std::optional<Frame> frame_of(const json& row, const Counts& counts) {
  if (!row.is_object() || !row.contains("time_s") || !row["time_s"].is_number() ||
      row.contains("picture"))
    return std::nullopt;
  const auto tiles = unpacked<std::int16_t>(row.value("tiles", json()));
  const auto particles = unpacked<std::int16_t>(row.value("particles", json()));
  const auto poses = unpacked<float>(row.value("poses", json()));
  const auto cylinders = unpacked<float>(row.value("cylinders", json()));
  const auto forces = unpacked<float>(row.value("forces", json()));
  if (!tiles || !particles || !poses || !cylinders || !forces) return std::nullopt;
  if (tiles->size() % (kTile + 2) != 0 || particles->size() % 3 != 0 ||
      particles->size() / 3 > UINT16_MAX || poses->size() != 7 * counts.links ||
      cylinders->size() != 6 * counts.cylinders || forces->size() != 6 * counts.forces)
    return std::nullopt;
  return Frame{row["time_s"].get<double>(), *tiles, *particles, *poses, *cylinders, *forces};
}

/// The frames that a page gets, in the form in which it gets them.
class Frames {
 public:
  /// Takes the tiles of a frame; later ones replace earlier ones.
  void merge(const Frame& frame) {
    for (std::size_t i = 0; i < frame.tiles.size(); i += kTile + 2) {
      const auto begin = frame.tiles.begin() + static_cast<std::ptrdiff_t>(i);
      waiting_[{begin[0], begin[1]}] =
          std::vector<std::int16_t>(begin, begin + static_cast<std::ptrdiff_t>(kTile + 2));
    }
  }
  /// Adds a frame with all tiles that were merged since the last one.
  void add(const Frame& frame) {
    times_.push_back(frame.time);
    append(frame.poses, poses_);
    append(frame.cylinders, cylinders_);
    append(frame.forces, forces_);
    append(frame.particles, particles_);
    particle_counts_.push_back(static_cast<std::uint16_t>(frame.particles.size() / 3));
    tile_counts_.push_back(static_cast<std::uint32_t>(waiting_.size()));
    for (const auto& [place, tile] : waiting_) append(tile, tiles_);
    waiting_.clear();
  }
  json members() const {
    return {{"times", times_},
            {"poses", packed(poses_)},
            {"cylinders", packed(cylinders_)},
            {"forces", packed(forces_)},
            {"particle_counts", packed(particle_counts_)},
            {"particles", packed(particles_)},
            {"tile_counts", packed(tile_counts_)},
            {"tiles", packed(tiles_)}};
  }

 private:
  template <class T>
  static void append(const std::vector<T>& part, std::vector<T>& whole) {
    whole.insert(whole.end(), part.begin(), part.end());
  }
  std::vector<double> times_;
  std::vector<float> poses_, cylinders_, forces_;
  std::vector<std::int16_t> particles_, tiles_;
  std::vector<std::uint16_t> particle_counts_;
  std::vector<std::uint32_t> tile_counts_;
  std::map<std::array<std::int16_t, 2>, std::vector<std::int16_t>> waiting_;
};

/// Reads the next row; false at the end, and for a row without its end, which a kill leaves.
bool next_row(std::ifstream& in, std::string& row) {
  return std::getline(in, row) && !in.eof() && row.size() <= kLongest;
}

/// Copies what the header holds to the page's run.
Counts take_header(const std::string& file, const json& header, json& members) {
  for (const char* key : {"grid", "soils", "links", "cylinders", "forces", "start"})
    if (!header.is_object() || !header.contains(key)) refuse(file, "is not the file of a replay");
  const auto start = unpacked<std::int16_t>(header["start"]);
  if (!start || !header["links"].is_array() || !header["cylinders"].is_array() ||
      !header["forces"].is_array())
    refuse(file, "has a header with values of other types");
  for (const char* key : {"grid", "soils", "cylinders", "forces"}) members[key] = header[key];
  members["start"] = packed(*start);
  const auto design = unpacked<std::int16_t>(header.value("design", json()));
  members["design"] = design ? json(packed(*design)) : json();
  members["links"] = json::array();
  for (json link : header["links"]) {
    // The points and corners of meshes are compressed as all other values of a page.
    for (json& visual : link["visuals"]) {
      if (!visual.contains("mesh")) continue;
      const auto points = unpacked<float>(visual["mesh"].value("points", json()));
      const auto corners = unpacked<std::uint32_t>(visual["mesh"].value("triangles", json()));
      if (!points || !corners) refuse(file, "has a mesh that cannot be read");
      visual["mesh"] = {{"points", packed(*points)}, {"triangles", packed(*corners)}};
    }
    members["links"].push_back(std::move(link));
  }
  return {header["links"].size(), header["cylinders"].size(), header["forces"].size()};
}

}  // namespace

std::size_t count_frames(const std::string& file) {
  std::ifstream in(file, std::ios::binary);
  std::size_t out = 0;
  std::string row;
  if (!next_row(in, row)) return 0;
  while (next_row(in, row))
    if (row.find("\"poses\"") != std::string::npos) ++out;
  return out;
}

void read_header(const std::string& row, json& run) {
  take_header("replay", json::parse(row, nullptr, false), run);
}

ReplayCounts read_replay(const std::string& file, std::size_t every, json& run) {
  std::ifstream in(file, std::ios::binary);
  if (!in) throw FileError("cannot read '" + file + "'");
  std::string row;
  if (!next_row(in, row)) refuse(file, "has no header");
  ReplayCounts out;
  const Counts counts = take_header(file, json::parse(row, nullptr, false), run);
  Frames frames;
  std::optional<Frame> last;
  while (next_row(in, row)) {
    const json value = json::parse(row, nullptr, false);
    std::optional<Frame> frame = frame_of(value, counts);
    if (!frame) {
      if (value.is_discarded() || !value.contains("picture")) ++out.unread;
      continue;
    }
    frames.merge(*frame);
    const bool taken = out.frames++ % every == 0;
    if (taken) frames.add(*frame);
    last = taken ? std::nullopt : std::move(frame);
  }
  if (last) frames.add(*last);
  run["frames"] = frames.members();
  return out;
}

}  // namespace navvy::report
