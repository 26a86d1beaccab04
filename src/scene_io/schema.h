// SPDX-License-Identifier: Apache-2.0
// Schema of scene files: the tree of elements that the structs of `scene` describe.
#pragma once

#include <map>
#include <string>
#include <vector>

#include "scene/fields.h"
#include "scene/step_kind.h"

namespace navvy::scene_io {

/// An element or attribute of scene files.
struct SchemaNode {
  std::string name;     ///< in a file: "navvy:soil"
  std::string key;      ///< in `--set`: "soil"; "machine" for <include> and <model>
  std::string type;     ///< "element" if it has children, else number, whole, flag, text, ...
  std::string unit;     ///< "-" for a number without a unit
  std::string text;     ///< one sentence
  std::string initial;  ///< default value as text; empty: none
  scene::Range range;
  bool needed = false, attribute = false, sdf = false, repeats = false;
  std::size_t most = 1;  ///< limit of the number of elements
  scene::Refers refers = scene::Refers::kNothing;
  std::vector<std::string> choices;  ///< values of a choice
  std::string only;                  ///< types of the parent that have the field; empty: all
  std::vector<SchemaNode> children;

  /// Returns the child with this name or key, null if there is none.
  const SchemaNode* child(const std::string& name_or_key) const;
};

/// The whole schema, below <sdf>.
class Schema {
 public:
  /// @param kinds steps of programs
  explicit Schema(const scene::StepKinds& kinds);
  Schema(const Schema&) = delete;
  Schema& operator=(const Schema&) = delete;

  const SchemaNode& root() const { return root_; }
  /// Returns the first node, from the top down, with this name or key; null if there is none.
  const SchemaNode* find(const std::string& name_or_key) const;
  /// Returns the names and keys of all elements with children.
  std::vector<std::string> names() const;

  /// Questions of readers about an element below a parent, by their names.
  bool allows(const std::string& parent, const std::string& name) const;
  bool repeats(const std::string& parent, const std::string& name) const;
  std::vector<std::string> extensions(const std::string& parent) const;
  /// Returns what an element of this name may hold, wherever it is.
  const std::vector<const SchemaNode*>& children(const std::string& parent) const;
  /// Returns true if the text of an element of this name refers to a part of a machine.
  bool refers_to_part(const std::string& name) const;

 private:
  SchemaNode root_;
  std::map<std::string, std::vector<const SchemaNode*>> children_;  ///< by the parent's name
};

/// Returns the schema without steps, built once.
const Schema& schema();

/// Returns a node and all below it as a table for people.
std::string schema_text(const SchemaNode& node);
/// Returns a node and all below it as JSON.
std::string schema_json(const SchemaNode& node);
/// Returns the reference page of scene files (docs/reference/scene.md).
std::string schema_markdown(const Schema& schema);

}  // namespace navvy::scene_io
