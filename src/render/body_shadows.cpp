// SPDX-License-Identifier: Apache-2.0
#include "render/body_shadows.h"

#include <numeric>

namespace navvy::render {

void BodyShadows::find_groups() {
  const std::size_t count = bodies_.size();
  low_.assign(count, Vec3f::Constant(1e30f));
  high_.assign(count, Vec3f::Constant(-1e30f));
  for (std::size_t i = 0; i < count; ++i) bodies_[i].extend(low_[i], high_[i]);
  // Each body refers to an earlier one of its group, the first one to itself.
  std::vector<std::size_t> first(count);
  std::iota(first.begin(), first.end(), std::size_t{0});
  const auto first_of = [&](std::size_t i) {
    while (first[i] != i) i = first[i] = first[first[i]];
    return i;
  };
  for (std::size_t i = 0; i < count; ++i)
    for (std::size_t k = 0; k < i; ++k) {
      const Vec3f gap = (low_[i] - high_[k]).cwiseMax(low_[k] - high_[i]);
      if (gap.maxCoeff() >= kApart) continue;
      const std::size_t a = first_of(i), b = first_of(k);
      first[std::max(a, b)] = std::min(a, b);
    }
  groups_.clear();
  std::vector<std::size_t> group_of(count);
  for (std::size_t i = 0; i < count; ++i) {
    const std::size_t root = first_of(i);
    if (root == i) {
      group_of[i] = groups_.size();
      groups_.emplace_back();
    }
    group_of[i] = group_of[root];
    groups_[group_of[i]].bodies.push_back(i);
  }
}

void BodyShadows::cast(ShadowMap& map) const {
  for (std::size_t b = 0; b < bodies_.size(); ++b) {
    if (!map.covers(low_[b], high_[b])) continue;
    const Eigen::Matrix3f turn = bodies_[b].X_WS.topLeftCorner<3, 3>();
    const Vec3f at = bodies_[b].X_WS.topRightCorner<3, 1>();
    for (const bool solid : {true, false}) {
      const std::vector<Vec3f>& t =
          solid ? bodies_[b].shape->solid_triangles : bodies_[b].shape->open_triangles;
      for (std::size_t i = 0; i + 2 < t.size(); i += 3)
        map.add_triangle(turn * t[i] + at, turn * t[i + 1] + at, turn * t[i + 2] + at, solid);
    }
  }
  for (const Vec3f& p : falling_) map.add_point(p, radius_);
  map.finish();
}

void BodyShadows::update(const std::vector<PlacedShape>& bodies, const std::vector<Vec3f>& falling,
                         float radius, const Lighting& lighting) {
  if (bodies_ == bodies && falling_ == falling && radius_ == radius && lighting_ == lighting &&
      ground_.version() != 0)
    return;
  bodies_ = bodies;
  falling_ = falling;
  radius_ = radius;
  lighting_ = lighting;
  find_groups();
  if (bodies.empty() && falling.empty()) return clear(bodies, lighting);
  Vec3f low = Vec3f::Constant(1e30f), high = -low;
  for (std::size_t i = 0; i < bodies.size(); ++i) {
    low = low.cwiseMin(low_[i]);
    high = high.cwiseMax(high_[i]);
  }
  for (const Vec3f& p : falling) {
    low = low.cwiseMin(p);
    high = high.cwiseMax(p);
  }
  ground_.begin(lighting, low, high);
  cast(ground_);
  for (std::size_t g = 0; g < groups_.size(); ++g) {
    Group& group = groups_[g];
    group.shadows = &ground_;
    if (groups_.size() == 1) continue;
    if (g == maps_.size()) maps_.push_back(std::make_unique<ShadowMap>());
    Vec3f group_low = Vec3f::Constant(1e30f), group_high = -group_low;
    for (const std::size_t b : group.bodies) {
      group_low = group_low.cwiseMin(low_[b]);
      group_high = group_high.cwiseMax(high_[b]);
    }
    maps_[g]->begin(lighting, group_low, group_high);
    cast(*maps_[g]);
    group.shadows = maps_[g].get();
  }
}

// An empty map reports everything as lit.
void BodyShadows::clear(const std::vector<PlacedShape>& bodies, const Lighting& lighting) {
  if (bodies_ != bodies) {
    bodies_ = bodies;
    find_groups();
  }
  falling_.clear();
  // A new version of the map would be sent to OpenGL again, for each picture of a depth camera.
  if (ground_.version() == 0 || !ground_.empty()) {
    ground_.begin(lighting, Vec3f::Zero(), Vec3f::Ones());
    ground_.finish();
  }
  for (Group& group : groups_) group.shadows = &ground_;
}

}  // namespace navvy::render
