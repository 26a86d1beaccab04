// SPDX-License-Identifier: Apache-2.0
#include "core/memo.h"

#include <gtest/gtest.h>

#include <stdexcept>
#include <thread>
#include <vector>

namespace navvy {
namespace {

TEST(Memo, ComputesEachResultOnce) {
  Memo<int, int> memo;
  int calls = 0;
  const auto square = [&](int x) {
    return memo.at(x, [&] {
      ++calls;
      return x * x;
    });
  };
  EXPECT_EQ(square(3), 9);
  EXPECT_EQ(square(4), 16);
  EXPECT_EQ(square(3), 9);
  EXPECT_EQ(calls, 2);
}

TEST(Memo, KeepsNothingOfACallThatThrows) {
  Memo<int, int> memo;
  EXPECT_THROW(memo.at(1, []() -> int { throw std::runtime_error("no result"); }),
               std::runtime_error);
  EXPECT_EQ(memo.at(1, [] { return 5; }), 5);
}

TEST(Memo, StaysRightBeyondTheNumberOfResultsThatItKeeps) {
  using Numbers = Memo<int, int>;
  Numbers memo;
  const int many = 3 * static_cast<int>(Numbers::kMost);
  for (int x = 0; x < many; ++x) EXPECT_EQ(memo.at(x, [&] { return 2 * x; }), 2 * x);
  // The last one is still kept, the first one is not.
  EXPECT_EQ(memo.at(many - 1, [] { return -1; }), 2 * (many - 1));
  EXPECT_EQ(memo.at(0, [] { return -1; }), -1);
}

TEST(Memo, ServesSeveralThreads) {
  Memo<int, int> memo;
  std::vector<std::thread> threads;
  std::vector<int> wrong(4);
  for (std::size_t t = 0; t < wrong.size(); ++t)
    threads.emplace_back([&, t] {
      for (int x = 0; x < 1000; ++x)
        if (memo.at(x % 100, [&] { return x % 100 + 1; }) != x % 100 + 1) ++wrong[t];
    });
  for (std::thread& thread : threads) thread.join();
  for (const int count : wrong) EXPECT_EQ(count, 0);
}

}  // namespace
}  // namespace navvy
