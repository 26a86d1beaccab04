// SPDX-License-Identifier: Apache-2.0
// Videos by a program that stands in for ffmpeg and keeps the raw pictures, and by ffmpeg itself
// where it is found (`./dev readers`).
#include "record/picture_files.h"

#include <gtest/gtest.h>

#include <unistd.h>

#include <chrono>
#include <csignal>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <string>
#include <thread>
#include <utility>
#include <vector>

#include "core/error.h"
#include "core/stopwatch.h"
#include "folder.h"
#include "paths.h"
#include "text_of.h"

namespace navvy::record {
namespace {

namespace fs = std::filesystem;
using test::text_of;

/// Keeps what it reads in the file that it is to write, and its options beside it. With the file
/// `full` beside it, it fails after the first picture.
const char* const kStandIn = R"(#!/usr/bin/python3
import os, sys
if '-encoders' in sys.argv:
    print('Encoders:\n V....D mpeg4 MPEG-4\n V....D libx264 H.264 (codec h264)')
    sys.exit(0)
path = sys.argv[-1].removeprefix('file:')
open(path + '.options', 'w').write(' '.join(sys.argv[1:]))
with open(path, 'wb') as out:
    while block := sys.stdin.buffer.read(45):
        out.write(block)
        if os.path.exists(os.path.join(os.path.dirname(sys.argv[0]), 'full')):
            print('av_interleaved_write_frame(): No space left on device', file=sys.stderr)
            sys.exit(1)
)";

/// A picture of 5 x 3 pixels; `number` is in each of its bytes.
render::Image picture(int number) {
  return {5, 3, std::vector<std::uint8_t>(45, static_cast<std::uint8_t>(number))};
}

class PictureFilesTest : public testing::Test {
 protected:
  PictureFilesTest() : path_(std::getenv("PATH")), results_(folder_ / "out") { results_.begin(); }
  ~PictureFilesTest() override { setenv("PATH", path_.c_str(), 1); }

  /// Makes a folder the only one in which programs are found.
  void use_programs_of(const std::string& folder) { setenv("PATH", folder.c_str(), 1); }
  void use_stand_in() {
    fs::create_directories(folder_ / "bin");
    std::ofstream(folder_ / "bin/ffmpeg") << kStandIn;
    fs::permissions(folder_ / "bin/ffmpeg", fs::perms::owner_all);
    use_programs_of(folder_ / "bin");
  }
  /// Finds ffmpeg as the readers' package has it; false if it is not installed.
  bool use_ffmpeg() {
    std::error_code none;
    for (const auto& entry :
         fs::recursive_directory_iterator(navvy::source_dir() + "/build/readers/lib", none))
      if (entry.path().parent_path().filename() == "binaries" &&
          entry.path().filename().string().starts_with("ffmpeg-")) {
        fs::create_directories(folder_ / "bin");
        fs::create_symlink(entry.path(), folder_ / "bin/ffmpeg");
        use_programs_of(folder_ / "bin");
        return true;
      }
    return false;
  }
  /// Returns the number of pictures in a video of 6 x 4 pixels, as ffmpeg decodes it.
  std::size_t decoded(const std::string& file) {
    const std::string raw = folder_ / "decoded";
    const std::string command = "'" + folder_ / "bin/ffmpeg" + "' -y -loglevel error -i '" + file +
                                "' -f rawvideo -pix_fmt rgb24 '" + raw + "' 2>/dev/null";
    const int status = std::system(command.c_str());
    return status == 0 ? text_of(raw).size() / (6 * 4 * 3) : 0;
  }
  scene::Camera camera(const char* name, double rate) {
    scene::Camera out;
    out.name = name;
    out.rate = rate;
    return out;
  }

