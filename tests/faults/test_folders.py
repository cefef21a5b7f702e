"""Folders that cannot be written, and folders that vanish."""

import errno
import os
import random
import shutil
import subprocess
import time
import unittest

from support import (COMMAND, IS_LONG, FaultCase, copy_photographs, environment,
                     files_in, run, start)

SEED = 5
NOBODY = 65534


class ReadOnly(FaultCase):
    """Folders that may be read only."""

    def setUp(self):
        super().setUp()
        self.room = self.folder / "room.lowlap"
        self.succeed(["simulate", "--views", 5, "--points", 60, "--lines", 60,
                      "-o", self.room])
        self.model = self.folder / "model"
        self.succeed(["solve", self.room, "--no-adjust", "-o", self.model])
        self.out = self.folder / "out"
        self.images = copy_photographs(self.folder / "images")

    def commands(self):
        """Commands that write to the folder `out`."""
        return [
            ["run", self.images, "--intrinsics", self.images / "K.txt",
             "--max-tilt", "1", "-o", self.out],
            ["solve", self.room, "-o", self.out],
            ["merge", self.model / "scene.lowlap", "--scene", self.room,
             "-o", self.out],
            ["compare", self.room, "-o", self.out],
            ["convert", self.room, self.out / "scene.json"],
            ["convert", self.room, self.out / "model", "--to", "limap"],
            ["simulate", "--views", 4, "-o", self.out / "scene.json"],
            ["subsets", self.room, "--drop", 1,
             "--gt", self.model / "scene.lowlap", "-o", self.out],
            ["robustness", "--quick", "-o", self.out],
        ]

    def test_a_folder_of_somebody_else(self):
        self.out.mkdir()
        as_nobody = {}
        if os.geteuid() == 0:
            as_nobody = {"user": NOBODY, "group": NOBODY, "extra_groups": []}
            self.folder.chmod(0o755)
            if subprocess.run([COMMAND, "--version"], check=False,
                              capture_output=True, **as_nobody).returncode:
                self.skipTest("the command is in a folder of root's")
        else:
            self.out.chmod(0o555)
        for arguments in self.commands():
            done = run(arguments, **as_nobody)
            with self.subTest(arguments=arguments):
                self.check_refused(done, self.out, "Permission denied")
                self.assertEqual(files_in(self.out), {})

    def test_a_file_system_that_turns_read_only(self):
        for arguments in self.commands():
            done = run(arguments, env=environment(first=1, error=errno.EROFS))
            with self.subTest(arguments=arguments):
                self.check_refused(done, self.out, "Read-only file system")

    def test_a_cache_that_may_be_read_only(self):
        cache = self.folder / "cache"
        arguments = [*self.commands()[0], "--cache", cache]
        self.succeed(arguments)
        whole = self.folder / "whole"
        self.out.rename(whole)
        if os.geteuid() != 0:
            cache.chmod(0o555)
            self.succeed(arguments)
        else:
            self.folder.chmod(0o777)
            done = run(arguments, user=NOBODY, group=NOBODY, extra_groups=[])
            self.assertEqual(done.returncode, 0, done.stderr)
        self.check_same(self.out, whole)


class Vanishing(FaultCase):
    """Folders that somebody removes while the command works."""

    def setUp(self):
        super().setUp()
        self.random = random.Random(SEED)
        self.images = copy_photographs(self.folder / "images")
        self.arguments = ["run", self.images, "--intrinsics",
                          self.images / "K.txt", "--max-tilt", "1",
                          "--no-adjust", "-o", self.folder / "out",
                          "--cache", self.folder / "cache"]
        begin = time.monotonic()
        self.succeed(self.arguments)
        self.duration_s = time.monotonic() - begin
        shutil.copytree(self.folder / "out", self.folder / "whole")

    def remove_while_running(self, names):
        """Removes folders at a random moment, and a little later again; the
        exit code and messages."""
        process = start(self.arguments)
        for moment_s in (self.random.uniform(0, self.duration_s), 0.1):
            try:
                process.wait(moment_s)
            except subprocess.TimeoutExpired:
                pass
            for name in names:
                shutil.rmtree(self.folder / name, ignore_errors=True)
        _, messages = process.communicate(timeout=60)
        return process.returncode, messages

    def test_output_and_cache(self):
        for names in (["out"], ["cache"], ["out", "cache"]) * (6 if IS_LONG else 2):
            shutil.rmtree(self.folder / "cache", ignore_errors=True)
            code, messages = self.remove_while_running(names)
            self.assertIn(code, (0, 1), messages)
            if code == 1:
                self.assertIn("error: " + str(self.folder), messages)
            elif (self.folder / "out/summary.json").exists():
                self.check_whole(self.folder / "out", self.folder / "whole")
            self.succeed(self.arguments)
            self.check_same(self.folder / "out", self.folder / "whole")

    def test_photographs(self):
        for _ in range(4):
            shutil.rmtree(self.folder / "cache", ignore_errors=True)
            code, messages = self.remove_while_running(["images"])
            self.assertIn(code, (0, 1), messages)
            if code == 1:
                self.assertIn("error: " + str(self.images), messages)
            shutil.rmtree(self.images, ignore_errors=True)
            copy_photographs(self.images)


if __name__ == "__main__":
    unittest.main()
