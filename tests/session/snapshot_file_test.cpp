// SPDX-License-Identifier: Apache-2.0
// Snapshots as files: damaged ones, those of another scene, and crafted ones.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <fstream>
#include <limits>
#include <memory>
#include <string>
#include <vector>

#include "control/step_kinds.h"
#include "core/error.h"
#include "core/file.h"
#include "core/random.h"
#include "core/saved_state.h"
#include "device/device.h"
#include "folder.h"
#include "paths.h"
#include "scene_io/loader.h"
#include "session/session.h"

namespace navvy::session {
namespace {

class SnapshotFile : public testing::Test {
 protected:
  std::unique_ptr<Session> make(const std::string& scene, const std::vector<std::string>& settings,
                                double time = 0) {
    scene_io::Overrides overrides;
    overrides.render = false;
    for (const std::string& setting : settings)
      overrides.set.push_back(scene_io::parse_setting(setting));
    auto session =
        std::make_unique<Session>(scene_io::load_scene(navvy::source_dir() + "/scenarios/" + scene,
                                                       control::step_kinds(), overrides),
                                  device_);
    while (session->world().time() < time) session->step();
    return session;
  }
  void put(const std::vector<char>& bytes) const {
    std::ofstream(path_, std::ios::binary)
        .write(bytes.data(), static_cast<std::streamsize>(bytes.size()));
  }
  /// Returns why `session` refuses the file; empty if it accepts it.
  std::string refusal(Session& session, bool anyway = false) const {
    try {
      session.load(path_, anyway);
    } catch (const InputError& error) {
      return error.what();
    }
    return "";
  }

