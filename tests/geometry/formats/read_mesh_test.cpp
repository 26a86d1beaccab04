// SPDX-License-Identifier: Apache-2.0
// Meshes of other programs: axes, units, colors, merged vertices, and files that are broken.
#include "geometry/read_mesh.h"

#include <gtest/gtest.h>

#include <csignal>
#include <cstdint>
#include <cstdlib>
#include <cstring>
#include <fstream>
#include <functional>
#include <stdexcept>
#include <string>
#include <thread>
#include <vector>

#include "core/error.h"
#include "folder.h"
#include "geometry/formats/mesh_builder.h"
#include "geometry/formats/read_in_child.h"
#include "geometry/topology.h"

namespace navvy::geometry {
namespace {

constexpr const char* kStl =
    "solid s\n"
    "facet normal 0 0 1\nouter loop\nvertex 0 0 0\nvertex 2 0 0\nvertex 0 3 0\nendloop\nendfacet\n"
    "facet normal 0 0 1\nouter loop\nvertex 2 0 0\nvertex 2 3 0\nvertex 0 3 0\nendloop\nendfacet\n"
    "endsolid s\n";

/// A red triangle in centimetres, whose node is moved by 100 of them along z.
std::string collada(const std::string& up) {
  return R"(<?xml version="1.0"?>
<COLLADA xmlns="http://www.collada.org/2005/11/COLLADASchema" version="1.4.1">
<asset><unit name="centimeter" meter="0.01"/><up_axis>)" +
         up + R"(</up_axis></asset>
<library_effects><effect id="e"><profile_COMMON><technique sid="t"><lambert>
<diffuse><color>1 0 0 1</color></diffuse></lambert></technique></profile_COMMON></effect>
</library_effects>
<library_materials><material id="red" name="red"><instance_effect url="#e"/></material>
</library_materials>
<library_geometries><geometry id="g"><mesh>
<source id="p"><float_array id="a" count="9">0 0 0 100 0 0 0 200 300</float_array>
<technique_common><accessor source="#a" count="3" stride="3"><param name="X" type="float"/>
<param name="Y" type="float"/><param name="Z" type="float"/></accessor></technique_common></source>
<vertices id="v"><input semantic="POSITION" source="#p"/></vertices>
<triangles count="1" material="m"><input semantic="VERTEX" source="#v" offset="0"/><p>0 1 2</p>
</triangles></mesh></geometry></library_geometries>
<library_visual_scenes><visual_scene id="s"><node id="n"><translate>0 0 100</translate>
<instance_geometry url="#g"><bind_material><technique_common>
<instance_material symbol="m" target="#red"/></technique_common></bind_material>
</instance_geometry></node></visual_scene></library_visual_scenes>
<scene><instance_visual_scene url="#s"/></scene>
</COLLADA>
)";
}

constexpr const char* kGltf = R"({"asset":{"version":"2.0"},"scene":0,"scenes":[{"nodes":[0]}],
"nodes":[{"mesh":0}],"materials":[{"name":"m","pbrMetallicRoughness":
{"baseColorFactor":[0.25,0.5,0.75,1]}}],
"meshes":[{"primitives":[{"attributes":{"POSITION":0},"material":0}]}],
"accessors":[{"bufferView":0,"componentType":5126,"count":3,"type":"VEC3","min":[0,0,0],
"max":[1,2,0]}],"bufferViews":[{"buffer":0,"byteLength":36}],
"buffers":[{"byteLength":36,"uri":"points.bin"}]})";

constexpr const char* kInventor = R"(#Inventor V2.1 ascii
Separator {
  Material { diffuseColor 0 0.5 1 }
  Translation { translation 0 0 2 }
  Coordinate3 { point [ 0 0 0, 1 0 0, 0 1 0, 1 1 0 ] }
  IndexedFaceSet { coordIndex [ 0, 1, 3, 2, -1 ] }
}
)";

constexpr const char* kVrml = R"(#VRML V2.0 utf8
Transform { translation 1 0 0 children Shape {
  appearance Appearance { material Material { diffuseColor 1 1 0 } }
  geometry Box { size 2 4 6 }
} }
)";

class ReadMesh : public testing::Test {
 protected:
  std::string write(const std::string& name, const std::string& bytes) {
    std::ofstream(folder_ / name, std::ios::binary) << bytes;
    return folder_ / name;
  }
  /// Returns the message with which a file is refused; empty if it is not.
  std::string refusal(const std::string& name, const std::string& bytes) {
    try {
      read_mesh(write(name, bytes));
    } catch (const InputError& error) {
      return error.what();
    }
    return "";
  }
  test::Folder folder_;
};

