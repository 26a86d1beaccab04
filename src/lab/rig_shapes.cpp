// SPDX-License-Identifier: Apache-2.0
#include "lab/rig_shapes.h"

#include <cmath>
#include <utility>

#include "core/math.h"

namespace navvy::lab {

scene::Shell open_box(double length, double width, double height) {
  scene::Shell s;
  s.name = "box";
  // Corners counter-clockwise from above, floor first; triangles are counter-clockwise seen from
  // inside.
  const double x = length / 2, y = width / 2, h = height;
  s.vertices = {{-x, -y, 0}, {x, -y, 0}, {x, y, 0}, {-x, y, 0},
                {-x, -y, h}, {x, -y, h}, {x, y, h}, {-x, y, h}};
  s.triangles = {{0, 1, 2}, {0, 2, 3}, {0, 4, 5}, {0, 5, 1}, {1, 5, 6},
                 {1, 6, 2}, {2, 6, 7}, {2, 7, 3}, {3, 7, 4}, {3, 4, 0}};
  return s;
}

// Bodies and vessels share corners; only the front side differs.
scene::Shell closed_box(double length, double width, double height) {
  scene::Shell s = open_box(length, width, height);
  s.name = "block";
  // The lid, then all triangles reversed: from a vessel to a body.
  s.triangles.insert(s.triangles.end(), {{4, 7, 6}, {4, 6, 5}});
  for (auto& triangle : s.triangles) std::swap(triangle[1], triangle[2]);
  return s;
}

scene::Shell blade(double width, double height, double rake) {
  scene::Shell s;
  s.name = "blade";
  // The cutting edge is at z = 0; the upper edge leans back by the cotangent of the rake.
  const double y = width / 2, top = -height / std::tan(rake);
  s.vertices = {{0, -y, 0}, {0, y, 0}, {top, y, height}, {top, -y, height}};
  s.triangles = {{0, 1, 2}, {0, 2, 3}};
  return s;
}

scene::Shell plate(double length, double width) {
  scene::Shell s;
  // The front faces up; soil may touch either side.
  s.name = "plate";
  const double x = length / 2, y = width / 2;
  s.vertices = {{-x, -y, 0}, {x, -y, 0}, {x, y, 0}, {-x, y, 0}};
  s.triangles = {{0, 1, 2}, {0, 2, 3}};
  return s;
}

scene::Shell channel(double length, double gap, double bottom, double top, bool back) {
  scene::Shell s;
  s.name = "channel";
  // Odd indices are the upper ends; plate y = 0 first.
  s.vertices = {{length, 0, bottom}, {length, 0, top}, {0, 0, bottom},        {0, 0, top},
                {0, gap, bottom},    {0, gap, top},    {length, gap, bottom}, {length, gap, top}};
  s.triangles = {{0, 3, 1}, {0, 2, 3}, {4, 7, 5}, {4, 6, 7}};
  // Without a back the soil can leave at both ends.
  if (back) s.triangles.insert(s.triangles.end(), {{2, 5, 3}, {2, 4, 5}});
  return s;
}

scene::Shell tube(double radius, double bottom, double top, int sides) {
  scene::Shell s;
  s.name = "tube";
  for (int i = 0; i < sides; ++i) {
    const double angle = 2 * kPi * i / sides;
    // Inscribed: corners lie on the radius, facets a little inside it.
    s.vertices.emplace_back(radius * std::cos(angle), radius * std::sin(angle), bottom);
    s.vertices.emplace_back(radius * std::cos(angle), radius * std::sin(angle), top);
  }
  for (int i = 0; i < sides; ++i) {
    // The last facet closes the ring.
    // Normals point at the axis.
    const int a = 2 * i, b = 2 * ((i + 1) % sides);
    s.triangles.push_back({a, b + 1, b});
    s.triangles.push_back({a, a + 1, b + 1});
  }
  return s;
}

scene::Shell drum(double radius, double width, int sides) {
  scene::Shell s;
  s.name = "drum";
  // The two hubs, then pairs around the rim.
  s.vertices = {{0, -width / 2, 0}, {0, width / 2, 0}};
  for (int i = 0; i < sides; ++i) {
    const double angle = 2 * kPi * i / sides;
    // Pairs across the width, as many as facets.
    for (const double y : {-width / 2, width / 2})
      s.vertices.emplace_back(radius * std::cos(angle), y, radius * std::sin(angle));
  }
  for (int i = 0; i < sides; ++i) {
    // At -y; their partners at +y are the next index.
    const int a = 2 + 2 * i, b = 2 + 2 * ((i + 1) % sides);
    // Two for the tread, one for either side.
    s.triangles.push_back({a, b, b + 1});
    s.triangles.push_back({a, b + 1, a + 1});
    s.triangles.push_back({0, b, a});
    s.triangles.push_back({1, a + 1, b + 1});
  }
  return s;
}

}  // namespace navvy::lab
