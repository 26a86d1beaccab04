# SPDX-License-Identifier: Apache-2.0
"""Makes small synthetic data for the report page, and assembles the page from them."""
import base64
import gzip
import json
import math
import pathlib
import re
import struct
import zlib
from array import array

ROOT = pathlib.Path(__file__).resolve().parents[2]
PAGE = ROOT / "src" / "report" / "page"
THREE = pathlib.Path("/usr/share/javascript/three")
DYGRAPHS = pathlib.Path("/usr/share/javascript/dygraphs")
LIBRARIES = [
    THREE / "three.min.js",
    THREE / "examples/js/controls/OrbitControls.js",
    DYGRAPHS / "dygraph.min.js",
    DYGRAPHS / "extras/synchronizer.js",
]
STYLES = [DYGRAPHS / "dygraph.min.css", PAGE / "page.css"]
# The scripts only need the namespace of the first one, and the last one starts the page.
SCRIPTS = ["base.js", "data.js", "ground.js", "machines.js", "colors.js", "player.js", "outcome.js",
           "results.js", "cycles.js", "chart_groups.js", "chart.js", "charts.js", "map_view.js",
           "ground_map.js", "scene_ground.js", "scene_machines.js", "scene3d.js", "live.js",
           "media.js", "compare.js", "main.js"]

NX, NY, CELL = 90, 70, 0.1
ORIGIN = [-2.0, -3.5]
BASE = 100.0
TILE = 16
FRAMES = 20
DURATION = 38.0  # time of the last frame [s]
ROWS = 500


def packed(kind, values):
    """Returns base64 text of gzip-compressed values ('h', 'H', 'I' or 'f')."""
    if not values:
        return ""
    return base64.b64encode(gzip.compress(array(kind, values).tobytes(), 6, mtime=0)).decode()


def frame_time(frame):
    return DURATION * frame / (FRAMES - 1)


def start_height(x, y):
    """Returns the height at the start above BASE [mm]."""
    return round(40 * math.sin(0.13 * x) + 30 * math.cos(0.1 * y) + 2 * x)


def change(frame, x, y, depth=1200):
    """Returns the change of the height up to a frame [mm]: a trench that grows, and its spoil."""
    share = (frame + 1) / FRAMES
    length = 40 * share
    if 30 <= y < 40 and 25 <= x < 25 + length:
        return -round(depth * min(1, share + 0.2) * (1 - abs(y - 34.5) / 9))
    if math.hypot(x - 45, y - 56) < 9 * share:
        return round(90 * (9 * share - math.hypot(x - 45, y - 56)))
    return 0


def height(frame, x, y, depth=1200):
    """Returns the height above BASE at a frame [mm]; -1 is the start."""
    return start_height(x, y) + (change(frame, x, y, depth) if frame >= 0 else 0)


def tile_values(frame, tx, ty, depth):
    """Returns the record of a tile: its place, and its heights with 0 beyond the grid."""
    out = [tx, ty]
    for j in range(TILE):
        for i in range(TILE):
            x, y = tx * TILE + i, ty * TILE + j
            out.append(height(frame, x, y, depth) if x < NX and y < NY else 0)
    return out


