// ---- What goes in and out: scenes opened, dropped or pasted; the varied scene, its command line,
// the shown curves
import {$, make, trouble, wholePage} from './base.js';
import {keyOf} from './run.js';
import {markSaved, reference, referenceName, shownBranches, state} from './state.js';
import {solvers} from './solver.js';
import {curvesOf} from './charts.js';
import {workOf} from './variants.js';
import {tryOpen} from './app.js';

export const save = (text, name, type = 'text/yaml') => {
  const link = make('a', {href: URL.createObjectURL(new Blob([text], {type})), download: name});
  link.click();
  setTimeout(() => URL.revokeObjectURL(link.href), 1000);
};
export const stem = () => state.file.replace(/^.*[/\\]/, '').replace(/\.ya?ml$/, '');
// Numbers that the reader refuses are not written.
$('save').onclick = async () => {
  const settings = [...state.settings], {failure} = state;
  try {
    if (failure?.kind === 'input')
      throw new Error(`not saved, since it is not a scene:\n${failure.message}`);
    const {text} = await solvers.back.ask('rewrite', {request: {settings}});
    window.live.saved = text;
    markSaved(keyOf(settings));
    save(text, `${stem()}_varied.yaml`);
  } catch (error) { trouble(error.message); }
};
// The whole page with its scene, its numbers and its variants.
$('save-page').onclick = () => {
  const {source: text, file: name, files} = state, read = $('scene').textContent;
  const [head, tail] = wholePage().split(read), {text: own, first} = JSON.parse(read);
  const scene = JSON.stringify({text, name, files, work: workOf(), ...own === text && {first}})
    .replaceAll('<', '\\u003c');
  window.live.saved = `<!doctype html>\n${head}${scene}${tail}`;
  save(window.live.saved, `${stem()}.html`, 'text/html');
  markSaved(keyOf(state.settings));
};
export const quoted = word =>
    /^[\w./=+-]+$/.test(word) ? word : `'${word.replaceAll("'", "'\\''")}'`;
export const commandLine = () => ['elastocheck', 'report', quoted(state.file),
  ...[...state.settings].flatMap(([p, v]) => ['--set', quoted(`${p}=${v}`)])].join(' ');
const dialog = (title, text, write, then) => {
  const box = $('dialog'), area = box.querySelector('textarea');
  box.querySelector('span').textContent = title;
  area.value = text;
  area.readOnly = !write;
  $('dialog-ok').hidden = !write;
  box.returnValue = '';
  box.onclose = () => { if (box.returnValue === 'ok' && then) then(area.value); };
  box.showModal();
  if (!write) area.select();
};
$('line').onclick = () => dialog(
    'The numbers that differ from the scene as opened, as a command line', commandLine(), false);
$('paste').onclick = () =>
    dialog('Text of a scene (YAML)', '', true, text => tryOpen(text, 'pasted.yaml'));
// One row per point and curve.
const curvesAsCsv = () => {
  const rows =
      [['branch', 'parameter', 'unit of the parameter', 'output', 'unit', 'now', referenceName()]];
  for (const branch of shownBranches())
    for (const {name, unit} of curvesOf(branch).flatMap(key => state.figures.get(key) ?? [])) {
      const before = new Map(reference().curve(reference().branch(branch.name), name));
      for (const [a, value] of state.now.curve(branch, name))
        rows.push([branch.name, a, branch.unit, name, unit, value, before.get(a) ?? '']);
    }
  const cell = v => Number.isNaN(v) ? '' :
      /[",\n]/.test(v)              ? `"${String(v).replaceAll('"', '""')}"` :
                                      v;
  return rows.map(row => row.map(cell).join(',')).join('\n') + '\n';
};
$('csv').onclick = () => save(window.live.saved = curvesAsCsv(), `${stem()}.csv`, 'text/csv');
// A scene, and the tables that it refers to by their names.
export const openFiles = async list => {
  const all = [...list], scene = all.find(f => /\.ya?ml$/i.test(f.name)) ?? all[0],
        others = all.filter(f => f !== scene);
  if (!scene) return;
  const files = await Promise.all(others.map(async f => [f.name, await f.text()]));
  await tryOpen(
      await scene.text(), scene.name, files.length ? Object.fromEntries(files) : undefined);
};
export const makeFiles = () => {
  $('file').onchange = async () => {
    await openFiles($('file').files);
    $('file').value = '';
  };
  for (const name of ['dragover', 'drop'])
    document.addEventListener(name, async event => {
      if (!event.dataTransfer?.types.includes('Files')) return;
      event.preventDefault();
      if (name === 'drop') await openFiles(event.dataTransfer.files);
    });
  window.addEventListener('beforeunload', event => {
    if (state.saved !== keyOf(state.settings)) event.preventDefault();
  });
};
