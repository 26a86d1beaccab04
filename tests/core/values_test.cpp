// SPDX-License-Identifier: Apache-2.0
// Small types used by all modules: errors, hash, random numbers, log, math.
#include <gtest/gtest.h>

#include <set>
#include <string>
#include <vector>

#include "core/edit_distance.h"
#include "core/error.h"
#include "core/hash.h"
#include "core/log.h"
#include "core/math.h"
#include "core/random.h"

namespace navvy {
namespace {

TEST(Fault, StatesPlaceValueRuleAndRemedy) {
  Fault fault{Fault::Severity::kError, "a.sdf",           12, "world/navvy:soil/cohesion_pa", "-3",
              "must be at least 0",    "write 0 for sand"};
  EXPECT_EQ(
      fault.text(),
      "a.sdf:12: error: world/navvy:soil/cohesion_pa: '-3': must be at least 0 (write 0 for sand)");
  fault.severity = Fault::Severity::kWarning;
  fault.line = 0;
  fault.value.clear();
  fault.remedy.clear();
  EXPECT_EQ(fault.text(), "a.sdf: warning: world/navvy:soil/cohesion_pa: must be at least 0");
  EXPECT_EQ(Fault{}.text(), "error: ");
}

TEST(InputError, ListsEveryFaultOnItsOwnLine) {
  const InputError error(std::vector<Fault>{{Fault::Severity::kError, "f", 1, "", "", "one", ""},
                                            {Fault::Severity::kError, "f", 2, "", "", "two", ""}});
  EXPECT_STREQ(error.what(), "f:1: error: one\nf:2: error: two");
  EXPECT_EQ(error.faults().size(), 2u);
}

TEST(StateHash, ChangesWithEveryBitLengthAndOrder) {
  std::vector<unsigned char> bytes(29, 0);
  std::set<std::uint64_t> seen;
  const auto digest = [](const std::vector<unsigned char>& data) {
    StateHash hash;
    hash.bytes(data.data(), data.size());
    return hash.digest();
  };
  for (std::size_t bit = 0; bit < 8 * bytes.size(); ++bit) {
    bytes[bit / 8] ^= static_cast<unsigned char>(1u << (bit % 8));
    EXPECT_TRUE(seen.insert(digest(bytes)).second) << "bit " << bit;
    bytes[bit / 8] ^= static_cast<unsigned char>(1u << (bit % 8));
  }
  for (std::size_t size = 0; size <= bytes.size(); ++size) {
    EXPECT_TRUE(
        seen.insert(digest({bytes.begin(), bytes.begin() + static_cast<std::ptrdiff_t>(size)}))
            .second)
        << size;
  }
  StateHash ab, ba;
  ab.value(1.5);
  ab.value(2);
  ba.value(2);
  ba.value(1.5);
  EXPECT_NE(ab.digest(), ba.digest());
}

TEST(StateHash, IsWrittenAsSixteenHexDigits) {
  EXPECT_EQ(StateHash().hex(), "cbf29ce484222325");  // the offset basis of 64-bit FNV-1a
}

TEST(Random, ProducesThePublishedSequence) {
  // First numbers of SplitMix64 for seed 1234567, as printed by the authors' C code.
  Random random(1234567);
  for (const std::uint64_t expected :
       {6457827717110365317ULL, 3203168211198807973ULL, 9817491932198370423ULL,
        4593380528125082431ULL, 16408922859458223821ULL}) {
    EXPECT_EQ(random.next(), expected);
  }
}

TEST(Random, IsUniformInItsRange) {
  Random random(3);
  constexpr int kDraws = 100000;
  double sum = 0;
  for (int i = 0; i < kDraws; ++i) {
    const double x = random.uniform(-2, 6);
    ASSERT_GE(x, -2);
    ASSERT_LT(x, 6);
    sum += x;
  }
  // Standard error of the mean is 8 / sqrt(12 n) = 0.0073; five of them.
  EXPECT_NEAR(sum / kDraws, 2, 0.037);
}

TEST(Suggestion, IsTheMostSimilarNameEvenWithReorderedWords) {
  const std::vector<std::string> soils = {"clay_stiff", "loam", "sand_dry", "sand_moist",
                                          "topsoil"};
  EXPECT_EQ(suggestion("laom", soils), "did you mean 'loam'?");
  EXPECT_EQ(suggestion("dry_sand", soils), "did you mean 'sand_dry'?");
  EXPECT_EQ(suggestion("dry-sand", soils), "did you mean 'sand_dry'?");
  EXPECT_EQ(suggestion("stif_clay", soils), "did you mean 'clay_stiff'?");
  EXPECT_EQ(nearest_name(soils, "moist_sand"), "sand_moist");
  EXPECT_EQ(suggestion("gravel", soils),
            "known here: clay_stiff, loam, sand_dry, sand_moist, topsoil");
}

TEST(Log, GoesToTheSinkOrNowhere) {
  log_info("lost");
  std::vector<std::string> lines;
  set_log_sink([&](LogLevel level, const std::string& text) {
    lines.push_back((level == LogLevel::kWarning ? "warning " : "info ") + text);
  });
  log_info("a");
  log_warning("b");
  set_log_sink({});
  log_info("lost");
  EXPECT_EQ(lines, (std::vector<std::string>{"info a", "warning b"}));
}

TEST(Math, PoseTurnsAboutFixedAxesRollFirst) {
  // Roll takes y to z; yaw leaves z; so the y axis ends as z.
  const Pose X = make_pose(1, 2, 3, kPi / 2, 0, kPi / 2);
  // Rounding of sin and cos of pi/2: a few 1e-16.
  EXPECT_TRUE((X * Vec3(0, 1, 0)).isApprox(Vec3(1, 2, 4), 1e-14));
  EXPECT_TRUE((X * Vec3(1, 0, 0)).isApprox(Vec3(1, 3, 3), 1e-14));
}

TEST(Math, MassUnitsRoundToNearestAndBackExactly) {
  EXPECT_EQ(mass_units(1.0), 1 << 24);
  EXPECT_EQ(mass_units(-0.4 * kMassQuantum), 0);
  EXPECT_EQ(mass_units(1.6 * kMassQuantum), 2);
  for (const std::int64_t units :
       {std::int64_t{1}, std::int64_t{123456789}, std::int64_t{1} << 52}) {
    EXPECT_EQ(mass_units(kilograms(units)), units);
  }
}

}  // namespace
}  // namespace navvy
