// ---- Geometry behind the figures, in the drawing: the road, steering axes, instant centres and
// the roll centre with the lines from the patches (points_of_figures() of the catalogue).
import {state} from './state.js';

const ofWheel = ['lower', 'upper', 'front', 'side'];
const isFinite = p => p.every(Number.isFinite);
// The road below the wheels: a line from the side, else a rectangle around the drawing.
const roadOf = (run, branch, k, {flat, axes, wide}) => {
  const patches = run.drawing.wheels.map(w => run.point(branch, k, w.patch));
  if (!patches.length) return '';
  const z = Math.min(...patches.map(p => p[2]));
  if (Math.abs(axes.up[2]) > .999) {
    const y = px(flat([0, 0, z])[1]);
    return `<path class="road" d="M0,${y}H${px(wide)}"/>`;
  }
  const all = run.drawing.points.map((_, i) => run.point(branch, k, i));
  const ends = i => {
    const list = [...all, ...patches].map(p => p[i]);
    return [Math.min(...list) - 60, Math.max(...list) + 60];
  };
  const [x0, x1] = ends(0), [y0, y1] = ends(1);
  const corners = [[x0, y0], [x1, y0], [x1, y1], [x0, y1]].map(([x, y]) => flat([x, y, z]));
  return `<path class="road" d="${path(corners, 'Z')}"/>`;
};
const lineOf = (kind, a, b, {flat}) =>
  `<path class="guide ${kind}" d="${path([flat(a), flat(b)])}"/>`;
const markOf = (kind, words, at, {flat, wide}) => {
  const [x, y] = flat(at), [sx, sy] = [px(x), px(y)];
  if (x < 0 || x > wide) return '';
  return `<g class="guide ${kind}"><circle cx="${sx}" cy="${sy}" r="4"/>` +
    `<path d="M${px(x - 7)},${sy}h14M${sx},${px(y - 7)}v14"/>` +
    `<text x="${px(x + 9)}" y="${px(y + 4)}">${words}</text></g>`;
};
// The steering axis from above its upper end to the road.
const steeringAxis = ({lower, upper}, patch, sheet) => {
  if (!isFinite(lower) || !isFinite(upper)) return '';
  const along = add(upper, -1, lower), down = (patch[2] - lower[2]) / along[2];
  if (!(Math.abs(down) < 10)) return '';
  return lineOf('kingpin', add(upper, .25, along), add(lower, down, along), sheet);
};
const centreOf = (at, words, patch, sheet) => !isFinite(at) ? ''
  : lineOf('instant', patch, at, sheet) + markOf('instant', words, at, sheet);
// `sheet`: how a point is drawn ({flat, axes, wide}).
export const guides = (run, branch, k, sheet) => {
  const parts = [roadOf(run, branch, k, sheet)], {axes} = sheet;
  if (!state.guides || !run.drawing.wheels.length) return parts.join('');
  const fromFront = axes.right[1] ** 2 > .5, upright = axes.up[2] > .5;
  const roll = run.guide(branch, k, ofWheel.length * run.drawing.wheels.length);
  run.drawing.wheels.forEach((wheel, w) => {
    const points = Object.fromEntries(ofWheel.map((name, i) =>
      [name, run.guide(branch, k, ofWheel.length * w + i)]));
    const patch = run.point(branch, k, wheel.patch);
    parts.push(steeringAxis(points, patch, sheet));
    if (!upright) return;
    const seen = fromFront ? points.front : points.side;
    parts.push(centreOf(seen, 'instant centre', patch, sheet));
    if (fromFront && isFinite(roll)) parts.push(lineOf('roll', patch, roll, sheet));
  });
  if (fromFront && upright && isFinite(roll))
    parts.push(markOf('roll', 'roll centre', roll, sheet));
  return parts.join('');
};
