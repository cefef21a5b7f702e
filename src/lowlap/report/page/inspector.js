// What there is to say about what is selected, on the right.

function linkTo(kind, index, text) {
  return make('button', { class: 'link', onclick: () => select(kind, index) },
              text);
}

const pairName = pair => pair.views.map(shortName).join(' – ');
const tripletName = triplet => triplet.views.map(shortName).join(' – ');

// Its name alone, if the page does not hold the pair.
function linkToPair(a, b) {
  const pair = pairOf(a, b);
  const name = pairName({ views: [a, b] });
  return pair ? linkTo('pair', pair.index, name) : name;
}

const MOST_ROWS = 12;

// A list with a dot of evidence for each; the strongest first.
function evidenceRows(kind, items, nameOf) {
  const rows = [...items].sort((a, b) => a.log10_nfa - b.log10_nfa);
  const makeRow = item => make(
      'div', { class: 'row', 'data-kind': kind, 'data-index': item.index,
               onclick: () => select(kind, item.index) },
      make('i', { style: `background: ${evidenceColor(item.log10_nfa)}` }),
      make('span', {}, nameOf(item)),
      make('b', {}, fixed(item.log10_nfa, 1)));
  return [
    rows.slice(0, MOST_ROWS).map(makeRow),
    rows.length > MOST_ROWS && make(
        'details', {},
        make('summary', { class: 'soft' }, `${rows.length - MOST_ROWS} more`),
        rows.slice(MOST_ROWS).map(makeRow)),
  ];
}

function countOf(list, wanted) {
  let count = 0;
  for (const value of list) count += wanted(value);
  return count;
}

function share(part, all) {
  return all === 0 ? '–' :
      `${part} of ${all} (${Math.round(100 * part / all)} %)`;
}

function describeView(view) {
  const { features } = view;
  const inModel = list => share(countOf(list, v => v !== NO_LANDMARK),
                                list.length);
  const used = view.pairs.filter(pair => pair.used);
  const ratios = view.triplets.filter(isMeaningful);
  const moved = view.camera && view.camera_before && Math.hypot(
      ...view.camera.center.map((v, n) => v - view.camera_before.center[n]));
  const rmse = kind => {
    const px = rmsePx(kind, view);
    return px === undefined ? '–' : `${number(px, 2)} px`;
  };
  const canvas = make('canvas', { id: 'photograph' });
  const draw = () => canvas.isConnected && drawPhotograph(canvas, view.index, 2);
  requestAnimationFrame(draw);
  redrawSelected = draw;
  return [
    make('h2', {}, view.name,
         badgeOf(view).className !== 'soft' && badgeOf(view)),
    canvas,
    view.warnings.map(text => make('p', { class: 'warning' }, text)),
    facts([
      ['size', `${view.width} × ${view.height} px`],
      view.focal_px && ['focal lengths',
                        `${view.focal_px.map(f => fixed(f, 1)).join(', ')} px`],
      view.detected && ['detected', `${view.detected.num_points} points, ` +
                                        `${view.detected.num_segments} segments`],
      ['points in the model', inModel(features.landmarks)],
      ['segments in the model', inModel(features.lines)],
      ['RMSE of points, lines', `${rmse('points')}, ${rmse('lines')}`],
      view.position_error !== undefined &&
          ['error of the position', number(view.position_error)],
      view.rotation_error_deg !== undefined &&
          ['error of the rotation', `${number(view.rotation_error_deg, 2)}°`],
      view.center_stddev !== undefined &&
          ['deviation of the position',
           `${number(100 * view.center_stddev, 2)} % of the scene`],
      moved && ['moved by the adjustment',
                `${number(100 * moved, 2)} % of the scene`],
    ]),
    view.camera && space && make('p', {}, make('button', {
      class: 'link', onclick: () => space.lookThrough(view.index),
    }, 'Look through this camera')),
    make('h3', {},
         `Relative poses in use: ${used.length} of ${view.pairs.length}`),
    evidenceRows('pair', used, pairName),
    ratios.length > 0 &&
        make('h3', {}, `Meaningful scale ratios: ${ratios.length} of ` +
                           `${view.triplets.length}`),
    evidenceRows('triplet', ratios, tripletName),
  ];
}

function describePair(pair) {
  const both = page.triplets.filter(
      triplet => pair.views.includes(triplet.views[1]) &&
          pair.views.every(view => triplet.views.includes(view)));
  return [
    make('h2', {}, pairName(pair),
         !pair.used && make('span', { class: 'badge bad' }, 'not used')),
    pair.note && make('p', { class: pair.used ? 'note' : 'warning' },
                      pair.note.replace(/_/g, ' ')),
    make('p', {}, pair.views.map(
        view => [linkTo('view', view, page.views[view].name), ' '])),
    facts([
      ['log10 NFA', fixed(pair.log10_nfa, 1)],
      ['inliers', `${pair.point_inliers || 0} points, ` +
                      `${pair.line_inliers || 0} lines`],
      pair.point_matches + pair.line_matches > 0 &&
          ['matches by descriptors alone', `${pair.point_matches} points, ` +
                                               `${pair.line_matches} lines`],
    ]),
    make('p', {}, make('button', { class: 'link',
                                   onclick: () => openTab('matches') },
                       'See the matches side by side')),
    make('h3', {}, `Scale ratios across it: ${both.length}`),
    evidenceRows('triplet', both.filter(t => t.log10_nfa !== undefined),
                 tripletName),
  ];
}

