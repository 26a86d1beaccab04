// SPDX-License-Identifier: Apache-2.0
// Ground queries of wheels and bodies on columns.
#include "coupling/ground_view.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "core/random.h"
#include "coupling/ride.h"

namespace navvy::coupling {
namespace {

/// Returns the same ground without an upper bound of its heights.
class WithoutHighest final : public terramechanics::GroundQuery {
 public:
  explicit WithoutHighest(const GroundView& view) : view_(view) {}
  double height(double x, double y) const override { return view_.height(x, y); }
  Vec3 normal(double x, double y) const override { return view_.normal(x, y); }
  terramechanics::SoilState soil(double x, double y) const override { return view_.soil(x, y); }
  terramechanics::GroundLattice lattice() const override { return view_.lattice(); }

 private:
  const GroundView& view_;
};

heightfield::Ground hills() {
  return testing::bed(testing::shipped_soil("loam"), 0.1, Vec2(12, 9), [](double x, double y) {
    return 0.4 * std::sin(1.3 * x) + 0.3 * std::cos(2.1 * y) + 0.1 * x;
  });
}

TEST(GroundView, BoundsItsHeightsInAnyRectangle) {
  const heightfield::Ground ground = hills();
  const GroundView view(ground, ground.setup().soils);
  Random random(11);
  for (int n = 0; n < 300; ++n) {
    const Vec2 low(random.uniform(-3, 13), random.uniform(-3, 10));
    const Vec2 high = low + Vec2(random.uniform(0, 3), random.uniform(0, 3));
    double most = -1e9;
    for (int i = 0; i <= 40; ++i)
      for (int j = 0; j <= 40; ++j)
        most = std::max(most, view.height(low.x() + (high.x() - low.x()) * i / 40,
                                          low.y() + (high.y() - low.y()) * j / 40));
    EXPECT_GE(view.highest(low, high) + 1e-9, most);
    // The steepest slope is 0.9 m per metre: a ring of two columns around the rectangle.
    EXPECT_LE(view.highest(low, high), most + 0.35);
  }
}

// A body whose box is wholly above the ground is skipped; this must not affect the forces on it.
TEST(GroundView, ItsHeightBoundDoesNotAffectForcesOnBodies) {
  const heightfield::Ground ground = hills();
  const GroundView view(ground, ground.setup().soils);
  const WithoutHighest plain(view);
  scene::Machine box;
  box.name = "box";
  scene::Link link;
  link.name = "box";
  link.mass = 100;
  link.inertia = Mat3::Identity() * 10;
  link.collisions.push_back({});
  box.links.push_back(link);
  std::vector<Pose> places;
  for (const terramechanics::GroundQuery* asked :
       {static_cast<const terramechanics::GroundQuery*>(&view),
        static_cast<const terramechanics::GroundQuery*>(&plain)}) {
    const auto engine = vehicle::make_bullet_engine(Vec3(0, 0, -kGravity));
    engine->add_machine(box, make_pose(5, 4, 2.5));
    for (int step = 0; step < 1200; ++step) engine->step(testing::Ride::kStep, *asked);
    places.push_back(engine->link(0, 0).X_WL);
  }
  EXPECT_LT(places[0].translation().z(), 2);  // it fell, and tumbled downhill
  EXPECT_TRUE(places[0].matrix() == places[1].matrix());
}

}  // namespace
}  // namespace navvy::coupling
