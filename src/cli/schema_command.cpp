// SPDX-License-Identifier: Apache-2.0
// `navvy schema`: prints the elements of scene files.
#include <CLI/CLI.hpp>
#include <cstdio>
#include <memory>
#include <string>

#include "cli/commands.h"
#include "cli/exit_code.h"
#include "control/step_kinds.h"
#include "core/edit_distance.h"
#include "core/error.h"
#include "scene_io/schema.h"

namespace navvy::cli {
namespace {

/// Options as parsed.
struct SchemaOptions {
  std::string part;
  bool json = false, markdown = false;
};

/// Prints the schema, or the part of one element.
int print_schema(const SchemaOptions& options) {
  const scene_io::Schema schema(control::step_kinds());
  const scene_io::SchemaNode* node =
      options.part.empty() ? &schema.root() : schema.find(options.part);
  if (node == nullptr)
    throw InputError(Fault{Fault::Severity::kError, "", 0, "schema", options.part,
                           "no element of this name holds other elements",
                           suggestion(options.part, schema.names())});
  std::string text;
  if (options.markdown)
    text = scene_io::schema_markdown(schema);
  else
    text = options.json ? scene_io::schema_json(*node) : scene_io::schema_text(*node);
  std::fputs(text.c_str(), stdout);
  return kOk;
}

}  // namespace

void add_schema(CLI::App& app, Action& action) {
  auto options = std::make_shared<SchemaOptions>();
  CLI::App* command = app.add_subcommand(
      "schema", "print the elements of scene files with unit, default and range");
  command->add_option("part", options->part,
                      "element to print with all that it contains, e.g. soil; default all");
  command->add_flag("--json", options->json, "print JSON for programs");
  command->add_flag("--markdown", options->markdown, "print the reference page");
  command->callback([options, &action] { action = [options] { return print_schema(*options); }; });
}

}  // namespace navvy::cli
