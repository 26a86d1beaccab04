// SPDX-License-Identifier: Apache-2.0
// `navvy show` and the overlays of pictures.
#include <gtest/gtest.h>

#include <string>

#include "cli/program_run.h"

namespace navvy {
namespace {

using Show = test::ProgramRun;

/// Returns the big-endian number at a place of a file's bytes.
int number_at(const std::string& bytes, std::size_t at) {
  int out = 0;
  for (std::size_t i = 0; i < 4; ++i)
    out = 256 * out + static_cast<unsigned char>(bytes.at(at + i));
  return out;
}

TEST_F(Show, DrawsACameraBeforeTheRun) {
  const std::string to = out() + ".png";
  ASSERT_EQ(run({"show", "bucket_path", "--camera", "bucket", "--out", to}), 0) << complained();
  EXPECT_NE(said().find("camera 'bucket' of 'bucket_path', 1280 x 720 pixels"), std::string::npos)
      << said();
  const std::string plain = test::text_of(to);
  EXPECT_EQ(plain.substr(1, 3), "PNG");
  EXPECT_EQ(number_at(plain, 16), 1280);
  EXPECT_EQ(number_at(plain, 20), 720);
  ASSERT_EQ(
      run({"show", "bucket_path", "--camera", "bucket", "--out", to, "--show", "joints,grid,hud"}),
      0)
      << complained();
  EXPECT_NE(test::text_of(to), plain);
}

TEST_F(Show, RefusesUnknownCamerasOverlaysAndFiles) {
  EXPECT_EQ(run({"show", "bucket_path", "--camera", "sidee"}), 2);
  EXPECT_NE(complained().find("did you mean 'side'"), std::string::npos) << complained();
  EXPECT_EQ(run({"show", "bucket_path", "--show", "joints,hut"}), 2);
  EXPECT_NE(complained().find("did you mean 'hud'"), std::string::npos) << complained();
  EXPECT_EQ(run({"show", "bucket_path", "--out", out() + ".jpg"}), 2);
  EXPECT_NE(complained().find("end the name in .png"), std::string::npos) << complained();
}

}  // namespace
}  // namespace navvy
