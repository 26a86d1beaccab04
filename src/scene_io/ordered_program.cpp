// SPDX-License-Identifier: Apache-2.0
#include "scene_io/ordered_program.h"

#include <memory>

#include "scene_io/program_reader.h"
#include "scene_io/xml.h"

namespace navvy::scene_io {

ProgramReader ordered_program_reader(const scene::StepKinds& kinds) {
  return [kinds](const std::string& steps, const scene::Machine& machine,
                 const scene::StartGround& ground) {
    Faults faults;
    // On one line with the steps, so that lines in messages are those of the order.
    const std::unique_ptr<Document> document =
        Document::parse("<sdf version=\"1.9\" xmlns:navvy=\"navvy\"><navvy:program>" + steps +
                            "</navvy:program></sdf>",
                        "order", faults);
    scene::Program out;
    if (document) {
      Element& program = *document->root()->FirstChildElement();
      // An order that closes the program itself would go on behind it.
      if (program.NextSibling() != nullptr)
        faults.error(program, "", "an order contains the steps of one program",
                     "remove the end tag of navvy:program");
      else
        out = read_program(program, kinds, &machine, &ground, faults);
    }
    faults.finish();
    return out;
  };
}

}  // namespace navvy::scene_io
