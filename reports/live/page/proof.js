// ---- Proofs: while nothing is moved, the points of the shown branches are proved one after the
// other by interval arithmetic (reports/live/proof.hpp). A change of a number ends it; what is
// proved belongs to one run.
import {shown, sketch} from './base.js';
import {isSolved, shownBranches, state} from './state.js';
import {solvers} from './solver.js';
import {allPoints, requestOf} from './solve.js';
import {drawCharts, footroom, H, left, right, W} from './charts.js';

// branches: name of a branch -> {stations, limits, claim, done}
const proofs = {run: null, branches: new Map()};
export const proofOf = branchName =>
  proofs.run === state.now && isSolved() && !state.failure ? proofs.branches.get(branchName)
    : undefined;
// Numbers that are not solved, whether they cannot be or the solver stopped, have no proof.
export const dropProofs = () => {
  if (!proofs.run) return;
  proofs.run = null;
  drawCharts();
};
export const prove = async more => {
  const run = state.now;
  if (!run || !isSolved() || state.failure) return;
  if (proofs.run !== run) Object.assign(proofs, {run, branches: new Map()});
  for (const {name, points} of shownBranches()) {
    const proof = proofs.branches.get(name) ?? {stations: [], limits: [], done: points === 0};
    proofs.branches.set(name, proof);
    // some 20 ms at a time, so that a move does not wait
    for (let count = 1; !proof.done && more();) {
      const begun = performance.now();
      await proveSome(proof, requestOf(run.settings, name), count);
      count = Math.max(1, Math.min(20, Math.round(count * 20 / (performance.now() - begun + .1))));
      if (run !== state.now || proofs.run !== run) return;
      drawCharts();
    }
    if (!more()) return;
  }
};
const proveSome = async (proof, request, count) => {
  try {
    const {proof: found} =
        await solvers.back.ask('prove', {request, first: proof.stations.length, count});
    proof.claim = found.claim;
    proof.stations.push(...found.stations);
    proof.limits = found.limits ?? proof.limits;
    proof.done = found.limits !== undefined;
  } catch (error) { Object.assign(proof, {trouble: error.message, done: true}); }
};

// The strip below a curve: one piece for each point, proved or not. `x`: from a parameter to the
// drawing.
export const proofStrip = (branch, x) => {
  const wide = (W - left - right) / (allPoints + 1);
  return (proofOf(branch)?.stations ?? [])
      .map(
          ({a, answer, stable, detail}) => sketch(
              'rect', {
                class: answer === 'proved' ? stable ? 'proved' : 'proved unstable' : 'unproved',
                x: px(x(a) - wide / 2 + .4),
                width: px(wide - .8),
                y: H - footroom - 2.5,
                height: 5
              },
              sketch(
                  'title', {},
                  `${shown(a)}: ${
                      answer === 'proved'       ? 'proved' + (stable ? ', stable' : '') :
                          answer === 'excluded' ? 'proved to be no equilibrium' :
                                                  'not proved'}${detail ? ': ' + detail : ''}`)));
};
const power = value =>
    minus(String(+value.toPrecision(2)).replace(/^0\.0+1$/, () => value.toExponential(0)));
// The proof of a branch in a sentence.
export const proofWords = (branch, points) => {
  const proof = proofOf(branch);
  if (!proof)
    return isSolved() && !state.failure ? 'proof of the points: when nothing is moved' :
                                          'no proof: these numbers are not solved';
  if (proof.trouble) return `not proved: ${proof.trouble}`;
  const {stations, claim, done} = proof, good = stations.filter(s => s.answer === 'proved'),
                          bad = stations.find(s => s.answer !== 'proved');
  if (!stations.length) return done ? 'no point to prove' : 'proof of the points begins';
  const alone = Math.min(...good.map(s => s.unique_mm ?? 0)),
        counted = done ? `${good.length} of ${stations.length} points` :
                         `${good.length} of ${points} points so far`;
  const parts = [`${counted} proved`];
  if (good.length)
    parts.push(
        `an equilibrium is within ${power(claim.mm)} mm and ${power(claim.deg)} deg of each` +
        (alone > 0 ? `, no other within ${shown(+alone.toPrecision(2))} mm` : '') +
        (good.every(s => s.stable) ? ', stable' : ', not all proved stable'));
  if (bad)
    parts.push(`at ${shown(bad.a)} ${state.now.branch(branch)?.unit ?? ''} ${
        bad.answer === 'excluded' ? 'proved to be no equilibrium' :
                                    'not proved'}${bad.detail ? ': ' + bad.detail : ''}`);
  return parts.join(': ');
};
