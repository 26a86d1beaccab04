// SPDX-License-Identifier: Apache-2.0
// Shapes of a scene as heights. Every function depends on the place and the numbers of the feature
// only: there are no tables and no state, so tiles can be made in any order and by any thread.
#include "heightfield/procedural.h"

#include <algorithm>
#include <cmath>

#include "core/random.h"

namespace navvy::heightfield {
namespace {

using scene::GroundFeature;

// Returns the random number in [-0.5, 0.5) of a lattice point.
double lattice(std::int64_t i, std::int64_t j, std::uint64_t seed) {
  // Two rounds, one per coordinate, decorrelate neighbours on the lattice.
  Random random(seed ^ (static_cast<std::uint64_t>(i) * 0x9e3779b97f4a7c15ULL));
  Random second(random.next() ^ (static_cast<std::uint64_t>(j) * 0xc2b2ae3d27d4eb4fULL));
  return second.uniform() - 0.5;
}

// Value noise with continuous curvature, in [-0.5, 0.5) [Perlin 2002, "Improving noise", the
// quintic fade].
double value_noise(double x, double y, std::uint64_t seed) {
  const double fx = std::floor(x), fy = std::floor(y);
  const auto i = static_cast<std::int64_t>(fx), j = static_cast<std::int64_t>(fy);
  const auto fade = [](double t) { return t * t * t * (t * (6 * t - 15) + 10); };
  const double u = fade(x - fx), v = fade(y - fy);
  const double low = (1 - u) * lattice(i, j, seed) + u * lattice(i + 1, j, seed);
  const double high = (1 - u) * lattice(i, j + 1, seed) + u * lattice(i + 1, j + 1, seed);
  return (1 - v) * low + v * high;
}

// Two octaves; a wave is two lattice steps long. The second octave is rotated so that the lattice
// stays invisible.
double hills(const GroundFeature& f, double along, double across) {
  const double x = 2 * along / f.length, y = 2 * across / f.length;
  return f.height * (0.75 * value_noise(x, y, f.seed) +
                     0.25 * value_noise(1.6 * x + 1.2 * y, 1.6 * y - 1.2 * x, ~f.seed));
}

// The floor is flat. Outside it the walls rise with the distance to the rectangle of the floor,
// which rounds their corners.
double trench(const GroundFeature& f, double along, double across) {
  const double du = std::max(std::abs(along) - f.length / 2, 0.0),
               dv = std::max(std::abs(across) - f.width / 2, 0.0);
  const double outside = std::hypot(du, dv);
  if (outside <= 0) return -f.height;
  return f.angle > 0 ? -std::max(0.0, f.height - outside / std::tan(f.angle)) : 0;
}

// Level behind the toe, then a face, then level again; a negative height is a step down.
double bank(const GroundFeature& f, double left) {
  if (left < 0) return 0;
  const bool vertical = f.angle <= 0 || f.angle >= kPi / 2;
  return vertical ? f.height
                  : std::clamp(left * std::tan(f.angle), std::min(f.height, 0.0),
                               std::max(f.height, 0.0));
}

// Returns the height that one feature adds at W (x, y) [m].
double shape(const GroundFeature& f, double friction_angle, double x, double y) {
  const double c = std::cos(f.yaw), s = std::sin(f.yaw), dx = x - f.center.x(),
               dy = y - f.center.y();
  const double along = c * dx + s * dy, across = c * dy - s * dx;
  switch (f.kind) {
    case GroundFeature::Kind::kSlope:
      return std::tan(f.angle) * along;
    case GroundFeature::Kind::kHills:
      return hills(f, along, across);
    case GroundFeature::Kind::kStockpile:
      return std::max(0.0, f.height - std::hypot(along, across) *
                                          std::tan(f.angle > 0 ? f.angle : friction_angle));
    case GroundFeature::Kind::kTrench:
      return trench(f, along, across);
    case GroundFeature::Kind::kBank:
      return bank(f, across);
    case GroundFeature::Kind::kBlock:
      return std::abs(along) <= f.length / 2 && std::abs(across) <= f.width / 2 ? f.height : 0;
  }
  return 0;
}

// A bound suffices: bedrock lies below it by the depth of the scene, so a slightly low value is
// harmless.
double lowest(const GroundFeature& f, const Vec2& min, const Vec2& max) {
  switch (f.kind) {
    case GroundFeature::Kind::kSlope: {
      // A plane is lowest at a corner.
      double low = shape(f, 0, min.x(), min.y());
      for (const Vec2& p : {Vec2(max.x(), min.y()), Vec2(min.x(), max.y()), max})
        low = std::min(low, shape(f, 0, p.x(), p.y()));
      return low;
    }
    case GroundFeature::Kind::kHills:
      return -std::abs(f.height) / 2;
    case GroundFeature::Kind::kTrench:
      return std::min(0.0, -f.height);
    case GroundFeature::Kind::kBank:
    case GroundFeature::Kind::kBlock:
      return std::min(0.0, f.height);
    case GroundFeature::Kind::kStockpile:
      return 0;
  }
  return 0;
}

}  // namespace

ProceduralSurface::ProceduralSurface(const scene::StartGround& ground, double friction_angle)
    : base_(ground.surface), friction_angle_(friction_angle), features_(ground.features) {}

double ProceduralSurface::operator()(double x, double y) const {
  // Summed in the order of the file, so that two builds are bit-identical.
  double z = base_;
  for (const GroundFeature& feature : features_) z += shape(feature, friction_angle_, x, y);
  return z;
}

// Bounds each shape by itself; the sum of the bounds is a bound of the sum.
double ProceduralSurface::lower_bound(const Vec2& min, const Vec2& max) const {
  double z = base_;
  for (const GroundFeature& feature : features_) z += lowest(feature, min, max);
  return z;
}

}  // namespace navvy::heightfield
