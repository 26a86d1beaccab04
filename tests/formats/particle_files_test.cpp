// SPDX-License-Identifier: Apache-2.0
// Every format of particles is read back by an independent reader: NumPy, VTK, and Python's struct
// for PLY. Values differ in every element, so that a wrong order, stride or type is detected.
#include "formats/particle_files.h"

#include <gtest/gtest.h>

#include <filesystem>
#include <nlohmann/json.hpp>

#include "core/error.h"
#include "core/file.h"
#include "folder.h"
#include "formats/pvd_index.h"
#include "heightfield/maps.h"

namespace navvy::formats {
namespace {

using heightfield::testing::output_of;
using heightfield::testing::write_text;

/// Returns a table of `count` particles, whose values a reader computes as `expected` in kExpected.
scene::ParticleTable example(std::size_t count) {
  scene::ParticleTable out;
  out.time = 0.1;
  out.steps = 50;
  out.soils = {{"loam", 1540}, {"s\u00e4nd <&>", 1650.5}};
  out.resize(count);
  // Members as arrays see them: element k of the table is (k + 1) / 7 plus the array's number.
  double number = 0;
  const auto fill = [&](auto& values) {
    for (std::size_t k = 0; k < values.size(); ++k)
      values[k] =
          static_cast<std::decay_t<decltype(values[k])>>(number + static_cast<double>(k + 1) / 7);
    ++number;
  };
  fill(out.id), fill(out.position), fill(out.velocity), fill(out.mass), fill(out.soil);
  fill(out.volume_ratio), fill(out.density), fill(out.density_state), fill(out.plastic_shear);
  fill(out.stress), fill(out.velocity_gradient);
  return out;
}

/// Python: names, types and widths of the arrays in their order, and their expected values.
const char* const kExpected = R"(
import json, sys
import numpy as np
NAMES = ['id', 'position', 'velocity', 'mass', 'soil', 'volume_ratio', 'density', 'density_state',
         'plastic_shear', 'stress', 'velocity_gradient']
TYPES = ['u4', 'f8', 'f4', 'f8', 'u2', 'f4', 'f4', 'f4', 'f4', 'f4', 'f4']
WIDTHS = [1, 3, 3, 1, 1, 1, 1, 1, 1, 6, 9]
def expected(i, count):
    k = np.arange(count * WIDTHS[i], dtype=float)
    out = (i + (k + 1) / 7).astype(TYPES[i])
    return out.reshape(count, WIDTHS[i]) if WIDTHS[i] > 1 else out
count = int(sys.argv[2])
)";

bool has_module(const std::string& name) {
  return std::system(("/usr/bin/python3 -c 'import " + name + "' >/dev/null 2>&1").c_str()) == 0;
}

/// Returns the last line that the Python `script` prints for a file with `count` particles.
std::string read_by(const test::Folder& folder, const std::string& script, const std::string& file,
                    std::size_t count) {
  write_text(folder / "read.py", kExpected + script);
  return output_of("/usr/bin/python3 '" + folder / "read.py" + "' '" + file + "' " +
                   std::to_string(count) + " 2>&1");
}

class ParticleFiles : public testing::TestWithParam<std::size_t> {};
INSTANTIATE_TEST_SUITE_P(Counts, ParticleFiles, testing::Values(0, 1, 40'000));

TEST_P(ParticleFiles, NpzIsReadByNumPy) {
  if (!has_module("numpy")) GTEST_SKIP() << "NumPy for /usr/bin/python3 is missing";
  const test::Folder folder;
  particle_format_named("npz").write(example(GetParam()), folder / "p.npz");
  EXPECT_EQ(read_by(folder, R"(
f = np.load(sys.argv[1])
head = json.loads(f['header.json'])
assert head['count'] == count and head['time_s'] == 0.1 and head['steps'] == 50, head
assert head['soils'][1] == {'name': 's\u00e4nd <&>', 'bank_density_kg_m3': 1650.5}, head
assert list(head['arrays']) == NAMES
for i, name in enumerate(NAMES):
    want = expected(i, count)
    if name == 'velocity_gradient': want = want.reshape(count, 3, 3)
    assert f[name].dtype == want.dtype and f[name].shape == want.shape, name
    assert (f[name] == want).all(), name
    assert head['arrays'][name]['type'] == want.dtype.name, name
print('good')
)",
                    folder / "p.npz", GetParam()),
            "good\n");
}

TEST_P(ParticleFiles, PlyHasAPropertyPerElement) {
  if (!has_module("numpy")) GTEST_SKIP() << "NumPy for /usr/bin/python3 is missing";
  const test::Folder folder;
  particle_format_named("ply").write(example(GetParam()), folder / "p.ply");
  EXPECT_EQ(read_by(folder, R"(
data = open(sys.argv[1], 'rb').read()
at = data.index(b'end_header\n') + 11
lines = data[:at].decode().split('\n')
assert lines[:2] == ['ply', 'format binary_little_endian 1.0']
assert 'comment time_s 0.1' in lines and 'comment unit density kg/m3' in lines
assert 'comment soil 1 bank_density_kg_m3 1650.5 name s\u00e4nd <&>' in lines, lines
assert 'element vertex %d' % count in lines
kinds = {'double': 'f8', 'float': 'f4', 'uint': 'u4', 'ushort': 'u2'}
fields = [(l.split()[2], '<' + kinds[l.split()[1]]) for l in lines if l.startswith('property')]
assert [name for name, _ in fields[:5]] == ['id', 'x', 'y', 'z', 'velocity_x'], fields
rows = np.frombuffer(data[at:], np.dtype(fields))
assert len(rows) == count
column = 0
for i, width in enumerate(WIDTHS):
    want = expected(i, count).reshape(count, width)
    for k in range(width):
        assert rows[fields[column][0]].dtype == TYPES[i]
        assert (rows[fields[column][0]] == want[:, k]).all(), fields[column]
        column += 1
assert column == len(fields)
print('good')
)",
                    folder / "p.ply", GetParam()),
            "good\n");
}

TEST_P(ParticleFiles, VtuIsReadByVtk) {
  if (!has_module("numpy") || !has_module("vtkmodules.vtkIOXML"))
    GTEST_SKIP() << "NumPy or VTK for /usr/bin/python3 is missing (python3-vtk9)";
  const test::Folder folder;
  particle_format_named("vtu").write(example(GetParam()), folder / "p.vtu");
  EXPECT_EQ(read_by(folder, R"(
from vtkmodules.vtkIOXML import vtkXMLUnstructuredGridReader
from vtkmodules.util.numpy_support import vtk_to_numpy
reader = vtkXMLUnstructuredGridReader()
reader.SetFileName(sys.argv[1])
reader.Update()
assert reader.GetErrorCode() == 0
grid = reader.GetOutput()
assert grid.GetNumberOfPoints() == count and grid.GetNumberOfCells() == count
for k in {0, count // 2, count - 1} if count else ():
    assert grid.GetCellType(k) == 1 and grid.GetCell(k).GetPointId(0) == k
points = vtk_to_numpy(grid.GetPoints().GetData()) if count else np.zeros((0, 3))
assert (points == expected(1, count)).all()
data = grid.GetPointData()
for i, name in enumerate(NAMES):
    if name == 'position': continue
    array = data.GetArray(name)
    got = vtk_to_numpy(array)
    want = expected(i, count)
    assert got.dtype == want.dtype and (got.reshape(want.shape) == want).all(), name
assert data.GetArray('stress').GetComponentName(5) == 'xz'
assert data.GetArray('density').GetInformation().Get(array.UNITS_LABEL()) == 'kg/m3'
fields = grid.GetFieldData()
assert fields.GetArray('TimeValue').GetValue(0) == 0.1
assert fields.GetArray('steps').GetValue(0) == 50
assert fields.GetArray('soil_bank_density').GetValue(1) == 1650.5
names = fields.GetAbstractArray('soil_names')
assert [names.GetValue(i) for i in range(2)] == ['loam', 's\u00e4nd <&>']
print('good')
)",
                    folder / "p.vtu", GetParam()),
            "good\n");
}

TEST(ParticleFormats, AreNamedByTheEndingOfTheFile) {
  EXPECT_EQ(particle_format_of("a/b.npz", "--out").name, "npz");
  EXPECT_EQ(particle_format_of("b.vtu", "--out").name, "vtu");
  EXPECT_EQ(particle_format_of("b.ply", "--out").name, "ply");
  const auto refused = [](const auto& call) -> std::string {
    try {
      call();
    } catch (const InputError& error) {
      return error.what();
    }
    return "";
  };
  for (const char* path : {"b.vtk", "npz", "b", "b.npz/"}) {
    const std::string text = refused([&] { particle_format_of(path, "--out"); });
    EXPECT_NE(text.find(".npz, .vtu, .ply"), std::string::npos) << text;
    EXPECT_NE(text.find(path), std::string::npos) << text;
  }
  EXPECT_NE(refused([] { particle_format_named("vtk"); }).find("did you mean 'vtu'?"),
            std::string::npos);
  EXPECT_EQ(particle_format_names(), "npz, vtu or ply");
}

TEST(ParticleFormats, LeaveTheOldFileWhereTheNewOneCannotBeWritten) {
  const test::Folder folder;
  for (const ParticleFormat& format : particle_formats()) {
    EXPECT_THROW(format.write(example(3), folder / ("no/such/folder/p" + format.extension)),
                 FileError);
    std::filesystem::create_directories(folder.path() / ("p" + format.extension));
    EXPECT_THROW(format.write(example(3), folder / ("p" + format.extension)), FileError);
    // The same table gives the same bytes.
    for (const char* name : {"a", "b"}) format.write(example(3), folder / name);
    EXPECT_EQ(read_file(folder / "a"), read_file(folder / "b")) << format.name;
  }
  for (const auto& entry : std::filesystem::directory_iterator(folder.path()))
    EXPECT_EQ(entry.path().string().find(".part"), std::string::npos) << entry.path();
}

TEST(ParticleTable, RefusesUnknownQuantitiesWithTheNearestName) {
  EXPECT_EQ(example(2).arrays({"mass", "id"})[0].bytes.size(), 16u);
  try {
    example(2).arrays({"mass", "densty"});
    FAIL();
  } catch (const InputError& error) {
    EXPECT_NE(std::string(error.what()).find("did you mean 'density'?"), std::string::npos)
        << error.what();
  }
}

TEST(PvdIndex, IsCompleteAfterEveryEntry) {
  const test::Folder folder;
  write_text(folder / "p.pvd", std::string(10'000, 'x'));
  PvdIndex index(folder / "p.pvd");
  std::string entries;
  for (int i = 0; i < 3; ++i) {
    const std::string name = "p_" + std::to_string(i) + ".vtu";
    index.add(0.1 * i, name);
    entries += "<DataSet timestep=\"" + nlohmann::json(0.1 * i).dump() + "\" part=\"0\" file=\"" +
               name + "\"/>\n";
    const std::vector<char> bytes = read_file(folder / "p.pvd");
    EXPECT_EQ(std::string(bytes.begin(), bytes.end()),
              "<?xml version=\"1.0\"?>\n<VTKFile type=\"Collection\" version=\"0.1\" "
              "byte_order=\"LittleEndian\">\n<Collection>\n" +
                  entries + "</Collection>\n</VTKFile>\n");
  }
  EXPECT_THROW(PvdIndex(folder / "no/p.pvd").add(0, "a"), FileError);
}

}  // namespace
}  // namespace navvy::formats
