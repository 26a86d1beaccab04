// SPDX-License-Identifier: Apache-2.0
#include "formats/pvd_index.h"

#include <fcntl.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <nlohmann/json.hpp>
#include <utility>

#include "core/error.h"
#include "core/file.h"

namespace navvy::formats {
namespace {

constexpr const char* kHead =
    "<?xml version=\"1.0\"?>\n<VTKFile type=\"Collection\" version=\"0.1\" "
    "byte_order=\"LittleEndian\">\n<Collection>\n";
constexpr const char* kTail = "</Collection>\n</VTKFile>\n";

}  // namespace

PvdIndex::PvdIndex(std::string path) : path_(std::move(path)) {}

PvdIndex::~PvdIndex() {
  if (file_ >= 0) ::close(file_);
}

void PvdIndex::add(double time, const std::string& name) {
  const auto require = [&](bool good) {
    if (!good) throw FileError("cannot write '" + path_ + "': " + std::strerror(errno));
  };
  if (file_ < 0) {
    // A file of an earlier run is replaced as a whole, never overwritten in part.
    write_file_atomically(path_, std::string(kHead) + kTail);
    file_ = ::open(path_.c_str(), O_WRONLY | O_CLOEXEC);
    require(file_ >= 0);
    end_ = std::strlen(kHead);
  }
  const std::string entry = "<DataSet timestep=\"" + nlohmann::json(time).dump() +
                            "\" part=\"0\" file=\"" + name + "\"/>\n";
  // One call writes entry and end of the document over the former end. After a failure the next
  // call writes at the same place.
  const std::string text = entry + kTail;
  errno = ENOSPC;
  require(::pwrite(file_, text.data(), text.size(), static_cast<off_t>(end_)) ==
          static_cast<ssize_t>(text.size()));
  end_ += entry.size();
}

}  // namespace navvy::formats
