#!/usr/bin/env python3
"""Makes the inputs that the fuzzers start from, a folder for each of them, with
the program itself where it writes the format. Needs the standard library alone.

  make_corpus.py LOWLAP FOLDER
"""
import json
import pathlib
import sqlite3
import struct
import subprocess
import sys
import tempfile
import zlib

SOURCES = pathlib.Path(__file__).resolve().parents[2]
CAMERA = """2759.48 0 1520.69
0 2764.16 1006.81
0 0 1
0 0 0
0.450927 -0.0945642 -0.887537
-0.892535 -0.0401974 -0.449183
0.00679989 0.994707 -0.102528
-7.28137 -7.57667 0.204446
3072 2048
"""


def one_input(files):
    """Files by their names as one input, as InputFolder takes them apart."""
    bytes_of_input = files.get("input", b"")
    for name, content in files.items():
        if name != "input":
            bytes_of_input += b"--8<-- " + name.encode() + b"\n" + content
            if not content.endswith(b"\n"):
                bytes_of_input += b"\n"
    return bytes_of_input


def files_of(folder):
    return {str(path.relative_to(folder)): path.read_bytes()
            for path in sorted(folder.rglob("*")) if path.is_file()}


class Corpus:
    def __init__(self, lowlap, folder, work):
        self.lowlap, self.folder, self.work = lowlap, folder, work

    def run(self, *arguments):
        subprocess.run([self.lowlap, *map(str, arguments), "--quiet"],
                       check=True, stdout=subprocess.DEVNULL,
                       stderr=subprocess.DEVNULL)

    def add(self, fuzzer, name, content):
        if isinstance(content, str):
            content = content.encode()
        path = self.folder / fuzzer / name
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_bytes(content)

    def simulate(self):
        """Scenes by name: measurements, and solutions with their structure."""
        scenes = {}
        for kind, features in (("room", 8), ("corridor", 1)):
            paths = [self.work / f"{kind}_{part}.lowlap"
                     for part in ("measured", "solved")]
            self.run("simulate", "--kind", kind, "--views", 4, "--pairs",
                     "cycle", "--points", features, "--lines", features,
                     "--noise", 0.3,
                     "--output", paths[0], "--truth", paths[1])
            scenes.update({path.stem: path for path in paths})
        return scenes

    def add_scenes(self, scenes):
        """Every scene in every format that can be written into one."""
        one_file = ["json", "lowlap", "openmvg-json", "openmvg-bin",
                    "openmvg-xml", "line3dpp", "bundler", "nvm", "bal", "tum",
                    "kitti"]
        for name, scene in scenes.items():
            for form in one_file + ["colmap", "colmap-bin", "limap"]:
                folder = self.work / f"{name}_{form}"
                if form in one_file:
                    folder.mkdir()
                    self.run("convert", scene, folder / "input", "--to", form)
                else:
                    self.run("convert", scene, folder, "--to", form)
                files = files_of(folder)
                if "input.list.txt" in files:
                    files["list.txt"] = files.pop("input.list.txt")
                content = one_input(files)
                fuzzer = form.replace("-", "_").replace("openmvg_json", "json")
                self.add(fuzzer, f"{name}_{form}", content)
                self.add("any_scene", f"{name}_{form}", content)
        for path in (SOURCES / "tests/io/data").glob("version_*"):
            self.add(path.suffix[1:], path.name, path.read_bytes())
        rigs = {
            "cameras.txt": "1 PINHOLE 64 48 50 50 32 24\n"
                           "2 OPENCV 64 48 50 50 32 24 .1 0 0 0\n",
            "rigs.txt": "3 2 CAMERA 1 CAMERA 2 1 1 0 0 0 .5 0 0\n",
            "frames.txt": "4 3 1 0 0 0 1 2 3 2 CAMERA 1 1 CAMERA 2 2\n",
            "images.txt": "1 1 0 0 0 0 0 0 1 a.jpg\n1 2 7 3 4 -1\n"
                          "2 1 0 0 0 0 0 0 2 b.jpg\n5 6 7\n",
            "points3D.txt": "7 1 2 3 255 0 0 .5 1 0 2 0\n"}
        self.add("colmap", "rigs", one_input(
            {name: text.encode() for name, text in rigs.items()}))
        self.add("nvm", "fixed", "NVM_V3 FixedK 50 32 50 24 0\n\n"
                 "1\na.jpg 50 1 0 0 0 1 2 3 .1 0\n\n0\n0\n")
        self.add("nvm", "r9t", "NVM_V3_R9T\n1\na.jpg 50 1 0 0 0 1 0 0 0 1 1 2 "
                 "3 .1 0\n0\n0\n")
        self.add("line3dpp", "lines", "1 0 0 0 1 0 0 2 0 0 1 2 3 4 1 0 1 2 3 4\n"
                 "2 0 0 0 1 0 0 1 0 0 2 0 0 2 0 1 5 6 7 8 1 1 5 6 7 8\n")

    def add_onedsfm(self):
        turn = "0 -1 0 1 0 0 0 0 1"
        files = {
            "EGs.txt": f"0 1 {turn} 1 0 0\n1 2 {turn} 0 .6 .8\n",
            "cc.txt": "0\n1\n2\n",
            "list.txt": "a.jpg 0 650\nb.jpg\nc.jpg 0 600\n",
            "coords.txt": "".join(
                f"#index = {n}, name = {name}.jpg, keys = 2, px = 400, "
                f"py = 300, focal = 650\n0 10 20 0 0 1 2 3\n"
                f"1 30 40.5 0 0 1 2 3\n" for n, name in enumerate("abc")),
            "tracks.txt": "2\n3 0 0 1 0 2 0\n2 1 1 2 1\n",
            "gt_bundle.out": "# Bundle file v0.3\n2 1\n650 0 0\n1 0 0\n0 1 0\n"
                             "0 0 1\n1 2 3\n0 0 0\n0 0 0\n0 0 0\n0 0 0\n0 0 0\n"
                             "0 0 0\n255 255 255\n1 0 0 10 20\n"}
        content = one_input({n: text.encode() for n, text in files.items()})
        self.add("1dsfm", "problem", content)
        self.add("any_scene", "problem", content)
        self.add("camera_files", "problem", content)

    def add_openmvg(self, solved):
        matches = "0 1\n2\n0 1\n1 0\n1 2\n1\n1 1\n"
        binary = struct.pack("<QIIQIIII", 1, 0, 1, 2, 0, 1, 1, 0)
        points = "1 2\n3.5 4\n"
        regions = "1 2 3 4\n5 6 7 8\n"
        for name, content in (("text", matches), ("binary", binary),
                              ("points", points), ("regions", regions)):
            self.add("openmvg_files", name, content)
        listing = self.work / "listing.json"
        self.run("convert", solved, listing, "--to", "openmvg-json")
        views = [path.stem for path in map(pathlib.Path, image_names(listing))]
        for name, content in (("matches.f.txt", matches.encode()),
                              ("matches.e.bin", binary)):
            files = {"input": listing.read_bytes(), name: content}
            files.update({f"{view}.feat": points.encode() for view in views})
            self.add("openmvg_project", name, one_input(files))

    def add_databases(self):
        path = self.work / "database.db"
        for version in (3600, 3800, 4000):
            path.unlink(missing_ok=True)
            write_database(path, version)
            for fuzzer in ("colmap_db", "database_write", "any_scene"):
                self.add(fuzzer, str(version), path.read_bytes())

    def add_small_files(self):
        self.add("camera_files", "camera", CAMERA)
        self.add("camera_files", "K", "\n".join(CAMERA.split("\n")[:3]))
        self.add("camera_files", "folder", one_input(
            {f"gt_dense_cameras/000{n}.jpg.camera": CAMERA.encode()
             for n in range(3)}))
        self.add("pairs", "pairs", '# two\n0 1\n"photo 2.jpg" 3\n\n'
                 '"left/photo 0.jpg" "photo 1.jpg"\n')
        self.add("true_edges", "edges", '{"edges": [{"name": "a", "p0": [0, 1,'
                 ' 2], "p1": [3, 4, 5], "pts": [[0, 1, 2], [3, 4, 5.5]],'
                 ' "views": [[3, 0.5, 120.0], [4, 1, 2]]}]}')
        for n, words in enumerate((
                "graph", "graph,lud:loss_width=1e-5,max_iterations=50,bata",
                "1dsfm:num_directions=3+bata", "focal,aspect,principal-point",
                "all", "pairs", "planes", "window:3", "loop:2", "cycle",
                "chain", "0", "auto")):
            self.add("arguments", str(n), words)

    def add_result_logs(self):
        self.run("robustness", "--quick", "--output", self.work / "study")
        cells = (self.work / "study/trials.jsonl").read_text().split("\n")
        subset = ('{"dropped":[1,2],"views":3,"placed":3,"mean_error":0.1,'
                  '"max_error":0.2,"worst_view":4,'
                  '"mean_error_before_adjustment":0.3,"doubts":["open_loop"],'
                  '"failure":"","seconds":0.5}')
        settings = '{"settings":""}'
        self.add("result_log", "cells", "\n".join([settings] + cells[1:4]))
        self.add("result_log", "subset", f"{settings}\n{subset}\n")

    def add_cache(self):
        images = self.work / "images"
        images.mkdir()
        for n in range(2):
            (images / f"{n}.png").write_bytes(picture(n, 96))
        out = self.work / "run"
        subprocess.run([self.lowlap, "run", images, "--focal", "80", "--output",
                        out, "--quiet"], stdout=subprocess.DEVNULL,
                       stderr=subprocess.DEVNULL)  # too few to place
        for entry in (out / "cache").glob("*.entry"):
            content = entry.read_bytes()
            self.add("cache", entry.stem, content)
            # Behind two lines and five numbers.
            start = content.index(b"\n", content.index(b"\n") + 1) + 1 + 5 * 8
            self.add("cache", entry.stem + "_content", content[start:])

    def add_photographs(self):
        room = SOURCES / "sfm_data/samples/room/images"
        photograph = sorted(room.iterdir())[0].read_bytes()
        self.add("photograph", "room.jpg", with_exif(photograph))
        self.add("photograph", "head.jpg", with_exif(photograph)[:2000])
        self.add("photograph", "a.png", picture(0, 16))
        self.add("photograph", "a.pgm", b"P5 4 2 255\n01234567")
        self.add("photograph", "a.bmp", struct.pack(
            "<2sIIIIiiHHIIiiII", b"BM", 66, 0, 54, 40, 2, -2, 1, 24, 0, 16, 0,
            0, 0, 0) + bytes(range(16)))


