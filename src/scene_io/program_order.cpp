// SPDX-License-Identifier: Apache-2.0
#include "scene_io/program_order.h"

#include <string>
#include <variant>
#include <vector>

namespace navvy::scene_io {

namespace {

/// The `wait_for` elements of one machine, in the order of its WaitFor steps.
std::vector<Element*> waits_of(Element& machine) {
  std::vector<Element*> waits;
  if (Element* program = machine.FirstChildElement("navvy:program"))
    for (Element* e = program->FirstChildElement("wait_for"); e; e = e->NextSiblingElement("wait_for"))
      waits.push_back(e);
  return waits;
}

int step_count(const scene::MachineInWorld& machine) { return static_cast<int>(machine.program.steps.size()); }

/// Steps of `wait`'s machine that have to be done before it goes on.
int needed(const scene::WaitFor& wait, const scene::MachineInWorld& other) {
  return wait.steps > 0 ? wait.steps : step_count(other);
}

bool check_wait(const Element& at, const scene::WaitFor& wait, std::size_t waiting, const scene::World& world,
                Faults& faults) {
  std::vector<std::string> names;
  for (std::size_t m = 0; m < world.machines.size(); ++m)
    if (m != waiting) names.push_back(world.machines[m].name);
  const int index = world.machine_index(wait.machine);
  if (index < 0) {
    faults.error(at, wait.machine, "no machine of this name in the world", suggestion(wait.machine, names));
    return false;
  }
  if (index == static_cast<int>(waiting)) {
    faults.error(at, wait.machine, "a machine cannot wait for itself", "name another machine");
    return false;
  }
  const int steps = step_count(world.machines[static_cast<std::size_t>(index)]);
  if (steps > 0 && wait.steps <= steps) return true;
  faults.error(at, std::to_string(wait.steps),
               "the program of '" + wait.machine + "' has " + std::to_string(steps) + " steps",
               steps > 0 ? "wait for at most so many" : "give it a program");
  return false;
}

/// Lets every program run as far as waiting allows; where each stands then.
std::vector<int> run_dry(const scene::World& world) {
  std::vector<int> done(world.machines.size(), 0);
  for (bool moved = true; moved;) {
    moved = false;
    for (std::size_t m = 0; m < world.machines.size(); ++m) {
      const auto& steps = world.machines[m].program.steps;
      if (done[m] >= step_count(world.machines[m])) continue;
      if (const auto* wait = std::get_if<scene::WaitFor>(&steps[static_cast<std::size_t>(done[m])])) {
        const auto other = static_cast<std::size_t>(world.machine_index(wait->machine));
        if (done[other] < needed(*wait, world.machines[other])) continue;
      }
      ++done[m];
      moved = true;
    }
  }
  return done;
}

}  // namespace

void check_program_order(Element& world_element, const scene::World& world, Faults& faults) {
  std::vector<std::vector<Element*>> waits;
  for (Element* e = world_element.FirstChildElement(); e; e = e->NextSiblingElement())
    if (std::string(e->Name()) == "include" || std::string(e->Name()) == "model") waits.push_back(waits_of(*e));
  bool sound = waits.size() == world.machines.size();
  for (std::size_t m = 0; m < world.machines.size() && sound; ++m) {
    std::size_t next = 0;
    for (const scene::ProgramStep& step : world.machines[m].program.steps)
      if (const auto* wait = std::get_if<scene::WaitFor>(&step)) {
        const Element& at = *waits[m][next++];
        sound = !wait->machine.empty() && check_wait(at, *wait, m, world, faults) && sound;
      }
  }
  if (!sound) return;
  const std::vector<int> done = run_dry(world);
  for (std::size_t m = 0; m < world.machines.size(); ++m) {
    std::size_t before = 0;
    for (int s = 0; s < done[m]; ++s)
      before += std::holds_alternative<scene::WaitFor>(world.machines[m].program.steps[static_cast<std::size_t>(s)]);
    if (done[m] < step_count(world.machines[m]))
      faults.error(*waits[m][before], child_text(*waits[m][before], "machine"),
                   "the machines wait for each other: none goes on before its longest_s has run out",
                   "let one of them go first");
  }
}

}  // namespace navvy::scene_io
