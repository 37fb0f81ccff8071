// ---- Notes on the shown branches: early ends, stops that close, motions that nothing resists,
// the state of the proof
import {$, show, shown, sketch, write} from './base.js';
import {isChanged, reference, referenceName, shownBranches, state} from './state.js';
import {proofOf, proofWords} from './proof.js';

// Where stops close or open on the way out from the start: [[parameter, name, 'closes' or
// 'opens'], ...]. Between two points by the deflection at which the force, extrapolated from the
// next two closed points, is zero.
export const stopsOf = (run, branch) =>
    run.channels.filter(name => /\.(bump|rebound)(_stop)?\.force$/.test(name)).flatMap(name => {
      const force = run.curve(branch, name),
            depth = run.curve(branch, name.replace(/force$/, 'deflection')),
            closed = force.map(p => Math.abs(p[1]) > 1e-6);
      return force.flatMap(([a], k) => {
        if (!k || closed[k] === closed[k - 1]) return [];
        const [open, shut] = closed[k] ? [k - 1, k] : [k, k - 1], next = 2 * shut - open;
        let at = force[shut][0];
        if (closed[next]) {
          const touch = depth[shut][1] -
              force[shut][1] * (depth[next][1] - depth[shut][1]) /
                  (force[next][1] - force[shut][1]);
          const share = (touch - depth[open][1]) / (depth[shut][1] - depth[open][1]);
          if (share >= 0 && share <= 1) at = force[open][0] + share * (at - force[open][0]);
        }
        return [[at, name.slice(0, -6), at > 0 === closed[k] ? 'closes' : 'opens']];
      });
    });
const endWords = branch => !branch ? '' :
    branch.outcome === 'converged' ? 'reached its end' :
                                     `${branch.outcome}: ${branch.detail}`;
const limitWords = ({answer, from, to, detail}, unit) => answer === 'proved' ?
    `\nlimit point proved: its parameter is between ${minus(from.toPrecision(12))} and ${
        minus(to.toPrecision(12))} ${unit}` :
    `\nlimit point not proved${detail ? ': ' + detail : ''}`;
const earlyEnd = (branch, old) => {
  const before =
      old && endWords(old) !== endWords(branch) ? `; ${referenceName()}: ${endWords(old)}` : '';
  const limits = proofOf(branch.name)?.limits ?? [];
  return `${branch.name}: ${endWords(branch)}${before}${
      limits.map(l => limitWords(l, branch.unit)).join('')}`;
};
// [[class, text], ...]
const stopNotes = (branch, old, named) => {
  const earlier = new Map(
      (old ? stopsOf(reference(), old) : []).map(([a, name, way]) => [`${name} ${way}`, a]));
  const notes = stopsOf(state.now, branch).map(([a, name, way]) => {
    const key = `${name} ${way}`, was = earlier.get(key);
    earlier.delete(key);
    const before = !old ? '' : was === undefined ? `, ${referenceName()} not on this branch`
      : Math.abs(was - a) > 1e-6 ? `, ${referenceName()} near ${shown(was)}` : '';
    return ['stop', `${named}${key} near ${shown(a)} ${branch.unit}${before}`];
  });
  for (const [key, a] of earlier)
    notes.push([
      'stop',
      `${named}${referenceName()} ${key} near ${shown(a)} ${branch.unit}, now not on this branch`
    ]);
  return notes;
};
const idleNotes = (branch, old, named) => {
  const idle = branch.idle ?? [], usual = old?.idle ?? idle;
  return [
    ...idle.map(
        text =>
            ['idle',
             `${named}idle motion, which nothing resists: ${text}${
                 usual.includes(text) ? '' : ` (not ${referenceName()})`}`]),
    ...usual.filter(text => !idle.includes(text))
        .map(text => ['idle', `${named}no idle motion any more: ${text}`])
  ];
};
export const drawNotes = () => {
  if (!state.now) return;
  const notes = [], ended = [];
  for (const branch of shownBranches()) {
    const named = state.branch === '' ? `${branch.name}: ` : '',
          old = isChanged() ? reference().branch(branch.name) : null;
    if (branch.outcome !== 'converged') ended.push(earlyEnd(branch, old));
    else if (old && old.outcome !== 'converged')
      notes.push(['', `${named}reaches its end; ${referenceName()}: ${endWords(old)}`]);
    notes.push(...stopNotes(branch, old, named), ...idleNotes(branch, old, named));
    notes.push(
        ['proof', (proofOf(branch.name) ? named : '') + proofWords(branch.name, branch.points)]);
  }
  // Notes that all branches share are said once.
  const texts = new Map(notes.map(([kind, text]) => [text, kind]));
  show($('notes'), ...[...texts].map(([text, kind]) => sketch('li', {class: kind}, text)));
  $('ending').hidden = !ended.length;
  write($('ending'), ended.join('\n'));
};
