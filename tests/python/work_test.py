"""Long work: progress, Ctrl-C, other threads."""
import signal
import subprocess
import sys
import threading
import time
import unittest

import numpy as np

import imgmesh
import picture_files

IMAGE = np.round(picture_files.ramp(48, 32) * 255).astype(np.uint8)
# Ends while daemon threads build.
ENDS = """
import threading, time, numpy, imgmesh
image = numpy.random.default_rng(1).integers(0, 256, (400, 400, 3), numpy.uint8)
def work(progress):
    while True:
        imgmesh.build(image, progress=progress)
for progress in (None, lambda fraction, stage: None):
    threading.Thread(target=work, args=(progress,), daemon=True).start()
time.sleep({})
"""
LARGE = np.random.default_rng(1).integers(0, 256, (800, 1000, 3), np.uint8)


class Work(unittest.TestCase):
    def test_progress(self):
        seen = []
        imgmesh.build(LARGE, progress=lambda fraction, stage: seen.append((fraction, stage)))
        fractions = [fraction for fraction, stage in seen]
        self.assertEqual(fractions, sorted(fractions))
        self.assertTrue(all(0 <= f <= 1 and isinstance(s, str) and s for f, s in seen))
        self.assertGreater(len(seen), 2)

    def test_an_exception_of_progress_ends_the_work(self):
        for after in (1, 2, 3):
            calls = []

            def stop(fraction, stage):
                calls.append(fraction)
                if len(calls) == after:
                    raise LookupError("enough")

            with self.assertRaisesRegex(LookupError, "enough"):
                imgmesh.build(LARGE, progress=stop)
            self.assertEqual(len(calls), after)
        self.assertEqual(len(imgmesh.build(IMAGE).levels), 1)  # and later work is as always

    def test_ctrl_c(self):
        def press():
            time.sleep(0.3)
            signal.raise_signal(signal.SIGINT)  # Python's handler runs in the main thread

        presser = threading.Thread(target=press)
        presser.start()
        start = time.monotonic()
        with self.assertRaises(KeyboardInterrupt):
            while True:
                imgmesh.build(LARGE, preset="best", refine=300)
        presser.join()
        self.assertLess(time.monotonic() - start, 10)  # the build would take minutes

    def test_daemon_threads_at_the_end(self):
        for seconds in (0.05, 0.3, 0.6):
            run = subprocess.run([sys.executable, "-c", ENDS.format(seconds)], capture_output=True, text=True, timeout=60)
            self.assertEqual((run.returncode, run.stdout, run.stderr), (0, "", ""))

    def test_other_threads_run_meanwhile(self):
        ticks, done = [0], threading.Event()

        def tick():
            while not done.is_set():
                ticks[0] += 1
                time.sleep(0.001)

        other = threading.Thread(target=tick)
        other.start()
        imgmesh.build(LARGE)
        during = ticks[0]
        done.set()
        other.join()
        self.assertGreater(during, 20)

    def test_many_threads(self):
        """Several builds at once give what each gives alone."""
        inputs = [np.roll(IMAGE, 5 * k, axis=1) for k in range(6)]
        alone = [imgmesh.build(image, density=6) for image in inputs]
        failures = []

        def work(k):
            try:
                for _ in range(4):
                    mesh = imgmesh.build(inputs[k], density=6, threads=1 + k % 3, progress=lambda f, s: None)
                    np.testing.assert_array_equal(mesh.vertices, alone[k].vertices)
                    np.testing.assert_array_equal(mesh.face_ids, alone[k].face_ids)
                    np.testing.assert_array_equal(np.asarray(mesh.reconstruct()), np.asarray(alone[k].reconstruct()))
                    mesh.segment(threshold=3)
                    with self.assertRaises(imgmesh.Error):
                        imgmesh.build(inputs[k], faces=1)
            except BaseException as failure:
                failures.append(failure)

        threads = [threading.Thread(target=work, args=(k,)) for k in range(6)]
        for thread in threads:
            thread.start()
        for thread in threads:
            thread.join()
        self.assertEqual(failures, [])


if __name__ == "__main__":
    unittest.main()
