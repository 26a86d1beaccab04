#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Opens the report page with synthetic data in a headless browser that has no network."""
import json
import pathlib
import sys
import unittest

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parent))
import browser  # noqa: E402
import sample_data as sample  # noqa: E402

# A small window, as software draws the 3D view where there is no GPU.
WINDOW = (1000, 600)
MISSING = [str(path) for path in sample.LIBRARIES + sample.STYLES if not path.exists()]
if not browser.PROGRAM:
    MISSING.append("chromium")


@unittest.skipIf(MISSING, "needs " + ", ".join(MISSING))
class PageCase(unittest.TestCase):
    """A browser per class, as its start takes seconds.

    Without WebGL where a test does not need it, as software draws it slowly.
    """

    webgl = False

    @classmethod
    def setUpClass(cls):
        cls.page = browser.Browser(webgl=cls.webgl)
        cls.addClassCleanup(cls.page.close)
        cls.page.size(*WINDOW)

    def open(self, *runs, title="report"):
        self.page.open(sample.assemble(sample.document(*runs), title))
        self.assertEqual(self.page.messages, [])

    def tearDown(self):
        # Whatever a test does, the page stays silent and loads only itself.
        self.assertEqual(self.page.messages, [])
        outside = [url for url in self.page.requests
                   if not url.startswith(("data:", "blob:", "file://" + self.page.folder))]
        self.assertEqual(outside, [])

    def text(self, selector):
        return self.page.run("document.querySelector(%s).textContent" % json.dumps(selector))

    def count(self, selector):
        return self.page.run("document.querySelectorAll(%s).length" % json.dumps(selector))

    def wait(self, script):
        """Waits until a condition of the page holds; long, as the machine may be busy."""
        return self.page.run("(async () => { for (let i = 0; i < 600; ++i) { if (%s) return true; "
                             "await new Promise(done => setTimeout(done, 50)); } "
                             "return false; })()" % script)


