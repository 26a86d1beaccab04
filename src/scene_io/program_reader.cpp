// SPDX-License-Identifier: Apache-2.0
#include "scene_io/program_reader.h"

#include "scene_io/fields.h"

namespace navvy::scene_io {

namespace {

// Thin on purpose: ranges, messages and what counts as unknown are those of Fields, as everywhere
// in a scene file.
/// The children of an XML element as a step's reader sees them.
class XmlSource final : public scene::FieldSource {
 public:
  XmlSource(Element& element, Faults& faults)
      : element_(element), faults_(faults), fields_(element, faults) {}

  FieldSource& number(const char* name, double& out, Range range, double factor) override {
    fields_.number(name, out, range, factor);
    return *this;
  }
  FieldSource& whole(const char* name, int& out, Range range) override {
    fields_.whole(name, out, range);
    return *this;
  }
  FieldSource& text(const char* name, std::string& out) override {
    fields_.text(name, out);
    return *this;
  }
  FieldSource& vec2(const char* name, Vec2& out, Range range) override {
    fields_.vec2(name, out, range);
    return *this;
  }
  FieldSource& list(const char* name, std::vector<double>& out, Range range,
                    double factor) override {
    fields_.list(name, out, range, factor);
    return *this;
  }
  FieldSource& each(const char* name, const std::function<void(FieldSource&)>& read) override {
    fields_.each(name, [&](Element& child) {
      // Faults of all depths go into one list.
      XmlSource source(child, faults_);
      read(source);
    });
    return *this;
  }
  FieldSource& required(const char* name) override {
    fields_.required(name);
    return *this;
  }
  FieldSource& attribute(const char* name, std::string& out) override {
    fields_.attribute(name);
    out = scene_io::attribute(element_, name);
    return *this;
  }
  void finish() override { fields_.finish(); }

  bool has(const char* name) const override { return fields_.has(name); }
  std::string written(const char* name) const override { return child_text(element_, name); }
  void error(const char* name, const std::string& value, const std::string& rule,
             const std::string& remedy) override {
    // A fault of a child that is not there is one of the element that lacks it.
    const Element* child = *name != '\0' ? fields_.child(name) : nullptr;
    faults_.error(child ? *child : element_, value, rule, remedy);
  }

 private:
  Element& element_;
  Faults& faults_;
  Fields fields_;
};

}  // namespace

scene::Program read_program(Element& element, const scene::StepKinds& kinds,
                            const scene::Machine* machine, const scene::StartGround* ground,
                            Faults& faults) {
  scene::Program program;
  Fields fields(element, faults);
  // All names are told to `fields` first: what it does not know by then is reported with the
  // nearest of them.
  for (const scene::StepKind& kind : kinds) fields.each(kind.element.c_str(), [](Element&) {});
  for (Element* child = element.FirstChildElement(); child; child = child->NextSiblingElement())
    for (const scene::StepKind& kind : kinds)
      if (kind.element == child->Name()) {
        XmlSource source(*child, faults);
        program.steps.push_back(kind.read({source, machine, ground}));
        // Beside the step, for messages of what only a machine on its ground can tell.
        program.lines.push_back(child->GetLineNum());
      }
  fields.finish();
  return program;
}

}  // namespace navvy::scene_io
