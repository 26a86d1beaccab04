// SPDX-License-Identifier: Apache-2.0
#include "geometry/formats/read_inventor.h"

#include <Inventor/SoDB.h>
#include <Inventor/SoInput.h>
#include <Inventor/SoPrimitiveVertex.h>
#include <Inventor/actions/SoCallbackAction.h>
#include <Inventor/errors/SoDebugError.h>
#include <Inventor/errors/SoReadError.h>
#include <Inventor/fields/SoMFInt32.h>
#include <Inventor/fields/SoMFNode.h>
#include <Inventor/fields/SoMFVec3f.h>
#include <Inventor/fields/SoSFInt32.h>
#include <Inventor/fields/SoSFNode.h>
#include <Inventor/fields/SoSFShort.h>
#include <Inventor/lists/SoFieldList.h>
#include <Inventor/misc/SoChildList.h>
#include <Inventor/nodes/SoCoordinate4.h>
#include <Inventor/nodes/SoFile.h>
#include <Inventor/nodes/SoSeparator.h>
#include <Inventor/nodes/SoShape.h>

#include <algorithm>
#include <cstdlib>
#include <exception>
#include <initializer_list>
#include <set>
#include <vector>

#include "core/error.h"
#include "core/limits.h"
#include "geometry/formats/mesh_builder.h"
#include "geometry/formats/read_in_child.h"

