"""What the tests of the module share."""

from pathlib import Path

import lowlap
import numpy as np

ROOT = Path(__file__).resolve().parents[2]
CASTLE = ROOT / "sfm_data/samples/castle-p19"
ROOM = ROOT / "sfm_data/samples/room"


class LeastSquares(lowlap.TranslationAverager):
    """Centres and lengths by linear least squares on directions and ratios."""

    def name(self):
        return "least_squares"

    def solve(self, problem):
        n, m = len(problem.views), len(problem.edges)
        # C_second - C_first - s direction = 0, for unknown C and s.
        directions = np.zeros((m, 3, 3 * n + m))
        for e, (first, second) in enumerate(problem.edges):
            directions[e, :, 3 * second:3 * second + 3] = np.eye(3)
            directions[e, :, 3 * first:3 * first + 3] = -np.eye(3)
            directions[e, :, 3 * n + e] = -problem.directions[e]
        ratios = np.zeros((len(problem.ratios), 3 * n + m))
        for k, (reference, target) in enumerate(problem.ratios):
            ratios[k, 3 * n + target] = 1
            ratios[k, 3 * n + reference] = -np.exp(problem.log_ratios[k])
        gauge = np.zeros((4, 3 * n + m))
        gauge[:3, :3] = np.eye(3)
        gauge[3, 3 * n:] = 1 / m
        system = np.vstack([directions.reshape(3 * m, -1), ratios, gauge])
        right = np.zeros(len(system))
        right[-1] = 1
        solution = np.linalg.lstsq(system, right, rcond=None)[0]
        return solution[:3 * n].reshape(n, 3)
