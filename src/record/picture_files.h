// SPDX-License-Identifier: Apache-2.0
// Writes the pictures of a run as videos or PNG files, on a thread of its own.
#pragma once

#include <condition_variable>
#include <cstddef>
#include <cstdint>
#include <deque>
#include <exception>
#include <map>
#include <memory>
#include <mutex>
#include <optional>
#include <set>
#include <string>
#include <thread>
#include <vector>

#include "record/picture_format.h"
#include "record/run_folder.h"
#include "record/video_process.h"
#include "render/image.h"
#include "scene/scene.h"

namespace navvy::record {

/// Writes the pictures of all cameras of a run into its folder.
///
/// Pictures are encoded on a thread that the first picture starts, so the caller draws and
/// simulates on. At most kMost pictures wait; then the caller waits. An error of the thread is
/// thrown by the next call.
class PictureFiles {
 public:
  /// Prepares files in `folder`, which must outlive this object.
  /// @throws InputError for the format kVideo if there is no ffmpeg.
  PictureFiles(RunFolder& folder, PictureFormat format);
  /// Writes the waiting pictures and ends the videos, without reporting errors.
  ~PictureFiles();
  PictureFiles(const PictureFiles&) = delete;
  PictureFiles& operator=(const PictureFiles&) = delete;

  /// Hands over picture number `number` of `camera`: the picture after `number` periods of the
  /// camera's rate. The pictures of a video must have consecutive numbers.
  /// @throws FileError for a file that cannot be written, now or earlier.
  void write(const scene::Camera& camera, std::uint64_t number, render::Image image);
  /// Begins new videos, after the world was put into another state: `frames/<camera>_2.mp4` and so
  /// on. PNG files of the same number are replaced.
  void restart();
  /// Writes the waiting pictures and ends the videos. Later calls do nothing.
  /// @throws FileError for the first file that could not be written.
  void finish();
  /// Returns the processor time spent on encoding so far, by the thread and by the programs that
  /// have ended [s].
  double processor_time() const;

  /// Maximum number of pictures that wait to be encoded.
  static constexpr std::size_t kMost = 8;

 private:
  /// A picture on its way to the thread. Without an image it ends the video.
  struct Job {
    /// Path of the video or of the PNG file.
    std::string path;
    render::Image image;
    /// Pictures per second of a video, and its comment.
    double rate = 0;
    std::string comment;
  };
  /// Returns the program for videos, null for PNG files. Searches for it once.
  const VideoProgram* program();
  /// Appends a job, after waiting for a free place. @throws the thread's error.
  void add(Job job);
  /// Encodes jobs until the end, on the thread.
  void work();
  /// Encodes one picture or ends one video.
  void encode(const Job& job);
  /// Ends the thread after all jobs.
  void join();

  RunFolder& folder_;
  PictureFormat format_;
  /// Program for videos, if there is one, and true after it was searched for.
  std::optional<VideoProgram> program_;
  bool searched_ = false;
  /// Path of the present video of each camera by the camera's name.
  std::map<std::string, std::string> paths_;
  /// Names that videos have or had, without extension, and names of cameras.
  std::set<std::string> taken_;

  /// Videos by their paths; used by the thread alone while it runs.
  std::map<std::string, std::unique_ptr<VideoProcess>> videos_;
  /// Guards all members below.
  mutable std::mutex mutex_;
  /// Signals that a job was added or taken, or that the thread is to end.
  std::condition_variable changed_;
  std::deque<Job> jobs_;
  bool ending_ = false;
  /// First error of the thread; it drops all jobs after it.
  std::exception_ptr error_;
  double processor_time_ = 0;
  std::thread thread_;
};

}  // namespace navvy::record
