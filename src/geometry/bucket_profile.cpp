// SPDX-License-Identifier: Apache-2.0
#include "geometry/bucket_profile.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "geometry/bucket_shape.h"
#include "geometry/plane_hull.h"

namespace navvy::geometry {

namespace {

using Segment = std::array<Vec2, 2>;

Vec2 side_view(const Vec3& p) { return {p.x(), p.z()}; }

/// Returns where the triangles cross the plane at y.
std::vector<Segment> section(const TriangleMesh& mesh, double y) {
  std::vector<Segment> out;
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    std::vector<Vec2> ends;
    for (std::size_t i = 0; i < 3; ++i) {
      const Vec3 &a = mesh.corner(t, i), &b = mesh.corner(t, (i + 1) % 3);
      if ((a.y() < y) == (b.y() < y)) continue;
      ends.push_back(side_view(a + (y - a.y()) / (b.y() - a.y()) * (b - a)));
    }
    if (ends.size() == 2) out.push_back({ends[0], ends[1]});
  }
  return out;
}

double distance(const Vec2& p, const Segment& s) {
  const Vec2 along = s[1] - s[0];
  const double length = along.squaredNorm();
  const double at = length > 0 ? std::clamp((p - s[0]).dot(along) / length, 0.0, 1.0) : 0;
  return (s[0] + at * along - p).norm();
}

/// Returns the smallest distance between the middle part of an edge and the section, as a share of
/// the edge's length.
double openness(const Vec2& a, const Vec2& b, const std::vector<Segment>& section) {
  double least = std::numeric_limits<double>::infinity();
  for (const double at : {0.3, 0.4, 0.5, 0.6, 0.7})
    for (const Segment& s : section) least = std::min(least, distance(a + at * (b - a), s));
  return least / (b - a).norm();
}

/// Leaves out points that are within `tolerance` of the line between their neighbours.
void simplify(const std::vector<Vec2>& line, std::size_t first, std::size_t last, double tolerance,
              std::vector<Vec2>& out) {
  double most = 0;
  std::size_t at = first;
  for (std::size_t i = first + 1; i < last; ++i) {
    const double d = distance(line[i], {line[first], line[last]});
    if (d > most) most = d, at = i;
  }
  if (most > tolerance) {
    simplify(line, first, at, tolerance, out);
    simplify(line, at, last, tolerance, out);
  } else {
    out.push_back(line[last]);
  }
}

/// Replaces the points within `reach` of either end by their mean: an edge is a face of the plate
/// or of the bar on it, whose middle is the edge and whose direction means nothing.
std::vector<Vec2> blunted(std::vector<Vec2> line, double reach) {
  for (int end = 0; end < 2; ++end) {
    const Vec2 tip = line.front();
    std::size_t count = 0;
    Vec2 sum = Vec2::Zero();
    while (count + 2 < line.size() && (line[count] - tip).norm() < reach) sum += line[count++];
    if (count > 0) {
      line.erase(line.begin(), line.begin() + static_cast<std::ptrdiff_t>(count) - 1);
      line.front() = sum / static_cast<double>(count);
    }
    std::reverse(line.begin(), line.end());
  }
  return line;
}

}  // namespace

std::optional<BucketProfile> find_bucket_profile(const TriangleMesh& mesh) {
  // A profile of the mesh that is no mouth touches steel, one that is a mouth has none near it.
  constexpr double kOpen = 0.1, kLongMouth = 0.3;
  const Box box = bounds(mesh);
  // Slightly off the middle, where meshes often have vertices.
  const double middle = 0.5 * (box.low.y() + box.high.y()) + 1.3e-3 * (box.high.y() - box.low.y());
  const std::vector<Segment> cut = section(mesh, middle);
  std::vector<Vec2> points;
  for (const Segment& s : cut) points.insert(points.end(), s.begin(), s.end());
  const std::vector<Vec2> hull = plane_hull(points);
  if (hull.size() < 4) return std::nullopt;
  double size = 0;
  for (const Vec2& p : hull) size = std::max(size, (p - hull[0]).norm());
  std::size_t mouth = hull.size();
  double longest = kLongMouth * size;
  for (std::size_t i = 0; i < hull.size(); ++i) {
    const Vec2 &a = hull[i], &b = hull[(i + 1) % hull.size()];
    if ((b - a).norm() <= longest || openness(a, b, cut) < kOpen) continue;
    longest = (b - a).norm();
    mouth = i;
  }
  if (mouth == hull.size()) return std::nullopt;
  std::vector<Vec2> line;
  for (std::size_t i = 1; i <= hull.size(); ++i) line.push_back(hull[(mouth + i) % hull.size()]);
  if (line.front().norm() < line.back().norm()) std::reverse(line.begin(), line.end());
  line = blunted(std::move(line), 0.06 * size);
  BucketProfile out;
  out.points.push_back(line.front());
  simplify(line, 0, line.size() - 1, 0.01 * size, out.points);
  out.y_low = box.low.y();
  out.y_high = box.high.y();
  if (out.points.size() < 3) return std::nullopt;
  return out;
}

TriangleMesh shell_of(const BucketProfile& profile) {
  const Vec2 mouth = 0.5 * (profile.points.front() + profile.points.back());
  const auto at = [](const Vec2& p, double y) { return Vec3(p.x(), y, p.y()); };
  std::vector<Vec3> high, low;
  for (const Vec2& p : profile.points) {
    high.push_back(at(p, profile.y_high));
    low.push_back(at(p, profile.y_low));
  }
  TriangleMesh out = plate_shell(high, low, {at(mouth, profile.y_high), at(mouth, profile.y_low)});
  // The profile may run either way about the inside.
  const Vec2 inside = mouth - 0.1 * opening(profile) * (profile.points[0] - mouth).norm();
  const Vec3 p(inside.x(), 0.5 * (profile.y_low + profile.y_high), inside.y());
  if (out.area_vector(0).dot(p - out.corner(0, 0)) < 0)
    for (auto& t : out.triangles) std::swap(t[1], t[2]);
  return out;
}

double heaped_capacity(const BucketProfile& profile) {
  double area = 0;
  for (std::size_t i = 0; i < profile.points.size(); ++i) {
    const Vec2 &a = profile.points[i], &b = profile.points[(i + 1) % profile.points.size()];
    area += 0.5 * (a.x() * b.y() - a.y() * b.x());
  }
  const double width = profile.y_high - profile.y_low;
  return std::abs(area) * width +
         heap_volume(0, (profile.points.front() - profile.points.back()).norm(), 0.5 * width, 0);
}

Vec2 cut_direction(const BucketProfile& profile) {
  return (profile.points[0] - profile.points[1]).normalized();
}

Vec2 opening(const BucketProfile& profile) {
  const Vec2 along = (profile.points.back() - profile.points.front()).normalized();
  const Vec2 across(along.y(), -along.x());
  double side = 0;
  for (const Vec2& p : profile.points) side += across.dot(p - profile.points.front());
  // The points are on the inner side of the mouth.
  return side > 0 ? Vec2(-across) : across;
}

}  // namespace navvy::geometry
