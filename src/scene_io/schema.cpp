// SPDX-License-Identifier: Apache-2.0
#include "scene_io/schema.h"

#include <algorithm>
#include <functional>
#include <set>
#include <string_view>

#include "core/limits.h"
#include "scene/scene.h"

namespace navvy::scene_io {

namespace {

using scene::Field;
using scene::Mark;

// Names of the types, in the order of the alternatives of `scene::Value`. The assertion compares
// the numbers only; a new alternative needs its name at its own place.
constexpr const char* kTypes[] = {"flag",      "whole", "whole",  "number",  "text",   "vector",
                                  "vector",    "pose",  "matrix", "numbers", "vector", "whole",
                                  "direction", "color", "choice", "computed"};
static_assert(std::size(kTypes) == std::variant_size_v<scene::Value>);

std::string key_of(const std::string& name) {
  return name.rfind("navvy:", 0) == 0 ? name.substr(6) : name;
}

/// Visitor that adds the fields of a struct to a node.
class Builder final : public scene::Fields {
 public:
  explicit Builder(SchemaNode& node) : node_(node) { node_.type = "element"; }

  void field(const Field& f) override {
    // A derived value follows from other elements, so a file cannot give it.
    if (f.mark.has(Mark::kDerived)) return;
    SchemaNode& out = add(f.name, f.text, f.mark);
    out.type = kTypes[f.value.index()];
    out.attribute = f.mark.has(Mark::kAttribute);
    out.refers = f.refers;
    // The suffix of the name is the only place where a field states its unit.
    const scene::Unit unit = scene::unit_of(f.name);
    if (out.type == "number" || unit.symbol != std::string_view("-")) out.unit = unit.symbol;
    // A pose has its units in its sentence.
    const bool number = out.type == "number" || out.type == "whole" || out.type == "vector" ||
                        out.type == "numbers";
    if (number) out.range = f.range;
    // check_tree holds repeated points against the same limit.
    out.repeats = std::holds_alternative<std::vector<Vec3>*>(f.value);
    if (out.repeats) out.most = limits::kLinks;
    if (const auto* choice = std::get_if<scene::NamedChoice>(&f.value))
      out.choices.assign(choice->names.begin(), choice->names.end());
    // A number out of its range, such as 0 for a rate, stands for "not given".
    double* const* value = std::get_if<double*>(&f.value);
    const bool none = value != nullptr &&
                      (**value < f.range.min * unit.factor || **value > f.range.max * unit.factor);
    // A field with a flag has no value, and so no default, until its element is given.
    if (!out.needed && !f.mark.given && !none && out.type != "pose")
      out.initial = scene::value_text(f.value, unit.factor);
    if (f.attribute) add_attribute(out, *f.attribute);
  }
  void group(const scene::Group& group, const std::function<void(Fields&)>& describe) override {
    Builder inner(add(group.name, group.text, group.mark));
    describe(inner);
  }
  void list(const scene::List& list) override {
    if (list.mark.has(Mark::kDerived)) return;
    for (std::size_t kind = 0; kind < list.kinds.size(); ++kind) {
      SchemaNode& out = add(list.kinds[kind].name, list.kinds[kind].text, list.mark);
      // Machines are <include> or <model> in a file; to a user they are machines.
      if (std::string_view(list.name) == "machine") out.key = list.name;
      out.repeats = true;
      // An empty list has no item, so a fresh one shows the fields and their defaults.
      out.most = list.most;
      Builder inner(out);
      list.fresh(kind, inner);
    }
  }
  void types(const scene::Types& types) override {
    SchemaNode& out = add(types.attribute, types.text, {Mark::kAttribute});
    out.attribute = true;
    out.type = "choice";
    out.choices.assign(types.names.begin(), types.names.end());
    out.initial = types.names[0];
    std::vector<std::set<std::string>> owners;
    // Each type is described on a node of its own, and equal names are merged: a field that several
    // types share appears once, and `only` names its types unless all of them have it.
    const std::size_t first = node_.children.size();
    for (std::size_t type = 0; type < types.names.size(); ++type) {
      SchemaNode part;
      Builder inner(part);
      types.describe(type, inner);
      for (SchemaNode& child : part.children) {
        std::size_t at = first;
        while (at < node_.children.size() && node_.children[at].name != child.name) ++at;
        if (at == node_.children.size()) {
          node_.children.push_back(std::move(child));
          owners.emplace_back();
        }
        owners[at - first].insert(types.names[type]);
      }
    }
    for (std::size_t i = 0; i < owners.size(); ++i)
      if (owners[i].size() < types.names.size())
        for (const std::string& owner : owners[i])
          node_.children[first + i].only +=
              (node_.children[first + i].only.empty() ? "" : ", ") + owner;
  }

