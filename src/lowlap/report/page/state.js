// What is selected and what is shown; everything that draws listens.

const state = {
  selected: { kind: '', index: -1 },  // 'view', 'pair' or 'triplet'
  stage: 'after',                     // or 'before' the adjustment
  shown: {
    points: true, lines: true, planes: false, cameras: true, pictures: true,
    links: false, truth: false,
  },
  overlay: { model: true, matched: true, detected: false, points: true,
             segments: true },
};

const listeners = { selected: [], stage: [], shown: [], overlay: [] };

function listen(topic, callback) {
  listeners[topic].push(callback);
}

function announce(topic) {
  for (const callback of listeners[topic]) callback();
}

// The place in the address lets a selection be kept and sent. Selecting what
// is selected does nothing.
function select(kind, index) {
  const { selected } = state;
  if (selected.kind === kind && selected.index === index) return;
  state.selected = { kind, index };
  history.replaceState(null, '', kind ? `#${kind}=${index}` : '#');
  announce('selected');
}

function isSelected(kind, index) {
  return state.selected.kind === kind && state.selected.index === index;
}

function setStage(stage) {
  state.stage = stage;
  announce('stage');
}

function toggle(topic, name) {
  state[topic][name] = !state[topic][name];
  announce(topic);
}

// The views that the selection is about.
function selectedViews() {
  const { kind, index } = state.selected;
  if (kind === 'view') return [index];
  if (kind === 'pair') return page.pairs[index].views;
  if (kind === 'triplet') return page.triplets[index].views;
  return [];
}

function selectFromAddress() {
  const match = /^#(view|pair|triplet)=(\d+)$/.exec(location.hash);
  if (!match) return;
  const lists = { view: page.views, pair: page.pairs, triplet: page.triplets };
  const index = Number(match[2]);
  if (index < lists[match[1]].length) select(match[1], index);
}
