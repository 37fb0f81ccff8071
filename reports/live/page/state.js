// ---- The state of the page, and the functions that change it. A station is a parameter of a
// branch, never an index. The scene as opened is solved once per branch and not overwritten. What
// is on the screen belongs to one run (state.now).
import {Run, keyOf} from './run.js';

const fresh = () => ({
  // The open scene, as open() of engine.hpp describes it: its numbers by path, outputs by name,
  // and its figures: each the outputs of one chart, one of every wheel.
  info: null, source: '', file: '', files: undefined, numbers: new Map(), channel: new Map(),
  figures: new Map(),
  // path -> text of the numbers that are changed; the key of those that were saved last
  settings: new Map(), saved: keyOf([]),
  // settings before each change, and before the present one; what the pointer holds
  undo: [], redo: [], before: null, held: null,
  // runs of the scene as opened, and on the screen; why the newest numbers have none: {message,
  // kind}
  base: new Run([]), now: null, failure: null,
  // kept runs: {name, run}; name of the one to compare with, '': the scene as opened
  variants: [], compared: '',
  // what is shown; branch '': all of them; station null: the start; curves null: the default ones
  branch: '', station: null, curves: null, targets: new Map(), point: null, effects: null,
  large: '',
  // points that move together; lengths that stay [mm], by their ends; result of a wish that is not
  // taken over: {name, run, numbers}
  group: [], locks: new Map(), preview: null,
});
export const state = {
  ...fresh(), busy: false, due: false, since: 0, published: false, guides: true, solves: 0
};

const figuresOf = channels => {
  const figures = new Map();
  for (const channel of channels) {
    const key = channel.wheel === null ? channel.name : channel.figure;
    figures.set(key, [...figures.get(key) ?? [], channel]);
  }
  return figures;
};
export const openScene = (head, source, file, files) => Object.assign(state, fresh(), {
  info: head, source, file, files, branch: head.branches[0]?.name ?? '',
  numbers: new Map(head.numbers.map(n => [n.path, n])),
  channel: new Map(head.channels.map(c => [c.name, c])), figures: figuresOf(head.channels),
});

// ---- What is shown
const shownBranch = run => run.branch(state.branch) ?? run.branches[0];
// Index of the shown point of a branch; of other branches than the shown one the start.
export const stationIn = (run, branch) => !branch?.points ? 0
  : state.station === null || branch.name !== shownBranch(run).name ? branch.start
    : run.near(branch, state.station);
export const stationOf = run => {
  const branch = shownBranch(run);
  return [branch, stationIn(run, branch)];
};
// What the run on the screen is compared with: the scene as opened, or a variant.
export const reference = () =>
  state.variants.find(v => v.name === state.compared)?.run ?? state.base;
export const referenceName = () => state.compared || 'as opened';
// The same position of the reference; -1: it has no such point.
export const stationInReference = () => {
  const [branch, k] = stationOf(state.now), old = reference().branch(branch?.name);
  return [old, branch?.points ? reference().exact(old, state.now.a(branch, k)) : -1];
};
export const shownBranches = () =>
    state.now.branches.filter(b => ['', b.name].includes(state.branch));
export const showBranch = name => Object.assign(state, {branch: name, station: null});
export const showStation = (branch, a) => {
  const k = state.now.near(branch, a);
  state.station = k === branch.start ? null : state.now.a(branch, k);
};
export const showPublished = on => { state.published = on; };
export const showGuides = on => { state.guides = on; };
export const showCurves = keys => { state.curves = keys.length ? keys : null; };
export const toggleLarge = key => { state.large = state.large === key ? '' : key; };
export const choosePoint = name => { state.point = name; };
// null: no band
export const aimAt = (key, ends) =>
  ends ? state.targets.set(key, ends) : state.targets.delete(key);
export const keepEffects = effects => { state.effects = effects; };
export const keepPreview = preview => { state.preview = preview; };
export const compareWith = name => { state.compared = name; };
export const isSolved = () => state.now !== null && state.now.key === keyOf(state.settings) &&
  state.now.fast === state.published;
export const isChanged = () => state.now.key !== reference().key;
export const keptRuns = () =>
  [state.base, ...state.variants.map(v => v.run), ...state.preview ? [state.preview.run] : []];

// ---- Numbers and settings
export const numberOf = path =>
  state.settings.has(path) ? +state.settings.get(path) : state.numbers.get(path).value;
export const put = (path, text) => {
  if (state.numbers.get(path).value === +text && text.trim() !== '') state.settings.delete(path);
  else state.settings.set(path, text);
};

export const takeSettings = settings => { state.settings = new Map(settings); };
export const dropSettings = paths => paths.forEach(path => state.settings.delete(path));
export const markSaved = key => { state.saved = key; };
// What the pointer holds: a hardpoint by its name, or the view.
export const hold = held => { state.held = held; };
export const letGoOfAll = () => Object.assign(state, {held: null, before: null});
export const toggleInGroup = name => {
  state.group = state.group.includes(name) ? state.group.filter(n => n !== name)
    : [...state.group, name];
};
// Keeps a length, or stops keeping it.
export const toggleLength = (key, length) => {
  if (!state.locks.delete(key)) state.locks.set(key, length);
};

// ---- Variants: kept beside the scene as A, B and C
export const keepVariant = run => {
  const name = [...'ABC'].find(letter => state.variants.every(v => v.name !== letter));
  if (name) state.variants.push({name, run});
};
export const dropVariant = name => {
  state.variants = state.variants.filter(v => v.name !== name);
  if (state.compared === name) state.compared = '';
};

// ---- Undo: the settings before each change. begin() and settle() enclose what is undone in one
// step.
export const begin = () => { state.before ??= [...state.settings]; };
export const settle = () => {
  const {before} = state;
  state.before = null;
  if (!before || keyOf(before) === keyOf(state.settings)) return;
  state.undo.push(before);
  state.redo = [];
};
export const isMoving = () => state.before !== null;
// Back to what was before begin().
export const abandon = () => {
  if (state.before) state.settings = new Map(state.before);
  state.before = null;
};
export const stepBack = (from, to) => {
  if (!from.length) return false;
  to.push([...state.settings]);
  state.settings = new Map(from.pop());
  return true;
};

// ---- Solving
export const startSolve = () => {
  const {since} = state;
  Object.assign(state, {due: false, since: 0});
  return since;
};
export const demandSolve = () => {
  state.since ||= performance.now();
  Object.assign(state, {due: true, failure: null});
};
export const setBusy = busy => { state.busy = busy; };
export const showRun = run => Object.assign(
    state, {now: run, failure: null, solves: Math.max(state.solves, run.id ??= state.solves + 1)});
export const showFailure = ({message, kind}) => Object.assign(state, {failure: {message, kind}});
