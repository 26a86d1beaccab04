// SPDX-License-Identifier: Apache-2.0
#include "core/state_io.h"

#include <gtest/gtest.h>

#include "core/error.h"

namespace navvy {
namespace {

std::vector<char> sample() {
  StateWriter writer;
  writer.begin("soil", 2);
  writer.value(42);
  writer.vector(std::vector<double>{1, 2, 3});
  writer.text("loam");
  writer.end();
  return writer.bytes();
}

TEST(StateReader, ReadsBackWhatWasWritten) {
  StateReader reader(sample());
  reader.begin("soil", 2);
  EXPECT_EQ(reader.value<int>(), 42);
  EXPECT_EQ(reader.vector<double>(), (std::vector<double>{1, 2, 3}));
  EXPECT_EQ(reader.text(), "loam");
  EXPECT_NO_THROW(reader.end());
}

TEST(StateReader, RefusesAnotherSectionANewerVersionAndLeftOverBytes) {
  EXPECT_THROW(StateReader(sample()).begin("ground", 2), InputError);
  EXPECT_THROW(StateReader(sample()).begin("soil", 1), InputError);
  EXPECT_THROW(StateReader(sample()).begin("soil", 3), InputError);
  StateReader reader(sample());
  reader.begin("soil", 2);
  EXPECT_THROW(reader.end(), InputError);
}

TEST(StateReader, NeverReadsPastAnyTruncation) {
  const std::vector<char> whole = sample();
  for (std::size_t n = 0; n < whole.size(); ++n) {
    StateReader reader(std::vector<char>(whole.begin(), whole.begin() + static_cast<std::ptrdiff_t>(n)));
    EXPECT_THROW(
        {
          reader.begin("soil", 2);
          reader.value<int>();
          reader.vector<double>();
          reader.text();
          reader.end();
        },
        InputError)
        << "cut at " << n;
  }
}

}  // namespace
}  // namespace navvy
