// The NFA of every ratio of a triplet, as an SVG plot.

const KIND_COLORS = ['var(--point)', 'var(--line)', 'var(--plane)',
                     'var(--camera)', 'var(--truth)'];

// Round numbers of 1, 2, 5 times a power of ten, about so many.
function ticksOf(low, high, about) {
  const raw = (high - low) / about;
  const power = 10 ** Math.floor(Math.log10(raw));
  const step = power * [1, 2, 5, 10].find(m => m * power >= raw);
  const ticks = [];
  for (let tick = Math.ceil(low / step); tick * step <= high; ++tick) {
    ticks.push(Number((tick * step).toPrecision(12)));
  }
  return ticks;
}

// Powers of 2 and their like, for ratios.
function ratioTicks(low, high) {
  const ratios = [.01, .02, .05, .1, .2, .5, 1, 2, 5, 10, 20, 50, 100];
  const inside = ratios.filter(r => Math.log(r) > low && Math.log(r) < high);
  if (inside.length >= 3) return inside;
  return ticksOf(Math.exp(low), Math.exp(high), 4).filter(tick => tick > 0);
}

function plotProfile(triplet, whole) {
  const profile = decodeProfile(triplet.profile);
  const width = 400, height = 230;
  const edge = { left: 44, right: 10, top: 10, bottom: 34 };
  // Whole, or where the evidence is: about the ratio.
  const reach = Math.max(.12, 12 * (triplet.high - triplet.low) / 2);
  const ends = [profile.logRatios[0],
                profile.logRatios[profile.logRatios.length - 1]];
  const low = whole ? ends[0] : Math.max(ends[0], triplet.log_ratio - reach);
  const high = whole ? ends[1] : Math.min(ends[1], triplet.log_ratio + reach);
  const least = Math.min(-1, triplet.log10_nfa, ...profile.total) * 1.08;
  const most = Math.max(1, -.08 * least);
  const x = log => edge.left +
      (log - low) / (high - low || 1) * (width - edge.left - edge.right);
  const y = nfa => edge.top +
      (most - nfa) / (most - least) * (height - edge.top - edge.bottom);
  const path = values => values.map((value, n) =>
      `${n ? 'L' : 'M'}${x(profile.logRatios[n]).toFixed(1)} ` +
      `${y(Math.min(most, value)).toFixed(1)}`).join('');
  const mark = (log, color, dash) => log > low && log < high && makeSvg(
      'line', { x1: x(log), x2: x(log), y1: edge.top, y2: height - edge.bottom,
                stroke: color, 'stroke-dasharray': dash });
  const clip = `clip-${triplet.index}`;
  return makeSvg(
      'svg', { viewBox: `0 0 ${width} ${height}`, class: 'profile' },
      makeSvg('clipPath', { id: clip }, makeSvg('rect', {
        x: edge.left, y: edge.top, width: width - edge.left - edge.right,
        height: height - edge.top - edge.bottom,
      })),
      ticksOf(least, most, 5).map(tick => [
        makeSvg('line', { x1: edge.left, x2: width - edge.right, y1: y(tick),
                          y2: y(tick), class: 'axis' }),
        makeSvg('text', { x: edge.left - 5, y: y(tick) + 4,
                          'text-anchor': 'end' }, String(tick)),
      ]),
      ratioTicks(low, high).map(ratio => [
        makeSvg('line', { x1: x(Math.log(ratio)), x2: x(Math.log(ratio)),
                          y1: edge.top, y2: height - edge.bottom,
                          class: 'axis' }),
        makeSvg('text', { x: x(Math.log(ratio)), y: height - edge.bottom + 14,
                          'text-anchor': 'middle' }, String(ratio)),
      ]),
      makeSvg('line', { x1: edge.left, x2: width - edge.right, y1: y(0),
                        y2: y(0), stroke: 'var(--soft)' }),
      makeSvg('g', { 'clip-path': `url(#${clip})` },
              makeSvg('rect', {
                x: x(triplet.low), y: edge.top,
                width: Math.max(1, x(triplet.high) - x(triplet.low)),
                height: height - edge.top - edge.bottom,
                fill: 'var(--accent)', opacity: .15,
              }),
              profile.kinds.map(([, values], n) => makeSvg('path', {
                d: path(values), fill: 'none',
                stroke: KIND_COLORS[n % KIND_COLORS.length], 'stroke-width': 1,
              })),
              makeSvg('path', { d: path(profile.total), fill: 'none',
                                stroke: 'var(--ink)', 'stroke-width': 1.6 }),
              mark(triplet.log_ratio, 'var(--accent)'),
              triplet.second && mark(triplet.second[0], 'var(--bad)', '4 3'),
              triplet.true_log_ratio !== undefined &&
                  mark(triplet.true_log_ratio, 'var(--truth)', '2 2')),
      makeSvg('text', { x: (edge.left + width - edge.right) / 2,
                        y: height - 4, 'text-anchor': 'middle' }, 'ratio'),
      makeSvg('text', { x: 4, y: 12, 'dominant-baseline': 'middle' },
              'log10 NFA'));
}
