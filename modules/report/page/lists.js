// The lists beside the map and the tables below it.

function jumpItem(at, name, text, onclick) {
  const children = [
    element('span', {class: 'at'}, at), element('span', {class: 'name'}, name),
    element('span', {class: 'text'}, text)];
  return element('li', {}, onclick ? element('button', {type: 'button', onclick}, ...children)
                                   : element('div', {}, ...children));
}

function fillList(id, items, none) {
  const list = document.querySelector(`#${id} ol`);
  if (items.length === 0) items = [element('li', {class: 'none'}, none)];
  list.append(...items);
}

/** "(showing 10 of 20)" where a list was cut. */
function noteCut(id, shown, all) {
  if (shown < all) document.querySelector(`#${id} h2`).append(` (${shown} of ${all})`);
}

/** `go(t, place)`: shows a time, and a place of the scene if it is given. */
function fillLists(data, go) {
  const stretches = data.stretches;
  fillList('stretches', stretches.list.map(s => jumpItem(
    clock(s.from), s.cause,
    `${short(s.to - s.from, 3)} s, ${s.recovered ? 'then recovered' : 'not recovered'}`,
    () => go(s.from))), 'None: the pose was never in doubt.');
  noteCut('stretches', stretches.list.length, stretches.of);

  const warnings = data.warnings.flatMap(kind => kind.first.map((w, i) => jumpItem(
    w.t === null ? 'run' : clock(w.t),
    kind.kind + (i === 0 && kind.count > kind.first.length ? ` (${kind.count} times)` : ''),
    w.text, w.t === null ? null : () => go(w.t))));
  fillList('warnings', warnings, 'None.');

  fillList('loops', data.loops.list.map(loop => jumpItem(
    clock(loop.t_to), `${loop.name}: ${loop.verdict}`,
    (loop.reason ? loop.reason + '. ' : '') + `Seen first at ${clock(loop.t_from)}` +
      (loop.gap === null ? '' : `; gap ${short(loop.gap, 3)} m`),
    () => go(loop.t_to, loop.to))), 'No two places were compared.');
  noteCut('loops', data.loops.list.length, data.loops.of);
}

function tableCard({title, note, header, rows}) {
  const table = element('table', header.length > 0 ? {class: 'figures'} : {});
  if (header.length > 0) table.append(element('tr', {}, ...header.map(h => element('th', {scope: 'col'}, h))));
  for (const row of rows)
    table.append(element('tr', {}, ...row.map(
      (cell, i) => i === 0 ? element('th', {scope: 'row'}, cell) : element('td', {}, cell))));
  const card = element('div', {class: 'table'}, element('h3', {}, title));
  if (note) card.append(element('p', {class: 'hint'}, note));
  card.append(table);
  return card;
}

function fillTexts(data) {
  document.getElementById('title').textContent = data.title;
  document.getElementById('subtitle').textContent = data.subtitle;
  document.getElementById('headlines').append(...data.headlines.map(
    ([name, value]) => element('div', {}, element('dt', {}, name), element('dd', {}, value))));
  document.querySelector('#facts .tables').append(...data.facts.map(tableCard));
  document.getElementById('facts').hidden = data.facts.length === 0;
  const texts = document.getElementById('texts');
  texts.append(...data.texts.map(([name, text]) => element('details', {class: 'file'},
    element('summary', {}, name), element('pre', {}, text))));
  texts.hidden = data.texts.length === 0;
  if (!data.accuracy) return;
  document.getElementById('accuracy').hidden = false;
  document.getElementById('accuracy-headline').textContent = data.accuracy.headline;
  document.querySelector('#accuracy .tables').append(...data.accuracy.tables.map(tableCard));
  const summary = document.getElementById('accuracy-summary');
  summary.hidden = false;
  summary.querySelector('p').textContent = data.accuracy.headline;
}
