// The photographs on the left.

function badgeOf(view) {
  if (!view.camera) return make('span', { class: 'badge bad' }, 'not placed');
  if (view.warnings.length > 0) {
    return make('span', { class: 'badge' }, 'doubtful');
  }
  const error = view.position_error;
  return make('span', { class: 'soft' },
              error === undefined ? '' : number(error, 2));
}

function makeThumbnail(view) {
  const choose = () => select('view', view.index);
  return make(
      'li', {
        class: 'thumbnail', tabindex: 0, 'data-view': view.index,
        title: view.name, onclick: choose,
        onkeydown: event => event.key === 'Enter' && choose(),
      },
      make('canvas'),
      make('div', { class: 'caption' }, make('span', {}, shortName(view.index)),
           badgeOf(view)));
}

function startViewList() {
  const items = page.views.map(makeThumbnail);
  const list = make('ol', {}, items);
  const kinds = make(
      'div', { class: 'toolbar' },
      makeToggle('overlay', 'points', 'points', 'point'),
      makeToggle('overlay', 'segments', 'segments', 'line'));
  const sets = make(
      'div', { class: 'toolbar' }, makeToggle('overlay', 'model', 'in model'),
      makeToggle('overlay', 'matched', 'matched', 'line'),
      page.views.some(view => view.detected) &&
          makeToggle('overlay', 'detected', 'detected', 'faint'));
  document.getElementById('views').append(kinds, sets, list);

  // Those that can be seen are drawn, and drawn anew once the overlay changed.
  const visible = new Set();
  const draw = item => drawPhotograph(item.querySelector('canvas'),
                                      Number(item.dataset.view), 1.5);
  const observer = new IntersectionObserver(entries => {
    for (const { target, isIntersecting } of entries) {
      if (!isIntersecting) {
        visible.delete(target);
      } else if (!visible.has(target)) {
        visible.add(target);
        draw(target);
      }
    }
  }, { root: list, rootMargin: '200px' });
  for (const item of items) {
    const canvas = item.querySelector('canvas');
    canvas.style.aspectRatio = 1 / aspectOf(Number(item.dataset.view));
    observer.observe(item);
  }
  listen('overlay', () => visible.forEach(draw));
  listen('selected', () => {
    const views = selectedViews();
    for (const item of items) {
      item.classList.toggle('selected',
                            views.includes(Number(item.dataset.view)));
    }
    if (views.length > 0) items[views[0]].scrollIntoView({ block: 'nearest' });
  });
}
