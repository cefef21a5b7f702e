// The inlier matches of the selected pair, on its photographs side by side.

const matchesShown = { points: true, lines: true };

// Where the photographs lie in a box, as large as they fit, beside one another.
function placeSideBySide(views, width, height) {
  const gap = 10, top = 30;
  const aspects = views.map(aspectOf);
  const boxWidth = Math.min((width - 3 * gap) / 2,
                            ...aspects.map(a => (height - top - gap) / a));
  const left = (width - 2 * boxWidth - gap) / 2;
  return views.map((_, n) => ({
    x: left + n * (boxWidth + gap), y: top, width: boxWidth,
    height: boxWidth * aspects[n],
  }));
}

function drawPairMatches(context, pair, boxes) {
  const [from, to] = pair.views.map(view => page.views[view].features);
  let index = 0;
  const link = (a, b, color) => {
    context.strokeStyle = color;
    context.globalAlpha = .45;
    context.lineWidth = .8;
    context.beginPath();
    context.moveTo(...a);
    context.lineTo(...b);
    context.stroke();
    context.globalAlpha = 1;
  };
  const each = (matches, draw) => {
    for (let n = 0; n + 1 < matches.length; n += 2) {
      draw(matches[n], matches[n + 1], distinctColor(index++));
    }
  };
  if (matchesShown.points) {
    each(pair.points, (first, second, color) => {
      const a = positionIn(boxes[0], from.points, first);
      const b = positionIn(boxes[1], to.points, second);
      link(a, b, color);
      context.fillStyle = color;
      for (const [x, y] of [a, b]) context.fillRect(x - 2, y - 2, 4, 4);
    });
  }
  if (matchesShown.lines) {
    each(pair.lines, (first, second, color) => {
      const ends = [[boxes[0], from, first], [boxes[1], to, second]].map(
          ([box, features, n]) => [0, 1].map(
              end => positionIn(box, features.segments, 2 * n + end)));
      const middle = ([a, b]) => [(a[0] + b[0]) / 2, (a[1] + b[1]) / 2];
      link(middle(ends[0]), middle(ends[1]), color);
      context.strokeStyle = color;
      context.lineWidth = 2.5;
      for (const [a, b] of ends) {
        context.beginPath();
        context.moveTo(...a);
        context.lineTo(...b);
        context.stroke();
      }
    });
  }
}

// The selected pair, or, of a view or triplet, its first pair in use.
function shownPair() {
  const { kind, index } = state.selected;
  if (kind === 'pair') return page.pairs[index];
  if (kind === 'triplet') return pairOf(...page.triplets[index].views.slice(0, 2));
  const pairs = kind === 'view' ? page.views[index].pairs : page.pairs;
  const used = pairs.filter(pair => pair.used);
  return used.sort((a, b) => a.log10_nfa - b.log10_nfa)[0] || pairs[0];
}

function drawMatchesTab(tab) {
  const pair = shownPair();
  if (!pair) {
    tab.replaceChildren(make('p', { class: 'empty' }, 'There are no pairs.'));
    return;
  }
  const canvas = make('canvas', { id: 'matches-canvas' });
  const draw = () => {
    if (!canvas.isConnected) return;
    const { clientWidth: width, clientHeight: height } = tab;
    const context = sharpContext(canvas, width, height);
    const boxes = placeSideBySide(pair.views, width, height);
    pair.views.forEach((view, n) => {
      const picture = pictures.get(view);
      drawBackground(context, view, boxes[n],
                     picture && picture.complete && picture);
    });
    context.fillStyle = 'rgb(255 255 255 / .25)';
    for (const box of boxes) {
      context.fillRect(box.x, box.y, box.width, box.height);
    }
    drawPairMatches(context, pair, boxes);
  };
  const makeKind = (name, count) => make('button', {
    class: 'toggle', 'aria-pressed': String(matchesShown[name]),
    onclick: event => {
      matchesShown[name] = !matchesShown[name];
      event.target.setAttribute('aria-pressed', String(matchesShown[name]));
      draw();
    },
  }, `${count} ${name}`);
  tab.replaceChildren(
      canvas,
      make('div', { class: 'toolbar',
                    style: 'position: absolute; top: 0; left: 0; right: 0' },
           linkTo('pair', pair.index, pairName(pair)),
           makeKind('points', pair.points.length / 2),
           makeKind('lines', pair.lines.length / 2)));
  draw();
  for (const view of pair.views) withPicture(view, draw);
}
