# SPDX-License-Identifier: Apache-2.0
"""Scenes: values by the names of the schema."""
import ast
import inspect
import json
import pathlib
import pickle
import tempfile
import unittest

import map_sites
import navvy
from navvy import _navvy


class Scenes(unittest.TestCase):
    def test_values_are_attributes_in_the_units_of_the_file(self):
        scene = navvy.Scene("trench")
        self.assertEqual(scene.name, "trench")
        self.assertEqual(scene.machine.names(), ["excavator"])
        self.assertEqual(scene.machine["excavator"].pose[:2], (-9, 0))
        self.assertEqual(scene.ground.size_m, (24, 20))
        self.assertEqual(scene.solver.cell_m, 0.1)
        self.assertGreater(scene.soil.friction_angle_deg, 10)
        self.assertIn("cohesion_pa", dir(scene.soil[0]))

    def test_settings_reach_the_world(self):
        scene = navvy.Scene("trench")
        other = scene.copy()
        scene.soil.cohesion_pa = 12000
        scene.machine["excavator"].pose = (-9, 1, 0, 0, 0, 0.5)
        self.assertEqual(scene.soil["loam"].cohesion_pa, 12000)
        self.assertEqual(scene.machine[0].pose, (-9, 1, 0, 0, 0, 0.5))
        self.assertNotEqual(other.soil.cohesion_pa, 12000)
        self.assertEqual(pickle.loads(pickle.dumps(scene)).soil.cohesion_pa, 12000)
        del scene

    def test_what_the_schema_refuses_changes_nothing(self):
        scene = navvy.Scene("trench")
        before = scene.soil.cohesion_pa
        with self.assertRaises(navvy.InputError) as caught:
            scene.soil.cohesion_pa = -5
        fault = caught.exception.faults[0]
        self.assertIn("cohesion_pa", fault.element)
        self.assertTrue(fault.rule)
        self.assertEqual(scene.soil.cohesion_pa, before)
        with self.assertRaisesRegex(navvy.InputError, "cohesion_pa"):
            scene.soil.cohesion = 5
        with self.assertRaisesRegex(AttributeError, "cohesion_pa"):
            scene.soil.cohesion
        with self.assertRaisesRegex(KeyError, "excavator"):
            scene.machine["digger"]

    def test_faults_name_file_line_element_and_rule(self):
        text = (
            '<sdf version="1.9" xmlns:navvy="navvy"><world name="w">\n'
            '<navvy:soil ref="loam"/>\n<navvy:ground><size_m>-4 4</size_m></navvy:ground>\n'
            "</world></sdf>"
        )
        with tempfile.TemporaryDirectory() as folder:
            path = pathlib.Path(folder) / "bad.sdf"
            path.write_text(text)
            with self.assertRaises(navvy.InputError) as caught:
                navvy.Scene(path)
        fault = caught.exception.faults[0]
        self.assertEqual((fault.severity, fault.file, fault.line), ("error", str(path), 3))
        self.assertIn("size_m", fault.element)
        self.assertIn(str(path) + ":3", str(caught.exception))
        self.assertIsInstance(caught.exception, ValueError)

    def test_maps_of_every_format_without_gdal_give_one_ground(self):
        with tempfile.TemporaryDirectory() as folder:
            map_sites.check_sites(navvy, folder)

    def test_unknown_scenes_are_refused_with_a_suggestion(self):
        with self.assertRaisesRegex(navvy.InputError, "trench"):
            navvy.Scene("trensh")
        self.assertIn("trench", navvy.scenes())
        self.assertEqual(json.loads(navvy.schema())["name"], "sdf")


class Stubs(unittest.TestCase):
    def test_list_all_that_the_extension_has(self):
        text = (pathlib.Path(navvy.__file__).parent / "_navvy.pyi").read_text()
        stubs = ast.parse(text)
        functions = {node.name for node in stubs.body if isinstance(node, ast.FunctionDef)}
        classes = {
            node.name: {item.name for item in node.body if isinstance(item, ast.FunctionDef)}
            for node in stubs.body
            if isinstance(node, ast.ClassDef)
        }
        for name, value in vars(_navvy).items():
            if name.startswith("_"):
                continue
            if inspect.isclass(value):
                own = {n for n in vars(value) if not n.startswith("__")}
                self.assertEqual(own - classes[name], set(), name)
            else:
                self.assertIn(name, functions)


if __name__ == "__main__":
    unittest.main()
