// ---- Curves: one chart for each chosen output of the shown branch, or of every branch
import {$, make, show, shown, sketch} from './base.js';
import {
  aimAt, isChanged, isMoving, reference, referenceName, showCurves, shownBranches, state,
  stationIn, toggleLarge
} from './state.js';
import {proofStrip} from './proof.js';
import {drawNotes, stopsOf} from './notes.js';
import {saveChart} from './picture.js';
import {isLeftOut, moveTo, watchSight} from './app.js';

export const words = name => name.replaceAll('_', ' ').replace('@', ', ');
const range = curve => {
  const values = curve.map(p => p[1]).filter(Number.isFinite);
  return values.length ? [Math.min(...values), Math.max(...values)] : null;
};
const moves = curve => {
  const r = range(curve);
  return r && r[1] - r[0] > 1e-6 * Math.max(1, Math.abs(r[0]), Math.abs(r[1]));
};
// The usual figures of the branch that move, up to nine; main ones that move are added up to four.
const defaultCurves = (run, branch) => {
  const usual = state.info.branches.find(b => b.name === branch.name).usual;
  const usable = [...state.figures].filter(([, channels]) =>
    channels.some(c => ['motion', 'characteristic'].includes(c.kind) &&
      moves(run.curve(branch, c.name))));
  const list = [...new Set(usual)].filter(key => usable.some(([name]) => name === key));
  for (const [key, [{main}]] of usable)
    if (list.length < 4 && main && !list.includes(key)) list.push(key);
  return list.slice(0, 9);
};
const defaults = new WeakMap();  // of a solved branch
// The figures of a branch that have a chart, chosen by its curves in the scene as opened, so that
// the charts stay in their places during a drag.
export const curvesOf = branch => {
  const base = state.base.branch(branch.name), solved = base ?? branch;
  if (!state.curves && !defaults.has(solved))
    defaults.set(solved, defaultCurves(base ? state.base : state.now, solved));
  const names = state.curves ?? defaults.get(solved);
  return state.branch === '' && !state.curves ? names.slice(0, 3) : names;
};
// What a solve computes while a number is moved: the curves, and at the positions of drawing and
// tables all.
export const whatIsShown = () => {
  const {now} = state, list = isMoving() && now ? shownBranches() : [];
  if (!list.length) return undefined;
  const places = [...list, now.branches[0]].filter(b => b.points);
  return {
    everywhere: list.flatMap(curvesOf).flatMap(
      key => (state.figures.get(key) ?? []).map(c => c.name)),
    at: [state.station ?? 0, ...places.map(b => now.a(b, b.start))],
  };
};
const ticks = (low, high, count) => {
  const rough = (high - low) / count, size = 10 ** Math.floor(Math.log10(rough));
  const step = [1, 2, 5, 10].map(f => f * size).find(s => s >= rough * .999), list = [];
  for (let v = Math.ceil(low / step - 1e-9) * step; v <= high + 1e-9 * step; v += step)
    list.push(+v.toPrecision(12));
  return list;
};
const worst = (curve, fast) => {
  const at = new Map(fast.map(p => [p[0], p[1]])),
        off = curve.map(([a, v]) => Math.abs(at.get(a) - v));
  return Math.max(...off.filter(Number.isFinite), -1);
};
export const W = 264;
export const H = 142;
export const left = 38;
export const right = 8;
export const footroom = 28;
const headroom = 6;

// The data of one chart.
const dataOf = (branchName, name) => {
  const channels = state.figures.get(name) ?? [], now = state.now.branch(branchName),
        old = reference().branch(branchName), k = now ? stationIn(state.now, now) : 0;
  const others = [...state.variants, ...state.preview ? [state.preview] : []];
  const series = channels.map(channel => {
    const curve = state.now.curve(now, channel.name);
    return {
      channel, curve, here: curve[k], before: reference().curve(old, channel.name),
      fast: state.now.published(now, channel.name),
      variants: others.filter(v => v.run !== reference()).map(v => (
        {name: v.name, points: v.run.curve(v.run.branch(branchName), channel.name)})),
    };
  });
  const all = series.flatMap(s => [s.curve, s.before, s.fast, ...s.variants.map(v => v.points)])
    .flat().filter(p => Number.isFinite(p[1]));
  const target = state.targets.get(`${branchName}|${name}`);
  return {branchName, name, channel: channels[0], now, series, target, all};
};
// "left 1.2 · right 1.4", once where they agree; the owner of a wheel's output is before its name.
const ownerOf = ({name, figure, wheel}) =>
  wheel === null ? '' : name.slice(0, -figure.length - 1);
