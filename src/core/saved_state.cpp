// SPDX-License-Identifier: Apache-2.0
#include "core/saved_state.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cstring>

#include "core/error.h"

namespace navvy {

// Numbers are stored as in memory, so states are portable between little-endian machines only.
static_assert(std::endian::native == std::endian::little, "states are little-endian");

namespace {

constexpr std::size_t kTagSize = 16;
using Tag = std::array<char, kTagSize>;

/// Returns the tag padded with zeros. All bytes are compared on loading, so no byte of a head is
/// without meaning.
Tag tag_of(const char* text) {
  Tag tag{};
  const std::size_t size = std::strlen(text);
  // One byte stays free for the terminating zero.
  if (size == 0 || size >= kTagSize)
    throw Error("archive: bad section '" + std::string(text) + "'");
  std::memcpy(tag.data(), text, size);
  return tag;
}

/// Adds fields to a hash. Heads of sections are left out: equal values in another section are the
/// same state.
class HashArchive final : public Archive {
 public:
  explicit HashArchive(StateHash& sum) : Archive(false), sum_(sum) {}

 private:
  // Extended to a word with zeros, as StateHash takes single values.
  void scalar(void* data, std::size_t size) override {
    if (!hashed()) return;
    std::uint64_t word = 0;
    std::memcpy(&word, data, size);
    sum_.value(word);
  }
  void block(void* data, std::size_t size) override {
    if (hashed()) sum_.bytes(data, size);
  }
  void begin_section(const char*, std::uint32_t) override {}
  void end_section() override {}

  StateHash& sum_;
};

/// Collects bytes and, in a map, the field of each.
class SaveArchive final : public Archive {
 public:
  explicit SaveArchive(ByteMap* map) : Archive(false), map_(map) {}
  std::vector<char> take() { return std::move(bytes_); }

 private:
  void scalar(void* data, std::size_t size) override {
    // An empty list has no bytes to map.
    if (size == 0) return;
    if (map_) map_->fields.push_back({bytes_.size(), size, path(), hashed(), reason()});
    append(data, size);
  }
  void block(void* data, std::size_t size) override { scalar(data, size); }
  // A head is {tag, version, size of the body}, 28 bytes.
  void begin_section(const char* tag, std::uint32_t version) override {
    const Tag name = tag_of(tag);
    append(name.data(), name.size());
    append(&version, sizeof version);
    // Overwritten when the section ends.
    const std::uint64_t size = 0;
    append(&size, sizeof size);
    open_.push_back(bytes_.size());
  }
  void end_section() override {
    const std::uint64_t size = bytes_.size() - open_.back();
    std::memcpy(bytes_.data() + open_.back() - sizeof size, &size, sizeof size);
    open_.pop_back();
  }
  void append(const void* data, std::size_t size) {
    const auto* p = static_cast<const char*>(data);
    bytes_.insert(bytes_.end(), p, p + size);
  }

  ByteMap* map_;
  std::vector<char> bytes_;
  // Offsets of the bodies of open sections.
  std::vector<std::size_t> open_;
};

/// Loads what SaveArchive wrote.
class LoadArchive final : public Archive {
 public:
  explicit LoadArchive(std::vector<char> bytes) : Archive(true), bytes_(std::move(bytes)) {}
  void finish() const {
    if (left() > 0) fail("the state is longer than this version reads");
  }

 private:
  // The only place that reads, also for heads of sections: nothing beyond the innermost section is
  // ever read.
  void scalar(void* data, std::size_t size) override {
    if (size > left()) fail("the section ends too early");
    if (size > 0) std::memcpy(data, bytes_.data() + at_, size);
    at_ += size;
  }
  void block(void* data, std::size_t size) override { scalar(data, size); }
  void begin_section(const char* tag, std::uint32_t version) override {
    const Tag wanted = tag_of(tag);
    Tag found{};
    scalar(found.data(), found.size());
    if (found != wanted) {
      const std::string name(found.data(), strnlen(found.data(), kTagSize));
      fail("expected section '" + std::string(tag) + "', found '" + name + "'");
    }
    std::uint32_t number = 0;
    scalar(&number, sizeof number);
    if (number != version)
      fail("version " + std::to_string(number) + " of this section, this program reads " +
           std::to_string(version));
    std::uint64_t size = 0;
    scalar(&size, sizeof size);
    // `left` counts within the enclosing section, so no section extends beyond it.
    if (size > left()) fail("the section is truncated");
    ends_.push_back(at_ + size);
  }
  void end_section() override {
    // Left-over bytes mean that other fields were saved, so what was loaded may be nonsense.
    if (left() > 0) fail("the section is longer than this version reads");
    ends_.pop_back();
  }
  std::size_t left() const override { return (ends_.empty() ? bytes_.size() : ends_.back()) - at_; }

  std::vector<char> bytes_;
  std::size_t at_ = 0;
  // Ends of open sections.
  std::vector<std::size_t> ends_;
};

}  // namespace

// Finds the last field that begins at or before the byte. Heads of sections lie between fields.
const ByteMap::Field* ByteMap::at(std::size_t offset) const {
  const auto after =
      std::upper_bound(fields.begin(), fields.end(), offset,
                       [](std::size_t value, const Field& field) { return value < field.offset; });
  if (after == fields.begin()) return nullptr;
  const Field& field = *(after - 1);
  return offset < field.offset + field.size ? &field : nullptr;
}

void saved_state::hash(StateHash& sum, const Visit& visit) {
  HashArchive archive(sum);
  visit(archive);
}

std::vector<char> saved_state::save(const Visit& visit, ByteMap* map) {
  SaveArchive archive(map);
  visit(archive);
  return archive.take();
}

void saved_state::load(std::vector<char> bytes, const Visit& visit) {
  // If the visit throws, the object is half loaded; the caller discards it or loads it again.
  LoadArchive archive(std::move(bytes));
  visit(archive);
  archive.finish();
}

}  // namespace navvy
