"""LIMAP's pickled files to text and back: check_limap_text.py SCRIPT."""

import pathlib
import subprocess
import sys
import tempfile

import numpy as np

script = sys.argv[1]
with tempfile.TemporaryDirectory() as name:
    folder = pathlib.Path(name)

    def run(mode):
        subprocess.run([sys.executable, script, mode, name], check=True)

    place = folder / "line_matchings/lsd/feats/matcher"
    place.mkdir(parents=True)
    matches = {9: np.array([[0, 1], [1, 2]]), 7: np.zeros((0, 2), int)}
    np.save(place / "matches_4.npy", np.array(matches, dtype=object))
    camera = {"model_id": 1, "params": [500, 500, 320.5, 240], "cam_id": 1,
              "height": 480, "width": 640, "initialized": [True, True]}
    image = {"cam_id": 1, "image_name": "a.jpg",
             "pose": {"qvec": [1, 0, 0, 0], "tvec": [0, 0.1, 0]}}
    np.save(folder / "imagecols.npy",
            np.array({"cameras": {1: camera}, "images": {4: image}},
                     dtype=object))
    run("to-text")
    text = (place / "matches_4.txt").read_text()
    assert text == "9 0 1\n9 1 2\n", text
    cameras = (folder / "sparse/cameras.txt").read_text()
    assert cameras == "1 PINHOLE 640 480 500.0 500.0 320.5 240.0\n", cameras
    images = (folder / "sparse/images.txt").read_text()
    assert images == "4 1.0 0.0 0.0 0.0 0.0 0.1 0.0 1 a.jpg\n\n", images

    (place / "matches_4.npy").unlink()
    run("from-text")
    back = np.load(place / "matches_4.npy", allow_pickle=True).item()
    assert list(back) == [9] and (back[9] == matches[9]).all(), back
