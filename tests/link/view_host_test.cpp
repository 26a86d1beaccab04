// SPDX-License-Identifier: Apache-2.0
// Live pages: who may see and command them, what slow and killed subscribers get, and runs whose
// folders are damaged.
#include <fcntl.h>
#include <gtest/gtest.h>
#include <sys/file.h>

#include <atomic>
#include <chrono>
#include <cstdint>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <memory>
#include <nlohmann/json.hpp>
#include <optional>
#include <span>
#include <string>
#include <thread>
#include <utility>
#include <vector>

#include "core/base64.h"
#include "core/error.h"
#include "folder.h"
#include "link/http_client.h"
#include "link/run_view.h"
#include "link/view_commands.h"
#include "link/view_feed.h"
#include "link/view_server.h"

namespace navvy::link {
namespace {

using nlohmann::json;
using testing::Address;
using testing::ask;
using testing::Events;
using testing::get;
using testing::post;
using testing::Reply;

/// Returns the tile at (x, y) whose heights are all `number`.
std::vector<std::int16_t> tile(int x, int y, int number) {
  std::vector<std::int16_t> out = {static_cast<std::int16_t>(x), static_cast<std::int16_t>(y)};
  out.resize(2 + 256, static_cast<std::int16_t>(number));
  return out;
}

std::vector<std::int16_t> tiles_of(const json& row) {
  const std::string bytes = base64_bytes(row.at("tiles").get<std::string>()).value_or("");
  std::vector<std::int16_t> out(bytes.size() / 2);
  if (!out.empty()) std::memcpy(out.data(), bytes.data(), 2 * out.size());
  return out;
}

TEST(ViewFeed, GivesASlowSubscriberAllThatChangedSinceItsLastFrame) {
  ViewFeed feed;
  EXPECT_FALSE(feed.wait(0, 0.01));
  feed.add({{"time_s", 1}}, tile(0, 0, 10));
  const auto first = feed.wait(0, 1);
  ASSERT_TRUE(first);
  EXPECT_EQ(first->number, 1u);
  EXPECT_EQ(tiles_of(json::parse(first->text)), tile(0, 0, 10));
  EXPECT_FALSE(feed.wait(1, 0.01));
  feed.add({{"time_s", 2}}, tile(0, 1, 20));
  feed.add({{"time_s", 3}}, tile(0, 1, 30));
  feed.add({{"time_s", 4}}, {});
  const json slow = json::parse(feed.wait(1, 1)->text);
  EXPECT_EQ(slow.at("time_s"), 4);
  EXPECT_EQ(slow.at("missed"), 2);
  EXPECT_EQ(tiles_of(slow), tile(0, 1, 30));
  const json fast = json::parse(feed.wait(3, 1)->text);
  EXPECT_EQ(fast.at("missed"), 0);
  EXPECT_TRUE(tiles_of(fast).empty());
  EXPECT_EQ(tiles_of(json::parse(feed.wait(0, 1)->text)).size(), 2 * 258u) << "a new one gets all";
  feed.close("over");
  feed.add({{"time_s", 5}}, {});
  EXPECT_FALSE(feed.wait(4, 1));
  EXPECT_EQ(feed.end(), "over");
}

/// A server with a feed and a list of the commands that it got.
struct Served {
  std::shared_ptr<ViewFeed> feed = std::make_shared<ViewFeed>();
  ViewServer server{"--view",
                    0,
                    {[] { return std::string("<p>page</p>"); }, [this] { return feed; },
                     [](const std::string& text) {
                       if (text != "{}")
                         throw InputError(Fault{Fault::Severity::kError, "", 0, "command", text,
                                                "is none", "send {}"});
                     },
                     [](const std::string& path) -> std::optional<ViewFile> {
                       if (path != "frames/a.mp4") return std::nullopt;
                       return ViewFile{"video/mp4", "video"};
                     }}};
  Address at{server.address()};
};

TEST(ViewServer, ServesThePageWithHeadersThatKeepTheAddressSecret) {
  const Served one;
  EXPECT_EQ(one.at.path.size(), 34u) << "128 random bits";
  const Reply page = get(one.at, "");
  EXPECT_EQ(page.status, 200);
  EXPECT_EQ(page.body, "<p>page</p>");
  for (const char* header : {"Referrer-Policy: no-referrer", "Cache-Control: no-store",
                             "frame-ancestors 'none'", "X-Content-Type-Options: nosniff"})
    EXPECT_NE(page.head.find(header), std::string::npos) << page.head;
  EXPECT_EQ(get(one.at, "frames/a.mp4").body, "video");
  EXPECT_EQ(post(one.at, "{}").status, 200);
  const Reply wrong = post(one.at, "{\"a\":1}");
  EXPECT_EQ(wrong.status, 400);
  EXPECT_NE(json::parse(wrong.body).at("error").get<std::string>().find("send {}"),
            std::string::npos);
  const Served other;
  EXPECT_NE(one.at.path, other.at.path);
}

TEST(ViewServer, RefusesWrongTokensForeignSitesAndUnknownPaths) {
  const Served one;
  const std::string host = "Host: " + one.at.host() + "\r\n";
  std::string guess = one.at.path;
  guess[5] = guess[5] == '0' ? '1' : '0';
  const auto status = [&](const std::string& first, const std::string& headers,
                          const std::string& body = "") {
    return ask(one.at.port, first, headers, body).status;
  };
  const std::string type = "Content-Type: application/json\r\n", path = one.at.path;
  for (const std::string& wrong : {guess, std::string("/"), std::string("/favicon.ico"),
                                   path.substr(0, path.size() - 1), "/" + path, path + "x/"}) {
    if (wrong == path + "x/") continue;
    EXPECT_EQ(status("GET " + wrong, host), 403) << wrong;
    EXPECT_EQ(status("POST " + wrong + "control", host + type, "{}"), 403) << wrong;
  }
  // A name of another site that resolves to this machine, no name, and a page of another site.
  EXPECT_EQ(status("GET " + path, "Host: evil.example:80\r\n"), 403);
  EXPECT_EQ(status("GET " + path, ""), 403);
  EXPECT_EQ(status("GET " + path, "Host: localhost:1\r\n"), 200);
  EXPECT_EQ(
      status("POST " + path + "control", host + type + "Origin: http://evil.example\r\n", "{}"),
      403);
  EXPECT_EQ(status("POST " + path + "control", host + type + "Origin: null\r\n", "{}"), 403);
  EXPECT_EQ(status("POST " + path + "control",
                   host + type + "Origin: http://" + one.at.host() + "\r\n", "{}"),
            200);
  // Browsers send this type across sites without asking.
  EXPECT_EQ(status("POST " + path + "control", host + "Content-Type: text/plain\r\n", "{}"), 415);
  EXPECT_EQ(status("GET " + path + "nothing", host), 404);
  EXPECT_EQ(status("GET " + path + "../etc/passwd", host), 404);
  EXPECT_EQ(status("POST " + path + "nothing", host + type, "{}"), 404);
  EXPECT_EQ(status("GET " + path + "control", host), 405);
  EXPECT_EQ(status("POST " + path, host + type, "{}"), 405);
  EXPECT_EQ(
      status("POST " + path + "control", host + type, std::string(HttpServer::kMostBytes + 1, ' ')),
      413);
}

TEST(ViewServer, SaysThatAPortIsInUse) {
  const Served one;
  const auto message = [&](const auto& act) -> std::string {
    try {
      act();
    } catch (const InputError& error) {
      return error.what();
    }
    return "";
  };
  for (const std::string& text : {message([&] { ViewServer::require_port("--view", one.at.port); }),
                                  message([&] { ViewServer("--view", one.at.port, {}); })}) {
    EXPECT_NE(text.find("--view"), std::string::npos) << text;
    EXPECT_NE(text.find("Address already in use"), std::string::npos) << text;
    EXPECT_NE(text.find("choose another port, or 0"), std::string::npos) << text;
  }
  EXPECT_EQ(message([] { ViewServer::require_port("--view", 0); }), "");
}

TEST(ViewServer, ServesTenSubscribersAndForgetsKilledOnes) {
  Served one;
  std::vector<std::unique_ptr<Events>> readers;
  readers.reserve(10);
  for (int i = 0; i < 10; ++i) readers.push_back(std::make_unique<Events>(one.at));
  one.feed->add({{"time_s", 1}}, tile(0, 0, 10));
  for (auto& reader : readers) EXPECT_EQ(reader->next().at("time_s"), 1);
  EXPECT_EQ(one.feed->subscribers(), 10);
  // Killed in the middle: the others go on, and the place is free within seconds.
  for (int i = 0; i < 5; ++i) readers[static_cast<std::size_t>(i)]->leave();
  for (int frame = 2; frame < 50; ++frame) {
    one.feed->add({{"time_s", frame}}, tile(0, 0, frame));
    std::this_thread::sleep_for(std::chrono::milliseconds(2));
  }
  for (std::size_t i = 5; i < 10; ++i) {
    json row = readers[i]->next();
    while (row.at("time_s") != 49) row = readers[i]->next();
    EXPECT_EQ(tiles_of(row), tile(0, 0, 49));
  }
  for (int i = 0; i < 100 && one.feed->subscribers() > 5; ++i)
    std::this_thread::sleep_for(std::chrono::milliseconds(100));
  EXPECT_EQ(one.feed->subscribers(), 5);
  one.feed->close("over");
  EXPECT_EQ(readers[9]->next(), "over");
  EXPECT_TRUE(readers[9]->is_end());
}

TEST(ViewServer, NeverMakesTheWriterWaitForASubscriberThatDoesNotRead) {
  Served one;
  Events reader(one.at);
  one.feed->add({{"time_s", 0}}, {});
  EXPECT_EQ(reader.next().at("time_s"), 0);
  // More than the system takes for a reader that does not read.
  const std::string large(1 << 20, 'x');
  const auto begin = std::chrono::steady_clock::now();
  for (int i = 1; i <= 40; ++i) {
    one.feed->add({{"time_s", i}, {"large", large}}, tile(i, 0, i));
    std::this_thread::sleep_for(std::chrono::milliseconds(1));
  }
  EXPECT_LT(std::chrono::steady_clock::now() - begin, std::chrono::seconds(20));
  // It gets the last frame, with the tiles of those that it missed.
  std::size_t tiles = 0;
  std::uint64_t missed = 0;
  for (json row = reader.next(); row.is_object(); row = reader.next()) {
    tiles += tiles_of(row).size() / 258;
    missed += row.at("missed").get<std::uint64_t>();
    if (row.at("time_s") == 40) break;
  }
  EXPECT_EQ(tiles, 40u);
  EXPECT_GT(missed, 0u);
}

TEST(ViewServer, RefusesMoreStreamsThanItHasThreadsFor) {
  Served one;
  std::vector<std::unique_ptr<Events>> readers;
  one.feed->add({{"time_s", 1}}, {});
  for (int i = 0; i < ViewServer::kMostStreams; ++i) {
    readers.push_back(std::make_unique<Events>(one.at));
    EXPECT_EQ(readers.back()->next().at("time_s"), 1);
  }
  EXPECT_EQ(get(one.at, "events").status, 503);
  EXPECT_EQ(get(one.at, "").status, 200);
}

/// Inputs of a machine with one joint and one switch.
sim::Inputs some_inputs() {
  sim::Inputs out;
  out.add({"m/boom/position", "rad", "", 0, -1, 1, true}, [](double) {});
  out.add({"m/gear", "1", "", 0, 1, 4, false}, [](double) {});
  return out;
}

TEST(ViewCommands, MergesUntilTheRunTakesThem) {
  ViewCommands commands(some_inputs(), "");
  commands.add(R"({"step": 3})");
  commands.add(R"({"pause": true, "pace": 0.5})");
  commands.add(R"({"step": 2, "inputs": {"m/boom/position": 0.1, "m/gear": 2}})");
  commands.add(R"({"inputs": {"m/boom/position": 5}})");
  const ViewCommands::Pending all = commands.take();
  EXPECT_EQ(all.pause, true);
  EXPECT_EQ(all.steps, 2) << "a pause ends the steps before it";
  EXPECT_EQ(all.pace, 0.5);
  EXPECT_EQ(all.inputs, (std::vector<std::pair<int, double>>{{1, 2}, {0, 5}}))
      << "the value set last comes last, and a clamped input takes any value";
  EXPECT_FALSE(commands.take().pause);
}

TEST(ViewCommands, RefusesInvalidOnesAsAWhole) {
  ViewCommands commands(some_inputs(), "");
  for (const char* bad :
       {"", "[]", "{", R"({"pause": 1})", R"({"step": 0})", R"({"step": 1.5})", R"({"step": 1e9})",
        R"({"pace": -1})", R"({"pace": 1e9})", R"({"pace": "fast"})", R"({"stop": true})",
        R"({"inputs": 3})", R"({"inputs": {"m/boom/positio": 1}})",
        R"({"inputs": {"m/boom/position": "x"}})", R"({"inputs": {"m/gear": 9}})",
        R"({"pause": true, "inputs": {"m/gear": 9}})"})
    EXPECT_THROW(commands.add(bad), InputError) << bad;
  EXPECT_FALSE(commands.take().pause);
  ViewCommands others(some_inputs(), "belong to the controller");
  EXPECT_NO_THROW(others.add(R"({"pause": true})"));
  EXPECT_THROW(others.add(R"({"inputs": {"m/boom/position": 0}})"), InputError);
}

template <class T>
std::string plain(const std::vector<T>& values) {
  return base64(std::as_bytes(std::span(values)));
}

/// The folder of a run that goes on, as its lock says.
class RunningFolder : public ::testing::Test {
 protected:
  RunningFolder() {
    write("run.json", R"({"format":1,"version":"0","device":"a device"})");
    write("summary.json", R"({"scenario":"</script><b>dig","status":"running"})");
    lock_ = ::open((folder_ / "navvy.run").c_str(), O_RDWR | O_CREAT, 0644);
    EXPECT_EQ(::flock(lock_, LOCK_EX | LOCK_NB), 0);
  }
  ~RunningFolder() override { release(); }
  void release() {
    if (lock_ >= 0) ::close(lock_);
    lock_ = -1;
  }
  void write(const std::string& name, const std::string& text, bool append = false) {
    std::ofstream(folder_ / name, append ? std::ios::app : std::ios::trunc) << text;
  }
  void begin_replay() {
    write("replay.jsonl", json{{"format", 1},
                               {"grid",
                                {{"nx", 20},
                                 {"ny", 18},
                                 {"cell_m", 0.1},
                                 {"origin_m", {0, 0}},
                                 {"unit_m", 0.001},
                                 {"base_m", 5},
                                 {"particle_unit_m", 0.01}}},
                               {"start", plain(std::vector<std::int16_t>(20 * 18, 100))},
                               {"soils", json::array()},
                               {"links", json::array()},
                               {"cylinders", json::array()},
                               {"forces", json::array()}}
                                  .dump() +
                              "\n");
  }
  static std::string frame(double time) {
    return json{{"time_s", time}, {"tiles", plain(tile(1, 1, static_cast<int>(10 * time)))},
                {"poses", ""},    {"cylinders", ""},
                {"forces", ""},   {"particles", ""}}
               .dump() +
           "\n";
  }
  /// Steps a view, as `navvy view` does, until an event comes.
  static json next(RunView& view, Events& events) {
    std::atomic<bool> over{false};
    std::thread steps([&] {
      while (!over) {
        view.step();
        std::this_thread::sleep_for(std::chrono::milliseconds(20));
      }
    });
    json out = events.next();
    over = true;
    steps.join();
    return out;
  }

