// ---- Solving: the newest numbers of the shown branch at once; the other branches, the scene as
// opened, effects and proofs when nothing is moved.
import {$, write, writeAttributes} from './base.js';
import {Run, keyOf} from './run.js';
import {
  demandSolve, isMoving, isSolved, keptRuns, reference, setBusy, showFailure, showRun,
  startSolve, state
} from './state.js';
import {solvers} from './solver.js';
import {draw, drawChange} from './app.js';
import {dropProofs, prove} from './proof.js';
import {measureEffects} from './effects.js';
import {whatIsShown} from './charts.js';
import {storeWork} from './variants.js';

export const allPoints = 40;
export const requestOf = (settings, only, more = {}) =>
  ({settings: [...settings], points: allPoints, only, ...more});
window.live = {
  draws: [],
  state
};  // for tests: seconds of every solve, and from the change to the picture

// Solves a branch, or all for '', into a run: everything, or what is shown while a number moves.
export const solveInto = async (run, solver, only, shown_) => {
  const {info} = state, place = b => info.branches.findIndex(entry => entry.name === b.name);
  const request = requestOf(run.settings, only, {published: run.fast, shown: shown_});
  const answer = await solver.ask('solve', {request});
  run.seconds ??= answer.seconds;
  run.take(answer, !shown_).branches.sort((a, b) => place(a) - place(b));
};
// Whether a run has a branch, or all for '', as far as it is drawn now.
const has = (run, only) => {
  const list = only === '' ? run.branches : run.branches.filter(b => b.name === only);
  return list.length === (only === '' ? state.info.branches.length : 1) &&
    list.every(b => b.whole || isMoving());
};

// The worker begins before the page draws what is moved.
export const solveSoon = () => {
  demandSolve();
  pump();
};
let later = 0;
const showChange = () => {
  clearTimeout(later);
  later = 0;
  if (!isSolved()) dropProofs();
  drawChange();
};
// A move is drawn with its answer, in one frame, and before it where the answer is late.
export const showChangeSoon = () => { later ||= setTimeout(showChange, 50); };
export const changed = () => {
  solveSoon();
  showChange();
};
// A hidden page gets no frames.
export const nextFrame = () =>
  new Promise(resolve => { requestAnimationFrame(resolve); setTimeout(resolve, 100); });
const newest = () => {
  const {published, now} = state, settings = [...state.settings], key = keyOf(settings);
  return [...keptRuns(), now].find(run => run?.key === key && run.fast === published) ??
      new Run(settings, published);
};
// Solves the newest numbers; a run that is solved already is drawn with the next frame.
const askNewest = () => {
  const asked = startSolve(), {info, branch} = state, base = reference(), run = newest();
  showWaiting();
  const old = run === base || has(base, branch) ? null : solveInto(base, solvers.back, branch);
  const solved = has(run, branch) ? nextFrame()
    : solveInto(run, solvers.front, branch, whatIsShown());
  return {asked, info, run, solved: Promise.all([solved, old])};
};
const present = ({asked, info, run}, error) => {
  if (info !== state.info) return;
  error ? showFailure(error) : showRun(run);
  const begun = performance.now();
  if (later) showChange();
  draw();
  const done = performance.now();
  if (error) return;
  window.live.ready ||= done;
  window.live.draws.push(
      {solve: run.seconds, draw: (done - begun) / 1e3, all: (done - asked) / 1e3});
};
// The worker goes on with newer numbers while the page draws. A solver that stopped is asked once
// more.
const pump = async () => {
  if (state.busy || !state.due) return;
  setBusy(true);
  for (let turn_ = askNewest(), again = true; turn_;) {
    const error = await turn_.solved.then(() => null, reason => reason);
    endWaiting();
    const retry = error?.kind === 'stopped' && again && turn_.info === state.info;
    if (retry) demandSolve();
    const next = state.due ? askNewest() : null;
    again = !retry;
    if (!retry) present(turn_, error);
    drawStatus();
    turn_ = next;
  }
  setBusy(false);
  rest();
};

// ---- At rest: nothing is moved and nothing is to be solved for it
export const resting = () => !state.busy && !state.due && !isMoving();
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
        if (run.branch(name)?.whole) continue;
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
    seconds === undefined ? 'starting the solver…' : `shown in ${(1e3 * seconds).toFixed(0)} ms`,
    ...settings.length ? [`${counted(settings.length, 'number')} changed`] : []
  ].join(' · ');
};
const statusOf = () => {
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
