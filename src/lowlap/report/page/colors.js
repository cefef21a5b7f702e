// Evidence as colour: from little (red) over some (amber) to much (blue-green).

const RAMP = [[190, 58, 45], [226, 158, 57], [120, 175, 110], [25, 125, 135],
              [28, 72, 140]];

// Digits of evidence, -log10 NFA, on a scale that is finest where it is weak.
function evidenceShare(log10Nfa) {
  const digits = Math.max(0, -log10Nfa);
  return Math.min(1, Math.log10(1 + digits) / 4);
}

function rampColor(share) {
  const at = Math.max(0, Math.min(1, share)) * (RAMP.length - 1);
  const n = Math.min(RAMP.length - 2, Math.floor(at));
  const channels = RAMP[n].map(
      (from, c) => Math.round(from + (at - n) * (RAMP[n + 1][c] - from)));
  return `rgb(${channels.join(',')})`;
}

// Grey where it is not known, as in scenes of other programs.
function evidenceColor(log10Nfa) {
  if (!log10Nfa) return 'rgb(135,147,160)';
  return rampColor(evidenceShare(log10Nfa));
}

function evidenceLegend(label) {
  const stops = RAMP.map((_, n) => rampColor(n / (RAMP.length - 1)));
  return make('div', { class: 'legend' }, `${label}: 0`,
              make('i', { style: `background: linear-gradient(90deg, ${stops})` }),
              '10,000 digits');
}

// Distinct for neighbouring indices: the hue turns by the golden ratio.
function distinctColor(index) {
  return `hsl(${Math.round(index * 222.49) % 360} 75% 48%)`;
}
