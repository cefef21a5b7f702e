// The view graph from above: views where their cameras are, relative poses
// coloured by evidence. The selected view shows its ratios as arcs.

const MOST_EDGES = 3000;
const MOST_ARCS = 24;  // the strongest

// Positions in the drawing; views without a camera stand in a row below. Views
// that lie on one another (or without any camera) stand on a circle instead.
function layOutGraph(width, height) {
  const placed = page.views.filter(view => view.camera);
  const xs = placed.map(view => view.camera.center[0]);
  const ys = placed.map(view => view.camera.center[1]);
  const [minX, maxX] = [Math.min(...xs), Math.max(...xs)];
  const [minY, maxY] = [Math.min(...ys), Math.max(...ys)];
  const edge = 30;
  const scale = Math.min((width - 2 * edge) / (maxX - minX),
                         (height - 2 * edge) / (maxY - minY));
  const others = page.views.filter(view => !view.camera);
  const places = [];
  for (const view of page.views) {
    const angle = 2 * Math.PI * view.index / page.views.length;
    if (!placed.length || !isFinite(scale)) {
      places.push([width / 2 + .42 * height * Math.sin(angle),
                   height / 2 - .42 * height * Math.cos(angle)]);
    } else if (view.camera) {
      places.push(
          [width / 2 + scale * (view.camera.center[0] - (minX + maxX) / 2),
           height / 2 - scale * (view.camera.center[1] - (minY + maxY) / 2)]);
    } else {
      const n = others.indexOf(view);
      places.push([edge + (n + .5) * (width - 2 * edge) / others.length,
                   height - 12]);
    }
  }
  return places;
}

function drawEdge(pair, places) {
  const [[x1, y1], [x2, y2]] = pair.views.map(view => places[view]);
  const isChosen = isSelected('pair', pair.index);
  const title = `${pairName(pair)}: log10 NFA ${fixed(pair.log10_nfa, 1)}` +
      (pair.used ? '' : `, not used: ${pair.note}`);
  return makeSvg(
      'g', { class: 'clickable', 'data-pair': pair.index,
             onclick: () => select('pair', pair.index) },
      makeSvg('title', {}, title),
      makeSvg('line', { x1, y1, x2, y2, stroke: 'transparent',
                        'stroke-width': 7 }),
      makeSvg('line', {
        x1, y1, x2, y2,
        stroke: pair.used ? evidenceColor(pair.log10_nfa) : 'var(--faint)',
        'stroke-dasharray': pair.used ? undefined : '3 4',
        'stroke-width': isChosen ? 5 : pair.used ?
            1 + 1.6 * evidenceShare(pair.log10_nfa) : 1,
      }));
}

// An arc about the middle view, from one relative pose to the other.
function drawArc(triplet, places, n) {
  const [first, middle, last] = triplet.views.map(view => places[view]);
  const angleTo = end => Math.atan2(end[1] - middle[1], end[0] - middle[0]);
  const from = angleTo(first);
  let turn = angleTo(last) - from;
  turn -= 2 * Math.PI * Math.round(turn / (2 * Math.PI));
  const radius = 15 + 4 * (n % (MOST_ARCS / 2));
  const at = angle => `${(middle[0] + radius * Math.cos(angle)).toFixed(1)} ` +
      `${(middle[1] + radius * Math.sin(angle)).toFixed(1)}`;
  const arc = `M${at(from)}A${radius} ${radius} 0 0 ${turn > 0 ? 1 : 0} ` +
      at(from + turn);
  return makeSvg(
      'path', {
        d: arc, class: 'clickable', fill: 'none', 'data-triplet': triplet.index,
        stroke: evidenceColor(triplet.log10_nfa || 0),
        'stroke-width': isSelected('triplet', triplet.index) ? 5 : 2.6,
        onclick: () => select('triplet', triplet.index),
      },
      makeSvg('title', {}, `${tripletName(triplet)}: log10 NFA ` +
                               fixed(triplet.log10_nfa, 1)));
}

function drawNode(view, places, width) {
  const [cx, cy] = places[view.index];
  const isAtEnd = cx > width - 90;  // no room for a name after it
  const isChosen = selectedViews().includes(view.index);
  return makeSvg(
      'g', { class: 'clickable', 'data-node': view.index,
             onclick: () => select('view', view.index) },
      makeSvg('title', {}, view.name),
      makeSvg('circle', {
        cx, cy, r: isChosen ? 7.5 : 5.5,
        fill: isChosen ? 'var(--accent)' : !view.camera ? 'var(--bad)' :
            view.warnings.length > 0 ? 'var(--line)' : 'var(--camera)',
        stroke: 'var(--panel)', 'stroke-width': 1.5,
      }),
      page.views.length <= 80 &&
          makeSvg('text', { x: cx + (isAtEnd ? -8 : 8), y: cy - 6,
                            'text-anchor': isAtEnd ? 'end' : 'start' },
                  shortName(view.index)));
}

// The view whose ratios are shown: the middle one of the selection.
function middleView() {
  const { kind, index } = state.selected;
  if (kind === 'view') return index;
  return kind === 'triplet' ? page.triplets[index].views[1] : -1;
}

function drawGraph(tab) {
  const { clientWidth: width, clientHeight: height } = tab;
  const places = layOutGraph(width, height);
  const edges = [...page.pairs].sort((a, b) => a.used - b.used)
      .filter(pair => pair.used || pair.point_inliers > 0 ||
                  isSelected('pair', pair.index)).slice(-MOST_EDGES);
  const middle = middleView();
  const arcs = middle < 0 ? [] : page.views[middle].triplets
      .filter(triplet => triplet.views[1] === middle && isMeaningful(triplet))
      .sort((a, b) => isSelected('triplet', b.index) -
                isSelected('triplet', a.index) || a.log10_nfa - b.log10_nfa);
  tab.replaceChildren(
      makeSvg('svg', { viewBox: `0 0 ${width} ${height}` },
              edges.map(pair => drawEdge(pair, places)),
              arcs.slice(0, MOST_ARCS).map((t, n) => drawArc(t, places, n)),
              page.views.map(view => drawNode(view, places, width))),
      evidenceLegend('evidence'));
}
