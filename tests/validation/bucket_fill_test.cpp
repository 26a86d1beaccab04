// SPDX-License-Identifier: Apache-2.0
// What the bucket brings in each kind of soil: the shipped trench, whole.
#include <gtest/gtest.h>

#include <cstdlib>
#include <string>

#include "validation/loads.h"
#include "validation/report.h"
#include "validation/scenes.h"
#include "values.h"

namespace navvy::validation {
namespace {

constexpr const char* kSource = "handbooks [docs/validation.md, Whole digs]";

struct FillCase {
  const char* soil;
  /// Range of the scoops of the first slice, which are planned as full / heaped bucket.
  double least, most;
  /// Least mean of the whole dig / heaped bucket; 0 if none is wanted.
  double whole;
};
void PrintTo(const FillCase& c, std::ostream* out) { *out << c.soil; }

class BucketFill : public testing::TestWithParam<FillCase> {};

TEST_P(BucketFill, IsWhatTheSoilHolds) {
  const FillCase& c = GetParam();
  const scene::Scene scene =
      load_scene("trench.sdf", {std::string("soil.ref=") + c.soil, "recording.duration_s=300"});
  session::Session session(scene, shared_device());
  while (!session.done()) session.step();
  // Later ones are planned as full as well, or take what is left of a slice, depending on the soil.
  constexpr std::size_t kFirstSlice = 2;
  const double heaped = heaped_load(scene);
  ASSERT_GE(session.cycles().size(), kFirstSlice);
  for (std::size_t i = 0; i < session.cycles().size(); ++i)
    print_value("scoop " + std::to_string(i + 1) + ", payload at the dump [kg]",
                session.cycles()[i].payload_dump, "no tolerance", kSource);
  expect_between("scoops of the first slice / heaped bucket",
                 mean_payload(session, kFirstSlice) / heaped, c.least, c.most, kSource);
  const double whole = mean_payload(session) / heaped;
  if (c.whole > 0)
    expect_between("all scoops / heaped bucket", whole, c.whole, 1.1, kSource);
  else
    print_value("all scoops / heaped bucket", whole, "no tolerance", kSource);
  print_value("the program's end [s]", session.world().time(), "no tolerance", kSource);
  // Soil without cohesion slides into its trench for longer than this run.
  if (c.whole > 0) EXPECT_TRUE(session.complete()) << session.programs().at(0).list.back().reason;
  expect_between("largest ledger error [units]",
                 static_cast<double>(std::abs(session.world().soil().mass_ledger().error)), 0, 0,
                 kSource);
  expect_between("shell crossings",
                 static_cast<double>(session.world().soil().counts().shell_crossings), 0, 0,
                 kSource);
}

// Fill factors of handbooks; sand and gravel by their repose.
INSTANTIATE_TEST_SUITE_P(
    Soils, BucketFill,
    testing::Values(FillCase{"loam", 0.9, 1.1, 0.7}, FillCase{"clay_wet", 0.9, 1.05, 0.7},
                    FillCase{"clay_stiff", 0.8, 1.0, 0}, FillCase{"sand_dry", 0.8, 1.0, 0},
                    FillCase{"gravel", 0.8, 1.0, 0}, FillCase{"crushed_stone", 0.6, 0.85, 0}),
    [](const auto& tested) { return std::string(tested.param.soil); });

}  // namespace
}  // namespace navvy::validation
