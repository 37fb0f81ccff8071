// ---- Proofs: while nothing is moved, the points of the shown branches are proved one after the other by interval
// arithmetic (reports/live/proof.hpp). A change of a number ends it; what is proved belongs to one answer of the solver.
const proofs = {run: null, of: new Map()};  // name of a branch -> {stations, limits, claim, done}
const proofOf = branchName => proofs.run === state.now ? proofs.of.get(branchName) : undefined;
const shownBranches = () => state.branch === '' ? state.now.branches : state.now.branches.filter(b => b.name === state.branch);
let proving = 0, provePause = 0;
const resting = () => !busy && !due && !held?.name;
const isSolved = () => JSON.stringify(state.now.settings) === JSON.stringify([...state.settings]);
// Numbers that are not solved, whether they cannot be or the solver stopped, have no proof.
const dropProofs = () => {
  ++proving;
  clearTimeout(provePause);
  if (!proofs.run) return;
  proofs.run = null;
  drawCharts();
};
const prove = async () => {
  const mine = ++proving, run = state.now, more = () => mine === proving && run === state.now && resting();
  if (!run || !isSolved()) return;
  if (proofs.run !== run) Object.assign(proofs, {run, of: new Map()});
  for (const {name, points} of shownBranches()) {
    const proof = proofs.of.get(name) ?? {stations: [], limits: [], done: points === 0};
    proofs.of.set(name, proof);
    for (let count = 1; !proof.done && more();) {
      const begun = performance.now(), first = proof.stations.length;
      try {
        const {proof: found} = await ask('prove', {request: {settings: run.settings, points: allPoints, only: name}, first, count});
        proof.claim = found.claim;
        proof.stations.push(...found.stations);
        proof.limits = found.limits ?? proof.limits;
        proof.done = found.limits !== undefined;
      } catch (error) { proof.trouble = error.message; proof.done = true; }
      // some 20 ms at a time, so that a move does not wait
      count = Math.max(1, Math.min(20, Math.round(count * 20 / (performance.now() - begun + .1))));
      if (run !== state.now) return;
      drawCharts();
    }
    if (!more()) return;
  }
};
const proveSoon = () => { ++proving; clearTimeout(provePause); provePause = setTimeout(prove, 300); };

// The strip below a curve: one piece for each point, proved or not. `x`: from a parameter to the drawing.
const proofStrip = (branch, x) => {
  const wide = (W - left - right) / 41;
  return (proofOf(branch)?.stations ?? []).map(({a, answer, stable, detail}) => sketch('rect', {class: answer === 'proved' ? stable ? 'proved' : 'proved unstable' : 'unproved',
    x: px(x(a) - wide / 2 + .4), width: px(wide - .8), y: H - footroom - 2.5, height: 5},
    sketch('title', {}, `${shown(a)}: ${answer === 'proved' ? 'proved' + (stable ? ', stable' : '') : answer === 'excluded' ? 'proved to be no equilibrium' : 'not proved'}${detail ? ': ' + detail : ''}`)));
};
const power = value => minus(String(+value.toPrecision(2)).replace(/^0\.0+1$/, () => value.toExponential(0)));
// The proof of a branch in a sentence.
const proofWords = (branch, points) => {
  const proof = proofOf(branch);
  if (!proof) return isSolved() ? 'proof of the points: when nothing is moved' : 'no proof: these numbers are not solved';
  if (proof.trouble) return `not proved: ${proof.trouble}`;
  const {stations, claim, done} = proof, good = stations.filter(s => s.answer === 'proved'), bad = stations.find(s => s.answer !== 'proved');
  if (!stations.length) return done ? 'no point to prove' : 'proof of the points begins';
  const alone = Math.min(...good.map(s => s.unique_mm ?? 0)), counted = done ? `${good.length} of ${stations.length} points` : `${good.length} of ${points} points so far`;
  const parts = [`${counted} proved`];
  if (good.length) parts.push(`an equilibrium is within ${power(claim.mm)} mm and ${power(claim.deg)} deg of each` +
    (alone > 0 ? `, no other within ${shown(+alone.toPrecision(2))} mm` : '') + (good.every(s => s.stable) ? ', stable' : ', not all proved stable'));
  if (bad) parts.push(`at ${shown(bad.a)} ${branchOf(state.now, branch)?.unit ?? ''} ${bad.answer === 'excluded' ? 'proved to be no equilibrium' : 'not proved'}${bad.detail ? ': ' + bad.detail : ''}`);
  return parts.join(': ');
};
