// ---- The page: what is drawn when, its tools, and its start
import {$, make, shown, trouble, write, writeAttributes} from './base.js';
import {
  begin, isMoving, openScene, settle, showBranch, showFailure, showPublished, showRun, showStation,
  state, stationOf, stepBack, takeSettings
} from './state.js';
import {openIn, solvers, startSolvers, unpacked} from './solver.js';
import {changed, drawStatus, nextFrame, requestOf, restSoon} from './solve.js';
import {draw3d, drawHandles, axesOf, fitView, makeHandles, makeView, view} from './view.js';
import {letGo, makeHand, release} from './hand.js';
import {choosePreset, drawCharts, makeCharts, makeChoice} from './charts.js';
import {drawTables} from './tables.js';
import {clearEffects, listEffects} from './effects.js';
import {fillNumbers, makeNumbers, markInvalid} from './numbers.js';
import {makeFiles} from './files.js';
import {drawVariants, restoreWork} from './variants.js';
import {drawPreview, resetWishes} from './wish.js';

// ---- While a number is moved, what is out of sight is not drawn.
const unseen = new WeakSet();
const sight = new IntersectionObserver(list => {
  for (const {target, isIntersecting} of list) unseen[isIntersecting ? 'delete' : 'add'](target);
  if (isMoving()) draw();
});
export const watchSight = element => sight.observe(element);
export const isLeftOut = element => isMoving() && unseen.has(element);

// After a change of a number, before it is solved.
export const drawChange = () => {
  clearEffects();
  drawPreview();
  fillNumbers();
  drawHandles(axesOf());
  drawButtons();
  drawStatus();
};
// All that depends on the run on the screen, and on whether it is the newest.
export const draw = () => {
  trouble(state.failure?.kind === 'cancelled' ? '' : state.failure?.message ?? '');
  markInvalid();
  drawButtons();
  drawStatus();
  if (!state.now) return;
  drawPreview();
  if (view.size === 1) fitView(state.now);
  draw3d();
  drawCharts();
  drawTables();
  drawMotion();
  drawVariants();
  if (!isMoving()) listEffects();
};
const drawMotion = () => {
  const [branch, k] = stationOf(state.now), slider = $('motion');
  if (!branch?.points) return;
  writeAttributes(slider, {max: String(branch.points - 1)});
  slider.value = k;
  write($('motion-name'), branch.name);
  write($('motion-at'), `${shown(state.now.a(branch, k))} ${branch.unit}`);
  writeAttributes(slider, {'aria-valuetext': $('motion-at').textContent});
};
export const moveTo = (branchName, a) => {
  if (state.now.seconds === undefined) return;  // of the first picture only the start is known
  if (state.branch !== '' || branchName === stationOf(state.now)[0].name)
    showStation(state.now.branch(branchName), a);
  else return select(branchName);
  clearEffects();
  draw3d();
  drawCharts();
  drawMotion();
  drawTables();
  restSoon();
};
$('motion').oninput = () => {
  const [branch] = stationOf(state.now);
  moveTo(branch.name, state.now.a(branch, +$('motion').value));
};
const drawBranches = () => {
  for (const button of $('branches').children)
    button.setAttribute('aria-pressed', String(button.dataset.branch === state.branch));
};
const select = name => {
  showBranch(name);
  drawBranches();
  changed();
};
const makeBranches = () => {
  const names = [...state.info.branches.map(b => b.name), ''];
  $('branches').replaceChildren(...names.map(name => {
    const button = make('button', {type: 'button', 'data-branch': name}, name || 'all branches');
    button.onclick = () => select(name);
    return button;
  }));
  drawBranches();
};
const drawButtons = () => {
  $('undo').disabled = !state.undo.length;
  $('redo').disabled = !state.redo.length;
  for (const id of ['line', 'save', 'save-page', 'csv']) $(id).disabled = !state.info;
  $('reset').disabled = !state.settings.size;
};

// ---- Opening
const drawScene = () => {
  const {title, warnings} = state.info;
  $('title').textContent = title;
  document.title = `${title} – elastocheck live`;
  $('warnings').hidden = !warnings.length;
  $('warnings').querySelector('summary').textContent =
      `${warnings.length} warning${warnings.length > 1 ? 's' : ''} of the reader`;
  $('warnings').querySelector('ul').replaceChildren(...warnings.map(w => make('li', {}, w)));
  makeHandles();
  makeNumbers();
  makeBranches();
  makeChoice();
  resetWishes();
  $('point').hidden = $('target').hidden = $('effects').hidden = true;
};
const enterScene = (head, source, file, files) => {
  letGo();
  openScene(head, source, file, files);
  view.size = 1;
  drawScene();
};
// `first`: the scene and its first branch as the program solved them, on the screen until the
// solver has started and solved them itself.
const openText = async (source, file, files, work, first) => {
  const answer = openIn({source, name: file, files}), enter = head => {
    enterScene(head, source, file, files);
    if (head === first?.open) showFirst(first);
    restoreWork(work);
    changed();
  };
  if (first) enter(first.open);
  const head = await answer;
  if (JSON.stringify(head) !== JSON.stringify(first?.open)) enter(head);
};
const showFirst = ({head, numbers}) => {
  showRun(state.base.take({head, numbers: Float64Array.from(numbers, v => v ?? NaN)}, false));
  draw();
  window.live.ready = performance.now();
};
const readFirst = async packed => {
  try { return await (await unpacked(packed, 'deflate')).json(); } catch { return null; }
};
export const tryOpen = async (source, file, files, work, first) => {
  try { await openText(source, file, files, work, first); } catch (error) {
    trouble(error.message);
    if (!state.info || first) showFailure(error);
    drawStatus();
  }
};

// ---- Tools
const step = (from, to) => {
  if (state.held?.name) release(true);
  if (stepBack(state[from], state[to])) changed();
};
$('undo').onclick = () => step('undo', 'redo');
$('redo').onclick = () => step('redo', 'undo');
export const edit = change_ => {
  begin();
  change_();
  settle();
  changed();
};
$('reset').onclick = () => edit(() => takeSettings([]));
$('preset').onchange = () => { choosePreset(); listEffects(); restSoon(); };
$('published').onchange = () => {
  showPublished($('published').checked);
  document.querySelector('.legend').classList.toggle('plain', !state.published);
  changed();
};
$('trouble').onclick = () => trouble('');
// Ctrl+Z takes back the text of an entry not entered yet, else the last change of a number.
document.addEventListener('keydown', event => {
  if (!(event.ctrlKey || event.metaKey) || event.key.toLowerCase() !== 'z') return;
  const row = event.target.closest('.row'),
        text = event.target.matches('textarea,input[type=text],input[type=search]');
  if (text && !row) return;
  event.preventDefault();
  if (text && row.revert()) return;
  event.shiftKey ? step('redo', 'undo') : step('undo', 'redo');
});
// Solves in the background, until there is something to do: the browser compiles code that has run
// often to faster code.
const warmUp = async () => {
  for (let k = 0; k < 10 && state.info && !state.busy && !state.due; ++k)
    await solvers.front.ask('solve', {request: requestOf([], state.branch)});
};

const start = async () => {
  watchSight($('tables'));
  makeView();
  makeHand();
  makeCharts();
  makeFiles();
  try {
    const {text, name, files, work, first} = JSON.parse($('scene').textContent);
    const read = readFirst(first);
    startSolvers(read.then(nextFrame).then(nextFrame));
    await tryOpen(text, name, files, work, await read);
    await warmUp();
  } catch (error) {
    if (state.info) return;
    showFailure(error);
    draw();
  }
};
start();
