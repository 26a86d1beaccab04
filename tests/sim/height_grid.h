// SPDX-License-Identifier: Apache-2.0
// The smallest real sampler: a grid of ground heights that moves with a machine. It shows all that
// a sensor needs: this file, and `add` where the world or session is made.
#pragma once

#include <cmath>
#include <limits>
#include <string>

#include "sim/world.h"

namespace navvy::sim::testing {

/// Ground heights below a machine on a square grid, and the lowest of them as a number.
///
/// Frame F lies level at the base link's place with its heading; node (row, column) is at
/// F (column - n/2, row - n/2) x spacing, value = height there - height of F's origin [m].
class HeightGrid final : public Sampler {
 public:
  HeightGrid(const MachineHandle& machine, int nodes, double spacing, double rate)
      : machine_(machine), base_(machine.link(0)), nodes_(nodes), spacing_(spacing), rate_(rate) {}

  std::string name() const override { return machine_.name() + "/height_grid"; }
  double rate() const override { return rate_; }

  void declare(Publisher& out) override {
    ArrayChannel grid;
    grid.name = name();
    grid.unit = "m";
    grid.meaning = "height of the ground over the frame's origin";
    grid.frame = name();
    grid.type = ElementType::kFloat32;
    grid.shape = {nodes_, nodes_};
    grid_ = out.declare(grid);
    lowest_ = out.declare(Channel{name() + "/lowest", "m", "least height of the grid"});
    count_ = out.declare(Channel{name() + "/samples", "1", "samples so far"});
  }

  void sample(const World& world, Publisher& out) override {
    const Pose X_WF = frame();
    double least = std::numeric_limits<double>::infinity();
    const std::span<float> values = out.fill<float>(grid_, X_WF);
    const int middle = nodes_ / 2;
    std::size_t i = 0;
    for (int row = 0; row < nodes_; ++row)
      for (int column = 0; column < nodes_; ++column) {
        const Vec3 p_W = X_WF * Vec3(spacing_ * (column - middle), spacing_ * (row - middle), 0);
        const double height = world.ground().sample(p_W.x(), p_W.y()) - X_WF.translation().z();
        least = std::min(least, height);
        values[i++] = static_cast<float>(height);
      }
    out.set(lowest_, least);
    out.set(count_, ++samples_);
  }

  void visit(Archive& a) override { a("samples", samples_); }

 private:
  Pose frame() const {
    const Pose X_WB = base_.pose();
    const double yaw = std::atan2(X_WB.linear()(1, 0), X_WB.linear()(0, 0));
    const Vec3 p = X_WB.translation();
    return make_pose(p.x(), p.y(), p.z(), 0, 0, yaw);
  }

  MachineHandle machine_;
  LinkHandle base_;
  int nodes_;
  double spacing_, rate_;
  int grid_ = -1, lowest_ = -1, count_ = -1;
  double samples_ = 0;
};

}  // namespace navvy::sim::testing
