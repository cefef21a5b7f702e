// Uses the page as a person would, by events, and writes what came of it as
// JSON into an element "self-test". Appended to a page by page_browser_test.cc.
'use strict';

const outcome = { errors: [] };
window.addEventListener(
    'error', event => outcome.errors.push(String(event.message)));

const frames = count => new Promise(done => {
  const next = () => count-- > 0 ? requestAnimationFrame(next) : done();
  next();
});
const one = selector => document.querySelector(selector);
const press = element => {
  for (const type of ['mousedown', 'mouseup', 'click']) {
    element.dispatchEvent(new MouseEvent(type, { bubbles: true }));
  }
};
const pressAt = (element, clientX, clientY) => {
  for (const type of ['mousedown', 'mouseup', 'click']) {
    element.dispatchEvent(
        new MouseEvent(type, { bubbles: true, clientX, clientY, button: 0 }));
  }
};

// How many colours a canvas shows.
function colorsOf(canvas) {
  const copy = document.createElement('canvas');
  copy.width = canvas.width;
  copy.height = canvas.height;
  const context = copy.getContext('2d');
  context.drawImage(canvas, 0, 0);
  const { data } = context.getImageData(0, 0, copy.width, copy.height);
  return new Set(new Uint32Array(data.buffer)).size;
}

function colorsOfSpace() {
  space.render();
  return colorsOf(space.canvas);
}

async function testSpace() {
  outcome.spaceColors = colorsOfSpace();
  for (const name of ['points', 'lines', 'cameras', 'pictures']) {
    if (state.shown[name]) press(one(`#shown-${name}`));
  }
  outcome.colorsOfNothing = colorsOfSpace();
  press(one('#shown-cameras'));
  outcome.colorsOfCameras = colorsOfSpace();
  for (const name of ['points', 'lines', 'pictures']) {
    press(one(`#shown-${name}`));
  }
  // The middle of a camera's image plane lies under the pointer.
  const rectangle = space.canvas.getBoundingClientRect();
  const last = page.views.length - 1;
  const center = projectToScreen(cameraAt(last, 1).center, rectangle);
  pressAt(space.canvas, center.x, center.y);
  outcome.pickedCamera = state.selected.kind === 'view' &&
      Math.hypot(...['x', 'y'].map(axis => projectToScreen(
          cameraAt(state.selected.index, 1).center, rectangle)[axis] -
          center[axis])) < 60;
  if (one('#stage-before')) {
    press(one('#stage-before'));
    await frames(60);
    outcome.shareBefore = space.share;
    press(one('#stage-after'));
    await frames(60);
    outcome.shareAfter = space.share;
  }
}

async function testPage() {
  await frames(5);
  outcome.title = one('#header h1').textContent;
  outcome.thumbnails = document.querySelectorAll('.thumbnail').length;
  outcome.hasSpace = Boolean(space);
  if (space) await testSpace();

  press(document.querySelectorAll('.thumbnail')[1]);
  await frames(3);
  outcome.viewHead = one('#inspector h2').textContent;
  outcome.viewAddress = location.hash;
  const photograph = one('#photograph');
  outcome.photographColors = colorsOf(photograph);
  press(one('#overlay-points'));
  press(one('#overlay-segments'));
  outcome.bareColors = colorsOf(photograph);
  press(one('#overlay-points'));
  press(one('#overlay-segments'));

  press(one('#tab-graph'));
  outcome.edges = document.querySelectorAll('#tab [data-pair]').length;
  const nodes = [...document.querySelectorAll('#tab [data-node]')];
  outcome.nodes = nodes.length;
  outcome.nodeNames = nodes.map(
      node => (node.querySelector('text') || {}).textContent);
  const arc = one('#tab [data-triplet]');
  if (arc) {
    press(arc);
    outcome.tripletHead = one('#inspector h2').textContent;
    outcome.profiles = document.querySelectorAll('#inspector .profile').length;
    outcome.profilePath =
        one('#inspector .profile g path:last-of-type').getAttribute('d').length;
  }
  press(one('#tab [data-pair]'));
  outcome.pairHead = one('#inspector h2').textContent;
  press(one('#tab-matches'));
  await frames(3);
  outcome.matchColors = colorsOf(one('#matches-canvas'));
  press(one('#tab-residuals'));
  outcome.histograms = document.querySelectorAll('#tab figure').length;
  press(one('#tab [data-bar]'));
  outcome.barSelects = state.selected.kind;
  for (const name of ['cameras', 'pairs', 'ratios']) {
    press(one(`#tab-${name}`));
    outcome[`${name}Rows`] = document.querySelectorAll('#tab tbody tr').length;
  }
  press(one('#tab-cameras'));
  press(one('#tab th:last-child'));
  press(one('#tab tbody tr'));
  outcome.rowSelects = location.hash;
  outcome.scripts = document.querySelectorAll('script').length;
}

testPage()
    .catch(error => outcome.errors.push(String(error.stack)))
    .then(() => {
      const result = document.createElement('pre');
      result.id = 'self-test';
      result.textContent = JSON.stringify(outcome).replace(/</g, '\\u003c')
                               .replace(/&/g, '\\u0026');
      document.body.append(result);
    });
