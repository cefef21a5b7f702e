"""Builds the wheel: CMake makes the package, setuptools packs it.

    pip wheel --no-build-isolation --no-deps src/python

With LOWLAP_BUILD_DIR, the name of a build folder of CMake, what is built there
already is not built again.
"""

import os
import re
import shutil
import subprocess
import sys
from pathlib import Path

from setuptools import Extension, setup
from setuptools.command.build_ext import build_ext

ROOT = Path(__file__).resolve().parents[2]


def project_version():
    listing = (ROOT / "CMakeLists.txt").read_text()
    return re.search(r"project\(lowlap VERSION ([0-9.]+)", listing).group(1)


class CMakeBuild(build_ext):
    def build_extension(self, extension):
        build = Path(os.environ.get("LOWLAP_BUILD_DIR") or self.build_temp).resolve()
        if not (build / "CMakeCache.txt").exists():
            build.mkdir(parents=True, exist_ok=True)
            subprocess.check_call(
                ["cmake", "-S", ROOT, "-B", build, "-DCMAKE_BUILD_TYPE=Release",
                 "-DLOWLAP_BUILD_PYTHON=ON", "-DLOWLAP_BUILD_CLI=OFF",
                 "-DLOWLAP_BUILD_TESTS=OFF", f"-DPython_EXECUTABLE={sys.executable}"]
                + (["-GNinja"] if shutil.which("ninja") else []))
        subprocess.check_call(
            ["cmake", "--build", build, "--target", "lowlap_python", "--parallel"])
        target = Path(self.get_ext_fullpath(extension.name)).resolve()
        target.parent.mkdir(parents=True, exist_ok=True)
        shutil.copy(build / "python" / "lowlap" / target.name, target)


setup(
    version=project_version(),
    packages=["lowlap"],
    package_data={"lowlap": ["py.typed", "*.pyi"]},
    ext_modules=[Extension("lowlap._lowlap", sources=[])],
    cmdclass={"build_ext": CMakeBuild},
)
