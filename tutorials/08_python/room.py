"""Tutorial 8: from photographs to camera centres in Python, and an averaging
strategy of one's own, compared with the built-in ones.

The room has bare walls: neighbouring photographs share half of what they show,
and hardly anything is common to three.

    cmake -S . -B build -DLOWLAP_BUILD_PYTHON=ON && cmake --build build
    PYTHONPATH=build/python python3 tutorials/08_python/room.py

Projects of other programs are taken likewise, as by the command:

    lowlap.solve("database.db", images="IMAGES")
    lowlap.solve("sfm_data.json", matchdir="matches")
    lowlap.merge(["sparse/0", "sparse/1"], images="IMAGES", intrinsics="K.txt")
"""

import sys
from pathlib import Path

import lowlap
import numpy as np

ROOM = Path(__file__).resolve().parents[2] / "sfm_data/samples/room"


def calibrate():
    # Tilted views, which would take most of the time, are not needed here.
    solution = lowlap.run(ROOM / "images", ROOM / "images/K.txt", pairs="cycle",
                          max_tilt=1, gt=ROOM / "gt_dense_cameras")
    scene = solution.scene
    for id, view in scene.views.items():
        pose = scene.find_pose(id)
        place = "not placed" if pose is None else np.round(pose.center, 3)
        print(f"{view.filename}: {len(scene.features[id].points_px)} points, {place}")
    for warning in solution.warnings:
        print("warning:", warning)
    print(f"mean position error {solution.evaluation.position.mean:.4f} m\n")
    return solution


class Walk(lowlap.TranslationAverager):
    """As simple as a strategy can be: it walks over the ratios, the surest
    first, to find the length of every relative pose, and over the relative
    poses to lay the centres end to end."""

    def name(self):
        return "walk"

    def needs(self):
        return "a ratio"

    def solve(self, problem):
        surest = np.argsort(problem.ratio_stddevs, kind="stable")
        lengths = np.full(len(problem.edges), np.nan)
        centers = np.full((len(problem.views), 3), np.nan)
        if len(surest) == 0:
            return centers
        lengths[problem.ratios[surest[0], 0]] = 1
        centers[problem.edges[problem.ratios[surest[0], 0], 0]] = 0
        found = True
        while found:
            found = False
            for k in surest:
                reference, target = problem.ratios[k]
                if np.isnan(lengths[reference]) == np.isnan(lengths[target]):
                    continue
                if np.isnan(lengths[target]):
                    lengths[target] = lengths[reference] * np.exp(problem.log_ratios[k])
                else:
                    lengths[reference] = lengths[target] * np.exp(-problem.log_ratios[k])
                found = True
                break
        found = True
        while found:
            found = False
            for (first, second), step in zip(problem.edges,
                                             lengths[:, None] * problem.directions):
                known = ~np.isnan(centers[[first, second], 0])
                if np.isnan(step[0]) or known[0] == known[1]:
                    continue
                if known[0]:
                    centers[second] = centers[first] + step
                else:
                    centers[first] = centers[second] - step
                found = True
        return centers


def main():
    solution = calibrate()
    # The scene's ratios are estimated once more, and shared by all strategies.
    comparison = lowlap.compare(solution.scene, ROOM / "gt_dense_cameras",
                                ["graph", "chain", Walk()], no_adjust=True)
    print(comparison)
    placed = {result.strategy: result.num_placed for result in comparison.results}
    # Both need ratios that chain the views, and have the same.
    return 0 if placed["walk"] == placed["chain"] > 2 else 1


if __name__ == "__main__":
    sys.exit(main())