const valuesIn = (series, value) => {
  const texts = series.map(s => shown(value(s)));
  return texts.every(t => t === texts[0]) ? texts[0]
    : series.map((s, k) => `${ownerOf(s.channel)} ${texts[k]}`).join(' · ');
};
// The axes of a chart; cut where a pole of the figure would flatten the rest of its curve.
const scaleOf = ({all, channel, target}) => {
  const x0 = Math.min(...all.map(p => p[0])), xs = Math.max(...all.map(p => p[0])),
        x1 = xs === x0 ? x0 + 1 : xs;
  const sorted = all.map(p => p[1]).sort((a, b) => a - b),
        q = share => sorted[Math.round(share * (sorted.length - 1))];
  const ends = (target ?? []).filter(Number.isFinite);
  const whole = [Math.min(sorted[0], ...ends), Math.max(sorted.at(-1), ...ends)];
  const cut = channel?.undefined && whole[1] - whole[0] > 8 * (q(.9) - q(.1));
  let [y0, y1] = cut ? [q(.05), q(.95)] : whole;
  const least = 1e-3 * Math.max(Math.abs(y0), Math.abs(y1)) || 1e-3;
  if (y1 - y0 < least) [y0, y1] = [y0 - least, y1 + least];
  [y0, y1] = [y0 - .06 * (y1 - y0), y1 + .06 * (y1 - y0)];
  const high = y1 - y0, seen = v => Math.min(y1 + high, Math.max(y0 - high, v));
  const x = axisBetween(left, W - right, x0, x1), y = axisBetween(H - footroom, headroom, y0, y1);
  return {x, x0, x1, y0, y1, at: ([a, v]) => [x.place(a), y.place(seen(v))], cut, whole};
};
const gridOf = ({branchName, now}, {x0, x1, y0, y1, at, cut, whole}) => {
  const list = [];
  for (const v of ticks(y0, y1, 4)) {
    const y = px(at([x0, v])[1]);
    list.push(sketch('line', {class: 'grid', x1: left, x2: W - right, y1: y, y2: y}),
      sketch('text', {x: left - 4, y: +y + 3, 'text-anchor': 'end'}, shown(v)));
  }
  for (const v of ticks(x0, x1, 4)) {
    const x = px(at([v, y0])[0]);
    list.push(sketch('line', {class: 'grid', x1: x, x2: x, y1: headroom, y2: H - footroom}),
      sketch('text', {x, y: H - 17, 'text-anchor': 'middle'}, shown(v)));
  }
  const end = {x: W - right, 'text-anchor': 'end'};
  if (cut)
    list.push(
        sketch('text', {...end, y: headroom + 8}, `axis cut: ${whole.map(shown).join(' to ')}`));
  list.push(sketch('text', {...end, y: H - 4}, `${branchName} [${now?.unit ?? ''}]`));
  return list;
};
// Whether a target band is met: missed where a point lies outside, open where the branch ends
// early.
const answerTo = ({target, series, now}) => !target ? ''
  : series.some(s => s.curve.some(p => !(p[1] >= target[0] && p[1] <= target[1]))) ? 'missed'
    : series[0]?.curve.length && now?.outcome === 'converged' ? 'met' : 'open';
