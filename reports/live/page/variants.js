// ---- Work that is kept: variants A, B and C beside the scene, overlaid in the charts, to return
// to or to compare with; and in the browser, until the same scene is opened again.
import {$, make, write} from './base.js';
import {Run, keyOf} from './run.js';
import {
  compareWith, dropVariant, isChanged, isSolved, keepVariant, markSaved, referenceName, state,
  takeSettings
} from './state.js';
import {draw, edit} from './app.js';
import {changed} from './solve.js';

const changesOf = settings =>
  `${settings.length} number${settings.length === 1 ? '' : 's'} changed`;
const chipOf = ({name, run}) => {
  const back = make('button', {type: 'button', title: `Return to ${name}`}, name);
  const drop = make('button', {type: 'button', 'aria-label': `Drop ${name}`}, '×');
  back.onclick = () => edit(() => takeSettings(run.settings));
  drop.onclick = () => { dropVariant(name); changed(); };
  const words = ` ${changesOf(run.settings)} `;
  return make(
      'span', {class: `chip variant ${name}`}, make('i', {class: 'key'}), back, words, drop);
};
export const drawVariants = () => {
  const names = ['', ...state.variants.map(v => v.name)];
  $('keep').disabled = !isSolved() || !state.settings.size || state.variants.length > 2 ||
    state.variants.some(v => v.run.key === state.now.key);
  const kept = state.variants.some(v => v.run.key === state.now.key);
  $('refer').disabled = !isSolved() || !isChanged() ||
    (state.settings.size > 0 && !kept && state.variants.length > 2);
  write($('was-name'), referenceName());
  if (names.join() === $('compare').dataset.names) return;
  $('compare').dataset.names = names.join();
  $('variants').replaceChildren(...state.variants.map(chipOf));
  $('compare').replaceChildren(...names.map(n => make('option', {value: n}, n || 'as opened')));
  $('compare').value = state.compared;
  $('compare-with').hidden = !state.variants.length;
};
const keepNow = () => {
  if (state.variants.every(v => v.run.key !== state.now.key)) keepVariant(state.now);
  draw();
  storeWork();
};
$('keep').onclick = keepNow;
// Makes the numbers on the screen the reference: the scene as opened, or a variant.
$('refer').onclick = () => {
  if (state.settings.size) keepNow();
  compareWith(state.variants.find(v => v.run.key === state.now.key)?.name ?? '');
  $('compare').dataset.names = '?';
  changed();
};
$('compare').onchange = () => {
  compareWith($('compare').value);
  changed();
};

// ---- In the browser, by the file and the text of the scene; a browser may forbid it.
const place = () => `elastocheck live: ${state.file}`;
export const workOf = () => ({source: state.source, settings: [...state.settings],
  variants: state.variants.map(v => v.run.settings)});
export const storeWork = () => {
  const work = workOf(), nothing = !work.settings.length && !work.variants.length;
  if (nothing && !$('restore').hidden) return;  // it is still offered
  try {
    if (nothing) localStorage.removeItem(place());
    else localStorage.setItem(place(), JSON.stringify(work));
  } catch { /* nothing is kept */ }
};
const stored = () => {
  try {
    const work = JSON.parse(localStorage.getItem(place()));
    return work?.source === state.source ? work : null;
  } catch { return null; }
};
const take = work => {
  for (const list of work.variants)
    if (state.variants.every(v => v.run.key !== keyOf(list))) keepVariant(new Run(list));
  edit(() => takeSettings(work.settings));
};
const isOfScene = work => work?.source === state.source &&
  [...work.variants, work.settings].every(list => list.every(([path]) => state.numbers.has(path)));
// Takes the work saved with the page; else offers the work that the browser has stored of the
// scene.
export const restoreWork = inFile => {
  const work = stored();
  $('compare').dataset.names = '?';
  $('restore').hidden = !isOfScene(work) || inFile !== undefined;
  if (isOfScene(inFile)) {
    take(inFile);
    markSaved(keyOf(state.settings));
  }
  if ($('restore').hidden) return;
  $('restore').textContent = `Restore the work of last time (${changesOf(work.settings)})`;
  $('restore').onclick = () => {
    $('restore').hidden = true;
    take(work);
  };
};