std::string binary_stl(std::uint32_t announced, std::uint32_t held) {
  std::string bytes(80, ' ');
  bytes.append(reinterpret_cast<const char*>(&announced), 4);
  const float corners[12] = {0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 1, 0};
  for (std::uint32_t i = 0; i < held; ++i)
    bytes.append(reinterpret_cast<const char*>(corners), sizeof corners).append(2, '\0');
  return bytes;
}

TEST_F(ReadMesh, StlHasMergedVerticesAndNoColor) {
  const TriangleMesh mesh = read_mesh(write("a.STL", kStl));
  EXPECT_EQ(mesh.triangles.size(), 2u);
  EXPECT_EQ(mesh.vertices.size(), 4u);
  EXPECT_TRUE(mesh.materials.empty());
  EXPECT_EQ(bounds(mesh).high, Vec3(2, 3, 0));
  EXPECT_EQ(read_mesh(write("b.stl", binary_stl(1, 1))).triangles.size(), 1u);
}

TEST_F(ReadMesh, ColladaKeepsAxesUnitAndColorWhateverIsUp) {
  for (const char* up : {"Z_UP", "Y_UP", "X_UP"}) {
    const TriangleMesh mesh = read_mesh(write("a.dae", collada(up)));
    ASSERT_EQ(mesh.triangles.size(), 1u) << up;
    EXPECT_LT((mesh.corner(0, 0) - Vec3(0, 0, 1)).norm(), 1e-6) << up;
    EXPECT_LT((mesh.corner(0, 1) - Vec3(1, 0, 1)).norm(), 1e-6) << up;
    EXPECT_LT((mesh.corner(0, 2) - Vec3(0, 2, 4)).norm(), 1e-6) << up;
    ASSERT_EQ(mesh.materials.size(), 1u);
    EXPECT_EQ(mesh.materials[0].diffuse, (std::array<float, 3>{1, 0, 0}));
    EXPECT_EQ(mesh.material_of.at(0), 0);
  }
}

TEST_F(ReadMesh, GltfIsTurnedZUpAndReadsOnlyBuffersBesideIt) {
  const float points[9] = {0, 0, 0, 1, 0, 0, 0, 2, 0};
  write("points.bin", std::string(reinterpret_cast<const char*>(points), sizeof points));
  const TriangleMesh mesh = read_mesh(write("a.gltf", kGltf));
  ASSERT_EQ(mesh.triangles.size(), 1u);
  // Its y, which is up, is our z.
  EXPECT_LT((mesh.corner(0, 2) - Vec3(0, 0, 2)).norm(), 1e-6);
  EXPECT_NEAR(mesh.materials.at(0).diffuse[1], 0.5, 1e-6);
  std::string outside = kGltf;
  outside.replace(outside.find("points.bin"), 10, "../points.bin");
  std::filesystem::create_directories(folder_ / "below");
  EXPECT_NE(refusal("below/a.gltf", outside), "");
}

TEST_F(ReadMesh, BinaryGltfIsTurnedZUpWithItsColor) {
  const float points[9] = {0, 0, 0, 1, 0, 0, 0, 2, 0};
  std::string json = kGltf;
  const std::string uri = R"(,"uri":"points.bin")";
  json.erase(json.find(uri), uri.size());
  // The chunks of the format are padded to four bytes.
  json.append((4 - json.size() % 4) % 4, ' ');
  const auto number = [](std::size_t value) {
    const auto bits = static_cast<std::uint32_t>(value);
    return std::string(reinterpret_cast<const char*>(&bits), sizeof bits);
  };
  const std::string file =
      write("a.glb", "glTF" + number(2) + number(12 + 8 + json.size() + 8 + sizeof points) +
                         number(json.size()) + "JSON" + json + number(sizeof points) +
                         std::string("BIN\0", 4) +
                         std::string(reinterpret_cast<const char*>(points), sizeof points));
  const TriangleMesh mesh = read_mesh(file);
  ASSERT_EQ(mesh.triangles.size(), 1u);
  EXPECT_LT(mesh.corner(0, 0).norm(), 1e-6);
  EXPECT_LT((mesh.corner(0, 1) - Vec3(1, 0, 0)).norm(), 1e-6);
  // Its y, which is up, is our z.
  EXPECT_LT((mesh.corner(0, 2) - Vec3(0, 0, 2)).norm(), 1e-6);
  ASSERT_EQ(mesh.materials.size(), 1u);
  EXPECT_EQ(mesh.material_of.at(0), 0);
  const float color[3] = {0.25f, 0.5f, 0.75f};
  for (std::size_t i = 0; i < 3; ++i)
    EXPECT_NEAR(mesh.materials[0].diffuse[i], color[i], 1e-6) << i;
}