const targetOf = ({target}, {x0, y0, y1, at}) => {
  if (!target) return [];
  const [from, to] = [Math.max(y0, target[0]), Math.min(y1, target[1])].map(v => at([x0, v])[1]);
  return from > to ?
      [sketch(
          'rect',
          {class: 'target', x: left, width: W - left - right, y: px(to), height: px(from - to)})] :
      [];
};
const pieces = (points, at) => {
  const parts = [[]];
  for (const p of points) Number.isFinite(p[1]) ? parts.at(-1).push(at(p)) : parts.push([]);
  return parts.map(p => path(p)).join('');
};
const curvesIn = ({curve, before, fast, variants}, {at}, side) => {
  const list = [], same = new Map(fast.map(p => [p[0], p[1]]));
  for (const {name: kept, points} of variants)
    list.push(sketch('path', {class: `variant ${kept}`, d: pieces(points, at)}));
  if (isChanged()) list.push(sketch('path', {class: 'was' + side, d: pieces(before, at)}));
  const pairs = curve.filter(p => Number.isFinite(p[1]) && Number.isFinite(same.get(p[0])));
  const back = pairs.map(p => at([p[0], same.get(p[0])])).reverse();
  if (pairs.length > 1)
    list.push(sketch('path', {class: 'band', d: path([...pairs.map(at), ...back], 'Z')}),
      sketch('path', {class: 'fastline', d: pieces(fast, at)}));
  return [...list, sketch('path', {class: 'now' + side, d: pieces(curve, at)})];
};
// The second wheel of an axle is dashed.
const sideOf = k => k ? ' other' : '';
const marksIn = ({branchName, now, series}, {y0, at}) => {
  const list = [], [{curve, here}] = series;
  if (here) {
    const x = px(at(here)[0]);
    list.push(sketch('line', {class: 'here', x1: x, x2: x, y1: headroom, y2: H - footroom}));
    for (const [k, {here: [, value]}] of series.entries())
      if (Number.isFinite(value))
        list.push(sketch(
          'circle', {class: 'dot' + sideOf(k), cx: x, cy: px(at([here[0], value])[1]), r: 2.8}));
  }
  list.push(sketch('g', {class: 'proof'}, ...proofStrip(branchName, a => at([a, y0])[0])));
  for (const [a, stop, way] of now ? stopsOf(state.now, now) : [])
    list.push(sketch(
        'path', {class: 'stop', d: `M${px(at([a, y0])[0])},${H - footroom - 6}l4,6h-8Z`},
        sketch('title', {}, `${stop} ${way} near ${shown(a)} ${now.unit}`)));
  if (now && now.outcome !== 'converged' && curve.length)
    for (const p of [curve[0], curve.at(-1)].filter(
             p => Number.isFinite(p[1]) && !onEnd(branchName, p[0])))
      list.push(sketch(
          'circle', {class: 'end', cx: px(at(p)[0]), cy: px(at(p)[1]), r: 3.5},
          sketch('title', {}, now.detail)));
  return list;
};
const fastWords = ({now, series, channel}) => {
  const off = Math.max(...series.map(s => worst(s.curve, s.fast)), -1);
  return !now?.published || off < 0 ? '' : off < 5e-7 ? 'published recursion: no error'
    : `published recursion off by up to ${shown(+off.toPrecision(2))} ${channel.unit}`;
};
export const scales = new Map();  // of the charts on the page, by their keys
const keyOfChart = chart => `${chart.dataset.branch}|${chart.dataset.channel}`;
const button = (kind, text, title, label, onclick) =>
  sketch('button', {type: 'button', class: kind, title, 'aria-label': label, onclick}, text);
const sidesOf = series => series.length < 2 ? []
  : series.map((s, k) => sketch(
    'span', {class: 'side'}, sketch('i', {class: 'key now' + sideOf(k)}), ownerOf(s.channel)));
const footOf = data => {
  const {name, branchName, series} = data, key = `${branchName}|${name}`;
  return sketch(
      'p', {class: 'fast'}, ...sidesOf(series), sketch('span', {}, fastWords(data)),
      button(
          'shot', 'PNG', 'As a picture', `Picture of ${name} on ${branchName}`,
          event => saveChart(event.target.closest('.chart'))),
      button(
          'enlarge', state.large === key ? 'smaller' : 'larger', 'Enlarge',
          `Enlarge ${name} on ${branchName}`, () => enlarge(key)),
      button(
          'aim', 'target', 'Target band', `Target band of ${name} on ${branchName}`,
          () => editTarget(name, branchName)));
};
const verdicts = {met: 'the whole branch lies in the band', missed: 'a point lies out of the band',
  open: 'in the band, but the branch ends early'};