class CompleteRun(PageCase):
    """A page with every member, opened once."""

    @classmethod
    def setUpClass(cls):
        super().setUpClass()
        cls.page.open(sample.assemble(sample.document(sample.run())))

    def test_names_status_reason_and_hash(self):
        head = self.text("#head")
        for part in ("trench sample", "incomplete", "the truck did not come within 2 s",
                     "Synthetic device", "8a411250a589af30", "every 3rd frame"):
            self.assertIn(part, head)

    def test_has_the_heights_of_the_data_at_any_time(self):
        # Backwards too: a later time first, then the start, then one between two frames.
        between = (sample.frame_time(7) + sample.frame_time(8)) / 2
        for time, frame in ((sample.DURATION, sample.FRAMES - 1), (-1.0, -1), (between, 7)):
            got = self.page.run("(() => { const h = navvy.heights(0, %r); return "
                                "{nx: h.nx, ny: h.ny, values: Array.from(h.values)}; })()" % time)
            self.assertEqual((got["nx"], got["ny"]), (sample.NX, sample.NY))
            # float32 holds heights near 100 m to 8 um; the data have steps of 1 mm.
            worst = max(abs(got["values"][y * sample.NX + x] - sample.BASE -
                            sample.height(frame, x, y) / 1000)
                        for y in range(sample.NY) for x in range(sample.NX))
            self.assertLess(worst, 0.0005, "at %g s" % time)

    def test_keeps_every_digit_of_the_results(self):
        shown = self.page.run("Object.fromEntries([...document.querySelectorAll('.tile')].map("
                              "tile => [tile.dataset.key, +tile.querySelector('[data-value]')"
                              ".dataset.value]))")
        summary = sample.summary()
        score = summary["score"]
        self.assertEqual(shown["bank_volume_m3"], summary["bank_volume_m3"])
        self.assertEqual(shown["energy_kj_per_m3"], score["energy_kj_per_m3"])
        self.assertEqual(shown["payload_mean_kg"], 815.75)
        self.assertEqual(shown["cut_m3"], 3.012345678901 + 0.25)

    def test_lists_steps_goals_and_the_ledger(self):
        self.assertEqual(self.count("#outcome .program tbody tr"), 3)
        self.assertIn("balanced", self.text("#ledger"))
        self.assertNotIn("not balanced", self.text("#ledger"))
        goals = self.text("#goals")
        self.assertIn("met", goals)
        self.assertIn("missed", goals)

    def test_says_that_webgl_is_missing(self):
        self.assertIn("no WebGL", self.text("#scene3d"))

    def test_draws_charts_with_a_common_zoom(self):
        self.assertGreaterEqual(self.count(".chart canvas"), 6)
        self.page.run("document.querySelectorAll('#cycles tbody tr')[1].click()")
        cycle = sample.cycles()[1]
        windows = self.page.run("navvy.shown.parts[0].section.charts.map("
                                "chart => chart.graph.xAxisRange())")
        for low, high in windows:
            self.assertAlmostEqual(low, cycle["start_s"] - 0.05 * sample.DURATION / 3, places=6)
            self.assertAlmostEqual(high, cycle["end_s"] + 0.05 * sample.DURATION / 3, places=6)
        self.assertAlmostEqual(self.page.run("navvy.shown.clock.time"), cycle["lift_out_s"])

    def test_keeps_each_chart_inside_its_place(self):
        self.assertTrue(self.wait(
            "[...document.querySelectorAll('.chart')].every(chart => "
            "[...chart.querySelectorAll('canvas')].every(canvas => "
            "canvas.getBoundingClientRect().right <= chart.getBoundingClientRect().right + 1))"))

    def test_shows_the_values_of_all_charts_under_the_pointer(self):
        self.page.run("document.querySelectorAll('#charts button').forEach(button => { "
                      "if (button.textContent === 'Whole run') button.click(); })")
        texts = ("Object.fromEntries([...document.querySelectorAll('#charts .chart')].map(chart => "
                 "[chart.querySelector('h3').textContent, "
                 "chart.querySelector('.legend .value').textContent]))")
        before = self.page.run(texts)
        self.page.run("(() => { const plot = document.querySelector('#charts .plot'); "
                      "const canvas = plot.querySelectorAll('canvas')[1]; "
                      "const r = plot.getBoundingClientRect(); "
                      "canvas.dispatchEvent(new MouseEvent('mousemove', {bubbles: true, "
                      "clientX: r.left + navvy.shown.parts[0].section.charts[0].graph"
                      ".toDomXCoord(3.17), clientY: r.top + 60})); })()")
        after = self.page.run(texts)
        # The sample digs with a period of 12.67 s, so the payload is largest at 3.17 s.
        self.assertAlmostEqual(float(after["Payload [kg]"]), 820, delta=5)
        self.assertGreater(sum(before[title] != after[title] for title in after), 3)

    def test_plots_any_channel_on_demand(self):
        before = self.count(".chart")
        self.page.run("(() => { const list = document.querySelector('#charts select'); "
                      "list.value = String(navvy.runs[0].telemetry.names.indexOf("
                      "'digger/stability/margin')); "
                      "list.dispatchEvent(new Event('change')); })()")
        self.assertEqual(self.count(".chart"), before + 1)
        self.assertIn("digger/stability/margin", self.text(".chart h3"))
        self.page.run("document.querySelector('.chart h3 button').click()")
        self.assertEqual(self.count(".chart"), before)

    def test_draws_the_map_at_the_chosen_time(self):
        # A copy is read, as reading the map itself often makes the browser print a hint.
        probe = ("(() => { const map = document.querySelector('#plan canvas.map'); "
                 "const copy = document.createElement('canvas'); "
                 "copy.width = map.width; copy.height = map.height; "
                 "const context = copy.getContext('2d', {willReadFrequently: true}); "
                 "context.drawImage(map, 0, 0); "
                 "const data = context.getImageData(0, 0, map.width, map.height).data; "
                 "let sum = 0; for (let i = 0; i < data.length; i += 4) "
                 "sum += data[i] - data[i + 2]; return sum; })()")
        self.page.run("document.querySelector('#plan').scrollIntoView()")
        self.page.run("navvy.shown.clock.set(0)")
        self.assertTrue(self.wait("document.querySelector('#plan .side').textContent"
                                  ".includes('At 0.0 s')"))
        early = self.page.run(probe)
        self.page.run("navvy.shown.clock.set(38)")
        self.assertTrue(self.wait("document.querySelector('#plan .side').textContent"
                                  ".includes('At 38.0 s')"))
        # Cut is red, so the map gets redder while the trench grows.
        self.assertGreater(self.page.run(probe), early)

    def test_shows_height_change_and_design_under_the_pointer(self):
        self.page.run("(() => { const map = document.querySelector('#plan canvas.map'); "
                      "const r = map.getBoundingClientRect(); map.dispatchEvent(new PointerEvent("
                      "'pointermove', {clientX: r.left + 0.5 * r.width, "
                      "clientY: r.top + 0.5 * r.height})); })()")
        text = self.text("#plan .readout")
        for part in ("height", "change", "design"):
            self.assertIn(part, text)

    def test_plays(self):
        self.page.run("navvy.shown.clock.set(1); document.querySelector('#player .play').click()")
        self.assertTrue(self.wait("navvy.shown.clock.time > 1.05"))
        self.page.run("document.querySelector('#player .play').click()")
        self.assertFalse(self.page.run("navvy.shown.clock.playing"))

    def test_fits_a_phone(self):
        self.page.size(390, 800)
        try:
            self.assertTrue(self.wait("document.documentElement.scrollWidth <= 390"))
        finally:
            self.page.size(*WINDOW)


