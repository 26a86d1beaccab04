// SPDX-License-Identifier: Apache-2.0
// The map of one instant as a bag, which a subscribing planner receives once.
#include <cstdio>

#include "core/file.h"
#include "formats/formats.h"
#include "formats/part_folder.h"
#include "formats/ros/streams.h"

namespace navvy::formats {
namespace {

void write(ros::Bag& bag, const map::TerrainMap& map, const std::vector<map::MapLayer>& layers) {
  const std::int64_t now = ros::stamp(map.time());
  ros::write_clock(bag, now);
  ros::write_map(bag, map, layers, now);
  bag.close();
}

/// Returns the files of a bag; the journal of SQLite exists only while it writes.
std::vector<std::string> bag_files(const std::string& name) {
  return {"metadata.yaml", name + "_0.db3", name + "_0.db3-journal"};
}

void write_mcap(const map::TerrainMap& map, const std::vector<map::MapLayer>& layers,
                const std::string& path) {
  const std::string part = partial_name(path);
  try {
    const auto bag = ros::make_mcap(part);
    write(*bag, map, layers);
  } catch (...) {
    // A full disk must not keep partial files.
    std::remove(part.c_str());
    throw;
  }
  commit_file(path);
}

void write_bag(const map::TerrainMap& map, const std::vector<map::MapLayer>& layers,
               const std::string& path) {
  PartFolder part(path, bag_files(folder_name(path)));
  write(*ros::make_bag_folder(part.place()), map, layers);
  part.commit();
}

}  // namespace

MapFormat mcap_format() {
  return {.name = "mcap",
          .extension = ".mcap",
          .meaning = "ROS 2 messages in one file: grid_map, occupancy, points",
          .by_default = {map::MapLayer::kElevation, map::MapLayer::kTraversability},
          .write = write_mcap,
          .open_bag = ros::make_mcap};
}

MapFormat bag_format() {
  return {.name = "bag",
          .extension = "",
          .meaning = "the same as a rosbag2 folder (SQLite)",
          .by_default = {map::MapLayer::kElevation, map::MapLayer::kTraversability},
          .write = write_bag,
          .within = bag_files,
          .open_bag = ros::make_bag_folder};
}

}  // namespace navvy::formats
