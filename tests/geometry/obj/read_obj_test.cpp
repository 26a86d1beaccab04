// SPDX-License-Identifier: Apache-2.0
#include "geometry/obj/read_obj.h"

#include <gtest/gtest.h>
#include <sys/stat.h>

#include <filesystem>
#include <string>

#include "core/error.h"
#include "core/file.h"
#include "core/limits.h"
#include "core/log.h"
#include "folder.h"
#include "geometry/solid_properties.h"

namespace navvy::geometry {
namespace {

class ReadObj : public ::testing::Test {
 protected:
  TriangleMesh read(const std::string& text) {
    write_file_atomically(path_, text);
    return read_obj(path_);
  }
  std::string fault(const std::string& text) {
    try {
      read(text);
    } catch (const InputError& error) {
      return error.what();
    }
    return "no fault";
  }
  /// Succeeds if `text` is refused with that line of the file.
  ::testing::AssertionResult refuses(const std::string& text, int line) {
    const std::string found = fault(text);
    if (found.find(path_ + ":" + std::to_string(line) + ":") != std::string::npos)
      return ::testing::AssertionSuccess();
    return ::testing::AssertionFailure() << found;
  }

  test::Folder folder_;
  const std::string path_ = folder_ / "mesh.obj";
};

const std::string kSquare = "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\n";

TEST_F(ReadObj, KeepsVerticesInOrderAndCutsFacesIntoTriangles) {
  const TriangleMesh mesh = read("# a square\n" + kSquare + "v 9 9 9\nf 1 2 3 4\n");
  ASSERT_EQ(mesh.vertices.size(), 5u) << "unused vertices remain";
  EXPECT_EQ(mesh.vertices[2], Vec3(1, 1, 0));
  ASSERT_EQ(mesh.triangles.size(), 2u);
  EXPECT_EQ(mesh.area_vector(0) + mesh.area_vector(1), Vec3(0, 0, 2)) << "the orientation remains";
  EXPECT_TRUE(mesh.material_of.empty());
}

TEST_F(ReadObj, AcceptsBackwardIndicesTextureIndicesAndEveryLineEnd) {
  for (const char* face :
       {"f -4 -3 -2\n", "f 1/1 2/1 3/1\n", "f 1//1 2//1 3//1\n", "f 1/1/1 2/1/1 3/1/1"}) {
    const TriangleMesh mesh = read(kSquare + "vt 0 0\nvn 0 0 1\n" + face);
    ASSERT_EQ(mesh.triangles.size(), 1u) << face;
    EXPECT_EQ(mesh.triangles[0], (std::array<int, 3>{0, 1, 2}));
  }
  std::string dos = kSquare + "f 1 2 3\n";
  for (std::size_t at = dos.find('\n'); at != std::string::npos; at = dos.find('\n', at + 2))
    dos.replace(at, 1, "\r\n");
  EXPECT_EQ(read(dos).triangles.size(), 1u);
  EXPECT_TRUE(refuses(dos + "f 1 2 7\r\n", 6));
}

TEST_F(ReadObj, RoundsToSinglePrecision) {
  const TriangleMesh mesh = read("v 0.1 -1e-3 +2.5\n");
  EXPECT_EQ(mesh.vertices[0], Vec3(0.1f, -1e-3f, 2.5f));
}

TEST_F(ReadObj, GivesEveryTriangleItsMaterial) {
  write_file_atomically(
      folder_ / "paint.mtl",
      "newmtl red\nKd 1 0 0\nKs 0.5 0.5 0.5\nNs 20\nd 0.5\nnewmtl spare\nKd 0 1 0\n");
  const TriangleMesh mesh = read("mtllib paint.mtl\n" + kSquare + "f 1 2 3\nusemtl red\nf 1 3 4\n");
  ASSERT_EQ(mesh.materials.size(), 2u) << "including the unused one";
  EXPECT_EQ(mesh.materials[0].name, "red");
  EXPECT_EQ(mesh.materials[0].diffuse, (std::array<float, 3>{1, 0, 0}));
  EXPECT_EQ(mesh.materials[0].specular, (std::array<float, 3>{0.5f, 0.5f, 0.5f}));
  EXPECT_EQ(mesh.materials[0].shininess, 20);
  EXPECT_EQ(mesh.materials[0].opacity, 0.5f);
  EXPECT_EQ(mesh.material_of, (std::vector<int>{-1, 0}));
}

TEST_F(ReadObj, WarnsOfAMissingMaterialFile) {
  std::string warnings;
  set_log_sink([&](LogLevel level, const std::string& text) {
    if (level == LogLevel::kWarning) warnings += text;
  });
  const TriangleMesh mesh = read("mtllib absent.mtl\n" + kSquare + "usemtl red\nf 1 2 3\n");
  set_log_sink({});
  EXPECT_NE(warnings.find("absent.mtl"), std::string::npos) << warnings;
  EXPECT_EQ(mesh.triangles.size(), 1u);
}

TEST_F(ReadObj, NamesTheLineOfABrokenVertex) {
  EXPECT_TRUE(refuses("v 0 0 0\nv 0 nan 0\n", 2));
  EXPECT_TRUE(refuses("v 0 0 inf\n", 1));
  EXPECT_TRUE(refuses("\nv 0 0\n", 2));
  EXPECT_TRUE(refuses("v 0 zero 0\n", 1));
  EXPECT_TRUE(refuses("v 0 0 1e39\n", 1)) << "beyond single precision";
  EXPECT_TRUE(refuses("v 0 0 1,5\n", 1));
}

TEST_F(ReadObj, NamesTheLineOfABrokenFace) {
  EXPECT_TRUE(refuses(kSquare + "f 1 2 5\n", 5));
  EXPECT_TRUE(refuses(kSquare + "f 0 1 2\n", 5));
  EXPECT_TRUE(refuses(kSquare + "f -5 1 2\n", 5));
  EXPECT_TRUE(refuses(kSquare + "f 1 2\n", 5));
  EXPECT_TRUE(refuses(kSquare + "f one two three\n", 5));
  EXPECT_TRUE(refuses(kSquare + "f 1 2 99999999999999999999\n", 5));
}

TEST_F(ReadObj, ReadsAnEmptyFileAsAnEmptyMeshAndRefusesAMissingOne) {
  EXPECT_TRUE(read("").vertices.empty());
  EXPECT_THROW(read_obj(folder_ / "absent.obj"), FileError);
}

TEST_F(ReadObj, ReadsABodyWithItsVolume) {
  const TriangleMesh tetrahedron =
      read("v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nf 1 3 2\nf 1 2 4\nf 1 4 3\nf 2 3 4\n");
  EXPECT_NEAR(solid_properties(tetrahedron).volume, 1.0 / 6, 1e-15);
}

TEST_F(ReadObj, OpensOnlyRegularMaterialFilesInItsFolder) {
  for (const char* name : {"/dev/zero", "../paint.mtl", "a/../../paint.mtl", "/etc/passwd"})
    EXPECT_NE(fault("mtllib " + std::string(name) + "\n" + kSquare + "f 1 2 3\n")
                  .find("must lie in the folder"),
              std::string::npos)
        << name;
  ASSERT_EQ(::mkfifo((folder_ / "pipe.mtl").c_str(), 0600), 0);
  std::filesystem::create_symlink("/dev/zero", folder_ / "zero.mtl");
  EXPECT_NE(fault("mtllib pipe.mtl\n" + kSquare + "f 1 2 3\n").find("it is a pipe"),
            std::string::npos);
  EXPECT_NE(fault("mtllib zero.mtl\n" + kSquare + "f 1 2 3\n").find("it is a device"),
            std::string::npos);
  write_file_atomically(folder_ / "large.mtl", std::string(limits::kMtlBytes + 1, '#'));
  EXPECT_NE(fault("mtllib large.mtl\n" + kSquare + "f 1 2 3\n").find("more than 1048576 bytes"),
            std::string::npos);
  ASSERT_EQ(::mkfifo((folder_ / "pipe.obj").c_str(), 0600), 0);
  EXPECT_THROW(read_obj(folder_ / "pipe.obj"), InputError);
}

TEST_F(ReadObj, LimitsTheResourcesOfAFile) {
  const auto repeated = [](const std::string& text, std::size_t times) {
    std::string out;
    for (std::size_t i = 0; i < times; ++i) out += text;
    return out;
  };
  EXPECT_TRUE(refuses(kSquare + "f" + repeated(" 1 2 3", 22) + "\n", 5)) << "66 corners";
  EXPECT_TRUE(refuses(kSquare + "# " + std::string(limits::kObjLineBytes, 'x') + "\n", 5));
  EXPECT_TRUE(refuses("v 0 0 1e7\n", 1));
  EXPECT_TRUE(refuses(kSquare + repeated("f 1 2 3\n", limits::kObjTriangles + 1), 1'000'005));
  EXPECT_NE(fault(repeated("v 0 0 0\n", limits::kObjVertices + 1)).find("at most 2000000 vertices"),
            std::string::npos);
  EXPECT_NE(
      fault(repeated("g\n", limits::kObjStatements + 1)).find("at most 100000 lines of groups"),
      std::string::npos);
  EXPECT_NE(fault(repeated("mtllib a.mtl\n", limits::kMtlFiles + 1)).find("at most 16 mtllib"),
            std::string::npos);
  EXPECT_NE(fault(std::string(limits::kObjBytes + 1, '\n')).find("more than 67108864 bytes"),
            std::string::npos);
}

}  // namespace
}  // namespace navvy::geometry
