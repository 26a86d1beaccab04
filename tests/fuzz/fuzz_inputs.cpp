// SPDX-License-Identifier: Apache-2.0
// Writes the inputs of packs and the broken scenes into folders, as libFuzzer reads them, and packs
// folders again. Called by `./dev fuzz`.
#include <iostream>

#include "fuzz/pack.h"
#include "scene_io/broken_scenes.h"

namespace {

constexpr char kUsage[] =
    "usage: fuzz_inputs unpack PACK FOLDER    write the inputs of a pack into an emptied folder\n"
    "       fuzz_inputs pack FOLDER PACK      write the files of a folder into a pack\n"
    "       fuzz_inputs scenes TABLE FOLDER   write the scenes of broken_scenes.txt into a "
    "folder\n";

void run(const std::string& command, const std::string& from, const std::string& to) {
  if (command == "unpack") {
    navvy::fuzz::write_folder(to, navvy::fuzz::read_pack(from));
  } else if (command == "pack") {
    navvy::fuzz::write_pack(to, navvy::fuzz::read_folder(from));
  } else if (command == "scenes") {
    navvy::test::BrokenSceneTable(from).write(to);
  } else {
    throw std::runtime_error("no command '" + command + "'\n" + kUsage);
  }
}

}  // namespace

int main(int argc, char** argv) {
  if (argc != 4) {
    std::cerr << kUsage;
    return 2;
  }
  try {
    run(argv[1], argv[2], argv[3]);
    return 0;
  } catch (const std::exception& error) {
    std::cerr << "fuzz_inputs: " << error.what() << '\n';
    return 1;
  }
}