class OddRuns(PageCase):
    """Names that look like markup, missing members, broken data, two runs, large sites."""

    def test_shows_a_name_that_looks_like_markup_as_text(self):
        name = "</script><b>x"
        run = sample.run(name)
        run["notes"] = ["<img src=x onerror=alert(1)>"]
        run["telemetry"]["names"][2] = "<i>digger</i>/bucket/payload"
        self.open(run, title=name)
        self.assertEqual(self.text("#head h1"), name)
        self.assertEqual(self.page.run("document.title"), name)
        self.assertEqual(self.count("main b, main img[src=x], main .chart i i"), 0)
        self.assertEqual(self.text("#head .notes li"), "<img src=x onerror=alert(1)>")

    def test_gives_a_reason_for_each_missing_member(self):
        self.open(sample.broken_run())
        self.assertIn("not complete", self.text("#head .notes"))
        for section in ("outcome", "results", "charts", "plan", "scene3d", "media", "scene"):
            self.assertGreaterEqual(self.count("#%s .absent" % section), 1, section)
        self.assertIsNone(self.page.run("navvy.heights(0, 1)"))
        self.assertTrue(self.page.run("document.querySelector('#player').hidden"))

    def test_plays_an_embedded_video_from_the_page(self):
        run = sample.run()
        run["videos"] = [{"name": "side", "type": "video/mp4", "data": "AAAA"}]
        self.open(run)
        self.assertTrue(self.page.run("document.querySelector('video').src.startsWith('blob:')"))

    def test_leaves_out_a_part_that_cannot_be_unpacked(self):
        run = sample.run()
        run["telemetry"]["values"] = run["telemetry"]["values"][:400]
        run["frames"]["poses"] = ""
        self.open(run)
        self.assertIn("could not read the telemetry", self.text("#head .notes"))
        self.assertIn("could not read the frames", self.text("#head .notes"))
        self.assertEqual(self.count("#charts .chart"), 0)
        self.assertEqual(self.count("#plan canvas.map"), 1)

    def test_draws_at_most_300_by_300_vertices(self):
        # The largest site needs no data: only indices are formed.
        self.open(sample.broken_run())
        for n, low, high in ((2048, 900, 1100), (2048, 0, 2048), (300, 10, 200), (1, 0, 1),
                             (2048, 2000, 2048), (2048, 100, 1900)):
            got = self.page.run("navvy.unevenIndices(%d, %d, %d)" % (n, low, high))
            self.assertLessEqual(len(got), 300)
            self.assertEqual((got[0], got[-1]), (0, n - 1))
            self.assertEqual(got, sorted(set(got)))

    def test_compares_two_runs(self):
        self.open(sample.run(), sample.run("deeper sample", 2.5, 1.2, 1350, "out/deeper"))
        rows = self.page.run("[...document.querySelectorAll('#differences tbody tr')].map("
                             "row => [row.cells[0].textContent, row.cells[3].querySelector("
                             "'[data-value]').dataset.value])")
        self.assertAlmostEqual(float(dict(rows)["Bank volume dug"]), 2.5 - 2.123456789012345)
        self.assertEqual(self.count("#compare .chart"), 1)
        self.assertEqual(self.count("#compare canvas.map"), 1)
        self.assertIn("Largest difference 0.142 m", self.text("#compare .side"))
        self.page.run("document.querySelectorAll('.run-choice button')[1].click()")
        self.assertEqual(self.text("#head h1"), "deeper sample")

    def test_says_why_two_sites_cannot_be_compared(self):
        other = sample.run()
        other["grid"] = dict(other["grid"], origin_m=[5.0, 5.0])
        self.open(sample.run(), other)
        self.assertIn("different places", self.text("#compare"))
        self.open(sample.run(), sample.broken_run())
        self.assertIn("no summary.json", self.text("#compare"))
        self.assertIn("no readable heights", self.text("#compare"))


class ThreeDimensions(PageCase):
    """The 3D view of runs that lack a part, and of one run after the other."""

    webgl = True

    def test_draws_ground_and_machines_in_3d(self):
        self.open(sample.run())
        self.assertEqual(self.page.run("(() => { const view = navvy.shown.parts[2].view; "
                                       "view.draw(); return view.renderer.info.render.calls > 8; "
                                       "})()"), True)

    def test_shows_machines_without_ground_and_ground_without_machines(self):
        run = sample.run()
        run.update(grid=None, start="", design=None)
        self.open(run)
        self.assertEqual(self.count("#scene3d canvas"), 1)
        self.assertEqual(self.count("#plan .absent"), 1)
        run = sample.run()
        run.update(frames=None, telemetry=None, phases=[])
        self.open(run)
        self.assertIn("no recorded frames", self.text("#scene3d"))
        self.assertEqual(self.count("#plan canvas.map"), 1)

    def test_shows_the_other_run_in_the_same_view(self):
        self.open(sample.run(), sample.run(depth=1350))
        for i in (1, 0):
            self.page.run("document.querySelectorAll('.run-choice button')[%d].click()" % i)
            self.assertEqual(self.count("#scene3d canvas"), 1)


if __name__ == "__main__":
    unittest.main()
