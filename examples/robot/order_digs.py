#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Orders an excavator to dig one cell after the other, and follows its progress.

    python3 order_digs.py --cells "3.65 0 1.85 0" "3.26 -2.19 1.57 -1.57"
"""
import argparse, json, subprocess

DIG = """<dig><from_m>{0} {1}</from_m><to_m>{2} {3}</to_m><depth_m>{depth}</depth_m>
<max_cycles>{cycles}</max_cycles>
<dump_at_m>-4 6</dump_at_m><dump_height_m>2</dump_height_m></dig>"""


def main():
    kept = argparse.RawTextHelpFormatter
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=kept)
    parser.add_argument("scene", nargs="?", default="trench")
    parser.add_argument("--machine", default="excavator")
    parser.add_argument("--pose", default="-4 0", help="where the machine starts: x y [m]")
    parser.add_argument("--cells", nargs="+", default=["3.65 0 1.85 0", "3.26 -2.19 1.57 -1.57"],
                        help='ends of the middle line of each: "x y x y" [m]')
    parser.add_argument("--depth", type=float, default=0.6, help="[m]")
    parser.add_argument("--cycles", type=int, default=60, help="most scoops of a cell")
    parser.add_argument("--set", action="append", default=[], metavar="KEY=VALUE",
                        help="value of the scene, as for navvy run")
    parser.add_argument("--navvy", default="navvy")
    parser.add_argument("--out", default="out/order_digs", help="folder of the results")
    options = parser.parse_args()
    command = [options.navvy, "run", options.scene, "--control", "stdio", "--control-rate", "1"]
    command += ["--no-render", "--quiet", "--duration", "600", "--out", options.out]
    command += ["--set", f"machine.{options.machine}.pose={options.pose} 0 0 0 0"]
    command += [word for one in options.set for word in ("--set", one)]
    navvy = subprocess.Popen(command, stdin=subprocess.PIPE, stdout=subprocess.PIPE, text=True)

    def ask(line):
        print(json.dumps(line), file=navvy.stdin, flush=True)
        return json.loads(navvy.stdout.readline())

    ordered = 0
    while navvy.stdout.readline():
        now = ask({"progress": True})["progress"]
        program = {p["machine"]: p for p in now["programs"]}.get(options.machine)
        if ordered and program["state"] != "running":
            step = program["step_list"][-1]
            left = f"{step['volume_left_m3']:.2f} of {step['design_volume_m3']:.2f} m3 are left"
            print(f"{now['time']:.0f} s: {step['state']}, {step['reason'] or left}")
        if not ordered or program["state"] != "running":
            if ordered == len(options.cells):
                break
            cell = options.cells[ordered]
            steps = DIG.format(*cell.split(), depth=options.depth,
                               cycles=options.cycles)
            answer = ask({"order": {"machine": options.machine, "steps": steps, "now": True}})
            if "error" in answer:
                print(answer["error"])
                break
            print(f"cell {cell} is ordered", flush=True)
            ordered += 1
        print("{}", file=navvy.stdin, flush=True)
    print('{"end": true}', file=navvy.stdin, flush=True)
    navvy.wait()
    with open(options.out + "/summary.json") as file:
        print(json.load(file)["cycles"], "cycles")


main()
