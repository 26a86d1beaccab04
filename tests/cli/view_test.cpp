// SPDX-License-Identifier: Apache-2.0
// `navvy run --view` and `navvy view` as processes, driven over HTTP as the page does.
#include <gtest/gtest.h>
#include <unistd.h>

#include <csignal>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "cli/program_run.h"
#include "link/http_client.h"

namespace navvy {
namespace {

namespace fs = std::filesystem;
using link::testing::Address;
using link::testing::Events;
using link::testing::get;
using link::testing::post;
using nlohmann::json;

class View : public test::ProgramRun {
 protected:
  std::vector<std::string> bucket(const std::string& duration) const {
    return {"run",        "bucket_path", "--no-render", "--no-report", "--quiet",
            "--duration", duration,      "--out",       out()};
  }
  /// Waits until the program has printed the address of the page.
  Address address() const {
    for (int i = 0; i < 6000; ++i) {
      const std::string text = said();
      const std::size_t at = text.find("view: "), end = text.find('\n', at);
      if (end != std::string::npos && at != std::string::npos)
        return Address(text.substr(at + 6, end - at - 6));
      ::usleep(10'000);
    }
    ADD_FAILURE() << complained();
    return Address("http://127.0.0.1:0/");
  }
  /// Returns the next frame for which `wanted` is true; null if there is none.
  template <class Wanted>
  static json until(Events& events, const Wanted& wanted) {
    for (json row = events.next(); row.is_object(); row = events.next())
      if (wanted(row)) return row;
    return nullptr;
  }
};

TEST_F(View, DoesNotChangeTheRun) {
  ASSERT_EQ(run(bucket("0.5")), 0) << complained();
  const std::string alone = summary().at("state_hash");
  std::vector<std::string> arguments = bucket("0.5");
  arguments.insert(arguments.end(), {"--view", "0"});
  const pid_t process = start(arguments);
  const Address at = address();
  // Paused at once, so that the run does not end before a page has seen it.
  EXPECT_EQ(post(at, R"({"pause":true})").status, 200);
  Events events(at);
  const json paused =
      until(events, [](const json& row) { return row.at("live").at("paused") == true; });
  ASSERT_TRUE(paused.is_object());
  const long step = paused.at("live").at("step");
  EXPECT_EQ(post(at, R"({"step":3})").status, 200);
  const json after =
      until(events, [&](const json& row) { return row.at("live").at("step") == step + 3; });
  EXPECT_TRUE(after.is_object());
  EXPECT_EQ(post(at, R"({"pause":false})").status, 200);
  // How many frames follow depends on how fast the run ends.
  json last = events.next();
  while (last.is_object()) last = events.next();
  EXPECT_TRUE(events.is_end());
  EXPECT_NE(last.get<std::string>().find(out()), std::string::npos) << last;
  EXPECT_EQ(test::wait_for(process), 0) << complained();
  EXPECT_EQ(summary().at("state_hash"), alone);
}

TEST_F(View, PausesStepsAndDrivesOnRequest) {
  std::vector<std::string> arguments = bucket("1000");
  arguments.insert(arguments.end(), {"--view", "0"});
  const pid_t process = start(arguments);
  const Address at = address();
  EXPECT_EQ(get(at, "").status, 200);
  Events events(at);
  EXPECT_EQ(post(at, R"({"pause":true})").status, 200);
  const json paused =
      until(events, [](const json& row) { return row.at("live").at("paused") == true; });
  ASSERT_TRUE(paused.is_object());
  const long step = paused.at("live").at("step");
  EXPECT_EQ(post(at, R"({"step":7})").status, 200);
  const json after =
      until(events, [&](const json& row) { return row.at("live").at("step") == step + 7; });
  ASSERT_TRUE(after.is_object());
  EXPECT_GT(after.at("time_s"), paused.at("time_s"));
  // An input ends the program of its machine, and moves the joint.
  EXPECT_NE(after.at("phases")[0], "inputs");
  EXPECT_EQ(post(at, R"({"inputs":{"bucket/slide_x/velocity":0.2}})").status, 200);
  EXPECT_EQ(post(at, R"({"inputs":{"bucket/slide_q/velocity":0.2}})").status, 400);
  EXPECT_EQ(post(at, R"({"step":200})").status, 200);
  const json moved =
      until(events, [&](const json& row) { return row.at("live").at("step") == step + 207; });
  ASSERT_TRUE(moved.is_object());
  EXPECT_EQ(moved.at("phases")[0], "inputs");
  EXPECT_NE(moved.at("poses"), after.at("poses"));
  // A paused run still obeys signals.
  ::kill(process, SIGTERM);
  EXPECT_EQ(test::wait_for(process), 130) << complained();
  EXPECT_EQ(summary().at("status"), "interrupted");
}

TEST_F(View, RefusesAPortInUse) {
  std::vector<std::string> arguments = bucket("1000");
  arguments.insert(arguments.end(), {"--view", "0"});
  const pid_t process = start(arguments);
  const std::string port = std::to_string(address().port);
  arguments.back() = port;
  arguments[8] = out() + "2";
  EXPECT_EQ(run(arguments), 2);
  EXPECT_NE(complained().find("--view"), std::string::npos) << complained();
  EXPECT_NE(complained().find("Address already in use"), std::string::npos) << complained();
  EXPECT_FALSE(fs::exists(out() + "2"));
  EXPECT_EQ(run({"view", out(), "--port", port}), 2);
  EXPECT_NE(complained().find("--port"), std::string::npos) << complained();
  EXPECT_EQ(run({"view", out(), "--port", "70000"}), 2);
  ::kill(process, SIGTERM);
  test::wait_for(process);
}

TEST_F(View, OfAFolderShowsItsReport) {
  ASSERT_EQ(
      run({"run", "bucket_path", "--no-render", "--quiet", "--duration", "0.3", "--out", out()}), 0)
      << complained();
  const pid_t process = start({"view", out()});
  const Address at = address();
  const auto page = get(at, "");
  EXPECT_EQ(page.status, 200);
  EXPECT_NE(page.body.find("\"complete\":true"), std::string::npos);
  ::kill(process, SIGINT);
  EXPECT_EQ(test::wait_for(process), 0) << complained();
  EXPECT_EQ(run({"view", directory_.string()}), 2);
  EXPECT_NE(complained().find("is no folder of a run"), std::string::npos) << complained();
}

}  // namespace
}  // namespace navvy
