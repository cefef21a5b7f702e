"""Checks that the JSON Schema of the scene file says what lowlap writes.

check_schema.py SCHEMA WRITER: runs WRITER to write a scene in which every member
is filled; it must satisfy the schema, and damaged copies of it must not.
"""

import copy
import json
import pathlib
import subprocess
import sys
import tempfile

import jsonschema


def main(schema_path, writer):
    schema = json.loads(pathlib.Path(schema_path).read_text(encoding="utf-8"))
    jsonschema.Draft202012Validator.check_schema(schema)
    validator = jsonschema.Draft202012Validator(schema)
    with tempfile.TemporaryDirectory() as folder:
        path = pathlib.Path(folder) / "scene.json"
        subprocess.run([writer, str(path)], check=True)
        scene = json.loads(path.read_text(encoding="utf-8"))
    validator.validate(scene)

    def data(section, index):
        return lambda s: s[section][index]["value"]["ptr_wrapper"]["data"]

    def own(section):
        return lambda s: s["lowlap"][section][0]

    # Every member of a record of ours is required, but for the optional ones.
    records = [(own(name), key)
               for name in ("features", "relative_poses", "point_tracks",
                            "line_tracks", "scale_ratios", "line_structure")
               for key in own(name)(scene)
               if key not in ("covariance", "point_covariances",
                              "repeated_points", "repeated_segments",
                              "alternatives", "weakness",
                              "second_mode")]
    records += [(data("views", 0), key) for key in data("views", 0)(scene)]
    records += [(data("intrinsics", 0), key)
                for key in data("intrinsics", 0)(scene)]
    records += [(lambda s: s, key) for key in scene if key != "lowlap"]
    records += [(lambda s: s["lowlap"], "version")]
    for get, key in records:
        damaged = copy.deepcopy(scene)
        del get(damaged)[key]
        assert not validator.is_valid(damaged), f"{key} may be left out"
        damaged = copy.deepcopy(scene)
        get(damaged)[key] = None
        assert not validator.is_valid(damaged), f"{key} may be null"
    # And nothing else is allowed in ours.
    for get in [own(name) for name in ("features", "relative_poses",
                                       "point_tracks", "scale_ratios",
                                       "line_structure")]:
        damaged = copy.deepcopy(scene)
        get(damaged)["unknown"] = 1
        assert not validator.is_valid(damaged), "an unknown member is allowed"
    for weakness in ("matches_side_by_side", "surroundings", "repeats"):
        weak = copy.deepcopy(scene)
        own("relative_poses")(weak)["weakness"] = weakness
        validator.validate(weak)
    print(f"{len(records)} members checked")


if __name__ == "__main__":
    main(*sys.argv[1:])