function describeTriplet(triplet) {
  const ratio = log => number(Math.exp(log), 4);
  const [first, middle, last] = triplet.views;
  const verdict = triplet.verdict.replace(/_/g, ' ');
  const head = [
    make('h2', {}, tripletName(triplet), !isMeaningful(triplet) &&
        make('span', { class: 'badge' }, verdict)),
    make('p', { class: 'note' },
         'Length of the baseline ', linkToPair(middle, last),
         ' over that of ', linkToPair(first, middle)),
  ];
  if (triplet.log_ratio === undefined) {
    return [head, make('p', { class: 'empty' },
                       'Nothing in these views says anything about it.')];
  }
  const kinds = triplet.kinds.filter(([, , candidates]) => candidates > 0);
  const names = triplet.profile ?
      (triplet.profile.kinds || []).map(([name]) => name) : [];
  const colorOf = name => names.includes(name) ?
      KIND_COLORS[names.indexOf(name) % KIND_COLORS.length] : 'var(--faint)';
  return [
    head,
    triplet.profile ? plotBoth(triplet) : make(
        'p', { class: 'note' },
        `The NFA of all its ratios is not in this page, which has ` +
        `${page.triplets.filter(other => other.profile).length} of ` +
        `${page.triplets.length}: “lowlap scales --profile” writes all.`),
    facts([
      ['ratio', ratio(triplet.log_ratio)],
      ['95 % interval', `${ratio(triplet.low)} to ${ratio(triplet.high)}`],
      triplet.true_log_ratio !== undefined &&
          ['true ratio', ratio(triplet.true_log_ratio)],
      ['log10 NFA', fixed(triplet.log10_nfa, 1)],
      triplet.second && ['second mode', `${ratio(triplet.second[0])} ` +
                                            `(${fixed(triplet.second[1], 1)})`],
    ]),
    make('h3', {}, 'Evidence: inliers, log10 NFA, information'),
    make('div', {}, kinds.map(
        ([name, inliers, candidates, nfa, information]) => make(
            'div', { class: 'row' },
            make('i', { style: `background: ${colorOf(name)}` }),
            make('span', {}, `${name.replace(/_/g, ' ')}: ` +
                                 `${inliers} of ${candidates}`),
            make('b', {}, `${fixed(nfa, 1)}, ` +
                              `${Math.round(100 * information)} %`)))),
    make('h3', {}, 'Views'),
    triplet.views.map(view => [linkTo('view', view, page.views[view].name), ' ']),
  ];
}

function plotBoth(triplet) {
  return [
    make('h3', {}, 'log10 NFA of every ratio'), plotProfile(triplet, true),
    make('h3', {}, 'About the ratio'), plotProfile(triplet, false),
  ];
}

function describePage() {
  const { num_points: all, point_stride: stride, feature_stride: tracks,
          num_pairs: pairs, num_used_pairs: used, num_triplets: triplets,
          num_meaningful: meaningful } = page.thinning;
  return [
    make('h2', {}, page.title),
    make('p', { class: 'note' },
         'Click a camera, a photograph, a line of the view graph or a row of ' +
         'a table to see what it rests on.'),
    facts([
      ['photographs', page.views.length],
      ['cameras placed', page.views.filter(view => view.camera).length],
      // Not every command knows which are.
      used < pairs ? ['relative poses in use', `${used} of ${pairs}`]
                   : ['relative poses', pairs],
      ['meaningful scale ratios', `${meaningful} of ${triplets}`],
      ['coplanar pairs of lines', page.coplanarPairs.length / 2],
    ]),
    stride > 1 && make('p', { class: 'note' },
                       `One of ${stride} points is shown, of ${all}.`),
    tracks > 1 && make('p', { class: 'note' },
                       `One of ${tracks} matched points is shown.`),
    pairs > page.pairs.length &&
        make('p', { class: 'note' }, `Of ${pairs} pairs those in use, and of ` +
                                         'most evidence, are here.'),
    triplets > page.triplets.length &&
        make('p', { class: 'note' }, `Of ${triplets} ratios those with a ` +
                                         'profile, and of most evidence, are here.'),
    page.warnings.length > 0 && make('h3', {}, 'Warnings'),
    page.warnings.map(({ text }) => make('p', { class: 'warning' }, text)),
  ];
}

let redrawSelected = null;

function startInspector() {
  const inspector = document.getElementById('inspector');
  const show = () => {
    const { kind, index } = state.selected;
    redrawSelected = null;
    const content = kind === 'view' ? describeView(page.views[index])
        : kind === 'pair'           ? describePair(page.pairs[index])
        : kind === 'triplet'        ? describeTriplet(page.triplets[index])
                                    : describePage();
    inspector.replaceChildren();
    fill(inspector, {}, content.flat());
    inspector.scrollTop = 0;
  };
  listen('selected', show);
  listen('overlay', () => redrawSelected && redrawSelected());
  show();
}
