// SPDX-License-Identifier: Apache-2.0
#include "core/state_io.h"

#include <array>
#include <bit>

namespace navvy {

static_assert(std::endian::native == std::endian::little, "snapshots are little-endian");

namespace {
constexpr std::size_t kTagSize = 16;
}

void StateWriter::begin(const std::string& tag, std::uint32_t version) {
  if (open_ || tag.empty() || tag.size() >= kTagSize) throw Error("StateWriter: bad section '" + tag + "'");
  std::array<char, kTagSize> name{};
  std::memcpy(name.data(), tag.data(), tag.size());
  bytes_.insert(bytes_.end(), name.begin(), name.end());
  value(version);
  section_ = bytes_.size();
  value(std::uint64_t{0});
  open_ = true;
}

void StateWriter::end() {
  if (!open_) throw Error("StateWriter: end() without begin()");
  const std::uint64_t size = bytes_.size() - section_ - sizeof(std::uint64_t);
  std::memcpy(bytes_.data() + section_, &size, sizeof size);
  open_ = false;
}

void StateReader::fail(const std::string& rule) const {
  throw InputError(Fault{Fault::Severity::kError, "snapshot", 0, tag_, "", rule,
                         "it was written by another version of Navvy or damaged; record it again"});
}

void StateReader::begin(const std::string& tag, std::uint32_t known) {
  if (open_) fail("section entered before the last was left");
  tag_ = tag;
  need(kTagSize);
  const std::string found(bytes_.data() + at_, strnlen(bytes_.data() + at_, kTagSize));
  at_ += kTagSize;
  if (found != tag) fail("expected this section, found '" + found + "'");
  const auto version = value<std::uint32_t>();
  if (version != known)
    fail("version " + std::to_string(version) + " of this section, this program reads " + std::to_string(known));
  const auto size = value<std::uint64_t>();
  if (size > bytes_.size() - at_) fail("the section is cut short");
  section_end_ = at_ + size;
  open_ = true;
}

void StateReader::end() {
  if (!open_) fail("left without being entered");
  if (at_ != section_end_) fail("the section holds more than this version reads");
  open_ = false;
}

}  // namespace navvy
