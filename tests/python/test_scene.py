import collections.abc
import gc
import json
import pickle
import tempfile
import unittest
import warnings
from pathlib import Path

import lowlap
import numpy as np

from support import CASTLE


class SceneTest(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.scene, cls.truth = lowlap.simulate(views=6, pairs="window:2", noise=0.5)

    def test_mappings_are_those_of_python(self):
        views = self.scene.views
        self.assertIsInstance(views, collections.abc.Mapping)
        self.assertEqual(len(views), 6)
        self.assertEqual(list(views), list(range(6)))
        self.assertEqual(views.keys(), list(views))
        self.assertIn(5, views)
        self.assertNotIn(6, views)
        self.assertNotIn("five", views)
        self.assertIsNone(views.get(6))
        # Ids may be None, and whatever is no id is no key.
        self.assertIsNone(self.scene.intrinsics.get(None))
        self.assertEqual(views.get("five", 5), 5)
        for key in ("five", None, -1, (0, 1)):
            with self.assertRaises(KeyError):
                views[key]
        with self.assertRaises(KeyError):
            views[6]
        self.assertEqual([view.filename for view in views.values()],
                         [views[id].filename for id, _ in views.items()])
        self.assertIn((0, 1), self.scene.relative_poses)
        self.assertEqual(self.scene.relative_poses[0, 1].views, (0, 1))

    def test_weaknesses_have_names(self):
        self.assertIsNone(self.scene.relative_poses[0, 1].weakness)
        with tempfile.TemporaryDirectory() as folder:
            file = Path(folder) / "scene.json"
            self.scene.write(file)
            content = json.loads(file.read_text())
            pose = content["lowlap"]["relative_poses"][0]
            pose["weakness"] = "surroundings"
            file.write_text(json.dumps(content))
            views = tuple(pose["views"])
            read = lowlap.read(file).relative_poses[views]
        self.assertEqual(read.weakness, "surroundings")

    def test_unrelated_pairs_are_an_array(self):
        self.assertEqual(self.scene.unrelated_pairs.shape, (0, 2))
        with tempfile.TemporaryDirectory() as folder:
            file = Path(folder) / "scene.json"
            self.scene.write(file)
            content = json.loads(file.read_text())
            content["lowlap"]["unrelated_pairs"] = [0, 4, 0, 5]
            file.write_text(json.dumps(content))
            pairs = lowlap.read(file).unrelated_pairs
        self.assertEqual(pairs.tolist(), [[0, 4], [0, 5]])

    def test_arrays_are_on_the_scenes_memory(self):
        features = self.scene.features[0]
        points = features.points_px
        self.assertFalse(points.flags.owndata)
        self.assertEqual(points.ctypes.data, features.points_px.ctypes.data)
        self.assertEqual(points.ctypes.data,
                         self.scene.features[0].points_px.ctypes.data)
        pose = self.scene.relative_poses[0, 1]
        track = next(iter(self.scene.point_tracks.values()))
        for array in (points, features.segments_px, pose.rotation, pose.direction,
                      pose.point_inliers, pose.line_inliers, track):
            self.assertFalse(array.flags.owndata)
            self.assertFalse(array.flags.writeable)
            with self.assertRaises(ValueError):
                array[0] = 0

    def test_arrays_keep_the_scene_alive(self):
        scene, _ = lowlap.simulate(views=4)
        points = scene.features[2].points_px
        expected = points.copy()
        tracks = [track for track in scene.point_tracks.values()]
        lengths = [len(track) for track in tracks]
        del scene
        gc.collect()
        # New scenes would take the memory if it were free.
        others = [lowlap.simulate(views=4, seed=seed) for seed in range(1, 6)]
        np.testing.assert_array_equal(points, expected)
        self.assertEqual([len(track) for track in tracks], lengths)
        self.assertEqual(len(others), 5)

    def test_arrays_hold_what_the_scene_says(self):
        pose = self.scene.relative_poses[0, 1]
        np.testing.assert_allclose(pose.rotation @ pose.rotation.T, np.eye(3),
                                   atol=1e-12)
        self.assertAlmostEqual(np.linalg.norm(pose.direction), 1)
        # The epipolar constraint, from the arrays alone: a matrix read by
        # columns instead of rows, or a wrong stride, would not meet it.
        first, second = (self.scene.features[view] for view in pose.views)
        inverse = [np.linalg.inv(self.scene.find_intrinsic(view).calibration)
                   for view in pose.views]
        matches = pose.point_inliers
        rays = [np.c_[points[column], np.ones(len(matches))] @ k.T
                for points, column, k in ((first.points_px, matches[:, 0], inverse[0]),
                                          (second.points_px, matches[:, 1], inverse[1]))]
        normals = np.cross(np.broadcast_to(pose.direction, rays[0].shape),
                           rays[0] @ pose.rotation.T)
        sines = (normals * rays[1]).sum(1) / np.linalg.norm(normals, axis=1)
        focal = self.scene.find_intrinsic(0).fx_px
        # Two points with half a pixel of noise each, and their depths' share.
        self.assertLess(np.sqrt(np.mean(sines ** 2)) * focal, 2)
        segments = first.segments_px
        self.assertEqual(segments.shape, (len(first.segment_stddevs_px), 4))
        self.assertTrue((np.linalg.norm(segments[:, 2:] - segments[:, :2], axis=1) > 1).all())
        for repeated in (first.repeated_points, first.repeated_segments):
            self.assertEqual((repeated.shape, repeated.dtype), ((0,), np.uint32))

    def test_structure_projects_into_its_observations(self):
        errors = []
        for landmark in self.truth.structure.values():
            for (view, feature), pixel in zip(landmark.observations, landmark.pixels_px):
                pose = self.truth.find_pose(view)
                projected = self.truth.find_intrinsic(view).project(
                    pose.rotation @ (landmark.position - pose.center))
                errors.append(projected - pixel)
                np.testing.assert_array_equal(
                    self.truth.features[view].points_px[feature], pixel)
        self.assertGreater(len(errors), 100)
        # Half a pixel of noise; the mean of its squares is known to a share.
        self.assertAlmostEqual(np.std(errors), 0.5, delta=0.05)

    def test_files_return_the_scene(self):
        with tempfile.TemporaryDirectory() as folder:
            for name in ("scene.json", "scene.lowlap"):
                path = Path(folder) / name
                self.assertEqual(self.truth.write(path), [])
                self.assertEqual(lowlap.read(path), self.truth)
            self.assertNotEqual(lowlap.read(path), self.scene)
            self.assertNotIn(3, lowlap.read(path, exclude=["3"]).views)

    def test_without_views(self):
        less = self.scene.without_views([0, 3])
        self.assertEqual(list(less.views), [1, 2, 4, 5])
        self.assertTrue(all(0 not in pair for pair in less.relative_poses))
        less.validate()

    def test_notes_go_to_the_log(self):
        scene = lowlap.read(CASTLE / "scene.lowlap", log=self.fail)
        self.assertEqual(len(scene.views), 19)
        self.assertIsNone(scene.find_pose(0))


    def test_notes_of_a_path_go_wherever_it_is_taken(self):
        with tempfile.TemporaryDirectory() as folder:
            notes = self.truth.write(folder, "colmap")
            self.assertEqual(len(notes), 1)
            points = Path(folder) / "points3D.txt"
            points.write_text(points.read_text().replace(" 255 255 255 ", " 9 9 9 "))
            messages = []
            scene = lowlap.read(folder, log=lambda *message: messages.append(message))
            self.assertEqual(len(scene.poses), 6)
            self.assertEqual([level for level, _ in messages], ["warning"])
            self.assertIn("colours", messages[0][1])
            for take in (lowlap.read, lambda path: lowlap.evaluate(path, self.truth)):
                with self.assertWarnsRegex(UserWarning, "colours"):
                    take(folder)
                with warnings.catch_warnings():
                    warnings.simplefilter("error")
                    with self.assertRaisesRegex(UserWarning, "colours"):
                        take(folder)


class ErrorTest(unittest.TestCase):
    def test_says_what_is_wrong_and_where(self):
        with tempfile.TemporaryDirectory() as folder:
            path = Path(folder) / "broken.json"
            path.write_text('{"sfm_data_version": "0.3", "views": [}')
            with self.assertRaises(lowlap.Error) as caught:
                lowlap.read(path)
        error = caught.exception
        self.assertEqual(error.code, "parse")
        self.assertEqual(error.file, str(path))
        self.assertNotEqual(error.place, "")
        self.assertEqual(str(error), f"{error.file}: {error.place}: {error.message}")
        again = pickle.loads(pickle.dumps(error))
        self.assertEqual((again.code, str(again)), (error.code, str(error)))

    def test_codes(self):
        with self.assertRaises(lowlap.Error) as caught:
            lowlap.read("/nowhere/scene.json")
        self.assertEqual(caught.exception.code, "not_found")
        with self.assertRaises(lowlap.Error) as caught:
            lowlap.read(__file__)
        self.assertEqual(caught.exception.code, "unsupported")

    def test_wrong_types_are_type_errors(self):
        with self.assertRaises(TypeError):
            lowlap.read(5)
        with self.assertRaises(TypeError):
            lowlap.scales(5)


if __name__ == "__main__":
    unittest.main()
