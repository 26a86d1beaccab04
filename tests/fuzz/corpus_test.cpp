// SPDX-License-Identifier: Apache-2.0
// Replays the kept inputs of the fuzz targets in the plain build: none may crash or break a
// property.
#include <gtest/gtest.h>

#include <cstdint>

#include "folder.h"
#include "fuzz/pack.h"
#include "fuzz/target.h"
#include "paths.h"

NAVVY_FUZZ_TARGET(world);
NAVVY_FUZZ_TARGET(machine);
NAVVY_FUZZ_TARGET(set);
NAVVY_FUZZ_TARGET(urdf);
NAVVY_FUZZ_TARGET(obj);
NAVVY_FUZZ_TARGET(mesh);
NAVVY_FUZZ_TARGET(terrain);
NAVVY_FUZZ_TARGET(npy);
NAVVY_FUZZ_TARGET(landxml);

namespace navvy {
namespace {

void replay(const std::string& target, int (*run)(const std::uint8_t*, std::size_t)) {
  const fuzz::Inputs inputs =
      fuzz::read_pack(source_dir() + "/tests/fuzz/corpus/" + target + ".pack");
  EXPECT_GT(inputs.size(), 2u);
  for (const auto& [name, bytes] : inputs) {
    SCOPED_TRACE(name);
    EXPECT_EQ(run(reinterpret_cast<const std::uint8_t*>(bytes.data()), bytes.size()), 0);
  }
}

TEST(FuzzCorpus, WorldReplaysWithoutFailure) { replay("world", fuzz_world); }
TEST(FuzzCorpus, MachineReplaysWithoutFailure) { replay("machine", fuzz_machine); }
TEST(FuzzCorpus, SetReplaysWithoutFailure) { replay("set", fuzz_set); }
TEST(FuzzCorpus, UrdfReplaysWithoutFailure) { replay("urdf", fuzz_urdf); }
TEST(FuzzCorpus, MeshReplaysWithoutFailure) { replay("mesh", fuzz_mesh); }
TEST(FuzzCorpus, ObjReplaysWithoutFailure) { replay("obj", fuzz_obj); }
TEST(FuzzCorpus, TerrainReplaysWithoutFailure) { replay("terrain", fuzz_terrain); }
TEST(FuzzCorpus, NpyReplaysWithoutFailure) { replay("npy", fuzz_npy); }
TEST(FuzzCorpus, LandXmlReplaysWithoutFailure) { replay("landxml", fuzz_landxml); }

TEST(FuzzPack, GivesBackWhatWasPacked) {
  const test::Folder folder;
  const fuzz::Inputs inputs = {{"a", ""}, {"b", "x 1\n"}, {"c", std::string("\0\n\xff", 3)}};
  fuzz::write_pack(folder / "p.pack", inputs);
  EXPECT_EQ(fuzz::read_pack(folder / "p.pack"), inputs);
  fuzz::write_folder(folder / "files", inputs);
  EXPECT_EQ(fuzz::read_folder(folder / "files"), inputs);
}

TEST(FuzzPack, RefusesAPackThatIsCutShort) {
  const test::Folder folder;
  std::ofstream(folder / "cut.pack") << "a 9\nabc\n";
  EXPECT_THROW(fuzz::read_pack(folder / "cut.pack"), std::runtime_error);
  std::ofstream(folder / "text.pack") << "no pack at all\n";
  EXPECT_THROW(fuzz::read_pack(folder / "text.pack"), std::runtime_error);
  EXPECT_THROW(fuzz::read_pack(folder / "missing.pack"), std::runtime_error);
}

}  // namespace
}  // namespace navvy