  const std::string path_;
  const test::Folder folder_;
  RunFolder results_;
};

TEST_F(PictureFilesTest, GiveTheProgramAllPicturesOfACameraInOrder) {
  use_stand_in();
  PictureFiles files(results_, PictureFormat::kAuto);
  std::string left, right;
  for (int i = 0; i < 3 * static_cast<int>(PictureFiles::kMost); ++i) {
    files.write(camera("left", 4), static_cast<std::uint64_t>(6 + i), picture(i));
    left += std::string(45, static_cast<char>(i));
    if (i % 2 != 0) continue;
    files.write(camera("right", 2), static_cast<std::uint64_t>(i), picture(100 + i));
    right += std::string(45, static_cast<char>(100 + i));
  }
  files.finish();
  EXPECT_EQ(text_of(folder_ / "out/frames/left.mp4"), left);
  EXPECT_EQ(text_of(folder_ / "out/frames/right.mp4"), right);
  const std::string options = text_of(folder_ / "out/frames/left.mp4.options");
  for (const char* part : {"-video_size 5x3", "-framerate 4 ", "libx264", "+frag_keyframe",
                           "comment=first picture at 1.5 s of simulated time"})
    EXPECT_NE(options.find(part), std::string::npos) << part << " in: " << options;
  EXPECT_GT(files.processor_time(), 0);
  // Files of a run are those that it has listed.
  EXPECT_NE(text_of(folder_ / "out/navvy.run").find("frames/left.mp4\n"), std::string::npos);
}

TEST_F(PictureFilesTest, BeginNewVideosAfterARestart) {
  use_stand_in();
  PictureFiles files(results_, PictureFormat::kVideo);
  files.write(camera("left", 4), 7, picture(1));
  files.restart();
  files.write(camera("left", 4), 0, picture(2));
  files.finish();
  EXPECT_EQ(text_of(folder_ / "out/frames/left.mp4"), std::string(45, 1));
  EXPECT_EQ(text_of(folder_ / "out/frames/left_2.mp4"), std::string(45, 2));
}

TEST_F(PictureFilesTest, ReportTheMessageOfAProgramThatFails) {
  use_stand_in();
  std::ofstream(folder_ / "bin/full") << "";
  PictureFiles files(results_, PictureFormat::kVideo);
  std::string message;
  try {
    // The pipe holds many of these small pictures.
    for (int i = 0; i < 100000; ++i)
      files.write(camera("left", 4), static_cast<std::uint64_t>(i), picture(i));
    files.finish();
  } catch (const FileError& error) {
    message = error.what();
  }
  EXPECT_NE(message.find("out/frames/left.mp4"), std::string::npos) << message;
  EXPECT_NE(message.find("No space left on device"), std::string::npos) << message;
}

TEST_F(PictureFilesTest, ArePngFilesWithoutTheProgramOrOnRequest) {
  use_programs_of(folder_ / "nothing");
  {
    PictureFiles files(results_, PictureFormat::kAuto);
    files.write(camera("left", 4), 12, picture(7));
    files.finish();
  }
  EXPECT_EQ(render::read_png(folder_ / "out/frames/left_00012.png").rgb, picture(7).rgb);
  EXPECT_THROW(PictureFiles(results_, PictureFormat::kVideo), InputError);
  use_stand_in();
  {
    PictureFiles files(results_, PictureFormat::kPng);
    // The destructor writes what waits.
    files.write(camera("left", 4), 13, picture(8));
  }
  EXPECT_EQ(render::read_png(folder_ / "out/frames/left_00013.png").rgb, picture(8).rgb);
  EXPECT_FALSE(fs::exists(folder_ / "out/frames/left.mp4"));
}

TEST_F(PictureFilesTest, ThrowTheErrorOfAPngFileThatCannotBeWritten) {
  PictureFiles files(results_, PictureFormat::kPng);
  files.write(camera("left", 4), 1, picture(1));
  files.write(camera("left", 4), 2, render::Image{4, 4, {1, 2, 3}});
  EXPECT_THROW(files.finish(), Error);
}

TEST_F(PictureFilesTest, HaveEveryPictureInAVideoOfFfmpeg) {
  if (!use_ffmpeg()) GTEST_SKIP() << "ffmpeg is missing: ./dev readers";
  PictureFiles files(results_, PictureFormat::kVideo);
  for (int i = 0; i < 25; ++i)
    files.write(camera("left", 10), static_cast<std::uint64_t>(i), picture(100));
  files.finish();
  EXPECT_EQ(decoded(folder_ / "out/frames/left.mp4"), 25u);
  // The colour comes back but for the encoder's loss and the rounding to limited range.
  EXPECT_NEAR(static_cast<unsigned char>(text_of(folder_ / "decoded")[0]), 100, 4);
  EXPECT_GT(files.processor_time(), 0);
}

TEST_F(PictureFilesTest, CanBePlayedAfterAKillOfTheProgram) {
  if (!use_ffmpeg()) GTEST_SKIP() << "ffmpeg is missing: ./dev readers";
  const VideoProgram program = find_video_program().value();
  const std::string path = folder_ / "killed.mp4";
  VideoProcess video(program, path, 5, 3, 10, "test");
  std::string children;
  std::ifstream("/proc/self/task/" + std::to_string(::gettid()) + "/children") >> children;
  if (children.empty()) GTEST_SKIP() << "the kernel does not list children";
  for (int i = 0; i < 100; ++i) video.write(picture(i));
  // Of ten seconds of video at least the first fragment is on disk before the kill.
  for (const Stopwatch watch; watch.seconds() < 60 && decoded(path) < 20;)
    std::this_thread::sleep_for(std::chrono::milliseconds(50));
  ::kill(std::stoi(children), SIGKILL);
  EXPECT_THROW(video.finish(), FileError);
  EXPECT_GE(decoded(path), 20u);
}

}  // namespace
}  // namespace navvy::record
