// SPDX-License-Identifier: Apache-2.0
#include "render/shape_cache.h"

#include <Inventor/nodes/SoCoordinate3.h>
#include <Inventor/nodes/SoIndexedFaceSet.h>
#include <Inventor/nodes/SoMaterial.h>
#include <Inventor/nodes/SoSeparator.h>
#include <Inventor/nodes/SoShapeHints.h>

#include <algorithm>
#include <array>
#include <cstdio>

#include "core/error.h"
#include "geometry/read_mesh.h"
#include "render/closed_mesh.h"

namespace navvy::render {
namespace {

struct Look {
  scene::Color color;
  Vec3f specular = Vec3f::Constant(0.12f);
  float shininess = 0.2f;
};

/// Faces of one material over shared points.
struct Part {
  Look look;
  /// Indices in Coin's format: -1 ends a face.
  std::vector<std::int32_t> indices;
};

struct Body {
  std::vector<Vec3f> points;
  std::vector<Part> parts;
};

// Edges flatter than this are drawn round [rad]. 36 deg are more than between the 18 to 28 sides of
// a cylinder (20 deg at most) and less than at its rims.
constexpr float kCrease = 0.62f;

void add_face(Body& body, std::initializer_list<std::int32_t> face) {
  auto& indices = body.parts.back().indices;
  indices.insert(indices.end(), face);
  indices.push_back(-1);
}

// Corners are numbered by bits, so that a face is a list of four numbers. All faces point outwards.
Body box(const Vec3f& size, const Look& look) {
  Body b;
  b.parts.push_back({look, {}});
  for (int k = 0; k < 8; ++k)
    b.points.emplace_back(0.5f * size.x() * ((k & 1) ? 1.f : -1.f),
                          0.5f * size.y() * ((k & 2) ? 1.f : -1.f),
                          0.5f * size.z() * ((k & 4) ? 1.f : -1.f));
  for (const auto& f : {std::array{0, 2, 3, 1},
                        {4, 5, 7, 6},
                        {0, 1, 5, 4},
                        {2, 6, 7, 3},
                        {0, 4, 6, 2},
                        {1, 3, 7, 5}})
    add_face(b, {f[0], f[1], f[2], f[3]});
  return b;
}

/// Cylinder along z, centred.
Body cylinder(float radius, float length, const Look& look, int sides = 28) {
  Body b;
  b.parts.push_back({look, {}});
  // Corners of the side come in pairs, lower and upper; the centres of the two ends follow at 2
  // sides.
  for (int i = 0; i < sides; ++i) {
    const float a = 2 * static_cast<float>(kPi) * static_cast<float>(i) / static_cast<float>(sides);
    for (const float z : {-0.5f, 0.5f})
      b.points.emplace_back(radius * std::cos(a), radius * std::sin(a), z * length);
  }
  b.points.emplace_back(0, 0, -0.5f * length);
  b.points.emplace_back(0, 0, 0.5f * length);
  for (int i = 0; i < sides; ++i) {
    const int a = 2 * i, c = 2 * ((i + 1) % sides);
    add_face(b, {a, c, c + 1, a + 1});
    add_face(b, {2 * sides, c, a});
    add_face(b, {2 * sides + 1, a + 1, c + 1});
  }
  return b;
}

/// Cone along z with its base at -length / 2.
Body cone(float radius, float length, const Look& look, int sides = 28) {
  Body b;
  b.parts.push_back({look, {}});
  for (int i = 0; i < sides; ++i) {
    const float a = 2 * static_cast<float>(kPi) * static_cast<float>(i) / static_cast<float>(sides);
    b.points.emplace_back(radius * std::cos(a), radius * std::sin(a), -0.5f * length);
  }
  b.points.emplace_back(0, 0, -0.5f * length);
  b.points.emplace_back(0, 0, 0.5f * length);
  for (int i = 0; i < sides; ++i) {
    const int next = (i + 1) % sides;
    add_face(b, {sides, next, i});
    add_face(b, {i, next, sides + 1});
  }
  return b;
}

/// Sphere, or with a `length` a capsule along z: two hemispheres at that distance.
Body sphere(float radius, const Look& look, float length = 0) {
  constexpr int kSides = 24, kHalf = 6;
  // A capsule has its widest ring twice, below and above.
  const int rings = 2 * kHalf + (length > 0 ? 1 : 0);
  Body b;
  b.parts.push_back({look, {}});
  for (int r = 0; r <= rings; ++r)
    for (int i = 0; i < kSides; ++i) {
      // All corners of the rings at the poles coincide; their empty triangles are omitted below.
      const int of_sphere = r <= kHalf ? r : r - (rings - 2 * kHalf);
      const double up = kPi * (static_cast<double>(of_sphere) / (2 * kHalf) - 0.5),
                   a = 2 * kPi * i / kSides;
      b.points.push_back(Vec3(radius * std::cos(up) * std::cos(a),
                              radius * std::cos(up) * std::sin(a), radius * std::sin(up))
                             .cast<float>());
      b.points.back().z() += (r <= kHalf ? -0.5f : 0.5f) * length;
    }
  for (int r = 0; r < rings; ++r)
    for (int i = 0; i < kSides; ++i) {
      const int a = r * kSides + i, c = r * kSides + (i + 1) % kSides;
      if (r > 0) add_face(b, {a, c, c + kSides});
      if (r + 1 < rings) add_face(b, {a, c + kSides, a + kSides});
    }
  return b;
}

/// Points and faces of `mesh` in Coin's format, part by part.
Body mesh_body(const geometry::TriangleMesh& mesh, const Vec3f& scale, const Look& plain) {
  Body b;
  for (const Vec3& v : mesh.vertices) b.points.push_back(v.cast<float>().cwiseProduct(scale));
  // Part 0 has the visual's own colour, part k+1 the file's material k.
  b.parts.push_back({plain, {}});
  for (const geometry::MeshMaterial& m : mesh.materials) {
    // Exponents of OpenGL end at 128.
    const auto shine =
        static_cast<float>(std::clamp(static_cast<double>(m.shininess) / 128.0, 0.0, 1.0));
    b.parts.push_back(
        {{{m.diffuse[0], m.diffuse[1], m.diffuse[2], m.opacity}, Vec3f(m.specular.data()), shine},
         {}});
  }
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    const int material = mesh.material_of.empty() ? -1 : mesh.material_of[t];
    auto& indices = b.parts[static_cast<std::size_t>(material + 1)].indices;
    indices.insert(indices.end(), mesh.triangles[t].begin(), mesh.triangles[t].end());
    indices.push_back(-1);
  }
  return b;
}

Body read_body(const std::string& file, const Vec3f& scale, const Look& plain) {
  const geometry::TriangleMesh mesh = geometry::read_mesh(file);
  if (mesh.vertices.empty())
    throw InputError(Fault{Fault::Severity::kError, file, 0, "mesh", "",
                           "a mesh to draw must have vertices", "export the mesh again"});
  return mesh_body(mesh, scale, plain);
}

Body make_body(const scene::Visual& visual) {
  const scene::Geometry& g = visual.geometry;
  const Look look{visual.color, Vec3f::Constant(0.12f), 0.2f};
  switch (g.kind) {
    case scene::Geometry::Kind::kBox:
      return box(g.size.cast<float>(), look);
    case scene::Geometry::Kind::kCylinder:
      return cylinder(static_cast<float>(g.radius), static_cast<float>(g.length), look);
    case scene::Geometry::Kind::kSphere:
      return sphere(static_cast<float>(g.radius), look);
    case scene::Geometry::Kind::kCone:
      return cone(static_cast<float>(g.radius), static_cast<float>(g.length), look);
    case scene::Geometry::Kind::kCapsule:
      return sphere(static_cast<float>(g.radius), look, static_cast<float>(g.length));
    // A plane is drawn as a thin plate of its size.
    case scene::Geometry::Kind::kPlane:
      return box(Vec3(g.size.x(), g.size.y(), 0.002).cast<float>(), look);
    case scene::Geometry::Kind::kMesh:
      break;
  }
  if (g.made) return mesh_body(*g.made, g.scale.cast<float>(), look);
  return read_body(g.mesh_file, g.scale.cast<float>(), look);
}

SoNode* make_node(const Body& body, const std::vector<bool>& solid) {
  auto* root = new SoSeparator;
  // Nodes of Coin begin with a count of 0 and delete themselves when it returns there; the cache
  // gives this reference back.
  root->ref();
  auto* coordinates = new SoCoordinate3;
  coordinates->point.setNum(static_cast<int>(body.points.size()));
  for (std::size_t i = 0; i < body.points.size(); ++i)
    coordinates->point.set1Value(static_cast<int>(i), body.points[i].x(), body.points[i].y(),
                                 body.points[i].z());
  root->addChild(coordinates);
  for (std::size_t k = 0; k < body.parts.size(); ++k) {
    const Part& part = body.parts[k];
    if (part.indices.empty()) continue;
    auto* hints = new SoShapeHints;
    hints->vertexOrdering = SoShapeHints::COUNTERCLOCKWISE;
    // Open parts are lit from both sides; the inner side of solid ones is omitted.
    hints->shapeType = solid[k] ? SoShapeHints::SOLID : SoShapeHints::UNKNOWN_SHAPE_TYPE;
    hints->creaseAngle = kCrease;
    root->addChild(hints);
    auto* material = new SoMaterial;
    const SbColor color(part.look.color.r, part.look.color.g, part.look.color.b);
    material->diffuseColor = color;
    material->ambientColor = color;
    material->specularColor =
        SbColor(part.look.specular.x(), part.look.specular.y(), part.look.specular.z());
    material->shininess = part.look.shininess;
    material->transparency = std::clamp(1.0f - part.look.color.a, 0.0f, 1.0f);
    root->addChild(material);
    auto* faces = new SoIndexedFaceSet;
    faces->coordIndex.setValues(0, static_cast<int>(part.indices.size()), part.indices.data());
    root->addChild(faces);
  }
  return root;
}

Shape make_shape(const Body& body) {
  Shape out;
  std::vector<bool> solid;
  for (const Part& part : body.parts) solid.push_back(is_solid(body.points, part.indices));
  out.node = make_node(body, solid);
  for (std::size_t p = 0; p < body.parts.size(); ++p) {
    const Part& part = body.parts[p];
    std::vector<Vec3f>& triangles = solid[p] ? out.solid_triangles : out.open_triangles;
    std::size_t first = 0;
    for (std::size_t i = 0; i < part.indices.size(); ++i) {
      if (part.indices[i] >= 0) continue;
      // A face with more than three corners is cut into a fan, which is exact for the flat and
      // convex faces made here.
      for (std::size_t k = first + 2; k < i; ++k)
        for (const std::size_t j : {first, k - 1, k})
          triangles.push_back(body.points[static_cast<std::size_t>(part.indices[j])]);
      first = i + 1;
    }
  }
  if (!body.points.empty()) out.low = out.high = body.points.front();
  for (const Vec3f& p : body.points) {
    out.low = out.low.cwiseMin(p);
    out.high = out.high.cwiseMax(p);
  }
  return out;
}

std::string name_of(const scene::Visual& visual) {
  // Appearance as a text key: numbers to the last digit of a float, colours to four digits.
  const scene::Geometry& g = visual.geometry;
  // 400 bytes hold 13 numbers of at most 17 characters.
  char text[400];
  std::snprintf(text, sizeof text,
                "%d %.9g %.9g %.9g %.9g %.9g %.9g %.9g %.9g %.4g %.4g %.4g %.4g ",
                static_cast<int>(g.kind), g.size.x(), g.size.y(), g.size.z(), g.radius, g.length,
                g.scale.x(), g.scale.y(), g.scale.z(), static_cast<double>(visual.color.r),
                static_cast<double>(visual.color.g), static_cast<double>(visual.color.b),
                static_cast<double>(visual.color.a));
  return text + g.mesh_file;
}

}  // namespace

