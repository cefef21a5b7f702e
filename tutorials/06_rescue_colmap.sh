#!/usr/bin/env bash
# Tutorial 6: rescue of a project that fell apart in COLMAP.
#
# The bundled room has bare walls: neighbouring photographs share half of what
# they show, and hardly anything is common to three, which is what COLMAP places
# a further camera by. With its default options it finds no model at all; with
# weaker demands it places some cameras, rightly or not, and loses the others.
# `lowlap merge` checks what there is against relative poses and scale ratios,
# which coplanar lines give too, keeps what these bear out, and places the rest.
# COLMAP goes on from the result.
#
#   bash tutorials/06_rescue_colmap.sh [OUT]      a minute or two; Debian's colmap
#
# $LOWLAP is the command, if it is not that of the quickstart or the system.
# Without COLMAP the exit code is 77.
set -euo pipefail
cd "$(dirname "$0")/.."

if ! command -v colmap >/dev/null; then
  echo "skipped: there is no colmap (apt-get install colmap)"
  exit 77
fi
lowlap=${LOWLAP:-build/quickstart/src/cli/lowlap}
[[ -x $lowlap ]] || lowlap=lowlap
room=sfm_data/samples/room
out=${1:-out/rescue}
rm -rf "$out"
mkdir -p "$out/sparse"

# Neither a screen nor a graphics card is needed.
export QT_QPA_PLATFORM=offscreen
run_colmap() { colmap "$@" >>"$out/colmap.log" 2>&1; }

echo "== COLMAP"
# Its pixels have the corner of the image at (0, 0), those of K.txt the middle of
# the first one.
camera=$(awk 'NR == 1 { fx = $1; cx = $3 } NR == 2 { fy = $2; cy = $3 }
  END { printf "%s,%s,%s,%s", fx, fy, cx + 0.5, cy + 0.5 }' "$room/images/K.txt")
(cd "$room/images" && ls ./*.jpg) | sed 's|^\./||' >"$out/images.txt"
run_colmap feature_extractor --database_path "$out/database.db" \
  --image_path "$room/images" --image_list_path "$out/images.txt" \
  --ImageReader.single_camera 1 --ImageReader.camera_model PINHOLE \
  --ImageReader.camera_params "$camera" --SiftExtraction.use_gpu 0
# One thread each, so that its random choices hardly vary.
run_colmap exhaustive_matcher --database_path "$out/database.db" \
  --SiftMatching.use_gpu 0 --SiftMatching.num_threads 1
run_colmap mapper --database_path "$out/database.db" \
  --image_path "$room/images" --output_path "$out/sparse" \
  --Mapper.ba_refine_focal_length 0 --Mapper.ba_refine_extra_params 0 \
  --Mapper.init_min_num_inliers 15 --Mapper.init_min_tri_angle 2 \
  --Mapper.init_max_forward_motion 1 --Mapper.min_num_matches 8 \
  --Mapper.abs_pose_min_num_inliers 6 \
  --Mapper.abs_pose_min_inlier_ratio 0.05 --Mapper.min_model_size 3 \
  --Mapper.num_threads 1
for model in "$out"/sparse/*; do
  echo "$model: $(colmap model_analyzer --path "$model" 2>&1 |
    grep 'Registered images') of $(wc -l <"$out/images.txt")"
done

echo
echo "== lowlap merge"
photographs=("$room/images" --intrinsics "$room/images/K.txt" --pairs cycle
             --gt "$room/gt_dense_cameras" --output "$out/merged")
if ! "$lowlap" merge "$out"/sparse/* --images "${photographs[@]}"; then
  # Another version of COLMAP may place cameras so that nothing bears them out:
  # such a model is refused, and there is nothing to rescue.
  echo "== lowlap run, from the photographs alone"
  "$lowlap" run "${photographs[@]}"
fi

echo
echo "== COLMAP again"
"$lowlap" convert "$out/merged/scene.lowlap" "$out/model" --to colmap-bin
colmap model_analyzer --path "$out/model"
