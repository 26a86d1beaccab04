// SPDX-License-Identifier: Apache-2.0
#include "geometry/bucket_shape.h"

#include <algorithm>
#include <cmath>

#include "geometry/plane_hull.h"

namespace navvy::geometry {

namespace {

/// Side profile of the shipped excavators' bucket from the cutting edge to the upper edge of the
/// back: x and z in B as shares of the tip radius.
constexpr std::size_t kPoints = 9;
constexpr std::array<std::array<double, 2>, kPoints> kProfile = {{{1, 0},
                                                                  {0.8571, 0.1679},
                                                                  {0.7143, 0.3071},
                                                                  {0.5643, 0.4036},
                                                                  {0.4071, 0.4500},
                                                                  {0.2571, 0.4357},
                                                                  {0.1357, 0.3571},
                                                                  {0.0714, 0.2286},
                                                                  {0.0571, 0.0714}}};
/// Bounds of the factor on the depth (U): flat ditching buckets to deep trenching buckets.
constexpr double kShallowest = 0.5, kDeepest = 1.6;

Vec2 point_of(std::size_t i) { return {kProfile.at(i)[0], kProfile.at(i)[1]}; }

/// The mouth: a line from the cutting edge to the upper edge of the back.
struct Mouth {
  Vec2 edge, along, inward;  ///< the edge [m], and unit vectors along the mouth and into the bucket
  double length;             ///< [m]

  explicit Mouth(const BucketSize& size)
      : edge(size.tip_radius * point_of(0)),
        along(size.tip_radius * point_of(kPoints - 1) - edge),
        length(along.norm()) {
    along /= length;
    inward = Vec2(along.y(), -along.x());
  }
};

/// Returns the profile in coordinates of the mouth: u along it from the edge, v into the bucket
/// [m].
std::vector<Vec2> profile_uv(const BucketSize& size, double depth) {
  const Mouth mouth(size);
  std::vector<Vec2> out;
  for (std::size_t i = 0; i < kPoints; ++i) {
    const Vec2 p = size.tip_radius * point_of(i) - mouth.edge;
    out.emplace_back(p.dot(mouth.along), depth * p.dot(mouth.inward));
  }
  return out;
}

/// Returns half the distance of the middle surfaces of the side plates at u.
double half_width(const BucketSize& size, const Mouth& mouth, double u) {
  return 0.5 * (size.width - size.plate) - size.clearance * u / mouth.length;
}

Vec2 normal_of(const Vec2& a, const Vec2& b) {
  // To the right of the direction of the profile, which is the inside: towards the mouth.
  const Vec2 d = (b - a).normalized();
  return {d.y(), -d.x()};
}

/// Returns the profile moved inwards by `by` along its normals, with mitred corners; negative: out.
std::vector<Vec2> offset(const std::vector<Vec2>& line, double by) {
  std::vector<Vec2> out;
  for (std::size_t i = 0; i < line.size(); ++i) {
    const Vec2 before = i > 0 ? normal_of(line[i - 1], line[i]) : normal_of(line[0], line[1]);
    const Vec2 after = i + 1 < line.size() ? normal_of(line[i], line[i + 1]) : before;
    const Vec2 sum = before + after;
    out.push_back(line[i] + by * 2 / sum.squaredNorm() * sum);
  }
  return out;
}

/// Returns the point of the line through a and b at v = 0.
Vec2 at_mouth(const Vec2& a, const Vec2& b) {
  return {a.x() + (b.x() - a.x()) * a.y() / (a.y() - b.y()), 0};
}

/// Appends bodies between two rings of equally many points; each ring is a flat convex polygon.
class Bodies {
 public:
  explicit Bodies(const BucketSize& size) : size_(size), mouth_(size) {}

  /// A point of the profile at y.
  Vec3 place(const Vec2& uv, double y) const {
    const Vec2 p = mouth_.edge + uv.x() * mouth_.along + uv.y() * mouth_.inward;
    return {p.x(), y, p.y()};
  }
  double half(double u) const { return half_width(size_, mouth_, std::max(u, 0.0)); }

