# SPDX-License-Identifier: Apache-2.0
"""What the commands of `./dev` compute by themselves."""
import contextlib
import io
import pathlib
import re
import sys
import tempfile
import unittest

ROOT = pathlib.Path(__file__).resolve().parents[2]
sys.path.insert(0, str(ROOT / "tools"))
sys.path.insert(0, str(ROOT / "bench" / "peers"))
import benches  # noqa: E402
import build  # noqa: E402
import compare as peers  # noqa: E402
import dev  # noqa: E402
import fuzz  # noqa: E402
import gpu_check  # noqa: E402
import jobs  # noqa: E402
import lint  # noqa: E402
import packages  # noqa: E402
import scene_run  # noqa: E402
import testing  # noqa: E402
import validate  # noqa: E402
import workspace  # noqa: E402


def printed(function, *arguments):
    """Returns what a call prints on standard output."""
    with contextlib.redirect_stdout(io.StringIO()) as text:
        function(*arguments)
    return text.getvalue()


class Commands(unittest.TestCase):
    def test_help_has_a_line_for_every_command(self):
        for name in dev.COMMANDS:
            self.assertRegex(dev.usage(), r"(?m)^  %s +[A-Z].*\.$" % name)

    def test_help_of_every_command_explains_it_and_runs_nothing(self):
        for name, command in dev.COMMANDS.items():
            with self.subTest(name):
                try:
                    text = printed(command, ["--help"])
                except SystemExit as ended:
                    self.assertEqual(ended.code, 0)
                    continue
                self.assertIn("usage: ./dev " + name, text)

    def test_unknown_command_fails(self):
        with contextlib.redirect_stderr(io.StringIO()) as text:
            self.assertEqual(dev.main(["nonsense"]), 1)
        self.assertIn("unknown command 'nonsense'", text.getvalue())

    def test_status_of_a_failed_program_is_passed_on(self):
        with self.assertRaises(workspace.DevError) as failed:
            workspace.run("false")
        self.assertEqual(failed.exception.status, 1)
        with self.assertRaises(workspace.DevError) as killed:
            workspace.run("sh", "-c", "kill -TERM $$")
        self.assertEqual(killed.exception.status, 128 + 15)

    def test_clock(self):
        self.assertEqual(workspace.clock(4000), "1:06:40")
        self.assertEqual(workspace.clock(69.6), "0:01:10")


class Packages(unittest.TestCase):
    def test_no_install_asks_nobody(self):
        packages.enabled = False
        try:
            self.assertEqual(printed(packages.install, ["no-such-package"]), "")
        finally:
            packages.enabled = True

    def test_packages_are_listed_once(self):
        self.assertEqual(len(packages.BASE), len(set(packages.BASE)))


class Scenes(unittest.TestCase):
    def test_last_value_of_an_option_counts(self):
        self.assertEqual(scene_run.option_value(["--out", "a", "--out=b"], "--out"), "b")
        self.assertEqual(scene_run.option_value(["--outer", "a"], "--out"), "")

    def test_results_go_to_the_folder_of_the_scenes_name(self):
        self.assertEqual(scene_run.results_folder("trench", []), "out/trench")
        self.assertEqual(scene_run.results_folder("scenarios/trench.sdf", ["--out=out/x"]), "out/x")
        self.assertEqual(scene_run.results_folder("no_such_scene.sdf", []), "")


class Configuring(unittest.TestCase):
    def test_warnings_are_printed_with_what_follows(self):
        text = "-- fine\nCMake Warning at x:\n  why\n1\n2\n3\n4\n5\n"
        self.assertEqual(
            printed(build.print_warnings, text), "CMake Warning at x:\n  why\n1\n2\n3\n4\n"
        )


class Reports(unittest.TestCase):
    def report(self, statuses):
        text = "<testsuite>%s</testsuite>" % "".join(
            '<testcase name="a" status="%s"/>' % each for each in statuses
        )
        with tempfile.TemporaryDirectory() as folder:
            path = pathlib.Path(folder) / "report.xml"
            path.write_text(text)
            return testing.ran_something(path)

    def test_skipped_tests_did_not_run(self):
        self.assertFalse(self.report(["notrun", "disabled"]))
        self.assertTrue(self.report(["notrun", "run"]))
        self.assertTrue(self.report(["fail"]))
        self.assertFalse(testing.ran_something("no/such/report.xml"))


