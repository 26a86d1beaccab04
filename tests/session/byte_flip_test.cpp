// SPDX-License-Identifier: Apache-2.0
// A real world saves only state that its hash covers: bytes of its snapshot are flipped one by one,
// and each time the load is refused, or the hash changes, or the byte belongs to a field that gives
// a reason for not being hashed.
#include <gtest/gtest.h>

#include <memory>
#include <set>
#include <string>
#include <vector>

#include "control/step_kinds.h"
#include "core/saved_state.h"
#include "device/device.h"
#include "flip_bytes.h"
#include "paths.h"
#include "scene_io/loader.h"
#include "session/session.h"
#include "sim/height_grid.h"

namespace navvy::session {
namespace {

using Texts = std::set<std::string>;

class ByteFlip : public testing::Test {
 protected:
  /// Makes the scene with a sensor on its first machine, at `time` [s].
  std::unique_ptr<Session> make(const std::string& scene, const std::vector<std::string>& settings,
                                double time) {
    scene_io::Overrides overrides;
    overrides.render = false;
    for (const std::string& setting : settings)
      overrides.set.push_back(scene_io::parse_setting(setting));
    auto session =
        std::make_unique<Session>(scene_io::load_scene(navvy::source_dir() + "/scenarios/" + scene,
                                                       control::step_kinds(), overrides),
                                  device_);
    session->add(
        std::make_unique<sim::testing::HeightGrid>(session->world().machines().at(0), 3, 0.2, 20));
    while (session->world().time() < time) session->step();
    return session;
  }

  /// Reasons of the fields that are saved but not hashed; constants, which loading compares, do not
  /// count.
  static Texts reasons(const Session& session) {
    ByteMap map;
    saved(session, &map);
    Texts out;
    for (const ByteMap::Field& field : map.fields)
      if (!field.hashed && !field.reason.empty()) out.insert(field.reason);
    return out;
  }

  device::Device device_;
};

/// One byte in so many in runs of more than 256 bytes: a load takes a millisecond, so that every
/// byte of these 540 kB would take ten minutes. A prime has no common factor with the size of any
/// element, and therefore reaches all of their bytes.
constexpr std::size_t kStride = 401;

/// In shorter fields the first byte and every seventh after it: the lowest and the highest of a
/// number of eight bytes. A hashed field is hashed as a whole, so a forgotten one shows at its
/// first byte.
constexpr std::size_t kShortStride = 7;

/// Add a field to this list only after checking that no run depends on it. The place where a step
/// began is the exception: runs whose earlier states are equal have the same one.
const Texts kReasons = {"counts for people, no step reads them",
                        "follows from the states before; states of equal runs keep their hashes",
                        "only reports: a collision changes the states of its machines",
                        "states of runs without orders keep their hashes"};

// Cells of 0.2 m: three thousand particles while the bucket moves through the soil.
TEST_F(ByteFlip, OfADiggingBucketIsDetected) {
  const std::vector<std::string> coarse = {"solver.cell_m=0.2"};
  const auto session = make("bucket_path.sdf", coarse, 1.5);
  ASSERT_GT(session->world().soil().counts().particles, 50);
  const auto target = make("bucket_path.sdf", coarse, 0);
  EXPECT_EQ(test::flip_every_byte(*session, *target, kStride, kShortStride), "");
  EXPECT_EQ(reasons(*session), kReasons);
}

// An excavator of rigid bodies on tyres, before it digs: Bullet's state, drive, ruts, operator.
TEST_F(ByteFlip, OfAnExcavatorOnItsWheelsIsDetected) {
  const auto session = make("trench.sdf", {}, 0.5), target = make("trench.sdf", {}, 0);
  EXPECT_EQ(test::flip_every_byte(*session, *target, kStride, kShortStride), "");
  // A brake that is off is not hashed; a set one is, by its held position.
  std::set<std::string> with_brakes = kReasons;
  with_brakes.insert("hashed by the held position while it is set");
  // Only soil with an exponent of repeated passes reads it, and hashes its effect.
  with_brakes.insert("hashed by the pressures below where it is true");
  EXPECT_EQ(reasons(*session), with_brakes);
}

}  // namespace
}  // namespace navvy::session
