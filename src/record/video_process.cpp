// SPDX-License-Identifier: Apache-2.0
#include "record/video_process.h"

#include <fcntl.h>
#include <spawn.h>
#include <sys/mman.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cmath>
#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <sstream>
#include <utility>

#include "core/error.h"
#include "core/printable.h"

extern char** environ;

namespace navvy::record {
namespace {

namespace fs = std::filesystem;

/// Descriptors of a program that is started; -1 stands for /dev/null.
struct Streams {
  int in = -1, out = -1, messages = -1;
};

/// Starts a program in a process group of its own. Returns 0 if it cannot be started, with the
/// cause in `errno`.
pid_t start(const std::vector<std::string>& arguments, const Streams& streams) {
  posix_spawn_file_actions_t files;
  posix_spawn_file_actions_init(&files);
  const std::array<int, 3> wanted = {streams.in, streams.out, streams.messages};
  for (int i = 0; i < 3; ++i) {
    if (wanted[static_cast<std::size_t>(i)] >= 0)
      posix_spawn_file_actions_adddup2(&files, wanted[static_cast<std::size_t>(i)], i);
    else
      posix_spawn_file_actions_addopen(&files, i, "/dev/null", i == 0 ? O_RDONLY : O_WRONLY, 0);
  }
  posix_spawnattr_t attributes;
  posix_spawnattr_init(&attributes);
  // Signals that are blocked or ignored here have their usual effect there.
  sigset_t none, all;
  sigemptyset(&none);
  sigemptyset(&all);
  for (const int signal : {SIGPIPE, SIGINT, SIGTERM, SIGHUP}) sigaddset(&all, signal);
  posix_spawnattr_setsigmask(&attributes, &none);
  posix_spawnattr_setsigdefault(&attributes, &all);
  posix_spawnattr_setpgroup(&attributes, 0);
  posix_spawnattr_setflags(&attributes,
                           POSIX_SPAWN_SETPGROUP | POSIX_SPAWN_SETSIGMASK | POSIX_SPAWN_SETSIGDEF);
  std::vector<char*> words;
  words.reserve(arguments.size() + 1);
  for (const std::string& argument : arguments)
    words.push_back(const_cast<char*>(argument.c_str()));
  words.push_back(nullptr);
  pid_t process = 0;
  const int failed = posix_spawn(&process, words[0], &files, &attributes, words.data(), environ);
  posix_spawnattr_destroy(&attributes);
  posix_spawn_file_actions_destroy(&files);
  errno = failed;
  return failed == 0 ? process : 0;
}

/// Returns what a program prints; empty if it fails.
std::string output_of(const std::vector<std::string>& arguments) {
  int ends[2];
  if (::pipe2(ends, O_CLOEXEC) != 0) return "";
  const pid_t process = start(arguments, {-1, ends[1], -1});
  ::close(ends[1]);
  std::string out;
  char buffer[4096];
  for (ssize_t n = 0; process != 0 && (n = ::read(ends[0], buffer, sizeof buffer)) != 0;) {
    if (n < 0 && errno != EINTR) break;
    if (n > 0) out.append(buffer, static_cast<std::size_t>(n));
  }
  ::close(ends[0]);
  int status = 0;
  while (process != 0 && ::waitpid(process, &status, 0) < 0 && errno == EINTR) {
  }
  return process != 0 && WIFEXITED(status) && WEXITSTATUS(status) == 0 ? out : "";
}

/// Returns the path of a program in the directories of PATH; empty if there is none.
std::string program_in_path(const std::string& name) {
  const char* path = std::getenv("PATH");
  std::istringstream folders(path == nullptr ? "" : path);
  for (std::string folder; std::getline(folders, folder, ':');) {
    const std::string file = (folder.empty() ? "." : folder) + "/" + name;
    std::error_code ignored;
    if (fs::is_regular_file(file, ignored) && ::access(file.c_str(), X_OK) == 0) return file;
  }
  return "";
}

std::string number(double value) {
  char text[40];
  std::snprintf(text, sizeof text, "%.9g", value);
  return text;
}

}  // namespace

std::optional<VideoProgram> find_video_program() {
  const std::string path = program_in_path("ffmpeg");
  if (path.empty()) return {};
  // Fragments that can be played by themselves, each written when it is complete.
  const std::vector<std::string> mp4 = {"-movflags", "+frag_keyframe+empty_moov+default_base_moof",
                                        "-f", "mp4"};
  // Without frames that refer to later ones, which would hold pictures back. Some builds lack an
  // encoder because of its licence; the last one is part of the program.
  const std::vector<VideoProgram> known = {
      {path, {"libx264", "-preset", "veryfast", "-crf", "26", "-bf", "0"}, ".mp4"},
      {path,
       {"libvpx-vp9", "-deadline", "realtime", "-cpu-used", "8", "-crf", "33", "-b:v", "0"},
       ".webm"},
      {path, {"mpeg4", "-q:v", "4"}, ".mp4"}};
  // A line of the list is made of flags, name and description.
  std::istringstream list(output_of({path, "-hide_banner", "-encoders"}));
  std::vector<std::string> names;
  for (std::string line, flags, name; std::getline(list, line);)
    if (std::istringstream(line) >> flags >> name) names.push_back(name);
  for (VideoProgram program : known) {
    if (std::find(names.begin(), names.end(), program.encoder[0]) == names.end()) continue;
    program.encoder.insert(program.encoder.begin(), "-c:v");
    if (program.extension == ".mp4")
      program.encoder.insert(program.encoder.end(), mp4.begin(), mp4.end());
    else
      program.encoder.insert(program.encoder.end(), {"-f", "webm"});
    return program;
  }
  return {};
}

VideoProcess::VideoProcess(const VideoProgram& program, const std::string& path, int width,
                           int height, double rate, const std::string& comment)
    : path_(path), width_(width), height_(height) {
  int ends[2];
  if (::pipe2(ends, O_CLOEXEC) != 0)
    throw FileError("cannot make a pipe to ffmpeg for '" + path + "': " + std::strerror(errno));
  pipe_ = ends[1];
  // Fewer switches between the processes; the kernel may refuse.
  ::fcntl(pipe_, F_SETPIPE_SZ, 1 << 20);
  messages_ = ::memfd_create("ffmpeg", MFD_CLOEXEC);
  std::vector<std::string> arguments = {
      program.path, "-hide_banner", "-loglevel", "error", "-nostdin", "-y", "-f", "rawvideo",
      "-pixel_format", "rgb24", "-video_size", std::to_string(width) + "x" + std::to_string(height),
      "-framerate", number(rate), "-i", "pipe:0", "-an",
      // Players expect halved colours, so even sizes.
      "-vf",
      "scale=out_color_matrix=bt709,"
      "pad=ceil(iw/2)*2:ceil(ih/2)*2",
      "-pix_fmt", "yuv420p", "-colorspace", "bt709",
      // One thread: the other cores simulate.
      "-threads", "1", "-g", number(std::max(12.0, std::round(2 * rate))), "-flush_packets", "1",
      "-metadata", "comment=" + comment};
  arguments.insert(arguments.end(), program.encoder.begin(), program.encoder.end());
  // The prefix keeps a name with a colon or a dash from being taken for something else.
  arguments.push_back("file:" + path);
  process_ = start(arguments, {ends[0], -1, messages_});
  const int cause = errno;
  ::close(ends[0]);
  if (process_ != 0) return;
  ::close(std::exchange(pipe_, -1));
  if (messages_ >= 0) ::close(std::exchange(messages_, -1));
  throw FileError("cannot start '" + program.path + "' for '" + path +
                  "': " + std::strerror(cause));
}

VideoProcess::~VideoProcess() {
  if (process_ != 0) wait();
  if (messages_ >= 0) ::close(messages_);
}

int VideoProcess::wait() {
  if (pipe_ >= 0) ::close(std::exchange(pipe_, -1));
  int status = 0;
  rusage used{};
  while (::wait4(process_, &status, 0, &used) < 0 && errno == EINTR) {
  }
  process_ = 0;
  const auto seconds = [](const timeval& t) {
    return static_cast<double>(t.tv_sec) + 1e-6 * static_cast<double>(t.tv_usec);
  };
  processor_time_ = seconds(used.ru_utime) + seconds(used.ru_stime);
  return WIFEXITED(status) ? WEXITSTATUS(status) : -1;
}

std::string VideoProcess::last_message() const {
  std::string text(4096, '\0');
  const off_t size = messages_ < 0 ? 0 : ::lseek(messages_, 0, SEEK_END);
  const off_t from = std::max<off_t>(0, size - static_cast<off_t>(text.size()));
  const ssize_t n = messages_ < 0 ? 0 : ::pread(messages_, text.data(), text.size(), from);
  text.resize(n > 0 ? static_cast<std::size_t>(n) : 0);
  while (!text.empty() && text.back() == '\n') text.pop_back();
  const std::size_t line = text.rfind('\n');
  return text.empty() ? "no message" : printable(text.substr(line + 1));
}

void VideoProcess::write(const render::Image& image) {
  if (image.width != width_ || image.height != height_)
    throw Error("video '" + path_ + "': a picture of another size");
  // A program that has ended must not end this process too.
  sigset_t pipe, before;
  sigemptyset(&pipe);
  sigaddset(&pipe, SIGPIPE);
  pthread_sigmask(SIG_BLOCK, &pipe, &before);
  bool whole = true;
  for (std::size_t done = 0; whole && done < image.rgb.size();) {
    const ssize_t n = ::write(pipe_, image.rgb.data() + done, image.rgb.size() - done);
    if (n > 0) done += static_cast<std::size_t>(n);
    if (n < 0 && errno != EINTR) whole = false;
  }
  if (!whole) {
    // Takes the signal of the failed write, which would come once it is no longer blocked.
    const timespec none{};
    ::sigtimedwait(&pipe, nullptr, &none);
  }
  pthread_sigmask(SIG_SETMASK, &before, nullptr);
  if (whole) return;
  wait();
  throw FileError("ffmpeg ended while it wrote '" + path_ + "': " + last_message());
}

void VideoProcess::finish() {
  if (process_ == 0) return;
  if (wait() != 0) throw FileError("ffmpeg cannot write '" + path_ + "': " + last_message());
}

}  // namespace navvy::record
