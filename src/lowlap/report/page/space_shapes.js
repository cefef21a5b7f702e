// What is drawn in space: positions at a stage of the solution, and colours.
// All geometries are made once; their attributes are filled anew.

// Between the two stages (0: before the adjustment, 1: after); what was not
// there before stays where it is.
function mixPositions(target, structure, share) {
  const { positions, before } = structure;
  if (!before || share >= 1) {
    target.set(positions);
    return;
  }
  for (let n = 0; n < positions.length; ++n) {
    const from = isFinite(before[n]) ? before[n] : positions[n];
    target[n] = from + share * (positions[n] - from);
  }
}

// Centre and corner offsets of a view's camera at a stage; undefined if it is
// not placed.
function cameraAt(view, share) {
  const { camera, camera_before: before } = page.views[view];
  if (!camera || !before || share >= 1) return camera;
  const mix = (from, to) => from.map((v, n) => v + share * (to[n] - v));
  return { center: mix(before.center, camera.center),
           corners: mix(before.corners, camera.corners) };
}

// The corners of the image plane at a depth, 12 numbers.
function imagePlane(camera, depth) {
  return camera.corners.map((v, n) => camera.center[n % 3] + depth * v);
}

// Cameras are drawn as deep as half the usual distance to the next one.
function usualDepth() {
  const centers = page.views.filter(v => v.camera).map(v => v.camera.center);
  const nearest = centers.map(a => Math.min(...centers.filter(b => b !== a).map(
      b => Math.hypot(a[0] - b[0], a[1] - b[1], a[2] - b[2]))));
  const usual = nearest.sort((a, b) => a - b)[nearest.length >> 1];
  return Math.max(.015, Math.min(.11, .4 * (isFinite(usual) ? usual : .2)));
}

const FRUSTUM_EDGES = [[0, 1], [0, 2], [0, 3], [0, 4], [1, 2], [2, 3], [3, 4],
                       [4, 1]];

// The edges of a frustum: 16 ends, 48 numbers.
function writeFrustum(target, at, camera, depth) {
  const corners = imagePlane(camera, depth);
  const vertices = [camera.center, ...[0, 3, 6, 9].map(
      n => corners.slice(n, n + 3))];
  for (const edge of FRUSTUM_EDGES) {
    for (const end of edge) {
      target.set(vertices[end], at);
      at += 3;
    }
  }
}

// How many of these views observe each landmark; `member` is 'landmarks' (of
// points) or 'lines'.
function countObservers(views, member, count) {
  const observers = new Uint8Array(count);
  for (const view of views) {
    const seen = new Set(page.views[view].features[member]);
    for (const landmark of seen) {
      if (landmark < count) ++observers[landmark];
    }
  }
  return observers;
}

// The quadrilateral of a coplanar pair: both lines, and what joins their ends
// without crossing. Six vertices, 18 numbers.
function writeQuad(target, at, lines, first, second) {
  const end = (line, n) =>
      Array.from(lines.subarray(6 * line + 3 * n, 6 * line + 3 * n + 3));
  const [a, b] = [end(first, 0), end(first, 1)];
  let [c, d] = [end(second, 0), end(second, 1)];
  const dot = [0, 1, 2].reduce((s, n) => s + (b[n] - a[n]) * (d[n] - c[n]), 0);
  if (dot < 0) [c, d] = [d, c];
  for (const vertex of [a, b, d, a, d, c]) {
    target.set(vertex, at);
    at += 3;
  }
}

// The colour of each point where a photograph sees it, from 0 to 255; darkened
// where it would vanish before a light page. Calls back whenever a photograph
// was sampled.
function samplePointColors(colors, changed) {
  const known = new Uint8Array(colors.length / 3);
  for (const { index, features } of page.views) {
    withPicture(index, picture => {
      const canvas = make('canvas');
      const { naturalWidth: width, naturalHeight: height } = picture;
      canvas.width = width;
      canvas.height = height;
      const context = canvas.getContext('2d', { willReadFrequently: true });
      context.drawImage(picture, 0, 0);
      const pixels = context.getImageData(0, 0, width, height).data;
      features.landmarks.forEach((landmark, n) => {
        if (landmark >= known.length || known[landmark]) return;
        known[landmark] = 1;
        const x = Math.floor(features.points[2 * n] / 65536 * width);
        const y = Math.floor(features.points[2 * n + 1] / 65536 * height);
        const at = 4 * (y * width + x);
        for (let c = 0; c < 3; ++c) {
          colors[3 * landmark + c] = .85 * pixels[at + c];
        }
      });
      changed();
    });
  }
}
