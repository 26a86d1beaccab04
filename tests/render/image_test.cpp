// SPDX-License-Identifier: Apache-2.0
#include "render/image.h"

#include <gtest/gtest.h>
#include <sys/resource.h>

#include <csignal>
#include <filesystem>

#include "core/error.h"
#include "core/file.h"
#include "folder.h"

namespace navvy::render {
namespace {

Image gradient(int width, int height) {
  Image image{width, height, {}};
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < width; ++x)
      for (const int v : {x * 3, y * 5, x * y})
        image.rgb.push_back(static_cast<std::uint8_t>((v * 2654435761u) >> 24));
  return image;
}

class ImageTest : public ::testing::Test {
 protected:
  const test::Folder own_;
  const std::string folder_ = own_.path().string();
};

TEST_F(ImageTest, APngReadsBackAsItWasWritten) {
  const Image image = gradient(37, 21);
  write_png(folder_ + "/a.png", image);
  const Image back = read_png(folder_ + "/a.png");
  EXPECT_EQ(back.width, 37);
  EXPECT_EQ(back.height, 21);
  EXPECT_EQ(back.rgb, image.rgb);
  EXPECT_FALSE(std::filesystem::exists(partial_name(folder_ + "/a.png")));
}

TEST_F(ImageTest, AFullDiskLeavesTheOldPicture) {
  const std::string path = folder_ + "/a.png";
  const Image old = gradient(8, 8), large = gradient(200, 200);
  write_png(path, old);
  // A limit on the file size stands for the full disk: writing fails after the first bytes.
  rlimit before{};
  ASSERT_EQ(getrlimit(RLIMIT_FSIZE, &before), 0);
  const auto handler = std::signal(SIGXFSZ, SIG_IGN);
  rlimit tight = before;
  tight.rlim_cur = 4096;
  ASSERT_EQ(setrlimit(RLIMIT_FSIZE, &tight), 0);
  EXPECT_THROW(write_png(path, large), FileError);
  ASSERT_EQ(setrlimit(RLIMIT_FSIZE, &before), 0);
  std::signal(SIGXFSZ, handler);
  EXPECT_EQ(read_png(path).rgb, old.rgb);
  EXPECT_FALSE(std::filesystem::exists(partial_name(path)));
}

TEST_F(ImageTest, ErrorsNameThePath) {
  try {
    write_png(folder_ + "/missing/a.png", gradient(4, 4));
    FAIL() << "a missing folder must be an error";
  } catch (const FileError& error) {
    EXPECT_NE(std::string(error.what()).find("missing/a.png"), std::string::npos);
  }
  EXPECT_THROW(write_png(folder_ + "/a.png", Image{}), Error);
  EXPECT_THROW(read_png(folder_ + "/none.png"), FileError);
  write_file_atomically(folder_ + "/bad.png", std::string("no picture"));
  EXPECT_THROW(read_png(folder_ + "/bad.png"), Error);
}

}  // namespace
}  // namespace navvy::render
