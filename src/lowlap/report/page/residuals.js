// Histograms of the residuals, before and after the adjustment, of the scene or
// of the selected view; and the RMSE of every view.

function plotHistogram(kind, view, width, height) {
  const residuals = page.residuals[kind];
  const after = view >= 0 ? residuals.views[view] : residuals.after;
  const before = view >= 0 ? null : residuals.before;
  const edge = { left: 40, right: 8, top: 8, bottom: 32 };
  const numBins = after.counts.length;
  const most = Math.max(1, ...after.counts, ...(before ? before.counts : []));
  const x = bin => edge.left + bin / numBins * (width - edge.left - edge.right);
  const y = count => height - edge.bottom -
      count / most * (height - edge.top - edge.bottom);
  const outline = counts => `M${x(0)} ${y(0)}` + counts.map(
      (count, n) => `V${y(count).toFixed(1)}H${x(n + 1).toFixed(1)}`).join('') +
      `V${y(0)}`;
  const end = residuals.bin_px * numBins;
  const color = kind === 'points' ? 'var(--point)' : 'var(--line)';
  return make(
      'figure', {},
      make('figcaption', {},
           kind === 'points' ? 'Points: ' : 'Lines: ',
           view >= 0 ? `RMSE ${number(after.rmse_px, 3)} px`
                     : `median ${number(after.median_px, 3)} px`,
           make('span', { class: 'soft' },
                before ? `, ${number(before.median_px, 3)} before` : '',
                `; ${after.total} observations, ${after.beyond} beyond`)),
      makeSvg(
          'svg', { width, height },
          makeSvg('path', { d: outline(after.counts), fill: color,
                            opacity: .65 }),
          before && makeSvg('path', { d: outline(before.counts), fill: 'none',
                                      stroke: 'var(--ink)',
                                      'stroke-dasharray': '3 2' }),
          ticksOf(0, most, 4).map(tick => makeSvg(
              'text', { x: edge.left - 5, y: y(tick) + 4,
                        'text-anchor': 'end' }, String(tick))),
          ticksOf(0, end, 6).map(tick => makeSvg(
              'text', { x: x(tick / residuals.bin_px),
                        y: height - edge.bottom + 14,
                        'text-anchor': 'middle' }, String(tick))),
          makeSvg('line', { x1: edge.left, x2: width - edge.right, y1: y(0),
                            y2: y(0), stroke: 'var(--faint)' }),
          makeSvg('text', { x: (width + edge.left) / 2, y: height - 3,
                            'text-anchor': 'middle' }, 'residual (px)')));
}

// Undefined where nothing is observed.
function rmsePx(kind, view) {
  const { total, rmse_px: px } = page.residuals[kind].views[view.index];
  return total > 0 ? px : undefined;
}

function plotRmseOfViews(width) {
  const rows = page.views.filter(view => view.camera);
  const rmse = (kind, view) => rmsePx(kind, view) || 0;
  const most = Math.max(.01, ...rows.map(view => Math.max(
      rmse('points', view), rmse('lines', view))));
  const step = 16, left = 70;
  return make(
      'figure', {},
      make('figcaption', {}, 'RMSE by photograph (px)'),
      makeSvg(
          'svg', { width, height: step * rows.length + 4 },
          rows.map((view, n) => makeSvg(
              'g', { class: 'clickable', 'data-bar': view.index,
                     onclick: () => select('view', view.index) },
              makeSvg('text', { x: left - 6, y: step * n + 11,
                                'text-anchor': 'end' }, shortName(view.index)),
              ['points', 'lines'].map((kind, k) => makeSvg('rect', {
                x: left, y: step * n + 2 + 6 * k, height: 5,
                width: rmse(kind, view) / most * (width - left - 40),
                fill: kind === 'points' ? 'var(--point)' : 'var(--line)',
              })),
              makeSvg('text', { x: left + 4 + (width - left - 40) *
                                    Math.max(rmse('points', view),
                                             rmse('lines', view)) / most,
                                y: step * n + 11 },
                      fixed(Math.max(rmse('points', view),
                                     rmse('lines', view)), 2))))));
}

function drawResiduals(tab) {
  const { kind, index } = state.selected;
  const view = kind === 'view' ? index : -1;
  const width = (tab.clientWidth - 60) / 3;
  const height = Math.min(tab.clientHeight - 70, .75 * width);
  tab.replaceChildren(
      make('div', { class: 'plots' },
           ['points', 'lines']
               .filter(name => page.residuals[name].after.total > 0)
               .map(name => plotHistogram(name, view, width, height)),
           plotRmseOfViews(width)),
      make('p', { class: 'note', style: 'padding: 0 10px' },
           'Distances in the photographs, of what is in use.'));
}
