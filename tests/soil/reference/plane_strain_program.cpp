// SPDX-License-Identifier: Apache-2.0
// plane_strain RIG [key=value ...]: the plane-strain laboratory by hand. `plane_strain help` names
// rigs and keys.
#include <cstdio>
#include <cstdlib>
#include <map>
#include <string>

#include "scene/soil_values.h"
#include "soil/reference/plane_rigs.h"

namespace {

using namespace navvy;
using soil::reference::PlaneMethod;

const char* const kHelp =
    "plane_strain RIG [key=value ...]\n"
    "Rigs, a line each time:\n"
    "  blade   upright plate: depth (0.3 m), speed (0.15 m/s), from, travel (0.03, 0.07 m), delta "
    "(0 deg), ramp (0 m)\n"
    "  shear   shear cell: speed (0.3 m/s), stress (3000 Pa), strain (0.5)\n"
    "  rest    bed at rest: height (1 m), time (3 s)\n"
    "  wave    share of a shear wave that one transfer keeps: cells (8)\n"
    "Soil: density (1600), e (1e6 Pa), nu (0.3), phi (35 deg), c (0 Pa), residual (as c), loose (a "
    "fifth of it),\n"
    "swell (1.25), static (0.1). cell (0.1 m), courant (0.5).\n"
    "Method: contact=kinematic|fraction, crowding=closing|shear|none,\n"
    "opening=integrated|seen, mixing=1|0, hold=1 (steps a transfer), motion=0.2 (cells at most).\n"
    "The kernels' own: crowding=shear opening=seen hold=4.\n";

std::map<std::string, std::string> keys;

std::string text(const std::string& key, const std::string& otherwise) {
  const auto it = keys.find(key);
  return it == keys.end() ? otherwise : it->second;
}

double number(const std::string& key, double otherwise) {
  const auto it = keys.find(key);
  if (it == keys.end()) return otherwise;
  char* end = nullptr;
  const double value = std::strtod(it->second.c_str(), &end);
  if (end == it->second.c_str() || *end != 0) {
    std::fprintf(stderr, "plane_strain: %s=%s is no number\n", key.c_str(), it->second.c_str());
    std::exit(2);
  }
  return value;
}

PlaneMethod method() {
  PlaneMethod out;
  if (text("contact", "kinematic") == "fraction") out.contact = PlaneMethod::Contact::kFraction;
  const std::string crowding = text("crowding", "closing");
  if (crowding == "shear") out.crowding = PlaneMethod::Crowding::kShear;
  if (crowding == "none") out.crowding = PlaneMethod::Crowding::kNone;
  if (text("opening", "integrated") == "seen") out.opening = PlaneMethod::Opening::kSeen;
  out.mixing = number("mixing", 1) != 0;
  out.hold = static_cast<int>(number("hold", 1));
  out.most_motion = number("motion", 0.2);
  return out;
}

scene::Soil soil_of_keys() {
  scene::Soil out;
  out.bank_density = number("density", 1600);
  out.young_modulus = number("e", 1e6);
  out.poisson = number("nu", 0.3);
  out.friction_angle = radians(number("phi", 35));
  out.cohesion = number("c", 0);
  out.residual_cohesion = number("residual", out.cohesion);
  out.loose_cohesion = number("loose", scene::default_loose_cohesion(out.residual_cohesion));
  out.swell = number("swell", 1.25);
  out.static_friction_share = number("static", 0.1);
  return out;
}

}  // namespace

int main(int argc, char** argv) {
  const std::string rig = argc > 1 ? argv[1] : "help";
  for (int i = 2; i < argc; ++i) {
    const std::string word = argv[i];
    const std::size_t at = word.find('=');
    if (at == std::string::npos) {
      std::fprintf(stderr, "plane_strain: %s is no key=value\n%s", word.c_str(), kHelp);
      return 2;
    }
    keys[word.substr(0, at)] = word.substr(at + 1);
  }
  const scene::Soil soil = soil_of_keys();
  const double cell = number("cell", 0.1), courant = number("courant", 0.5);
  namespace r = soil::reference;
  if (rig == "blade") {
    r::PlaneBlade blade;
    blade.depth = number("depth", blade.depth);
    blade.speed = number("speed", blade.speed);
    blade.from = number("from", blade.from);
    blade.travel = number("travel", blade.travel);
    blade.friction = std::tan(radians(number("delta", 0)));
    blade.ramp = number("ramp", 0);
    const r::BladeResult out = r::push_blade(soil, cell, courant, method(), blade);
    std::printf(
        "speed %.3f m/s: %.0f N/m, over Rankine %.3f, scatter %.1f %%; of the work dissipated "
        "%.2f, of the tool's in "
        "transfers %.3f; "
        "densest %.2f; steps a transfer %.1f\n",
        blade.speed, out.force, out.over_rankine, 100 * out.scatter, out.dissipated, out.transfer,
        out.crowding, out.steps_a_transfer);
  } else if (rig == "shear") {
    const double speed = number("speed", 0.3);
    std::printf("speed %.3f m/s: tau / sigma %.4f, sin phi %.4f\n", speed,
                r::shear_ratio(soil, cell, courant, method(), speed, number("stress", 3000),
                               number("strain", 0.5)),
                std::sin(soil.friction_angle));
  } else if (rig == "rest") {
    const r::RestResult out =
        r::rest_bed(soil, cell, courant, method(), number("height", 1), number("time", 3));
    std::printf("stress / weight %.4f, scatter %.2f %%, speed %.3f mm/s\n", out.stress,
                100 * out.scatter, 1e3 * out.speed);
  } else if (rig == "wave") {
    std::printf("kept by a transfer: %.5f\n", r::wave_kept_by_transfer(number("cells", 8)));
  } else {
    std::printf("%s", kHelp);
    return rig == "help" || rig == "--help" ? 0 : 2;
  }
  return 0;
}
