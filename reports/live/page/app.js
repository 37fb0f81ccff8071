// ---- The page: its state, what changes it, and the solver in its worker
const state = {info: null, source: '', file: '', of: new Map(), channel: new Map(), settings: new Map(), base: null, now: null,
  branch: '', station: null, curves: null, point: null, targets: new Map(), effects: null, undo: [], redo: [], solved: new Map()};
const branchOf = (run, name) => run.branches.find(b => b.name === name);
// The shown position is a parameter of the shown branch: points of two runs at one place in their lists may be different
// positions. Of the other branches the start is shown.
const shownBranch = run => branchOf(run, state.branch) ?? run.branches[0];
const stationIn = (run, branch) => !branch?.points ? 0 : state.station === null || branch.name !== shownBranch(run).name ? branch.start : run.near(branch, state.station);
const stationOf = run => {
  const branch = shownBranch(run);
  return [branch, stationIn(run, branch)];
};
// The same position of the scene as opened; -1: it has no such point.
const stationAsOpened = () => {
  const [branch, k] = stationOf(state.now), old = branchOf(state.base, branch?.name);
  return [old, branch?.points ? state.base.exact(old, state.now.a(branch, k)) : -1];
};

// ---- The worker: one call at a time, answers by their number
let worker, calls = 0;
const waiting = new Map();
let stopped = '';  // why the worker answers no more
const ask = (what, data = {}) => new Promise((resolve, reject) => {
  if (stopped) { reject(new Error(stopped)); return; }
  waiting.set(++calls, {resolve, reject});
  worker.postMessage({id: calls, what, ...data}, data.bytes ? [data.bytes] : []);
});
const startWorker = async () => {
  const blob = new Blob([$('worker').textContent], {type: 'text/javascript'});
  worker = new Worker(URL.createObjectURL(blob));
  worker.onmessage = ({data}) => {
    const call = waiting.get(data.id);
    waiting.delete(data.id);
    data.error === undefined ? call.resolve(data) : call.reject(Object.assign(new Error(data.error), {kind: data.kind}));
  };
  worker.onerror = worker.onmessageerror = event => {
    stopped = `the solver stopped: ${event.message ?? 'its answer cannot be read'}; open the page again`;
    for (const call of waiting.values()) call.reject(new Error(stopped));
    waiting.clear();
  };
  const coded = atob($('solver').textContent.trim()), packed = new Uint8Array(coded.length);
  for (let k = 0; k < coded.length; ++k) packed[k] = coded.charCodeAt(k);
  const plain = new Blob([packed]).stream().pipeThrough(new DecompressionStream('gzip'));
  await ask('start', {bytes: await new Response(plain).arrayBuffer()});
};

// ---- Numbers and settings
const numberOf = path => state.settings.has(path) ? +state.settings.get(path) : state.of.get(path).value;
const paths = name => [0, 1, 2].map(k => `points.${name}.${'xyz'[k]}`);
const mm = path => millimetres[state.of.get(path).unit] ?? 1;
const coordinatesOf = name => paths(name).map(p => numberOf(p) * mm(p));
const isMoved = name => paths(name).some(p => state.settings.has(p));
// A hardpoint where it is drawn: its design position, or with its body at the shown station.
const placeOf = name => {
  const design = coordinatesOf(name), {now} = state;
  if (!now) return design;
  const i = now.drawing.points.findIndex(p => p.name === name), [branch, k] = stationOf(now);
  if (i < 0 || !branch?.points || k === branch.start) return design;
  return add(add(design, 1, now.point(branch, k, i)), -1, now.point(branch, branch.start, i));
};
const put = (path, text) => {
  if (state.of.get(path).value === +text && text.trim() !== '') state.settings.delete(path);
  else state.settings.set(path, text);
};
const place = (name, coordinates) => {
  paths(name).forEach((p, k) => { if (Math.abs(coordinates[k] - numberOf(p) * mm(p)) > 1e-9) put(p, written(coordinates[k] / mm(p))); });
  changed();
};
// Half the points while a hardpoint is dragged, where the start is shown.
const allPoints = 40;
const request = () => ({settings: [...state.settings], points: held?.name && state.station === null ? allPoints / 2 : allPoints,
  full: state.info.branches.map(b => state.branch === '' || b.name === state.branch || b === state.info.branches[0])});