def tiles(depth):
    """Returns counts and values of the tiles that changed from frame to frame."""
    counts, values = [], []
    for frame in range(FRAMES):
        changed = sorted({(x // TILE, y // TILE) for y in range(NY) for x in range(NX)
                          if height(frame, x, y, depth) != height(frame - 1, x, y, depth)})
        counts.append(len(changed))
        for tx, ty in changed:
            values += tile_values(frame, tx, ty, depth)
    return counts, values


def design():
    """Returns the design heights: a trench floor 1.1 m below the start."""
    return [start_height(x, y) - 1100 if 25 <= x < 65 and 30 <= y < 40 else -32768
            for y in range(NY) for x in range(NX)]


def machine_frames():
    """Returns poses, cylinders, forces and particles of the frames."""
    poses, cylinders, forces, counts, particles = [], [], [], [], []
    for frame in range(FRAMES):
        yaw = 0.9 * math.sin(frame)
        half = yaw / 2
        poses += [-0.6, 0, BASE + 0.75, 1, 0, 0, 0]
        poses += [-0.6, 0, BASE + 1.5, math.cos(half), 0, 0, math.sin(half)]
        tip = [-0.6 + 2.4 * math.cos(yaw), 2.4 * math.sin(yaw), BASE + 1.0]
        cylinders += [-0.6, 0, BASE + 1.5] + tip
        forces += tip + [-4000 * math.sin(frame) ** 2, 500, 9000 * math.sin(frame) ** 2]
        counts.append(40 + frame)
        for i in range(40 + frame):
            particles += [200 + 5 * (i % 12) + 10 * frame, 330 + 6 * (i // 12), 40 + 3 * (i % 7)]
    return poses, cylinders, forces, counts, particles


def pyramid():
    """Returns a small mesh, as a bucket."""
    points = [-0.3, -0.3, 0, 0.3, -0.3, 0, 0.3, 0.3, 0, -0.3, 0.3, 0, 0, 0, -0.5]
    triangles = [0, 1, 4, 1, 2, 4, 2, 3, 4, 3, 0, 4, 0, 2, 1, 0, 3, 2]
    return {"points": packed("f", points), "triangles": packed("I", triangles)}


def links():
    yellow, dark = [0.75, 0.4, 0.02], [0.06, 0.06, 0.06]
    base = [{"pose": [0, s, -0.35, 1, 0, 0, 0], "color": dark, "box": [2.6, 0.5, 0.7]}
            for s in (-0.8, 0.8)]
    base.append({"pose": [0, 0, 0.2, 1, 0, 0, 0], "color": dark, "cylinder": [0.5, 0.5]})
    arm = [{"pose": [-0.3, 0, 0.1, 1, 0, 0, 0], "color": yellow, "box": [1.8, 1.6, 0.9]},
           {"pose": [1.4, 0, 0.3, 0.9914, 0, 0.1305, 0], "color": yellow, "box": [2.4, 0.3, 0.3]},
           {"pose": [2.5, 0, -0.1, 1, 0, 0, 0], "color": dark, "sphere": 0.16},
           {"pose": [2.5, 0, -0.2, 1, 0, 0, 0], "color": dark, "mesh": pyramid()}]
    return [{"machine": "digger", "link": "base", "visuals": base},
            {"machine": "digger", "link": "arm", "visuals": arm}]


CHANNELS = [("time", "s"), ("soil/particles", "1"), ("digger/bucket/payload", "kg"),
            ("digger/bucket/smooth_force_x", "N"), ("digger/bucket/smooth_force_y", "N"),
            ("digger/bucket/smooth_force_z", "N"), ("digger/boom_joint/cylinder_force", "N"),
            ("digger/arm_joint/cylinder_force", "N"), ("digger/boom_joint/velocity", "rad/s"),
            ("digger/swing_joint/velocity", "rad/s"), ("digger/swing_joint/position", "rad"),
            ("digger/pump/pressure", "Pa"), ("digger/pump/flow", "m3/s"),
            ("digger/velocity/x", "m/s"), ("digger/stability/margin", "m")]


def telemetry(scale=1.0):
    values = []
    for row in range(ROWS):
        t = DURATION * row / (ROWS - 1)
        dig = max(0.0, math.sin(2 * math.pi * t / 12.67))
        swing = math.sin(2 * math.pi * t / 12.67 + 2)
        values += [t, 900 * dig, scale * 820 * dig, -21000 * dig * (1 + 0.2 * math.sin(9 * t)),
                   1500 * math.sin(5 * t) * dig, 14000 * dig, 52000 * swing, -31000 * dig,
                   0.3 * swing, 0.7 * math.cos(0.5 * t), 0.9 * swing, 1e6 + 1.6e7 * dig,
                   0.003 * abs(swing), 0.4 if t > 34 else 0.0, 0.8 - 0.3 * dig]
    return {"names": [name for name, _ in CHANNELS], "units": [unit for _, unit in CHANNELS],
            "rows": ROWS, "values": packed("f", values)}


def cycles():
    length = DURATION / 3
    return [{"machine": "digger", "start_s": i * length, "curl_s": i * length + 3.1,
             "lift_out_s": i * length + 5.2, "dump_start_s": i * length + 7.9,
             "end_s": (i + 1) * length, "payload_at_lift_out_kg": 812.25 + 3.5 * i,
             "payload_at_dump_kg": 798.125 + 3 * i, "force_peak_n": 25100.0 + 400 * i,
             "draft_peak_n": 22000.0, "uplift_peak_n": 3100.0} for i in range(3)]


def phases():
    spans = []
    for one in cycles():
        bounds = [one["start_s"], one["lift_out_s"], one["dump_start_s"],
                  one["dump_start_s"] + 1.6, one["end_s"]]
        for name, begin, end in zip(("dig", "swing loaded", "dump", "swing empty"), bounds,
                                    bounds[1:]):
            spans.append({"name": name, "start_s": begin, "end_s": end})
    return [{"machine": "digger", "spans": spans}]


def score(volume):
    shape = {"area_m2": 4.0, "cut_area_m2": 4.0, "design_cut_m3": 4.4, "design_fill_m3": 0.0,
             "completion": 0.8731, "coverage": 0.81, "volume_error": -0.0312,
             "rms_error_m": 0.114, "over_dig_rms_m": 0.021, "over_dig_max_m": 0.0931,
             "under_dig_rms_m": 0.112, "under_dig_max_m": 0.431}
    machine = {"machine": "digger", "cycles": 3, "distance_driven_m": 1.62, "work_j": 512345.0,
               "stations": 1, "reach_area_m2": 61.2, "cycle_mean_s": 12.667, "cycle_spread_s": 0.4,
               "payload_mean_kg": 815.75, "payload_spread_kg": 3.5, "fill_factor_mean": 0.973,
               "fill_factor_spread": 0.05}
    return {"inside": {"cut_m3": 3.012345678901, "fill_m3": 0.0, "lost_kg": 5000, "gained_kg": 0},
            "outside": {"cut_m3": 0.25, "fill_m3": 2.75, "lost_kg": 0, "gained_kg": 4700},
            "shape": shape, "bank_volume_m3": volume,
            "bank_volume_m3_per_h": volume / DURATION * 3600,
            "energy_kj_per_m3": 512.345 / volume, "moved_kg": 2403.375, "moved_t_per_h": 227.7,
            "work_time_s": DURATION, "energy_j": 512345.0, "collision_count": 0,
            "machines": [machine]}


def summary(volume=2.123456789012345):
    steps = [{"step": 1, "kind": "go_to", "state": "done", "reason": "", "start_s": 0.0,
              "end_s": 4.0, "place_m": [0, 0, 0]},
             {"step": 2, "kind": "dig_area", "state": "done", "reason": "", "start_s": 4.0,
              "end_s": 36.0, "place_m": [0, 0, 0]},
             {"step": 3, "kind": "wait_for", "state": "out_of_time", "start_s": 36.0,
              "end_s": 38.0, "reason": "the truck did not come within 2 s", "place_m": [0, 0, 0]}]
    program = {"machine": "digger", "state": "out_of_time", "step": 3, "steps": 3, "time_s": 38.0,
               "kind": "wait_for", "reason": "the truck did not come within 2 s",
               "step_list": steps, "place_m": [0, 0, 0]}
    soil = {"soil": "loam", "columns_change_kg": -5210.4, "particles_kg": 5210.4,
            "left_site_kg": 0.0, "loaded_kg": 0.0}
    return {"schema_version": 1, "scenario": "sample", "status": "incomplete",
            "message": "program of digger, step 3: the truck did not come within 2 s",
            "device": "Synthetic device", "steps": 24000, "step_s": DURATION / 24000,
            "simulated_time_s": DURATION, "wall_time_s": 61.5, "real_time_factor": 0.6178861788,
            "state_hash": "8a411250a589af30", "programs": [program], "cycles": 3,
            "cycle_list": cycles(), "payload_kg": [812.25, 815.75, 819.25],
            "bank_volume_m3": volume, "loose_volume_m3": 2.75, "energy_j": 512345.0,
            "bucket_force_peak_n": 25900.0, "bucket_draft_peak_n": 22000.0,
            "rock_force_peak_n": 0.0, "collision_count": 0, "particles_peak": 903,
            "score": score(volume),
            "goals": [{"goal": "completion", "at_least": 0.8, "value": 0.8731, "met": True},
                      {"goal": "volume_error", "at_most": 0.02, "value": -0.0312, "met": False}],
            "mass_ledger": {"error_units": 0, "unit_kg": 2.0 ** -24, "soils": [soil]}}


def picture(color):
    """Returns a PNG of one colour, 32 x 18 pixels, as base64."""
    def chunk(kind, data):
        body = kind + data
        return struct.pack(">I", len(data)) + body + struct.pack(">I", zlib.crc32(body))
    rows = b"".join(b"\0" + bytes(color) * 32 for _ in range(18))
    png = b"\x89PNG\r\n\x1a\n" + chunk(b"IHDR", struct.pack(">IIBBBBB", 32, 18, 8, 2, 0, 0, 0))
    png += chunk(b"IDAT", zlib.compress(rows)) + chunk(b"IEND", b"")
    return base64.b64encode(png).decode()


def run(name="trench sample", volume=2.123456789012345, scale=1.0, depth=1200,
        folder="out/sample"):
    """Returns a complete run that dug to a depth [mm]."""
    counts, values = tiles(depth)
    poses, cylinders, forces, particle_counts, particles = machine_frames()
    start = [start_height(x, y) for y in range(NY) for x in range(NX)]
    return {
        "name": name, "folder": folder, "complete": True,
        "notes": ["Heights: every 3rd frame",
                  "The video frames/side.mp4 (12 MB) lies beside this page"],
        "scene_text": "<sdf version='1.9'>\n  <world name='sample'></world>\n</sdf>\n",
        "run": {"format": 1, "navvy": "0.3.0", "device": "Synthetic device",
                "scene": "scenarios/sample.sdf",
                "command": ["navvy", "run", "scenarios/sample.sdf", "--set", "a note=it's"]},
        "summary": summary(volume),
        "grid": {"nx": NX, "ny": NY, "cell_m": CELL, "origin_m": ORIGIN, "unit_m": 0.001,
                 "base_m": BASE},
        "start": packed("h", start), "design": packed("h", design()),
        "soils": [{"name": "loam", "color": [0.23, 0.14, 0.075]}],
        "links": links(),
        "cylinders": [{"machine": "digger", "radius_m": 0.07, "barrel_length_m": 1.2}],
        "forces": [{"name": "digger/bucket"}],
        "frames": {"times": [frame_time(i) for i in range(FRAMES)], "poses": packed("f", poses),
                   "cylinders": packed("f", cylinders), "forces": packed("f", forces),
                   "particle_counts": packed("H", particle_counts),
                   "particles": packed("h", particles), "tile_counts": packed("I", counts),
                   "tiles": packed("h", values)},
        "paths": [{"machine": "digger", "points": [[-1.8, -2.5], [-1.2, -1.2], [-0.6, 0, BASE]]}],
        "phases": phases(), "telemetry": telemetry(scale),
        "videos": [{"name": "side", "file": "frames/side.mp4"}],
        "pictures": [{"camera": "side", "time_s": 12.0, "type": "image/png",
                      "data": picture((150, 120, 90))},
                     {"camera": "side", "time_s": 30.0, "type": "image/png",
                      "data": picture((90, 120, 150))}]}


def broken_run(name="broken sample"):
    """Returns a run of which only the folder is known: every member that may be null is null."""
    return {"name": name, "folder": "out/broken", "complete": False, "notes": [],
            "scene_text": "", "run": None, "summary": None, "grid": None, "start": "",
            "design": None, "soils": [], "links": [], "cylinders": [], "forces": [],
            "frames": None, "paths": [], "phases": [], "telemetry": None, "videos": [],
            "pictures": []}


def document(*runs):
    return {"format": 1, "version": "0.3.0", "made": "2026-11-26T18:00:00Z", "runs": list(runs)}


def library_text(path):
    """Returns a file without its pointer to a source map, which is not there to be loaded."""
    text = path.read_text(encoding="utf-8")
    return re.sub(r"(//[#@] sourceMappingURL=[^\n]*|/\*# sourceMappingURL=.*?\*/)", "", text)


def assemble(data, title="report"):
    """Returns the page as `navvy report` writes it."""
    styles = "\n".join("<style>%s</style>" % library_text(path) for path in STYLES)
    paths = LIBRARIES + [PAGE / name for name in SCRIPTS]
    scripts = "\n".join("<script>%s</script>" % library_text(path) for path in paths)
    text = json.dumps(data).replace("<", "\\u003c")
    page = (PAGE / "page.html").read_text(encoding="utf-8")
    parts = {"STYLES": styles, "SCRIPTS": scripts,
             "DATA": '<script type="application/json" id="navvy-data">%s</script>' % text,
             "TITLE": title.replace("&", "&amp;").replace("<", "&lt;")}
    return re.sub(r"<!--NAVVY:([A-Z]+)-->", lambda match: parts[match.group(1)], page)