def image_names(listing):
    views = json.loads(listing.read_text())["views"]
    return [view["value"]["ptr_wrapper"]["data"]["filename"] for view in views]


def write_database(path, version):
    database = sqlite3.connect(path)
    pose = ", qvec BLOB, tvec BLOB" if version >= 3800 else ""
    database.executescript(f"""
        PRAGMA page_size = 512; PRAGMA user_version = {version};
        CREATE TABLE cameras(camera_id INTEGER PRIMARY KEY, model INTEGER,
            width INTEGER, height INTEGER, params BLOB,
            prior_focal_length INTEGER);
        CREATE TABLE images(image_id INTEGER PRIMARY KEY, name TEXT UNIQUE,
            camera_id INTEGER);
        CREATE TABLE keypoints(image_id INTEGER PRIMARY KEY, rows INTEGER,
            cols INTEGER, data BLOB);
        CREATE TABLE matches(pair_id INTEGER PRIMARY KEY, rows INTEGER,
            cols INTEGER, data BLOB);
        CREATE TABLE two_view_geometries(pair_id INTEGER PRIMARY KEY,
            rows INTEGER, cols INTEGER, data BLOB, config INTEGER,
            F BLOB, E BLOB, H BLOB{pose});""")
    database.execute("INSERT INTO cameras VALUES(1, 1, 64, 48, ?, 1)",
                     [struct.pack("<4d", 50, 50, 32, 24)])
    for image in (1, 2):
        database.execute("INSERT INTO images VALUES(?, ?, 1)",
                         [image, f"{image}.jpg"])
        database.execute("INSERT INTO keypoints VALUES(?, 2, 2, ?)",
                         [image, struct.pack("<4f", 1, 2, 3, 4)])
    row = [2147483647 + 2, struct.pack("<4I", 0, 1, 1, 0)]
    database.execute("INSERT INTO matches VALUES(?, 2, 2, ?)", row)
    if pose:
        row += [struct.pack("<4d", 1, 0, 0, 0), struct.pack("<3d", 0, .6, .8)]
    database.execute(
        "INSERT INTO two_view_geometries VALUES(?, 2, 2, ?, 2, NULL, NULL, NULL"
        + (", ?, ?)" if pose else ")"), row)
    database.commit()
    database.close()