// ---- Undo: the settings before each change
const remember = () => {
  const last = state.undo.at(-1), now = [...state.settings];
  if (last && JSON.stringify(last) === JSON.stringify(now)) return;
  state.undo.push(now);
  state.redo = [];
};
// Drops a remembered state that nothing was changed after.
const settle = () => {
  if (state.undo.length && JSON.stringify(state.undo.at(-1)) === JSON.stringify([...state.settings])) state.undo.pop();
  buttons();
};
const restore = (from, to) => {
  if (!from.length) return;
  to.push([...state.settings]);
  state.settings = new Map(from.pop());
  changed();
};
const buttons = () => {
  $('undo').disabled = !state.undo.length;
  $('redo').disabled = !state.redo.length;
  $('reset').disabled = $('line').disabled = $('save').disabled = !state.info;
  $('reset').disabled ||= !state.settings.size;
};

// ---- Solving: the newest state, one solve at a time; what came between is left out
let busy = false, due = false;
window.live = {draws: [], state};  // for tests: seconds of every solve, and from the change to the picture
let since = 0;
const changed = () => {
  since ||= performance.now();
  dropProofs();
  due = true;
  fillNumbers();
  drawHandles(axesOf());
  buttons();
  pump();
};
// A hidden page gets no frames.
const nextFrame = () => new Promise(resolve => { requestAnimationFrame(resolve); setTimeout(resolve, 100); });
const pump = async () => {
  if (busy) return;
  busy = true;
  while (due) {
    due = false;
    const asked = since, settings = new Map(state.settings);
    since = 0;
    try {
      // The first picture needs one branch; the others follow.
      const first = !state.now, asks = request();
      const answer = await ask('solve', {request: first ? {...asks, only: state.branch} : asks});
      if (answer.head.trouble) throw new Error(answer.head.trouble);
      state.now = Object.assign(new Run(answer), {settings: [...settings]});
      if (!settings.size && asks.points === allPoints) state.base = state.now;
      trouble('');
      const begun = performance.now();
      draw();
      const done = performance.now();
      window.live.ready ||= done;
      window.live.draws.push({solve: answer.seconds, draw: (done - begun) / 1e3, all: (done - asked) / 1e3});
      $('state').textContent = `${state.now.branches.length} branch${state.now.branches.length === 1 ? '' : 'es'} solved in ${(1e3 * answer.seconds).toFixed(0)} ms` +
        (settings.size ? ` · ${settings.size} number${settings.size > 1 ? 's' : ''} changed` : '');
      if (first && state.info.branches.length > 1) due = true, since = performance.now();
    } catch (error) {
      $('state').textContent = 'not solved: the curves are those of the last numbers that could be solved';
      trouble(error.message);
      if (state.now) drawNotes();
    }
    invalid();
    await nextFrame();
  }
  busy = false;
};

