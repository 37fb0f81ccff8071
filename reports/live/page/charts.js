// ---- Curves: one chart for each chosen output of the shown branch, or of every branch
const words = name => name.replaceAll('_', ' ').replace('@', ', ');
const range = curve => {
  const values = curve.map(p => p[1]).filter(Number.isFinite);
  return values.length ? [Math.min(...values), Math.max(...values)] : null;
};
const moves = curve => { const r = range(curve); return r && r[1] - r[0] > 1e-6 * Math.max(1, Math.abs(r[0]), Math.abs(r[1])); };
const defaultCurves = (run, branch) => {
  const usable = state.info.channels.filter(c => ['motion', 'characteristic'].includes(c.kind) && moves(run.curve(branch, c.name)));
  const list = usable.filter(c => c.usual).sort((a, b) => a.usual - b.usual);
  for (const channel of usable) if (list.length < 4 && channel.main && !list.includes(channel)) list.push(channel);
  return list.slice(0, 9).map(c => c.name);
};
const ticks = (low, high, count) => {
  const rough = (high - low) / count, size = 10 ** Math.floor(Math.log10(rough));
  const step = [1, 2, 5, 10].map(f => f * size).find(s => s >= rough * .999), list = [];
  for (let v = Math.ceil(low / step - 1e-9) * step; v <= high + 1e-9 * step; v += step) list.push(+v.toPrecision(12));
  return list;
};
const worst = (curve, fast) => {
  const at = new Map(fast.map(p => [p[0], p[1]]));
  let off = 0, compared = 0;
  for (const [a, v] of curve) {
    const other = at.get(a);
    if (!Number.isFinite(v) || !Number.isFinite(other)) continue;
    off = Math.max(off, Math.abs(other - v)), ++compared;
  }
  return compared ? off : NaN;
};
const W = 264, H = 142, left = 38, right = 8, headroom = 6, footroom = 28;
const chartOf = (branchName, name, withBranch) => {
  const channel = state.channel.get(name), now = branchOf(state.now, branchName), old = branchOf(state.base, branchName);
  const curve = state.now.curve(now, name), before = state.base.curve(old, name), fast = state.now.published(now, name);
  const both = [...curve, ...before, ...fast].filter(p => Number.isFinite(p[1]));
  const figure = sketch('div', {class: 'chart', 'data-channel': name, 'data-branch': branchName});
  const here = curve[stationIn(state.now, now)];
  const aim = sketch('button', {type: 'button', class: 'aim', title: 'Target band', 'aria-label': `Target band of ${name} on ${branchName}`,
    onclick: () => editTarget(name, branchName)}, 'target');
  const target = state.targets.get(`${branchName}|${name}`);
  figure.children.push(sketch('h3', {title: channel?.definition ?? ''}, sketch('span', {}, words(name) + (withBranch ? ' · ' + branchName : '')),
    sketch('span', {class: 'value'}, here ? `${shown(here[1])} ${channel?.unit ?? ''}` : '–')));
  if (!both.length) { figure.children.push(sketch('p', {class: 'fast'}, 'not computed, or without a value on this branch')); return figure; }
  let [x0, x1] = [Math.min(...both.map(p => p[0])), Math.max(...both.map(p => p[0]))];
  // A pole of a figure does not flatten the rest of its curve.
  const sorted = both.map(p => p[1]).sort((a, b) => a - b), q = share => sorted[Math.round(share * (sorted.length - 1))];
  let [y0, y1] = [sorted[0], sorted.at(-1)];
  if (target) [y0, y1] = [Math.min(y0, ...target.filter(Number.isFinite)), Math.max(y1, ...target.filter(Number.isFinite))];
  const whole = [y0, y1], cut = channel?.undefined && y1 - y0 > 8 * (q(.9) - q(.1));
  if (cut) [y0, y1] = [q(.05), q(.95)];
  const least = 1e-3 * Math.max(Math.abs(y0), Math.abs(y1)) || 1e-3;
  if (y1 - y0 < least) [y0, y1] = [y0 - least, y1 + least];
  if (x1 === x0) x1 = x0 + 1;
  [y0, y1] = [y0 - .06 * (y1 - y0), y1 + .06 * (y1 - y0)];
  const at = ([a, v]) => [left + (W - left - right) * (a - x0) / (x1 - x0), H - footroom - (H - headroom - footroom) * (Math.min(y1 + (y1 - y0), Math.max(y0 - (y1 - y0), v)) - y0) / (y1 - y0)];
  const svg = sketch('svg', {viewBox: `0 0 ${W} ${H}`, role: 'img', 'aria-label': `${name} over ${branchName}`});
  for (const v of ticks(y0, y1, 4)) {
    const y = px(at([x0, v])[1]);
    svg.children.push(sketch('line', {class: 'grid', x1: left, x2: W - right, y1: y, y2: y}), sketch('text', {x: left - 4, y: +y + 3, 'text-anchor': 'end'}, shown(v)));
  }
  for (const v of ticks(x0, x1, 4)) {
    const x = px(at([v, y0])[0]);
    svg.children.push(sketch('line', {class: 'grid', x1: x, x2: x, y1: headroom, y2: H - footroom}), sketch('text', {x, y: H - 17, 'text-anchor': 'middle'}, shown(v)));
  }
  if (cut) svg.children.push(sketch('text', {x: W - right, y: headroom + 8, 'text-anchor': 'end'}, `axis cut: ${whole.map(shown).join(' to ')}`));
  svg.children.push(sketch('text', {x: W - right, y: H - 4, 'text-anchor': 'end'}, `${branchName} [${now?.unit ?? ''}]`));
  const lines = points => {
    const parts = [[]];
    for (const p of points) Number.isFinite(p[1]) ? parts.at(-1).push(at(p)) : parts.push([]);
    return parts.map(p => path(p)).join('');
  };
  const inner = sketch('svg', {x: left, y: 0, width: W - left - right, height: H - footroom + 3, viewBox: `${left} 0 ${W - left - right} ${H - footroom + 3}`});
  if (target) {
    const [from, to] = [Math.max(y0, target[0]), Math.min(y1, target[1])].map(v => at([x0, v])[1]);
    if (from > to) inner.children.push(sketch('rect', {class: 'target', x: left, width: W - left - right, y: px(to), height: px(from - to)}));
    figure.attributes.class += curve.length && curve.every(p => p[1] >= target[0] && p[1] <= target[1]) ? ' met' : ' missed';
  }
  if (state.base !== state.now) inner.children.push(sketch('path', {class: 'was', d: lines(before)}));
  const same = new Map(fast.map(p => [p[0], p[1]])), pairs = curve.filter(p => Number.isFinite(p[1]) && Number.isFinite(same.get(p[0])));
  if (pairs.length > 1)
    inner.children.push(sketch('path', {class: 'band', d: path([...pairs.map(at), ...pairs.map(p => at([p[0], same.get(p[0])])).reverse()], 'Z')}),
                 sketch('path', {class: 'fastline', d: lines(fast)}));
  inner.children.push(sketch('path', {class: 'now', d: lines(curve)}));
  if (here) {
    const x = px(at(here)[0]);
    inner.children.push(sketch('line', {class: 'here', x1: x, x2: x, y1: headroom, y2: H - footroom}));
    if (Number.isFinite(here[1])) inner.children.push(sketch('circle', {class: 'dot', cx: x, cy: px(at(here)[1]), r: 2.8}));
  }
  inner.children.push(sketch('g', {class: 'proof'}, ...proofStrip(branchName, a => at([a, y0])[0])));
  for (const [a, stop, way] of stopsOf(state.now, now)) {
    const x = at([a, y0])[0];
    inner.children.push(sketch('path', {class: 'stop', d: `M${px(x)},${H - footroom - 6}l4,6h-8Z`}, sketch('title', {}, `${stop} ${way} near ${shown(a)} ${now.unit}`)));
  }
  if (now && now.outcome !== 'converged' && curve.length)
    for (const p of [curve[0], curve.at(-1)].filter(p => Number.isFinite(p[1]) && !onEnd(branchName, p[0])))
      inner.children.push(sketch('circle', {class: 'end', cx: px(at(p)[0]), cy: px(at(p)[1]), r: 3.5}, sketch('title', {}, now.detail)));
  svg.children.push(inner);
  figure.children.push(svg);
  const off = worst(curve, fast), r = range(curve), far = r && off > .01 * (r[1] - r[0]);
  figure.children.push(sketch('p', {class: far ? 'fast far' : 'fast'}, sketch('span', {}, !now?.published || Number.isNaN(off) ? '' : off < 5e-7 ? 'published recursion: no error'
    : `published recursion off by up to ${shown(+off.toPrecision(2))} ${channel.unit}`), aim));
  return figure;
};
// The target band of one curve: met where every point of the branch lies in it.
const editTarget = (name, branchName) => {
  const form = $('target'), key = `${branchName}|${name}`, given = state.targets.get(key) ?? [-Infinity, Infinity];
  const entries = [form.elements.low, form.elements.high];
  form.hidden = false;
  form.querySelector('span').textContent = `target of ${name} on ${branchName} [${state.channel.get(name).unit}]`;
  entries.forEach((entry, k) => {
    entry.value = Number.isFinite(given[k]) ? given[k] : '';
    entry.oninput = () => {
      const ends = entries.map((e, i) => e.value.trim() === '' ? [-Infinity, Infinity][i] : +e.value.trim());
      entries.forEach((e, i) => e.setAttribute('aria-invalid', String(Number.isNaN(ends[i]) || ends[0] > ends[1])));
      if (ends.some(Number.isNaN) || ends[0] > ends[1]) return;
      ends.some(Number.isFinite) ? state.targets.set(key, ends) : state.targets.delete(key);
      drawCharts();
    };
  });
  form.querySelector('button').onclick = () => { state.targets.delete(key); form.hidden = true; drawCharts(); };
  entries[0].focus();
};
// Whether a parameter is an end of the branch as the scene gives it.
const onEnd = (branchName, a) => {
  const b = state.info.branches.find(entry => entry.name === branchName);
  return b && [b.from, b.to].some(end => Math.abs(a - end) <= 1e-9 * Math.max(1, Math.abs(end)));
};
const drawCharts = () => {
  const {now} = state;
  if (!now) return;
  const list = shownBranches().flatMap(branch => {
    const names = state.curves ?? defaultCurves(state.base, branchOf(state.base, branch.name) ?? branch);
    return (state.branch === '' && !state.curves ? names.slice(0, 3) : names).map(name => chartOf(branch.name, name, state.branch === ''));
  });
  show($('charts'), ...list);
  drawNotes();
};