TEST_F(ReadMesh, InventorAndVrmlKeepPlaceAndColor) {
  const TriangleMesh face = read_mesh(write("a.iv", kInventor));
  EXPECT_EQ(face.triangles.size(), 2u);
  EXPECT_EQ(face.vertices.size(), 4u);
  EXPECT_EQ(bounds(face).low, Vec3(0, 0, 2));
  EXPECT_EQ(face.materials.at(0).diffuse, (std::array<float, 3>{0, 0.5f, 1}));
  const TriangleMesh box = read_mesh(write("a.wrl", kVrml));
  EXPECT_EQ(bounds(box).low, Vec3(0, -2, -3));
  EXPECT_EQ(bounds(box).high, Vec3(2, 2, 3));
  EXPECT_TRUE(is_solid(box));
  EXPECT_EQ(box.materials.at(0).diffuse, (std::array<float, 3>{1, 1, 0}));
}

TEST_F(ReadMesh, ThreadsReadInventorFilesBesideEachOther) {
  const std::string file = write("a.wrl", kVrml);
  std::vector<std::size_t> triangles(4);
  std::vector<std::thread> threads;
  threads.reserve(triangles.size());
  for (std::size_t& count : triangles)
    threads.emplace_back([&count, &file] { count = read_mesh(file).triangles.size(); });
  for (std::thread& thread : threads) thread.join();
  EXPECT_EQ(triangles, (std::vector<std::size_t>{12, 12, 12, 12}));
}

TEST_F(ReadMesh, CountsTheIndicesOfAShapeByItsOwnPoints) {
  const std::string faces = "coordIndex [ 0, 1, 2, -1 ] }\n";
  const std::string points = "[ 0 0 0, 1 0 0, 0 1 0 ]";
  const std::string own =
      "#Inventor V2.1 ascii\nIndexedFaceSet { vertexProperty VertexProperty "
      "{ vertex " +
      points + " } " + faces;
  EXPECT_EQ(read_mesh(write("own.iv", own)).triangles.size(), 1u);
  const std::string weights =
      "#Inventor V2.1 ascii\nSeparator { Coordinate4 { point [ 0 0 0 1, "
      "1 0 0 1, 0 1 0 1 ] } IndexedFaceSet { " +
      faces + "}\n";
  const std::string four = refusal("weights.iv", weights);
  EXPECT_NE(four.find("'Coordinate4': points must have three"), std::string::npos) << four;
  // Found by fuzzing: Coin crashes on a shape without points, also beside one that has some.
  const std::string vrml = "#VRML V2.0 utf8\nShape { geometry IndexedFaceSet { ",
                    coord = "coord Coordinate { point " + points + " } ";
  const std::string none = refusal("none.wrl", vrml + faces + "}\n");
  EXPECT_NE(none.find("below the number of points, 0"), std::string::npos) << none;
  const std::string beside =
      refusal("beside.wrl", vrml + coord + faces + "}\n" + vrml.substr(16) + faces + "}\n");
  EXPECT_NE(beside.find("below the number of points, 0"), std::string::npos) << beside;
}

TEST_F(ReadMesh, BrokenFilesAreRefusedWithLineAndRemedy) {
  const std::string dae = collada("Z_UP");
  const std::string cut = refusal("cut.dae", dae.substr(0, dae.find("<triangles")));
  EXPECT_NE(cut.find("cut.dae:14: error"), std::string::npos) << cut;
  EXPECT_NE(cut.find("'end of the file'"), std::string::npos) << cut;
  EXPECT_NE(cut.find("must end with </COLLADA>"), std::string::npos) << cut;
  EXPECT_NE(cut.find("copy or export it again"), std::string::npos) << cut;
  const std::string ascii = kStl;
  const std::string half = refusal("half.stl", ascii.substr(0, ascii.find("endsolid")));
  EXPECT_NE(half.find("half.stl:16: error"), std::string::npos) << half;
  const std::string few = refusal("few.stl", binary_stl(3, 2));
  EXPECT_NE(few.find("'184 bytes'"), std::string::npos) << few;
  EXPECT_NE(few.find("announces 3 triangles, which take 234 bytes"), std::string::npos) << few;
  const std::string bad =
      refusal("bad.iv", "#Inventor V2.1 ascii\nSeparator {\n Cube { width x }\n}\n");
  EXPECT_NE(bad.find("bad.iv:3: error"), std::string::npos) << bad;
  EXPECT_NE(refusal("text.wrl", "no scene at all\n"), "");
}

TEST_F(ReadMesh, ACrashOfTheLibraryIsAnErrorOfTheFile) {
  std::string dae = collada("Z_UP");
  // Found by fuzzing: release 5.2 of Assimp crashes on it.
  dae.replace(dae.find("count=\"9\""), 5, "uoctn");
  const std::string crash = refusal("a.dae", dae);
  EXPECT_NE(crash.find("a.dae: error"), std::string::npos) << crash;
}

