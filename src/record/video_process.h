// SPDX-License-Identifier: Apache-2.0
// Encodes pictures as a video with the program ffmpeg, which runs as a process of its own.
#pragma once

#include <sys/types.h>

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "render/image.h"

namespace navvy::record {

/// The program ffmpeg and the encoder that videos are made with.
struct VideoProgram {
  /// Path of the program.
  std::string path;
  /// Options of the program that select encoder and container.
  std::vector<std::string> encoder;
  /// Extension of the videos, ".mp4" or ".webm".
  std::string extension;
};

/// Returns the program ffmpeg in the directories of the environment variable PATH, with the first
/// encoder of libx264, libvpx-vp9 and mpeg4 that it has; nothing if there is no such program or it
/// has none of them. Starts the program once, which takes some tens of milliseconds.
std::optional<VideoProgram> find_video_program();

/// A video that is being written.
///
/// The program reads raw pictures from a pipe. An MP4 file is written in fragments of two seconds
/// of the video or twelve pictures, whichever is longer, so that all but the last fragment can be
/// played after both processes were killed. If this process alone is killed, the pipe ends and the
/// program completes the file. It has a process group of its own, and so does not get the
/// terminal's signals.
class VideoProcess {
 public:
  /// Starts the program for pictures of `width` x `height` pixels, of which `rate` are shown per
  /// second [1/s]. Replaces the file `path`. `comment` is stored in the file.
  /// @throws FileError if the program cannot be started.
  VideoProcess(const VideoProgram& program, const std::string& path, int width, int height,
               double rate, const std::string& comment);
  /// Ends the video as `finish` does, without reporting errors.
  ~VideoProcess();
  VideoProcess(const VideoProcess&) = delete;
  VideoProcess& operator=(const VideoProcess&) = delete;

  /// Appends a picture. Waits while the program is busy. @throws FileError with the program's
  /// message if it has ended, as on a full disk; Error for a picture of another size.
  void write(const render::Image& image);
  /// Ends the video and waits for the program. Later calls do nothing. @throws FileError with the
  /// program's message if it failed.
  void finish();
  /// Returns the processor time that the program has used [s]; 0 before `finish`.
  double processor_time() const { return processor_time_; }

 private:
  /// Closes the pipe and waits for the program. Returns its exit status, -1 if a signal ended it.
  int wait();
  /// Returns the last line of the program's messages.
  std::string last_message() const;

  std::string path_;
  int width_, height_;
  /// Writing end of the pipe, and file in memory with the program's messages; -1 if closed.
  int pipe_ = -1, messages_ = -1;
  /// Process of the program; 0 after it was waited for.
  pid_t process_ = 0;
  double processor_time_ = 0;
};

}  // namespace navvy::record
