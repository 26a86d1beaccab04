// SPDX-License-Identifier: Apache-2.0
// The map of one instant as a bag: what a planner that subscribes gets once.
#include <cstdio>

#include "core/file.h"
#include "planner/formats/formats.h"
#include "planner/formats/part_folder.h"
#include "planner/ros/streams.h"

namespace navvy::planner {
namespace {

void write(ros::Bag& bag, const TerrainMap& map, const std::vector<Layer>& layers) {
  const std::int64_t now = ros::stamp(map.time());
  ros::write_clock(bag, now);
  ros::write_map(bag, map, layers, now);
  bag.close();
}

}  // namespace

/// SQLite's journal is there as long as it writes.
std::vector<std::string> bag_files(const std::string& name) {
  return {"metadata.yaml", name + "_0.db3", name + "_0.db3-journal"};
}

void write_mcap(const TerrainMap& map, const std::vector<Layer>& layers, const std::string& path) {
  const std::string part = partial_name(path);
  try {
    const auto bag = ros::make_mcap(part);
    write(*bag, map, layers);
  } catch (...) {
    std::remove(part.c_str());  // a full disk is not to stay full of halves
    throw;
  }
  commit_file(path);
}

void write_bag(const TerrainMap& map, const std::vector<Layer>& layers, const std::string& path) {
  PartFolder part(path, bag_files(folder_name(path)));
  write(*ros::make_bag_folder(part.place()), map, layers);
  part.commit();
}

}  // namespace navvy::planner
