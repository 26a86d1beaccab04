// SPDX-License-Identifier: Apache-2.0
#include "record/crash_summary.h"

#include <fcntl.h>
#include <unistd.h>

#include <cerrno>
#include <cstdio>
#include <cstring>
#include <utility>

#include "core/error.h"

namespace navvy::record {
namespace {

/// A summary without cycles has 4 kB and grows by some lines per cycle.
constexpr std::size_t kLeastCapacity = std::size_t{64} << 10;

/// The object that write_crash_summary uses.
std::atomic<CrashSummary*> speaking{nullptr};

/// Returns a part of a summary with running programs marked as interrupted: the run is over when it
/// is read.
std::string ended(std::string text) {
  const std::string running = "\"state\": \"running\"", over = "\"state\": \"interrupted\"";
  for (std::size_t at = text.find(running); at != std::string::npos;
       at = text.find(running, at + over.size()))
    text.replace(at, running.size(), over);
  return text;
}

// The functions below run in signal handlers, so they allocate no memory and take no lock.

/// Writes all bytes. Returns false on failure.
bool put(int file, const char* text, std::size_t size) {
  while (size > 0) {
    const ssize_t n = ::write(file, text, size);
    if (n < 0 && errno == EINTR) continue;
    if (n <= 0) return false;
    text += n;
    size -= static_cast<std::size_t>(n);
  }
  return true;
}

/// Writes text as the content of a JSON string. Characters that need an escape become a space.
bool put_text(int file, const char* text) {
  for (; *text != '\0'; ++text) {
    const char c = *text == '\n' ? ';' : *text;
    if (c == '"'                            ? !put(file, "'", 1)
        : (c < ' ' || c == '\\' || c > '~') ? !put(file, " ", 1)
                                            : !put(file, &c, 1))
      return false;
  }
  return true;
}

}  // namespace

CrashSummary::CrashSummary(std::string reserve, std::string target)
    : reserve_(std::move(reserve)), target_(std::move(target)) {
  file_ = ::open(reserve_.c_str(), O_RDWR | O_CREAT | O_TRUNC | O_CLOEXEC, 0644);
  if (file_ < 0) throw FileError("cannot create '" + reserve_ + "': " + std::strerror(errno));
  if (!take_capacity(kLeastCapacity)) {
    const int code = errno;
    ::close(file_);
    ::unlink(reserve_.c_str());
    throw FileError("cannot write '" + reserve_ + "': " + std::strerror(code));
  }
  speaking = this;
}

CrashSummary::~CrashSummary() {
  CrashSummary* self = this;
  speaking.compare_exchange_strong(self, nullptr);
  // There is no file of this name once it became the summary.
  if (file_ >= 0) ::close(file_);
  ::unlink(reserve_.c_str());
}

/// Writes the bytes, as file systems that compress or copy on write do not guarantee space that was
/// only reserved.
bool CrashSummary::take_capacity(std::size_t bytes) {
  const std::string blank(4096, ' ');
  for (; reserved_ < bytes; reserved_ += blank.size())
    if (::pwrite(file_, blank.data(), blank.size(), static_cast<off_t>(reserved_)) !=
        static_cast<ssize_t>(blank.size())) {
      if (errno == 0) errno = ENOSPC;
      return false;
    }
  return ::fsync(file_) == 0 || errno == EINVAL;
}

void CrashSummary::keep(const std::string& summary) {
  const std::string mark = "\"status\": \"running\"";
  const std::size_t at = summary.find(mark);
  if (file_ < 0 || at == std::string::npos) return;
  // Twice the size of the text, which grows between two checkpoints and by a message.
  if (summary.size() * 2 > reserved_ && !take_capacity(summary.size() * 4)) return;
  const int next = ready_ == 0 ? 1 : 0;
  // The text that a handler may read right now stays as it is.
  texts_[next] = {ended(summary.substr(0, at)), ended(summary.substr(at + mark.size()))};
  ready_ = next;
}

/// The file keeps its reserved blocks until it is cut to the length of the text.
bool CrashSummary::write(const std::string& text) noexcept {
  if (file_ < 0 || ::lseek(file_, 0, SEEK_SET) != 0 || !put(file_, text.data(), text.size()))
    return false;
  if (::ftruncate(file_, static_cast<off_t>(text.size())) != 0) return false;
  ::fsync(file_);
  ::close(std::exchange(file_, -1));
  return std::rename(reserve_.c_str(), target_.c_str()) == 0;
}

bool CrashSummary::leave(const char* status, const char* message) noexcept {
  const int ready = ready_;
  if (file_ < 0 || ready < 0 || ::lseek(file_, 0, SEEK_SET) != 0) return false;
  const auto put_all = [&](const std::string& text) {
    return put(file_, text.data(), text.size());
  };
  const bool written = put_all(texts_[ready].before) && put(file_, "\"message\": \"", 12) &&
                       put_text(file_, message) && put(file_, "\",\n  \"status\": \"", 16) &&
                       put_text(file_, status) && put(file_, "\"", 1) &&
                       put_all(texts_[ready].after);
  const off_t end = ::lseek(file_, 0, SEEK_CUR);
  if (!written || ::ftruncate(file_, end) != 0) return false;
  ::fsync(file_);
  ::close(std::exchange(file_, -1));
  return std::rename(reserve_.c_str(), target_.c_str()) == 0;
}

bool write_crash_summary(const char* status, const char* message) noexcept {
  // The first caller wins: a handler may be called within a handler.
  CrashSummary* words = speaking.exchange(nullptr);
  return words != nullptr && words->leave(status, message);
}

}  // namespace navvy::record
