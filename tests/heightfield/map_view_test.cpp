// SPDX-License-Identifier: Apache-2.0
#include "heightfield/map_view.h"

#include <gtest/gtest.h>

#include "core/error.h"
#include "heightfield/grounds.h"

namespace navvy::heightfield {
namespace {

using testing::wavy_setup;

TEST(MapView, ShowsEveryLayerOfARectangle) {
  Ground::Setup setup = wavy_setup();
  setup.surface = [](int ix, int iy) { return 0.05 * ix - 0.02 * iy; };
  Ground ground(std::move(setup));
  std::vector<SoilLayer> taken;
  ground.take_above(40, 33, ground.height(40, 33) - 0.5, taken);
  const CellRect rect{35, 30, 50, 40};
  const MapView elevation = map_view(ground, "elevation", rect),
                change = map_view(ground, "change", rect);
  EXPECT_EQ(elevation.nx(), 15);
  EXPECT_EQ(elevation.ny(), 10);
  EXPECT_NEAR(elevation.origin.x(), -3.3 + 3.5, 1e-12);
  EXPECT_EQ(elevation.at(3, 2), static_cast<float>(ground.height(38, 32)));
  EXPECT_NEAR(change.at(5, 3), -0.5, 1e-6);  // float
  EXPECT_EQ(change.at(6, 3), 0);
  EXPECT_EQ(map_view(ground, "soil", rect).at(6, 3), 1);
  EXPECT_EQ(map_view(ground, "soil", rect).at(5, 3), 0);  // dug through the topsoil
  // The plane rises by 0.5 along x and falls by 0.2 along y.
  const Vec3 n = Vec3(-0.5, 0.2, 1).normalized();
  EXPECT_NEAR(map_view(ground, "normal_x", rect).at(12, 8), n.x(), 1e-6);
  EXPECT_NEAR(map_view(ground, "normal_y", rect).at(12, 8), n.y(), 1e-6);
  EXPECT_NEAR(map_view(ground, "normal_z", rect).at(12, 8), n.z(), 1e-6);
  EXPECT_NEAR(map_view(ground, "slope", rect).at(12, 8), std::acos(n.z()), 1e-6);
  EXPECT_EQ(elevation.sequence, ground.sequence());
}

TEST(MapView, IsCutToTheSite) {
  const Ground ground(wavy_setup());
  const MapView view = map_view(ground, "elevation", CellRect{-5, 40, 9, 99});
  EXPECT_EQ(view.nx(), 9);
  EXPECT_EQ(view.ny(), 5);
  EXPECT_EQ(view.at(0, 0), static_cast<float>(ground.height(0, 40)));
  EXPECT_TRUE(map_view(ground, "elevation", CellRect{200, 0, 210, 9}).values.empty());
  EXPECT_EQ(map_view(ground, "slope").values.size(), 77u * 45u);
}

TEST(MapView, KnowsItsLayersByName) {
  for (const MapLayer& layer : map_layers()) EXPECT_EQ(&map_layer(layer.name), &layer);
  EXPECT_THROW(map_layer("altitude"), InputError);
}

}  // namespace
}  // namespace navvy::heightfield