  void add(const std::vector<Vec3>& one, const std::vector<Vec3>& other, int material) {
    const int n = static_cast<int>(one.size()), first = static_cast<int>(mesh_.vertices.size());
    std::vector<std::array<int, 3>> faces;
    for (int i = 0; i < n; ++i) {
      const int j = (i + 1) % n;
      faces.push_back({i, j, n + j});
      faces.push_back({i, n + j, n + i});
      if (i > 1) faces.push_back({0, i, i - 1});
      if (i > 1) faces.push_back({n, n + i - 1, n + i});
    }
    mesh_.vertices.insert(mesh_.vertices.end(), one.begin(), one.end());
    mesh_.vertices.insert(mesh_.vertices.end(), other.begin(), other.end());
    // The rings may run either way; outside is where the volume is positive.
    double volume = 0;
    const auto at = [&](int i) { return mesh_.vertices[static_cast<std::size_t>(first + i)]; };
    for (const auto& f : faces)
      volume += (at(f[0]) - at(0)).dot((at(f[1]) - at(0)).cross(at(f[2]) - at(0)));
    for (auto f : faces) {
      if (volume < 0) std::swap(f[1], f[2]);
      mesh_.triangles.push_back({first + f[0], first + f[1], first + f[2]});
      mesh_.material_of.push_back(material);
    }
  }
  /// Adds a flat body between two heights y.
  void add(const std::vector<Vec2>& xz, double y0, double y1, int material) {
    std::vector<Vec3> one, other;
    for (const Vec2& p : xz) {
      one.emplace_back(p.x(), y0, p.y());
      other.emplace_back(p.x(), y1, p.y());
    }
    add(one, other, material);
  }
  TriangleMesh take() {
    MeshMaterial worn;
    worn.name = "worn";
    worn.diffuse = {0.55f, 0.55f, 0.56f};
    worn.specular = {0.45f, 0.45f, 0.45f};
    worn.shininess = 40;
    mesh_.materials = {worn};
    return std::move(mesh_);
  }

