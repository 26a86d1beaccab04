// SPDX-License-Identifier: Apache-2.0
#include "scene_io/schema.h"

#include <gtest/gtest.h>

#include <functional>
#include <set>
#include <string>
#include <utility>

#include "control/step_kinds.h"
#include "paths.h"
#include "scene/overlay.h"
#include "scene_io/sdf_rules.h"
#include "text_of.h"

namespace navvy::scene_io {
namespace {

void visit(const SchemaNode& node, const std::function<void(const SchemaNode&)>& one) {
  one(node);
  for (const SchemaNode& child : node.children) visit(child, one);
}

TEST(Schema, EveryFieldHasASentenceAndAnUnambiguousName) {
  const Schema all(control::step_kinds());
  int fields = 0;
  visit(all.root(), [&](const SchemaNode& node) {
    ++fields;
    EXPECT_FALSE(node.text.empty()) << node.name;
    EXPECT_TRUE(node.text.empty() || node.text.back() == '.') << node.name << ": " << node.text;
    // SDF has a `type` of noise both as attribute and as element.
    std::set<std::pair<std::string, bool>> names;
    for (const SchemaNode& child : node.children)
      EXPECT_TRUE(names.insert({child.name, child.attribute}).second)
          << node.name << "/" << child.name;
  });
  EXPECT_GT(fields, 250);
}

TEST(Schema, DefaultsAreWithinTheirRanges) {
  visit(Schema(control::step_kinds()).root(), [](const SchemaNode& node) {
    // Zero stands for "not given" if the range excludes it.
    if (node.type != "number" || node.initial.empty() || node.initial == "0") return;
    const double value = std::stod(node.initial);
    EXPECT_GE(value, node.range.min) << node.name;
    EXPECT_LE(value, node.range.max) << node.name;
  });
}

TEST(Schema, ReadersFindPlacesListsAndReferences) {
  EXPECT_TRUE(schema().allows("world", "navvy:soil"));
  EXPECT_TRUE(schema().allows("include", "navvy:physics"));
  EXPECT_FALSE(schema().allows("include", "navvy:wheel"));
  EXPECT_TRUE(schema().allows("link", "navvy:density_kg_per_m3"));
  EXPECT_TRUE(schema().repeats("model", "navvy:track"));
  EXPECT_FALSE(schema().repeats("world", "navvy:ground"));
  EXPECT_TRUE(schema().refers_to_part("steer_joint"));
  EXPECT_FALSE(schema().refers_to_part("soil"));
}

TEST(Schema, PrintsPartsAsTextAndJson) {
  const Schema all(control::step_kinds());
  ASSERT_NE(all.find("soil"), nullptr);
  const std::string text = schema_text(*all.find("soil"));
  EXPECT_NE(text.find("cohesion_pa"), std::string::npos);
  EXPECT_NE(text.find("0..60"), std::string::npos);
  EXPECT_NE(text.find("plane_strain, direct_shear, triaxial, repose"), std::string::npos) << text;
  const std::string json = schema_json(*all.find("solver"));
  EXPECT_NE(json.find("{\"name\": \"cell_m\", \"type\": \"number\", \"unit\": \"m\", "
                      "\"default\": \"0.1\", \"min\": 0.005, \"max\": 2"),
            std::string::npos)
      << json;
  EXPECT_EQ(all.find("no such element"), nullptr);
}

TEST(Schema, NamesEveryOverlay) {
  std::string text;
  visit(Schema(control::step_kinds()).root(), [&](const SchemaNode& node) {
    if (node.name == "navvy:show") text = node.text;
  });
  for (const scene::OverlayInfo& one : scene::overlays())
    EXPECT_NE(text.find(one.name), std::string::npos) << one.name;
}

TEST(Schema, TheReferencePageIsUpToDate) {
  const std::string page = test::text_of(source_dir() + "/docs/reference/scene.md");
  EXPECT_TRUE(page == schema_markdown(Schema(control::step_kinds())))
      << "run: navvy schema --markdown > docs/reference/scene.md";
}

}  // namespace
}  // namespace navvy::scene_io
