#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Drives a robot on two wheels round a square by nothing but its encoders, as the robot's own computer would.

    python3 drive_square.py paper/diff_kinematic
    python3 drive_square.py paper/diff_physics

starts `navvy run SCENE --control stdio`, sets wheel speeds, reads the two registers, and says where the robot believes to be
and where it is. The first scene rolls without slip, in the second one tyres slip and give way: only the second column differs.
The registers wrap: differences go the short way round. `--slip 0.05` falsifies the encoders of either.
"""
import argparse
import json
import math
import subprocess

COUNTS_PER_TURN, BITS, RADIUS, TRACK = 76600, 16, 0.1, 0.4  # vehicles/robot
RATE = 50  # control steps a second


def between(before, now):
    passed = int(now - before) % (1 << BITS)
    return passed - (1 << BITS) if passed >= 1 << (BITS - 1) else passed


class Robot:
    """Registers in, wheel speeds out; `x`, `y`, `yaw` are dead reckoning."""

    def __init__(self, x, y, yaw):
        self.x, self.y, self.yaw, self.driven, self.before = x, y, yaw, 0.0, None

    def look(self, registers):
        if self.before:
            left, right = (between(b, n) * 2 * math.pi * RADIUS / COUNTS_PER_TURN
                           for b, n in zip(self.before, registers))
            step, turn = (left + right) / 2, (right - left) / TRACK
            chord = step * (math.sin(turn / 2) / (turn / 2) if turn else 1)
            self.x += chord * math.cos(self.yaw + turn / 2)
            self.y += chord * math.sin(self.yaw + turn / 2)
            self.yaw += turn
            self.driven += step
        self.before = registers

    @staticmethod
    def wheels(speed, turn):
        return (speed - TRACK / 2 * turn) / RADIUS, (speed + TRACK / 2 * turn) / RADIUS


def ramp(left, before, most, rate):
    stop = min(math.sqrt(1.4 * rate * abs(left)), 5 * abs(left))
    return min(most, stop, before + rate / RATE)


def square(robot, edge, start):
    """Yields wheel speeds [rad/s] until home."""
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
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("scene")
    parser.add_argument("--navvy", default="navvy")
    parser.add_argument("--edge", type=float, default=1.0, help="of the square [m]")
    parser.add_argument("--slip", type=float, default=0.0, help="that the encoders pretend")
    parser.add_argument("--out", help="folder of the results")
    options = parser.parse_args()
    command = [options.navvy, "run", options.scene, "--control", "stdio", "--control-rate", str(RATE), "--no-render",
               "--quiet"] + (["--out", options.out] if options.out else [])
    navvy = subprocess.Popen(command, stdin=subprocess.PIPE, stdout=subprocess.PIPE, text=True)

    def hear():
        return json.loads(navvy.stdout.readline())["outputs"]

    def say(line):
        print(json.dumps(line), file=navvy.stdin, flush=True)

    outputs = hear()
    robot = Robot(outputs["robot/pose/x"], outputs["robot/pose/y"], outputs["robot/pose/yaw"])
    registers = [f"robot/spin_{side}/counts" for side in ("left", "right")]
    robot.look([outputs[name] for name in registers])
    say({"inputs": {"robot/drive/brake": 0, "robot/spin_left/encoder_slip": options.slip,
                    "robot/spin_right/encoder_slip": options.slip}})
    for left, right in square(robot, options.edge, robot.driven):
        outputs = hear()
        robot.look([outputs[name] for name in registers])
        say({"inputs": {"robot/spin_left/velocity": left, "robot/spin_right/velocity": right}})
    outputs = hear()
    robot.look([outputs[name] for name in registers])
    say({"end": True})
    navvy.stdin.close()
    navvy.wait()
    print(f"{options.scene}: after {outputs['time']:.2f} s it believes to be at "
          f"{robot.x:.3f} {robot.y:.3f} m, {math.degrees(robot.yaw):.1f} deg, and is at "
          f"{outputs['robot/pose/x']:.3f} {outputs['robot/pose/y']:.3f} m, "
          f"{math.degrees(outputs['robot/pose/yaw']):.1f} deg")


if __name__ == "__main__":
    main()
