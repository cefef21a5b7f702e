// Elements and texts.

function fill(element, attributes, children) {
  for (const [name, value] of Object.entries(attributes || {})) {
    if (name.startsWith('on')) {
      element.addEventListener(name.slice(2), value);
    } else if (value !== undefined && value !== false) {
      element.setAttribute(name, value === true ? '' : value);
    }
  }
  element.append(...children.flat(2).filter(child => child || child === 0));
  return element;
}

function make(tag, attributes, ...children) {
  return fill(document.createElement(tag), attributes, children);
}

function makeSvg(tag, attributes, ...children) {
  return fill(document.createElementNS('http://www.w3.org/2000/svg', tag),
              attributes, children);
}

// A button that is on or off, of state[topic][name].
function makeToggle(topic, name, label, color) {
  const button = make('button', {
    class: 'toggle', id: `${topic}-${name}`,
    style: color && `--swatch: var(--${color})`,
    onclick: () => toggle(topic, name),
  }, label);
  const show = () => button.setAttribute('aria-pressed', state[topic][name]);
  listen(topic, show);
  show();
  return button;
}

function number(value, digits = 3) {
  if (value === undefined || value === null || !isFinite(value)) return '–';
  return Number(value.toPrecision(digits)).toString();
}

const fixed = (value, digits) =>
    value === undefined ? '–' : value.toFixed(digits);

function facts(rows) {
  return make('table', { class: 'facts' },
              rows.filter(row => row).map(([name, value]) => make(
                  'tr', {}, make('td', { class: 'soft' }, name),
                  make('td', {}, String(value)))));
}

// A canvas as sharp as the screen, with a context in CSS pixels.
function sharpContext(canvas, width, height) {
  const ratio = window.devicePixelRatio || 1;
  canvas.width = Math.round(width * ratio);
  canvas.height = Math.round(height * ratio);
  const context = canvas.getContext('2d');
  context.scale(ratio, ratio);
  return context;
}

function cssColor(name) {
  return getComputedStyle(document.documentElement)
      .getPropertyValue(`--${name}`).trim();
}
