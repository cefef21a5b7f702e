"""Runs that are killed leave no half-written file, and go on to the same bytes."""

import itertools
import random
import shutil
import signal
import subprocess
import time
import unittest

from support import (IS_LONG, FaultCase, copy_photographs, environment,
                     is_temporary, run, start)

SEED = 20240607
KILLS_OF_RUN, KILLS_OF_MERGE = (60, 40) if IS_LONG else (20, 10)
KILLS_BEFORE_A_RESULT = 5
PATIENCE_S = 20  # of a test on a machine that has much else to do


class Kills(FaultCase):
    """`run` and `merge` on three photographs of the room."""

    def setUp(self):
        super().setUp()
        self.random = random.Random(SEED)
        self.images = copy_photographs(self.folder / "images")
        self.measure_whole("--max-tilt", 1)

    def measure_whole(self, *options):
        """An undisturbed run: its files, and how long it takes."""
        self.photographs = ["--intrinsics", self.images / "K.txt", *options]
        shutil.rmtree(self.folder / "whole", ignore_errors=True)
        begin = time.monotonic()
        self.succeed(self.arguments_of_run("whole"))
        self.duration_s = time.monotonic() - begin

    def arguments_of_run(self, name):
        """Output and cache in a folder of this name."""
        return ["run", self.images, *self.photographs,
                "--output", self.folder / name / "out",
                "--cache", self.folder / name / "cache"]

    def arguments_of_merge(self, name):
        """A model, and photographs to measure."""
        return ["merge", self.folder / "model/scene.lowlap",
                "--images", self.images, *self.photographs,
                "--output", self.folder / name / "out",
                "--cache", self.folder / name / "cache"]

    def kill(self, arguments, with_signal=signal.SIGKILL):
        """Starts the command and ends it; false if it was done before."""
        process = start(arguments)
        moment_s = self.random.uniform(0, 1.1 * self.duration_s)
        try:
            process.communicate(timeout=moment_s)
        except subprocess.TimeoutExpired:
            process.send_signal(with_signal)
            process.communicate(timeout=PATIENCE_S)
            return True
        self.assertEqual(process.returncode, 0)
        return False

    def kill_often(self, arguments_of, expected, kills):
        """Kills, checks what is there, and after some kills goes on to the end,
        from what a killed run left, or over a result that is there."""
        done = 0
        broken = self.folder / "broken"
        while done < kills:
            for _ in range(min(KILLS_BEFORE_A_RESULT, kills - done)):
                if self.kill(arguments_of("broken")):
                    done += 1
                else:  # from the start again, beside the result
                    shutil.rmtree(broken / "cache")
                self.check_whole(broken, expected)
            self.succeed(arguments_of("broken"))
            self.check_same(broken, expected)
            shutil.rmtree(broken / self.random.choice(["cache", "out", "."]))

    def test_run_goes_on_after_kills(self):
        self.kill_often(self.arguments_of_run, self.folder / "whole",
                        KILLS_OF_RUN)

    def test_merge_goes_on_after_kills(self):
        shutil.copytree(self.folder / "whole/out", self.folder / "model")
        self.succeed(self.arguments_of_merge("merged"))
        self.kill_often(self.arguments_of_merge, self.folder / "merged",
                        KILLS_OF_MERGE)

    def test_interrupted_runs_leave_nothing_behind(self):
        for with_signal in (signal.SIGINT, signal.SIGTERM) * 4:
            self.kill(self.arguments_of_run("broken"), with_signal)
            self.check_whole(self.folder / "broken", self.folder / "whole")
            left = list((self.folder / "broken").rglob("*.tmp*"))
            self.assertEqual(left, [])
        self.succeed(self.arguments_of_run("broken"))
        self.check_same(self.folder / "broken", self.folder / "whole")

    def test_a_kill_before_every_change_of_the_file_system(self):
        # Tilted views are kept, too; the adjustment writes no files.
        self.measure_whole("--max-tilt", 1.5, "--no-adjust")
        arguments = self.arguments_of_run("broken")
        whole, broken = self.folder / "whole", self.folder / "broken"
        for over_a_result in (True, False):
            shutil.rmtree(broken, ignore_errors=True)
            shutil.copytree(whole, broken)
            for first in itertools.count(1):
                if not over_a_result:
                    for path in (broken / "out").iterdir():
                        if not is_temporary(path.name):
                            path.unlink()
                done = run(arguments, env=environment(first=first,
                                                      error="kill"))
                self.check_whole(broken, whole)
                if done.returncode == 0:
                    break
                self.assertEqual(done.returncode, -signal.SIGKILL)
            self.assertGreater(first, 15)
            self.check_same(broken, whole)


if __name__ == "__main__":
    unittest.main()
