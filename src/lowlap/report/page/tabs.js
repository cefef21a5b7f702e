// The tabs below the space; only the open one is drawn.

const TABS = {
  graph: ['View graph', drawGraph],
  matches: ['Matches', drawMatchesTab],
  residuals: ['Residuals', drawResiduals],
  cameras: ['Cameras', drawCameras],
  pairs: ['Pairs', drawPairs],
  ratios: ['Scale ratios', drawRatios],
};

let openedTab = 'graph';

function redrawTab() {
  const tab = document.getElementById('tab');
  const scrolled = tab.scrollTop;
  TABS[openedTab][1](tab);
  tab.scrollTop = scrolled;
}

function openTab(name) {
  openedTab = name;
  for (const button of document.querySelectorAll('#tabs [role=tab]')) {
    button.setAttribute('aria-selected', button.id === `tab-${name}`);
  }
  document.getElementById('tab').scrollTop = 0;
  redrawTab();
}

function startTabs() {
  const tab = make('div', { class: 'tab', id: 'tab' });
  document.getElementById('tabs').append(
      make('div', { class: 'toolbar', role: 'tablist' },
           Object.entries(TABS).map(([name, [title]]) => make('button', {
             role: 'tab', id: `tab-${name}`, onclick: () => openTab(name),
           }, title))),
      tab);
  listen('selected', redrawTab);
  new ResizeObserver(redrawTab).observe(tab);
  openTab('graph');
}
