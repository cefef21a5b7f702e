"""What the tests of faults share: the command, small inputs, faulty calls."""

import json
import os
import shutil
import subprocess
import tempfile
import unittest
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
ROOM = ROOT / "sfm_data/samples/room"
CASTLE = ROOT / "sfm_data/samples/castle-p19"
DATA = Path(os.environ.get("LOWLAP_DATA", ROOT.parent / "shared/data"))
COMMAND = os.environ["LOWLAP_COMMAND"]
FAULTY_CALLS = os.environ["LOWLAP_FAULTY_CALLS"]
# Three times as many random moments, for ctest --label-regex long.
IS_LONG = "LOWLAP_LONG" in os.environ
ALL_CALLS = "open,write,mkdir,sync,rename,link"


def environment(calls=ALL_CALLS, first=0, last=None, error="28", count=None):
    """The environment in which the calls from `first` to `last` fail."""
    faults = {"LD_PRELOAD": FAULTY_CALLS, "FAULTY_CALLS": calls,
              "FAULTY_FIRST": str(first), "FAULTY_ERROR": str(error)}
    if last is not None:
        faults["FAULTY_LAST"] = str(last)
    if count is not None:
        faults["FAULTY_COUNT"] = str(count)
    return {**os.environ, **faults}


def start(arguments, **options):
    """Starts the command with its messages in a pipe."""
    return subprocess.Popen([COMMAND, *map(str, arguments)],
                            stdout=subprocess.DEVNULL, stderr=subprocess.PIPE,
                            text=True, **options)


def run(arguments, **options):
    """Runs the command to its end; a hang is an error."""
    return subprocess.run([COMMAND, *map(str, arguments)], text=True,
                          capture_output=True, check=False,
                          **{"timeout": 300, **options})


def copy_photographs(folder, count=3):
    """The first photographs of the bundled room, with their calibration."""
    folder.mkdir()
    for path in sorted((ROOM / "images").glob("*.jpg"))[:count]:
        shutil.copy(path, folder)
    shutil.copy(ROOM / "images/K.txt", folder)
    return folder


def without_times(value):
    """A JSON value without what differs from run to run: times and memory."""
    if isinstance(value, dict):
        return {key: without_times(part) for key, part in value.items()
                if not key.endswith(("_s", "_mb", "_ms"))}
    if isinstance(value, list):
        return [without_times(part) for part in value]
    return value


def content(path):
    """The bytes of a file, or what a summary says apart from times."""
    if path.name == "summary.json":
        return without_times(json.loads(path.read_text()))
    return path.read_bytes()


def is_temporary(name):
    """Whether this is no name of a result."""
    return ".tmp" in name or name.endswith(("-journal", "-wal", "-shm"))


def files_in(folder):
    """Relative name and content of all files below a folder."""
    folder = Path(folder)
    return {str(path.relative_to(folder)): path.read_bytes()
            for path in sorted(folder.rglob("*")) if path.is_file()}


class FaultCase(unittest.TestCase):
    """A folder of its own for each test."""

    def setUp(self):
        self.folder = Path(tempfile.mkdtemp(prefix="lowlap_faults_"))
        self.addCleanup(shutil.rmtree, self.folder, ignore_errors=True)

    def castle(self):
        """The photographs of six megapixels; skips the test without them."""
        images = DATA / "strecha/castle-P19/images"
        if not images.exists():
            print("skipped: no data")
            self.skipTest("no data")
        return images

    def succeed(self, arguments, **options):
        """Runs the command, which must succeed."""
        done = run(arguments, **options)
        self.assertEqual(done.returncode, 0, (arguments, done.stderr))
        return done

    def check_whole(self, folder, expected):
        """Every file with the name of a result is that of `expected`."""
        for path in Path(folder).rglob("*"):
            if path.is_dir() or is_temporary(path.name):
                continue
            other = Path(expected) / path.relative_to(folder)
            self.assertTrue(other.exists(), path)
            self.assertTrue(content(path) == content(other),
                            f"{path} differs from {other}")

    def check_same(self, folder, expected):
        """The same files as in `expected`, and no temporary one."""
        names = sorted(files_in(folder))
        self.assertEqual(names, sorted(files_in(expected)))
        self.check_whole(folder, expected)

    def check_refused(self, done, about, reason=None):
        """Exit code 1 with a message about the file, no crash."""
        self.assertEqual(done.returncode, 1, done.stderr)
        errors = [line for line in done.stderr.splitlines()
                  if line.startswith("error: ")]
        self.assertEqual(len(errors), 1, done.stderr)
        self.assertIn(str(about), errors[0])
        if reason is not None:
            self.assertRegex(errors[0], reason)
