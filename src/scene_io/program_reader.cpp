// SPDX-License-Identifier: Apache-2.0
#include "scene_io/program_reader.h"

#include <functional>
#include <map>

#include "scene_io/fields.h"

namespace navvy::scene_io {

namespace {

constexpr Range kPlace = {-1e6, 1e6};  // [m]

class ProgramReader {
 public:
  ProgramReader(const scene::Machine* machine, const scene::Ground* ground, Faults& faults)
      : machine_(machine), ground_(ground), faults_(faults) {}

  scene::DriveTo drive_to(Element& element) {
    scene::DriveTo step;
    Fields fields(element, faults_);
    fields.vec2("target_m", step.target, kPlace)
        .required("target_m")
        .number("heading_deg", step.heading, {-360, 360}, kDegree)
        .number("speed_m_per_s", step.speed, {-20, 20})
        .number("tolerance_m", step.tolerance, {0.01, 5})
        .finish();
    step.has_heading = fields.has("heading_deg");
    if (Element* speed = fields.child("speed_m_per_s"); speed && step.speed == 0)
      faults_.error(*speed, "0", "the speed must not be zero");
    require(element, machine_ && machine_->has_drive, "drive_to needs a machine with <navvy:drive>");
    on_site(fields.child("target_m"), step.target);
    return step;
  }

  scene::Dig dig(Element& element) {
    scene::Dig step;
    if (machine_ && !machine_->buckets.empty()) step.width = machine_->buckets[0].width;
    Fields fields(element, faults_);
    fields.vec2("from_m", step.from, kPlace)
        .required("from_m")
        .vec2("to_m", step.to, kPlace)
        .required("to_m")
        .number("depth_m", step.depth, {0.02, 20})
        .required("depth_m")
        .number("width_m", step.width, {0.05, 50})
        .vec2("dump_at_m", step.dump_at, kPlace)
        .required("dump_at_m")
        .number("dump_height_m", step.dump_height, {0.1, 10})
        .number("pass_depth_m", step.pass_depth, {0.02, 5})
        .whole("max_cycles", step.max_cycles, {1, 100000})
        .finish();
    const bool can = machine_ && !machine_->buckets.empty() && !machine_->arm.boom.empty() &&
                     !machine_->arm.stick.empty() && !machine_->arm.bucket.empty();
    require(element, can, "dig needs a machine with <navvy:bucket> and <navvy:arm> (boom, stick, bucket)");
    on_site(fields.child("from_m"), step.from);
    on_site(fields.child("to_m"), step.to);
    on_site(fields.child("dump_at_m"), step.dump_at);
    if (fields.has("from_m") && fields.has("to_m") && (step.to - step.from).norm() < 0.1)
      faults_.error(*fields.child("to_m"), text_of(*fields.child("to_m")), "must lie at least 0.1 m from from_m");
    if (ground_ && step.depth > ground_->depth)
      faults_.error(fields.child("depth_m") ? *fields.child("depth_m") : element, child_text(element, "depth_m"),
                    "must not exceed depth_m of the ground", "there is rock below; make the ground deeper");
    return step;
  }

  scene::Swing swing(Element& element) {
    scene::Swing step;
    Fields(element, faults_).number("angle_deg", step.angle, {-3600, 3600}, kDegree).required("angle_deg").finish();
    require(element, machine_ && !machine_->arm.swing.empty(), "swing needs a machine with <navvy:arm>/swing_joint");
    return step;
  }

  scene::Dump dump(Element& element) {
    scene::Dump step;
    Fields(element, faults_).number("hold_s", step.hold, {0, 600}).finish();
    require(element, machine_ && !machine_->arm.bucket.empty(), "dump needs a machine with <navvy:arm>/bucket_joint");
    return step;
  }

  scene::Wait wait(Element& element) {
    scene::Wait step;
    Fields(element, faults_).number("duration_s", step.duration, {0, 1e6}).required("duration_s").finish();
    return step;
  }

  scene::Tip tip(Element& element) {
    scene::Tip step;
    Fields fields(element, faults_);
    fields.number("angle_deg", step.angle, {-360, 360}, kDegree)
        .required("angle_deg")
        .number("hold_s", step.hold, {0, 600})
        .finish();
    require(element, machine_ && !machine_->beds.empty(), "tip needs a machine with <navvy:bed>");
    if (!machine_ || machine_->beds.empty() || !fields.has("angle_deg")) return step;
    const int index = machine_->joint_index(machine_->beds[0].joint);
    if (index < 0) return step;
    const scene::Joint& joint = machine_->joints[static_cast<std::size_t>(index)];
    if (joint.has_limits && (step.angle < joint.lower - 1e-6 || step.angle > joint.upper + 1e-6))
      faults_.error(*fields.child("angle_deg"), text_of(*fields.child("angle_deg")),
                    "must lie within the limits of the bed's joint, " + std::to_string(joint.lower / kDegree) + " to " +
                        std::to_string(joint.upper / kDegree));
    return step;
  }

  scene::WaitFor wait_for(Element& element) {
    scene::WaitFor step;
    Fields(element, faults_)
        .text("machine", step.machine)
        .required("machine")
        .whole("steps", step.steps, {1, 1e6})
        .number("longest_s", step.longest, {0, 1e6})
        .finish();
    return step;
  }

