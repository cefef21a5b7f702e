"""A disk that is full at any write: an error that names the file, nothing half."""

import json
import os
import re
import shutil
import sqlite3
import struct
import subprocess
import unittest

from support import (CASTLE, COMMAND, FaultCase, copy_photographs, environment,
                     files_in, is_temporary, run)

FULL = "No space left on device"
CALLS = "open,write,mkdir,sync"
MAX_MOMENTS = 24  # of the calls of one command


def make_database(path, scene):
    """A COLMAP database with the views and keypoints of a scene."""
    database = sqlite3.connect(path)
    database.executescript("""
        CREATE TABLE cameras (camera_id INTEGER PRIMARY KEY, model INTEGER,
          width INTEGER, height INTEGER, params BLOB, prior_focal_length INTEGER);
        CREATE TABLE images (image_id INTEGER PRIMARY KEY, name TEXT UNIQUE,
          camera_id INTEGER);
        CREATE TABLE keypoints (image_id INTEGER PRIMARY KEY, rows INTEGER,
          cols INTEGER, data BLOB);
        CREATE TABLE matches (pair_id INTEGER PRIMARY KEY, rows INTEGER,
          cols INTEGER, data BLOB);
        CREATE TABLE two_view_geometries (pair_id INTEGER PRIMARY KEY,
          rows INTEGER, cols INTEGER, data BLOB, config INTEGER, F BLOB, E BLOB,
          H BLOB, qvec BLOB, tvec BLOB);""")
    views = [entry["value"]["ptr_wrapper"]["data"] for entry in scene["views"]]
    for view in views:
        number = view["id_view"] + 1
        points = scene["lowlap"]["features"][view["id_view"]]["points"]
        count = len(points) // 2
        blob = struct.pack(f"<{2 * count}f", *(x + 0.5 for x in points))
        database.execute("INSERT INTO cameras VALUES (?,1,?,?,?,1)", (
            number, view["width"], view["height"],
            struct.pack("<4d", 1000, 1000, 500, 500)))
        database.execute("INSERT INTO images VALUES (?,?,?)",
                         (number, view["filename"], number))
        database.execute("INSERT INTO keypoints VALUES (?,?,2,?)",
                         (number, count, blob))
    database.commit()
    database.close()


def dump(path):
    """The content of a database as text."""
    database = sqlite3.connect(path)
    lines = list(database.iterdump())
    database.close()
    return lines


