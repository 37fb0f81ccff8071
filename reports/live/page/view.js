// ---- The drawing: orthographic, of the shown station, with the suspension as opened in pale
// lines
import {$, make, show, shown, sketch, writeAttributes} from './base.js';
import {isChanged, reference, showGuides, state, stationInReference, stationOf} from './state.js';
import {coordinatesOf, findImages, isMoved, movable} from './points.js';
import {guides} from './guides.js';

export const view = {
  yaw: 38,
  pitch: 24,
  zoom: 1,
  centre: [0, 0, 0],
  size: 1,
  wide: 640,
  high: 460,
  name: 'Oblique'
};
export const axesOf = () => ({
  ...sheetOf(view.yaw, view.pitch),
  scale: view.zoom * .8 * Math.min(view.wide, view.high) / view.size
});
const flat = (p, axes) =>
  add([view.wide / 2, view.high / 2], axes.scale, onSheet(add(p, -1, view.centre), axes));
// ---- Hardpoints where they are drawn
// Position of a hardpoint, moved with its body to the shown station.
const placeOf = name => {
  const design = coordinatesOf(name), {now} = state;
  if (!now) return design;
  const i = now.drawing.points.findIndex(p => p.name === name), [branch, k] = stationOf(now);
  if (i < 0 || !branch?.points || k === branch.start) return design;
  return add(add(design, 1, now.point(branch, k, i)), -1, now.point(branch, branch.start, i));
};
// ---- What is in sight
const tyresIn = (run, branch, k) =>
  tyresOf(run.drawing, i => run.point(branch, k, i), w => run.spin(branch, k, w));
export const fitView = run => {
  const branch = run.branches[0], all = [];
  if (!branch || !branch.points) return;
  for (let i = 0; i < run.drawing.points.length; ++i) all.push(run.point(branch, branch.start, i));
  all.push(...tyresIn(run, branch, branch.start).flat(2));
  const ends = extents(all);
  view.centre = ends.map(([low, high]) => (low + high) / 2);
  view.size = Math.hypot(...ends.map(([low, high]) => high - low)) * .8 || 1;
  view.zoom = 1;
};
// Shifts the view by pixels of the drawing.
export const panView = (dx, dy) => {
  const {right, up, scale} = axesOf();
  view.centre = add(add(view.centre, -dx / scale, right), dy / scale, up);
};
// Zooms about a place of the drawing, which stays where it is.
export const zoomView = (factor, x, y) => {
  const old = view.zoom, [fromX, fromY] = [x - view.wide / 2, y - view.high / 2];
  view.zoom = Math.min(20, Math.max(.2, old * factor));
  const grown = view.zoom / old;
  panView(fromX * (1 - grown), fromY * (1 - grown));
};
// Reads the width, which costs a layout of the page; called only where it may have changed.
const measureView = () => {
  view.wide = $('drawing').clientWidth || 640;
  view.high = Math.round(view.wide * .74);
};