// Stretched bodies are transformed as well, so the corners follow scale and pose.
void PlacedShape::extend(Vec3f& low, Vec3f& high) const {
  for (int k = 0; k < 8; ++k) {
    const Vec3f corner((k & 1) ? shape->high.x() : shape->low.x(),
                       (k & 2) ? shape->high.y() : shape->low.y(),
                       (k & 4) ? shape->high.z() : shape->low.z());
    const Vec3f w = (X_WS * corner.homogeneous()).head<3>();
    low = low.cwiseMin(w);
    high = high.cwiseMax(w);
  }
}

ShapeCache::~ShapeCache() {
  for (auto& [name, shape] : shapes_) shape.node->unref();
}

const Shape& ShapeCache::get(const scene::Visual& visual) {
  const std::string name = name_of(visual);
  const auto found = shapes_.find(name);
  if (found != shapes_.end()) return found->second;
  return shapes_.emplace(name, make_shape(make_body(visual))).first->second;
}

const Shape& ShapeCache::cylinder_along_x(bool rod) {
  const std::string name = rod ? "rod" : "barrel";
  const auto found = shapes_.find(name);
  if (found != shapes_.end()) return found->second;
  Look look{{0.20f, 0.20f, 0.21f, 1}, Vec3f::Constant(0.2f), 0.3f};
  if (rod) look = {{0.72f, 0.74f, 0.77f, 1}, Vec3f::Constant(0.7f), 0.6f};
  Body body = cylinder(1, 1, look, 18);
  // Exchanging the axes in a cycle is a rotation, so the faces still point outwards.
  for (Vec3f& p : body.points) p = Vec3f(p.z() + 0.5f, p.x(), p.y());
  return shapes_.emplace(name, make_shape(body)).first->second;
}

}  // namespace navvy::render
