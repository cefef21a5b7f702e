"""Scenes of other programs, and models that are merged, as the command has them."""

import os
import sqlite3
import struct
import subprocess
import tempfile
import unittest
from pathlib import Path

import lowlap
import numpy as np

from support import ROOM


def write_openmvg(scene, folder):
    """A listing, features and matches as OpenMVG keeps them; returns the listing."""
    folder.mkdir()
    for id, view in scene.views.items():
        np.savetxt(folder / (Path(view.filename).stem + ".feat"),
                   np.pad(scene.features[id].points_px, ((0, 0), (0, 2))), "%.6f")
    with open(folder / "matches.f.txt", "w") as file:
        for (first, second), pose in scene.relative_poses.items():
            file.write(f"{first} {second}\n{len(pose.point_inliers)}\n")
            np.savetxt(file, pose.point_inliers, "%d")
    scene.write(folder / "sfm_data.json", "openmvg-json")
    return folder / "sfm_data.json"


def write_database(scene, path):
    """A database of COLMAP with the keypoints and matches of a scene."""
    database = sqlite3.connect(path)
    database.executescript(
        "CREATE TABLE cameras(camera_id INTEGER PRIMARY KEY, model INTEGER, width INTEGER,"
        " height INTEGER, params BLOB, prior_focal_length INTEGER);"
        "CREATE TABLE images(image_id INTEGER PRIMARY KEY, name TEXT, camera_id INTEGER);"
        "CREATE TABLE keypoints(image_id INTEGER PRIMARY KEY, rows INTEGER, cols INTEGER,"
        " data BLOB);"
        "CREATE TABLE matches(pair_id INTEGER PRIMARY KEY, rows INTEGER, cols INTEGER,"
        " data BLOB);")
    camera = scene.find_intrinsic(0)
    params = struct.pack("4d", camera.fx_px, camera.fy_px,
                         *(camera.principal_point_px + 0.5))
    database.execute("INSERT INTO cameras VALUES(1, 1, ?, ?, ?, 0)",
                     (camera.width_px, camera.height_px, params))
    for id, view in scene.views.items():
        points = (scene.features[id].points_px + 0.5).astype("<f4")
        database.execute("INSERT INTO images VALUES(?, ?, 1)", (id + 1, view.filename))
        database.execute("INSERT INTO keypoints VALUES(?, ?, 2, ?)",
                         (id + 1, len(points), points.tobytes()))
    for (first, second), pose in scene.relative_poses.items():
        matches = pose.point_inliers.astype("<u4")
        database.execute("INSERT INTO matches VALUES(?, ?, 2, ?)",
                         ((first + 1) * 2147483647 + second + 1, len(matches),
                          matches.tobytes()))
    database.commit()
    database.close()


