// SPDX-License-Identifier: Apache-2.0
// `navvy particles` and `navvy run --particles` as processes: of a scene, a run and a snapshot, and
// their messages on wrong arguments.
#include <gtest/gtest.h>

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <string>
#include <vector>

#include "cli/program_run.h"

namespace navvy {
namespace {

class Particles : public test::ProgramRun {
 protected:
  void SetUp() override {
    ProgramRun::SetUp();
    // A block of sand that slumps immediately.
    scene_ = path("scene.sdf");
    std::ofstream(scene_)
        << R"(<sdf version="1.9" xmlns:navvy="navvy"><world name="slump"><navvy:soil ref="sand_dry"/>
<navvy:ground><size_m>4.8 3.2</size_m>
<block><center_m>1 0.5</center_m><length_m>0.8</length_m><width_m>0.8</width_m><height_m>0.6</height_m></block>
<active><min_m>0.6 0.1</min_m><max_m>1.4 0.9</max_m><bottom_m>0</bottom_m></active></navvy:ground></world></sdf>
)";
  }
  std::string scene_;
};

TEST_F(Particles, OfASnapshotAreThoseThatTheRunRecordedAtThatTime) {
  // A snapshot is taken in the first step at or after its time, particles in the nearest one.
  for (const std::string format : {"npz", "vtu", "ply"}) {
    ASSERT_EQ(run({"run", scene_, "--no-render", "--no-report", "--duration", "0.2", "--snapshot",
                   path("half.snapshot"), "--snapshot-at", "0.099", "--particles", "20," + format,
                   "--out", out()}),
              0)
        << complained();
    ASSERT_EQ(run({"particles", path("half.snapshot"), "--scene", scene_, "--out",
                   path("half." + format)}),
              0)
        << complained();
    const std::string recorded = out() + "/particles/particles_000002." + format;
    EXPECT_GT(std::filesystem::file_size(recorded), 10'000u);
    EXPECT_TRUE(test::text_of(recorded) == test::text_of(path("half." + format))) << format;
    EXPECT_TRUE(std::filesystem::exists(out() + "/particles/particles_000004." + format));
    EXPECT_EQ(std::filesystem::exists(out() + "/particles/particles.pvd"), format == "vtu");
  }
  EXPECT_NE(said().find("particles of "), std::string::npos) << said();
  EXPECT_NE(said().find(" kg at 0."), std::string::npos) << said();
  // A snapshot beside the run's scene needs no --scene.
  std::filesystem::copy_file(path("half.snapshot"), out() + "/half.snapshot");
  ASSERT_EQ(run({"particles", out() + "/half.snapshot", "--out", path("again.ply")}), 0)
      << complained();
  EXPECT_TRUE(test::text_of(path("again.ply")) == test::text_of(path("half.ply")));
}

TEST_F(Particles, OfASceneAreItsActiveSoilAtTheStart) {
  ASSERT_EQ(run({"particles", scene_, "--out", path("start.npz")}), 0) << complained();
  EXPECT_NE(said().find(" at 0 s"), std::string::npos) << said();
  EXPECT_EQ(complained(), "");
  if (std::system("/usr/bin/python3 -c 'import numpy' >/dev/null 2>&1") != 0)
    GTEST_SKIP() << "NumPy for /usr/bin/python3 is missing (python3-numpy)";
  // 0.8 x 0.8 x 0.6 m of sand in the bank; its density is that of the header.
  std::ofstream(directory_ / "read.py") << R"(
import json, sys, numpy as np
f = np.load(sys.argv[1])
head = json.loads(f['header.json'])
p, m = f['position'], f['mass']
assert len(p) == head['count'] > 100
assert ((p[:, :2] > [0.59, 0.09]) & (p[:, :2] < [1.41, 0.91])).all(), (p.min(0), p.max(0))
assert p[:, 2].min() > 0 and p[:, 2].max() < 0.6
assert abs(m.sum() / (0.8 * 0.8 * 0.6 * head['soils'][0]['bank_density_kg_m3']) - 1) < 0.01
assert (f['velocity'] == 0).all()
)";
  EXPECT_EQ(std::system(
                ("/usr/bin/python3 '" + path("read.py") + "' '" + path("start.npz") + "'").c_str()),
            0);
}

TEST_F(Particles, OfASceneWithoutActiveSoilAreAValidFileAndAWarning) {
  const std::string flat = path("flat.sdf");
  std::ofstream(flat) << R"(<sdf version="1.9" xmlns:navvy="navvy"><world name="flat">
<navvy:soil ref="loam"/><navvy:ground><size_m>4 4</size_m></navvy:ground></world></sdf>
)";
  for (const char* name : {"none.npz", "none.vtu", "none.ply"}) {
    EXPECT_EQ(run({"particles", flat, "--out", path(name)}), 0) << complained();
    expect_complained("has no active soil");
    EXPECT_TRUE(std::filesystem::exists(path(name)));
  }
}

TEST_F(Particles, AreRefusedWithARemedyAndWriteNothing) {
  EXPECT_EQ(run({"particles", scene_, "--out", path("a.vtk")}), 2);
  expect_complained(".npz, .vtu, .ply");
  EXPECT_EQ(run({"particles", "trnch", "--out", path("a.vtu")}), 2);
  expect_complained("did you mean 'trench'?");
  EXPECT_EQ(run({"particles", scene_, "--out", path("no/such/a.npz")}), 4);
  expect_complained("mkdir -p '" + path("no/such") + "'");
  EXPECT_EQ(run({"particles", scene_, "--scene", scene_, "--out", path("a.npz")}), 2);
  expect_complained("omit it, or name a snapshot");
  EXPECT_EQ(run({"particles", directory_.string(), "--out", path("a.npz")}), 2);
  expect_complained("--snapshot-at");
  EXPECT_EQ(run({"particles", scene_}), 2);
  expect_complained("--out");
  std::filesystem::copy_file(scene_, path("scene.npz"));
  EXPECT_EQ(run({"particles", path("scene.npz"), "--out", path("scene.npz")}), 2);
  expect_complained("would replace");
  const auto refused = [&](const std::string& text) {
    return run(
        {"run", scene_, "--no-render", "--duration", "0.01", "--particles", text, "--out", out()});
  };
  for (const char* text : {"0", "ten", "10 vtu", "0,npz", "nan.5", ",vtu"}) {
    EXPECT_EQ(refused(text), 2) << text;
    expect_complained("RATE,FORMAT");
  }
  for (const char* text : {"-1", "1e9", "nan", "inf", "1e-9,ply"}) {
    EXPECT_EQ(refused(text), 2) << text;
    expect_complained("from 0.001 to 1000");
  }
  for (const char* text : {"10,", "10,vtk", "10,npz,vtu"}) {
    EXPECT_EQ(refused(text), 2) << text;
    expect_complained("expected npz, vtu or ply");
  }
  EXPECT_FALSE(std::filesystem::exists(out()));
  EXPECT_FALSE(std::filesystem::exists(path("a.npz")));
}

}  // namespace
}  // namespace navvy
