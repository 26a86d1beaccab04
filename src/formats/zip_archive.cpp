// SPDX-License-Identifier: Apache-2.0
#include "formats/zip_archive.h"

#include <zip.h>

#include <algorithm>
#include <cstring>
#include <exception>
#include <utility>

#include "core/error.h"
#include "core/file.h"

namespace navvy::formats {

struct ZipArchive::Entry {
  Next next;
  std::uint64_t size;
  std::string bytes;
  std::size_t at;
  std::exception_ptr failure;
};

ZipArchive::ZipArchive(const std::string& path) : path_(path), part_(partial_name(path)) {
  navvy::require_writable(path);
  int code = 0;
  archive_ = zip_open(part_.c_str(), ZIP_CREATE | ZIP_TRUNCATE, &code);
  if (archive_ != nullptr) return;
  zip_error_t error;
  zip_error_init_with_code(&error, code);
  const std::string cause = zip_error_strerror(&error);
  zip_error_fini(&error);
  fail(cause);
}

ZipArchive::~ZipArchive() {
  if (archive_ != nullptr) zip_discard(archive_);
}

void ZipArchive::add(const std::string& name, std::uint64_t size, Next next) {
  Entry& entry = entries_.emplace_back(Entry{std::move(next), size, "", 0, nullptr});
  const auto callback = [](void* user, void* data, zip_uint64_t length, zip_source_cmd_t command) {
    return static_cast<zip_int64_t>(serve(user, data, length, command));
  };
  zip_source_t* source = zip_source_function(archive_, callback, &entry);
  if (source == nullptr) fail(zip_strerror(archive_));
  const zip_int64_t index = zip_file_add(archive_, name.c_str(), source, ZIP_FL_ENC_UTF_8);
  if (index < 0) {
    zip_source_free(source);
    fail(zip_strerror(archive_));
  }
  const auto number = static_cast<zip_uint64_t>(index);
  zip_set_file_compression(archive_, number, ZIP_CM_STORE, 0);
  // 1980-01-01 00:00: the same entries give the same bytes.
  zip_file_set_dostime(archive_, number, 0, 33, 0);
}

void ZipArchive::add(const std::string& name, std::string content) {
  const std::uint64_t size = content.size();
  add(name, size,
      [content = std::move(content)]() mutable { return std::exchange(content, std::string()); });
}

void ZipArchive::commit() {
  if (zip_close(archive_) != 0) {
    for (const Entry& entry : entries_)
      if (entry.failure) std::rethrow_exception(entry.failure);
    fail(zip_strerror(archive_));
  }
  archive_ = nullptr;
  commit_file(path_);
}

void ZipArchive::fail(const std::string& cause) const {
  throw FileError("cannot write '" + path_ + "': " + cause);
}

std::int64_t ZipArchive::read(Entry& entry, char* data, std::uint64_t length) {
  std::uint64_t done = 0;
  try {
    while (done < length) {
      if (entry.at == entry.bytes.size()) {
        entry.bytes = entry.next();
        entry.at = 0;
        if (entry.bytes.empty()) break;
      }
      const std::size_t count = std::min<std::size_t>(length - done, entry.bytes.size() - entry.at);
      // Bytes, not a text. NOLINTNEXTLINE(bugprone-not-null-terminated-result)
      std::memcpy(data + done, entry.bytes.data() + entry.at, count);
      entry.at += count;
      done += count;
    }
  } catch (...) {
    // The library is C: the exception goes on in `commit`.
    entry.failure = std::current_exception();
    return -1;
  }
  return static_cast<std::int64_t>(done);
}

std::int64_t ZipArchive::serve(void* user, void* data, std::uint64_t length, int command) {
  Entry& entry = *static_cast<Entry*>(user);
  switch (command) {
    case ZIP_SOURCE_SUPPORTS:
      return ZIP_SOURCE_SUPPORTS_READABLE;
    case ZIP_SOURCE_READ:
      return read(entry, static_cast<char*>(data), length);
    case ZIP_SOURCE_STAT: {
      // With its size known an entry below 4 GiB needs no ZIP64.
      auto* stat = static_cast<zip_stat_t*>(data);
      zip_stat_init(stat);
      stat->valid |= ZIP_STAT_SIZE;
      stat->size = entry.size;
      return sizeof(zip_stat_t);
    }
    case ZIP_SOURCE_ERROR: {
      auto* codes = static_cast<int*>(data);
      codes[0] = ZIP_ER_READ;
      codes[1] = 0;
      return 2 * sizeof(int);
    }
    default:
      return 0;
  }
}

}  // namespace navvy::formats