  scene::Trajectory trajectory(Element& element) {
    scene::Trajectory step;
    std::vector<std::vector<double>> columns;
    Fields fields(element, faults_);
    fields.list("times_s", step.times, {0, 1e6})
        .required("times_s")
        .each("joint", [&](Element& joint) { columns.push_back(column(joint, step)); })
        .required("joint")
        .finish();
    for (std::size_t i = 1; i < step.times.size(); ++i)
      if (step.times[i] <= step.times[i - 1]) {
        faults_.error(*fields.child("times_s"), text_of(*fields.child("times_s")), "times must increase");
        break;
      }
    if (fields.has("times_s") && step.times.empty())
      faults_.error(*fields.child("times_s"), "", "needs at least one time");
    // The file gives a row a joint, the operator wants a row a time.
    step.positions.assign(step.times.size(), std::vector<double>(columns.size(), 0.0));
    for (std::size_t j = 0; j < columns.size(); ++j)
      for (std::size_t k = 0; k < step.times.size() && k < columns[j].size(); ++k) step.positions[k][j] = columns[j][k];
    return step;
  }

 private:
  std::vector<double> column(Element& element, scene::Trajectory& step) {
    const std::string name = attribute(element, "name");
    std::vector<double> degrees, meters;
    Fields fields(element, faults_);
    fields.attribute("name")
        .list("positions_deg", degrees, {-36000, 36000}, kDegree)
        .list("positions_m", meters, {-1e4, 1e4})
        .finish();
    step.joints.push_back(name);
    if (fields.has("positions_deg") == fields.has("positions_m")) {
      faults_.error(element, "", "needs either <positions_deg> or <positions_m>");
      return {};
    }
    const std::vector<double>& positions = fields.has("positions_deg") ? degrees : meters;
    if (positions.size() != step.times.size())
      faults_.error(element, std::to_string(positions.size()) + " positions",
                    "needs one position for each of the " + std::to_string(step.times.size()) + " times of <times_s>");
    check_joint(element, name, fields.has("positions_deg"), positions);
    return positions;
  }

  void check_joint(const Element& element, const std::string& name, bool in_degrees,
                   const std::vector<double>& positions) {
    if (!machine_ || machine_->links.empty()) return;
    const int index = machine_->joint_index(name);
    if (index < 0) {
      std::vector<std::string> names;
      for (const scene::Joint& joint : machine_->joints) names.push_back(joint.name);
      faults_.error(element, name, "no joint of this name in the machine", suggestion(name, names));
      return;
    }
    const scene::Joint& joint = machine_->joints[static_cast<std::size_t>(index)];
    const bool turns = joint.type == scene::Joint::Type::kRevolute;
    if (!turns && joint.type != scene::Joint::Type::kPrismatic) {
      faults_.error(element, name, "only revolute and prismatic joints can be moved");
    } else if (turns != in_degrees) {
      faults_.error(element, name,
                    turns ? "a revolute joint needs <positions_deg>" : "a prismatic joint needs <positions_m>");
    } else if (joint.has_limits) {
      const double f = turns ? 1 / kDegree : 1;
      for (const double position : positions) {
        if (position >= joint.lower - 1e-6 && position <= joint.upper + 1e-6) continue;
        faults_.error(element, std::to_string(position * f),
                      "must lie within the joint's limits, " + std::to_string(joint.lower * f) + " to " +
                          std::to_string(joint.upper * f));
        break;
      }
    }
  }

  void require(const Element& element, bool fulfilled, const char* rule) {
    // Without links the machine itself is faulty and has been reported.
    if (machine_ && !machine_->links.empty() && !fulfilled) faults_.error(element, machine_->name, rule);
  }

  void on_site(const Element* element, const Vec2& place) {
    if (!ground_ || !element) return;
    const Vec2 low = ground_->origin, high = ground_->origin + ground_->size;
    if ((place.array() >= low.array()).all() && (place.array() <= high.array()).all()) return;
    auto pair = [](const Vec2& v) {
      std::string x = std::to_string(v.x()), y = std::to_string(v.y());
      return "(" + x.substr(0, x.find('.') + 3) + ", " + y.substr(0, y.find('.') + 3) + ")";
    };
    faults_.error(*element, text_of(*element), "must lie on the site, " + pair(low) + " to " + pair(high) + " m",
                  "move it, or enlarge size_m of the ground");
  }

  const scene::Machine* machine_;
  const scene::Ground* ground_;
  Faults& faults_;
};

}  // namespace

scene::Program read_program(Element& element, const scene::Machine* machine, const scene::Ground* ground,
                            Faults& faults) {
  ProgramReader reader(machine, ground, faults);
  const std::vector<std::pair<std::string, std::function<scene::ProgramStep(Element&)>>> kinds = {
      {"drive_to", [&](Element& e) { return reader.drive_to(e); }},
      {"dig", [&](Element& e) { return reader.dig(e); }},
      {"swing", [&](Element& e) { return reader.swing(e); }},
      {"dump", [&](Element& e) { return reader.dump(e); }},
      {"wait", [&](Element& e) { return reader.wait(e); }},
      {"tip", [&](Element& e) { return reader.tip(e); }},
      {"wait_for", [&](Element& e) { return reader.wait_for(e); }},
      {"trajectory", [&](Element& e) { return reader.trajectory(e); }}};
  scene::Program program;
  Fields fields(element, faults);
  for (const auto& [name, read] : kinds) fields.each(name.c_str(), [](Element&) {});
  for (Element* child = element.FirstChildElement(); child; child = child->NextSiblingElement())
    for (const auto& [name, read] : kinds)
      if (name == child->Name()) {
        program.steps.push_back(read(*child));
        program.lines.push_back(child->GetLineNum());
      }
  fields.finish();
  return program;
}

}  // namespace navvy::scene_io
