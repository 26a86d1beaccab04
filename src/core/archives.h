// SPDX-License-Identifier: Apache-2.0
// The kinds of Archive: one hashes, one saves, one loads. Whoever visits needs core/archive.h only; this is for whoever
// asks an object for its hash or its bytes.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <utility>
#include <vector>

#include "core/archive.h"
#include "core/hash.h"

namespace navvy {

/// Feeds every field to a hash: numbers one by one, runs of plain values as bytes, lengths before elements.
class HashArchive final : public Archive {
 public:
  explicit HashArchive(StateHash& hash) : Archive(false), hash_(hash) {}

  /// Visits an object that must not change; visits keep that word unless they load.
  template <class T>
  void read(const T& object) {
    const_cast<T&>(object).visit(*this);
  }

 private:
  void scalar(void* data, std::size_t size) override;
  void block(void* data, std::size_t size) override;
  void begin_section(const char*, std::uint32_t) override {}
  void end_section() override {}

  StateHash& hash_;
};

/// Which field the bytes of a saved state belong to.
struct ByteMap {
  struct Field {
    std::size_t offset = 0, size = 0;  ///< [bytes]
    std::string path;                  ///< "world/tools[2]/force"
    bool hashed = true;
    std::string reason;  ///< why not; empty for constants, which loading compares with the scene
  };
  std::vector<Field> fields;  ///< ascending by offset; heads of sections are in none

  /// The field of byte `offset`; null in the head of a section.
  const Field* at(std::size_t offset) const;
};

/// Collects the bytes of a state in memory.
class SaveArchive final : public Archive {
 public:
  /// With a `map`, every run of bytes is noted in it; that is slow and meant for tests.
  explicit SaveArchive(ByteMap* map = nullptr) : Archive(false), map_(map) {}

  /// Visits an object that must not change.
  template <class T>
  void read(const T& object) {
    const_cast<T&>(object).visit(*this);
  }
  const std::vector<char>& bytes() const { return bytes_; }

 private:
  void scalar(void* data, std::size_t size) override;
  void block(void* data, std::size_t size) override { scalar(data, size); }
  void begin_section(const char* tag, std::uint32_t version) override;
  void end_section() override;
  void append(const void* data, std::size_t size);

  ByteMap* map_;
  std::vector<char> bytes_;
  std::vector<std::size_t> open_;  ///< where the bodies of open sections begin
};

/// Reads what a SaveArchive wrote. Every fault throws InputError naming the field; the object is then half loaded and
/// must be loaded again or thrown away. Input of any length and content is safe: nothing is read beyond the end, and
/// memory follows the bytes that are there.
class LoadArchive final : public Archive {
 public:
  explicit LoadArchive(std::vector<char> bytes) : Archive(true), bytes_(std::move(bytes)) {}

  /// Visits an object, whose fields are overwritten one by one.
  template <class T>
  void write(T& object) {
    object.visit(*this);
  }
  /// @throws InputError when bytes were left unread.
  void finish() const;

 private:
  void scalar(void* data, std::size_t size) override;
  void block(void* data, std::size_t size) override { scalar(data, size); }
  void begin_section(const char* tag, std::uint32_t version) override;
  void end_section() override;
  std::size_t left() const override { return (ends_.empty() ? bytes_.size() : ends_.back()) - at_; }

  std::vector<char> bytes_;
  std::size_t at_ = 0;
  std::vector<std::size_t> ends_;  ///< of open sections
};

/// Hash of one object's state: `.digest()` or `.hex()`.
template <class T>
StateHash hash_of(const T& object) {
  StateHash hash;
  HashArchive(hash).read(object);
  return hash;
}

/// The bytes of one object's state; with a `map`, which field each belongs to.
template <class T>
std::vector<char> saved(const T& object, ByteMap* map = nullptr) {
  SaveArchive archive(map);
  archive.read(object);
  return archive.bytes();
}

/// Loads an object from what `saved` answered. @throws InputError naming the field; see LoadArchive.
template <class T>
void load_saved(std::vector<char> bytes, T& object) {
  LoadArchive archive(std::move(bytes));
  archive.write(object);
  archive.finish();
}

}  // namespace navvy
