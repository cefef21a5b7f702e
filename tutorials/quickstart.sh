#!/usr/bin/env bash
# From a fresh Debian 12 machine to two calibrated scenes: installs what is
# needed, builds lowlap, solves the bundled facade (a scene description computed
# from photographs) and calibrates the bundled room (rendered photographs).
set -euo pipefail
cd "$(dirname "$0")/.."

bash tutorials/install_dependencies.sh

build=build/quickstart
cmake -S . -B "$build" -G Ninja -DCMAKE_BUILD_TYPE=Release \
  -DLOWLAP_BUILD_TESTS=OFF >"/dev/null"
cmake --build "$build" --target lowlap_cli
lowlap="$build/src/cli/lowlap"

samples=sfm_data/samples
out=out/quickstart

echo
echo "== castle-p19: 19 views of a courtyard, from their scene description"
"$lowlap" solve "$samples/castle-p19/scene.lowlap" \
  --gt "$samples/castle-p19/gt_dense_cameras" --output "$out/castle-p19"

echo
echo "== room: 11 photographs, once round a room with bare walls"
"$lowlap" run "$samples/room/images" --intrinsics "$samples/room/images/K.txt" \
  --pairs cycle --gt "$samples/room/gt_dense_cameras" --output "$out/room"

echo
echo "Look at $out/castle-p19/report.html and $out/room/report.html in a browser,"
echo "or open cloud.ply in the same folders with MeshLab or CloudCompare."
