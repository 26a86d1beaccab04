// SPDX-License-Identifier: Apache-2.0
// Particles as VTK's XML unstructured grid (VTU), which ParaView reads: a vertex per particle, a
// point array per quantity, appended as raw bytes.
#include <algorithm>
#include <cstdint>
#include <nlohmann/json.hpp>
#include <string>
#include <string_view>
#include <vector>

#include "formats/part_file.h"
#include "formats/particle_files.h"

namespace navvy::formats {
namespace {

const char* type_of(scene::ParticleElement type) {
  switch (type) {
    case scene::ParticleElement::kUint16:
      return "UInt16";
    case scene::ParticleElement::kUint32:
      return "UInt32";
    case scene::ParticleElement::kFloat32:
      return "Float32";
    case scene::ParticleElement::kFloat64:
      break;
  }
  return "Float64";
}

/// Writes the header of a file and reserves the places of its appended arrays.
class Header {
 public:
  /// Adds an element whose `bytes` are appended; `attributes` describe it.
  void appended(const std::string& attributes, std::uint64_t bytes, const std::string& unit = "") {
    text_ += "<DataArray " + attributes + " format=\"appended\" offset=\"" +
             std::to_string(offset_) + "\"";
    text_ += unit.empty() ? "/>\n"
                          : ">\n<InformationKey name=\"UNITS_LABEL\" location=\"vtkDataArray\">" +
                                unit + "</InformationKey>\n</DataArray>\n";
    // Each array follows its length.
    offset_ += sizeof(std::uint64_t) + bytes;
  }
  void add(const std::string& text) { text_ += text; }
  const std::string& text() const { return text_; }

 private:
  std::string text_;
  std::uint64_t offset_ = 0;
};

/// Returns a text as numbers of its bytes with a 0 at its end, as VTK writes strings.
std::string bytes_of(std::string_view text) {
  std::string out;
  // VTK reads each number as a signed character.
  for (const char c : text) out += std::to_string(static_cast<signed char>(c)) + " ";
  return out + "0 ";
}

/// Adds time, step number and soils, which ParaView shows as field data.
void add_fields(Header& head, const scene::ParticleTable& particles) {
  const auto number = [](double value) { return nlohmann::json(value).dump(); };
  std::string names, densities;
  for (const scene::ParticleSoil& soil : particles.soils) {
    names += bytes_of(soil.name);
    densities += number(soil.bank_density) + " ";
  }
  const std::string soils =
      " NumberOfTuples=\"" + std::to_string(particles.soils.size()) + "\" format=\"ascii\">";
  head.add(
      "<FieldData>\n<DataArray type=\"Float64\" Name=\"TimeValue\" NumberOfTuples=\"1\" "
      "format=\"ascii\">" +
      number(particles.time) +
      "</DataArray>\n<DataArray type=\"UInt64\" Name=\"steps\" NumberOfTuples=\"1\" "
      "format=\"ascii\">" +
      std::to_string(particles.steps) +
      "</DataArray>\n<DataArray type=\"Float64\" Name=\"soil_bank_density\"" + soils + densities +
      "</DataArray>\n<Array type=\"String\" Name=\"soil_names\"" + soils + names +
      "</Array>\n</FieldData>\n");
}

/// Returns the attributes of a point array.
std::string attributes_of(const scene::ParticleArray& array) {
  std::string out = std::string("type=\"") + type_of(array.type) + "\" Name=\"" + array.name +
                    "\" NumberOfComponents=\"" + std::to_string(array.width()) + "\"";
  for (std::size_t i = 0; i < array.components.size(); ++i)
    out += " ComponentName" + std::to_string(i) + "=\"" + array.components[i] + "\"";
  return out;
}

void write_bytes(PartFile& file, const void* data, std::uint64_t size) {
  file.write(&size, sizeof size);
  if (size > 0) file.write(data, size);
}

/// Appends 32-bit numbers: the first is `first`, and each further one is greater by 1.
void write_count(PartFile& file, std::int32_t first, std::size_t count) {
  std::vector<std::int32_t> numbers(count);
  for (std::size_t i = 0; i < count; ++i) numbers[i] = first + static_cast<std::int32_t>(i);
  write_bytes(file, numbers.data(), sizeof(std::int32_t) * count);
}

void write_vtu(const scene::ParticleTable& particles, const std::string& path) {
  const std::uint64_t count = particles.count();
  const std::string number = std::to_string(count);
  Header head;
  head.add(
      "<?xml version=\"1.0\"?>\n<VTKFile type=\"UnstructuredGrid\" version=\"1.0\" "
      "byte_order=\"LittleEndian\" header_type=\"UInt64\">\n<UnstructuredGrid>\n");
  add_fields(head, particles);
  head.add("<Piece NumberOfPoints=\"" + number + "\" NumberOfCells=\"" + number +
           "\">\n<PointData Scalars=\"density\" Vectors=\"velocity\">\n");
  // The position is that of the points, in an element of its own.
  std::vector<scene::ParticleArray> data = particles.arrays();
  const auto position = std::find_if(data.begin(), data.end(),
                                     [](const auto& one) { return one.name == "position"; });
  const scene::ParticleArray points = *position;
  data.erase(position);
  for (const scene::ParticleArray& one : data)
    head.appended(attributes_of(one), one.bytes.size(), one.unit);
  head.add("</PointData>\n<Points>\n");
  head.appended(attributes_of(points), points.bytes.size(), points.unit);
  head.add("</Points>\n<Cells>\n");
  head.appended("type=\"Int32\" Name=\"connectivity\"", 4 * count);
  head.appended("type=\"Int32\" Name=\"offsets\"", 4 * count);
  head.appended("type=\"UInt8\" Name=\"types\"", count);
  head.add("</Cells>\n</Piece>\n</UnstructuredGrid>\n<AppendedData encoding=\"raw\">\n_");
  PartFile file(path);
  file.write(head.text().data(), head.text().size());
  for (const scene::ParticleArray& one : data)
    write_bytes(file, one.bytes.data(), one.bytes.size());
  write_bytes(file, points.bytes.data(), points.bytes.size());
  // One cell per point: filters of ParaView, such as a threshold, work on cells.
  write_count(file, 0, count);
  write_count(file, 1, count);
  constexpr std::uint8_t kVertex = 1;
  const std::vector<std::uint8_t> types(count, kVertex);
  write_bytes(file, types.data(), types.size());
  const std::string end = "\n</AppendedData>\n</VTKFile>\n";
  file.write(end.data(), end.size());
  file.commit();
}

}  // namespace

ParticleFormat particle_vtu_format() {
  return {"vtu", ".vtu", "VTK unstructured grid of vertices, for ParaView", write_vtu};
}

}  // namespace navvy::formats
