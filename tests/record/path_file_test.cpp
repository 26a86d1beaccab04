// SPDX-License-Identifier: Apache-2.0
#include "record/path_file.h"

#include <gtest/gtest.h>

#include <string>

#include "core/error.h"
#include "core/file.h"
#include "folder.h"
#include "formats/formats.h"
#include "map/grounds.h"

namespace navvy::record {
namespace {

using control::Path;

TEST(PathFile, ReadsBackEveryPath) {
  const Path straight({Vec2(1, 2), 0}, {{1, 0}}), back({Vec2(3, 4), 0}, {{-0.25, 0}});
  const std::string rows = path_rows("digger", {{3, 0, straight}, {2, 1.5, back}, {3, 7, back}});
  EXPECT_NE(rows.find("digger,3,1,0,0.0000,1.0000,2.0000,0.00000,1\n"), std::string::npos) << rows;
  EXPECT_NE(rows.find("digger,3,2,7,0.2500,2.7500,4.0000,0.00000,-1\n"), std::string::npos) << rows;
  const test::Folder folder;
  const std::string file = folder / "paths.csv";
  write_file_atomically(file, path_header() + "\n" + rows);
  const std::vector<map::MapLine> lines = read_paths(file);
  ASSERT_EQ(lines.size(), 3u);
  EXPECT_EQ(lines[0].places.size(), 11u);
  EXPECT_EQ(lines[1].number, 1);
  EXPECT_EQ(lines[2].number, 2);
  EXPECT_NEAR((lines[2].places.back() - Vec2(2.75, 4)).norm(), 0, 1e-9);
}

TEST(PathFile, RefusesInvalidRowsByFileAndLine) {
  const test::Folder folder;
  const std::string file = folder / "paths.csv";
  for (const std::string& text :
       {path_header() + "\ndigger,3,1,0,zero,1,2,0,1\n", path_header() + "\nnothing\n"}) {
    write_file_atomically(file, text);
    try {
      read_paths(file);
      FAIL() << text;
    } catch (const InputError& error) {
      EXPECT_NE(std::string(error.what()).find(file + ":2"), std::string::npos) << error.what();
    }
  }
  write_file_atomically(file, std::string("x,y\n1,2\n"));
  EXPECT_THROW(read_paths(file), InputError);
}

TEST(PathFile, IsDrawnOnAHillshadeWithoutOtherChanges) {
  const map::TerrainMap map =
      map::testing::map_of(map::testing::setup(), [](double x, double) { return 0.1 * x; });
  const test::Folder folder;
  const std::string plain = folder / "plain.png", drawn = folder / "drawn.png";
  formats::write_map("hillshade", map, {map::MapLayer::kElevation}, plain);
  formats::format_named("hillshade").write_with_lines(map, {map::MapLayer::kElevation}, drawn, {});
  EXPECT_EQ(read_file(drawn), read_file(plain));
  formats::format_named("hillshade")
      .write_with_lines(map, {map::MapLayer::kElevation}, drawn,
                        {{1, {Vec2(0, 3), Vec2(5, 5), Vec2(99, 99)}}});
  EXPECT_NE(read_file(drawn), read_file(plain));
  EXPECT_EQ(formats::format_named("npz").write_with_lines, nullptr);
}

}  // namespace
}  // namespace navvy::record