// ---- Arrows: by how much a figure, at the shown position of the shown branch, changes with each coordinate of a hardpoint.
// Central differences of 0.1 mm, solved while nothing else is to be done.
const listEffects = () => {
  const select = $('effect'), old = select.value, names = [...new Set([...document.querySelectorAll('#charts .chart')].map(c => c.dataset.channel))];
  if ([...select.options].slice(1).map(o => o.value).join() === names.join()) return;
  select.replaceChildren(make('option', {value: ''}, 'none'), ...names.map(n => make('option', {value: n}, n)));
  select.value = names.includes(old) ? old : '';
};
let measuring = 0;
const measureEffects = async () => {
  const mine = ++measuring, name = $('effect').value, h = .1;
  state.effects = null;
  $('effects').hidden = true;
  drawHandles(axesOf());
  if (!name || !state.now) return;
  const [branch, k] = stationOf(state.now), a = state.now.a(branch, k), all = [];
  const rates = state.channel.get(name).kind === 'characteristic';
  for (const point of handles.keys())
    for (const p of paths(point)) {
      const values = [];
      for (const sign of [1, -1]) {
        if (due || busy) return;
        if (mine !== measuring) return;
        const settings = new Map(state.settings).set(p, written(numberOf(p) + sign * h / mm(p)));
        try {
          const run = new Run(await ask('solve', {request: {settings: [...settings], points: allPoints, only: branch.name, full: state.info.branches.map(() => rates)}}));
          values.push(valueAt(run, run.branches[0], name, run.exact(run.branches[0], a)));
        } catch { values.push(NaN); }
      }
      all.push({point, path: p, axis: 'xyz'.indexOf(p.at(-1)), by: (values[0] - values[1]) / (2 * h)});
    }
  if (mine !== measuring) return;
  state.effects = all.filter(e => Number.isFinite(e.by));
  const unit = state.channel.get(name).unit, most = [...state.effects].sort((a, b) => Math.abs(b.by) - Math.abs(a.by)).slice(0, 5);
  $('effects').hidden = false;
  $('effects').querySelector('h3').textContent = `Most effect on ${name} at ${shown(a)} ${branch.unit} of ${branch.name}, per mm`;
  $('effects').querySelector('ol').replaceChildren(...most.map(e => {
    const button = make('button', {type: 'button', 'aria-label': `change ${e.path} for it`}, 'solve');
    button.onclick = () => solveFor(e.path, e.by * mm(e.path), name, branch.name, a);
    return make('li', {}, `${e.path.slice(7)} ${signed(e.by)} ${unit}`, button);
  }));
  $('effects').querySelector('label span').textContent = unit;
  if (document.activeElement !== $('wish')) $('wish').value = shown(state.now.value(branch, k, state.now.place.get(name))).replaceAll('−', '-');
  drawHandles(axesOf());
};
// Sets one number such that a figure at a station has the wished value: secant method, from the known slope.
const solveFor = async (path, slope, name, branchName, a) => {
  const wish = $('wish').value.trim(), want = Number(wish), mine = ++measuring;
  $('wish').setAttribute('aria-invalid', String(wish === '' || !Number.isFinite(want)));
  if (wish === '' || !Number.isFinite(want)) return;
  const rates = state.channel.get(name).kind === 'characteristic';
  let x = numberOf(path), before = null, message = 'it does not converge';
  try {
    for (let i = 0; i < 15; ++i) {
      const settings = new Map(state.settings).set(path, written(x));
      const answer = await ask('solve', {request: {settings: [...settings], points: allPoints, only: branchName, full: state.info.branches.map(() => rates)}});
      if (mine !== measuring || due) return;
      if (answer.head.trouble) throw new Error(answer.head.trouble);
      const run = new Run(answer), value = valueAt(run, run.branches[0], name, run.exact(run.branches[0], a));
      if (!Number.isFinite(value)) break;
      if (Math.abs(value - want) <= 1e-6 * Math.max(1, Math.abs(want))) {
        remember();
        put(path, written(x));
        changed();
        settle();
        return;
      }
      if (before && x !== before[0]) slope = (value - before[1]) / (x - before[0]);
      before = [x, value];
      x += (want - value) / slope;
    }
  } catch (error) { message = error.message; }
  trouble(`${name} of ${want} is not reached by ${path}: ${message}`);
};
$('effects').onsubmit = event => event.preventDefault();
let pause = 0;
const measureSoon = () => { ++measuring; clearTimeout(pause); if ($('effect').value) pause = setTimeout(measureEffects, 250); };
$('effect').onchange = measureEffects;
const trouble = text => { $('trouble').hidden = !text; $('trouble').textContent = text; };

// ---- Opening
const open = async (source, file, files) => {
  const {head} = await ask('open', {source, name: file, files});
  Object.assign(state, {info: head, source, file, of: new Map(head.numbers.map(n => [n.path, n])),
    channel: new Map(head.channels.map(c => [c.name, c])), settings: new Map(), undo: [], redo: [], curves: null, point: null, targets: new Map(), effects: null,
    station: null, branch: head.branches[0]?.name ?? '', now: null, base: null});
  $('title').textContent = head.title;
  document.title = `${head.title} – elastocheck live`;
  $('warnings').hidden = !head.warnings.length;
  $('warnings').querySelector('summary').textContent = `${head.warnings.length} warning${head.warnings.length > 1 ? 's' : ''} of the reader`;
  $('warnings').querySelector('ul').replaceChildren(...head.warnings.map(w => make('li', {}, w)));
  makeHandles();
  makeNumbers();
  makeBranches();
  makeChoice();
  resetWishes();
  $('preset').selectedIndex = 0;
  $('point').hidden = $('target').hidden = $('effects').hidden = true;
  trouble('');
  buttons();
  since = performance.now();
  due = true;
  await pump();
  if (state.base) { fitView(state.base); draw(); }
};
const tryOpen = async (source, file, files) => {
  try { await open(source, file, files); } catch (error) { trouble(error.message); $('state').textContent = 'not opened'; }
};

