// SPDX-License-Identifier: Apache-2.0
#include "core/renamed_names.h"

#include <gtest/gtest.h>

#include <set>
#include <string>

#include "core/log.h"

namespace navvy {
namespace {

const std::vector<RenamedName> kTable = {
    {NameKind::kElement, "navvy:test_old", "navvy:test_new", "9.9"},
    {NameKind::kChannel, "test_pump/test_flow", "test_pump/test_rate", "9.9"},
};

TEST(RenamedNames, OldNamesGiveCurrentOnesWithOneWarningEach) {
  std::string logged;
  set_log_sink([&](LogLevel, const std::string& line) { logged += line + "\n"; });
  EXPECT_EQ(current_name(NameKind::kElement, "navvy:test_old", kTable), "navvy:test_new");
  EXPECT_EQ(current_name(NameKind::kElement, "navvy:test_old", kTable), "navvy:test_new");
  EXPECT_EQ(current_name(NameKind::kElement, "navvy:test_older", kTable), "navvy:test_older");
  EXPECT_EQ(current_name(NameKind::kLayer, "navvy:test_old", kTable), "navvy:test_old");
  for (int line : {7, 9}) current_name(NameKind::kElement, "navvy:test_old", kTable, "a.sdf", line);
  set_log_sink({});
  EXPECT_EQ(logged,
            "the element 'navvy:test_old' is called 'navvy:test_new' now; the old name is read "
            "until release 9.9\n"
            "a.sdf:7: the element 'navvy:test_old' is called 'navvy:test_new' now; the old name is "
            "read until release 9.9\n");
}

TEST(RenamedNames, ChannelsMatchByWholePartsFromTheirEnd) {
  const auto now = [](const std::string& name) {
    return current_name(NameKind::kChannel, name, kTable);
  };
  EXPECT_EQ(now("digger/test_pump/test_flow"), "digger/test_pump/test_rate");
  EXPECT_EQ(now("test_pump/test_flow"), "test_pump/test_rate");
  EXPECT_EQ(now("digger/a_test_pump/test_flow"), "digger/a_test_pump/test_flow");
}

TEST(RenamedNames, NoOldNameIsCurrent) {
  std::set<std::pair<NameKind, std::string>> current;
  for (const RenamedName& row : renamed_names()) current.emplace(row.kind, row.name);
  for (const RenamedName& row : renamed_names())
    EXPECT_EQ(current.count({row.kind, row.old_name}), 0u) << row.old_name;
}

}  // namespace
}  // namespace navvy
