// ---- The list of numbers, and the entry of the chosen hardpoint
import {$, make, pageUnit, show, shown, sketch, written} from './base.js';
import {begin, choosePoint, dropSettings, put, settle, state, toggleInGroup} from './state.js';
import {changed} from './solve.js';
import {images, isLocked, linksAt, paths, toggleLock} from './points.js';
import {axesOf, drawHandles} from './view.js';

export const rowsOf = new Map();  // path -> [row, ...]
const isNumber = text => /^[+-]?(\d+\.?\d*|\.\d+)(e[+-]?\d+)?$/i.test(text.trim());
// A text in the unit of the file as one in that of the page, and back; what is not a number stays.
const toPage = (path, text) => {
  const [, factor] = pageUnit(state.numbers.get(path).unit);
  return factor === 1 || !isNumber(text) ? text : written(+text * factor);
};
export const fromPage = (path, text) => {
  const [, factor] = pageUnit(state.numbers.get(path).unit);
  return factor === 1 || !isNumber(text) ? text : written(+text / factor);
};
const sliderOf = (number, filled) => {
  const size = Math.abs(number.value);
  const slider = make('input', {
    type: 'range',
    'aria-label': `${number.path}, slider`,
    min: number.value - .5 * size,
    max: number.value + .5 * size,
    step: size / 200
  });
  slider.oninput = () => {
    begin();
    put(number.path, written(+slider.value));
    filled();
    changed();
  };
  slider.onchange = () => {
    settle();
    changed();
  };
  return slider;
};
const numberRow = (number, words, slides) => {
  const entry = make(
      'input',
      {type: 'text', inputmode: 'decimal', 'aria-label': number.path, autocomplete: 'off'});
  const row =
      make('div', {class: 'row', 'data-path': number.path}, make('span', {class: 'path'}, words));
  // Whether the entry has text that is not a setting yet; the settings that entry and slider show.
  let typed = false, filled = null, slid = null;
  entry.oninput = () => { typed = true; filled = null; };
  entry.onchange = () => {
    typed = false;
    filled = null;
    begin();
    put(number.path, fromPage(number.path, entry.value.trim()));
    settle();
    changed();
  };
  const [unit] = pageUnit(number.unit);
  row.title = `as opened: ${toPage(number.path, String(number.value))} ${unit}`;
  const slider = slides && number.value !== 0 ? sliderOf(number, () => { slid = null; }) : null;
  row.append(slider ?? make('span'), entry, make('span', {class: 'unit'}, unit));
  // Sets only what differs: the browser paints an entry again that is set to its own value.
  row.fill = () => {
    const text = state.settings.get(number.path) ?? String(number.value);
    if (!typed && filled !== text) entry.value = toPage(number.path, filled = text);
    if (slider && slid !== text && document.activeElement !== slider) slider.value = slid = text;
    row.classList.toggle('changed', state.settings.has(number.path));
  };
  // Whether text is taken back that is not entered yet.
  row.revert = () => {
    const was = typed;
    typed = false;
    row.fill();
    return was;
  };
  rowsOf.set(number.path, [...(rowsOf.get(number.path) ?? []), row]);
  row.fill();
  return row;
};
export const fillNumbers = () => {
  for (const rows of rowsOf.values())
    for (const row of rows) row.fill();
  drawLinks();
};
// The links of the chosen hardpoint, with lengths that a drag can keep.
const drawLinks = () => {
  const name = state.point, list = $('links');
  if (!name || !list) return;
  show(list, ...linksAt(name).map(({link, other, length}) => {
    const locked = isLocked(name, other), label = `keep the length to ${other}`;
    const tick = sketch('input', {type: 'checkbox', checked: locked, 'aria-label': label,
      onchange: () => { toggleLock(name, other); drawLinks(); }});
    return sketch('li', {}, `${link}, to ${other}: ${shown(length)} mm `,
      sketch('label', {}, tick, 'keep'));
  }));
  $('group').setAttribute('aria-pressed', String(state.group.includes(name)));
  $('group').textContent = state.group.length ? `Moves with the group of ${state.group.length}`
    : 'Moves with a group';
};
// Marks the entries that the message is about, or that are no number.
let marked = false;
export const markInvalid = () => {
  const text = state.failure?.message ?? '';
  if (!text && !marked) return;
  marked = text !== '';
  for (const [path, rows] of rowsOf)
    for (const row of rows) {
      const entry = row.querySelector('input[type=text]'), given = state.settings.get(path);
      const wrong = given !== undefined && text !== '' &&
          (text.includes(path) || !Number.isFinite(+given) || given === '');
      if (entry.getAttribute('aria-invalid') !== String(wrong))
        entry.setAttribute('aria-invalid', String(wrong));
    }
};
const order = ['springs', 'bushings', 'stops', 'torsion_springs', 'beams', 'tyres', 'joints'];
const rank = name => { const k = order.indexOf(name); return k < 0 ? 50 : k; };
export const makeNumbers = () => {
  rowsOf.clear();
  const sections = new Map();
  for (const number of state.info.numbers) {
    const section = number.path.split('.')[0];
    if (!sections.has(section))
      sections.set(section, make('div', {}, make('h3', {}, section.replaceAll('_', ' '))));
    const words = number.path.slice(section.length + 1) || section;
    sections.get(section).append(numberRow(number, words, section !== 'points'));
  }
  const sorted = [...sections].sort((a, b) => rank(a[0]) - rank(b[0]));
  $('list').replaceChildren(...sorted.map(s => s[1]));
  filterNumbers();
};
const filterNumbers = () => {
  const word = $('find').value.trim().toLowerCase();
  for (const section of $('list').children) {
    const rows = [...section.querySelectorAll('.row')];
    for (const row of rows) row.hidden = !row.dataset.path.toLowerCase().includes(word);
    section.hidden = rows.every(row => row.hidden);
  }
};
export const choose = name => {
  if (state.point === name && !$('point').hidden) { drawLinks(); return; }
  for (const [path, rows] of rowsOf)
    rowsOf.set(path, rows.filter(row => !$('point').contains(row)));
  choosePoint(name);
  const back = make('button', {type: 'button'}, 'As opened');
  back.onclick = () => {
    begin();
    dropSettings(paths(name));
    settle();
    changed();
  };
  const rows = paths(name).map((p, k) => numberRow(state.numbers.get(p), 'xyz'[k], false));
  const group = make('button', {id: 'group', type: 'button',
    title: 'All points of the group move together; also by Ctrl and a click'});
  group.onclick = () => { toggleInGroup(name); drawLinks(); drawHandles(axesOf()); };
  $('point').replaceChildren(
    make('h3', {}, images.has(name) ? `${name}, of the numbers of ${images.get(name)}` : name),
    ...rows, back, group, make('ul', {id: 'links'}));
  $('point').hidden = false;
  drawLinks();
  drawHandles(axesOf());
};
$('find').oninput = filterNumbers;