TEST(ReadInChild, PassesOnMeshesFaultsAndFailuresAndOutlivesACrash) {
  TriangleMesh mesh;
  mesh.vertices = {Vec3(0, 0, 0), Vec3(1, 0, 0), Vec3(0, 1, 0)};
  mesh.triangles = {{0, 1, 2}};
  mesh.materials = {{"red", {1, 0, 0}, {0, 0, 1}, 3, 0.5f}};
  mesh.material_of = {0};
  const TriangleMesh same = read_in_child("m", "L", [&] { return mesh; });
  EXPECT_EQ(same.vertices, mesh.vertices);
  EXPECT_EQ(same.triangles, mesh.triangles);
  EXPECT_EQ(same.material_of, mesh.material_of);
  ASSERT_EQ(same.materials.size(), 1u);
  EXPECT_EQ(same.materials[0].name, "red");
  EXPECT_EQ(same.materials[0].specular, mesh.materials[0].specular);
  EXPECT_EQ(same.materials[0].opacity, 0.5f);
  const auto failure = [](const std::function<TriangleMesh()>& read) {
    try {
      read_in_child("m", "L", read);
    } catch (const InputError& error) {
      return std::string(error.what());
    }
    return std::string();
  };
  EXPECT_EQ(failure([]() -> TriangleMesh { refuse_mesh("m", 3, "x", "rule", "remedy"); }),
            "m:3: error: 'x': rule (remedy)");
  EXPECT_EQ(failure([]() -> TriangleMesh { throw std::runtime_error("reason"); }),
            "m: error: L failed: reason (export the mesh again)");
  EXPECT_EQ(
      failure([]() -> TriangleMesh { std::abort(); }),
      "m: error: L, which reads it, has crashed (Aborted) (the file is damaged: copy or export "
      "it again, or export it as OBJ)");
  // More than a pipe holds.
  TriangleMesh large = mesh;
  large.vertices.resize(100000, Vec3(0, 0, 1));
  EXPECT_EQ(read_in_child("m", "L", [&] { return large; }).vertices, large.vertices);
  EXPECT_THROW(read_in_child("m", "L",
                             []() -> TriangleMesh {
                               std::raise(SIGTERM);
                               return {};
                             }),
               Error);
  mesh.triangles[0][2] = 3;
  EXPECT_NE(failure([&] { return mesh; }), "");
}

TEST_F(ReadMesh, FilesWithoutTrianglesAreRefusedAsSuchInEveryFormat) {
  const auto without = [](std::string text, const std::string& from, const std::string& to) {
    const std::size_t at = text.find(from);
    return text.erase(at, text.find(to, at) + to.size() - at);
  };
  const std::string dae = collada("Z_UP");
  std::string no_area = dae, zero = without(dae, "<p>", "</p>");
  no_area.replace(no_area.find("<p>0 1 2"), 8, "<p>0 0 0");
  zero.replace(zero.find("<triangles count=\"1\""), 20, "<triangles count=\"0\"");
  const std::string gltf = R"({"asset":{"version":"2.0"},"scene":0,"scenes":[{"nodes":[0]}],)";
  for (const auto& [name, bytes] :
       {std::pair<std::string, std::string>{"a.stl", "solid s\nendsolid s\n"},
        {"b.stl", "solid s\nfacet\nendsolid s\n"},
        {"c.stl", "solid s\n" + std::string(100, ' ') + "endsolid s\n"},
        {"d.stl", binary_stl(0, 0)},
        {"a.obj", ""},
        {"b.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nl 1 2\n"},
        {"a.dae", without(dae, "<triangles", "</triangles>")},
        {"b.dae", without(dae, "<library_geometries>", "</library_geometries>")},
        {"c.dae", zero},
        {"d.dae", no_area},
        {"a.gltf", gltf + "\"nodes\":[{}]}"},
        {"b.gltf", gltf + R"("nodes":[{"mesh":0}],
"meshes":[{"primitives":[]}]})"},
        {"c.gltf", gltf + R"("nodes":[{"mesh":0}],
"meshes":[{"primitives":[{"attributes":{}}]}]})"},
        {"a.iv", "#Inventor V2.1 ascii\nSeparator { }\n"},
        {"a.wrl", "#VRML V2.0 utf8\nGroup { }\n"}})
    EXPECT_EQ(refusal(name, bytes),
              folder_ / name +
                  ": error: '0 triangles': a mesh needs at least one triangle with an area, and "
                  "this file shows none (export the mesh with its faces, or name another file)");
}

}  // namespace
}  // namespace navvy::geometry
