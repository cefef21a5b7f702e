// Photographs with their features, drawn into canvases; outlines where there is
// no photograph.

const pictures = new Map();  // by view: an image, once it was asked for

// Calls back at once if the picture is there, later if not, never without one.
function withPicture(view, callback) {
  const { photograph } = page.views[view];
  if (!photograph) return;
  let picture = pictures.get(view);
  if (!picture) {
    picture = new Image();
    picture.src = photograph;
    pictures.set(view, picture);
  }
  if (picture.complete && picture.naturalWidth > 0) {
    callback(picture);
  } else {
    picture.addEventListener('load', () => callback(picture), { once: true });
  }
}

function aspectOf(view) {
  const { width, height } = page.views[view];
  return width > 0 && height > 0 ? height / width : 2 / 3;
}

function drawBackground(context, view, box, picture) {
  if (picture) {
    context.drawImage(picture, box.x, box.y, box.width, box.height);
    return;
  }
  context.fillStyle = cssColor('raised');
  context.fillRect(box.x, box.y, box.width, box.height);
  context.strokeStyle = cssColor('rule');
  context.strokeRect(box.x + .5, box.y + .5, box.width - 1, box.height - 1);
}

function positionIn(box, positions, n) {
  return [box.x + positions[2 * n] / 65535 * box.width,
          box.y + positions[2 * n + 1] / 65535 * box.height];
}

function drawPoints(context, box, points, chosen, color, size) {
  context.fillStyle = color;
  for (let n = 0; n < points.length / 2; ++n) {
    if (!chosen(n)) continue;
    const [x, y] = positionIn(box, points, n);
    context.fillRect(x - size / 2, y - size / 2, size, size);
  }
}

function drawSegments(context, box, segments, chosen, color, width) {
  context.strokeStyle = color;
  context.lineWidth = width;
  context.beginPath();
  for (let n = 0; n < segments.length / 4; ++n) {
    if (!chosen(n)) continue;
    context.moveTo(...positionIn(box, segments, 2 * n));
    context.lineTo(...positionIn(box, segments, 2 * n + 1));
  }
  context.stroke();
}

const OVERLAY_COLORS = {
  detected: ['rgb(150 90 200 / .6)', 'rgb(150 90 200 / .6)'],
  matched: ['#e3c000', '#e3c000'],
  model: ['#38b6ff', '#ff7a1a'],
};

// The kinds of the overlay that are on; what is in the model lies on top.
function drawOverlay(context, view, box, size) {
  const { overlay } = state;
  const { features, detected } = page.views[view];
  const layers = [
    overlay.detected && detected &&
        ['detected', detected, () => true, () => true],
    overlay.matched && ['matched', features,
                        n => features.landmarks[n] === NO_LANDMARK,
                        n => features.lines[n] === NO_LANDMARK],
    overlay.model && ['model', features,
                      n => features.landmarks[n] !== NO_LANDMARK,
                      n => features.lines[n] !== NO_LANDMARK],
  ];
  for (const layer of layers) {
    if (!layer) continue;
    const [name, found, isPoint, isLine] = layer;
    const [pointColor, lineColor] = OVERLAY_COLORS[name];
    if (overlay.segments) {
      drawSegments(context, box, found.segments, isLine, lineColor, .8 * size);
    }
    if (overlay.points) {
      drawPoints(context, box, found.points, isPoint, pointColor, size);
    }
  }
}

// The view at the width that the canvas has in the page. Features are drawn
// smaller where there are many, so that the photograph can be seen.
function drawPhotograph(canvas, view, largest) {
  const { points, segments } = page.views[view].features;
  const count = points.length / 2 + segments.length / 4;
  const size = largest * Math.max(.45, Math.min(1, Math.sqrt(800 / count)));
  const width = canvas.clientWidth || 200;
  const height = Math.round(width * aspectOf(view));
  canvas.style.height = `${height}px`;
  const draw = picture => {
    if (!canvas.isConnected) return;
    const context = sharpContext(canvas, width, height);
    const box = { x: 0, y: 0, width, height };
    drawBackground(context, view, box, picture);
    drawOverlay(context, view, box, size);
  };
  if (!page.views[view].photograph) draw();
  withPicture(view, draw);
}
