"""Interrupts are answered within a second, whatever the command does."""

import random
import signal
import statistics
import subprocess
import time
import unittest

from support import IS_LONG, FaultCase, is_temporary, start

SEED = 11
INTERRUPTS = 30 if IS_LONG else 10
START_S = 0.6  # until the command has loaded and answers itself
LONGEST_S = 6
WITHIN_S = 1.0  # and what a kill takes, on a machine that is busy


class Interrupts(FaultCase):
    """`run` on photographs of six megapixels, whose features take seconds."""

    def answer_s(self, process, asked_for):
        """How long the process takes to end after a signal, its messages."""
        begin = time.monotonic()
        process.send_signal(asked_for)
        try:
            _, messages = process.communicate(timeout=60)
        except subprocess.TimeoutExpired:
            process.kill()
            process.communicate()
            self.fail("no answer in a minute")
        self.assertIn(process.returncode, (128 + asked_for, -signal.SIGKILL),
                      messages)
        return time.monotonic() - begin, messages

    def test_studies_end_within_a_second_and_go_on(self):
        moments = random.Random(SEED)
        out = self.folder / "study"
        kept = 0
        for _ in range(6):
            process = start(["robustness", "-o", out])
            time.sleep(START_S + moments.uniform(0, 2))
            took_s, _ = self.answer_s(process, signal.SIGINT)
            self.assertLess(took_s, 2 * WITHIN_S)
            self.assertEqual([path for path in out.iterdir()
                              if is_temporary(path.name)], [])
            text = (out / "trials.jsonl").read_text()
            self.assertTrue(text.endswith("\n"))
            self.assertGreaterEqual(len(text), kept)
            kept = len(text)

    def test_run_ends_within_a_second(self):
        images = self.castle()
        moments = random.Random(SEED)
        answers_s, kills_s, slowest = [], [], ""
        for n in range(INTERRUPTS):
            # Every second goes on from the cache, to interrupt later stages;
            # every fifth is killed: how long the machine takes by itself.
            cache = self.folder / ("cache" if n % 2 == 0 else f"cache{n}")
            out = self.folder / f"out{n}"
            process = start(["run", images, "--intrinsics", images / "K.txt",
                             "--cache", cache, "-o", out])
            time.sleep(START_S + moments.uniform(0, LONGEST_S))
            if n % 5 == 4:
                kills_s.append(self.answer_s(process, signal.SIGKILL)[0])
                continue
            took_s, messages = self.answer_s(
                process, moments.choice([signal.SIGINT, signal.SIGTERM]))
            answers_s.append(took_s)
            slowest = messages if took_s == max(answers_s) else slowest
            self.assertIn("error: interrupted", messages)
            self.assertFalse(out.exists())
            for path in cache.glob("*.tmp*"):  # killed before, not interrupted
                self.assertEqual(n % 2, 0, path)
        print(f"answered within {max(answers_s):.2f} s, median "
              f"{statistics.median(answers_s):.2f} s; killed within "
              f"{max(kills_s):.2f} s")
        self.assertLess(max(answers_s), WITHIN_S + max(kills_s), slowest)


if __name__ == "__main__":
    unittest.main()
