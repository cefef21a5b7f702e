#!/usr/bin/env python3
"""Translates what LIMAP pickles to text that lowlap reads, and back.

    limap_text.py to-text FOLDER     matches_ID.npy -> matches_ID.txt, and the
                                     cameras of imagecols.npy -> sparse/*.txt
    limap_text.py from-text FOLDER   matches_ID.txt -> matches_ID.npy

A line of matches_ID.txt is: neighbour, segment in ID, segment in the neighbour.
Unpickling runs what a file says: use it on files of your own. Needs NumPy.
"""

import pathlib
import sys

import numpy as np

# Undistorted images have one of these; the numbers are COLMAP's.
MODELS = {0: "SIMPLE_PINHOLE", 1: "PINHOLE"}


def load(path):
    return np.load(path, allow_pickle=True).item()


def numbers(values):
    return " ".join(repr(float(value)) for value in values)


def matches_to_text(path):
    rows = [f"{neighbor} {own} {other}\n"
            for neighbor, pairs in sorted(load(path).items())
            for own, other in np.asarray(pairs, int).reshape(-1, 2)]
    path.with_suffix(".txt").write_text("".join(rows))


def matches_from_text(path):
    rows = np.loadtxt(path, int, ndmin=2).reshape(-1, 3)
    matches = {int(n): rows[rows[:, 0] == n, 1:] for n in np.unique(rows[:, 0])}
    np.save(path.with_suffix(".npy"), np.array(matches, dtype=object))


def cameras_to_text(path, folder):
    model = load(path)
    cameras, images = [], []
    for key, camera in model["cameras"].items():
        if camera["model_id"] not in MODELS:
            sys.exit(f"{path}: camera {key} is not undistorted")
        cameras.append(f"{key} {MODELS[camera['model_id']]} {camera['width']} "
                       f"{camera['height']} {numbers(camera['params'])}\n")
    for key, image in model["images"].items():
        pose = image["pose"]
        images.append(f"{key} {numbers(pose['qvec'])} {numbers(pose['tvec'])} "
                      f"{image['cam_id']} {image['image_name']}\n\n")
    folder.mkdir(exist_ok=True)
    (folder / "cameras.txt").write_text("".join(cameras))
    (folder / "images.txt").write_text("".join(images))
    (folder / "points3D.txt").write_text("")


def main():
    if len(sys.argv) != 3 or sys.argv[1] not in ("to-text", "from-text"):
        sys.exit(__doc__)
    folder = pathlib.Path(sys.argv[2])
    if not folder.is_dir():
        sys.exit(f"{folder}: no such folder")
    form = "npy" if sys.argv[1] == "to-text" else "txt"
    translate = matches_to_text if form == "npy" else matches_from_text
    for path in sorted(folder.glob(f"line_matchings/*/*/*/matches_*.{form}")):
        translate(path)
    cameras = [path for path in (folder / "finaltracks/imagecols.npy",
                                 folder / "imagecols.npy") if path.is_file()]
    if form == "npy" and cameras and not (folder / "sparse").exists():
        cameras_to_text(cameras[0], folder / "sparse")


if __name__ == "__main__":
    main()
