# SPDX-License-Identifier: Apache-2.0
"""The Gymnasium environment; skipped without Gymnasium."""
import unittest
import warnings

import numpy as np

try:
    import gymnasium
    from gymnasium.utils.env_checker import check_env

    from navvy import env as dig  # registers Navvy/Dig-v0
except ImportError as error:
    raise unittest.SkipTest("skipped: " + str(error))


class Dig(unittest.TestCase):
    def test_passes_the_checker_without_a_warning(self):
        with warnings.catch_warnings(record=True) as caught:
            warnings.simplefilter("always")
            env = gymnasium.make("Navvy/Dig-v0", duration=2, worlds=1)
            check_env(env.unwrapped, skip_render_check=True)
            env.close()
        self.assertEqual([str(one.message) for one in caught], [])

    def test_is_repeatable_and_truncated_in_time(self):
        env = gymnasium.make("Navvy/Dig-v0", duration=1, worlds=2)
        actions = np.random.default_rng(5).uniform(-1, 1, (10, 4)).astype(np.float32)
        runs = []
        for _ in range(2):
            first, info = env.reset(seed=11)
            rows = [first]
            for action in actions:
                found, reward, terminated, truncated, _ = env.step(action)
                rows.append(np.append(found, reward))
            runs.append(np.concatenate(rows))
        np.testing.assert_array_equal(runs[0], runs[1])
        self.assertFalse(terminated)
        self.assertTrue(truncated)
        with self.assertRaises(ValueError):
            env.unwrapped.step(np.full(4, np.nan))
        env.close()

    def test_seeds_vary_soil_stance_and_ground_within_their_bounds(self):
        scenes = [dig.scene_of(number, 0.3) for number in range(4)]
        plain = scenes[0]
        for read in (
            lambda scene: scene.soil.cohesion_pa,
            lambda scene: scene.soil.friction_angle_deg,
            lambda scene: scene.machine[0].pose,
        ):
            self.assertEqual(len({read(scene) for scene in scenes}), 4)
        for scene in scenes:
            self.assertLessEqual(abs(scene.soil.cohesion_pa / plain.soil.cohesion_pa - 1), 0.3)
            self.assertTrue((np.abs(scene.machine[0].pose[:2]) <= 0.5).all())
        ratios = {
            round(scene.soil.residual_cohesion_pa / scene.soil.cohesion_pa, 6) for scene in scenes
        }
        self.assertEqual(len(ratios), 1)
        env = dig.DigEnv(worlds=4)
        heights = []
        for number in range(3):
            _, info = env.reset(options={"world": number})
            self.assertEqual(info["world"], number)
            heights.append(env._world.columns.copy())
        self.assertGreater(np.abs(heights[1] - heights[2]).max(), 0.01)
        self.assertGreater(len({env.reset(seed=seed)[1]["world"] for seed in range(6)}), 1)
        env.close()

    def test_a_scoop_earns_what_it_lifts(self):
        env = dig.DigEnv(duration=20, worlds=1)
        env.reset(seed=0)
        total = 0.0
        # Down, in, curled, up.
        dig_in, drag = ((-0.5, 0, 0), 9), ((-0.1, -0.6, -0.1), 26)
        curl, lift = ((0.2, -0.3, -1), 16), ((0.8, 0, -0.3), 25)
        for (boom, arm, bucket), count in (dig_in, drag, curl, lift):
            for _ in range(count):
                found, reward, terminated, _, _ = env.step(np.array([boom, arm, bucket, 0]))
                total += reward
                self.assertFalse(terminated)
        self.assertGreater(found[10], 0.5)
        self.assertGreater(found[14], 0.3)
        self.assertAlmostEqual(total, found[14], delta=0.1)
        env.close()


class Batch(unittest.TestCase):
    def run_batch(self, workers):
        envs = gymnasium.make_vec("Navvy/Dig-v0", num_envs=3, duration=1, worlds=2, workers=workers)
        actions = np.random.default_rng(5).uniform(-1, 1, (14, 3, 4)).astype(np.float32)
        first, info = envs.reset(seed=3)
        rows, ends = [first], []
        for action in actions:
            found, rewards, terminated, truncated, _ = envs.step(action)
            self.assertTrue(envs.observation_space.contains(found))
            rows.append(np.column_stack([found, rewards]).ravel())
            ends.append(truncated.tolist())
        envs.close()
        return np.concatenate([row.ravel() for row in rows]), ends, info

    def test_is_the_same_for_every_number_of_workers_and_for_single_members(self):
        one, ends, info = self.run_batch(1)
        other, _, _ = self.run_batch(3)
        np.testing.assert_array_equal(one, other)
        self.assertIn("world", info)
        # An episode of ten actions, the step that resets, and the next episode.
        self.assertEqual([row[0] for row in ends], [False] * 9 + [True] + [False] * 4)
        single = gymnasium.make("Navvy/Dig-v0", duration=1, worlds=2)
        found, _ = single.reset(seed=4)
        np.testing.assert_array_equal(found, one[:48].reshape(3, 16)[1])
        single.close()


if __name__ == "__main__":
    unittest.main()
