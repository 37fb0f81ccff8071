// ---- Notes on the shown branches: early ends, stops that close, motions that nothing resists, the state of the proof
// Where stops close or open on the way out from the start: [[parameter, name, 'closes' or 'opens'], ...]. Between two
// points by the deflection at which the force, extrapolated from the next two closed points, is zero.
const stopsOf = (run, branch) => run.channels.filter(name => /\.(bump|rebound)(_stop)?\.force$/.test(name)).flatMap(name => {
  const force = run.curve(branch, name), depth = run.curve(branch, name.replace(/force$/, 'deflection')), closed = force.map(p => Math.abs(p[1]) > 1e-6);
  return force.flatMap(([a], k) => {
    if (!k || closed[k] === closed[k - 1]) return [];
    const [open, shut] = closed[k] ? [k - 1, k] : [k, k - 1], next = 2 * shut - open;
    let at = force[shut][0];
    if (closed[next]) {
      const touch = depth[shut][1] - force[shut][1] * (depth[next][1] - depth[shut][1]) / (force[next][1] - force[shut][1]);
      const share = (touch - depth[open][1]) / (depth[shut][1] - depth[open][1]);
      if (share >= 0 && share <= 1) at = force[open][0] + share * (at - force[open][0]);
    }
    return [[at, name.slice(0, -6), at > 0 === closed[k] ? 'closes' : 'opens']];
  });
});
const bothOf = (branchName, list) => [list(state.now, branchOf(state.now, branchName)), state.base && state.base !== state.now ? list(state.base, branchOf(state.base, branchName)) : null];
const endWords = branch => !branch ? '' : branch.outcome === 'converged' ? 'reached its end' : `${branch.outcome}: ${branch.detail}`;
const drawNotes = () => {
  if (!state.now) return;
  const shown_ = shownBranches(), lines = [], ended = [];
  const say = (kind, text) => lines.push(make('li', {class: kind}, text));
  for (const branch of shown_) {
    const old = branchOf(state.base, branch.name), named = state.branch === '' ? `${branch.name}: ` : '';
    if (branch.outcome !== 'converged') {
      let text = `${branch.name}: ${endWords(branch)}`;
      if (old && state.base !== state.now && endWords(old) !== endWords(branch)) text += `; as opened: ${endWords(old)}`;
      for (const limit of proofOf(branch.name)?.limits ?? [])
        text += limit.answer === 'proved' ? `\nlimit point proved: its parameter is between ${minus(limit.from.toPrecision(12))} and ${minus(limit.to.toPrecision(12))} ${branch.unit}`
          : `\nlimit point not proved${limit.detail ? ': ' + limit.detail : ''}`;
      ended.push(text);
    } else if (old && old.outcome !== 'converged') say('', `${named}reaches its end; as opened: ${endWords(old)}`);
    const [stops, before] = bothOf(branch.name, stopsOf);
    const earlier = new Map((before ?? []).map(([a, name, way]) => [`${name} ${way}`, a])), seen = new Set();
    for (const [a, name, way] of stops) {
      const key = `${name} ${way}`, was = earlier.get(key);
      seen.add(key);
      say('stop', `${named}${key} near ${shown(a)} ${branch.unit}` + (!before ? '' : was === undefined ? ', as opened not on this branch' : Math.abs(was - a) > 1e-6 ? `, as opened near ${shown(was)}` : ''));
    }
    for (const [key, a] of earlier) if (!seen.has(key)) say('stop', `${named}as opened ${key} near ${shown(a)} ${branch.unit}, now not on this branch`);
    const idle = branch.idle ?? [], usual = old?.idle ?? [];
    for (const text of idle) say('idle', `${named}idle motion, which nothing resists: ${text}${usual.includes(text) ? '' : ' (not as opened)'}`);
    for (const text of usual) if (!idle.includes(text)) say('idle', `${named}no idle motion any more: ${text}`);
    say('proof', (proofOf(branch.name) ? named : '') + proofWords(branch.name, branch.points));
  }
  // Notes that all branches share are said once.
  const texts = new Map();
  for (const line of lines) texts.set(line.textContent, line);
  $('notes').replaceChildren(...texts.values());
  $('ending').hidden = !ended.length;
  $('ending').textContent = ended.join('\n');
};
