// ---- The hand on the drawing: hardpoints are dragged, the background turns (with Shift, or the
// right button: is shifted), the wheel and two fingers zoom. The page scrolls over the drawing
// until it is pressed.
import {$} from './base.js';
import {abandon, begin, hold, letGoOfAll, settle, state, toggleInGroup} from './state.js';
import {axesOf, draw3d, drawHandles, linkAt, view, zoomView, panView} from './view.js';
import {coordinatesOf, groupOf, movePoints} from './points.js';
import {changed, showChangeSoon, solveSoon} from './solve.js';
import {choose} from './numbers.js';

const pointers = new Map();  // pressed: id -> [x, y] in pixels of the window
// Displacement of a drag by some pixels, per axis [mm]. A view along an axis moves points in its
// plane, another view along one axis: the chosen one, or the one nearest to the first pixels. A
// pixel moves by one step of the grid at most.
const axisOf = (held, dx, dy, axes) => {
  const chosen = $('along').value;
  if (chosen !== '') return +chosen;
  const fit = k => {
    const s = [axes.right[k], -axes.up[k]], size = Math.hypot(...s);
    return size < .05 ? 0 : Math.abs(s[0] * dx + s[1] * dy) / size;
  };
  if (held.axis === undefined && Math.hypot(dx, dy) >= 4)
    held.axis = [0, 1, 2].reduce((best, k) => fit(k) > fit(best) ? k : best, 0);
  return held.axis;
};
const isPlane = axes => [0, 1, 2].some(k => Math.hypot(axes.right[k], axes.up[k]) < 1e-6);
const movedBy = (held, dx, dy, fine = false) => {
  const axes = axesOf(), step = +$('snap').value * (fine ? .1 : 1);
  const pixel = Math.min(1 / axes.scale, +$('snap').value || Infinity) * (fine ? .1 : 1);
  let d = [0, 0, 0];
  if ($('along').value === '' && isPlane(axes))
    d = add(add(d, dx * pixel, axes.right), -dy * pixel, axes.up);
  else {
    const k = axisOf(held, dx, dy, axes);
    if (k === undefined) return d;
    const s = [axes.right[k], -axes.up[k]], size = Math.hypot(...s);
    if (size > .03) d[k] = pixel * (s[0] * dx + s[1] * dy) / size;
  }
  return d.map(v => step ? Math.round(v / step) * step : v);
};
const activate = on => $('drawing').classList.toggle('active', on);

