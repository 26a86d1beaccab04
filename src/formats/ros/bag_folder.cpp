// SPDX-License-Identifier: Apache-2.0
// The tables of rosbag2 as ROS 2 Humble makes them; the metadata come last, when counts and times
// are known.
#include <sqlite3.h>

#include <algorithm>
#include <filesystem>
#include <map>

#include "core/error.h"
#include "core/file.h"
#include "formats/ros/bag.h"

namespace navvy::formats::ros {
namespace {

namespace fs = std::filesystem;

constexpr const char* kTables =
    "CREATE TABLE schema(schema_version INTEGER PRIMARY KEY, ros_distro TEXT NOT NULL);"
    "CREATE TABLE metadata(id INTEGER PRIMARY KEY, metadata_version INTEGER NOT NULL, metadata "
    "TEXT NOT NULL);"
    "CREATE TABLE topics(id INTEGER PRIMARY KEY, name TEXT NOT NULL, type TEXT NOT NULL,"
    " serialization_format TEXT NOT NULL, offered_qos_profiles TEXT NOT NULL);"
    "CREATE TABLE messages(id INTEGER PRIMARY KEY, topic_id INTEGER NOT NULL, timestamp INTEGER "
    "NOT NULL,"
    " data BLOB NOT NULL);"
    "CREATE INDEX timestamp_idx ON messages (timestamp ASC);"
    "INSERT INTO schema(schema_version, ros_distro) VALUES (3, 'humble');"
    // rosbag2 sets the same: commits do not wait for the disk. A kill of the program loses nothing
    // by it.
    "PRAGMA synchronous = OFF;";

/// Returns a text in double quotes, as YAML needs it.
std::string quoted(const std::string& text) {
  std::string out = "\"";
  for (const char c : text) out += c == '\n' ? std::string("\\n") : std::string(1, c);
  return out + "\"";
}

class BagFolder final : public Bag {
 public:
  explicit BagFolder(const std::string& path) : folder_(path) {
    // A slash at the end is ignored: the name of "out/bag/" is "bag".
    const std::string name =
        (folder_.has_filename() ? folder_ : folder_.parent_path()).filename().string();
    storage_ = name + "_0.db3";
    std::error_code failed;
    fs::create_directories(folder_, failed);
    if (failed) throw FileError("cannot make '" + path + "': " + failed.message());
    // A folder with other files was not made here; nothing is written into it or removed from it.
    for (const auto& entry : fs::directory_iterator(folder_))
      if (entry.path().filename() != storage_ && entry.path().filename() != "metadata.yaml")
        throw InputError(Fault{Fault::Severity::kError, path, 0, "bag",
                               entry.path().filename().string(), "is in the folder already",
                               "name a new folder"});
    // Removed first, so that no reader takes a partial new folder for the old bag.
    fs::remove(folder_ / "metadata.yaml", failed);
    fs::remove(folder_ / storage_, failed);
    if (sqlite3_open((folder_ / storage_).c_str(), &data_) != SQLITE_OK) fail();
    run(kTables);
  }
  BagFolder(const BagFolder&) = delete;
  BagFolder& operator=(const BagFolder&) = delete;
  ~BagFolder() override {
    sqlite3_finalize(insert_);
    sqlite3_close(data_);
  }

  bool has(const std::string& topic) const override { return topics_.count(topic) > 0; }

  void close() override {
    if (data_ == nullptr) return;
    commit();
    sqlite3_finalize(insert_);
    insert_ = nullptr;
    const int closed = sqlite3_close(data_);
    data_ = nullptr;
    if (closed != SQLITE_OK)
      throw FileError("cannot close '" + (folder_ / storage_).string() + "'");
    write_file_atomically((folder_ / "metadata.yaml").string(), metadata());
  }

 private:
  struct Entry {
    int id = 0;
    MessageKind kind = MessageKind::kClock;
    std::string offered_qos;
    std::uint64_t messages = 0;
  };

