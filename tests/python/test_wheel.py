"""pip builds a wheel that works, without a network."""

import os
import shutil
import subprocess
import sys
import tempfile
import unittest
import zipfile
from pathlib import Path

from support import ROOT


class WheelTest(unittest.TestCase):
    def test_builds_and_imports(self):
        with tempfile.TemporaryDirectory() as folder:
            # A copy, since setuptools writes beside the sources.
            source = Path(folder) / "source"
            shutil.copytree(ROOT / "src/python", source / "src/python")
            shutil.copy(ROOT / "CMakeLists.txt", source)
            subprocess.run(
                [sys.executable, "-m", "pip", "wheel", "--no-build-isolation",
                 "--no-deps", "--no-index", "-q", "-w", folder, source / "src/python"],
                check=True, env={**os.environ, "PYTHONPATH": ""})
            wheel, = Path(folder).glob("lowlap-*.whl")
            with zipfile.ZipFile(wheel) as files:
                names = set(files.namelist())
                files.extractall(Path(folder) / "site")
            for name in ("__init__.py", "__init__.pyi", "_base.py", "py.typed"):
                self.assertIn(f"lowlap/{name}", names)
            found = subprocess.run(
                [sys.executable, "-c",
                 "import lowlap; print(lowlap.__file__, lowlap.__version__)"],
                check=True, capture_output=True, text=True,
                env={**os.environ, "PYTHONPATH": str(Path(folder) / "site")}).stdout
            file, version = found.split()
            self.assertTrue(Path(file).is_relative_to(folder), file)
            self.assertIn(f"-{version}-", wheel.name)


if __name__ == "__main__":
    unittest.main()