 private:
  const BucketSize& size_;
  Mouth mouth_;
  TriangleMesh mesh_;
};

void add_plates(Bodies& bodies, const BucketSize& size, const std::vector<Vec2>& line) {
  const std::vector<Vec2> inner = offset(line, 0.5 * size.plate);
  const std::vector<Vec2> outer = offset(line, -0.5 * size.plate);
  for (std::size_t i = 0; i + 1 < line.size(); ++i) {
    std::vector<Vec3> left, right;
    for (const Vec2& p : {inner[i], inner[i + 1], outer[i + 1], outer[i]}) {
      left.push_back(bodies.place(p, bodies.half(p.x())));
      right.push_back(bodies.place(p, -bodies.half(p.x())));
    }
    bodies.add(left, right, -1);
  }
  for (const double side : {-1.0, 1.0}) {
    std::vector<Vec3> inside, outside;
    for (const Vec2& p : line) {
      inside.push_back(bodies.place(p, side * (bodies.half(p.x()) - 0.5 * size.plate)));
      outside.push_back(bodies.place(p, side * (bodies.half(p.x()) + 0.5 * size.plate)));
    }
    bodies.add(inside, outside, -1);
  }
}

/// Adds the bar of the cutting edge and the teeth, which end `length` ahead of the edge.
void add_edge(Bodies& bodies, const BucketSize& size, const Vec3& cut, const DrawnTeeth& teeth) {
  const Vec2 edge(size.tip_radius, 0), ahead(cut.x(), cut.z()), up(-ahead.y(), ahead.x());
  const double bar = 0.12 * size.tip_radius, thick = size.plate;
  const auto section = [&](double back, double front, double root, double tip) {
    return std::vector<Vec2>{
        Vec2(edge - back * ahead - root * up), Vec2(edge - back * ahead + root * up),
        Vec2(edge + front * ahead + tip * up), Vec2(edge + front * ahead - tip * up)};
  };
  bodies.add(section(bar, 0, 0.8 * thick, 0.6 * thick), -0.5 * size.width, 0.5 * size.width, 0);
  const double between = teeth.number > 1 ? (size.width - teeth.width) / (teeth.number - 1) : 0;
  for (int i = 0; i < teeth.number; ++i) {
    const double y = (i - 0.5 * (teeth.number - 1)) * between;
    bodies.add(section(bar, teeth.length, 1.3 * thick, 0.3 * thick), y - 0.5 * teeth.width,
               y + 0.5 * teeth.width, 0);
  }
}

void add_ears(Bodies& bodies, const BucketSize& size, const std::vector<Vec2>& line,
              const std::vector<Vec2>& pins) {
  std::vector<Vec2> points;
  const auto circle = [&](const Vec2& middle) {
    for (int i = 0; i < 16; ++i)
      points.push_back(middle + 0.065 * size.tip_radius *
                                    Vec2(std::cos(i * kPi / 8), std::sin(i * kPi / 8)));
  };
  circle(Vec2::Zero());
  for (const Vec2& pin : pins) circle(pin);
  for (std::size_t i = line.size() - 4; i < line.size(); ++i) {
    const Vec3 p = bodies.place(line[i], 0);
    points.emplace_back(p.x(), p.z());
  }
  const std::vector<Vec2> outline = plane_hull(points);
  const double y = std::min(0.19 * size.tip_radius, 0.32 * size.width), thick = 1.3 * size.plate;
  for (const double side : {-1.0, 1.0})
    bodies.add(outline, side * y - 0.5 * thick, side * y + 0.5 * thick, -1);
}

}  // namespace

double heap_volume(double u0, double u1, double half, double slope) {
  // Distances from a side are shorter than across by this factor.
  const double c = 1 / std::hypot(1.0, slope);
  constexpr int kSlices = 2000;
  const double step = (u1 - u0) / kSlices;
  double sum = 0;
  for (int i = 0; i < kSlices; ++i) {
    const double u = u0 + (i + 0.5) * step, h = half - slope * u;
    const double d = std::min(u - u0, u1 - u);
    // Across the mouth, the heap rises to d, or to a ridge in the middle.
    sum += h * c > d ? 2 * d * h - d * d / c : h * h * c;
  }
  return sum * step;
}

double heaped_capacity(const BucketSize& size, double depth) {
  const Mouth mouth(size);
  std::vector<Vec2> inside = offset(profile_uv(size, depth), 0.5 * size.plate);
  inside.front() = at_mouth(inside[0], inside[1]);
  inside.back() = at_mouth(inside[inside.size() - 2], inside.back());
  const double slope = size.clearance / mouth.length;
  const double half = half_width(size, mouth, 0) - 0.5 * size.plate * std::hypot(1.0, slope);
  const double u0 = inside.front().x(), u1 = inside.back().x();
  if (!(u1 > u0) || !(half - slope * u1 > 0)) return 0;
  // Area of the profile and its moment about u = 0, by the corners of a polygon.
  double area = 0, moment = 0;
  for (std::size_t i = 0; i < inside.size(); ++i) {
    const Vec2 &a = inside[i], &b = inside[(i + 1) % inside.size()];
    const double cross = a.x() * b.y() - a.y() * b.x();
    area += cross / 2;
    moment += cross * (a.x() + b.x()) / 6;
  }
  return 2 * std::abs(half * area - slope * moment) + heap_volume(u0, u1, half, slope);
}

std::array<double, 2> heaped_capacities(const BucketSize& size) {
  const double least = heaped_capacity(size, kShallowest), most = heaped_capacity(size, kDeepest);
  if (!(least > 0) || !(most > least)) return {0, 0};
  return {least, most};
}

double depth_for(const BucketSize& size, double capacity) {
  double low = kShallowest, high = kDeepest;
  // 50 halvings are exact to the last bits; the capacity grows with the depth.
  for (int i = 0; i < 50; ++i) {
    const double middle = 0.5 * (low + high);
    (heaped_capacity(size, middle) < capacity ? low : high) = middle;
  }
  return 0.5 * (low + high);
}

TriangleMesh bucket_shell(const BucketSize& size, double depth) {
  const std::vector<Vec2> line = profile_uv(size, depth);
  const Bodies bodies(size);
  const auto at = [&](const Vec2& p, double side) {
    return bodies.place(p, side * bodies.half(p.x()));
  };
  std::vector<Vec3> left, right;
  for (const Vec2& p : line) {
    left.push_back(at(p, 1));
    right.push_back(at(p, -1));
  }
  const Vec2 middle(0.5 * line.back().x(), 0);
  return plate_shell(left, right, {at(middle, 1), at(middle, -1)});
}

TriangleMesh plate_shell(const std::vector<Vec3>& left, const std::vector<Vec3>& right,
                         const std::array<Vec3, 2>& middles) {
  TriangleMesh out;
  out.vertices = left;
  out.vertices.insert(out.vertices.end(), right.begin(), right.end());
  // From the middle of the mouth the triangles of a side plate have no small angles.
  out.vertices.insert(out.vertices.end(), middles.begin(), middles.end());
  const int n = static_cast<int>(left.size());
  for (int i = 0; i + 1 < n; ++i) {
    out.triangles.push_back({i, n + i + 1, i + 1});
    out.triangles.push_back({i, n + i, n + i + 1});
    out.triangles.push_back({2 * n, i, i + 1});
    out.triangles.push_back({2 * n + 1, n + i + 1, n + i});
  }
  return out;
}

Vec3 cut_direction(const BucketSize& size, double depth) {
  const std::vector<Vec2> line = profile_uv(size, depth);
  const Bodies bodies(size);
  return (bodies.place(line[0], 0) - bodies.place(line[1], 0)).normalized();
}

TriangleMesh bucket_picture(const BucketSize& size, double depth, const DrawnTeeth& teeth,
                            const std::vector<Vec2>& pins) {
  const std::vector<Vec2> line = profile_uv(size, depth);
  Bodies bodies(size);
  add_plates(bodies, size, line);
  add_edge(bodies, size, cut_direction(size, depth), teeth);
  add_ears(bodies, size, line, pins);
  return bodies.take();
}

}  // namespace navvy::geometry
