// SPDX-License-Identifier: Apache-2.0
// A pack: the inputs that a fuzz target keeps, in one file (corpus/<target>.pack). For each input,
// ordered by name:
//   NAME SIZE\n   a name without blanks, and the size of the input [bytes]
//   BYTES\n       the input as it is
#pragma once

#include <filesystem>
#include <fstream>
#include <iterator>
#include <map>
#include <stdexcept>
#include <string>

namespace navvy::fuzz {

/// Inputs by name.
using Inputs = std::map<std::string, std::string>;

/// Reads a pack. @throws std::runtime_error if the file is missing, cut short or no pack.
inline Inputs read_pack(const std::filesystem::path& path) {
  std::ifstream in(path, std::ios::binary);
  if (!in) throw std::runtime_error("cannot read " + path.string());
  Inputs inputs;
  std::string name;
  for (std::size_t size = 0; in >> name >> size && in.get() == '\n';) {
    std::string bytes(size, '\0');
    in.read(bytes.data(), static_cast<std::streamsize>(size));
    if (in.get() != '\n')
      throw std::runtime_error(path.string() + ": input '" + name + "' does not end at its size");
    inputs[name] = std::move(bytes);
  }
  if (!in.eof())
    throw std::runtime_error(path.string() + ": no NAME SIZE after input '" + name + "'");
  return inputs;
}

/// Writes a pack. @throws std::runtime_error if the file cannot be written.
inline void write_pack(const std::filesystem::path& path, const Inputs& inputs) {
  std::ofstream out(path, std::ios::binary);
  for (const auto& [name, bytes] : inputs)
    out << name << ' ' << bytes.size() << '\n' << bytes << '\n';
  if (!out.flush()) throw std::runtime_error("cannot write " + path.string());
}

/// Reads the files of a folder.
inline Inputs read_folder(const std::filesystem::path& folder) {
  Inputs inputs;
  for (const auto& entry : std::filesystem::directory_iterator(folder)) {
    std::ifstream in(entry.path(), std::ios::binary);
    inputs[entry.path().filename().string()].assign(std::istreambuf_iterator<char>(in), {});
  }
  return inputs;
}

/// Writes a file for each input into `folder`, which then holds nothing else.
inline void write_folder(const std::filesystem::path& folder, const Inputs& inputs) {
  std::filesystem::remove_all(folder);
  std::filesystem::create_directories(folder);
  for (const auto& [name, bytes] : inputs) std::ofstream(folder / name, std::ios::binary) << bytes;
}

}  // namespace navvy::fuzz
