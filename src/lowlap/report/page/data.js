// The data of the page, decoded. Views, pairs and triplets are told by their
// place in these lists.

function decode(base64, Type) {
  const text = atob(base64 || '');
  const bytes = new Uint8Array(text.length);
  for (let n = 0; n < text.length; ++n) bytes[n] = text.charCodeAt(n);
  return new Type(bytes.buffer);
}

const NO_LANDMARK = 0xFFFFFFFF;

// Positions are shares of width and height, 0 to 65535.
function decodeFeatures(features) {
  return {
    points: decode(features && features.points, Uint16Array),
    landmarks: decode(features && features.landmarks, Uint32Array),
    segments: decode(features && features.segments, Uint16Array),
    lines: decode(features && features.lines, Uint32Array),
  };
}

function decodeStructure(structure) {
  return {
    positions: decode(structure.positions, Float32Array),
    before: structure.before && decode(structure.before, Float32Array),
    numViews: decode(structure.num_views, Uint8Array),
  };
}

function decodeProfile(profile) {
  const values = base64 => Array.from(decode(base64, Float32Array));
  return profile && {
    logRatios: values(profile.log_ratios),
    total: values(profile.total),
    kinds: (profile.kinds || []).map(([name, list]) => [name, values(list)]),
  };
}

function decodePage(raw) {
  const page = { ...raw };
  page.views = raw.views.map((view, index) => ({
    ...view,
    index,
    features: decodeFeatures(view.features),
    detected: view.detected && {
      ...view.detected, ...decodeFeatures(view.detected),
    },
    pairs: [],
    triplets: [],
    warnings: [],
  }));
  page.points = decodeStructure(raw.points);
  page.lines = decodeStructure(raw.lines);
  page.coplanarPairs = decode(raw.coplanar_pairs, Uint32Array);
  page.pairs = raw.pairs.map((pair, index) => ({
    ...pair,
    index,
    points: decode(pair.points, Uint32Array),
    lines: decode(pair.lines, Uint32Array),
  }));
  page.triplets = raw.triplets.map((triplet, index) => ({ ...triplet, index }));
  for (const pair of page.pairs) {
    for (const view of pair.views) page.views[view].pairs.push(pair);
  }
  for (const triplet of page.triplets) {
    for (const view of triplet.views) page.views[view].triplets.push(triplet);
  }
  for (const warning of page.warnings) {
    for (const view of warning.views) {
      page.views[view].warnings.push(warning.text);
    }
  }
  page.hasBefore = page.views.some(view => view.camera_before);
  page.hasTruth = page.views.some(view => view.camera_true);
  return page;
}

const page = decodePage(
    JSON.parse(document.getElementById('data').textContent));

// The least of each path, from its end, that no other view has: without the
// extension or with it, with more and more folders.
function shortestNames(names) {
  const shortest = names.map(() => undefined);
  const depth = Math.max(0, ...names.map(name => name.split('/').length));
  for (let kept = 1; kept <= depth; ++kept) {
    const ends = names.map(name => name.split('/').slice(-kept).join('/'));
    const stems = ends.map(end => end.replace(/\.[^./]*$/, ''));
    for (const parts of [stems, ends]) {
      const count = new Map();
      for (const part of parts) count.set(part, (count.get(part) || 0) + 1);
      parts.forEach((part, n) => {
        if (count.get(part) === 1) shortest[n] = shortest[n] || part;
      });
    }
  }
  return names.map((name, n) => shortest[n] || name);
}

const shortNames = shortestNames(page.views.map(view => view.name));
const shortName = view => shortNames[view];

function pairOf(a, b) {
  return page.views[a].pairs.find(
      pair => pair.views.includes(a) && pair.views.includes(b));
}

const isMeaningful = triplet => triplet.verdict === 'meaningful';
