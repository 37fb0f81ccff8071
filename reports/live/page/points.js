// ---- Hardpoints: their coordinates in mm; those of the other side of a mirrored axle; groups
// that move together; lengths that a drag keeps.
import {pageUnit, written} from './base.js';
import {numberOf, put, state, toggleLength} from './state.js';

// Points of the other side have no numbers of their own: name -> the point that they mirror.
export const images = new Map();
const hasNumbers = name =>
  ['x', 'y', 'z'].every(axis => state.numbers.has(`points.${name}.${axis}`));
export const findImages = () => {
  images.clear();
  if (!/^mirror:/m.test(state.source)) return;
  const {points} = state.info, own = points.filter(p => hasNumbers(p.name));
  for (const {name, at: [x, y, z]} of points.filter(p => !hasNumbers(p.name))) {
    const twin = own.find(
      ({at}) => Math.max(Math.abs(at[0] - x), Math.abs(at[1] + y), Math.abs(at[2] - z)) < 1e-6);
    if (twin) images.set(name, twin.name);
  }
};
export const movable = () =>
  state.info.points.map(p => p.name).filter(name => hasNumbers(name) || images.has(name));
const twinOf = name => images.get(name) ?? name;
const sign = (name, k) => k === 1 && images.has(name) ? -1 : 1;
export const paths = name => [0, 1, 2].map(k => `points.${twinOf(name)}.${'xyz'[k]}`);
export const mm = path => pageUnit(state.numbers.get(path).unit)[1];
export const coordinatesOf = name =>
  paths(name).map((p, k) => sign(name, k) * numberOf(p) * mm(p));
export const isMoved = name => paths(name).some(p => state.settings.has(p));
export const putCoordinates = (name, coordinates) => paths(name).forEach((p, k) => {
  const value = sign(name, k) * coordinates[k];
  if (Math.abs(value - numberOf(p) * mm(p)) > 1e-9) put(p, written(value / mm(p)));
});

// ---- Groups: what moves with a point, each number once
export const groupOf = name => {
  const list = state.group.includes(name) ? [name, ...state.group] : [name];
  return list.filter((n, k) => list.findIndex(other => twinOf(other) === twinOf(n)) === k);
};

// ---- Links between hardpoints, and lengths that stay
export const linksAt = name => {
  const {links = [], points = []} = state.now?.drawing ?? {}, seen = new Set();
  return links.flatMap(({name: link, points: ends}) => {
    const [a, b] = ends.map(i => points[i].name), other = a === name ? b : b === name ? a : null;
    if (other === null || seen.has(other) || !movable().includes(other)) return [];
    seen.add(other);
    return [{link, other, length: apart(coordinatesOf(name), coordinatesOf(other))}];
  });
};
const keyOfLock = (a, b) => [twinOf(a), twinOf(b)].sort().join('|');
export const isLocked = (a, b) => state.locks.has(keyOfLock(a, b));
export const toggleLock = (a, b) =>
  toggleLength(keyOfLock(a, b), apart(coordinatesOf(a), coordinatesOf(b)));
// Moves points [[name, coordinates], ...]; one end of a locked length goes to the nearest place at
// that length from the other end.
export const movePoints = places => {
  const moving = new Set(places.map(([name]) => twinOf(name)));
  for (const [name, wanted] of places) {
    let at = wanted;
    const held = linksAt(name).filter(
      ({other}) => isLocked(name, other) && !moving.has(twinOf(other)));
    for (let round = 0; round < (held.length > 1 ? 50 : 1); ++round)
      for (const {other} of held) {
        const centre = coordinatesOf(other), length = state.locks.get(keyOfLock(name, other));
        at = add(centre, length / (apart(at, centre) || 1), add(at, -1, centre));
      }
    putCoordinates(name, at);
  }
};
