# SPDX-License-Identifier: Apache-2.0
"""Rollouts: many copies of a world at once."""
import unittest

import numpy as np

import navvy


class Rollout(unittest.TestCase):
    def test_is_the_same_for_every_number_of_workers_and_for_single_steps(self):
        session = navvy.Session("bucket_path")
        session.step(500)
        self.assertGreater(session.particle_count, 100)
        names = [one.name for one in session.inputs if one.name.endswith("velocity")][:2]
        controls = np.random.default_rng(3).uniform(-0.5, 0.8, (4, 6, 2))
        before = session.state_hash()
        results = [
            navvy.rollout(session, controls, inputs=names, steps=10, workers=n) for n in (1, 2, 4)
        ]
        self.assertEqual(session.state_hash(), before)
        np.testing.assert_array_equal(results[0], results[1])
        np.testing.assert_array_equal(results[0], results[2])
        single = session.fork()
        for row in range(controls.shape[1]):
            for name, value in zip(names, controls[3, row]):
                single[name] = value
            single.step(10)
            np.testing.assert_array_equal(single.observe(), results[0][3, row])
        self.assertGreater(np.ptp(results[0][:, -1], axis=0).max(), 0.01)

    def test_begins_with_snapshots_and_records_chosen_outputs(self):
        world = navvy.Session("bucket_path")
        world.step(100)
        early = world.save()
        world.step(100)
        name = next(one.name for one in world.inputs if one.name.endswith("velocity"))
        outputs = [world.outputs[0].name, world.outputs[1].name]
        found = navvy.rollout(
            world, np.zeros((2, 3, 1)), inputs=[name], outputs=outputs, states=[early, world.save()]
        )
        self.assertEqual(found.shape, (2, 3, 2))
        world.load(early)
        world[name] = 0
        world.step()
        np.testing.assert_array_equal(found[0, 0], world.observe(outputs=outputs))

    def test_names_a_wrong_number_and_its_place(self):
        world = navvy.Session("bucket_path")
        name = next(one.name for one in world.inputs if one.name.endswith("velocity"))
        controls = np.zeros((2, 3, 1))
        controls[1, 2, 0] = np.nan
        with self.assertRaisesRegex(navvy.InputError, r"controls\[1, 2\].*" + name):
            navvy.rollout(world, controls, inputs=[name])
        with self.assertRaisesRegex(ValueError, r"\(n, t, k\)"):
            navvy.rollout(world, np.zeros((2, 3)), inputs=[name])
        with self.assertRaisesRegex(ValueError, "shape"):
            navvy.rollout(world, np.zeros((2, 3, 5)), inputs=[name])
        with self.assertRaises(TypeError):
            navvy.rollout(world, np.zeros((1, 1, 1), dtype="U3"), inputs=[name])
        with self.assertRaises(navvy.InputError):
            navvy.rollout(world, np.zeros((1, 1, 1)), inputs=["no/such/input"])
        world.step()


if __name__ == "__main__":
    unittest.main()
