// SPDX-License-Identifier: Apache-2.0
#include "core/sealed.h"

#include <algorithm>
#include <cstdint>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <string>

#include "core/error.h"
#include "core/hash.h"
#include "core/saved_state.h"

namespace navvy {
namespace {

constexpr char kMagic[16] = "navvy state 1\n\n";
/// Length of the part of the magic that all versions share.
constexpr std::size_t kName = 11;
/// Size of the file's head [bytes]: magic, length of the file, checksum of both.
constexpr std::size_t kHead = sizeof kMagic + 2 * sizeof(std::uint64_t);

[[noreturn]] void refuse(const std::string& where, const std::string& rule) {
  throw InputError(Fault{
      Fault::Severity::kError, "snapshot", 0, where, "", rule,
      "it is damaged, is no snapshot, or comes from another version of Navvy; record it again"});
}

void append(std::vector<char>& to, const void* data, std::size_t size) {
  const char* bytes = static_cast<const char*>(data);
  to.insert(to.end(), bytes, bytes + size);
}

std::uint64_t number_at(const char* at) {
  std::uint64_t out = 0;
  std::memcpy(&out, at, sizeof out);
  return out;
}

/// Returns the hash of a section's bytes and its index, so that exchanged sections are found.
std::uint64_t checksum(std::uint64_t place, const char* data, std::size_t size) {
  StateHash sum;
  sum.value(place);
  sum.bytes(data, size);
  return sum.digest();
}

/// Returns the length of the section that begins at `at`, with its head, or 0 if no section fits
/// into `size`.
std::size_t section_size(const char* at, std::size_t size) {
  if (size < kSectionHead) return 0;
  const std::uint64_t body = number_at(at + kSectionHead - sizeof(std::uint64_t));
  return body <= size - kSectionHead ? kSectionHead + static_cast<std::size_t>(body) : 0;
}

/// Returns "section 2, 'ground'": the index of a section and its name, as far as it is readable.
std::string name_of(std::uint64_t place, const char* at, std::size_t size) {
  // A head is {name, version, length}.
  const std::size_t most =
      std::min(size, kSectionHead - sizeof(std::uint32_t) - sizeof(std::uint64_t));
  const std::string name(
      at, std::find_if_not(at, at + most, [](char c) { return c > ' ' && c < 0x7F; }));
  return "section " + std::to_string(place + 1) + (name.empty() ? "" : ", '" + name + "'");
}

}  // namespace

std::vector<char> seal(const std::vector<char>& state) {
  std::vector<char> out(kHead);
  std::uint64_t place = 0;
  for (std::size_t at = 0; at < state.size(); ++place) {
    const std::size_t size = section_size(state.data() + at, state.size() - at);
    if (size == 0)
      throw Error("seal: byte " + std::to_string(at) + " of the state lies in no section");
    const std::uint64_t sum = checksum(place, state.data() + at, size);
    append(out, &sum, sizeof sum);
    append(out, state.data() + at, size);
    at += size;
  }
  const std::uint64_t length = out.size();
  // The head is written last, when the length is known.
  std::memcpy(out.data(), kMagic, sizeof kMagic);
  std::memcpy(out.data() + sizeof kMagic, &length, sizeof length);
  const std::uint64_t sum = checksum(0, out.data(), sizeof kMagic + sizeof length);
  std::memcpy(out.data() + sizeof kMagic + sizeof length, &sum, sizeof sum);
  return out;
}

std::vector<char> unseal(const std::vector<char>& content) {
  if (content.size() < kHead || std::memcmp(content.data(), kMagic, sizeof kMagic) != 0)
    refuse("head", "must be a snapshot of this version");
  const char* const numbers = content.data() + sizeof kMagic;
  if (number_at(numbers + sizeof(std::uint64_t)) !=
      checksum(0, content.data(), kHead - sizeof(std::uint64_t)))
    refuse("head", "the checksum does not match");
  if (number_at(numbers) != content.size())
    refuse("head", "the file is truncated or longer than it was written");
  std::vector<char> out;
  out.reserve(content.size());
  std::uint64_t place = 0;
  for (std::size_t at = kHead; at < content.size(); ++place) {
    const std::size_t left = content.size() - at;
    if (left < sizeof(std::uint64_t)) refuse(name_of(place, "", 0), "the section is truncated");
    const char* const section = content.data() + at + sizeof(std::uint64_t);
    const std::string where = name_of(place, section, left - sizeof(std::uint64_t));
    const std::size_t size = section_size(section, left - sizeof(std::uint64_t));
    if (size == 0) refuse(where, "the section is truncated");
    if (number_at(content.data() + at) != checksum(place, section, size))
      refuse(where, "the checksum does not match");
    append(out, section, size);
    at += sizeof(std::uint64_t) + size;
  }
  return out;
}

bool is_sealed(const std::string& path) {
  // Opening a pipe would block.
  std::error_code code;
  if (!std::filesystem::is_regular_file(path, code)) return false;
  char head[kName] = {};
  std::ifstream(path, std::ios::binary).read(head, kName);
  return std::memcmp(head, kMagic, kName) == 0;
}

}  // namespace navvy