const chartOf = (branchName, name) => {
  const data = dataOf(branchName, name), {channel, series, all} = data,
        key = `${branchName}|${name}`, verdict = answerTo(data);
  const title = words(name) + (state.branch === '' ? ' · ' + branchName : '');
  const kind =
      ['chart', ...verdict ? [verdict] : [], ...state.large === key ? ['large'] : []].join(' ');
  const figure = sketch(
      'div',
      {class: kind, 'data-channel': name, 'data-branch': branchName, 'data-solve': state.now.id},
      sketch(
          'h3', {title: [channel?.definition ?? '', verdicts[verdict] ?? ''].join('\n').trim()},
          sketch('span', {}, title),
          sketch(
              'span', {class: 'value'}, series[0]?.here ?
                `${valuesIn(series, s => s.here[1])} ${channel.unit}` : '–')));
  scales.delete(key);
  if (!all.length) {
    figure.children.push(
        sketch('p', {class: 'fast'}, 'not computed, or without a value on this branch'));
    return figure;
  }
  const scale = scaleOf(data);
  scales.set(key, {...scale, ...data});
  const inner = sketch(
      'svg', {
        x: left,
        y: 0,
        width: W - left - right,
        height: H - footroom + 3,
        viewBox: `${left} 0 ${W - left - right} ${H - footroom + 3}`
      },
      ...targetOf(data, scale), ...series.flatMap((s, k) => curvesIn(s, scale, sideOf(k))),
      ...marksIn(data, scale));
  figure.children.push(
      sketch(
          'svg',
          {viewBox: `0 0 ${W} ${H}`, role: 'img', 'aria-label': `${name} over ${branchName}`},
          ...gridOf(data, scale), inner),
      footOf(data));
  return figure;
};
// The target band of one curve.
const editTarget = (name, branchName) => {
  const form = $('target'), key = `${branchName}|${name}`,
        given = state.targets.get(key) ?? [-Infinity, Infinity];
  const entries = [form.elements.low, form.elements.high];
  form.hidden = false;
  form.querySelector('span').textContent =
      `target of ${name} on ${branchName} [${state.figures.get(name)[0].unit}]`;
  entries.forEach((entry, k) => {
    entry.value = Number.isFinite(given[k]) ? given[k] : '';
    entry.oninput = () => {
      const ends = entries.map(
          (e, i) => e.value.trim() === '' ? [-Infinity, Infinity][i] : +e.value.trim());
      entries.forEach(
          (e, i) =>
              e.setAttribute('aria-invalid', String(Number.isNaN(ends[i]) || ends[0] > ends[1])));
      if (ends.some(Number.isNaN) || ends[0] > ends[1]) return;
      aimAt(key, ends.some(Number.isFinite) ? ends : null);
      drawCharts();
    };
  });
  form.querySelector('button').onclick = () => {
    aimAt(key, null);
    form.hidden = true;
    drawCharts();
  };
  entries[0].focus();
};
const enlarge = key => {
  toggleLarge(key);
  drawCharts();
};
// Whether a parameter is an end of the branch as the scene gives it.
const onEnd = (branchName, a) => {
  const b = state.info.branches.find(entry => entry.name === branchName);
  return b && [b.from, b.to].some(end => Math.abs(a - end) <= 1e-9 * Math.max(1, Math.abs(end)));
};
let drawnCharts = [];
export const drawCharts = () => {
  if (!state.now) return;
  const list = shownBranches().flatMap(branch => curvesOf(branch).map(key => [branch.name, key])),
        {children} = $('charts'), same = list.length === children.length;
  drawnCharts = list.map(
      (chart, k) => same && isLeftOut(children[k]) ? drawnCharts[k] : chartOf(...chart));
  show($('charts'), ...drawnCharts);
  for (const chart of children) watchSight(chart);
  drawNotes();
};

// ---- The pointer on a chart: the values there, and with a click the position
const pointed = event => {
  const svg = event.target.closest('#charts .chart > svg'),
        scale = svg && scales.get(keyOfChart(svg.closest('.chart')));
  if (!scale) return null;
  const [x] = pointerIn(svg, event);
  return scale.x.has(x) ? {...scale, svg, a: scale.x.value(x)} : null;
};
const nearest = (curve, a) => curve.reduce(
    (best, p) => Math.abs(p[0] - a) < Math.abs(best[0] - a) ? p : best, [Infinity, NaN]);
