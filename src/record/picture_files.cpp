// SPDX-License-Identifier: Apache-2.0
#include "record/picture_files.h"

#include <cstdio>
#include <ctime>
#include <utility>

#include "core/error.h"

namespace navvy::record {
namespace {

/// Returns the processor time of the calling thread [s].
double thread_time() {
  timespec now{};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &now);
  return static_cast<double>(now.tv_sec) + 1e-9 * static_cast<double>(now.tv_nsec);
}

}  // namespace

PictureFiles::PictureFiles(RunFolder& folder, PictureFormat format)
    : folder_(folder), format_(format) {
  if (format == PictureFormat::kVideo && program() == nullptr)
    throw InputError(Fault{Fault::Severity::kError, "", 0, "--pictures", "video",
                           "the program ffmpeg is not in PATH, or has no encoder for videos",
                           "install it, or use --pictures png"});
}

PictureFiles::~PictureFiles() { join(); }

const VideoProgram* PictureFiles::program() {
  if (!searched_ && format_ != PictureFormat::kPng) program_ = find_video_program();
  searched_ = true;
  return program_ ? &*program_ : nullptr;
}

void PictureFiles::write(const scene::Camera& camera, std::uint64_t number, render::Image image) {
  const VideoProgram* video = program();
  if (video == nullptr) {
    // The number of a picture gives its time: name_N.png is N periods from the start.
    char name[32];
    std::snprintf(name, sizeof name, "_%05llu.png", static_cast<unsigned long long>(number));
    add({folder_.path("frames/" + camera.name + name), std::move(image), 0, ""});
    return;
  }
  std::string& path = paths_[camera.name];
  std::string comment;
  if (path.empty()) {
    std::string label = camera.name;
    for (int i = 2; !taken_.insert(label).second; ++i)
      label = camera.name + "_" + std::to_string(i);
    path = folder_.path("frames/" + label + video->extension);
    char text[100];
    std::snprintf(text, sizeof text, "first picture at %.9g s of simulated time",
                  static_cast<double>(number) / camera.rate);
    comment = text;
  }
  add({path, std::move(image), camera.rate, comment});
}

void PictureFiles::restart() {
  for (auto& [name, path] : paths_)
    if (!path.empty()) add({std::exchange(path, ""), {}, 0, ""});
}

void PictureFiles::add(Job job) {
  std::unique_lock lock(mutex_);
  if (!thread_.joinable() && !ending_) thread_ = std::thread([this] { work(); });
  changed_.wait(lock, [&] { return jobs_.size() < kMost || error_; });
  if (error_) std::rethrow_exception(error_);
  jobs_.push_back(std::move(job));
  changed_.notify_all();
}

void PictureFiles::work() {
  while (true) {
    std::unique_lock lock(mutex_);
    changed_.wait(lock, [&] { return !jobs_.empty() || ending_; });
    if (jobs_.empty()) return;
    const Job job = std::move(jobs_.front());
    // A place is free as soon as encoding begins.
    jobs_.pop_front();
    changed_.notify_all();
    if (error_) continue;
    lock.unlock();
    const double begun = thread_time();
    std::exception_ptr error;
    try {
      encode(job);
    } catch (const std::exception&) {
      error = std::current_exception();
    }
    lock.lock();
    processor_time_ += thread_time() - begun;
    error_ = error;
  }
}

void PictureFiles::encode(const Job& job) {
  // Without a rate it is a PNG file, except for the end of a video, which has no image.
  if (job.rate == 0 && !job.image.rgb.empty()) {
    render::write_png(job.path, job.image);
    return;
  }
  std::unique_ptr<VideoProcess>& video = videos_[job.path];
  if (!job.image.rgb.empty()) {
    if (!video)
      video = std::make_unique<VideoProcess>(*program_, job.path, job.image.width, job.image.height,
                                             job.rate, job.comment);
    video->write(job.image);
    return;
  }
  const auto ended = std::move(video);
  videos_.erase(job.path);
  if (!ended) return;
  ended->finish();
  const std::lock_guard lock(mutex_);
  processor_time_ += ended->processor_time();
}

void PictureFiles::join() {
  {
    const std::lock_guard lock(mutex_);
    ending_ = true;
    changed_.notify_all();
  }
  if (thread_.joinable()) thread_.join();
}

void PictureFiles::finish() {
  join();
  for (auto& [path, video] : videos_) {
    if (!video) continue;
    try {
      video->finish();
    } catch (const std::exception&) {
      if (!error_) error_ = std::current_exception();
    }
    processor_time_ += video->processor_time();
  }
  videos_.clear();
  paths_.clear();
  if (error_) std::rethrow_exception(std::exchange(error_, nullptr));
}

double PictureFiles::processor_time() const {
  const std::lock_guard lock(mutex_);
  return processor_time_;
}

}  // namespace navvy::record