  test::Folder folder_;
  int lock_ = -1;
};

TEST_F(RunningFolder, IsFollowedToItsEndAndThenReported) {
  RunView view(folder_.path().string(), 0);
  const Address at(view.address());
  EXPECT_NE(get(at, "").body.find("has not recorded a frame yet"), std::string::npos);
  begin_replay();
  write("replay.jsonl", frame(1), true);
  const std::string page = get(at, "").body;
  EXPECT_NE(page.find("connect-src 'self'"), std::string::npos);
  EXPECT_NE(page.find("\"live\":"), std::string::npos);
  // A name cannot end the script, and is text in the title.
  EXPECT_EQ(page.find("</script><b>dig"), std::string::npos);
  EXPECT_NE(page.find("&lt;/script&gt;&lt;b&gt;dig"), std::string::npos);
  Events events(at);
  EXPECT_EQ(events.next().at("time_s"), 1);
  // A row in two parts, and damaged ones between.
  const std::string row = frame(2);
  write("replay.jsonl", "{\"poses\":3}\nnothing\n" + row.substr(0, 30), true);
  view.step();
  write("replay.jsonl", row.substr(30), true);
  const json second = next(view, events);
  EXPECT_EQ(second.at("time_s"), 2);
  EXPECT_EQ(tiles_of(second), tile(1, 1, 20));
  EXPECT_EQ(post(at, "{\"pause\":true}").status, 404) << "a folder cannot be commanded";
  write("replay.jsonl", frame(3), true);
  write("summary.json", R"({"scenario":"dig","status":"finished"})");
  release();
  json last = next(view, events);
  if (!events.is_end()) last = next(view, events);
  EXPECT_EQ(last, "The run has ended: finished.");
  const std::string report = get(at, "").body;
  EXPECT_EQ(report.find("connect-src"), std::string::npos);
  EXPECT_NE(report.find("\"complete\":true"), std::string::npos);
}

TEST_F(RunningFolder, ThatWasKilledIsReported) {
  begin_replay();
  write("replay.jsonl", frame(1), true);
  release();
  RunView view(folder_.path().string(), 0);
  EXPECT_NE(get(Address(view.address()), "").body.find("The run was killed"), std::string::npos);
}

TEST_F(RunningFolder, WithADamagedReplayIsStillServed) {
  write("replay.jsonl", "{\"no\":\"header\"}\n");
  RunView view(folder_.path().string(), 0);
  const Address at(view.address());
  EXPECT_EQ(get(at, "").status, 200);
  Events events(at);
  write("summary.json", "damaged");
  EXPECT_NE(get(at, "").body.find("summary.json cannot be read"), std::string::npos);
  std::filesystem::remove_all(folder_.path());
  view.step();
  const Reply gone = get(at, "");
  EXPECT_EQ(gone.status, 500);
  EXPECT_NE(gone.body.find("is no folder of a run"), std::string::npos) << gone.body;
}

TEST_F(RunningFolder, EndsTheStreamWhenAnotherRunTakesItsPlace) {
  begin_replay();
  write("replay.jsonl", frame(1), true);
  RunView view(folder_.path().string(), 0);
  const Address at(view.address());
  EXPECT_EQ(get(at, "").status, 200);
  Events events(at);
  EXPECT_EQ(events.next().at("time_s"), 1);
  std::filesystem::rename(folder_ / "replay.jsonl", folder_ / "old.jsonl");
  begin_replay();
  write("replay.jsonl", frame(7), true);
  EXPECT_EQ(next(view, events), "Another run writes to this folder now.");
  EXPECT_EQ(get(at, "").status, 200);
  Events again(at);
  EXPECT_EQ(again.next().at("time_s"), 7);
}

TEST(RunView, RefusesWhatIsNoRun) {
  const test::Folder folder;
  EXPECT_THROW(RunView(folder.path().string(), 0), InputError);
}

}  // namespace
}  // namespace navvy::link