class ProjectTest(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.scene, cls.truth = lowlap.simulate(views=5, pairs="window:2",
                                               trifocal_points=0.5, noise=0.2)
        holder = tempfile.TemporaryDirectory()
        cls.addClassCleanup(holder.cleanup)
        cls.folder = Path(holder.name)
        cls.listing = write_openmvg(cls.scene, cls.folder / "matches")
        cls.database = cls.folder / "database.db"
        write_database(cls.scene, cls.database)

    def test_relative_poses_are_estimated(self):
        for path, options in ((self.listing, {"matchdir": self.listing.parent}),
                              (self.database, {"log": lambda *_: None})):
            with self.subTest(path):
                scene = lowlap.measure(path, **options)
                self.assertEqual(len(scene.views), 5)
                self.assertEqual(len(scene.relative_poses), len(self.scene.relative_poses))
                less = lowlap.measure(path, exclude=["0", "1"] if path == self.listing
                                      else ["1", "2"], **options)
                self.assertEqual(len(less.views), 3)
                solution = lowlap.solve(path, gt=self.truth, **options)
                self.assertEqual(solution.num_placed, 5)
                self.assertEqual(len(solution.pairs), len(self.scene.relative_poses))
                self.assertLess(solution.evaluation.position.max, 0.1)
                self.assertEqual(
                    [ratio.log_ratio for ratio in lowlap.scales(path, **options)],
                    [ratio.log_ratio for ratio in lowlap.scales(scene)])

    def test_what_goes_with_a_path(self):
        with self.assertWarnsRegex(UserWarning, "COLMAP's guess"):
            lowlap.measure(self.database)
        for wrong in ((self.scene, {"matchdir": self.folder}),
                      (self.listing, {"match_file": "matches.f.txt"}),
                      (self.listing, {"images": self.folder})):
            with self.assertRaises(lowlap.Error) as caught:
                lowlap.solve(wrong[0], **wrong[1])
            self.assertEqual(caught.exception.code, "invalid_argument")
        with self.assertRaisesRegex(lowlap.Error, "holds no relative poses"):
            lowlap.solve(self.listing)

    def test_gives_what_the_command_gives(self):
        command = os.environ.get("LOWLAP_COMMAND")
        if not command:
            self.skipTest("the command is not built")
        ours, theirs = self.folder / "module", self.folder / "command"
        lowlap.solve(self.listing, matchdir=self.listing.parent, output=ours)
        subprocess.run([command, "solve", "-i", self.listing, "-m", self.listing.parent,
                        "-o", theirs], check=True, capture_output=True)
        for name in ("sfm_data.json", "scene.lowlap", "cloud.ply", "report.html"):
            self.assertEqual((ours / name).read_bytes(), (theirs / name).read_bytes(), name)


class MergeTest(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.scene, cls.truth = lowlap.simulate(views=10, pairs="window:2", noise=0.3)
        # Two models that share two cameras, each in its own frame.
        cls.parts = [lowlap.solve(cls.scene.without_views(views)).scene
                     for views in ([6, 7, 8, 9], [0, 1, 2, 3])]

    def test_makes_one_model(self):
        solution = lowlap.merge(self.parts, scene=self.scene, gt=self.truth)
        self.assertEqual(solution.num_placed, 10)
        self.assertLess(solution.evaluation.position.max, 0.05)
        self.assertTrue(any("model 2" in note for note in solution.notes), solution.notes)
        self.assertIn("model check", [cost.name for cost in solution.costs])

    def test_paths_and_one_model(self):
        with tempfile.TemporaryDirectory() as folder:
            part = Path(folder) / "part"
            self.parts[0].write(part, "colmap-bin")
            self.scene.write(Path(folder) / "scene.lowlap")
            solution = lowlap.merge(part, scene=Path(folder) / "scene.lowlap")
        self.assertEqual(solution.num_placed, 10)
        self.assertTrue(any(str(part) in note for note in solution.notes), solution.notes)

    def test_says_what_is_missing(self):
        with self.assertRaisesRegex(lowlap.Error, "images .* or scene"):
            lowlap.merge(self.parts)
        other, _ = lowlap.simulate(views=3)
        with self.assertRaises(lowlap.Error):
            lowlap.merge([other], scene=self.scene)
        with self.assertRaises(TypeError):
            lowlap.merge(5, scene=self.scene)

    def test_refuses_options_of_photographs_for_what_was_measured(self):
        for options in ({"focal": 900.0}, {"intrinsics": "K.txt"}, {"cache": "cache"},
                        {"pairs": "all"}, {"matcher": "flann"}, {"max_tilt": 2.0},
                        {"two_view": "points"}, {"refine_points": True}):
            with self.subTest(options), self.assertRaisesRegex(
                    lowlap.Error, next(iter(options))):
                lowlap.merge(self.parts, scene=self.scene, **options)

    def test_photographs_are_measured(self):
        class Stop(Exception):
            pass

        def stop(*_):
            raise Stop

        with self.assertRaises(Stop):
            lowlap.merge([], images=ROOM / "images", intrinsics=ROOM / "images/K.txt",
                         progress=stop)


if __name__ == "__main__":
    unittest.main()
