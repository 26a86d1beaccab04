// SPDX-License-Identifier: Apache-2.0
#include "scene/step_kind.h"

#include <cstdio>
#include <utility>

namespace navvy::scene {
namespace {

/// A place as "(x, y)" with two digits after the point.
std::string pair(const Vec2& v) {
  const std::string x = std::to_string(v.x()), y = std::to_string(v.y());
  return "(" + x.substr(0, x.find('.') + 3) + ", " + y.substr(0, y.find('.') + 3) + ")";
}

/// Passes every question on and notes what comes back.
class NotingSource final : public FieldSource {
 public:
  NotingSource(FieldSource& source, ProgramStep::Values& values, std::string path = "")
      : source_(source), values_(values), path_(std::move(path)) {}

  FieldSource& number(const char* name, double& out, Range range, double factor) override {
    source_.number(name, out, range, factor);
    return note(name, text_of(out));
  }
  FieldSource& whole(const char* name, int& out, Range range) override {
    source_.whole(name, out, range);
    return note(name, std::to_string(out));
  }
  FieldSource& text(const char* name, std::string& out) override {
    source_.text(name, out);
    return note(name, out);
  }
  FieldSource& vec2(const char* name, Vec2& out, Range range) override {
    source_.vec2(name, out, range);
    return note(name, text_of(out.x()) + " " + text_of(out.y()));
  }
  FieldSource& list(const char* name, std::vector<double>& out, Range range,
                    double factor) override {
    source_.list(name, out, range, factor);
    std::string all;
    for (const double value : out) all += (all.empty() ? "" : " ") + text_of(value);
    return note(name, all);
  }
  FieldSource& each(const char* name, const std::function<void(FieldSource&)>& read) override {
    int number = 0;
    source_.each(name, [&](FieldSource& child) {
      NotingSource noting(child, values_, path_ + name + "[" + std::to_string(number++) + "]/");
      read(noting);
    });
    return *this;
  }
  FieldSource& required(const char* name) override {
    source_.required(name);
    return *this;
  }
  FieldSource& attribute(const char* name, std::string& out) override {
    source_.attribute(name, out);
    return note(name, out);
  }
  void finish() override { source_.finish(); }
  bool has(const char* name) const override { return source_.has(name); }
  std::string written(const char* name) const override { return source_.written(name); }
  void error(const char* name, const std::string& value, const std::string& rule,
             const std::string& remedy) override {
    source_.error(name, value, rule, remedy);
  }

 private:
  static std::string text_of(double value) {
    char digits[40];
    std::snprintf(digits, sizeof digits, "%.17g", value);
    return digits;
  }
  FieldSource& note(const std::string& name, const std::string& value) {
    values_[path_ + name] = value;
    return *this;
  }

  FieldSource& source_;
  ProgramStep::Values& values_;
  std::string path_;
};

}  // namespace

ProgramStep read_noting(const StepSource& source,
                        const std::function<ProgramStep(const StepSource&)>& read) {
  ProgramStep::Values values;
  NotingSource noting(source.fields, values);
  ProgramStep step = read({noting, source.machine, source.ground});
  step.set_values(std::move(values));
  return step;
}

void StepSource::require(bool fulfilled, const char* rule) const {
  if (machine && !machine->links.empty() && !fulfilled) fields.error("", machine->name, rule);
}

void StepSource::on_site(const char* name, const Vec2& place) const {
  if (!ground || !fields.has(name)) return;
  const Vec2 low = ground->origin, high = ground->origin + ground->size;
  if ((place.array() >= low.array()).all() && (place.array() <= high.array()).all()) return;
  fields.error(name, fields.written(name),
               "must lie on the site, " + pair(low) + " to " + pair(high) + " m",
               "move it, or enlarge size_m of the ground");
}

}  // namespace navvy::scene
