// ---- Wanted values of several figures by several numbers within limits: the code of `elastocheck
// solve-for` (reports/live/wishes.hpp), from the numbers as they are now.
import {$, make, pageUnit, shown, signed, written} from './base.js';
import {Run, keyOf} from './run.js';
import {begin, keepPreview, numberOf, put, settle, state, stationOf} from './state.js';
import {solvers} from './solver.js';
import {changed, resting, solveInto} from './solve.js';
import {effectsOn} from './effects.js';
import {fromPage, rowsOf} from './numbers.js';
import {quoted} from './files.js';
import {draw} from './app.js';

const wishEntry = (value, label, more = {}) => make('input', {
  type: 'text',
  inputmode: 'decimal',
  size: 8,
  value,
  'aria-label': label,
  autocomplete: 'off',
  ...more
});
const removableRow = row => {
  const button = make('button', {type: 'button', 'aria-label': 'remove'}, '×');
  button.onclick = () => { row.remove(); wishLine(); };
  row.append(button);
  return row;
};
const figuresToWant = () => state.info.channels.filter(
    c => c.kind === 'motion' || c.kind === 'characteristic' ||
        (c.kind === 'element' && c.unit === 'N'));
export const addWant = (name, branchName, a, value = '') => {
  const unit = state.now.branch(branchName)?.unit ?? '';
  const figure = make(
      'select', {'aria-label': 'wanted figure'},
      ...figuresToWant().map(
          c => make(
              'option', {value: c.name, selected: c.name === name}, `${c.name} [${c.unit}]`)));
  const branch = make(
      'select', {'aria-label': 'on branch'},
      ...state.info.branches.map(
          b => make(
              'option', {value: b.name, selected: b.name === branchName},
              `${b.name} [${b.unit}]`)));
  const row = make(
      'div', {class: 'want'}, figure, ' on ', branch, ' at ',
      wishEntry(String(a), `parameter of the branch [${unit}]`), ' = ',
      wishEntry(value, 'wanted value'));
  $('wants').append(removableRow(row));
  wishLine();
};
// Unit of a number on the page.
const unitOf = path => state.numbers.has(path) ? pageUnit(state.numbers.get(path).unit)[0] : '';
const rangeOf = path => {
  const [unit, factor] = pageUnit(state.numbers.get(path).unit), value = numberOf(path) * factor;
  const half = unit === 'mm' && Math.abs(value) > 1e-9 || path.startsWith('points.') ?
      20 :
      .5 * Math.abs(value) || 1;
  return [value - half, value + half].map(written);
};
export const addVaried = (path = '') => {
  const known = state.numbers.has(path), [low, high] = known ? rangeOf(path) : ['', ''];
  const name = make('input', {
    type: 'text',
    list: 'paths',
    value: path,
    size: 26,
    'aria-label': 'number that may change',
    autocomplete: 'off'
  });
  const [from, to] = [wishEntry(low, 'lower limit'), wishEntry(high, 'upper limit')];
  const row = make(
      'div', {class: 'vary'}, name, ' from ', from, ' to ', to,
      make('span', {class: 'unit'}, unitOf(path)));
  name.onchange = () => {
    const known = state.numbers.has(name.value.trim());
    name.setAttribute('aria-invalid', String(!known));
    if (!known) return;
    [from.value, to.value] = rangeOf(name.value.trim());
    row.querySelector('.unit').textContent = unitOf(name.value.trim());
  };
  $('varies').append(removableRow(row));
  wishLine();
};
// The wishes as entered, or null where an entry is not a number.
const wishes = () => {
  let sound = true;
  const number = input => {
    const text = input.value.trim(), met = text !== '' && Number.isFinite(+text);
    input.setAttribute('aria-invalid', String(!met));
    sound &&= met;
    return +text;
  };
  const want = [...$('wants').children].map(row => {
    const [figure, branch] = row.querySelectorAll('select'),
                   [a, value] = row.querySelectorAll('input');
    return [figure.value, branch.value, number(a), number(value)];
  });
  const vary = [...$('varies').children].map(row => {
    const [name, low, high] = row.querySelectorAll('input'), path = name.value.trim(),
                      known = state.numbers.has(path);
    name.setAttribute('aria-invalid', String(!known));
    sound &&= known;
    const ends = [number(low), number(high)];
    return [path, ...known ? ends.map(v => +fromPage(path, String(v))) : ends];
  });
  return sound && want.length && vary.length ? {want, vary} : null;
};
// The same as a command line.
export const wishLine = () => {
  const {want, vary} = wishes() ?? {};
  for (const input of $('wishes').querySelectorAll('input'))
    if (input.value.trim() === '') input.setAttribute('aria-invalid', 'false');
  $('wish-line').textContent = !want ? '' : [
    'elastocheck', 'solve-for', quoted(state.file),
    ...[...state.settings].flatMap(([p, v]) => ['--set', quoted(`${p}=${v}`)]),
    ...vary.flatMap(([p, low, high]) => ['--vary', quoted(`${p}=${low}:${high}`)]),
    ...want.flatMap(([c, b, a, v]) => ['--want', quoted(`${c}@${b}:${a}=${v}`)])
  ].join(' ');
};
const changeOf = ({path, from, to}) => {
  const [unit, factor] = pageUnit(state.numbers.get(path).unit);
  return `${path} ${signed((to - from) * factor)} ${unit}`.trim();
};
// Shows the found numbers in the charts as a preview, which a click takes over.
const previewWish = async numbers => {
  const settings = new Map(state.settings);
  for (const {path, to} of numbers) settings.set(path, written(to));
  const run = new Run([...settings], state.published), from = keyOf(state.settings);
  await solveInto(run, solvers.back, state.branch);
  if (from !== keyOf(state.settings)) return;
  keepPreview({name: 'preview', run, numbers, from});
  draw();
};
// Drops the preview if the numbers have changed since it was found.
export const drawPreview = () => {
  if (state.preview && state.preview.from !== keyOf(state.settings)) keepPreview(null);
  $('wish-take').hidden = $('wish-drop').hidden = $('preview-name').hidden = !state.preview;
};
const takeWish = () => {
  const {numbers} = state.preview;
  begin();
  for (const n of numbers) put(n.path, written(n.to));
  settle();
  changed();
};
const grantWishes = async () => {
  const given = wishes(), said = $('wish-answer');
  if (!given) {
    said.textContent =
        'Each wish needs a figure, a position and a value, and a number with its limits.';
    return;
  }
  said.textContent = 'Solving…';
  $('wish-go').disabled = true;
  const settings = [...state.settings], info = state.info;
  try {
    const {found} = await solvers.back.ask('wish', {request: {settings, ...given}});
    if (info !== state.info || JSON.stringify(settings) !== JSON.stringify([...state.settings])) {
      said.textContent = 'Numbers were changed meanwhile: nothing is taken over.';
      return;
    }
    const dead = found.figures.find(f => f.still);
    if (found.why_not || dead) {
      said.textContent =
          found.why_not ?? `${dead.name} on ${dead.branch}: none of these numbers moves it.`;
      return;
    }
    await previewWish(found.numbers);
    const limits = found.numbers.filter(n => n.at_limit)
                       .map(n => `${n.path} at its ${n.at_limit < 0 ? 'lower' : 'upper'} limit`);
    const conflicts =
        found.figures.filter(f => f.conflict > .1).map(f => `${f.name} on ${f.branch}`);
    said.textContent = (found.met ? 'Met, with the smallest change: ' :
                                    `Not met${
                                        found.converged ? ', this is nearest' :
                                                          ', stopped without convergence'}: `) +
        found.figures.map(f => `${f.name} ${shown(f.before)} → ${shown(f.after ?? NaN)} ${f.unit}`)
            .join(', ') +
        ' by ' + found.numbers.map(changeOf).join(', ') +
        (limits.length ? `; ${limits.join(', ')}` : '') +
        (!found.met && conflicts.length > 1 ? `; in conflict: ${conflicts.join(', ')}` : '') + '.';
  } catch (error) { said.textContent = error.message; } finally { $('wish-go').disabled = false; }
};
export const resetWishes = () => {
  $('wants').replaceChildren();
  $('varies').replaceChildren();
  $('wish-answer').textContent = $('wish-line').textContent = '';
  $('paths').replaceChildren(...state.info.numbers.map(n => make('option', {value: n.path})));
  $('wishes').open = false;
  drawPreview();
};
// The first figure, with its value as it is, to be changed: at the shown position, or at the end
// of the branch, since a trim may hold the start.
const wantedStation = () => {
  const [branch, k] = stationOf(state.now);
  return [branch, branch?.points && k === branch.start ? branch.points - 1 : k];
};
const addShownWant = () => {
  const [branch, k] = wantedStation(), first = document.querySelector('#charts .chart');
  const name = $('effect').value || state.figures.get(first?.dataset.channel)?.[0].name ||
      figuresToWant()[0]?.name;
  if (!branch?.points || !name) return;
  const value = state.now.valueAt(branch, name, k);
  addWant(name, branch.name, +state.now.a(branch, k).toPrecision(6),
    Number.isFinite(value) ? String(+value.toPrecision(4)) : '');
};
// The coordinates that move the first figure most, measured where they are not known.
const addMostEffect = async () => {
  const figure = $('wants').querySelector('select')?.value, rows = $('varies').children.length;
  const same = () =>
    resting() && $('varies').children.length === rows && !$('wish-go').disabled;
  let effects = stationOf(state.now)[1] === wantedStation()[1] ? state.effects : null;
  if (!effects && figure && same()) {
    $('wish-answer').textContent = 'Looking for the coordinates that move it most…';
    effects = await effectsOn(figure, ...wantedStation(), same);
    if (!same()) return;
    $('wish-answer').textContent = '';
  }
  const used = new Set([...$('varies').querySelectorAll('input[list]')].map(i => i.value));
  const best = [...effects ?? []]
                   .filter(e => e.by !== 0)
                   .sort((a, b) => Math.abs(b.by) - Math.abs(a.by))
                   .map(e => e.path)
                   .filter(p => !used.has(p))
                   .slice(0, 3);
  if (best.length) for (const path of best) addVaried(path);
  else addVaried([...rowsOf.keys()].find(p => p.startsWith('points.') && !used.has(p)) ?? '');
};
$('wishes').addEventListener('toggle', () => {
  if (!$('wishes').open || !state.now || $('wants').children.length) return;
  addShownWant();
  addMostEffect();
});
$('want-more').onclick = () => state.now && addShownWant();
$('vary-more').onclick = () => state.now && addMostEffect();
$('wish-go').onclick = () => state.now && grantWishes();
$('wish-take').onclick = takeWish;
$('wish-drop').onclick = () => { keepPreview(null); draw(); };
$('wishes').addEventListener('input', wishLine);