class DiskFull(FaultCase):
    """Every command that writes, from each of its writes on without space."""

    def setUp(self):
        super().setUp()
        self.room = self.folder / "room.lowlap"
        self.truth = self.folder / "truth.lowlap"
        self.out = self.folder / "out"
        self.succeed(["simulate", "--views", 5, "--points", 60, "--lines", 60,
                      "--truth", self.truth, "-o", self.room])

    def count_calls(self, arguments, **options):
        """How many calls of an undisturbed run may fail."""
        count = self.folder / "count"
        self.succeed(arguments, env=environment(CALLS, count=count), **options)
        return int(count.read_text())

    def sweep(self, *arguments, before=(), codes=(1,)):
        """Fails at each moment, into a folder that holds copies of `before`."""
        def prepare():
            shutil.rmtree(self.out, ignore_errors=True)
            self.out.mkdir()
            for path in before:
                shutil.copy(path, self.out)

        prepare()
        total = self.count_calls(arguments)
        self.assertGreater(total, 0, arguments)
        step = -(-total // MAX_MOMENTS)
        for first in range(1, total + 1, step):
            prepare()
            was = files_in(self.out)
            done = run(arguments, env=environment(CALLS, first=first))
            with self.subTest(arguments=arguments, first=first, of=total):
                self.assertIn(done.returncode, codes, done.stderr)
                self.check_refused(done, self.out, FULL)
                self.assertEqual(files_in(self.out), was)
        return total

    def test_solve(self):
        self.sweep("solve", self.room, "-o", self.out)
        self.sweep("solve", self.room, "--no-adjust", "-o",
                   self.out / "solved/scene.json")

    def test_solve_over_an_earlier_result(self):
        earlier = self.folder / "earlier"
        self.succeed(["solve", self.room, "--no-adjust", "-o", earlier])
        self.sweep("solve", self.room, "-o", self.out,
                   before=[path for path in earlier.iterdir()])

    def test_a_file_that_cannot_take_its_name_takes_the_others_back(self):
        arguments = ["solve", self.room, "-o", self.out]
        self.succeed([*arguments, "--no-adjust"])
        was = files_in(self.out)
        for first in range(1, 6):
            done = run(arguments, env=environment("rename", first=first,
                                                  last=first))
            self.check_refused(done, self.out, FULL)
            self.assertEqual(files_in(self.out), was)
        # Without second names, the files are replaced all the same.
        self.succeed(arguments, env=environment("link", first=1))
        self.assertFalse(any(map(is_temporary, files_in(self.out))))

    def test_convert(self):
        solved = self.folder / "solved"
        self.succeed(["solve", self.room, "--no-adjust", "-o", solved])
        scene = solved / "scene.lowlap"
        for name in ("scene.json", "scene.lowlap", "cloud.ply", "lines.obj"):
            self.sweep("convert", scene, self.out / name)
        formats = run(["convert", "--formats"]).stdout
        for name in re.findall(r"(?m)^(\S+) \(read and written\)", formats):
            if name != "colmap-db":
                self.sweep("convert", scene, self.out / "converted", "--to",
                           name)

    def test_convert_into_a_database(self):
        text = self.folder / "room.json"
        self.succeed(["convert", self.room, text])
        database = self.folder / "database.db"
        make_database(database, json.loads(text.read_text()))
        self.out.mkdir()
        written = self.out / "database.db"
        arguments = ["convert", self.room, written]
        shutil.copy(database, written)
        total = self.count_calls(arguments)
        self.assertNotEqual(dump(written), dump(database))
        for first in range(1, total + 1):
            shutil.copy(database, written)
            done = run(arguments, env=environment(CALLS, first=first))
            self.check_refused(done, written, "unable to open|full|disk I/O")
            # On a disk without any space, what was begun is taken back by
            # whoever opens the database next.
            self.assertEqual(dump(written), dump(database))
            self.assertEqual(list(files_in(self.out)), ["database.db"])

    def test_merge(self):
        model = self.folder / "model"
        self.succeed(["solve", self.room, "-o", model])
        self.sweep("merge", model / "scene.lowlap", "--scene", self.room,
                   "-o", self.out)

    def test_studies_of_a_scene(self):
        self.sweep("compare", self.room, "--strategies", "graph,lud",
                   "--gt", self.truth, "-o", self.out)
        self.sweep("ablate", self.room, "--gt", self.truth, "--thresholds", 2,
                   "-o", self.out)

    def test_tables_and_pictures(self):
        self.sweep("scales", self.room, "--json", self.out / "ratios.json",
                   "--profile", self.out / "profile.csv")
        self.sweep("diagnose", self.room, "--json", self.out / "room.json")
        self.sweep("simulate", "--views", 4, "-o", self.out / "a.json",
                   "--truth", self.out / "b.json")
        self.sweep("adjust", self.truth, "-o", self.out)
        self.sweep("manual", "--output", self.out)
        images = copy_photographs(self.folder / "images", 2)
        self.sweep("features", images / "0000.jpg", "--lines",
                   "--draw", self.out / "features.png")

    def test_a_study_keeps_whole_records_and_goes_on(self):
        arguments = ["subsets", self.room, "--drop", 2, "--gt", self.truth,
                     "--threads", 1, "-o", self.out]
        total = self.count_calls(arguments)
        whole = files_in(self.out)
        for first in range(1, total + 1):
            shutil.rmtree(self.out)
            done = run(arguments, env=environment(CALLS, first=first))
            self.check_refused(done, self.out, FULL)
            log = self.out / "results.jsonl"
            text = log.read_text() if log.exists() else ""
            self.assertTrue(text == "" or text.endswith("\n"), text[-80:])
            for line in text.splitlines():
                json.loads(line)
            self.assertFalse(any(map(is_temporary, files_in(self.out))))
            self.succeed(arguments)
            self.assertEqual(sorted(files_in(self.out)), sorted(whole))

    def test_run(self):
        images = copy_photographs(self.folder / "images")
        cache = self.folder / "cache"
        arguments = ["run", images, "--intrinsics", images / "K.txt",
                     "--max-tilt", "1", "--no-adjust", "--cache", cache,
                     "-o", self.out]
        self.succeed(arguments)
        whole = self.folder / "whole"
        self.out.rename(whole)
        self.sweep(*arguments)
        shutil.rmtree(self.out)
        # Without space for the cache alone, with a warning.
        total = self.count_calls(arguments)
        shutil.rmtree(cache)
        done = self.succeed(arguments, env=environment(
            "open,write", first=1, last=2))
        self.assertIn("warning: the cache cannot be written: " + str(cache),
                      done.stderr)
        self.assertRegex(done.stderr, FULL)
        self.check_same(self.out, whole)
        self.assertFalse(any(map(is_temporary, files_in(cache))))
        self.assertGreater(total, 5)

    def test_standard_output(self):
        solved = CASTLE / "scene.lowlap"
        truth = CASTLE / "gt_dense_cameras"
        with open("/dev/full", "w", encoding="ascii") as full:
            for arguments in (["evaluate", self.truth, truth],
                              ["inspect", solved], ["scales", self.room],
                              ["diagnose", self.room], ["manual", "run"],
                              ["convert", "--formats"],
                              ["completion", "bash"]):
                if arguments[0] == "evaluate":
                    arguments = ["evaluate", self.truth, self.truth]
                done = subprocess.run(
                    [COMMAND, *map(str, arguments)], stdout=full, text=True,
                    stderr=subprocess.PIPE, check=False, timeout=300)
                with self.subTest(arguments=arguments):
                    self.check_refused(done, "standard output", FULL)


if __name__ == "__main__":
    os.umask(0o022)
    unittest.main()
