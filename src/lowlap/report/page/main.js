// The head of the page, and the start of all its parts.

// Folded away, with their number: `what` is their name.
function remarks(id, what, texts) {
  return texts.length > 0 && make(
      'details', { id, class: 'remarks' },
      make('summary', {}, `${texts.length} ${what}${texts.length > 1 ? 's' : ''}`),
      make('ul', {}, texts.map(text => make('li', {}, text))));
}

function startHeader() {
  fill(document.getElementById('header'), {}, [
    make('h1', {}, page.title),
    make('dl', {}, page.figures.map(([name, value]) => make(
        'div', {}, make('dt', {}, name), make('dd', {}, value)))),
    remarks('warnings', 'warning', page.warnings.map(({ text }) => text)),
    remarks('notes', 'note', page.notes),
  ]);
}

startHeader();
startSpace();
startViewList();
startTabs();
startInspector();
selectFromAddress();
window.addEventListener('hashchange', selectFromAddress);
