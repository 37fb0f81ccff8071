// ---- Work that is kept: variants A, B and C beside the scene, overlaid in the charts, to return
// to or to compare with; and in the browser, until the same scene is opened again.
import {$, make} from './base.js';
import {Run, keyOf} from './run.js';
import {dropVariant, isSolved, keepVariant, referenceName, state} from './state.js';
import {draw, edit} from './app.js';
import {changed} from './solve.js';

const changesOf = settings =>
  `${settings.length} number${settings.length === 1 ? '' : 's'} changed`;
const chipOf = ({name, run}) => {
  const back = make('button', {type: 'button', title: `Return to ${name}`}, name);
  const drop = make('button', {type: 'button', 'aria-label': `Drop ${name}`}, '×');
  back.onclick = () => edit(() => { state.settings = new Map(run.settings); });
  drop.onclick = () => { dropVariant(name); changed(); };
  const words = ` ${changesOf(run.settings)} `;
  return make(
      'span', {class: `chip variant ${name}`}, make('i', {class: 'key'}), back, words, drop);
};
export const drawVariants = () => {
  const names = ['', ...state.variants.map(v => v.name)];
  $('keep').disabled = !isSolved() || !state.settings.size || state.variants.length > 2 ||
    state.variants.some(v => v.run.key === state.now.key);
  $('was-name').textContent = referenceName();
  if (names.join() === $('compare').dataset.names) return;
  $('compare').dataset.names = names.join();
  $('variants').replaceChildren(...state.variants.map(chipOf));
  $('compare').replaceChildren(...names.map(n => make('option', {value: n}, n || 'as opened')));
  $('compare').value = state.compared;
  $('compare-with').hidden = !state.variants.length;
};
$('keep').onclick = () => {
  keepVariant(state.now);
  draw();
  storeWork();
};
$('compare').onchange = () => {
  state.compared = $('compare').value;
  changed();
};

// ---- In the browser, by the file and the text of the scene; a browser may forbid it.
const place = () => `elastocheck live: ${state.file}`;
export const storeWork = () => {
  const {source, variants} = state, settings = [...state.settings];
  const nothing = !settings.length && !variants.length;
  if (nothing && !$('restore').hidden) return;  // it is still offered
  try {
    if (nothing) localStorage.removeItem(place());
    else localStorage.setItem(place(), JSON.stringify({source, settings,
      variants: variants.map(v => v.run.settings)}));
  } catch { /* nothing is kept */ }
};
const stored = () => {
  try {
    const work = JSON.parse(localStorage.getItem(place()));
    return work?.source === state.source ? work : null;
  } catch { return null; }
};
// Offers what was kept of this scene.
export const restoreWork = () => {
  const work = stored(), all = work ? [...work.variants, work.settings] : [];
  const known = all.every(list => list.every(([path]) => state.of.has(path)));
  $('compare').dataset.names = '?';
  $('restore').hidden = !work || !known;
  if (!work || !known) return;
  $('restore').textContent = `Restore the work of last time (${changesOf(work.settings)})`;
  $('restore').onclick = () => {
    $('restore').hidden = true;
    for (const list of work.variants)
      if (state.variants.every(v => v.run.key !== keyOf(list))) keepVariant(new Run(list));
    edit(() => { state.settings = new Map(work.settings); });
  };
};