const readOut = event => {
  const there = pointed(event), line = $('cursor');
  line.hidden = !there?.series[0].curve.length;
  if (line.hidden) { readAt($('readout'), event, ''); return; }
  const {svg, at, y0} = there, box = svg.getBoundingClientRect(), size = box.width / W;
  const {series, channel, now} = there, [a] = nearest(series[0].curve, there.a);
  const [b] = nearest(series[0].before, a),
            same = isChanged() && Math.abs(a - b) <= 1e-9 * Math.max(1, Math.abs(a));
  line.style.left = `${box.left + size * at([a, y0])[0]}px`;
  line.style.top = `${box.top + size * headroom}px`;
  line.style.height = `${size * (H - headroom - footroom)}px`;
  readAt($('readout'), event, `${shown(a)} ${now.unit}: ` +
      `${valuesIn(series, s => nearest(s.curve, a)[1])} ${channel.unit}` +
      (same ? `, ${referenceName()} ${valuesIn(series, s => nearest(s.before, a)[1])}` : ''));
};
export const makeCharts = () => {
  $('charts').addEventListener('pointermove', readOut);
  $('charts').addEventListener('pointerleave', event => {
    $('cursor').hidden = true;
    readAt($('readout'), event, '');
  });
  addEventListener('scroll', () => { $('cursor').hidden = true; }, {passive: true});
  $('charts').addEventListener('click', event => {
    const there = pointed(event);
    if (there) moveTo(there.branchName, there.a);
  });
};

// ---- Which curves: sets chosen together, a list to search
const isPushed = c =>
    /force|torque/.test(c.cause);  // by a force or moment in the plane of the road
const isAngle = c => c.unit.startsWith('deg') && (c.kind === 'motion' ? c.main || c.at_rest
  : c.kind === 'characteristic' && !isPushed(c));
const presets = {
  'usual curves': () => false,
  'steering and camber': isAngle,
  'compliance': c => c.kind === 'characteristic' && isPushed(c),
  'forces of bushings': c => c.kind === 'element' && /\.elastic_force_[xyz]$/.test(c.name),
  'moments of bushings': c => c.kind === 'element' && /\.elastic_moment_[xyz]$/.test(c.name),
  'forces of springs, stops and links': c =>
      c.kind === 'element' && c.unit === 'N' && !/elastic_force/.test(c.name),
};
const keysOf = channels => [...state.figures].filter(
  ([, list]) => list.some(c => channels.includes(c))).map(([key]) => key);
const chooseCurves = list => {
  showCurves(list);
  drawCharts();
};
export const makeChoice = () => {
  const box = $('choose').querySelector('div');
  box.replaceChildren(...[...state.figures].map(([key, [{definition, unit}]]) => {
    const tick = make('input', {type: 'checkbox', value: key});
    tick.onchange = () =>
        chooseCurves([...box.querySelectorAll('input:checked')].map(t => t.value));
    return make('label', {title: definition}, tick, `${key} [${unit}]`);
  }));
  $('preset').selectedIndex = 0;
};
$('preset').replaceChildren(
    ...Object.keys(presets).map(name => make('option', {value: name}, name)));
export const choosePreset = () => {
  const chosen = state.info?.channels.filter(presets[$('preset').value]) ?? [];
  if (!chosen.length) $('preset').selectedIndex = 0;
  chooseCurves(keysOf(chosen));
};
$('choose').addEventListener('toggle', () => {
  if (!$('choose').open || !state.now) return;
  const list = shownBranches().flatMap(curvesOf);
  for (const tick of $('choose').querySelectorAll('input[type=checkbox]'))
    tick.checked = list.includes(tick.value);
});
$('search').oninput = () => {
  const word = $('search').value.trim().toLowerCase().replaceAll(' ', '_');
  for (const label of $('choose').querySelectorAll('div label'))
    label.hidden = !label.textContent.toLowerCase().includes(word);
};
$('target').onsubmit = event => event.preventDefault();
