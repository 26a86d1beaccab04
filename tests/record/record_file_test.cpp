// SPDX-License-Identifier: Apache-2.0
#include "record/record_file.h"

#include <gtest/gtest.h>

#include "core/error.h"
#include "folder.h"
#include "text_of.h"

namespace navvy::record {
namespace {

using test::text_of;

/// Returns the length of the header of a .npy file by the file's own statement; 0 for another file.
std::size_t header_length(const std::string& text) {
  if (text.size() < 12 || text.compare(0, 6, "\x93NUMPY") != 0) return 0;
  const bool wide = text[6] > 1;
  std::size_t length = 0;
  for (std::size_t i = 0; i < (wide ? 4u : 2u); ++i)
    length += static_cast<std::size_t>(static_cast<unsigned char>(text[8 + i])) << (8 * i);
  return length + (wide ? 12 : 10);
}

TEST(RecordFile, QuotesNamesAndCountsItsHeader) {
  const test::Folder folder;
  const std::string path = folder / "a.npy";
  RecordFile file(path, {{"it's", "<f4", {}}, {"back\\slash", "<f8", {3}}}, 28);
  file.add(std::string(28, 'x'));
  file.sync();
  const std::string text = text_of(path);
  EXPECT_EQ(text[6], 1);
  EXPECT_EQ(header_length(text) % 64, 0u);
  EXPECT_EQ(text.size(), header_length(text) + 28);
  EXPECT_NE(text.find(R"([('it\'s', '<f4'), ('back\\slash', '<f8', (3,))])"), std::string::npos);
}

TEST(RecordFile, ChoosesTheFormatThatItsHeaderNeeds) {
  const test::Folder folder;
  const auto version = [&](const std::vector<RecordField>& fields) {
    const std::string path = folder / "a.npy";
    RecordFile file(path, fields, 4 * fields.size());
    file.sync();
    const std::string text = text_of(path);
    EXPECT_EQ(header_length(text), text.size());
    EXPECT_EQ(text.size() % 64, 0u);
    return static_cast<int>(text[6]);
  };
  EXPECT_EQ(version({{"name", "<f4", {}}}), 1);
  // Names that are not ASCII need UTF-8, a header above 64 KiB a longer count.
  EXPECT_EQ(version({{"L\u00f6ffel", "<f4", {}}}), 3);
  std::vector<RecordField> many;
  many.reserve(5000);
  for (int i = 0; i < 5000; ++i) many.push_back({"machine/joint_" + std::to_string(i), "<f4", {}});
  EXPECT_EQ(version(many), 2);
}

TEST(RecordFile, RefusesRecordsOfAnotherSize) {
  const test::Folder folder;
  RecordFile file(folder / "a.npy", {{"x", "<f4", {}}}, 4);
  EXPECT_THROW(file.add("12345"), Error);
  EXPECT_EQ(file.records(), 0u);
}

}  // namespace
}  // namespace navvy::record
