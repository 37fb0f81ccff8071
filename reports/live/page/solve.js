// ---- Solving: the newest numbers of the shown branch at once; the other branches, the scene as
// opened, effects and proofs when nothing is moved.
import {$, write, writeAttributes} from './base.js';
import {Run, keyOf} from './run.js';
import {
  demandSolve, isSolved, keptRuns, reference, showFailure,
  showRun, startSolve, state
} from './state.js';
import {solvers} from './solver.js';
import {draw, drawChange} from './app.js';
import {dropProofs, prove} from './proof.js';
import {measureEffects} from './effects.js';
import {storeWork} from './variants.js';

export const allPoints = 40;
export const requestOf = (settings, only, more = {}) => ({
  settings: [...settings],
  points: allPoints,
  only,
  full: state.info.branches.map(() => true),
  ...more
});
window.live = {
  draws: [],
  state
};  // for tests: seconds of every solve, and from the change to the picture

export const solveInto = async (run, solver, only) => {
  const {info} = state, place = b => info.branches.findIndex(entry => entry.name === b.name);
  const answer =
      await solver.ask('solve', {request: requestOf(run.settings, only, {published: run.fast})});
  run.seconds ??= answer.seconds;
  run.take(answer).branches.sort((a, b) => place(a) - place(b));
};
// Whether a run has what is shown: a branch, or all.
const has = (run, only) => only === '' ? run.branches.length === state.info.branches.length
  : run.branch(only) !== undefined;

// The worker begins before the page draws what is moved.
export const changed = () => {
  demandSolve();
  pump();
  if (!isSolved()) dropProofs();
  drawChange();
};
// A hidden page gets no frames.
const nextFrame = () =>
  new Promise(resolve => { requestAnimationFrame(resolve); setTimeout(resolve, 100); });
export const pump = async () => {
  if (state.busy) return;
  state.busy = true;
  while (state.due) await solveNewest();
  state.busy = false;
  rest();
};
const newest = () => {
  const {published, now} = state, settings = [...state.settings], key = keyOf(settings);
  return [...keptRuns(), now].find(run => run?.key === key && run.fast === published) ??
      new Run(settings, published);
};
const solveNewest = async (again = true) => {
  const asked = startSolve(), {info, branch} = state, base = reference(), run = newest();
  showWaiting();
  try {
    const old = run === base || has(base, branch) ? null : solveInto(base, solvers.back, branch);
    // The page is painted while the worker solves, or now.
    await (has(run, branch) ? nextFrame() : solveInto(run, solvers.front, branch));
    await old;
    if (info !== state.info) return;
    showRun(run);
    const begun = performance.now();
    draw();
    const done = performance.now();
    window.live.ready ||= done;
    window.live.draws.push(
        {solve: run.seconds, draw: (done - begun) / 1e3, all: (done - asked) / 1e3});
  } catch (error) {
    if (info !== state.info) return;
    if (error.kind === 'stopped' && again && !state.due) {
      demandSolve();
      await solveNewest(false);
      return;
    }
    showFailure(error);
    draw();
  } finally {
    endWaiting();
    drawStatus();
  }
};

// ---- At rest: nothing is moved and nothing is to be solved for it
export const resting = () => !state.busy && !state.due && !state.held?.name;
export const isIdle = () => !state.busy && !state.due && !restingNow;  // nothing is being solved
let restingNow = 0, turn = 0, retried = 0;
export const rest = async () => {
  const mine = ++turn, {info} = state,
        more = () => mine === turn && resting() && info === state.info;
  if (!state.now || !info) return;
  ++restingNow;
  try {
    const runs = isSolved() ? [state.now, ...keptRuns()] : keptRuns();
    for (const run of new Set(runs))
      for (const {name} of info.branches) {
        if (!more()) return;
        if (run.branch(name)) continue;
        await solveInto(run, solvers.back, name);
        if (more()) draw();
      }
    retried = 0;
  } catch (error) {
    if (!more()) return;
    if (error.kind === 'stopped' && retried++ < 1)
      restSoon();
    else
      showFailure(error);
    return;
  } finally {
    --restingNow;
    drawStatus();
  }
  if (!more() || !isSolved() || state.failure) return;
  storeWork();
  await measureEffects(more);
  await prove(more);
};
let pause = 0;
export const restSoon = () => {
  ++turn;
  clearTimeout(pause);
  pause = setTimeout(() => resting() && rest(), 250);
};

// ---- The status: one line, and the page dimmed while its curves are not those of its numbers
const counted = (n, one, many = one + 's') => `${n} ${n === 1 ? one : many}`;
const solvedWords = ({branches, id, seconds, settings}) => {
  const all = state.info.branches.length, some = branches.filter(b => b.points).length;
  const early = branches.filter(b => b.points && b.outcome !== 'converged').length;
  const solved = !some ?
      `no point of ${counted(branches.length, 'branch', 'branches')} could be solved` :
      `${some === all ? '' : `${some} of `}${counted(all, 'branch', 'branches')} solved`;
  return [
    `solve ${id}`, solved + (early ? `, ${early} ${early === 1 ? 'ends' : 'end'} early` : ''),
    `shown in ${(1e3 * seconds).toFixed(0)} ms`,
    ...settings.length ? [`${counted(settings.length, 'number')} changed`] : []
  ].join(' · ');
};
export const statusOf = () => {
  const {now, failure} = state, old = now ? `; what is shown is solve ${now.id}` : '';
  if (failure) return ['failed', `not solved: ${failure.message.split('\n')[0]}${old}`];
  if (!now) return ['solving', state.info ? 'solving…' : 'starting the solver…'];
  return isSolved() || !late ? ['solved', solvedWords(now)] : ['solving', `solving…${old}`];
};
// A solve is waited for after a moment, so that a drag neither flickers nor paints the page twice
// for each move; later it can be cancelled.
let late = false, waiting = [];
const showWaiting = () => {
  endWaiting();
  waiting = [
    setTimeout(() => { late = true; drawStatus(); }, 250),
    setTimeout(() => { $('cancel').hidden = false; }, 1000)
  ];
};
const endWaiting = () => {
  waiting.forEach(clearTimeout);
  late &&= state.due;
};
export const drawStatus = () => {
  const [kind, text] = statusOf();
  writeAttributes(document.body, {'data-status': kind});
  write($('state'), text);
  writeAttributes($('state'), {title: text});
  if (!state.busy) $('cancel').hidden = true;
};
$('cancel').onclick = () => solvers.front.restart('cancelled', 'cancelled');
