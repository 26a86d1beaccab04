# SPDX-License-Identifier: Apache-2.0
"""The Gymnasium environment; skipped without Gymnasium."""
import unittest
import warnings

import numpy as np

try:
    import gymnasium
    from gymnasium.utils.env_checker import check_env

    import navvy.env  # noqa: F401  registers Navvy/Dig-v0
except ImportError as error:
    raise unittest.SkipTest("skipped: " + str(error))


class Dig(unittest.TestCase):
    def test_passes_the_checker_without_a_warning(self):
        with warnings.catch_warnings(record=True) as caught:
            warnings.simplefilter("always")
            env = gymnasium.make("Navvy/Dig-v0", duration=2, soils=1)
            check_env(env.unwrapped, skip_render_check=True)
            env.close()
        self.assertEqual([str(one.message) for one in caught], [])

    def test_is_repeatable_and_truncated_in_time(self):
        env = gymnasium.make("Navvy/Dig-v0", duration=1, soils=2)
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


if __name__ == "__main__":
    unittest.main()