// ---- Drawing all that depends on the answer
const draw = () => {
  if (!state.now) return;
  if (view.size === 1) fitView(state.now);
  draw3d();
  drawCharts();
  drawTables();
  drawMotion();
  listEffects();
  measureSoon();
  proveSoon();
};
const drawMotion = () => {
  const [branch, k] = stationOf(state.now), slider = $('motion');
  if (!branch?.points) return;
  slider.max = branch.points - 1;
  slider.value = k;
  $('motion-name').textContent = branch.name;
  $('motion-at').textContent = `${shown(state.now.a(branch, k))} ${branch.unit}`;
  slider.setAttribute('aria-valuetext', $('motion-at').textContent);
};
const makeBranches = () => {
  const names = [...state.info.branches.map(b => b.name), ''];
  $('branches').replaceChildren(...names.map(name => {
    const button = make('button', {type: 'button', 'aria-pressed': String(name === state.branch)}, name || 'all branches');
    button.onclick = () => {
      state.branch = name;
      state.station = null;
      for (const other of $('branches').children) other.setAttribute('aria-pressed', String(other === button));
      drawCharts();
      listEffects();
      proveSoon();
      solveBase().then(changed);
    };
    return button;
  }));
};
// The scene as opened, with all that the shown branch needs.
const solveBase = async () => {
  const answer = await ask('solve', {request: {...request(), points: allPoints, settings: []}});
  if (!answer.head.trouble) state.base = new Run(answer);
};
const makeChoice = () => {
  const box = $('choose').querySelector('div');
  box.replaceChildren(...state.info.channels.map(channel => {
    const tick = make('input', {type: 'checkbox', value: channel.name});
    tick.onchange = () => {
      state.curves = [...box.querySelectorAll('input:checked')].map(t => t.value);
      if (!state.curves.length) state.curves = null;
      drawCharts();
    };
    return make('label', {title: channel.definition}, tick, `${channel.name} [${channel.unit}]`);
  }));
};
$('choose').addEventListener('toggle', () => {
  if (!$('choose').open || !state.now) return;
  const list = state.curves ?? defaultCurves(state.base, branchOf(state.base, state.branch) ?? state.base.branches[0]);
  for (const tick of $('choose').querySelectorAll('input')) tick.checked = list.includes(tick.value);
});
// ---- The list of numbers, and the entry of the chosen hardpoint
const rowsOf = new Map();  // path -> [row, ...]
const numberRow = (number, words, slides) => {
  const entry = make('input', {type: 'text', inputmode: 'decimal', 'aria-label': number.path, autocomplete: 'off'});
  const row = make('div', {class: 'row', 'data-path': number.path}, make('span', {class: 'path'}, words));
  entry.onchange = () => { remember(); put(number.path, entry.value.trim()); changed(); settle(); };
  row.title = `as opened: ${number.value} ${number.unit}`;
  let slider = null, slid = null;  // the text that the slider stands at
  if (slides && number.value !== 0) {
    const size = Math.abs(number.value);
    slider = make('input', {type: 'range', 'aria-label': `${number.path}, slider`, min: number.value - .5 * size, max: number.value + .5 * size, step: size / 200});
    slider.onpointerdown = remember;
    slider.onkeydown = event => { if (event.key.startsWith('Arrow')) remember(); };
    slider.oninput = () => { put(number.path, written(+slider.value)); slid = null; changed(); };
    slider.onchange = settle;
  }
  row.append(slider ?? make('span'), entry, make('span', {class: 'unit'}, number.unit));
  // Sets only what differs: the browser paints an entry again that is set to its own value.
  row.fill = () => {
    const text = state.settings.get(number.path) ?? String(number.value);
    if (entry.value !== text && (document.activeElement !== entry || entry.value.trim() !== text)) entry.value = text;
    if (slider && slid !== text && document.activeElement !== slider) slider.value = slid = text;
    row.classList.toggle('changed', state.settings.has(number.path));
  };
  rowsOf.set(number.path, [...(rowsOf.get(number.path) ?? []), row]);
  row.fill();
  return row;
};
const fillNumbers = () => { for (const rows of rowsOf.values()) for (const row of rows) row.fill(); };
// Marks the entries that the message is about, or that are no number.
const invalid = () => {
  const text = $('trouble').textContent;
  for (const [path, rows] of rowsOf)
    for (const row of rows) {
      const entry = row.querySelector('input[type=text]'), given = state.settings.get(path);
      const wrong = String(given !== undefined && text !== '' && (text.includes(path) || !Number.isFinite(+given) || given === ''));
      if (entry.getAttribute('aria-invalid') !== wrong) entry.setAttribute('aria-invalid', wrong);
    }
};
const makeNumbers = () => {
  rowsOf.clear();
  const sections = new Map();
  for (const number of state.info.numbers) {
    const section = number.path.split('.')[0];
    if (!sections.has(section)) sections.set(section, make('div', {}, make('h3', {}, section.replaceAll('_', ' '))));
    sections.get(section).append(numberRow(number, number.path.slice(section.length + 1) || section, section !== 'points'));
  }
  const order = ['springs', 'bushings', 'stops', 'torsion_springs', 'beams', 'tyres', 'joints'];
  const rank = name => { const k = order.indexOf(name); return k < 0 ? 50 : k; };
  $('list').replaceChildren(...[...sections].sort((a, b) => rank(a[0]) - rank(b[0])).map(s => s[1]));
  filter();
};
const filter = () => {
  const word = $('find').value.trim().toLowerCase();
  for (const section of $('list').children) {
    let any = false;
    for (const row of section.querySelectorAll('.row')) {
      row.hidden = !row.dataset.path.toLowerCase().includes(word);
      any ||= !row.hidden;
    }
    section.hidden = !any;
  }
};
const choose = name => {
  if (state.point === name && !$('point').hidden) return;
  for (const [path, rows] of rowsOf) rowsOf.set(path, rows.filter(row => !$('point').contains(row)));
  state.point = name;
  const back = make('button', {type: 'button'}, 'As opened');
  back.onclick = () => { remember(); paths(name).forEach(p => state.settings.delete(p)); changed(); settle(); };
  $('point').replaceChildren(make('h3', {}, name), ...paths(name).map((p, k) => numberRow(state.of.get(p), 'xyz'[k], false)), back);
  $('point').hidden = false;
  drawHandles(axesOf());
};