def picture(seed, width):
    """A grey PNG file with corners and edges in it."""
    rows = b"".join(
        b"\0" + bytes((37 * (x // 12 * 7 + y // 9 * 5 + seed) % 251)
                      for x in range(width)) for y in range(width))
    def chunk(kind, data):
        return (struct.pack(">I", len(data)) + kind + data +
                struct.pack(">I", zlib.crc32(kind + data)))
    return (b"\x89PNG\r\n\x1a\n" +
            chunk(b"IHDR", struct.pack(">IIBBBBB", width, width, 8, 0, 0, 0, 0))
            + chunk(b"IDAT", zlib.compress(rows)) + chunk(b"IEND", b""))


def with_exif(jpeg):
    """With an orientation, a focal length, and that on film."""
    first = [struct.pack("<HHII", 0x0112, 3, 1, 6),
             struct.pack("<HHII", 0x8769, 4, 1, 0x26)]
    second = [struct.pack("<HHII", 0x920a, 5, 1, 0x44),
              struct.pack("<HHII", 0xa405, 3, 1, 28)]
    tiff = (b"II*\0" + struct.pack("<I", 8) + struct.pack("<H", len(first)) +
            b"".join(first) + struct.pack("<I", 0) +
            struct.pack("<H", len(second)) + b"".join(second) +
            struct.pack("<I", 0) + struct.pack("<II", 35, 1))
    data = b"Exif\0\0" + tiff
    return (b"\xff\xd8\xff\xe1" + struct.pack(">H", len(data) + 2) + data +
            jpeg[2:])


def main():
    if len(sys.argv) != 3:
        sys.exit(__doc__)
    with tempfile.TemporaryDirectory() as work:
        corpus = Corpus(str(pathlib.Path(sys.argv[1]).resolve()),
                        pathlib.Path(sys.argv[2]), pathlib.Path(work))
        scenes = corpus.simulate()
        corpus.add_scenes(scenes)
        corpus.add_onedsfm()
        corpus.add_openmvg(scenes["room_solved"])
        corpus.add_databases()
        corpus.add_small_files()
        corpus.add_result_logs()
        corpus.add_cache()
        corpus.add_photographs()


if __name__ == "__main__":
    main()
