// ---- Tables: what the trim adjusts, static values, characteristics by what acts, forces, compliance matrices; each as
// opened, now, and the change
const tableHead = (...columns) => sketch('thead', {}, sketch('tr', {}, ...columns.map(t => sketch('th', {scope: 'col'}, t))));
const differs = (was, value) => Number.isFinite(value - was) && Math.abs(value - was) > 1e-9 * Math.max(1, Math.abs(was));
const tableRow = (name, unit, was, value, more = {}, ...cells) => sketch('tr', more, sketch('td', {title: more.title ?? '', 'data-unit': unit}, name), sketch('td', {}, unit),
  sketch('td', {}, shown(was)), sketch('td', {}, shown(value)), sketch('td', {class: differs(was, value) ? 'changed' : ''}, differs(was, value) ? signed(value - was) : ''), ...cells);
const channelRow = (channel, was, value, ...cells) => tableRow(words(channel.name), channel.unit, was, value, {'data-channel': channel.name, title: channel.definition}, ...cells);
const group = (title, rows) => rows.length ? [sketch('tr', {class: 'group'}, sketch('th', {colspan: 5, scope: 'rowgroup'}, title)), ...rows] : [];
const valueAt = (run, branch, name, k) => branch?.points && k >= 0 ? run.value(branch, k, run.place.get(name) ?? -1) : NaN;
const drawTables = () => {
  const {base, now, info} = state, first = info.branches[0]?.name;
  if (!base || !now) return;
  const here = $('table-at').value === 'shown', [is, k] = here ? stationOf(now) : [branchOf(now, first), branchOf(now, first)?.start];
  const [old, j] = here ? stationAsOpened() : [branchOf(base, first), branchOf(base, first)?.start];
  const rowOf = c => channelRow(c, valueAt(base, old, c.name, j), valueAt(now, is, c.name, k));
  const adjusted = (now.trim ?? []).map(t => tableRow(t.name, t.unit, (base.trim ?? []).find(b => b.name === t.name)?.by ?? NaN, t.by, {title: t.makes, 'data-trim': t.name}));
  const rates = info.channels.filter(c => c.kind === 'characteristic'), angles = info.channels.filter(c => c.kind === 'motion' && c.at_rest);
  const plain = rates.length + angles.length ? angles : info.channels.filter(c => c.kind === 'motion' && c.main);
  show($('static'), tableHead('', 'unit', 'as opened', 'now', 'change'), sketch('tbody', {}, ...group('adjusted by the trim', adjusted),
    ...group(now.trim ? 'static values after the trim' : 'static values', plain.map(rowOf)),
    ...[...new Set(rates.map(c => c.cause))].flatMap(cause => group(cause, rates.filter(c => c.cause === cause).map(rowOf)))));
  $('table-place').textContent = is ? `${here ? '' : 'start of the first branch, '}${is.name} ${shown(now.a(is, k) ?? NaN)} ${is.unit}` : '';
  drawForces();
  drawMatrix();
};
// Forces at the shown position, or the largest of all branches.
const forceChannels = () => state.info.channels.filter(c => c.kind === 'element' && ['N', 'N·m'].includes(c.unit));
const largest = (run, name) => {
  let most = [0, ''];
  for (const branch of run.branches)
    for (const [, v] of run.curve(branch, name)) if (Math.abs(v) > Math.abs(most[0])) most = [v, branch.name];
  return most;
};
const drawForces = () => {
  if (!$('forces').open) return;
  const {base, now} = state, all = $('forces-at').value === 'largest';
  const [b, k] = stationOf(now), [o, j] = stationAsOpened();
  show($('forces').querySelector('table'), tableHead('', 'unit', 'as opened', 'now', 'change', ...all ? ['on branch'] : []), sketch('tbody', {}, ...forceChannels().map(c => {
    if (!all) return channelRow(c, valueAt(base, o, c.name, j), valueAt(now, b, c.name, k));
    const [was] = largest(base, c.name), [value, where] = largest(now, c.name);
    return channelRow(c, was, value, sketch('td', {class: 'word'}, where));
  })));
};
// The compliance matrices at the start of the first branch, asked for while they are shown.
const matrices = {run: null, now: null, base: null};
const drawMatrix = async () => {
  const {now, base} = state;
  if (!$('matrix').open || !now || !base) return;
  if (matrices.run !== now) {
    if (!resting()) return;
    matrices.run = now;
    try {
      const found = await ask('compliance', {request: {settings: now.settings}});
      const before = base === now ? found : matrices.base?.of === base ? matrices.base.found : await ask('compliance', {request: {settings: []}});
      if (state.now !== now) return;
      matrices.base = {of: base, found: before};
      matrices.now = found;
    } catch (error) { matrices.now = {why_not: error.message}; }
  }
  const {now: found, base: before} = matrices, point = $('matrix-at').value, table = $('matrix').querySelector('table');
  if (!found) return;
  if (found.why_not !== undefined) { show(table, sketch('tbody', {}, sketch('tr', {}, sketch('td', {}, found.why_not)))); return; }
  show(table, tableHead('', ...found.causes), sketch('tbody', {}, ...found[point].map((row, r) => sketch('tr', {},
    sketch('td', {}, row.name.replace(/^[^,]*, /, '')), ...row.values.map((v, c) => {
      const was = before.found?.[point]?.[r]?.values[c] ?? NaN, other = Math.abs(v - was) > 1e-6;
      return sketch('td', {class: other ? 'changed' : ''}, shown(Math.abs(v) < 1e-9 ? 0 : v), other ? sketch('small', {}, shown(was)) : null);
    })))));
};
for (const id of ['forces', 'matrix']) $(id).addEventListener('toggle', () => state.now && drawTables());
for (const id of ['table-at', 'forces-at', 'matrix-at']) $(id).onchange = () => state.now && drawTables();

// ---- Curves chosen together
// By a force or moment in the plane of the road.
const isPushed = c => /force|torque/.test(c.cause);
const presets = {
  'usual curves': () => null,
  'steering and camber': c => c.unit.startsWith('deg') && (c.kind === 'motion' ? c.main || c.at_rest : c.kind === 'characteristic' && !isPushed(c)),
  'compliance': c => c.kind === 'characteristic' && isPushed(c),
  'forces of bushings': c => c.kind === 'element' && /\.elastic_force_[xyz]$/.test(c.name),
  'moments of bushings': c => c.kind === 'element' && /\.elastic_moment_[xyz]$/.test(c.name),
  'forces of springs, stops and links': c => c.kind === 'element' && c.unit === 'N' && !/elastic_force/.test(c.name),
};
$('preset').replaceChildren(...Object.keys(presets).map(name => make('option', {value: name}, name)));
$('preset').onchange = () => {
  const chosen = state.info?.channels.filter(presets[$('preset').value]) ?? [];
  state.curves = chosen.length ? chosen.map(c => c.name) : null;
  if (!chosen.length && $('preset').selectedIndex) $('preset').selectedIndex = 0;
  drawCharts();
  listEffects();
  proveSoon();
};
