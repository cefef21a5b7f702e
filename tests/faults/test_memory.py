"""Too little memory: a message and an exit code, no crash and no hang."""

import resource
import unittest

from support import FaultCase, copy_photographs, files_in, run

MEGABYTE = 1 << 20


def limited(megabytes):
    """What a process does before it becomes the command."""
    size = megabytes * MEGABYTE
    return lambda: resource.setrlimit(resource.RLIMIT_AS, (size, size))


class Memory(FaultCase):
    """The address space is limited, as by `ulimit -v`."""

    def run_limited(self, arguments, megabytes):
        """Runs the command, which must not crash; its exit code."""
        done = run(arguments, preexec_fn=limited(megabytes), timeout=120)
        # 127: not even its libraries find a place.
        self.assertIn(done.returncode, (0, 1, 127), done.stderr)
        if done.returncode == 1:
            self.assertRegex(done.stderr, "(?m)^error: .*memory")
        return done.returncode

    def run_photographs(self, images, out, megabytes, threads):
        """Of photographs, without a cache."""
        code = self.run_limited(
            ["run", images, "--intrinsics", images / "K.txt", "--no-cache",
             "--threads", threads, "-o", out], megabytes)
        if code != 0:
            self.assertFalse(out.exists() and files_in(out))
        return code

    def test_photographs_of_a_megapixel(self):
        images = copy_photographs(self.folder / "images")
        codes = {megabytes: self.run_photographs(
            images, self.folder / f"out_{megabytes}_{threads}", megabytes, threads)
            for megabytes in (350, 400, 500) for threads in (1, 4)}
        self.assertEqual(codes[350], 1)

    def test_photographs_of_six_megapixels(self):
        images = self.castle()
        self.assertEqual(self.run_photographs(images, self.folder / "out", 500,
                                              2), 1)

    def test_commands_without_photographs(self):
        room = self.folder / "room.lowlap"
        self.succeed(["simulate", "--views", 15, "--points", 400,
                      "--lines", 200, "-o", room])
        codes = [self.run_limited(
            ["solve", room, "--threads", 4, "-o", self.folder / "out"],
            megabytes) for megabytes in (*range(220, 280, 3), 4000)]
        self.assertIn(1, codes)
        self.assertEqual(codes[-1], 0)


if __name__ == "__main__":
    unittest.main()
