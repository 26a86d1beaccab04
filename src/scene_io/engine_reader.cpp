// SPDX-License-Identifier: Apache-2.0
#include "scene_io/engine_reader.h"

#include <string>
#include <utility>
#include <vector>

#include "scene_io/fields.h"

namespace navvy::scene_io {

namespace {

using Kind = scene::CombustionEngine::Kind;
constexpr double kRpm = 2 * kPi / 60;  // [rad/s]

void read_point(Element& element, scene::CombustionEngine& engine, Faults& faults) {
  scene::CombustionEngine::Point point;
  const std::size_t before = faults.error_count();
  Fields fields(element, faults);
  fields.number("speed_rpm", point.speed, {1, 1e5}, kRpm)
      .required("speed_rpm")
      .number("torque_nm", point.torque, {0, 1e6})
      .required("torque_nm")
      .finish();
  if (faults.error_count() > before) return;
  if (!engine.curve.empty() && point.speed <= engine.curve.back().speed)
    faults.error(*fields.child("speed_rpm"), text_of(*fields.child("speed_rpm")),
                 "the points of a torque curve must rise in speed",
                 "order them from idle to the governed speed");
  if (engine.curve.empty() && point.torque <= 0)
    faults.error(*fields.child("torque_nm"), text_of(*fields.child("torque_nm")),
                 "an engine without torque at idle moves nothing",
                 "give a torque above 0 at the first point");
  engine.curve.push_back(point);
}

/// Elements of one kind that stand in an engine of the other.
void check_kind(const Element& element, const Fields& fields, const scene::CombustionEngine& engine,
                Faults& faults) {
  const bool source = engine.kind == Kind::kSpeedSource;
  for (const char* name : {"point", "braking_torque_nm", "shared_with_pump"})
    if (source && fields.has(name))
      faults.error(element, name, "a speed_source has no such element",
                   "remove it, or <kind>torque_curve</kind>");
  for (const char* name : {"max_speed_rpm", "max_torque_nm"}) {
    if (!source && fields.has(name))
      faults.error(element, name, "a torque_curve has no such element: its points say it",
                   "remove it, or <kind>speed_source</kind>");
    if (source && !fields.has(name))
      faults.error(element, "", std::string("a speed_source needs <") + name + ">", "");
  }
  if (source) return;
  if (!fields.has("braking_torque_nm"))
    faults.error(element, "", "a torque_curve needs <braking_torque_nm>",
                 "that it takes to turn the engine without fuel; 0: it coasts");
  if (engine.curve.size() < 2)
    faults.error(element, std::to_string(engine.curve.size()) + " points",
                 "a torque curve needs two or more <point>s, from idle to the governed speed",
                 "e.g. <point><speed_rpm>800</speed_rpm><torque_nm>300</torque_nm></point>");
}

void check_gears(const Fields& fields, const std::vector<double>& gears, Faults& faults) {
  const Element* element = fields.child("gear_ratios");
  if (element == nullptr) return;
  if (gears.empty())
    faults.error(*element, text_of(*element), "needs one gear or more",
                 "e.g. <gear_ratios>4 2 1</gear_ratios>");
  for (std::size_t i = 1; i < gears.size(); ++i)
    if (gears[i] >= gears[i - 1]) {
      faults.error(*element, text_of(*element),
                   "the ratios must fall from the first gear to the last", "order them by size");
      return;
    }
}

}  // namespace

void read_engine(Element& element, scene::AckermannDrive& drive, Faults& faults) {
  scene::CombustionEngine engine;
  bool shared = false;
  const std::size_t before = faults.error_count();
  Fields fields(element, faults);
  fields
      .choice<Kind>("kind", engine.kind,
                    {{"torque_curve", Kind::kTorqueCurve}, {"speed_source", Kind::kSpeedSource}})
      .required("kind")
      .each("point", [&](Element& point) { read_point(point, engine, faults); })
      .number("braking_torque_nm", engine.braking_torque, {0, 1e6})
      .flag("shared_with_pump", shared)
      .number("max_speed_rpm", engine.max_speed, {1, 1e5}, kRpm)
      .number("max_torque_nm", engine.max_torque, {1e-4, 1e6})
      .list("gear_ratios", engine.gears, {0.001, 1e4})
      .required("gear_ratios")
      .number("final_ratio", engine.final_ratio, {0.001, 1e4})
      .number("efficiency", engine.efficiency, {0.05, 1})
      .finish();
  // What is not sound by itself would be blamed a second time.
  if (faults.error_count() == before) check_kind(element, fields, engine, faults);
  if (faults.error_count() == before) check_gears(fields, engine.gears, faults);
  if (faults.error_count() > before) return;
  if (shared) {
    const scene::CombustionEngine::Point rated = scene::rated_point(engine);
    drive.engine_power = rated.speed * rated.torque;
  }
  drive.engine = std::move(engine);
}

}  // namespace navvy::scene_io
