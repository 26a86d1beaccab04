// SPDX-License-Identifier: Apache-2.0
#include "scene_io/program_reader.h"

#include <algorithm>
#include <string_view>

#include "scene_io/element_reader.h"

namespace navvy::scene_io {

namespace {

/// The element of one step.
class XmlStep final : public scene::StepSource {
 public:
  XmlStep(Element& element, const scene::Machine* on_machine, const scene::StartGround* on_ground,
          Faults& faults)
      : StepSource(on_machine, on_ground), element_(element), faults_(faults) {}

  void read(scene::Step& step) const override { read_element(element_, step, nullptr, faults_); }
  bool has(const char* name) const override { return scene_io::has(element_, name); }
  std::string written(const char* name) const override { return child_text(element_, name); }
  void error(const char* name, const std::string& value, const std::string& rule,
             const std::string& remedy, int item) const override {
    // The empty name stands for the step itself; `item` counts repeated children.
    const Element* child = *name != '\0' ? element_.FirstChildElement(name) : nullptr;
    for (; child != nullptr && item > 0; --item) child = child->NextSiblingElement(name);
    faults_.error(child ? *child : element_, value, rule, remedy);
  }

 private:
  Element& element_;
  Faults& faults_;
};

}  // namespace

scene::Program read_program(Element& element, const scene::StepKinds& kinds,
                            const scene::Machine* machine, const scene::StartGround* ground,
                            Faults& faults) {
  scene::Program program;
  std::vector<std::string> known;
  for (const scene::StepKind& kind : kinds) known.push_back(kind.element);
  for (Element* child = element.FirstChildElement(); child; child = child->NextSiblingElement()) {
    const auto kind = std::find(known.begin(), known.end(), child->Name()) - known.begin();
    if (static_cast<std::size_t>(kind) == kinds.size()) {
      faults.error(*child, text_of(*child), "unknown element",
                   faults.nearest(child->Name(), known));
      continue;
    }
    program.steps.push_back(
        kinds[static_cast<std::size_t>(kind)].read(XmlStep(*child, machine, ground, faults)));
    // Kept for messages that come when the run starts, as the document is closed by then.
    program.lines.push_back(child->GetLineNum());
  }
  if (!text_of(element).empty())
    faults.error(element, text_of(element), "text is not allowed between the elements here",
                 "remove it");
  if (const auto* at = element.FirstAttribute())
    faults.error(element, at->Name(), "unknown attribute", "remove it");
  if (element.FirstChildElement() == nullptr)
    faults.warning(element, "", "the program has no steps: nothing operates the machine",
                   "add steps, or remove the program");
  return program;
}

}  // namespace navvy::scene_io
