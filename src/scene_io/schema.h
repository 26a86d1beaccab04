// SPDX-License-Identifier: Apache-2.0
// Schema of scene files: the tree of elements that the structs of `scene` describe.
#pragma once

#include <map>
#include <string>
#include <vector>

#include "scene/fields.h"
#include "scene/step_kind.h"

namespace navvy::scene_io {

/// One element or attribute that scene files may contain.
struct SchemaNode {
  std::string name;  ///< in a file: "navvy:soil"
  /// Name of the element in `--set` keys: without "navvy:"; "machine" for <include> and <model>.
  std::string key;  ///< in `--set`: "soil"; "machine" for <include> and <model>
  /// "element" for an element with children; otherwise the type of its value: number, whole, flag,
  /// text, choice, vector, ...
  std::string type;  ///< "element" if it has children, else number, whole, flag, text, ...
  /// Unit of the value; "-" for a dimensionless number, empty for other types.
  std::string unit;  ///< "-" for a number without a unit
  /// One sentence of documentation.
  std::string text;
  /// Default value in the file's unit; empty if there is none.
  std::string initial;
  scene::Range range;
  bool needed = false, attribute = false, sdf = false, repeats = false;
  /// Maximum number of such elements below one parent.
  std::size_t most = 1;
  scene::Refers refers = scene::Refers::kNothing;
  /// Allowed values of a choice.
  std::vector<std::string> choices;
  /// Types of the parent element that have this field, separated by commas; empty if all have it.
  std::string only;
  std::vector<SchemaNode> children;

  /// Returns the child node with this name or key; null if there is none.
  const SchemaNode* child(const std::string& name_or_key) const;
};

/// The tree of all elements that scene, machine, soil and materials files may contain, below <sdf>.
class Schema {
 public:
  /// @param kinds types of program steps that <navvy:program> may contain
  explicit Schema(const scene::StepKinds& kinds);
  Schema(const Schema&) = delete;
  Schema& operator=(const Schema&) = delete;

  const SchemaNode& root() const { return root_; }
  /// Returns the first element (searching from the root) that has this name or key and may contain
  /// other elements; null if there is none.
  const SchemaNode* find(const std::string& name_or_key) const;
  /// Returns the keys of all elements that may contain other elements, sorted.
  std::vector<std::string> names() const;

  /// Returns true if an extension element `name` is allowed inside an element `parent`.
  bool allows(const std::string& parent, const std::string& name) const;
  bool repeats(const std::string& parent, const std::string& name) const;
  std::vector<std::string> extensions(const std::string& parent) const;
  /// Returns all nodes that may occur inside elements of this name, in any part of the tree.
  const std::vector<const SchemaNode*>& children(const std::string& parent) const;
  /// Returns true if elements of this name contain the name of a link, joint or shell.
  bool refers_to_part(const std::string& name) const;

 private:
  SchemaNode root_;
  std::map<std::string, std::vector<const SchemaNode*>> children_;  ///< by the parent's name
};

/// Returns the schema without program steps. It is built at the first call.
const Schema& schema();

/// Formats a node and all nodes below it as a table for people.
std::string schema_text(const SchemaNode& node);
/// Formats a node and all nodes below it as JSON.
std::string schema_json(const SchemaNode& node);
/// Formats the reference page of scene elements (docs/reference/scene.md).
std::string schema_markdown(const Schema& schema);

}  // namespace navvy::scene_io