// ---- Tools
$('find').oninput = filter;
$('undo').onclick = () => restore(state.undo, state.redo);
$('redo').onclick = () => restore(state.redo, state.undo);
$('reset').onclick = () => { remember(); state.settings.clear(); changed(); settle(); };
$('motion').oninput = () => {
  const [branch] = stationOf(state.now), k = +$('motion').value;
  state.station = k === branch.start ? null : state.now.a(branch, k);
  draw3d();
  drawCharts();
  drawMotion();
  if ($('forces').open || $('table-at').value === 'shown') drawTables();
  measureSoon();
};
document.addEventListener('keydown', event => {
  if (!(event.ctrlKey || event.metaKey) || event.key.toLowerCase() !== 'z' || event.target.matches('input[type=text],textarea')) return;
  event.preventDefault();
  event.shiftKey ? restore(state.redo, state.undo) : restore(state.undo, state.redo);
});
const save = (text, name) => {
  const link = make('a', {href: URL.createObjectURL(new Blob([text], {type: 'text/yaml'})), download: name});
  link.click();
  setTimeout(() => URL.revokeObjectURL(link.href), 1000);
};
$('save').onclick = async () => {
  try {
    const {text} = await ask('rewrite', {request: {settings: [...state.settings]}});
    window.live.saved = text;
    save(text, state.file.replace(/^.*[/\\]/, '').replace(/\.ya?ml$/, '') + '_varied.yaml');
  } catch (error) { trouble(error.message); }
};
const quoted = word => /^[\w./=+-]+$/.test(word) ? word : `'${word.replaceAll("'", "'\\''")}'`;
const commandLine = () => ['elastocheck', 'report', quoted(state.file), ...[...state.settings].flatMap(([p, v]) => ['--set', quoted(`${p}=${v}`)])].join(' ');
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
$('line').onclick = () => dialog('The numbers that differ from the scene as opened, as a command line', commandLine(), false);
$('target').onsubmit = event => event.preventDefault();
$('paste').onclick = () => dialog('Text of a scene (YAML)', '', true, text => tryOpen(text, 'pasted.yaml'));
// A scene, and the tables that it refers to by their names.
const openFiles = async list => {
  const all = [...list], scene = all.find(f => /\.ya?ml$/i.test(f.name)) ?? all[0], others = all.filter(f => f !== scene);
  if (!scene) return;
  const files = await Promise.all(others.map(async f => [f.name, await f.text()]));
  await tryOpen(await scene.text(), scene.name, files.length ? Object.fromEntries(files) : undefined);
};
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
new ResizeObserver(() => { measureView(); draw3d(); }).observe($('suspension'));
// The browser compiles anew what has run often: solves that nobody waits for, until there is something to do.
const warmUp = async () => {
  for (let k = 0; k < 10 && state.info && !busy && !due; ++k) await ask('solve', {request: {...request(), points: 20}});
};

setUpView();
(async () => {
  try {
    await startWorker();
    const {text, name, files} = JSON.parse($('scene').textContent);
    await tryOpen(text, name, files);
    await warmUp();
  } catch (error) {
    trouble(error.message);
    $('state').textContent = 'the solver did not start';
  }
})();