namespace navvy::geometry {
namespace {

/// Keeps the first message of the library, which would print it otherwise.
void keep_message(const SoError* error, void* into) {
  auto& text = *static_cast<std::string*>(into);
  if (text.empty()) text = error->getDebugString().getString();
}

/// Returns the number after the word "line" in a message of the library; 0 if there is none.
int line_in(const std::string& message) {
  const std::size_t at = message.find("line ");
  return at == std::string::npos ? 0 : std::atoi(message.c_str() + at + 5);
}

/// What the callbacks of one traversal share. Exceptions must not pass through the library.
struct Collected {
  MeshBuilder builder;
  std::exception_ptr failure;
};

/// Returns the product of those fields of a node that hold one whole number; 1 without any.
double product_of(const SoNode& node, std::initializer_list<const char*> names) {
  double product = 1;
  for (const char* name : names) {
    const SoField* field = node.getField(name);
    if (field != nullptr && field->isOfType(SoSFShort::getClassTypeId()))
      product *= static_cast<const SoSFShort*>(field)->getValue();
    if (field != nullptr && field->isOfType(SoSFInt32::getClassTypeId()))
      product *= static_cast<const SoSFInt32*>(field)->getValue();
  }
  return product;
}

/// Returns every node below `root` once, also those in fields: a search leaves out the parts of
/// VRML shapes.
std::vector<const SoNode*> nodes_of(const SoNode& root) {
  std::vector<const SoNode*> nodes;
  std::set<const SoNode*> known;
  const auto add = [&](const SoNode* node) {
    if (node != nullptr && known.insert(node).second) nodes.push_back(node);
  };
  add(&root);
  for (std::size_t at = 0; at < nodes.size(); ++at) {
    const SoNode& node = *nodes[at];
    if (const SoChildList* children = node.getChildren())
      for (int i = 0; i < children->getLength(); ++i) add((*children)[i]);
    SoFieldList fields;
    node.getFields(fields);
    for (int i = 0; i < fields.getLength(); ++i)
      if (fields[i]->isOfType(SoSFNode::getClassTypeId()))
        add(static_cast<const SoSFNode*>(fields[i])->getValue());
      else if (fields[i]->isOfType(SoMFNode::getClassTypeId()))
        for (int k = 0; k < static_cast<const SoMFNode*>(fields[i])->getNum(); ++k)
          add((*static_cast<const SoMFNode*>(fields[i]))[k]);
  }
  return nodes;
}

/// Returns the number of points in a field of a node; 0 if it has no such field.
int points_in(const SoNode& node, const char* name) {
  const SoField* field = node.getField(name);
  if (field == nullptr || !field->isOfType(SoMFVec3f::getClassTypeId())) return 0;
  return static_cast<const SoMFVec3f*>(field)->getNum();
}

/// Returns the number of points to which the indices of a shape refer, with at most `before` points
/// in one node of its file.
int points_of(const SoNode& shape, int before) {
  const auto part = [&](const char* name) -> const SoNode* {
    const SoField* field = shape.getField(name);
    if (field == nullptr || !field->isOfType(SoSFNode::getClassTypeId())) return nullptr;
    return static_cast<const SoSFNode*>(field)->getValue();
  };
  // VRML 2 names the points in the shape; in Inventor they may stand in any node before it.
  if (const SoNode* own = part("vertexProperty"); own != nullptr && points_in(*own, "vertex") > 0)
    return points_in(*own, "vertex");
  if (shape.getField("coord") == nullptr) return before;
  const SoNode* own = part("coord");
  return own == nullptr ? 0 : points_in(*own, "point");
}

/// Refuses numbers by which the library would ask for any amount of memory or time.
void check_nodes(const std::string& path, const SoNode& root) {
  int most = 0;
  const std::vector<const SoNode*> nodes = nodes_of(root);
  for (const SoNode* node : nodes)
    most = std::max({most, points_in(*node, "point"), points_in(*node, "vertex")});
  for (const SoNode* node : nodes) {
    if (node->isOfType(SoFile::getClassTypeId()))
      refuse_mesh(path, 0, "File", "a mesh must be whole in its file", "write the parts into one");
    // Coin crashes when it computes normals from four coordinates.
    if (node->isOfType(SoCoordinate4::getClassTypeId()))
      refuse_mesh(path, 0, "Coordinate4", "points must have three coordinates",
                  "export the mesh with Coordinate3");
    // Copies, and the points of an elevation grid.
    const double copies = product_of(
        *node, {"numElements1", "numElements2", "numElements3", "xDimension", "zDimension"});
    if (copies > limits::kObjTriangles)
      refuse_mesh(path, 0, std::to_string(static_cast<long long>(copies)),
                  "a node may repeat at most " + std::to_string(limits::kObjTriangles) + " parts",
                  "export the mesh with fewer");
    const SoField* indices = node->getField("coordIndex");
    if (indices == nullptr || !indices->isOfType(SoMFInt32::getClassTypeId())) continue;
    const auto& all = *static_cast<const SoMFInt32*>(indices);
    const int points = points_of(*node, most);
    for (int i = 0; i < all.getNum(); ++i)
      if (all[i] < -1 || all[i] >= points)
        refuse_mesh(path, 0, std::to_string(all[i]),
                    "an index of coordIndex must be -1 or below the number of points, " +
                        std::to_string(points));
  }
}

MeshMaterial material_at(SoCallbackAction& action, int index) {
  SbColor ambient, diffuse, specular, emission;
  float shininess = 0, transparency = 0;
  action.getMaterial(ambient, diffuse, specular, emission, shininess, transparency, index);
  MeshMaterial out;
  out.diffuse = {diffuse[0], diffuse[1], diffuse[2]};
  out.specular = {specular[0], specular[1], specular[2]};
  // Inventor scales the exponent of OpenGL to 1.
  out.shininess = 128 * shininess;
  out.opacity = 1 - transparency;
  return out;
}

void add_triangle(void* into, SoCallbackAction* action, const SoPrimitiveVertex* a,
                  const SoPrimitiveVertex* b, const SoPrimitiveVertex* c) {
  auto& collected = *static_cast<Collected*>(into);
  if (collected.failure) return;
  const SbMatrix& X = action->getModelMatrix();
  const auto place = [&](const SoPrimitiveVertex* v) {
    SbVec3f p;
    X.multVecMatrix(v->getPoint(), p);
    return Vec3(p[0], p[1], p[2]);
  };
  try {
    const bool mirrored = X.det3() < 0;
    const int material =
        collected.builder.add_material(material_at(*action, a->getMaterialIndex()));
    collected.builder.add(place(a), place(mirrored ? c : b), place(mirrored ? b : c), material);
  } catch (...) {
    collected.failure = std::current_exception();
  }
}

/// Reads the bytes of a file, in a child process.
TriangleMesh import(const std::string& path, const std::string& bytes) {
  SoDB::init();
  std::string message;
  SoReadError::setHandlerCallback(keep_message, &message);
  SoDebugError::setHandlerCallback(keep_message, &message);
  SoInput input;
  // From memory, so that the library opens no file by itself.
  input.setBuffer(bytes.data(), bytes.size());
  SoSeparator* root = SoDB::readAll(&input);
  if (root != nullptr) root->ref();
  Collected collected{MeshBuilder(path), nullptr};
  if (root != nullptr && message.empty()) {
    try {
      check_nodes(path, *root);
      SoCallbackAction action;
      action.addTriangleCallback(SoShape::getClassTypeId(), add_triangle, &collected);
      action.apply(root);
    } catch (...) {
      collected.failure = std::current_exception();
    }
  }
  if (root == nullptr || !message.empty())
    refuse_mesh(path, line_in(message), "",
                "cannot be read: " + (message.empty() ? "no Inventor or VRML file" : message));
  if (collected.failure) std::rethrow_exception(collected.failure);
  return collected.builder.finish();
}

}  // namespace

// Coin crashes on some damaged files, and is not made for several threads: the child has one.
TriangleMesh read_inventor(const std::string& path) {
  const std::string bytes = mesh_bytes(path);
  return read_in_child(path, "Coin", [&] { return import(path, bytes); });
}

}  // namespace navvy::geometry
