// SPDX-License-Identifier: Apache-2.0
#include "core/sealed.h"

#include <algorithm>
#include <array>
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

constexpr char kMagic[16] = "navvy state 3\n\n";
/// Length of the part of the magic that all versions share; the version follows it.
constexpr std::size_t kName = 11;
constexpr std::size_t kNumber = sizeof(std::uint64_t);
/// Positions in the head: magic, length of the file, checksum of the last section, checksum of all
/// these.
constexpr std::size_t kLength = sizeof kMagic, kLast = kLength + kNumber, kSum = kLast + kNumber,
                      kHead = kSum + kNumber;

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

/// Returns the hash of a section's bytes, its index and the checksum of the section before it (0
/// for the first and for the head). A section of another state, even of the same run a step later,
/// thus has another checksum in its place.
std::uint64_t checksum(std::uint64_t place, std::uint64_t before, const char* data,
                       std::size_t size) {
  // Words go to four hashes in turn: one hash waits for each of its multiplications.
  constexpr std::size_t kWord = sizeof(std::uint64_t), kLanes = 4;
  std::array<StateHash, kLanes> lanes;
  std::size_t at = 0;
  for (; at + kLanes * kWord <= size; at += kLanes * kWord)
    for (std::size_t lane = 0; lane < kLanes; ++lane)
      lanes[lane].value(number_at(data + at + lane * kWord));
  StateHash sum;
  sum.value(place);
  sum.value(before);
  sum.value(static_cast<std::uint64_t>(size));
  sum.bytes(data + at, size - at);
  for (const StateHash& lane : lanes) sum.value(lane.digest());
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
  // A state has some dozen sections.
  constexpr std::size_t kSections = 64;
  std::vector<char> out(kHead);
  out.reserve(kHead + state.size() + kSections * kNumber);
  std::uint64_t place = 0, last = 0;
  for (std::size_t at = 0; at < state.size(); ++place) {
    const std::size_t size = section_size(state.data() + at, state.size() - at);
    if (size == 0)
      throw Error("seal: byte " + std::to_string(at) + " of the state lies in no section");
    last = checksum(place, last, state.data() + at, size);
    append(out, &last, sizeof last);
    append(out, state.data() + at, size);
    at += size;
  }
  const std::uint64_t length = out.size();
  // The head is written last, when the length is known.
  std::memcpy(out.data(), kMagic, sizeof kMagic);
  std::memcpy(out.data() + kLength, &length, sizeof length);
  std::memcpy(out.data() + kLast, &last, sizeof last);
  const std::uint64_t sum = checksum(0, 0, out.data(), kSum);
  std::memcpy(out.data() + kSum, &sum, sizeof sum);
  return out;
}

namespace {

/// Checks magic, length and checksum of the head.
void check_head(const std::vector<char>& content) {
  if (content.size() >= sizeof kMagic && std::memcmp(content.data(), kMagic, kName) == 0 &&
      std::memcmp(content.data(), kMagic, sizeof kMagic) != 0) {
    const std::string version(content.data() + kName, content.data() + sizeof kMagic);
    throw InputError(Fault{
        Fault::Severity::kError, "snapshot", 0, "head", version.substr(1, version.find('\n') - 1),
        std::string("another version of Navvy wrote this format; this one reads ") +
            kMagic[kName + 1],
        "continue with that version, or record the snapshot again"});
  }
  if (content.size() < kHead || std::memcmp(content.data(), kMagic, sizeof kMagic) != 0)
    refuse("head", "must be a snapshot");
  if (number_at(content.data() + kSum) != checksum(0, 0, content.data(), kSum))
    refuse("head", "the checksum does not match");
  if (number_at(content.data() + kLength) != content.size())
    refuse("head", "the file is truncated or longer than it was written");
}

}  // namespace

std::vector<char> unseal(const std::vector<char>& content) {
  check_head(content);
  std::vector<char> out;
  out.reserve(content.size());
  std::uint64_t place = 0, last = 0;
  for (std::size_t at = kHead; at < content.size(); ++place) {
    const std::size_t left = content.size() - at;
    if (left < sizeof(std::uint64_t)) refuse(name_of(place, "", 0), "the section is truncated");
    const char* const section = content.data() + at + sizeof(std::uint64_t);
    const std::string where = name_of(place, section, left - sizeof(std::uint64_t));
    const std::size_t size = section_size(section, left - sizeof(std::uint64_t));
    if (size == 0) refuse(where, "the section is truncated");
    last = checksum(place, last, section, size);
    if (number_at(content.data() + at) != last)
      refuse(where, "the checksum does not match: the section is damaged, or of another state");
    append(out, section, size);
    at += sizeof(std::uint64_t) + size;
  }
  if (number_at(content.data() + kLast) != last)
    refuse("head", "the last section is of another state");
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
