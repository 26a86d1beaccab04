#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Drives a robot to a goal around what its laser scanner sees; it knows no map.

    python3 avoid_box.py paper/diff_physics --goal 3.5 -2 --crate "-0.5 -2"
"""
import argparse, array, json, math, subprocess

HALF_WIDTH, LOOK_AHEAD, SPEED = 0.42, 1.3, 0.5  # [m], [m], [m/s]


def clearance(points, heading):
    """Returns how far the robot can drive along a heading relative to its own [m]."""
    c, s = math.cos(heading), math.sin(heading)
    ahead = [x * c + y * s for x, y in points if abs(y * c - x * s) < HALF_WIDTH]
    return min((x for x in ahead if x > 0), default=math.inf)


def main():
    kept = argparse.RawTextHelpFormatter
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=kept)
    parser.add_argument("scene", nargs="?", default="paper/diff_physics")
    parser.add_argument("--goal", nargs=2, type=float, default=[3.5, -2.0], help="[m]")
    parser.add_argument("--crate", default="-0.5 -2", help="where the crate is put: x y [m]")
    parser.add_argument("--navvy", default="navvy")
    parser.add_argument("--out", default="out/avoid_box", help="folder of the results")
    options = parser.parse_args()
    command = [options.navvy, "run", options.scene, "--control", "stdio", "--control-rate", "10"]
    command += ["--no-render", "--quiet", "--set", f"machine.crate.pose={options.crate} 0 0 0 0.4"]
    command += ["--duration", "60", "--out", options.out]
    navvy = subprocess.Popen(command, stdin=subprocess.PIPE, stdout=subprocess.PIPE)

    def send(line):
        navvy.stdin.write(json.dumps(line).encode() + b"\n")
        navvy.stdin.flush()

    closest = left = math.inf
    while line := navvy.stdout.readline():
        pose = {k: json.loads(line)["outputs"]["robot/pose/" + k] for k in ("x", "y", "yaw")}
        send({"frames": ["robot/laser/ranges"]})
        head = json.loads(navvy.stdout.readline())["frames"]
        ranges = array.array("f", navvy.stdout.read(head["bytes"]))
        beams = [(r, math.radians(i / 2 - 90)) for i, r in enumerate(ranges) if math.isfinite(r)]
        points = [(r * math.cos(a), r * math.sin(a)) for r, a in beams]
        closest = min([closest] + [r for r, _ in beams])
        dx, dy = options.goal[0] - pose["x"], options.goal[1] - pose["y"]
        left = math.hypot(dx, dy)
        goal = math.remainder(math.atan2(dy, dx) - pose["yaw"], 2 * math.pi)
        ways = [math.radians(5 * i) for i in range(-18, 19)]
        free = [w for w in ways if clearance(points, w) > min(LOOK_AHEAD, left)]
        way = min(free, key=lambda w: abs(w - goal), default=1.5)
        if left < 0.15:
            break
        speed = SPEED * max(0.0, math.cos(way)) * min(1.0, 2 * left) if free else 0.0
        send({"inputs": {"robot/drive/brake": 0, "robot/drive/speed": speed,
                         "robot/drive/steer": max(-1.5, min(1.5, 2 * way))}})
    send({"end": True})
    print(f"{left:.2f} m from its goal; nothing came closer to the scanner than {closest:.2f} m")


main()
