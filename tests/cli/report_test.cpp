// SPDX-License-Identifier: Apache-2.0
// `navvy report`, and the page at the end of a run.
#include <gtest/gtest.h>
#include <unistd.h>

#include <csignal>
#include <filesystem>
#include <fstream>
#include <string>

#include "cli/program_run.h"

namespace navvy {
namespace {

namespace fs = std::filesystem;

class Report : public test::ProgramRun {
 protected:
  int run_bucket(const std::string& to, const std::string& more = "--quiet") {
    return run({"run", "bucket_path", "--no-render", "--duration", "0.3", "--out", to, more});
  }
};

TEST_F(Report, IsMadeAtTheEndOfARunAndAgain) {
  ASSERT_EQ(run_bucket(out()), 0) << complained();
  const std::string page = out() + "/report.html";
  EXPECT_NE(said().find("report: " + page + "\n"), std::string::npos) << said();
  const auto size = fs::file_size(page);
  EXPECT_GT(size, 100'000u);
  EXPECT_LT(size, 5'000'000u);
  fs::remove(page);
  ASSERT_EQ(run({"report", out() + "/"}), 0) << complained();
  EXPECT_EQ(fs::file_size(page), size);
  // The next run takes the place of this one, with its page.
  ASSERT_EQ(run_bucket(out()), 0) << complained();
  EXPECT_TRUE(fs::exists(out() + ".previous/report.html"));
  EXPECT_TRUE(fs::exists(out() + ".previous/replay.jsonl"));
}

TEST_F(Report, ComparesTwoRuns) {
  ASSERT_EQ(run_bucket(out()), 0);
  ASSERT_EQ(run_bucket(out() + "2"), 0);
  ASSERT_EQ(run({"report", out(), out() + "2"}), 0) << complained();
  EXPECT_TRUE(fs::exists(out() + "/report_and_out2.html")) << said();
  EXPECT_EQ(run({"report", out(), out() + "2", "--out", out() + "3.html"}), 0);
  EXPECT_TRUE(fs::exists(out() + "3.html"));
}

TEST_F(Report, IsLeftOutOnRequest) {
  ASSERT_EQ(run_bucket(out(), "--no-report"), 0) << complained();
  EXPECT_EQ(said().find("report: "), std::string::npos) << said();
  EXPECT_FALSE(fs::exists(out() + "/report.html"));
  EXPECT_FALSE(fs::exists(out() + "/replay.jsonl"));
  // It can be made later, and says what it lacks.
  ASSERT_EQ(run({"report", out()}), 0) << complained();
  EXPECT_NE(test::text_of(out() + "/report.html").find("replay.jsonl is missing"),
            std::string::npos);
}

TEST_F(Report, OfARunThatWasKilledCanBeMade) {
  const pid_t process = start({"run", "bucket_path", "--no-render", "--out", out()});
  const std::string replay = out() + "/replay.jsonl";
  for (int i = 0; i < 6000 && !fs::exists(replay); ++i) ::usleep(10'000);
  ::kill(process, SIGKILL);
  test::wait_for(process);
  ASSERT_TRUE(fs::exists(replay));
  ASSERT_EQ(run({"report", out()}), 0) << complained();
  EXPECT_NE(test::text_of(out() + "/report.html").find("The run was killed"), std::string::npos);
}

TEST_F(Report, RefusesWhatIsNoRun) {
  EXPECT_EQ(run({"report", directory_.string()}), 2);
  EXPECT_NE(complained().find("is no folder of a run"), std::string::npos) << complained();
  EXPECT_EQ(run({"report", out(), out(), out()}), 2);
  EXPECT_EQ(run({"report"}), 2);
  fs::create_directories(out());
  std::ofstream(out() + "/run.json") << "{}";
  EXPECT_EQ(run({"report", out(), "--out", "/nowhere/page.html"}), 4) << complained();
  EXPECT_NE(complained().find("/nowhere/page.html"), std::string::npos) << complained();
}

}  // namespace
}  // namespace navvy
