// Which camera a click in space means.

let pressedAt = null;

function rememberPress(event) {
  pressedAt = [event.clientX, event.clientY];
}

function projectToScreen(position, rectangle) {
  const p = new THREE.Vector3(...position).project(space.camera);
  return { x: rectangle.left + (p.x + 1) / 2 * rectangle.width,
           y: rectangle.top + (1 - p.y) / 2 * rectangle.height, depth: p.z };
}

function isInside(polygon, x, y) {
  let inside = false;
  polygon.forEach((a, n) => {
    const b = polygon[(n + 1) % polygon.length];
    if ((a.y > y) !== (b.y > y) &&
        x < a.x + (y - a.y) / (b.y - a.y) * (b.x - a.x)) {
      inside = !inside;
    }
  });
  return inside;
}

// The nearest camera with the image plane or a side of the frustum under the
// place, or with its centre within a few pixels of it; -1: none.
function cameraUnder(x, y) {
  const rectangle = space.canvas.getBoundingClientRect();
  let best = { view: -1, depth: Infinity };
  page.views.forEach((view, n) => {
    const camera = cameraAt(n, space.share);
    if (!camera) return;
    const center = projectToScreen(camera.center, rectangle);
    const plane = imagePlane(camera, space.depth);
    const corners = [0, 3, 6, 9].map(
        at => projectToScreen(plane.slice(at, at + 3), rectangle));
    if (Math.abs(center.depth) > 1 || center.depth >= best.depth) return;
    const faces = [corners, ...corners.map(
        (corner, c) => [center, corner, corners[(c + 1) % 4]])];
    if (Math.hypot(center.x - x, center.y - y) < 7 ||
        faces.some(face => isInside(face, x, y))) {
      best = { view: n, depth: center.depth };
    }
  });
  return best.view;
}

function pickCamera(event) {
  const moved = pressedAt && Math.hypot(event.clientX - pressedAt[0],
                                        event.clientY - pressedAt[1]);
  if (moved > 4) return;
  const view = cameraUnder(event.clientX, event.clientY);
  if (view >= 0) {
    select('view', view);
  } else {
    select('', -1);
  }
}
