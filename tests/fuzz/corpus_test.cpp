// SPDX-License-Identifier: Apache-2.0
// The kept inputs of the fuzz targets in the plain build: each goes through without a crash or a
// broken property.
#include <gtest/gtest.h>

#include <cstdint>
#include <filesystem>
#include <vector>

#include "core/file.h"
#include "fuzz/target.h"
#include "paths.h"

NAVVY_FUZZ_TARGET(world);
NAVVY_FUZZ_TARGET(machine);
NAVVY_FUZZ_TARGET(set);
NAVVY_FUZZ_TARGET(obj);
NAVVY_FUZZ_TARGET(terrain);
NAVVY_FUZZ_TARGET(npy);
NAVVY_FUZZ_TARGET(landxml);

namespace navvy {
namespace {

void replay(const std::string& target, int (*run)(const std::uint8_t*, std::size_t)) {
  int inputs = 0;
  for (const auto& entry :
       std::filesystem::directory_iterator(source_dir() + "/tests/fuzz/corpus/" + target)) {
    SCOPED_TRACE(entry.path().filename().string());
    const std::vector<char> bytes = read_file(entry.path().string());
    EXPECT_EQ(run(reinterpret_cast<const std::uint8_t*>(bytes.data()), bytes.size()), 0);
    ++inputs;
  }
  EXPECT_GT(inputs, 2);
}

TEST(FuzzCorpus, OfWorldGoesThrough) { replay("world_fuzz", fuzz_world); }
TEST(FuzzCorpus, OfMachineGoesThrough) { replay("machine_fuzz", fuzz_machine); }
TEST(FuzzCorpus, OfSetGoesThrough) { replay("set_fuzz", fuzz_set); }
TEST(FuzzCorpus, OfObjGoesThrough) { replay("obj_fuzz", fuzz_obj); }
TEST(FuzzCorpus, OfTerrainGoesThrough) { replay("terrain_fuzz", fuzz_terrain); }
TEST(FuzzCorpus, OfNpyGoesThrough) { replay("npy_fuzz", fuzz_npy); }
TEST(FuzzCorpus, OfLandXmlGoesThrough) { replay("landxml_fuzz", fuzz_landxml); }

}  // namespace
}  // namespace navvy
