"""lowlap calibrates photographs that hardly overlap.

    solution = lowlap.run("images", "K.txt")
    for id, view in solution.scene.views.items():
        print(view.filename, solution.scene.find_pose(id).center)

run() starts from photographs, solve() from a scene that read() has read, or
from the matches of COLMAP or OpenMVG; merge() makes one model of broken ones;
scales() and diagnose() look at what is measured, compare() at the averaging
strategies, evaluate() at true cameras. TranslationScaleEstimator is the
translation step alone, for a program that has a view graph in memory.

Options are keyword arguments with the names of the command line's flags. What
goes wrong is an Error. Long calls run without the interpreter's lock, and stop
on KeyboardInterrupt.
"""

from lowlap._base import Error, TranslationAverager
from lowlap import _lowlap
from lowlap._lowlap import *  # noqa: F401,F403

__version__ = _lowlap.__version__
__all__ = ["Error", "TranslationAverager"] + [
    name for name in dir(_lowlap) if not name.startswith("_")]
