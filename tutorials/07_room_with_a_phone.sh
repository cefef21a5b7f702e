#!/usr/bin/env bash
# A room, photographed with a phone: from taking the pictures to the report.
#
# Taking them
#   - Walk along the walls, and photograph across the room. Each photograph
#     shows half of what the one before it showed; turning on the spot gives no
#     distances, so take a step sideways between two photographs.
#   - Go once round, to where you began: the last photograph overlaps the first.
#   - Bare walls are no problem as long as their edges are in the picture: the
#     lines of ceiling, floor, doors, windows and sockets are what lowlap uses.
#   - Fix zoom and focus, hold the phone the same way round, and mind blur.
# The calibration
#   - Without one, the focal length comes from the photographs' EXIF data, and
#     `--refine-intrinsics` corrects it.
#   - Better: photograph a checkerboard once with the same zoom, calibrate
#     (OpenCV's sample calibration.cpp), and write the 3x3 matrix to K.txt.
# Not sure that there are enough photographs? Compute, ask `diagnose`, and take
# those that it asks for while you are still there. That is what follows, with
# the rendered photographs of the bundled room in place of your own.
#
#   bash tutorials/07_room_with_a_phone.sh [LOWLAP] [OUT] [OPTION...]
#
# from the clone, after the quickstart; options are those of `lowlap run`.
set -euo pipefail
lowlap=$(realpath "${1:-build/quickstart/src/cli/lowlap}")
out=$(realpath -m "${2:-out/room_with_a_phone}")
cd "$(dirname "$0")/.."
room=sfm_data/samples/room/images
mkdir -p "$out/photographs"
rm -f "$out/photographs"/{0003,0007,0008}.jpg  # of an earlier run
cp "$room"/{0000,0001,0002,0004,0005,0006,0009,0010}.jpg "$out/photographs"

echo "== the first eight photographs"
"$lowlap" run "$out/photographs" --intrinsics "$room/K.txt" \
  --output "$out/first" "${@:3}"

echo
echo "== what is missing? (--strict: exit code 2, since something is)"
verdict=0
"$lowlap" diagnose "$out/first/scene.lowlap" --strict || verdict=$?
if [[ $verdict != 2 ]]; then
  echo "expected exit code 2, got $verdict" >&2
  exit 1
fi

echo
echo "== three more: 0003 between the parts, as diagnose asked, 0007 and 0008"
echo "   between them the other way round; features and matches of the first"
echo "   eight come from the cache"
cp "$room"/{0003,0007,0008}.jpg "$out/photographs"
"$lowlap" run "$out/photographs" --intrinsics "$room/K.txt" \
  --cache "$out/first/cache" --output "$out/all" "${@:3}"

echo
"$lowlap" evaluate "$out/all/scene.lowlap" sfm_data/samples/room/gt_dense_cameras
echo
echo "Look at $out/all/report.html in a browser: every camera, with its evidence"
echo "and its warnings."