 private:
  static void add_attribute(SchemaNode& node, const scene::ValueAttribute& attribute) {
    SchemaNode& out = node.children.emplace_back();
    out.name = out.key = attribute.name;
    out.type = "choice";
    out.text = attribute.text;
    out.attribute = true;
    out.choices.assign(attribute.choice.names.begin(), attribute.choice.names.end());
    out.initial = out.choices.front();
  }
  // Adds a node to `node_`. The reference is valid until the next node is added.
  SchemaNode& add(const char* name, const char* text, const Mark& mark) {
    SchemaNode& out = node_.children.emplace_back();
    out.name = name;
    out.key = key_of(name);
    out.text = text;
    out.needed = mark.has(Mark::kNeeded);
    out.sdf = mark.has(Mark::kSdf);
    return out;
  }
  SchemaNode& node_;
};

/// Visits nodes from the top down until `visit` returns true.
bool walk(const SchemaNode& node, const std::function<bool(const SchemaNode&)>& visit) {
  if (visit(node)) return true;
  return std::any_of(node.children.begin(), node.children.end(),
                     [&](const SchemaNode& child) { return walk(child, visit); });
}

/// Adds the steps to every <navvy:program>. Only `control` knows the kinds of steps, so they come
/// as a table.
void add_steps(SchemaNode& node, const scene::StepKinds& kinds) {
  for (SchemaNode& child : node.children) add_steps(child, kinds);
  if (node.name != "navvy:program") return;
  for (const scene::StepKind& kind : kinds) {
    SchemaNode& step = node.children.emplace_back();
    step.name = step.key = kind.element;
    step.text = kind.text;
    step.repeats = true;
    step.most = limits::kSteps;
    Builder inner(step);
    kind.describe(inner);
  }
}

/// Adds an element that a file may have directly below <sdf>. The object with the defaults is
/// temporary: nodes hold texts and no pointers to members.
template <class T>
void add_root(SchemaNode& root, const char* name, const char* text, std::size_t most = 1) {
  SchemaNode& node = root.children.emplace_back();
  node.name = name;
  node.key = key_of(name);
  node.text = text;
  node.most = most;
  node.repeats = most > 1;
  Builder builder(node);
  T().describe(builder);
}

}  // namespace

const SchemaNode* SchemaNode::child(const std::string& name_or_key) const {
  for (const SchemaNode& node : children)
    if (node.name == name_or_key || node.key == name_or_key) return &node;
  return nullptr;
}

Schema::Schema(const scene::StepKinds& kinds) {
  root_.name = root_.key = "sdf";
  root_.type = "element";
  root_.text = "Root of a scene, machine, soil or materials file; version 1.9.";
  add_root<scene::Scene>(root_, "world", "A scene.");
  add_root<scene::Machine>(root_, "model", "A machine in a file of its own.");
  add_root<scene::Soil>(root_, "navvy:soil", "A soil in a file of its own.", limits::kSoils);
  add_root<scene::Materials>(root_, "navvy:materials", "A table of pairs in a file of its own.");
  add_steps(root_, kinds);
  // Readers ask for the children of an element by its name alone.
  // A name at several places of the tree has the children of all of them. The pointers stay valid,
  // as the tree is complete here and the class cannot be copied.
  walk(root_, [&](const SchemaNode& node) {
    std::vector<const SchemaNode*>& known = children_[node.name];
    for (const SchemaNode& child : node.children)
      if (std::none_of(known.begin(), known.end(),
                       [&](const SchemaNode* other) { return other->name == child.name; }))
        known.push_back(&child);
    return false;
  });
}

const SchemaNode* Schema::find(const std::string& name_or_key) const {
  // The walk is depth first in the order of the tree, so that an element of a world wins over the
  // same one in a file of its own.
  const SchemaNode* found = nullptr;
  walk(root_, [&](const SchemaNode& node) {
    if (node.type != "element" || (node.name != name_or_key && node.key != name_or_key))
      return false;
    found = &node;
    return true;
  });
  return found;
}

std::vector<std::string> Schema::names() const {
  std::set<std::string> out;
  walk(root_, [&](const SchemaNode& node) {
    if (node.type == "element") out.insert(node.key);
    return false;
  });
  return {out.begin(), out.end()};
}

const std::vector<const SchemaNode*>& Schema::children(const std::string& parent) const {
  static const std::vector<const SchemaNode*> none;
  const auto found = children_.find(parent);
  return found == children_.end() ? none : found->second;
}

bool Schema::allows(const std::string& parent, const std::string& name) const {
  const std::vector<std::string> known = extensions(parent);
  return std::find(known.begin(), known.end(), name) != known.end();
}

bool Schema::repeats(const std::string& parent, const std::string& name) const {
  const auto& known = children(parent);
  return std::any_of(known.begin(), known.end(), [&](const SchemaNode* child) {
    return child->name == name && child->repeats;
  });
}

std::vector<std::string> Schema::extensions(const std::string& parent) const {
  std::vector<std::string> out;
  // A run's scene.sdf has this element, by which a later run knows the files that it used.
  if (parent == "world") out.emplace_back("navvy:resolved");
  for (const SchemaNode* child : children(parent))
    if (child->name.rfind("navvy:", 0) == 0) out.push_back(child->name);
  return out;
}

bool Schema::refers_to_part(const std::string& name) const {
  // Soils and hitches are left out: they belong to the world, and a part's name does not change
  // them.
  using scene::Refers;
  return walk(root_, [&](const SchemaNode& node) {
    return node.name == name && (node.refers == Refers::kLink || node.refers == Refers::kJoint ||
                                 node.refers == Refers::kShell);
  });
}

const Schema& schema() {
  // The loader asks this one. It has no steps, as scene_io must not depend on control.
  static const Schema once{scene::StepKinds()};
  return once;
}

}  // namespace navvy::scene_io
