// SPDX-License-Identifier: Apache-2.0
#include "scene_io/program_order.h"

#include <optional>
#include <string>
#include <vector>

namespace navvy::scene_io {

namespace {

using scene::Waiting;

/// Returns the element of every step of a program, without unknown elements.
std::vector<Element*> elements_of(Element& machine, const scene::Program& steps) {
  std::vector<Element*> out;
  Element* program = machine.FirstChildElement("navvy:program");
  for (Element* e = program ? program->FirstChildElement() : nullptr; e;
       e = e->NextSiblingElement())
    if (out.size() < steps.steps.size() &&
        steps.steps[out.size()]->element() == std::string(e->Name()))
      out.push_back(e);
  return out;
}

int step_count(const scene::MachineInWorld& machine) {
  return static_cast<int>(machine.program.steps.size());
}

/// Returns the number of steps of the other machine that the step waits for.
int needed(const Waiting& wait, const scene::MachineInWorld& other) {
  return wait.steps > 0 ? wait.steps : step_count(other);
}

bool check_wait(const Element& at, const Waiting& wait, std::size_t waiting,
                const scene::Scene& world, Faults& faults) {
  // Checks the name, then the machine, then the number of steps.
  const int index = world.machine_index(wait.machine);
  if (index < 0) {
    std::vector<std::string> names;
    for (std::size_t m = 0; m < world.machines.size(); ++m)
      if (m != waiting) names.push_back(world.machines[m].name);
    faults.error(at, wait.machine, "no machine of this name in the world",
                 faults.nearest(wait.machine, names));
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

/// Checks that the hitch is one of the program's own machine.
void check_hitch(const Element& at, const std::string& hitch, std::size_t machine,
                 const scene::Scene& world, Faults& faults) {
  std::vector<std::string> names;
  for (const scene::Hitch& one : world.hitches) {
    if (one.parent != static_cast<int>(machine) && one.child != static_cast<int>(machine)) continue;
    if (one.name == hitch) return;
    names.push_back(one.name);
  }
  faults.error(at, hitch, "this machine has no hitch of this name",
               names.empty() ? "add <navvy:hitch name=\"" + hitch + "\"> to the world"
                             : faults.nearest(hitch, names));
}

/// Runs every program as far as waiting allows; returns the completed steps of each.
std::vector<int> run_dry(const scene::Scene& world) {
  // The result does not depend on the order, as programs never go back.
  std::vector<int> done(world.machines.size(), 0);
  for (bool moved = true; moved;) {
    moved = false;
    for (std::size_t m = 0; m < world.machines.size(); ++m) {
      const auto& steps = world.machines[m].program.steps;
      if (done[m] >= step_count(world.machines[m])) continue;
      if (const std::optional<Waiting> wait =
              steps[static_cast<std::size_t>(done[m])]->waits_for()) {
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

void check_program_order(Element& world_element, const scene::Scene& world, Faults& faults) {
  std::vector<std::vector<Element*>> elements;
  for (Element* e = world_element.FirstChildElement(); e; e = e->NextSiblingElement())
    if (std::string(e->Name()) == "include" || std::string(e->Name()) == "model") {
      const bool placed = elements.size() < world.machines.size();
      elements.push_back(
          elements_of(*e, placed ? world.machines[elements.size()].program : scene::Program{}));
    }
  bool sound = elements.size() == world.machines.size();
  for (std::size_t m = 0; m < world.machines.size() && sound; ++m) {
    const auto& steps = world.machines[m].program.steps;
    for (std::size_t s = 0; s < steps.size(); ++s) {
      if (const std::optional<Waiting> wait = steps[s]->waits_for())
        sound =
            !wait->machine.empty() && check_wait(*elements[m][s], *wait, m, world, faults) && sound;
      if (const std::optional<std::string> hitch = steps[s]->opens(); hitch && !hitch->empty())
        check_hitch(*elements[m][s], *hitch, m, world, faults);
    }
  }
  // Faulty programs cannot be run.
  if (!sound) return;
  // A program that cannot go on is at a waiting step.
  const std::vector<int> done = run_dry(world);
  for (std::size_t m = 0; m < world.machines.size(); ++m) {
    if (done[m] >= step_count(world.machines[m])) continue;
    const auto step = static_cast<std::size_t>(done[m]);
    faults.error(*elements[m][step], world.machines[m].program.steps[step]->waits_for()->machine,
                 "the machines wait for each other: none goes on before its longest_s has run out",
                 "let one of them go first");
  }
}

}  // namespace navvy::scene_io