// Ends what the pointers do; a drag stays where it is, or goes back.
export const release = (back = false) => {
  const dragged = state.held?.name;
  hold(null);
  if (!dragged) return;
  back ? abandon() : settle();
  changed();
};
// The handle under the pointer; of overlapping ones the nearest.
const handleAt = ({target, clientX, clientY}) => {
  if (!target.closest('.handle')) return null;
  const away = handle => {
    const {x, y, width, height} = handle.querySelector('.hit').getBoundingClientRect();
    return Math.hypot(x + width / 2 - clientX, y + height / 2 - clientY);
  };
  return document.elementsFromPoint(clientX, clientY).map(e => e.closest('.handle'))
    .filter(Boolean).reduce((best, h) => away(h) < away(best) ? h : best);
};
const press = event => {
  if (event.button > 2) return;
  activate(true);
  pointers.set(event.pointerId, [event.clientX, event.clientY]);
  $('drawing').setPointerCapture(event.pointerId);
  if (pointers.size > 1) { release(); return; }
  const handle = handleAt(event), {clientX: x, clientY: y} = event;
  if (handle && !event.button) {
    const {name} = handle.dataset;
    handle.focus({preventScroll: true});
    if (event.ctrlKey || event.metaKey) {
      toggleInGroup(name);
      drawHandles(axesOf());
    }
    choose(name);
    hold({name, group: groupOf(name).map(n => [n, coordinatesOf(n)]), x, y});
    begin();
  } else
    hold({turn: !event.button && !event.shiftKey, x, y, yaw: view.yaw, pitch: view.pitch});
  event.preventDefault();
};
const turn3d = (held, dx, dy) => {
  view.yaw = held.yaw - dx * .4;
  view.pitch = turned(held.pitch, dy * .4);
  view.name = '';
};
const pinch = (event, before) => {
  const other = [...pointers].find(([id]) => id !== event.pointerId)[1],
        to = [event.clientX, event.clientY], [clientX, clientY] = other;
  zoomView((apart(to, other) || 1) / (apart(before, other) || 1),
    ...pointerIn($('drawing'), {clientX, clientY}));
};
const moveGroup = (group, by) => movePoints(group.map(([name, from]) => [name, add(from, 1, by)]));
// Moves what is held to the pointer.
const follow = (held, event) => {
  const by = movedBy(held, event.clientX - held.x, event.clientY - held.y, event.shiftKey);
  if (by.every((v, k) => v === (held.by?.[k] ?? 0))) return;
  held.by = by;
  moveGroup(held.group, by);
  solveSoon();
  showChangeSoon();
};
// Follows raw moves of the pointer at once; `pointermove` comes only with the next frame.
const moveAhead = event => {
  if (pointers.size === 1 && pointers.has(event.pointerId) && state.held?.name)
    follow(state.held, event);
};
const move = event => {
  const before = pointers.get(event.pointerId), {held} = state;
  if (!before) return;
  pointers.set(event.pointerId, [event.clientX, event.clientY]);
  if (pointers.size === 2) pinch(event, before);
  else if (held?.name) {
    follow(held, event);
    return;
  } else if (held?.turn) turn3d(held, event.clientX - held.x, event.clientY - held.y);
  else if (held) panView(event.clientX - before[0], event.clientY - before[1]);
  draw3d();
};
const arrows = {ArrowLeft: [-1, 0], ArrowRight: [1, 0], ArrowUp: [0, -1], ArrowDown: [0, 1]};
// One step along the axis nearest to the arrow in this view.
const nudgeBy = (name, [x, y], fine) => {
  const axes = axesOf(), step = (+$('snap').value || .1) * (fine ? .1 : 1);
  const along = $('along').value === '' ? [0, 1, 2] : [+$('along').value];
  const fit = k => x * axes.right[k] - y * axes.up[k];
  const k = along.reduce((best, i) => Math.abs(fit(i)) > Math.abs(fit(best)) ? i : best, along[0]);
  if (Math.abs(fit(k)) < 1e-6) return;
  begin();
  moveGroup(groupOf(name).map(n => [n, coordinatesOf(n)]),
    [0, 1, 2].map(i => i === k ? Math.sign(fit(k)) * step : 0));
  settle();
  changed();
};
const pressKey = event => {
  const handle = event.target.closest('.handle');
  if (!handle) return;
  const {name} = handle.dataset;
  if (event.key === 'Enter' || event.key === ' ' || arrows[event.key]) event.preventDefault();
  else return;
  choose(name);
  if (arrows[event.key]) nudgeBy(name, arrows[event.key], event.shiftKey);
};
export const makeHand = () => {
  const svg = $('drawing');
  svg.addEventListener('pointerdown', press);
  svg.addEventListener('pointermove', move);
  svg.addEventListener('pointerrawupdate', moveAhead);
  for (const end of ['pointerup', 'pointercancel'])
    svg.addEventListener(end, event => {
      pointers.delete(event.pointerId);
      release();
    });
  svg.addEventListener('pointermove', event => {
    const words = event.buttons ? '' : linkAt(...pointerIn(svg, event));
    readAt($('readout'), event, words);
  });
  svg.addEventListener('pointerleave', event => readAt($('readout'), event, ''));
  svg.addEventListener('contextmenu', event => event.preventDefault());
  svg.addEventListener('wheel', event => {
    if (!svg.classList.contains('active')) return;
    event.preventDefault();
    zoomView(Math.exp(-event.deltaY * .0015), ...pointerIn(svg, event));
    draw3d();
  }, {passive: false});
  svg.addEventListener('keydown', pressKey);
  document.addEventListener('pointerdown', event => svg.contains(event.target) || activate(false));
  document.addEventListener('keydown', event => {
    if (event.key !== 'Escape') return;
    if (state.held?.name) release(true);
    else activate(false);
  });
};
// A scene is opened: nothing is held any more.
export const letGo = () => {
  letGoOfAll();
  pointers.clear();
};
