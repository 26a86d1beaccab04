// SPDX-License-Identifier: Apache-2.0
#include "render/closed_mesh.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>

namespace navvy::render {
namespace {

/// Adds a cube with outward faces, ended by -1, whose points are numbered from `first`.
void add_cube(std::vector<Vec3f>& points, std::vector<std::int32_t>& indices, const Vec3f& at) {
  const auto first = static_cast<std::int32_t>(points.size());
  for (int k = 0; k < 8; ++k)
    points.push_back(at + Vec3f(static_cast<float>(k & 1), static_cast<float>((k >> 1) & 1),
                                static_cast<float>(k >> 2)));
  for (const auto& face : {std::array{0, 2, 3, 1},
                           {4, 5, 7, 6},
                           {0, 1, 5, 4},
                           {2, 6, 7, 3},
                           {0, 4, 6, 2},
                           {1, 3, 7, 5}}) {
    for (const int k : face) indices.push_back(first + k);
    indices.push_back(-1);
  }
}

class Solid : public ::testing::Test {
 protected:
  void SetUp() override { add_cube(points_, indices_, {1, 2, 3}); }
  std::vector<Vec3f> points_;
  std::vector<std::int32_t> indices_;
};

TEST_F(Solid, ACubeTurnedOutwardsIsSolid) { EXPECT_TRUE(is_solid(points_, indices_)); }

TEST_F(Solid, ACubeWithoutLidIsNot) {
  indices_.resize(indices_.size() - 5);
  EXPECT_FALSE(is_solid(points_, indices_));
}

TEST_F(Solid, OneFlippedFaceOpensIt) {
  std::reverse(indices_.begin(), indices_.begin() + 4);
  EXPECT_FALSE(is_solid(points_, indices_));
}

TEST_F(Solid, DetectsAnInvertedPieceBesideALargerOne) {
  // A small inverted cube beside a large one: the sum of volumes is still positive.
  for (Vec3f& p : points_) p *= 3;
  std::vector<Vec3f> small;
  std::vector<std::int32_t> inward;
  add_cube(small, inward, {20, 0, 0});
  for (std::size_t i = 0; i < inward.size(); i += 5)
    std::reverse(inward.begin() + static_cast<long>(i), inward.begin() + static_cast<long>(i) + 4);
  for (const std::int32_t i : inward) indices_.push_back(i < 0 ? -1 : i + 8);
  points_.insert(points_.end(), small.begin(), small.end());
  EXPECT_FALSE(is_solid(points_, indices_));
}

TEST_F(Solid, CoincidentPointsCountAsOne) {
  std::vector<Vec3f> own;
  std::vector<std::int32_t> indices;
  for (const std::int32_t i : indices_) {
    indices.push_back(i < 0 ? -1 : static_cast<std::int32_t>(own.size()));
    if (i >= 0) own.push_back(points_[static_cast<std::size_t>(i)]);
  }
  EXPECT_TRUE(is_solid(own, indices));
}

}  // namespace
}  // namespace navvy::render