  device::Device device_;
  const test::Folder folder_;
  const std::string path_ = folder_ / "a.snapshot";
};

const std::vector<std::string> kCoarse = {"solver.cell_m=0.2"};

TEST_F(SnapshotFile, HasTheBytesOfASnapshotInMemory) {
  const auto first = make("bucket_path.sdf", kCoarse, 0.5);
  const std::vector<char> bytes = first->snapshot();
  first->save(path_);
  EXPECT_EQ(read_file(path_), bytes);
  const auto second = make("bucket_path.sdf", kCoarse);
  second->restore(bytes);
  EXPECT_EQ(second->state_hash(), first->state_hash());
  std::vector<char> torn = bytes;
  torn[torn.size() / 2] ^= 1;
  EXPECT_THROW(second->restore(torn), InputError);
}

TEST_F(SnapshotFile, RefusesTenThousandDamagedFiles) {
  // At a time when the bucket is in the soil.
  const auto session = make("bucket_path.sdf", kCoarse, 1.5);
  ASSERT_GT(session->world().soil().counts().particles, 0u);
  session->save(path_);
  const std::vector<char> whole = read_file(path_);
  const std::string hash = session->state_hash();
  Random random(3);
  const auto any = [&](std::size_t below) {
    return static_cast<std::size_t>(random.uniform(0, static_cast<double>(below)));
  };
  int flips = 0, cuts = 0, swaps = 0;
  for (int i = 0; i < 10000; ++i) {
    std::vector<char> bytes = whole;
    if (i % 5 == 3) {
      bytes.resize(any(bytes.size()));
      ++cuts;
    } else if (i % 5 == 4) {
      // Swaps two runs of bytes.
      while (bytes == whole) {  // swapping equal bytes is no damage
        const std::size_t size = 1 + any(64), from = any(bytes.size() - size),
                          to = any(bytes.size() - size);
        std::swap_ranges(bytes.begin() + static_cast<std::ptrdiff_t>(std::min(from, to)),
                         bytes.begin() + static_cast<std::ptrdiff_t>(std::min(
                                             std::min(from, to) + size, std::max(from, to))),
                         bytes.begin() + static_cast<std::ptrdiff_t>(std::max(from, to)));
      }
      ++swaps;
    } else {
      bytes[any(bytes.size())] ^= static_cast<char>(1 << any(8));
      ++flips;
    }
    put(bytes);
    ASSERT_NE(refusal(*session), "")
        << "damage " << i << " of " << bytes.size() << " bytes was accepted";
  }
  EXPECT_EQ(flips + cuts + swaps, 10000);
  std::printf("%zu bytes: %d flipped bits, %d cuts, %d swaps, all refused\n", whole.size(), flips,
              cuts, swaps);
  // Refused before anything was modified: the run can continue.
  EXPECT_EQ(session->state_hash(), hash);
  put(whole);
  EXPECT_EQ(refusal(*session), "");
}

TEST_F(SnapshotFile, OfAnotherCohesionMassOrPlaceIsRefusedWithTheDifference) {
  const auto session = make("bucket_path.sdf", kCoarse, 0.05);
  session->save(path_);
  const std::vector<std::pair<std::string, std::string>> changes = {
      {"soil.cohesion_pa=8123", "soil[loam]/cohesion"},
      {"machine[bucket].x_m=0.05", "machine[bucket]/pose/place"},
  };
  for (const auto& [setting, message] : changes) {
    const auto other = make("bucket_path.sdf", {kCoarse[0], setting});
    const std::string said = refusal(*other);
    EXPECT_NE(said.find(message), std::string::npos) << setting << ": " << said;
    EXPECT_NE(said.find("--resume-anyway"), std::string::npos) << said;
    EXPECT_EQ(refusal(*other, true), "") << setting;
    EXPECT_EQ(other->world().steps(), session->world().steps());
    other->step();
  }
  EXPECT_EQ(refusal(*make("bucket_path.sdf", kCoarse)), "");
}

TEST_F(SnapshotFile, HashesCoverTheWholeStartingGroundAndEveryParameter) {
  const std::vector<std::vector<std::string>> scenes = {
      kCoarse, {kCoarse[0], "soil.cohesion_pa=8123"}, {kCoarse[0], "soil.bekker_n=0.71"}};
  std::vector<std::string> hashes;
  hashes.reserve(scenes.size());
  for (const auto& settings : scenes)
    hashes.push_back(make("bucket_path.sdf", settings)->state_hash());
  std::sort(hashes.begin(), hashes.end());
  EXPECT_EQ(std::adjacent_find(hashes.begin(), hashes.end()), hashes.end())
      << "before the first step";
  // Untouched hills.
  const auto hills = [&](std::uint64_t seed) {
    scene_io::Overrides overrides;
    overrides.set = {scene_io::parse_setting(kCoarse[0])};
    scene::Scene scene = scene_io::load_scene(navvy::source_dir() + "/scenarios/bucket_path.sdf",
                                              control::step_kinds(), overrides);
    scene::GroundFeature feature;
    feature.kind = scene::GroundFeature::Kind::kHills;
    feature.height = 0.02;
    feature.length = 5;
    feature.seed = seed;
    scene.ground.features.push_back(feature);
    return Session(std::move(scene), device_).state_hash();
  };
  EXPECT_NE(hills(1), hills(2));
  EXPECT_EQ(hills(1), hills(1));
}

/// Extreme values for a field of this size, as integers and as floating-point numbers.
std::vector<std::vector<char>> extremes(std::size_t size) {
  std::vector<std::vector<char>> out;
  const auto add = [&](const auto& value) {
    if (sizeof value != size) return;
    std::vector<char> bytes(size);
    std::memcpy(bytes.data(), &value, size);
    out.push_back(bytes);
  };
  add(std::uint8_t{0x7f});
  add(std::uint8_t{0xff});
  for (const std::int32_t value : {-1, 1, 1000, 2147483647, -2147483647 - 1}) add(value);
  for (const float value : {std::nanf(""), 1e30f, -1e30f, std::numeric_limits<float>::infinity()})
    add(value);
  for (const std::int64_t value : {std::int64_t{-1}, std::int64_t{1}, std::int64_t{1} << 40,
                                   std::numeric_limits<std::int64_t>::max()})
    add(value);
  for (const double value : {std::nan(""), 1e300, -1e300, std::numeric_limits<double>::infinity()})
    add(value);
  return out;
}

// Every field of a state in turn gets a value that no run wrote, with a matching checksum: it is
// refused by name, or the run stops with a message, or it continues for three steps; the program
// survives.
TEST_F(SnapshotFile, CraftedValuesAreRefusedOrSurvived) {
  int met = 0, tried = 0, refused = 0, stopped = 0;
  for (const char* name : {"bucket_path.sdf", "trench.sdf"}) {
    const bool bucket = std::string(name) == "bucket_path.sdf";
    const std::vector<std::string> settings = {bucket ? "solver.cell_m=0.2" : "solver.cell_m=0.3"};
    const auto session = make(name, settings, bucket ? 1.5 : 0.2);
    const auto target = make(name, settings);
    ByteMap map;
    const std::vector<char> bytes = saved(*session, &map);
    std::string last;
    for (const ByteMap::Field& field : map.fields) {
      // The first few elements of a list stand for all: names differ only in their numbers.
      std::string kind;
      for (const char c : field.path)
        if (c < '0' || c > '9') kind += c;
      static std::map<std::string, int> seen;
      if (++seen[kind] > 2) continue;
      // Within a run of plain values: as bytes of any number, at its beginning and in its middle.
      for (const std::size_t width : {std::size_t{1}, std::size_t{4}, std::size_t{8}}) {
        if (field.size < width || (field.size < 8 && field.size != width)) continue;
        for (const std::vector<char>& extreme : extremes(width))
          for (const std::size_t at : {std::size_t{0}, field.size / 2 / width * width}) {
            if (at != 0 && field.size <= 8) continue;
            // All of them take half a minute; every third still covers every kind of field.
            if (++met % 3 != 0) continue;
            std::vector<char> crafted = bytes;
            std::copy(extreme.begin(), extreme.end(),
                      crafted.begin() + static_cast<std::ptrdiff_t>(field.offset + at));
            ++tried;
            try {
              load_saved(crafted, *target);
              for (int i = 0; i < 3; ++i) target->step();
              target->state_hash();
            } catch (const InputError&) {
              ++refused;
            } catch (const Error&) {
              ++stopped;
            }
          }
      }
    }
    // The session is still intact.
    load_saved(bytes, *target);
    EXPECT_EQ(target->state_hash(), session->state_hash()) << name;
  }
  std::printf("%d crafted values: %d refused, %d stopped the run with a message\n", tried, refused,
              stopped);
  EXPECT_GT(refused, 100);
}

}  // namespace
}  // namespace navvy::session
