// SPDX-License-Identifier: Apache-2.0
#include "link/control_requests.h"

#include <gtest/gtest.h>

#include <cstring>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "control/step_kinds.h"
#include "core/base64.h"
#include "core/error.h"
#include "run/scene.h"
#include "scene_io/ordered_program.h"
#include "sim/read_particles.h"

namespace navvy::link {
namespace {

using nlohmann::json;

/// Returns why a request is refused; empty if it is not.
std::string refused(ControlRequests& requests, const json& line) {
  try {
    requests.answer(line);
  } catch (const InputError& error) {
    return error.what();
  }
  return "";
}

TEST(ControlRequests, SendArraysWithStampShapeUnitAndFrame) {
  run::Simulation simulation(run::test::bucket_scene(2), run::test::with_height_grid());
  ControlRequests requests(simulation, 50);
  ASSERT_TRUE(ControlRequests::is_request(json{{"arrays", true}}));
  simulation.step(30);
  const json answer = requests.answer({{"arrays", {"bucket/height_grid"}}});
  const json& grid = answer.at("arrays").at("bucket/height_grid");
  EXPECT_EQ(grid.at("type"), "float32");
  EXPECT_EQ(grid.at("shape"), json({5, 5}));
  EXPECT_EQ(grid.at("unit"), "m");
  EXPECT_EQ(grid.at("frame"), "bucket/height_grid");
  EXPECT_EQ(grid.at("quaternion_wxyz").size(), 4u);
  const sim::ArrayView view = simulation.arrays().view("bucket/height_grid");
  EXPECT_EQ(grid.at("sequence"), view.sequence());
  EXPECT_EQ(grid.at("time"), view.time());
  EXPECT_EQ(grid.at("position_m")[0], view.X_WF().translation().x());
  const auto bytes = base64_bytes(grid.at("data_base64").get<std::string>());
  ASSERT_TRUE(bytes);
  ASSERT_EQ(bytes->size(), view.bytes().size());
  EXPECT_EQ(std::memcmp(bytes->data(), view.bytes().data(), bytes->size()), 0);
  EXPECT_EQ(requests.answer({{"arrays", true}}), answer);
  EXPECT_EQ(requests.answer({{"arrays", json::array()}}).at("arrays"), json::object());
  const json info = requests.answer({{"info", true}}).at("info");
  EXPECT_EQ(info.at("arrays").at("bucket/height_grid").at("shape"), json({5, 5}));
  EXPECT_FALSE(info.at("arrays").at("bucket/height_grid").contains("data_base64"));
}

TEST(ControlRequests, SendFramesAsBytesBehindTheLine) {
  run::Simulation simulation(run::test::gauged_scene(2), run::test::with_height_grid());
  ControlRequests requests(simulation, 50);
  ASSERT_TRUE(ControlRequests::is_request(json{{"frames", true}}));
  simulation.step(30);
  const json answer =
      requests.answer({{"frames", {"bucket/height_grid", "bucket/gauge/state"}}}).at("frames");
  ASSERT_EQ(answer.at("arrays").size(), 2u);
  EXPECT_EQ(answer.at("bytes"), 100 + 24);
  const json& gauge = answer.at("arrays")[1];
  EXPECT_EQ(gauge.at("name"), "bucket/gauge/state");
  EXPECT_EQ(gauge.at("bytes"), 24);
  EXPECT_FALSE(gauge.contains("data_base64"));
  const sim::ArrayView view = simulation.arrays().view("bucket/gauge/state");
  EXPECT_EQ(gauge.at("sequence"), view.sequence());
  EXPECT_EQ(gauge.at("delivered"), view.delivered());
  ASSERT_EQ(requests.bytes().size(), 124u);
  EXPECT_EQ(std::memcmp(requests.bytes().data() + 100, view.bytes().data(), 24), 0);
  // The bytes belong to this answer alone, and a refused request leaves none.
  EXPECT_THROW(requests.answer({{"frames", {"bucket/gauge/stat"}}}), InputError);
  EXPECT_TRUE(requests.bytes().empty());
  const json info = requests.answer({{"info", true}}).at("info").at("sensors").at("bucket/gauge");
  EXPECT_EQ(info.at("type"), "navvy:joint");
  EXPECT_EQ(info.at("arrays"), json({"bucket/gauge/state"}));
}

TEST(ControlRequests, SendParticlesAsBytesBehindTheLine) {
  run::Simulation simulation(run::test::bucket_scene(2));
  ControlRequests requests(simulation, 50);
  ASSERT_TRUE(ControlRequests::is_request(json{{"particles", true}}));
  const json none = requests.answer({{"particles", true}}).at("particles");
  EXPECT_EQ(none.at("count"), 0);
  EXPECT_EQ(none.at("bytes"), 0);
  EXPECT_EQ(none.at("arrays").size(), scene::ParticleTable().arrays().size());
  simulation.step(600);
  const scene::ParticleTable table = sim::read_particles(simulation.world());
  ASSERT_GT(table.count(), 100u);
  const json answer = requests.answer({{"particles", {"velocity", "mass"}}}).at("particles");
  EXPECT_EQ(answer.at("count"), table.count());
  EXPECT_EQ(answer.at("steps"), 600);
  EXPECT_EQ(answer.at("time"), simulation.time());
  EXPECT_EQ(answer.at("soils")[0].at("name"), table.soils[0].name);
  ASSERT_EQ(answer.at("arrays").size(), 2u);
  EXPECT_EQ(answer.at("arrays")[0].at("shape"), json({table.count(), 3}));
  EXPECT_EQ(answer.at("arrays")[0].at("type"), "float32");
  EXPECT_EQ(answer.at("arrays")[1].at("unit"), "kg");
  EXPECT_EQ(answer.at("arrays")[1].at("bytes"), 8 * table.count());
  ASSERT_EQ(requests.bytes().size(), 20 * table.count());
  EXPECT_EQ(std::memcmp(requests.bytes().data(), table.velocity.data(), 12 * table.count()), 0);
  EXPECT_EQ(std::memcmp(requests.bytes().data() + 12 * table.count(), table.mass.data(),
                        8 * table.count()),
            0);
  // A refused request leaves no bytes and says what is known.
  EXPECT_NE(refused(requests, {{"particles", {"densty"}}}).find("did you mean 'density'?"),
            std::string::npos);
  EXPECT_NE(refused(requests, {{"particles", 3}}).find("or true for all"), std::string::npos);
  EXPECT_TRUE(requests.bytes().empty());
}

TEST(ControlRequests, RefuseUnknownArraysWithTheNearestName) {
  run::Simulation simulation(run::test::bucket_scene(2), run::test::with_height_grid());
  ControlRequests requests(simulation, 50);
  EXPECT_NE(refused(requests, {{"arrays", {"bucket/hight_grid"}}}).find("bucket/height_grid"),
            std::string::npos);
  EXPECT_NE(refused(requests, {{"arrays", 3}}).find("list of at most 1000 names"),
            std::string::npos);
  EXPECT_NE(refused(requests, {{"arrays", {7}}}).find("must be a text"), std::string::npos);
}

TEST(ControlRequests, OrderProgramsAndReportTheirProgress) {
  run::SimulationOptions options;
  options.read_program = scene_io::ordered_program_reader(control::step_kinds());
  run::Simulation simulation(run::test::bucket_scene(2), options);
  ControlRequests requests(simulation, 50);
  ASSERT_TRUE(ControlRequests::is_request(json{{"order", json::object()}}));
  const std::string machine = simulation.world().machines().at(0).name();
  simulation.step(5);
  const auto order = [&](const json& what) { return refused(requests, {{"order", what}}); };
  const std::string wait = "<wait><duration_s>0.1</duration_s></wait>";
  EXPECT_NE(order({{"machine", machine}}).find("with machine and steps"), std::string::npos);
  EXPECT_NE(order({{"machine", machine}, {"steps", wait}, {"when", 1}}).find("none of machine"),
            std::string::npos);
  EXPECT_NE(order({{"machine", machine}, {"steps", wait}, {"now", 1}}).find("true or false"),
            std::string::npos);
  EXPECT_NE(order({{"machine", machine}, {"steps", 5}}).find("must be a text"), std::string::npos);
  EXPECT_NE(order({{"machine", "digger"}, {"steps", wait}}).find("no machine of this name"),
            std::string::npos);
  EXPECT_NE(refused(requests, {{"progress", 3}}).find("must be true"), std::string::npos);
  const json answer =
      requests.answer({{"order", {{"machine", machine}, {"steps", wait}, {"now", true}}}});
  EXPECT_EQ(answer.at("order").at("time"), simulation.time());
  simulation.step(2);
  json now = requests.answer({{"progress", true}}).at("progress");
  ASSERT_EQ(now.at("programs").size(), 1u);
  EXPECT_EQ(now.at("programs")[0].at("machine"), machine);
  EXPECT_EQ(now.at("programs")[0].at("orders"), 1);
  EXPECT_EQ(now.at("programs")[0].at("state"), "running");
  EXPECT_EQ(now.at("programs")[0].at("phase"), "wait");
  EXPECT_TRUE(now.at("score").is_object());
  while (simulation.time() < 0.3) simulation.step();
  now = requests.answer({{"progress", true}}).at("progress");
  EXPECT_EQ(now.at("programs")[0].at("state"), "done");
  EXPECT_EQ(now.at("programs")[0].at("step_list").back().at("kind"), "wait");
}

TEST(ControlRequests, ResetReplacesTheStateOnce) {
  run::Simulation simulation(run::test::bucket_scene(2));
  ControlRequests requests(simulation, 50, {false, false});
  const std::string start = simulation.state_hash();
  simulation.step(5);
  EXPECT_EQ(requests.answer({{"reset", true}}).at("reset").at("steps"), 0);
  EXPECT_TRUE(requests.moved());
  EXPECT_EQ(simulation.state_hash(), start);
  EXPECT_EQ(simulation.replacements(), 1u);
  EXPECT_THROW(requests.answer({{"save", "file"}}), InputError);
  EXPECT_FALSE(requests.moved());
  EXPECT_THROW(requests.answer({{"image", "side"}}), InputError);
}

}  // namespace
}  // namespace navvy::link
