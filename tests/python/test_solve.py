import os
import signal
import subprocess
import sys
import tempfile
import threading
import time
import unittest
from pathlib import Path

import lowlap
import numpy as np

from support import ROOM


class SolveTest(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.scene, cls.truth = lowlap.simulate(views=8, pairs="window:2")

    def test_solves_a_scene_without_noise(self):
        before = self.scene.without_views([])
        solution = lowlap.solve(self.scene, gt=self.truth)
        self.assertEqual(self.scene, before)
        self.assertEqual(solution.num_placed, 8)
        self.assertEqual(solution.unplaced, [])
        self.assertTrue(solution.is_firm, solution.warnings)
        self.assertEqual(solution.evaluation.scope, "full")
        # The room is metric.
        self.assertLess(solution.evaluation.position.max, 1e-5)
        self.assertEqual(len(solution.evaluation.views), 8)
        self.assertTrue(solution.adjustment.converged)
        self.assertGreater(len(solution.scene.structure), 0)
        self.assertEqual([cost.name for cost in solution.costs],
                         ["rotations", "scale ratios", "poses", "structure",
                          "adjustment"])
        self.assertIn("8 of 8", repr(solution))

    def test_ties_of_the_adjustment_are_as_asked(self):
        held = lowlap.solve(self.scene).adjustment
        self.assertGreater(held.planes, 0)
        self.assertGreater(held.directions, 0)
        without = lowlap.solve(self.scene, directions=False).adjustment
        self.assertEqual((without.planes, without.directions), (held.planes, 0))
        pairs = lowlap.solve(self.scene, coplanar_ties="pairs").adjustment
        self.assertEqual((pairs.planes, pairs.directions), (0, 0))

    def test_says_how_far_the_centres_are_known(self):
        for pose in lowlap.solve(self.scene).scene.poses.values():
            self.assertEqual(pose.center_covariance.shape, (3, 3))
        unadjusted = lowlap.solve(self.scene, no_adjust=True).scene
        for pose in unadjusted.poses.values():
            self.assertIsNone(pose.center_covariance)

    def test_says_which_directions_their_matches_contradict(self):
        scene, truth = lowlap.simulate(views=9, points=30, lines=50, noise=0.5,
                                       pairs="window:2", wrong_directions=0.2,
                                       seed=17)
        solution = lowlap.solve(scene, gt=truth)
        self.assertGreater(len(solution.replaced_directions), 0)
        for replaced in solution.replaced_directions:
            self.assertGreater(replaced.error_deg, 10)
        self.assertEqual(solution.kept_outliers, [])
        self.assertEqual(solution.left_out_ratios, [])
        self.assertEqual(solution.contests, [])
        for pose in solution.reconsidered_poses:
            self.assertGreaterEqual(pose.gained_digits, 1)
            self.assertGreater(pose.rotation_deg, 0)
        self.assertLess(solution.evaluation.position.max, 0.02)

    def test_truth_may_be_a_dictionary(self):
        truth = {id: lowlap.Pose(pose.rotation, pose.center)
                 for id, pose in self.truth.poses.items()}
        solution = lowlap.solve(self.scene, no_adjust=True)
        self.assertIsNone(solution.adjustment)
        self.assertEqual(
            lowlap.evaluate(solution.scene, truth).position.rmse,
            lowlap.evaluate(solution.scene, self.truth).position.rmse)

    def test_options(self):
        points = lowlap.solve(self.scene, features=["points"], no_adjust=True)
        kinds = {kind.kind for ratio in points.scene.scale_ratios
                 for kind in ratio.kinds}
        self.assertEqual(kinds, {"points"})
        both = lowlap.solve(self.scene, features="points,lines", no_adjust=True)
        self.assertEqual({kind.kind for ratio in both.scene.scale_ratios
                          for kind in ratio.kinds}, {"points", "lines"})
        refined = lowlap.solve(self.scene, refine_intrinsics="focal")
        self.assertEqual(len(refined.scene.given_intrinsics), 1)

    def test_options_that_make_no_sense(self):
        for options in ({"criterion": "luck"}, {"criterion": ""}, {"strategy": "no_such"},
                        {"features": "dots"}, {"threads": -1},
                        {"refine_intrinsics": "colour"},
                        {"refine_intrinsics": True, "no_adjust": True},
                        {"criterion": "ransac", "threshold": -1.0}):
            with self.subTest(options), self.assertRaises(lowlap.Error) as caught:
                lowlap.solve(self.scene, **options)
            self.assertEqual(caught.exception.code, "invalid_argument")
        for options in ({"gt": {0: "here"}}, {"stratgy": "graph"}, {"threshold": "wide"},
                        {"features": 3}, {"strategy": object()}):
            with self.subTest(options), self.assertRaises(TypeError):
                lowlap.solve(self.scene, **options)

    def test_a_scene_without_measurements(self):
        empty, _ = lowlap.simulate(views=3, pairs="chain")
        empty = empty.without_views([1])
        with self.assertRaises(lowlap.Error) as caught:
            lowlap.solve(empty)
        self.assertEqual(caught.exception.code, "invalid_scene")

    def test_callbacks(self):
        stages, messages = set(), []
        lowlap.solve(self.scene, threads=2,
                     progress=lambda stage, done, total: stages.add(stage),
                     log=lambda level, message: messages.append((level, message)))
        self.assertIn("structure", stages)
        self.assertTrue(messages)
        self.assertLessEqual({level for level, _ in messages},
                             {"debug", "info", "warning"})

    def test_progress_stops_the_run(self):
        calls = []

        def stop(stage, done, total):
            calls.append(stage)
            return False

        with self.assertRaises(lowlap.Error) as caught:
            lowlap.solve(self.scene, progress=stop)
        self.assertEqual(caught.exception.code, "cancelled")
        self.assertEqual(len(calls), 1)

    def test_exceptions_of_callbacks_come_back(self):
        def fail(*_):
            raise ZeroDivisionError("mine")

        for name in ("progress", "log"):
            with self.subTest(name), self.assertRaisesRegex(ZeroDivisionError, "mine"):
                lowlap.solve(self.scene, threads=2, **{name: fail})

    def test_the_interpreter_runs_meanwhile(self):
        interval = sys.getswitchinterval()
        running, ticks = threading.Event(), 0

        def tick():
            nonlocal ticks
            while running.is_set():
                ticks += 1
                time.sleep(0)

        running.set()
        thread = threading.Thread(target=tick)
        # Threads change only where one gives way of itself.
        sys.setswitchinterval(60)
        try:
            thread.start()
            before = ticks
            lowlap.solve(self.scene)
            after = ticks
        finally:
            running.clear()
            sys.setswitchinterval(interval)
            thread.join()
        self.assertGreater(after, before)

    def test_ctrl_c_stops_the_run(self):
        scene, _ = lowlap.simulate(views=40, pairs="window:3", noise=0.5)
        reached = []

        class Last(lowlap.TranslationAverager):
            def name(self):
                return "last"

            def solve(self, problem):
                reached.append(problem)
                raise lowlap.Error("unsupported", "too late")

        # Some seconds of work without a call of Python, which would find the
        # signal by itself.
        strategies = [f"lud:max_iterations={n}" for n in range(50, 70)]
        timer = threading.Timer(0.3, os.kill, (os.getpid(), signal.SIGINT))
        timer.start()
        with self.assertRaises(KeyboardInterrupt):
            lowlap.compare(scene, strategies=["graph", *strategies, Last()])
        timer.join()
        self.assertEqual(reached, [])


class RunTest(unittest.TestCase):
    def test_gives_what_the_command_gives(self):
        command = os.environ.get("LOWLAP_COMMAND")
        if not command:
            self.skipTest("the command is not built")
        images, truth = ROOM / "images", ROOM / "gt_dense_cameras"
        with tempfile.TemporaryDirectory() as folder:
            ours, theirs = Path(folder) / "module", Path(folder) / "command"
            cache = Path(folder) / "cache"
            solution = lowlap.run(images, images / "K.txt", pairs="cycle",
                                  max_tilt=1, gt=truth, cache=cache, output=ours)
            subprocess.run(
                [command, "run", images, "--intrinsics", images / "K.txt", "--pairs",
                 "cycle", "--max-tilt", "1", "--gt", truth, "--cache", cache,
                 "--output", theirs],
                check=True, capture_output=True)
            for name in ("sfm_data.json", "scene.lowlap", "cloud.ply", "report.html"):
                self.assertEqual((ours / name).read_bytes(),
                                 (theirs / name).read_bytes(), name)
        self.assertEqual(solution.num_placed, 11)
        self.assertEqual(solution.evaluation.num_solved, 11)
        self.assertEqual(len(solution.pairs), 11)
        self.assertTrue(all(pair.accepted for pair in solution.pairs))
        self.assertEqual(solution.unrelated_views, [])

    def test_calibrations(self):
        images = ROOM / "images"
        matrix = np.loadtxt(images / "K.txt")

        class Stop(Exception):
            pass

        def stop(*_):
            raise Stop

        # Accepted: the work begins.
        for intrinsics in (matrix, matrix.tolist(), images / "K.txt"):
            with self.assertRaises(Stop):
                lowlap.run(images, intrinsics, progress=stop)
        for intrinsics, options in ((matrix, {"focal": 900.0}), (None, {"focal": 0.0})):
            with self.assertRaises(lowlap.Error) as caught:
                lowlap.run(images, intrinsics, progress=stop, **options)
            self.assertEqual(caught.exception.code, "invalid_argument")
        with self.assertRaises(TypeError):
            lowlap.run(images, "K", focal="long")
        with self.assertRaises(TypeError):
            lowlap.run(images, matrix[:2], progress=stop)


if __name__ == "__main__":
    unittest.main()
