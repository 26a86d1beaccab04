// SPDX-License-Identifier: Apache-2.0
// An MCAP file consists of a magic, records of opcode, length and body, and the magic again.
// Numbers are little-endian; strings and maps begin with their length in 32 bits.
#include <algorithm>
#include <array>
#include <cerrno>
#include <cstdio>
#include <cstring>
#include <map>

#include "core/error.h"
#include "formats/ros/bag.h"

namespace navvy::formats::ros {
namespace {

constexpr char kMagic[] = "\x89MCAP0\r\n";
constexpr std::size_t kMagicBytes = 8;
// Opcodes of the MCAP specification, version 0. No chunks are written: each message is in the file
// as soon as it is flushed, so that a killed run leaves all of them.
enum Opcode : std::uint8_t {
  kHeader = 0x01,
  kFooter = 0x02,
  kSchema = 0x03,
  kChannel = 0x04,
  kMessage = 0x05,
  kStatistics = 0x0B,
  kDataEnd = 0x0F
};

template <class T>
void put(std::string& to, T value) {
  char bytes[sizeof(T)];
  std::memcpy(bytes, &value, sizeof value);
  to.append(bytes, sizeof value);
}
// A string is its length and its bytes.
void put_text(std::string& to, const std::string& text) {
  put(to, static_cast<std::uint32_t>(text.size()));
  to += text;
}

class Mcap final : public Bag {
 public:
  explicit Mcap(const std::string& path) : path_(path), file_(std::fopen(path.c_str(), "wb")) {
    if (file_ == nullptr) fail();
    append(std::string(kMagic, kMagicBytes));
    std::string body;
    // Profile and library; the profile "ros2" states how channels and schemas are to be read.
    put_text(body, "ros2");
    put_text(body, "navvy");
    record(kHeader, body);
  }
  Mcap(const Mcap&) = delete;
  Mcap& operator=(const Mcap&) = delete;
  ~Mcap() override {
    if (file_ != nullptr) std::fclose(file_);
  }

  bool has(const std::string& topic) const override { return topics_.count(topic) > 0; }

  void close() override {
    if (file_ == nullptr) return;
    std::string none;
    // No checksum.
    put(none, std::uint32_t{0});
    record(kDataEnd, none);
    const std::uint64_t summary = written_;
    // The summary repeats schemas and channels, where a reader finds them without reading the whole
    // file.
    append(summary_);
    std::string statistics;
    put(statistics, messages_);
    put(statistics, static_cast<std::uint16_t>(schemas_.size()));
    put(statistics, static_cast<std::uint32_t>(topics_.size()));
    // No attachments, metadata or chunks.
    for (int i = 0; i < 3; ++i) put(statistics, std::uint32_t{0});
    put(statistics, static_cast<std::uint64_t>(first_));
    put(statistics, static_cast<std::uint64_t>(last_));
    // The map of message counts has entries of 2 + 8 bytes; its length is in bytes.
    put(statistics, static_cast<std::uint32_t>(10 * topics_.size()));
    // Sorted by id, the order of creation.
    std::map<std::uint16_t, std::uint64_t> counts;
    for (const auto& [name, topic] : topics_) counts[topic.id] = topic.messages;
    for (const auto& [id, count] : counts) {
      put(statistics, id);
      put(statistics, count);
    }
    record(kStatistics, statistics);
    std::string footer;
    // Start of the summary, no summary offsets, no checksum.
    put(footer, summary);
    put(footer, std::uint64_t{0});
    put(footer, std::uint32_t{0});
    record(kFooter, footer);
    append(std::string(kMagic, kMagicBytes));
    std::FILE* file = file_;
    file_ = nullptr;
    if (std::fclose(file) != 0) fail();
  }

 private:
  struct Channel {
    std::uint16_t id = 0;
    std::uint64_t messages = 0;
  };

  void add(const Topic& topic, std::int64_t time_ns, const Bytes& message) override {
    Channel& channel = channel_of(topic);
    std::string body;
    put(body, channel.id);
    // Sequence number, log time and publish time. Both times are the simulated time.
    put(body, static_cast<std::uint32_t>(channel.messages++));
    put(body, static_cast<std::uint64_t>(time_ns));
    put(body, static_cast<std::uint64_t>(time_ns));
    body.append(message.data(), message.size());
    record(kMessage, body);
    // Flushed, so that a reader may follow the file during the run.
    if (std::fflush(file_) != 0) fail();
    first_ = messages_ == 0 ? time_ns : std::min(first_, time_ns);
    last_ = messages_++ == 0 ? time_ns : std::max(last_, time_ns);
  }

  [[noreturn]] void fail() const {
    throw FileError("cannot write '" + path_ + "': " + std::strerror(errno));
  }
  void append(const std::string& bytes) {
    if (std::fwrite(bytes.data(), 1, bytes.size(), file_) != bytes.size()) fail();
    written_ += bytes.size();
  }
  void record(Opcode opcode, const std::string& body) {
    std::string head(1, static_cast<char>(opcode));
    put(head, static_cast<std::uint64_t>(body.size()));
    append(head + body);
    if (opcode == kSchema || opcode == kChannel) summary_ += head + body;
  }

  Channel& channel_of(const Topic& topic) {
    const auto known = topics_.find(topic.name);
    if (known != topics_.end()) return known->second;
    // Number 0 means "no schema".
    const auto [schema, is_new] =
        schemas_.try_emplace(topic.kind, static_cast<std::uint16_t>(schemas_.size() + 1));
    std::string body;
    if (is_new) {
      // Schema id, name, encoding and text of the definition, as rosbag2's plugin for MCAP writes
      // them.
      put(body, schema->second);
      put_text(body, type_name(topic.kind));
      put_text(body, "ros2msg");
      put_text(body, definition(topic.kind));
      record(kSchema, body);
    }
    Channel& channel = topics_[topic.name];
    // Ids of channels count from 0, which is a valid id, unlike 0 of a schema.
    channel.id = static_cast<std::uint16_t>(topics_.size() - 1);
    body.clear();
    put(body, channel.id);
    put(body, schema->second);
    put_text(body, topic.name);
    put_text(body, "cdr");
    // Metadata: a map of texts with its length in bytes, empty for players' defaults.
    std::string metadata;
    if (const std::string qos = topic.offered_qos(); !qos.empty()) {
      put_text(metadata, "offered_qos_profiles");
      put_text(metadata, qos);
    }
    put_text(body, metadata);
    record(kChannel, body);
    return channel;
  }

  std::string path_, summary_;
  std::FILE* file_;
  std::uint64_t written_ = 0, messages_ = 0;
  std::int64_t first_ = 0, last_ = 0;
  std::map<MessageKind, std::uint16_t> schemas_;
  std::map<std::string, Channel> topics_;
};

}  // namespace

std::unique_ptr<Bag> make_mcap(const std::string& path) { return std::make_unique<Mcap>(path); }

}  // namespace navvy::formats::ros
