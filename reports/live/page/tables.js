// ---- Tables: what the trim adjusts, static values, characteristics by what acts, forces,
// compliance matrices; each as opened, now, and the change
import {$, show, shown, signed, sketch, write} from './base.js';
import {
  isSolved, reference, referenceName, stationInReference,
  stationOf, state
} from './state.js';
import {solvers} from './solver.js';
import {resting} from './solve.js';
import {words} from './charts.js';
import {isLeftOut} from './app.js';

const tableHead = (...columns) =>
    sketch('thead', {}, sketch('tr', {}, ...columns.map(t => sketch('th', {scope: 'col'}, t))));
const differs = (was, value) =>
    Number.isFinite(value - was) && Math.abs(value - was) > 1e-9 * Math.max(1, Math.abs(was));
const tableRow = (name, unit, was, value, more = {}, ...cells) => sketch(
    'tr', more, sketch('td', {title: more.title ?? '', 'data-unit': unit}, name),
    sketch('td', {}, unit), sketch('td', {}, shown(was)), sketch('td', {}, shown(value)),
    sketch(
        'td', {class: differs(was, value) ? 'changed' : ''},
        differs(was, value) ? signed(value - was) : ''),
    ...cells);
const channelRow = (channel, was, value, ...cells) => tableRow(
    words(channel.name), channel.unit, was, value,
    {'data-channel': channel.name, title: channel.definition}, ...cells);
const group = (title, rows) => rows.length ?
    [
      sketch('tr', {class: 'group'}, sketch('th', {colspan: 5, scope: 'rowgroup'}, title)), ...rows
    ] :
    [];
// The value that the trim arrives at, and by how much it is changed for that.
const trimRow = t => {
  const was = (reference().trim ?? []).find(b => b.name === t.name)?.by ?? NaN;
  const name =
      sketch('span', {}, `${t.name}, changed by`, sketch('small', {}, `makes ${t.makes}`));
  return tableRow(name, t.unit, was, t.by, {title: t.makes, 'data-trim': t.name});
};
// Where the static values are read: the shown position, or the start of the first branch.
const placeOfTable = () => {
  const {now, info} = state, base = reference();
  if ($('table-at').value === 'shown') return [...stationOf(now), ...stationInReference(), ''];
  const is = now.branch(info.branches[0]?.name), old = base.branch(is?.name);
  return [is, is?.start, old, old?.start, 'start of the first branch, '];
};
export const drawTables = () => {
  const {now, info} = state, base = reference(),
              [is, k, old, j, where] = now ? placeOfTable() : [];
  if (isLeftOut($('tables'))) return;
  // A drag solves the shown branch alone, which may be another one.
  $('tables').classList.toggle('stale', now !== null && !is);
  if (!is) return;
  const rowOf = c => channelRow(c, base.valueAt(old, c.name, j), now.valueAt(is, c.name, k));
  const rates = info.channels.filter(c => c.kind === 'characteristic');
  const angles = info.channels.filter(c => c.kind === 'motion' && c.at_rest);
  const plain = rates.length + angles.length ?
      angles :
      info.channels.filter(c => c.kind === 'motion' && c.main);
  $('static').dataset.solve = now.id;
  show(
      $('static'), tableHead('', 'unit', referenceName(), 'now', 'change'),
      sketch(
          'tbody', {}, ...group('adjusted by the trim', (now.trim ?? []).map(trimRow)),
          ...group(now.trim ? 'static values after the trim' : 'static values', plain.map(rowOf)),
          ...[...new Set(rates.map(c => c.cause))].flatMap(
              cause => group(cause, rates.filter(c => c.cause === cause).map(rowOf)))));
  write($('table-place'), `${where}${is.name} ${shown(now.a(is, k) ?? NaN)} ${is.unit}`);
  drawForces();
  drawMatrix();
};
// Forces at the shown position, or the largest of all branches.
const forceChannels = () =>
    state.info.channels.filter(c => c.kind === 'element' && ['N', 'N·m'].includes(c.unit));
const largest = (run, name) => {
  let most = [0, ''];
  for (const branch of run.branches)
    for (const [, v] of run.curve(branch, name))
      if (Math.abs(v) > Math.abs(most[0])) most = [v, branch.name];
  return most;
};
const drawForces = () => {
  if (!$('forces').open) return;
  const {now} = state, base = reference(), all = $('forces-at').value === 'largest';
  const [b, k] = stationOf(now), [o, j] = stationInReference();
  const whole = all && now.branches.length < state.info.branches.length;
  $('forces').classList.toggle('stale', whole);
  if (whole) return;
  show(
      $('forces').querySelector('table'),
      tableHead('', 'unit', referenceName(), 'now', 'change', ...all ? ['on branch'] : []),
      sketch('tbody', {}, ...forceChannels().map(c => {
        if (!all) return channelRow(c, base.valueAt(o, c.name, j), now.valueAt(b, c.name, k));
        const [was] = largest(base, c.name), [value, where] = largest(now, c.name);
        return channelRow(c, was, value, sketch('td', {class: 'word'}, where));
      })));
};
// The compliance matrices at the start of the first branch, computed only while they are shown.
const matrices = {run: null, now: null, base: null};
const drawMatrix = async () => {
  const {now} = state, base = reference();
  if (!$('matrix').open || !now || !base) return;
  if (matrices.run !== now) {
    if (!resting() || !isSolved()) return;
    matrices.run = now;
    try {
      const found = await solvers.back.ask('compliance', {request: {settings: now.settings}});
      const before = now.key === base.key ?
          found :
          matrices.base?.of === base ?
          matrices.base.found :
          await solvers.back.ask('compliance', {request: {settings: base.settings}});
      if (state.now !== now) return;
      matrices.base = {of: base, found: before};
      matrices.now = found;
    } catch (error) {
      if (error.kind === 'stopped') matrices.run = null;
      matrices.now = {why_not: error.message};
    }
  }
  const {now: found, base: before} = matrices, point = $('matrix-at').value,
                           table = $('matrix').querySelector('table');
  if (!found) return;
  if (found.why_not !== undefined) {
    show(table, sketch('tbody', {}, sketch('tr', {}, sketch('td', {}, found.why_not))));
    return;
  }
  show(
      table, tableHead('', ...found.causes),
      sketch(
          'tbody', {},
          ...found[point].map(
              (row, r) => sketch(
                  'tr', {}, sketch('td', {}, row.name.replace(/^[^,]*, /, '')),
                  ...row.values.map((v, c) => {
                    const was = before.found?.[point]?.[r]?.values[c] ?? NaN,
                          other = Math.abs(v - was) > 1e-6;
                    return sketch(
                        'td', {class: other ? 'changed' : ''}, shown(Math.abs(v) < 1e-9 ? 0 : v),
                        other ? sketch('small', {}, shown(was)) : null);
                  })))));
};
for (const id of ['forces', 'matrix'])
  $(id).addEventListener('toggle', () => state.now && drawTables());
for (const id of ['table-at', 'forces-at', 'matrix-at'])
  $(id).onchange = () => state.now && drawTables();
