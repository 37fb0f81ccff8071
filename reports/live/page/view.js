// ---- The drawing: orthographic, of the shown station, with the suspension as opened in pale lines
const views = {Oblique: [38, 24], Front: [0, 0], Side: [90, 0], Top: [180, 90]};  // about z, above [deg]
const view = {yaw: 38, pitch: 24, zoom: 1, centre: [0, 0, 0], size: 1, wide: 640, high: 460, name: 'Oblique'};
const axesOf = () => {
  const a = view.yaw * Math.PI / 180, b = view.pitch * Math.PI / 180;
  return {right: [-Math.sin(a), Math.cos(a), 0],
          up: [-Math.cos(a) * Math.sin(b), -Math.sin(a) * Math.sin(b), Math.cos(b)],
          scale: view.zoom * .8 * Math.min(view.wide, view.high) / view.size};
};
const flat = (p, {right, up, scale}) => {
  const d = add(p, -1, view.centre);
  return [view.wide / 2 + scale * dot(d, right), view.high / 2 - scale * dot(d, up)];
};
const tyresOf = (run, branch, k) => run.drawing.wheels.map((wheel, index) =>
  tyre(run.point(branch, k, wheel.centre), run.point(branch, k, wheel.patch), run.spin(branch, k, index)));
const fitView = run => {
  const branch = run.branches[0], all = [];
  if (!branch || !branch.points) return;
  for (let i = 0; i < run.drawing.points.length; ++i) all.push(run.point(branch, branch.start, i));
  all.push(...tyresOf(run, branch, branch.start).flat(2));
  const low = [0, 1, 2].map(k => Math.min(...all.map(p => p[k]))), high = [0, 1, 2].map(k => Math.max(...all.map(p => p[k])));
  view.centre = low.map((v, k) => (v + high[k]) / 2);
  view.size = Math.hypot(...low.map((v, k) => high[k] - v)) * .8 || 1;
};
const scenery = (run, branch, k, axes, was) => {
  const at = run.drawing.points.map((_, i) => flat(run.point(branch, k, i), axes));
  return was ? pale(run.drawing, at)
    : suspension(run.drawing, at, tyresOf(run, branch, k).map(edges => edges.map(edge => edge.map(p => flat(p, axes)))));
};
const triad = axes => {
  const from = [30, view.high - 30];
  return ['x', 'y', 'z'].map((name, k) => {
    const to = [from[0] + 22 * axes.right[k], from[1] - 22 * axes.up[k]];
    if (Math.hypot(to[0] - from[0], to[1] - from[1]) < 4) return '';
    return `<g class="axes">${line(path([from, to]), 6, 1.2)}<text x="${px(to[0] + 3)}" y="${px(to[1] - 2)}">${name}</text></g>`;
  }).join('');
};
// The movable hardpoints, each an element that keeps its place in the document, so that it keeps the focus.
const handles = new Map();
const drawHandles = axes => {
  const layer = $('handles');
  for (const [name, handle] of handles) {
    const [x, y] = flat(placeOf(name), axes);
    handle.setAttribute('transform', `translate(${px(x)} ${px(y)})`);
    handle.setAttribute('class', 'handle' + (state.point === name ? ' chosen' : '') + (isMoved(name) ? ' moved' : ''));
    handle.setAttribute('aria-label', `${name}: ${placeOf(name).map(v => minus(v.toFixed(1))).join(', ')} mm`);
    if (handle.parentNode !== layer) layer.append(handle);
  }
  // An arrow shows into which direction a move raises the chosen figure most, and by its length how much.
  const sums = new Map();
  for (const {point, axis, by} of state.effects ?? []) (sums.get(point) ?? sums.set(point, [0, 0, 0]).get(point))[axis] = by;
  const longest = Math.max(...[...sums.values()].map(g => Math.hypot(...g)), 0), arrows = [];
  for (const [point, g] of sums) {
    const d = [dot(g, axes.right), -dot(g, axes.up)].map(v => 60 * v / longest), size = Math.hypot(...d), [x, y] = flat(placeOf(point), axes);
    if (!(size > 3)) continue;
    const tip = [x + d[0], y + d[1]], u = d.map(v => v / size), side = s => [tip[0] - 6 * u[0] - s * 4 * u[1], tip[1] - 6 * u[1] + s * 4 * u[0]];
    arrows.push(sketch('path', {class: 'arrow', d: path([[x, y], tip]) + path([side(1), tip, side(-1)])}));
  }
  show($('arrows'), ...arrows);
};
const draw3d = () => {
  const svg = $('drawing'), {now, base} = state;
  if (!now) return;
  svg.setAttribute('viewBox', `0 0 ${view.wide} ${view.high}`);
  const axes = axesOf(), [branch, k] = stationOf(now);
  const layers = [];
  if (base !== now && branch) {
    const [old, j] = stationAsOpened();
    if (j >= 0) layers.push(scenery(base, old, j, axes, true));
  }
  if (branch && branch.points) layers.push(scenery(now, branch, k, axes, false));
  layers.push(triad(axes));
  $('scenery').innerHTML = layers.join('');
  drawHandles(axes);
  for (const button of $('views').children) button.setAttribute('aria-pressed', String(button.textContent === view.name));
};
// Asks for the width only where it may have changed: the answer costs a layout of the page.
const measureView = () => {
  view.wide = $('drawing').clientWidth || 640;
  view.high = Math.round(view.wide * .74);
};
const pointers = new Map();
let held = null;  // what a pointer moves: {name, from: coordinates, x, y} or {turn: true, ...}
const moved3d = (from, dx, dy) => {
  const axes = axesOf(), along = $('along').value, step = +$('snap').value;
  let d = [0, 0, 0];
  if (along === '') d = add(add(d, dx / axes.scale, axes.right), -dy / axes.scale, axes.up);
  else {
    const s = [axes.right[along] * axes.scale, -axes.up[along] * axes.scale], size = dot(s, s);
    if (size > 1e-3 * axes.scale ** 2) d[along] = (s[0] * dx + s[1] * dy) / size;
  }
  return from.map((v, k) => Math.abs(d[k]) < 1e-9 ? v : step ? v + Math.round(d[k] / step) * step : v + d[k]);
};
const setUpView = () => {
  const svg = $('drawing');
  measureView();
  svg.append(make('g', {id: 'scenery'}), make('g', {id: 'arrows'}), make('g', {id: 'handles'}));
  for (const name of Object.keys(views)) {
    const button = make('button', {type: 'button'}, name);
    button.onclick = () => { [view.yaw, view.pitch] = views[name]; view.name = name; draw3d(); };
    $('views').append(button);
  }
  svg.addEventListener('pointerdown', event => {
    if (event.button) return;
    pointers.set(event.pointerId, [event.clientX, event.clientY]);
    svg.setPointerCapture(event.pointerId);
    const handle = event.target.closest('.handle');
    if (handle) {
      handle.focus({preventScroll: true});
      choose(handle.dataset.name);
      held = {name: handle.dataset.name, from: coordinatesOf(handle.dataset.name), x: event.clientX, y: event.clientY};
      remember();
    } else held = {turn: true, x: event.clientX, y: event.clientY, yaw: view.yaw, pitch: view.pitch};
    event.preventDefault();
  });
  svg.addEventListener('pointermove', event => {
    if (!pointers.has(event.pointerId)) return;
    const before = pointers.get(event.pointerId);
    if (pointers.size === 2) {  // two fingers zoom
      const other = [...pointers].find(([id]) => id !== event.pointerId)[1];
      const apart = p => Math.hypot(p[0] - other[0], p[1] - other[1]) || 1;
      view.zoom = Math.min(20, Math.max(.2, view.zoom * apart([event.clientX, event.clientY]) / apart(before)));
      held = null;
      draw3d();
    } else if (held?.turn) {
      view.yaw = held.yaw - (event.clientX - held.x) * .4;
      view.pitch = Math.max(-90, Math.min(90, held.pitch + (event.clientY - held.y) * .4));
      view.name = '';
      draw3d();
    } else if (held?.name) place(held.name, moved3d(held.from, event.clientX - held.x, event.clientY - held.y), true);
    pointers.set(event.pointerId, [event.clientX, event.clientY]);
  });
  for (const end of ['pointerup', 'pointercancel'])
    svg.addEventListener(end, event => { pointers.delete(event.pointerId); const dragged = held?.name; held = null; if (dragged) { settle(); changed(); } });
  svg.addEventListener('wheel', event => {
    event.preventDefault();
    view.zoom = Math.min(20, Math.max(.2, view.zoom * Math.exp(-event.deltaY * .0015)));
    draw3d();
  }, {passive: false});
  svg.addEventListener('keydown', event => {
    const handle = event.target.closest('.handle'), arrow = {ArrowLeft: [-1, 0], ArrowRight: [1, 0], ArrowUp: [0, -1], ArrowDown: [0, 1]}[event.key];
    if (!handle) return;
    if (event.key === 'Enter' || event.key === ' ') { choose(handle.dataset.name); event.preventDefault(); }
    if (!arrow) return;
    event.preventDefault();
    const name = handle.dataset.name, axes = axesOf(), step = +$('snap').value || .1, from = coordinatesOf(name);
    choose(name);
    remember();
    // one step along the axis nearest to the arrow in this view
    const along = $('along').value === '' ? [0, 1, 2] : [+$('along').value];
    const fit = k => arrow[0] * axes.right[k] - arrow[1] * axes.up[k];
    const k = along.reduce((best, i) => Math.abs(fit(i)) > Math.abs(fit(best)) ? i : best, along[0]);
    if (Math.abs(fit(k)) > 1e-6) place(name, from.map((v, i) => i === k ? v + Math.sign(fit(k)) * step : v), false);
    settle();
  });
};
const makeHandles = () => {
  handles.clear();
  $('handles').replaceChildren();
  for (const point of state.info.points) {
    if (![0, 1, 2].every(k => state.of.has(`points.${point.name}.${'xyz'[k]}`))) continue;
    const group = make('g', {tabindex: 0, role: 'button', class: 'handle'},
      make('circle', {class: 'hit', r: 13}), make('circle', {class: 'dot', r: 4.5}), make('text', {x: 8, y: -7}, point.name));
    group.dataset.name = point.name;
    handles.set(point.name, group);
  }
  $('handles').classList.toggle('many', handles.size > 14);
};
