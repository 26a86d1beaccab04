// SPDX-License-Identifier: Apache-2.0
// Schema of scene files: the tree of all elements that the structs of the module scene describe.
#pragma once

#include <map>
#include <string>
#include <vector>

#include "scene/fields.h"
#include "scene/step_kind.h"

namespace navvy::scene_io {

/// An element or attribute of scene files.
struct SchemaNode {
  std::string name;  ///< name in a file, e.g. "navvy:soil"
  std::string key;   ///< name in `--set`, e.g. "soil"; "machine" for <include> and <model>
  /// "element" if it has children, else the type of the value, e.g. "number", "flag".
  std::string type;
  std::string unit;  ///< symbol of the unit; "-" for a number without a unit; empty for other types
  std::string text;  ///< one sentence of documentation
  std::string initial;  ///< default value as text; empty: none
  scene::Range range;   ///< allowed values of a number, in the unit of the file
  /// Properties of the node: `needed`: it is required; `attribute`: it is an attribute, not an
  /// element; `sdf`: it belongs to SDF; `repeats`: it may occur several times in one parent.
  bool needed = false, attribute = false, sdf = false, repeats = false;
  std::size_t most = 1;  ///< maximum number of such elements in one parent
  scene::Refers refers = scene::Refers::kNothing;  ///< type of the object that the value names
  std::vector<std::string> choices;  ///< allowed values of an enumeration; empty for other types
  std::string only;  ///< values of the parent's `type` for which this node exists; empty: all
  std::vector<SchemaNode> children;  ///< child elements and attributes

  /// Returns the child with this name or key; null if there is none.
  const SchemaNode* child(const std::string& name_or_key) const;
};

/// The whole schema: the tree below the root element <sdf>, with look-up by name.
class Schema {
 public:
  /// Builds the schema. @param kinds all types of program steps
  explicit Schema(const scene::StepKinds& kinds);
  Schema(const Schema&) = delete;
  Schema& operator=(const Schema&) = delete;

  /// Returns the node of the root element <sdf>.
  const SchemaNode& root() const { return root_; }
  /// Returns the first element node with children that has this name or key, searching from the
  /// root downwards; null if there is none.
  const SchemaNode* find(const std::string& name_or_key) const;
  /// Returns the keys of all elements with children, sorted and without duplicates.
  std::vector<std::string> names() const;

  /// Returns true if `name` is an extension element that an element `parent` may contain.
  bool allows(const std::string& parent, const std::string& name) const;
  /// Returns true if an element `parent` may contain several children `name`.
  bool repeats(const std::string& parent, const std::string& name) const;
  /// Returns the names of the extension elements (`navvy:`) that an element `parent` may contain.
  std::vector<std::string> extensions(const std::string& parent) const;
  /// Returns the nodes of everything that an element with the name `parent` may contain, wherever
  /// that element is in the tree.
  const std::vector<const SchemaNode*>& children(const std::string& parent) const;
  /// Returns true if an element with this name contains the name of a link, joint or shell.
  bool refers_to_part(const std::string& name) const;

 private:
  SchemaNode root_;  ///< the node of <sdf>
  /// Child nodes, keyed by the parent's name.
  std::map<std::string, std::vector<const SchemaNode*>> children_;
};

/// Returns the schema without program steps; it is built once per process.
const Schema& schema();

/// Returns a node and everything below it as a table for people.
std::string schema_text(const SchemaNode& node);
/// Returns a node and everything below it as JSON.
std::string schema_json(const SchemaNode& node);
/// Returns the text of the reference page of scene files (docs/reference/scene.md).
std::string schema_markdown(const Schema& schema);

}  // namespace navvy::scene_io
