// Tables of the cameras, pairs and ratios; a click on a head sorts by it.

const sorting = {};  // by table: [column, -1 or 1]

function makeTable(name, kind, columns, items) {
  const [sorted, direction] = sorting[name] || [-1, 1];
  const rows = [...items];
  if (sorted >= 0) {
    const valueOf = columns[sorted][1];
    const compare = (a, b) => typeof a === 'string' ? a.localeCompare(b) : a - b;
    // What has no value comes last.
    rows.sort((a, b) => {
      const [va, vb] = [valueOf(a), valueOf(b)];
      if (va === undefined || vb === undefined) {
        return (va === undefined) - (vb === undefined);
      }
      return direction * compare(va, vb);
    });
  }
  const show = (value, digits) => value === undefined ? '–'
      : typeof value === 'string' ? value
      : digits === undefined      ? String(value) : value.toFixed(digits);
  return make(
      'table', { class: 'data' },
      make('thead', {}, make('tr', {}, columns.map(([title, valueOf], n) => make(
          'th', {
            class: items.length > 0 && typeof valueOf(items[0]) === 'string' &&
                'text',
            onclick: () => {
              sorting[name] = [n, sorted === n ? -direction : 1];
              redrawTab();
            },
          }, title, sorted === n ? (direction > 0 ? ' ▲' : ' ▼') : '')))),
      make('tbody', {}, rows.map(item => make(
          'tr', { class: isSelected(kind, item.index) && 'selected',
                  'data-index': item.index,
                  onclick: () => select(kind, item.index) },
          columns.map(([, valueOf, digits]) => {
            const value = valueOf(item);
            return make('td', { class: typeof value === 'string' && 'text' },
                        show(value, digits));
          })))));
}

const inModel = list => countOf(list, value => value !== NO_LANDMARK);

function drawCameras(tab) {
  const columns = [
    ['photograph', view => view.name],
    ['state', view => !view.camera ? 'not placed'
        : view.warnings.length > 0 ? 'doubtful' : 'firm'],
    ['relative poses', view => countOf(view.pairs, pair => pair.used)],
    ['points', view => inModel(view.features.landmarks)],
    ['segments', view => inModel(view.features.lines)],
    ['point RMSE (px)', view => rmsePx('points', view), 2],
    ['line RMSE (px)', view => rmsePx('lines', view), 2],
  ];
  if (page.views.some(view => view.center_stddev !== undefined)) {
    columns.push(['deviation (% of the scene)',
                  view => view.center_stddev && 100 * view.center_stddev, 3]);
  }
  if (page.hasTruth) {
    columns.push(['position error', view => view.position_error, 4],
                 ['rotation error (°)', view => view.rotation_error_deg, 3]);
  }
  tab.replaceChildren(makeTable('cameras', 'view', columns, page.views));
}

function drawPairs(tab) {
  tab.replaceChildren(makeTable('pairs', 'pair', [
    ['pair', pairName],
    ['in use', pair => pair.used ? 'yes' : 'no'],
    ['point matches', pair => pair.point_matches],
    ['inliers', pair => pair.point_inliers],
    ['line matches', pair => pair.line_matches],
    ['inliers', pair => pair.line_inliers],
    ['log10 NFA', pair => pair.log10_nfa, 1],
    ['geometry, or why not', pair => pair.note],
  ], page.pairs));
}

function drawRatios(tab) {
  const exp = log => log === undefined ? undefined : Math.exp(log);
  const names = [];
  for (const { kinds } of page.triplets) {
    for (const [name] of kinds || []) {
      if (!names.includes(name)) names.push(name);
    }
  }
  const columns = [
    ['first – middle – last', tripletName],
    ['verdict', triplet => triplet.verdict.replace(/_/g, ' ')],
    ['ratio', triplet => exp(triplet.log_ratio), 4],
    ['95 % from', triplet => exp(triplet.low), 4],
    ['to', triplet => exp(triplet.high), 4],
    ['log10 NFA', triplet => triplet.log10_nfa, 1],
    ...names.map(name => [name.replace(/_/g, ' '), triplet => {
      const kind = (triplet.kinds || []).find(([other]) => other === name);
      return kind ? kind[1] : undefined;
    }]),
  ];
  if (page.hasTruth) {
    columns.push(['true ratio', triplet => exp(triplet.true_log_ratio), 4]);
  }
  tab.replaceChildren(makeTable('ratios', 'triplet', columns, page.triplets));
}