  void add(const Topic& topic, std::int64_t time_ns, const Bytes& message) override {
    // One transaction per time, because poses come fifty times per second: a transaction per
    // message would cost more than the step.
    if (messages_ > 0 && time_ns != now_) commit();
    if (sqlite3_get_autocommit(data_) != 0) run("BEGIN");
    now_ = time_ns;
    Entry& to = topics_[topic.name];
    // A new topic has id 0; ids in the table count from 1.
    if (to.id == 0) {
      to.id = static_cast<int>(topics_.size());
      to.kind = topic.kind;
      to.offered_qos = topic.offered_qos();
      sqlite3_stmt* row = prepare("INSERT INTO topics VALUES (?, ?, ?, 'cdr', ?)");
      sqlite3_bind_int(row, 1, to.id);
      sqlite3_bind_text(row, 2, topic.name.c_str(), -1, SQLITE_TRANSIENT);
      sqlite3_bind_text(row, 3, type_name(topic.kind).c_str(), -1, SQLITE_TRANSIENT);
      sqlite3_bind_text(row, 4, to.offered_qos.c_str(), -1, SQLITE_TRANSIENT);
      const bool done = sqlite3_step(row) == SQLITE_DONE;
      sqlite3_finalize(row);
      if (!done) fail();
    }
    if (insert_ == nullptr)
      insert_ = prepare("INSERT INTO messages(topic_id, timestamp, data) VALUES (?, ?, ?)");
    sqlite3_bind_int(insert_, 1, to.id);
    sqlite3_bind_int64(insert_, 2, time_ns);
    // SQLITE_STATIC avoids a copy: the message outlives the step below.
    sqlite3_bind_blob64(insert_, 3, message.data(), message.size(), SQLITE_STATIC);
    const bool done = sqlite3_step(insert_) == SQLITE_DONE;
    sqlite3_reset(insert_);
    if (!done) fail();
    ++to.messages;
    first_ = messages_ == 0 ? time_ns : std::min(first_, time_ns);
    last_ = messages_++ == 0 ? time_ns : std::max(last_, time_ns);
  }

  [[noreturn]] void fail() const {
    // Copied first, as the rollback replaces the message.
    const std::string cause = sqlite3_errmsg(data_);
    // Earlier messages stay readable.
    if (sqlite3_get_autocommit(data_) == 0)
      sqlite3_exec(data_, "ROLLBACK", nullptr, nullptr, nullptr);
    throw FileError("cannot write '" + (folder_ / storage_).string() + "': " + cause);
  }
  void run(const char* statements) {
    if (sqlite3_exec(data_, statements, nullptr, nullptr, nullptr) != SQLITE_OK) fail();
  }
  /// Ends the transaction, unless a fault has ended it.
  void commit() {
    if (sqlite3_get_autocommit(data_) == 0) run("COMMIT");
  }
  sqlite3_stmt* prepare(const char* statement) {
    sqlite3_stmt* out = nullptr;
    if (sqlite3_prepare_v2(data_, statement, -1, &out, nullptr) != SQLITE_OK) fail();
    return out;
  }

  std::string metadata() const {
    // Version 5 of the metadata is Humble's, like the tables.
    const std::string start = std::to_string(first_), duration = std::to_string(last_ - first_);
    std::string out =
        "rosbag2_bagfile_information:\n  version: 5\n  storage_identifier: sqlite3\n  duration:\n  "
        "  nanoseconds: " +
        duration + "\n  starting_time:\n    nanoseconds_since_epoch: " + start +
        "\n  message_count: " + std::to_string(messages_) + "\n  topics_with_message_count:\n";
    for (const auto& [name, topic] : topics_)
      out += "    - topic_metadata:\n        name: " + name +
             "\n        type: " + type_name(topic.kind) +
             "\n        serialization_format: cdr\n        offered_qos_profiles: " +
             quoted(topic.offered_qos) +
             "\n      message_count: " + std::to_string(topic.messages) + "\n";
    out += "  compression_format: \"\"\n  compression_mode: \"\"\n  relative_file_paths:\n    - " +
           storage_ + "\n  files:\n    - path: " + storage_ +
           "\n      starting_time:\n        nanoseconds_since_epoch: " + start +
           "\n      duration:\n        nanoseconds: " + duration +
           "\n      message_count: " + std::to_string(messages_) + "\n";
    return out;
  }

  fs::path folder_;
  std::string storage_;
  sqlite3* data_ = nullptr;
  sqlite3_stmt* insert_ = nullptr;
  std::map<std::string, Entry> topics_;
  std::uint64_t messages_ = 0;
  std::int64_t first_ = 0, last_ = 0, now_ = 0;
};

}  // namespace

std::unique_ptr<Bag> make_bag_folder(const std::string& folder) {
  return std::make_unique<BagFolder>(folder);
}

}  // namespace navvy::formats::ros
