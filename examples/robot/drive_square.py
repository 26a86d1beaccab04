#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Drives a robot with two wheels around a square, by its encoders alone.

    python3 drive_square.py paper/diff_kinematic
    python3 drive_square.py paper/diff_physics

Starts `navvy run SCENE --control stdio`, sets wheel speeds, reads the two encoder registers, and
compares the pose by dead reckoning with the true pose. The robot of the first scene rolls without
slip; in the second one tyres slip and deflect, so the two poses differ. The registers wrap around:
differences take the shorter direction. `--slip 0.05` falsifies the encoders of either scene.
"""
import argparse
import json
import math
import subprocess

COUNTS_PER_TURN, BITS, RADIUS, TRACK = 76600, 16, 0.1, 0.4  # vehicles/robot
# control rate [1/s]
RATE = 50


def between(before, now):
    """Returns the difference of two register values [counts]."""
    passed = int(now - before) % (1 << BITS)
    return passed - (1 << BITS) if passed >= 1 << (BITS - 1) else passed


class Robot:
    """Estimates pose and distance by dead reckoning from the registers [m, rad]."""

    def __init__(self, x, y, yaw):
        self.x, self.y, self.yaw, self.driven, self.before = x, y, yaw, 0.0, None

    def update(self, registers):
        """Updates the pose from new register values."""
        if self.before:
            left, right = (
                between(b, n) * 2 * math.pi * RADIUS / COUNTS_PER_TURN
                for b, n in zip(self.before, registers)
            )
            step, turn = (left + right) / 2, (right - left) / TRACK
            chord = step * (math.sin(turn / 2) / (turn / 2) if turn else 1)
            self.x += chord * math.cos(self.yaw + turn / 2)
            self.y += chord * math.sin(self.yaw + turn / 2)
            self.yaw += turn
            self.driven += step
        self.before = registers

    @staticmethod
    def wheels(speed, turn):
        """Returns wheel speeds [rad/s] for a speed [m/s] and a yaw rate [rad/s]."""
        return (speed - TRACK / 2 * turn) / RADIUS, (speed + TRACK / 2 * turn) / RADIUS


def ramp(left, before, most, rate):
    """Returns the next speed: accelerates at `rate`, and brakes to stop at the target."""
    stop = min(math.sqrt(1.4 * rate * abs(left)), 5 * abs(left))
    return min(most, stop, before + rate / RATE)


def square(robot, edge, start):
    """Yields wheel speeds [rad/s] until the robot is back at its start."""
    for side in range(4):
        speed = 0.0
        while (left := start + edge * (side + 1) - robot.driven) > 1e-3:
            speed = ramp(left, speed, 0.4, 0.5)
            yield robot.wheels(speed, 2 * (side * math.pi / 2 - robot.yaw))
        rate = 0.0
        while (left := (side + 1) * math.pi / 2 - robot.yaw) > 1e-3:
            rate = ramp(left, rate, 1.0, 1.5)
            yield robot.wheels(0.0, rate)
    yield 0.0, 0.0


def main():
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    parser.add_argument("scene")
    parser.add_argument("--navvy", default="navvy")
    parser.add_argument("--edge", type=float, default=1.0, help="edge of the square [m]")
    parser.add_argument("--slip", type=float, default=0.0, help="slip that the encoders simulate")
    parser.add_argument("--out", help="folder of the results")
    options = parser.parse_args()
    command = [
        options.navvy,
        "run",
        options.scene,
        "--control",
        "stdio",
        "--control-rate",
        str(RATE),
        "--no-render",
        "--quiet",
    ] + (["--out", options.out] if options.out else [])
    navvy = subprocess.Popen(command, stdin=subprocess.PIPE, stdout=subprocess.PIPE, text=True)

    def receive():
        return json.loads(navvy.stdout.readline())["outputs"]

    def send(line):
        print(json.dumps(line), file=navvy.stdin, flush=True)

    outputs = receive()
    robot = Robot(outputs["robot/pose/x"], outputs["robot/pose/y"], outputs["robot/pose/yaw"])
    registers = [f"robot/spin_{side}/counts" for side in ("left", "right")]
    robot.update([outputs[name] for name in registers])
    send(
        {
            "inputs": {
                "robot/drive/brake": 0,
                "robot/spin_left/encoder_slip": options.slip,
                "robot/spin_right/encoder_slip": options.slip,
            }
        }
    )
    for left, right in square(robot, options.edge, robot.driven):
        outputs = receive()
        robot.update([outputs[name] for name in registers])
        send({"inputs": {"robot/spin_left/velocity": left, "robot/spin_right/velocity": right}})
    outputs = receive()
    robot.update([outputs[name] for name in registers])
    send({"end": True})
    navvy.stdin.close()
    navvy.wait()
    print(
        f"{options.scene}: after {outputs['time']:.2f} s its estimate is "
        f"{robot.x:.3f} {robot.y:.3f} m, {math.degrees(robot.yaw):.1f} deg, its true pose "
        f"{outputs['robot/pose/x']:.3f} {outputs['robot/pose/y']:.3f} m, "
        f"{math.degrees(outputs['robot/pose/yaw']):.1f} deg"
    )


if __name__ == "__main__":
    main()