class Lint(unittest.TestCase):
    def test_files_with_most_changed_lines_come_first(self):
        self.assertEqual(
            lint.most_changed_first("1\t2\tsrc/a.cpp\n10\t0\tsrc/b.cpp\n0\t3\tsrc/0.cpp\n"),
            ["src/b.cpp", "src/0.cpp", "src/a.cpp"],
        )


class Benches(unittest.TestCase):
    def test_machine_name_is_a_folder_name(self):
        self.assertRegex(benches.machine_name(), r"^[a-z0-9]+(-[a-z0-9]+)*$")


class Peers(unittest.TestCase):
    def test_least_times_of_several_rounds_count(self):
        first = {"particles": 1000, "steps": 20, "wall_s": 0.5, "processor_s": 0.8}
        second = {"particles": 1000, "steps": 20, "wall_s": 0.7, "processor_s": 0.4}
        row = peers.better(peers.better(None, first), second)
        self.assertEqual((row["wall_s"], row["processor_s"]), (0.5, 0.4))
        for rate, expected in zip(peers.rates(row), (0.04, 0.05)):
            self.assertAlmostEqual(rate, expected)

    def test_rates_of_navvy_stand_over_those_of_a_peer_of_its_size(self):
        row = {"threads": 2, "step_ms": 1.7, "steps": 10}
        rows = [
            {**row, "code": "Navvy", "particles": 1000, "wall_s": 0.1, "processor_s": 0.2},
            {**row, "code": "Other", "particles": 1000, "wall_s": 0.5, "processor_s": 0.6},
        ]
        self.assertRegex(printed(peers.print_table, rows), r"Other .* 5\.0 +3\.0\n")

    def test_longer_steps_count_as_simulated_time(self):
        row = {"threads": 1, "particles": 1000, "steps": 10, "wall_s": 0.1, "processor_s": 0.2}
        rows = [{**row, "code": "Navvy", "step_ms": 1.5}, {**row, "code": "Other", "step_ms": 15}]
        said = printed(peers.print_table, rows)
        self.assertRegex(said, r"Other .* 1\.0 +1\.0 +1\.5 +0\.75 +0\.1 +0\.1\n")

    def test_result_of_a_script_is_its_line_of_json(self):
        self.assertEqual(peers.reported('noise\nPEER {"wall_s": 2.0}\n'), {"wall_s": 2.0})

    def test_a_missing_environment_leaves_codes_out(self):
        with tempfile.TemporaryDirectory() as folder:
            blocked = pathlib.Path(folder) / "file"
            blocked.write_text("")
            said = printed(peers.made_environment, blocked / "environment")
        for name, package in (("Taichi", "taichi"), ("Warp", "warp-lang"), ("Newton", "newton")):
            self.assertIn("left out %s, which needs the PyPI packages %s=" % (name, package), said)


class GpuCheck(unittest.TestCase):
    # As clang and ptxas print them.
    CODE = (
        "define dso_local void @scatter(float addrspace(1)* noundef %a) #0 "
        "!kernel_arg_type !4 !reqd_work_group_size !7 {\n"
        "!4 = !{!\"float*\"}\n!7 = !{i32 72, i32 3, i32 1}\n"
    )
    PTX = ".visible .entry scatter(\n\t.param .u64 scatter_param_0\n)\n{\n"
    REPORT = (
        "ptxas info    : Compiling entry function 'scatter' for 'sm_90'\n"
        "ptxas info    : Function properties for scatter\n"
        "    8 bytes stack frame, 4 bytes spill stores, 12 bytes spill loads\n"
        "ptxas info    : Used 112 registers, used 1 barriers, 25768 bytes smem\n"
    )

    def test_the_rows_state_what_clang_and_the_assembler_report(self):
        sizes = gpu_check.group_sizes(self.CODE)
        self.assertEqual(sizes, {"scatter": 216})
        self.assertIn(")\n.reqntid 216, 1, 1\n{", gpu_check.with_group_sizes(self.PTX, sizes))
        (kernel,) = gpu_check.kernels_of(self.REPORT, sizes)
        self.assertEqual(kernel, gpu_check.Kernel("scatter", 216, 112, 16, 8, 25768))

    def test_the_scarcest_resource_limits_the_groups(self):
        # Seven warps: 64 // 7 groups by warps, 16 // 7 by registers, 233472 // 26880 by memory.
        kernel = gpu_check.Kernel("scatter", 216, 112, 0, 0, 25768)
        self.assertEqual(
            kernel.limits(), {"warps": 9, "registers": 2, "local memory": 8, "groups": 32}
        )
        self.assertEqual(kernel.row()[-3:], (2, "22 %", "registers"))
        small = gpu_check.Kernel("twist", 28, 40, 0, 0, 0)
        self.assertEqual(small.row()[-3:], (32, "50 %", "groups"))

    def test_missing_tools_are_an_error_unless_they_may_be_missing(self):
        packages.enabled, library = False, gpu_check.LIBRARY
        gpu_check.LIBRARY = pathlib.Path("no/such/library.bc")
        try:
            with self.assertRaisesRegex(workspace.DevError, "apt-get install clang libclc-14"):
                gpu_check.gpu_check_command([])
            said = printed(gpu_check.gpu_check_command, ["--skip-without-tools"])
        finally:
            packages.enabled, gpu_check.LIBRARY = True, library
        self.assertIn("SKIPPED gpu-check: missing clang and libclc", said)


