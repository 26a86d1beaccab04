# SPDX-License-Identifier: Apache-2.0
"""Misuse of worlds: each is a clear exception, and the world goes on."""
import os
import signal
import threading
import time
import unittest

import numpy as np

import navvy


class Misuse(unittest.TestCase):
    def setUp(self):
        self.world = navvy.Session("bucket_path")

    def test_names_numbers_and_shapes_are_checked(self):
        world = self.world
        with self.assertRaisesRegex(navvy.InputError, "no_such"):
            world["no_such"]
        with self.assertRaises(navvy.InputError):
            world.get(10**6)
        with self.assertRaises(navvy.InputError):
            world.get(-1)
        with self.assertRaises(navvy.InputError):
            world.get(10**30)
        with self.assertRaisesRegex(TypeError, "name .str. or its index"):
            world.get(1.5)
        for bad in (float("nan"), float("inf")):
            with self.assertRaisesRegex(navvy.InputError, "finite"):
                world.set(0, bad)
        with self.assertRaises(TypeError):
            world.set(0, "fast")
        with self.assertRaises(ValueError):
            world.step(-1)
        with self.assertRaises(TypeError):
            world.step(1.5)
        count = len(world.outputs)
        with self.assertRaisesRegex(TypeError, "float64"):
            world.observe(np.zeros(count, dtype=np.float32))
        with self.assertRaisesRegex(ValueError, "shape"):
            world.observe(np.zeros(count + 1))
        with self.assertRaisesRegex(ValueError, "row-major"):
            world.observe(np.zeros(2 * count)[::2])
        fixed = np.zeros(count)
        fixed.flags.writeable = False
        with self.assertRaisesRegex(ValueError, "read-only"):
            world.observe(fixed)
        with self.assertRaises(TypeError):
            world.observe([0.0] * count)
        world.step()

    def test_a_closed_world_says_so(self):
        with self.world as world:
            pass
        for call in (world.step, world.save, world.observe, lambda: world.time, world.close):
            with self.assertRaisesRegex(navvy.ClosedError, "closed"):
                call()

    def test_a_second_thread_is_refused_while_one_steps(self):
        world = self.world
        entered, stop, errors, refused = threading.Event(), threading.Event(), [], 0

        def work():
            try:
                while not stop.is_set():
                    entered.set()
                    world.step(20)
            except Exception as error:  # the assertion below shows it
                errors.append(error)

        thread = threading.Thread(target=work)
        thread.start()
        entered.wait()
        deadline = time.monotonic() + 20
        while refused < 20 and time.monotonic() < deadline:
            try:
                world.time
            except navvy.BusyError as error:
                self.assertIn("another thread", str(error))
                refused += 1
            time.sleep(0.001)
        stop.set()
        thread.join()
        self.assertEqual(refused, 20)
        # The thread may in turn have met a call of this one.
        self.assertTrue(all(isinstance(error, navvy.BusyError) for error in errors))
        other = navvy.Session("bucket_path")
        other.step(world.steps)
        self.assertEqual(other.state_hash(), world.state_hash())

    def test_threads_with_a_world_each_compute_the_same(self):
        worlds = [self.world] + self.world.fork(2)
        threads = [threading.Thread(target=one.step, args=(300,)) for one in worlds]
        for one in threads:
            one.start()
        for one in threads:
            one.join()
        self.assertEqual(len({one.state_hash() for one in worlds}), 1)

    def test_a_forked_process_is_asked_to_spawn(self):
        self.world.step()
        read, write = os.pipe()
        child = os.fork()
        if child == 0:
            text = ""
            for call in (lambda: navvy.Session("bucket_path"), self.world.step):
                try:
                    call()
                    text += "no error;"
                except navvy.DeviceError as error:
                    text += ("spawn" if "spawn" in str(error) else str(error)) + ";"
            os.write(write, text.encode())
            os._exit(0)
        os.close(write)
        self.assertEqual(os.read(read, 1000).decode(), "spawn;spawn;")
        os.close(read)
        os.waitpid(child, 0)
        self.world.step()

    def test_an_interrupt_ends_a_long_step(self):
        timer = threading.Timer(0.3, os.kill, (os.getpid(), signal.SIGINT))
        timer.start()
        begin = time.monotonic()
        with self.assertRaises(KeyboardInterrupt):
            self.world.step(10**6)
        self.assertLess(time.monotonic() - begin, 5)
        self.world.step()

    def test_a_world_cannot_be_pickled(self):
        import pickle

        with self.assertRaisesRegex(TypeError, "save"):
            pickle.dumps(self.world)


if __name__ == "__main__":
    unittest.main()
