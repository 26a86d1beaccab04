#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Opens the live page in a headless browser, served by a stand-in for a run."""
import base64
import http.server
import json
import pathlib
import queue
import sys
import threading
import unittest
from array import array

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parent))
import browser  # noqa: E402
import sample_data as sample  # noqa: E402

MISSING = [str(path) for path in sample.LIBRARIES + sample.STYLES if not path.exists()]
if not browser.PROGRAM:
    MISSING.append("chromium")
INPUTS = [{"name": "digger/boom/position", "unit": "rad", "machine": "digger", "low": -1.0,
           "high": 0.5},
          {"name": "digger/boom/velocity", "unit": "rad/s", "machine": "digger", "low": -0.4,
           "high": 0.4},
          {"name": "digger/swing/position", "unit": "rad", "machine": "digger", "low": None,
           "high": None}]


def plain(kind, values):
    return base64.b64encode(array(kind, values).tobytes()).decode()


def frame(number, paused=False, phase="dig", message=""):
    """Returns the row of a frame of the sample run."""
    poses, cylinders, forces, counts, particles = sample.machine_frames()
    places = sorted({(x // sample.TILE, y // sample.TILE)
                     for y in range(sample.NY) for x in range(sample.NX)
                     if sample.change(number, x, y)})
    tiles = [value for tx, ty in places for value in sample.tile_values(number, tx, ty, 1200)]
    first = 3 * sum(counts[:number])
    return {"number": number + 1, "missed": 0, "time_s": sample.frame_time(number),
            "tiles": plain("h", tiles), "poses": plain("f", poses[14 * number:14 * number + 14]),
            "cylinders": plain("f", cylinders[6 * number:6 * number + 6]),
            "forces": plain("f", forces[6 * number:6 * number + 6]),
            "particles": plain("h", particles[first:first + 3 * counts[number]]),
            "phases": [phase],
            "live": {"paused": paused, "pace": 0, "step": 600 * number, "speed": 0.5,
                     "particles": 4000, "values": [-0.25, 0.1, 0.3], "message": message}}


class Stand(http.server.BaseHTTPRequestHandler):
    """Serves the page, its events and its commands as a run does."""

    def log_message(self, *arguments):
        pass

    def answer(self, kind, body):
        self.send_response(200)
        self.send_header("Content-Type", kind)
        self.send_header("Content-Length", str(len(body)))
        self.end_headers()
        self.wfile.write(body)

    def do_GET(self):
        if self.path == "/token/":
            self.answer("text/html; charset=utf-8", self.server.page)
        elif self.path == "/token/events":
            self.send_response(200)
            self.send_header("Content-Type", "text/event-stream")
            self.end_headers()
            for text in iter(self.server.events.get, None):
                self.wfile.write(text)
                self.wfile.flush()
        else:
            self.send_error(404)

    def do_POST(self):
        body = json.loads(self.rfile.read(int(self.headers["Content-Length"])))
        self.server.commands.put((self.headers["Content-Type"], body))
        self.answer("application/json", b'{"ok":true}')


def page_text(control=True):
    run = dict(sample.broken_run("</script><b>live"))
    whole = sample.run()
    for key in ("grid", "start", "design", "soils", "links", "cylinders", "forces"):
        run[key] = whole[key]
    data = dict(sample.document(run), live={"control": control, "step_s": 0.002,
                                            "inputs": INPUTS if control else []})
    return sample.assemble(data, "live").replace(
        "default-src 'none';", "default-src 'none'; connect-src 'self';").encode()


@unittest.skipIf(MISSING, "needs " + ", ".join(MISSING))
class LivePage(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.browser = browser.Browser(webgl=True, offline=False)
        cls.addClassCleanup(cls.browser.close)
        cls.browser.size(1300, 700)

    def open(self, control=True):
        server = http.server.ThreadingHTTPServer(("127.0.0.1", 0), Stand)
        server.page = page_text(control)
        server.events, server.commands = queue.Queue(), queue.Queue()
        threading.Thread(target=server.serve_forever, daemon=True).start()
        self.addCleanup(server.server_close)
        self.addCleanup(server.shutdown)
        self.addCleanup(server.events.put, None)
        self.server = server
        self.send(frame(0))
        self.address = "http://127.0.0.1:%d/token/" % server.server_port
        self.browser.visit(self.address)

    def send(self, row, name=""):
        text = ("event: %s\n" % name if name else "") + "data: %s\n\n" % json.dumps(row)
        self.server.events.put(text.encode())

    def run_script(self, script):
        return self.browser.run(script)

    def wait(self, condition):
        self.assertTrue(self.browser.run(
            "(async () => { for (let i = 0; i < 600; ++i) { if (%s) return true; "
            "await new Promise(done => setTimeout(done, 50)); } return false; })()" % condition),
            condition)

    def command(self):
        kind, body = self.server.commands.get(timeout=30)
        self.assertEqual(kind, "application/json")
        return body

    def tearDown(self):
        self.assertEqual(self.browser.messages, [])
        outside = [url for url in self.browser.requests
                   if not url.startswith(("data:", "blob:", self.address))]
        self.assertEqual(outside, [])

    def test_shows_frames_and_sends_commands(self):
        self.open()
        self.assertEqual(self.run_script("document.querySelector('h1').textContent"),
                         "</script><b>live")
        self.send(frame(7))
        self.wait("navvy.live.updates === 2")
        worst = self.run_script("Array.from(navvy.runs[0].ground.now)")
        expected = [sample.height(7, x, y) for y in range(sample.NY) for x in range(sample.NX)]
        self.assertEqual(worst, expected)
        self.assertEqual(self.run_script("navvy.shown.parts[0].view.movers.particles.geometry"
                                         ".drawRange.count >= 40"), True)
        click = "document.querySelector('#%s').click()"
        self.run_script(click % "pause")
        self.assertEqual(self.command(), {"pause": True})
        self.send(frame(8, paused=True))
        self.wait("document.querySelector('#state').textContent === 'paused'")
        self.assertEqual(self.run_script("document.querySelector('#pause').textContent"), "Resume")
        self.run_script("document.querySelector('#steps').value = 5;" + click % "step")
        self.assertEqual(self.command(), {"step": 5})
        self.assertIn("ends the program",
                      self.run_script("document.querySelector('.joints').textContent"))
        # A slider moved fast sends its last value; joints without bounds have none.
        self.assertEqual(self.run_script("document.querySelectorAll('.joints input').length"), 2)
        self.run_script("for (const v of [0.1, 0.2, 0.3]) { const s = document.querySelector("
                        "'[data-input=\"digger/boom/position\"]'); s.value = v; "
                        "s.dispatchEvent(new Event('input')); }")
        self.assertEqual(self.command(), {"inputs": {"digger/boom/position": 0.3}})
        self.send(frame(9, phase="inputs"))
        self.wait("document.querySelector('.joints').textContent.includes('program has ended')")

    def test_says_what_went_wrong_and_when_the_run_ends(self):
        self.open(control=False)
        self.assertEqual(self.run_script("document.querySelectorAll('.joints').length"), 0)
        bad = frame(3)
        bad["poses"] = plain("f", [1.0])
        self.send(bad)
        self.wait("document.querySelector('#message').textContent.includes('does not fit')")
        self.send("The run has ended: finished.", "end")
        self.wait("document.querySelector('#state').textContent === 'ended'")
        self.assertIn("Show its report",
                      self.run_script("document.querySelector('#message').textContent"))


if __name__ == "__main__":
    unittest.main()
