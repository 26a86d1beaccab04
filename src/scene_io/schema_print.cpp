// SPDX-License-Identifier: Apache-2.0
// Prints the schema for people, as JSON and as the reference page.
#include <cmath>
#include <cstdio>
#include <limits>
#include <map>

#include "scene_io/schema.h"
#include "scene_io/sdf_rules.h"
#include "scene_io/xml.h"

namespace navvy::scene_io {

namespace {

/// Returns false for a bound that stands for none. Ranges have both bounds or neither.
bool bounded(double bound) { return std::abs(bound) < std::numeric_limits<double>::max(); }

std::string range_of(const SchemaNode& node) {
  std::string out;
  // Choices take the place of a range: no value has both.
  for (const std::string& choice : node.choices) out += (out.empty() ? "" : ", ") + choice;
  if (!out.empty() || !bounded(node.range.min)) return out;
  return scene::short_text(node.range.min, 6) + ".." + scene::short_text(node.range.max, 6);
}

/// Returns the unit of a value, or the type of a value that has none.
std::string unit_or_type(const SchemaNode& node) {
  if (node.type == "element") return node.repeats ? "elements" : "element";
  if (node.type == "number") return node.unit;
  return node.type + (node.unit.empty() ? "" : " [" + node.unit + "]");
}

/// Returns the fewest digits that a reader of the page needs: floats and angles in radians have
/// many.
std::string rounded(const std::string& word) {
  double value = 0;
  if (!to_number(word, value)) return word;
  // 1e-5 is coarser than the rounding of a float (6e-8) and finer than a reader of the page
  // needs.
  for (int digits = 4; digits < 9; ++digits) {
    double back = 0;
    const std::string text = scene::short_text(value, digits);
    if (to_number(text, back) && std::abs(back - value) <= 1e-5 * std::abs(value)) return text;
  }
  return word;
}

std::string initial_of(const SchemaNode& node) {
  if (node.needed) return "needed";
  std::string out;
  for (const std::string& word : words_of(node.initial))
    out += (out.empty() ? "" : " ") + rounded(word);
  return out;
}

std::string sentence(const SchemaNode& node) {
  return node.text + (node.only.empty() ? "" : " Only of type " + node.only + ".");
}

/// Appends a row for a node and for each below it, indented by its depth.
void print_text(const SchemaNode& node, int depth, std::string& out) {
  const std::string name = (node.attribute ? "attribute " : "") + node.name;
  const std::string indent(static_cast<std::size_t>(2 * depth), ' ');
  char columns[200];
  // The widths align usual rows; a longer text shifts the rest of its own row.
  std::snprintf(columns, sizeof columns, "%-38s %-14s %-12s %-16s ", (indent + name).c_str(),
                unit_or_type(node).c_str(), initial_of(node).c_str(), range_of(node).c_str());
  out += columns + sentence(node) + "\n";
  for (const SchemaNode& child : node.children) print_text(child, depth + 1, out);
}

/// Returns a JSON string. Names and sentences are texts of this code base and hold no control
/// characters, so quotes and backslashes are all that needs an escape.
std::string quoted(const std::string& text) {
  std::string out = "\"";
  for (const char c : text) {
    if (c == '"' || c == '\\') out += '\\';
    out += c;
  }
  return out + "\"";
}

void print_json(const SchemaNode& node, const std::string& indent, std::string& out) {
  out += indent + "{\"name\": " + quoted(node.name) + ", \"type\": " + quoted(node.type);
  const auto add = [&out](const char* key, const std::string& text) {
    if (!text.empty()) out += std::string(", \"") + key + "\": " + quoted(text);
  };
  if (node.key != node.name) add("set", node.key);
  add("unit", node.unit);
  if (!node.needed) add("default", initial_of(node));
  // Bounds are exact, as programs compare values with them; defaults are for people.
  if (bounded(node.range.min))
    out += ", \"min\": " + scene::exact_text(node.range.min) +
           ", \"max\": " + scene::exact_text(node.range.max);
  if (node.needed) out += ", \"needed\": true";
  if (node.attribute) out += ", \"attribute\": true";
  if (node.sdf) out += ", \"sdf\": true";
  if (node.repeats) out += ", \"most\": " + std::to_string(node.most);
  std::string choices;
  for (const std::string& choice : node.choices)
    choices += (choices.empty() ? "" : ", ") + quoted(choice);
  if (!choices.empty()) out += ", \"choices\": [" + choices + "]";
  add("only", node.only);
  add("text", node.text);
  if (!node.children.empty()) {
    out += ", \"children\": [\n";
    for (std::size_t i = 0; i < node.children.size(); ++i) {
      print_json(node.children[i], indent + " ", out);
      out += i + 1 < node.children.size() ? ",\n" : "]";
    }
  }
  out += "}";
}

std::string code(const std::string& text) { return text.empty() ? "" : "`" + text + "`"; }

/// Paths of the sections so far, by what is inside their elements.
using Sections = std::map<std::string, std::string>;

// Fewer rows than this are printed again, since a reader finds them faster than a reference.
constexpr std::size_t kShortTable = 8;

/// Returns the path of an earlier section with the same elements inside; empty if this is the first
/// one or a short one.
std::string earlier_section(const SchemaNode& node, const std::string& path, Sections& sections) {
  if (node.children.size() < kShortTable) return "";
  std::string inside;
  for (const SchemaNode& child : node.children) print_json(child, "", inside);
  const auto [at, is_new] = sections.emplace(inside, path);
  return is_new ? "" : at->second;
}

/// Appends a section for a node and for every element with children below it.
void print_markdown(const SchemaNode& node, const std::string& path, Sections& sections,
                    std::string& out) {
  out += "\n### `" + path + "`\n" + node.text + "\n";
  if (node.repeats) out += "At most " + std::to_string(node.most) + ".\n";
  if (node.children.empty()) return;
  if (const std::string same = earlier_section(node, path, sections); !same.empty()) {
    out += "\nIts elements are those of `" + same + "`.\n";
    return;
  }
  out += "\n| Element | Unit or type | Default | Range | Meaning |\n|---|---|---|---|---|\n";
  const auto row = [&out](const SchemaNode& child, const std::string& owner) {
    out += "| " + (child.attribute ? "attribute " : std::string()) + code(child.name) + owner +
           " | " + unit_or_type(child) + " | " + initial_of(child) + " | " + range_of(child) +
           " | " + sentence(child) + " |\n";
  };
  // All rows come before the sections of the children, or the table would end in the middle.
  for (const SchemaNode& child : node.children) {
    row(child, "");
    if (child.type == "element") continue;
    for (const SchemaNode& own : child.children) row(own, " of " + code(child.name));
  }
  for (const SchemaNode& child : node.children)
    if (child.type == "element" && !child.children.empty())
      print_markdown(child, path + "/" + child.name, sections, out);
}

}  // namespace

std::string schema_text(const SchemaNode& node) {
  std::string out;
  print_text(node, 0, out);
  return out;
}

std::string schema_json(const SchemaNode& node) {
  std::string out;
  print_json(node, "", out);
  return out + "\n";
}

std::string schema_markdown(const Schema& schema) {
  std::string out =
      "<!-- SPDX-License-Identifier: Apache-2.0 -->\n"
      "<!-- Generated by `navvy schema --markdown`. Do not edit. -->\n"
      "# Scene elements\n\n"
      "A scene is an SDF 1.9 world with elements in the namespace `navvy:`. Every value is an "
      "element of\nits own, whose name ends in its unit. A value out of range and an unknown "
      "element are errors. Lists\nof numbers are separated by blanks. `navvy schema NAME` prints "
      "a part of this page, `navvy schema\n--json` all of it for programs. "
      "[Notes](elements.md) explain how elements work together.\n\n"
      "A machine (`model`), soils (`navvy:soil`) and a table of materials (`navvy:materials`) may "
      "be in files\nof their own, directly below `sdf`. `--set` names elements without `navvy:`; "
      "`machine` is an\n`include` or a `model`: `--set machine.digger.program.dig.depth_m=1`.\n\n"
      "## Elements\n";
  Sections sections;
  print_markdown(*schema.root().child("world"), "world", sections, out);
  out += "\n## Elements of SDF\n\n| In | Element | Use | Remark |\n|---|---|---|---|\n";
  for (const SdfUse& row : sdf_uses()) {
    const auto list = [](const std::string& words) {
      std::string text;
      for (const std::string& word : words_of(words))
        text += (text.empty() ? "" : ", ") + code(word);
      return text;
    };
    out += "| " + list(row.parents) + " | " + list(row.names) + " | " + row.use + " | " + row.why +
           " |\n";
  }
  return out;
}

}  // namespace navvy::scene_io
