// SPDX-License-Identifier: Apache-2.0
#include "core/state_io.h"

#include <array>
#include <bit>

namespace navvy {

// Numbers are written as they lie in memory: a snapshot travels between little-endian machines only.
static_assert(std::endian::native == std::endian::little, "snapshots are little-endian");

namespace {
// The same width as the sections of core/saved_state.cpp, so that a tag reads alike in a dump of either.
constexpr std::size_t kTagSize = 16;
}  // namespace

void StateWriter::begin(const std::string& tag, std::uint32_t version) {
  // Both are mistakes of the program, not of a file, hence a plain Error.
  if (open_ || tag.empty() || tag.size() >= kTagSize) throw Error("StateWriter: bad section '" + tag + "'");
  std::array<char, kTagSize> name{};
  std::memcpy(name.data(), tag.data(), tag.size());
  bytes_.insert(bytes_.end(), name.begin(), name.end());
  value(version);
  section_ = bytes_.size();
  // The body's size is not known yet; end() writes it over this word.
  value(std::uint64_t{0});
  open_ = true;
}

void StateWriter::end() {
  if (!open_) throw Error("StateWriter: end() without begin()");
  const std::uint64_t size = bytes_.size() - section_ - sizeof(std::uint64_t);
  std::memcpy(bytes_.data() + section_, &size, sizeof size);
  open_ = false;
}

// A fault in a snapshot is bad input, not a bug: the message says what to do about it.
void StateReader::fail(const std::string& rule) const {
  throw InputError(Fault{Fault::Severity::kError, "snapshot", 0, tag_, "", rule,
                         "it was written by another version of Navvy or damaged; record it again"});
}

void StateReader::begin(const std::string& tag, std::uint32_t known) {
  if (open_) fail("section entered before the last was left");
  tag_ = tag;
  // The tag is compared before anything else is believed, so that a damaged file is not read as numbers.
  need(kTagSize);
  const std::string found(bytes_.data() + at_, strnlen(bytes_.data() + at_, kTagSize));
  at_ += kTagSize;
  if (found != tag) fail("expected this section, found '" + found + "'");
  const auto version = value<std::uint32_t>();
  if (version != known)
    fail("version " + std::to_string(version) + " of this section, this program reads " + std::to_string(known));
  const auto size = value<std::uint64_t>();
  // Compared by subtraction: a huge size would wrap around in a sum and pass.
  if (size > bytes_.size() - at_) fail("the section is cut short");
  section_end_ = at_ + size;
  open_ = true;
}

void StateReader::end() {
  if (!open_) fail("left without being entered");
  // Bytes too many mean that the writer had other fields: what was read before may be nonsense, so this is no warning.
  if (at_ != section_end_) fail("the section holds more than this version reads");
  open_ = false;
}

}  // namespace navvy
