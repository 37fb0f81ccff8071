// ---- Arrows: by how much a figure, at the shown position of the shown branch, changes with each
// coordinate of a hardpoint. Central differences of 0.1 mm, solved while nothing else is to be
// done.
import {$, make, shown, signed, trouble, written} from './base.js';
import {Run} from './run.js';
import {begin, keepEffects, numberOf, put, settle, state, stationOf} from './state.js';
import {solvers} from './solver.js';
import {changed, requestOf, restSoon} from './solve.js';
import {images, mm, paths} from './points.js';
import {axesOf, drawHandles, handles} from './view.js';

const nudge = .1;  // [mm]
// A smaller change of a figure is rounding.
const least = value => 1e-7 * Math.max(1, Math.abs(value));

export const listEffects = () => {
  const select = $('effect'), old = select.value;
  const keys = new Set([...document.querySelectorAll('#charts .chart')].map(
    c => c.dataset.channel));
  const names = [...keys].flatMap(key => state.figures.get(key)?.map(c => c.name) ?? []);
  if ([...select.options].slice(1).map(o => o.value).join() === names.join()) return;
  select.replaceChildren(
      make('option', {value: ''}, 'none'), ...names.map(n => make('option', {value: n}, n)));
  select.value = names.includes(old) ? old : '';
};
// A figure at a parameter of a branch with other settings; NaN where it has none.
const valueWith = async (settings, branch, name, a) => {
  const run = new Run([...settings]);
  const more = {shown: {everywhere: [name], at: []}};
  run.take(await solvers.back.ask('solve', {request: requestOf(settings, branch, more)}));
  return run.valueAt(run.branches[0], name, run.exact(run.branches[0], a));
};
export const clearEffects = () => {
  if (state.effects === null && $('effects').hidden) return;
  keepEffects(null);
  $('effects').hidden = true;
  drawHandles(axesOf());
};
// Effects of every coordinate on a figure at a station of a branch: {point, path, axis, by: per
// mm}; null as soon as `more()` is false, because something else is to be done.
export const effectsOn = async (name, branch, k, more) => {
  const all = [], a = state.now.a(branch, k), value = state.now.valueAt(branch, name, k);
  for (const point of [...handles.keys()].filter(key => !images.has(key)))
    for (const p of paths(point)) {
      const values = [];
      for (const sign of [1, -1]) {
        const settings =
            new Map(state.settings).set(p, written(numberOf(p) + sign * nudge / mm(p)));
        try {
          values.push(await valueWith(settings, branch.name, name, a));
        } catch {
          values.push(NaN);
        }
        if (!more()) return null;
      }
      const by = Math.abs(values[0] - values[1]) < least(value) ?
          0 :
          (values[0] - values[1]) / (2 * nudge);
      all.push({point, path: p, axis: 'xyz'.indexOf(p.at(-1)), by});
    }
  return all.filter(e => Number.isFinite(e.by));
};
export const measureEffects = async more => {
  const name = $('effect').value;
  clearEffects();
  if (!name || !state.now) return;
  const [branch, k] = stationOf(state.now), effects = await effectsOn(name, branch, k, more);
  if (!effects) return;
  keepEffects(effects);
  showEffects(name, branch, state.now.a(branch, k), state.now.valueAt(branch, name, k));
  drawHandles(axesOf());
};
const showEffects = (name, branch, a, value) => {
  const {unit} = state.channel.get(name), place = `${shown(a)} ${branch.unit} of ${branch.name}`;
  const most = state.effects.filter(e => e.by !== 0)
                   .sort((x, y) => Math.abs(y.by) - Math.abs(x.by))
                   .slice(0, 5);
  const held = (state.now.trim ?? []).length ? ', or the trim holds it' : '';
  $('effects').hidden = false;
  $('effects').querySelector('h3').textContent = most.length ?
      `Most effect on ${name} at ${place}, per mm` :
      `No hardpoint moves ${name} at ${place}${held}`;
  $('effects').querySelector('ol').replaceChildren(...most.map(e => {
    const button =
        make('button', {type: 'button', 'aria-label': `change ${e.path} for it`}, 'solve');
    button.onclick = () => solveFor(e.path, e.by * mm(e.path), name, branch.name, a);
    return make('li', {}, `${e.path.slice(7)} ${signed(e.by)} ${unit}`, button);
  }));
  $('effects').querySelector('label').hidden = !most.length;
  $('effects').querySelector('label span').textContent = unit;
  if (document.activeElement !== $('wish')) $('wish').value = shown(value).replaceAll('−', '-');
};
// Sets one number such that a figure at a station has the wished value: secant method, from the
// known slope.
let solvingFor = 0;
const solveFor = async (path, firstSlope, name, branchName, a) => {
  const wish = $('wish').value.trim(), want = Number(wish), mine = ++solvingFor,
        wrong = wish === '' || !Number.isFinite(want);
  $('wish').setAttribute('aria-invalid', String(wrong));
  if (wrong) return;
  let x = numberOf(path), slope = firstSlope, before = null, message = 'it does not converge';
  try {
    for (let i = 0; i < 15; ++i) {
      const value =
          await valueWith(new Map(state.settings).set(path, written(x)), branchName, name, a);
      if (mine !== solvingFor || state.due) return;
      if (!Number.isFinite(value)) break;
      if (Math.abs(value - want) <= 1e-6 * Math.max(1, Math.abs(want))) {
        begin();
        put(path, written(x));
        settle();
        changed();
        return;
      }
      if (before && x !== before[0]) slope = (value - before[1]) / (x - before[0]);
      before = [x, value];
      x += (want - value) / slope;
    }
  } catch (error) {
    message = error.message;
  }
  trouble(`${name} of ${want} is not reached by ${path}: ${message}`);
};
$('effects').onsubmit = event => event.preventDefault();
$('effect').onchange = () => { clearEffects(); restSoon(); };
