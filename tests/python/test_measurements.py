import tempfile
import unittest
from pathlib import Path

import lowlap
import numpy as np

from support import LeastSquares


class ScalesTest(unittest.TestCase):
    def test_ratios_of_simulated_lengths(self):
        scene, truth = lowlap.simulate(views=8, pairs="window:2", noise=0.5)
        ratios = lowlap.scales(scene)
        self.assertEqual([ratio.views for ratio in ratios], lowlap.triplets(scene))
        deviations = []
        for ratio in ratios:
            self.assertEqual(ratio.is_meaningful, ratio.verdict == "meaningful")
            if not ratio.is_meaningful:
                continue
            first, middle, last = (truth.find_pose(view).center for view in ratio.views)
            expected = np.log(np.linalg.norm(last - middle) / np.linalg.norm(middle - first))
            deviations.append((ratio.log_ratio - expected) / ratio.stddev)
            low, high = ratio.interval
            self.assertLess(low, ratio.log_ratio)
            self.assertLess(ratio.log_ratio, high)
        self.assertGreater(len(deviations), 8)
        self.assertLess(np.median(np.abs(deviations)), 3)

    def test_support_by_kind(self):
        scene, _ = lowlap.simulate(views=4, trifocal_points=0.0, trifocal_lines=0.0)
        ratio = next(ratio for ratio in lowlap.scales(scene) if ratio.is_meaningful)
        kinds = {kind.kind: kind for kind in ratio.kinds}
        self.assertEqual(sum(kind.inliers for kind in kinds.values()), ratio.num_inliers)
        self.assertAlmostEqual(sum(kind.information_share for kind in kinds.values()), 1)
        self.assertEqual(kinds["points"].candidates, 0)
        self.assertEqual(ratio.find_kind("coplanar").inliers, kinds["coplanar"].inliers)
        self.assertIsNone(ratio.find_kind("no_such"))
        self.assertEqual(ratio.coplanar_inliers.shape, (kinds["coplanar"].inliers, 2))

    def test_flags_of_kinds(self):
        scene, _ = lowlap.simulate(views=6)
        for asked in (True, False):
            kinds = {kind.kind for ratio in lowlap.scales(scene, coplanar_points=asked)
                     for kind in ratio.kinds}
            self.assertEqual("plane_points" in kinds, asked)


class DiagnosisTest(unittest.TestCase):
    def test_a_chain_hangs_on_its_ratios(self):
        scene, _ = lowlap.simulate(views=5, pairs="chain")
        diagnosis = lowlap.diagnose(scene)
        self.assertEqual(diagnosis.groups, [[0, 1, 2, 3, 4]])
        self.assertEqual([len(group) for group in diagnosis.groups_by_directions],
                         [2, 2, 2, 2])
        self.assertEqual([each.view for each in diagnosis.articulation_views], [1, 2, 3])
        self.assertTrue(diagnosis.is_firm)
        self.assertEqual(diagnosis.floating, [])
        self.assertEqual(len(diagnosis.ratios), 3)
        self.assertIn("scale", str(diagnosis))
        self.assertIsInstance(diagnosis.to_dict(), dict)

    def test_without_ratios_the_parts_float(self):
        scene, _ = lowlap.simulate(views=4, pairs="chain", points=0, lines=0)
        diagnosis = lowlap.diagnose(scene, features="points")
        self.assertFalse(diagnosis.is_firm)
        self.assertEqual(len(diagnosis.groups), 3)
        self.assertTrue(diagnosis.floating)

    def test_reads_files_itself(self):
        scene, _ = lowlap.simulate(views=4, pairs="window:2")
        with tempfile.TemporaryDirectory() as folder:
            path = Path(folder) / "scene.lowlap"
            scene.write(path)
            self.assertEqual(str(lowlap.diagnose(path)), str(lowlap.diagnose(scene)))
        self.assertTrue(lowlap.diagnose(scene, min_inliers=0).is_firm)


class HostTest(unittest.TestCase):
    def setUp(self):
        self.scene, self.truth = lowlap.simulate(views=6, pairs="cycle")

    def fill(self, **options):
        estimator = lowlap.TranslationScaleEstimator(**options)
        for id, view in self.scene.views.items():
            features = self.scene.features[id]
            estimator.add_view(id, self.scene.find_intrinsic(id).calibration,
                               view.width_px, view.height_px, features.points_px,
                               features.segments_px)
        for pair, pose in self.scene.relative_poses.items():
            estimator.add_relative_pose(*pair, pose.rotation, 3 * pose.direction,
                                        pose.point_inliers, pose.line_inliers)
        return estimator

    def test_gives_ratios_and_centres(self):
        estimate = self.fill().estimate(threads=2)
        self.assertEqual(list(estimate.poses), list(range(6)))
        self.assertEqual(estimate.unplaced, [])
        # Of six, four join neighbours that share much.
        self.assertGreaterEqual(sum(ratio.is_meaningful for ratio in estimate.ratios), 4)
        # Distances in units of one of them do not depend on the gauge.
        def distances(poses):
            centers = np.array([poses[id].center for id in range(6)])
            all_pairs = np.linalg.norm(centers[:, None] - centers, axis=2)
            return all_pairs / all_pairs[0, 1]

        np.testing.assert_allclose(distances(estimate.poses), distances(self.truth.poses),
                                   atol=1e-3)

    def test_keeps_rotations_that_are_known(self):
        estimator = self.fill(features="points,lines", strategy="chain")
        for id in range(6):
            estimator.set_rotation(id, self.truth.find_pose(id).rotation)
        estimate = estimator.estimate()
        np.testing.assert_allclose(estimate.poses[4].rotation,
                                   self.truth.find_pose(4).rotation, atol=1e-12)

    def test_takes_strategies_of_lowlap(self):
        chain = lowlap.TranslationScaleEstimator(strategy=lowlap.averager("chain"))
        self.assertIsInstance(chain, lowlap.TranslationScaleEstimator)
        for wrong in (3, LeastSquares()):
            with self.assertRaisesRegex(TypeError, "one of lowlap's"):
                lowlap.TranslationScaleEstimator(strategy=wrong)

    def test_names_what_is_wrong(self):
        estimator = self.fill()
        estimator.add_relative_pose(0, 77, np.eye(3), [1, 0, 0], np.zeros((0, 2), int))
        with self.assertRaisesRegex(lowlap.Error, "77"):
            estimator.estimate()


if __name__ == "__main__":
    unittest.main()
