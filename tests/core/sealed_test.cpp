// SPDX-License-Identifier: Apache-2.0
#include "core/sealed.h"

#include <gtest/gtest.h>

#include <cstdint>

#include "core/archive.h"
#include "core/error.h"
#include "core/file.h"
#include "core/random.h"
#include "core/saved_state.h"
#include "folder.h"

namespace navvy {
namespace {

struct Part {
  std::vector<double> values;
  void visit(Archive& a) {
    a.section("part", 1, [&] { a("values", values); });
  }
};
/// Three sections in a row, the first two of one kind and length.
struct State {
  Part first{{1, 2, 3}}, second{{4, 5, 6}}, third{{7}};
  void visit(Archive& a) {
    a("first", first);
    a("second", second);
    a("third", third);
  }
};

bool refused(const std::vector<char>& content) {
  try {
    unseal(content);
  } catch (const InputError&) {
    return true;
  }
  return false;
}

TEST(Sealed, RestoresTheState) {
  const std::vector<char> state = saved(State());
  EXPECT_EQ(unseal(seal(state)), state);
  EXPECT_EQ(unseal(seal({})), std::vector<char>());
}

TEST(Sealed, IsRecognisedByItsHeader) {
  const test::Folder folder;
  write_file_atomically(folder / "state", seal(saved(State())));
  write_file_atomically(folder / "short", std::string("navvy"));
  EXPECT_TRUE(is_sealed(folder / "state"));
  EXPECT_FALSE(is_sealed(folder / "short"));
  EXPECT_FALSE(is_sealed(folder / "none"));
  EXPECT_FALSE(is_sealed(folder / ""));
}

TEST(Sealed, RejectsBytesOutsideOfSections) {
  EXPECT_THROW(seal(std::vector<char>(5, 'x')), Error);
  EXPECT_THROW(seal(std::vector<char>(100, 'x')), Error);
}

TEST(Sealed, EveryFlippedBitIsRefused) {
  const std::vector<char> content = seal(saved(State()));
  for (std::size_t bit = 0; bit < 8 * content.size(); ++bit) {
    std::vector<char> flipped = content;
    flipped[bit / 8] = static_cast<char>(flipped[bit / 8] ^ (1 << (bit % 8)));
    EXPECT_TRUE(refused(flipped)) << "bit " << bit;
  }
}

TEST(Sealed, ADamagedSectionIsReportedByPlaceAndName) {
  const std::vector<char> content = seal(saved(State()));
  const auto message_of = [&](std::size_t byte) {
    std::vector<char> flipped = content;
    flipped[byte] = static_cast<char>(flipped[byte] ^ 0x80);
    try {
      unseal(flipped);
    } catch (const InputError& error) {
      return std::string(error.what());
    }
    return std::string();
  };
  EXPECT_NE(message_of(content.size() - 1).find("section 3, 'part': the checksum does not match"),
            std::string::npos)
      << message_of(content.size() - 1);
  // The name itself is damaged: its leading letters are reported.
  const std::size_t name = 40 + 8;
  EXPECT_NE(message_of(name + 2).find("section 1, 'pa': "), std::string::npos)
      << message_of(name + 2);
  EXPECT_NE(message_of(name).find("section 1: "), std::string::npos) << message_of(name);
}

TEST(Sealed, RefusesEveryWrongLength) {
  std::vector<char> content = seal(saved(State()));
  for (std::size_t size = 0; size < content.size(); ++size)
    EXPECT_TRUE(refused(
        std::vector<char>(content.begin(), content.begin() + static_cast<std::ptrdiff_t>(size))))
        << size;
  content.push_back(0);
  EXPECT_TRUE(refused(content));
}

TEST(Sealed, SwappedSectionsAreRefused) {
  State swapped;
  std::swap(swapped.first, swapped.second);
  const std::vector<char> one = seal(saved(State())), other = seal(saved(swapped));
  ASSERT_EQ(one.size(), other.size());
  // Swaps the two equal sections of one file, including their checksums.
  const std::size_t head = 40, size = 8 + 28 + 8 + 24;
  std::vector<char> mixed = one;
  std::copy(one.begin() + head, one.begin() + head + size, mixed.begin() + head + size);
  std::copy(one.begin() + head + size, one.begin() + head + 2 * size, mixed.begin() + head);
  EXPECT_TRUE(refused(mixed));
}

// Two states of one run have sections of equal names and lengths.
TEST(Sealed, SectionsOfAnotherStateAreRefusedInEveryCombination) {
  State later;
  later.first.values = {1.5, 2, 3};
  later.second.values = {4.5, 5, 6};
  later.third.values = {7.5};
  const std::vector<char> one = seal(saved(State())), other = seal(saved(later));
  ASSERT_EQ(one.size(), other.size());
  // Head and sections, with their checksums, end here.
  const std::size_t ends[] = {40, 40 + 68, 40 + 2 * 68, one.size()};
  int tried = 0;
  for (unsigned from_other = 1; from_other < 15; ++from_other) {
    std::vector<char> mixed = one;
    for (std::size_t part = 0, begin = 0; part < 4; begin = ends[part++])
      if ((from_other >> part & 1) != 0)
        std::copy(other.begin() + static_cast<std::ptrdiff_t>(begin),
                  other.begin() + static_cast<std::ptrdiff_t>(ends[part]),
                  mixed.begin() + static_cast<std::ptrdiff_t>(begin));
    EXPECT_TRUE(refused(mixed)) << from_other;
    ++tried;
  }
  EXPECT_EQ(tried, 14);
  EXPECT_FALSE(refused(other));
}

TEST(Sealed, AnotherVersionIsNamed) {
  std::vector<char> content = seal(saved(State()));
  content[12] = '1';
  try {
    unseal(content);
    ADD_FAILURE();
  } catch (const InputError& error) {
    EXPECT_EQ(std::string(error.what()),
              "snapshot: error: head: '1': another version of Navvy wrote this format; this one "
              "reads 3 (continue with that version, or record the snapshot again)");
  }
}

}  // namespace
}  // namespace navvy