class Fuzz(unittest.TestCase):
    def test_totals_add_up(self):
        text = "target,aim,inputs,sanitized,seconds,crashes,last\nobj,10,5,1,2,0,2026-01-01\n"
        text = fuzz.added_total(text, "obj", 7, 7, 60, 1, "2026-02-02")
        self.assertEqual(text.splitlines()[1], "obj,10,12,8,62,1,2026-02-02")
        text = fuzz.added_total(text, "new", 7, 0, 60, 0, "2026-02-02")
        self.assertEqual(text.splitlines()[2], "new,1000000,7,0,60,0,2026-02-02")
        text = fuzz.added_total(text, "urdf", 7, 0, 60, 0, "2026-02-02")
        self.assertEqual(text.splitlines()[-1], "urdf,100000,7,0,60,0,2026-02-02")

    def test_a_walk_ends_after_seconds_or_inputs(self):
        words = ["urdf", "--inputs", "5"]
        self.assertEqual(fuzz.taken_limit(words).option(), "-runs=5")
        self.assertEqual(words, ["urdf"])
        self.assertEqual(fuzz.taken_limit(words).option(), "-max_total_time=60")
        self.assertEqual(fuzz.taken_limit(["7"]).option(), "-max_total_time=7")
        for wrong in (["--inputs"], ["--inputs", "many"], ["--inputs", "0"]):
            with self.assertRaisesRegex(workspace.DevError, "--inputs needs a number"):
                fuzz.taken_limit(wrong)

    def test_targets_are_found_with_and_without_their_ending(self):
        self.assertEqual(fuzz.chosen_targets("obj"), ["obj"])
        self.assertEqual(fuzz.chosen_targets("obj_fuzz"), ["obj"])
        self.assertGreater(len(fuzz.chosen_targets("")), 5)
        with self.assertRaisesRegex(workspace.DevError, "no fuzz target 'x'; there is: control"):
            fuzz.chosen_targets("x")


class Jobs(unittest.TestCase):
    def test_seeds_are_scenes_that_navvy_can_read(self):
        reference = (ROOT / "docs/reference/scene.md").read_text(encoding="utf-8")
        table = reference.split("### `world/navvy:ground/hills`")[1].split("###")[0]
        for element in re.findall(r"<(\w+_m)>", jobs.HILLS):
            self.assertIn("`%s`" % element, table)
        for name in jobs.names():
            scene = (ROOT / "scenarios/jobs" / (name + ".sdf")).read_text(encoding="utf-8")
            self.assertEqual(scene.count("</navvy:ground>"), 1, name)
            self.assertRegex(scene, r'soil ref="\w+"')


class Validation(unittest.TestCase):
    def setUp(self):
        self.folder = tempfile.TemporaryDirectory()
        self.addCleanup(self.folder.cleanup)
        self.done = pathlib.Path(self.folder.name) / "passed"

    def test_passed_cases_are_remembered(self):
        self.done.write_text("A.B\nC.D\n")
        self.assertEqual(validate.Validation(self.done).done, {"A.B", "C.D"})

    def test_time_left_follows_the_pace_so_far(self):
        validation = validate.Validation(self.done)
        validation.seconds = {"A.B": 100, "C.D": 50}
        validation.due = ["A.B", "C.D"]
        validation.results = {"A.B": ("passed", 100)}
        validation.begun -= 200
        self.assertEqual(
            validation.progress("x"), "validate 1/2 x; elapsed 0:03:20, left about 0:01:40"
        )

    def test_deviations_without_a_case_are_refused(self):
        with self.assertRaisesRegex(workspace.DevError, "which is no slow case"):
            validate.check_known_deviations([])

    def test_stamp_does_not_change_by_itself(self):
        self.assertEqual(validate.sources_stamp(), validate.sources_stamp())


if __name__ == "__main__":
    unittest.main()