const scenery = (run, branch, k, axes, was) => {
  const at = run.drawing.points.map((_, i) => flat(run.point(branch, k, i), axes));
  return was ? pale(run.drawing, at) : suspension(run.drawing, at,
    tyresIn(run, branch, k).map(edges => edges.map(edge => edge.map(p => flat(p, axes)))));
};
// The movable hardpoints, each an element that keeps its place in the document, so that it keeps
// the focus.
export const handles = new Map();
// Displacement by the drag so far, as text beside the handle.
const movedWords = name => {
  const from = state.held?.group?.find(([held]) => held === name)?.[1];
  if (!from) return '';
  const by = coordinatesOf(name).map((v, k) => v - from[k]);
  const parts = by.flatMap(
      (v, k) =>
          Math.abs(v) < 1e-9 ? [] : `${'xyz'[k]} ${v > 0 ? '+' : ''}${minus(+v.toFixed(3))}`);
  return parts.length ? ` ${parts.join(', ')} mm` : '';
};
export const drawHandles = axes => {
  const layer = $('handles');
  for (const [name, handle] of handles) {
    const place = placeOf(name), [x, y] = flat(place, axes),
          [label] = handle.querySelector('text').childNodes;
    writeAttributes(handle, {
      transform: `translate(${px(x)} ${px(y)})`,
      class: 'handle' + (state.point === name ? ' chosen' : '') +
          (isMoved(name) ? ' moved' : '') + (state.group.includes(name) ? ' grouped' : ''),
      'aria-label': `${name}: ${place.map(v => minus(v.toFixed(1))).join(', ')} mm`
    });
    const text = name + movedWords(name);
    if (label.data !== text) label.data = text;
    if (handle.parentNode !== layer) layer.append(handle);
  }
  drawArrows(axes);
};
// Gradients of the chosen figure by the positions of hardpoints, as arrows.
const drawArrows = axes => {
  const sums = new Map(), arrows = [];
  for (const {point, axis, by} of state.effects ?? []) {
    if (!sums.has(point)) sums.set(point, [0, 0, 0]);
    sums.get(point)[axis] = by;
  }
  const longest = Math.max(...[...sums.values()].map(g => Math.hypot(...g)), 0);
  for (const [point, g] of sums) {
    const d = [dot(g, axes.right), -dot(g, axes.up)].map(v => 60 * v / longest),
          size = Math.hypot(...d);
    if (!(size > 3)) continue;
    const [x, y] = flat(placeOf(point), axes), tip = [x + d[0], y + d[1]],
              u = d.map(v => v / size);
    const side = s => [tip[0] - 6 * u[0] - s * 4 * u[1], tip[1] - 6 * u[1] + s * 4 * u[0]];
    arrows.push(
        sketch('path', {class: 'arrow', d: path([[x, y], tip]) + path([side(1), tip, side(-1)])}));
  }
  show($('arrows'), ...arrows);
};
// Draws each layer of the scenery into its group, if its text has changed.
let drawnLayers = [];
const drawLayers = layers => {
  layers.forEach((text, k) => {
    if (text !== drawnLayers[k]) $('scenery').children[k].innerHTML = text;
  });
  drawnLayers = layers;
};
export const draw3d = () => {
  const svg = $('drawing'), {now} = state;
  if (!now) return;
  writeAttributes(svg, {viewBox: `0 0 ${view.wide} ${view.high}`});
  svg.dataset.solve = now.id;
  const axes = axesOf(), [branch, k] = stationOf(now);
  const [old, j] = isChanged() && branch ? stationInReference() : [null, -1];
  const axisName = (x, y, name) => `<text x="${px(x)}" y="${px(y)}">${name}</text>`;
  drawLayers([
    j < 0 ? '' : scenery(reference(), old, j, axes, true),
    branch?.points ?
      guides(now, branch, k, {flat: p => flat(p, axes), axes, wide: view.wide}) : '',
    branch?.points ? scenery(now, branch, k, axes, false) : '',
    `<g class="axes">${triad(axes, [30, view.high - 30], axisName)}</g>`]);
  drawHandles(axes);
  for (const button of $('views').children)
    writeAttributes(button, {'aria-pressed': String(button.textContent === view.name)});
};
export const makeHandles = () => {
  handles.clear();
  $('handles').replaceChildren();
  findImages();
  for (const name of movable()) {
    const group = make(
        'g', {tabindex: 0, role: 'button', class: 'handle'}, make('circle', {class: 'hit', r: 13}),
        make('circle', {class: 'dot', r: 4.5}), make('text', {x: 8, y: -7}, name));
    group.dataset.name = name;
    handles.set(name, group);
  }
  $('handles').classList.toggle('many', handles.size > 14);
};
// The link nearest to a place of the drawing, in words: its length, and its angles to the road as
// seen from the front and from the side.
export const linkAt = (x, y) => {
  const {now} = state, [branch, k] = now ? stationOf(now) : [];
  if (!branch?.points) return '';
  const axes = axesOf(), distance = ([a, b]) => {
    const d = [b[0] - a[0], b[1] - a[1]], l = d[0] ** 2 + d[1] ** 2 || 1;
    const t = Math.min(1, Math.max(0, ((x - a[0]) * d[0] + (y - a[1]) * d[1]) / l));
    return Math.hypot(x - a[0] - t * d[0], y - a[1] - t * d[1]);
  };
  let best = [7, ''];  // px, words
  for (const {name, kind, points} of now.drawing.links) {
    const ends = points.map(i => now.point(branch, k, i)),
          far = distance(ends.map(p => flat(p, axes)));
    if (kind === 'stop' || far >= best[0]) continue;
    const d = add(ends[1], -1, ends[0]);
    const angle = i => shown(Math.atan2(d[2], Math.abs(d[i])) * 180 / Math.PI);
    best = [far, `${name}: ${shown(Math.hypot(...d))} mm, ${angle(1)} deg from the front, ` +
      `${angle(0)} deg from the side`];
  }
  return best[1];
};
export const makeView = () => {
  measureView();
  $('drawing').append(
      make('g', {id: 'scenery'}, ...Array.from({length: 4}, () => make('g'))),
      make('g', {id: 'arrows'}), make('g', {id: 'handles'}));
  for (const name of Object.keys(views)) {
    const button = make('button', {type: 'button'}, name);
    button.onclick = () => { [view.yaw, view.pitch] = views[name]; view.name = name; draw3d(); };
    $('views').append(button);
  }
  $('guides').onchange = () => { showGuides($('guides').checked); draw3d(); };
  $('fit').onclick = () => { if (state.now) { fitView(state.now); draw3d(); } };
  new ResizeObserver(() => { measureView(); draw3d(); }).observe($('suspension'));
};
