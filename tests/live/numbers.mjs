// WebAssembly against native: every number of every scene, as given and with changed numbers; errors and what follows them.
// node numbers.mjs PAGE NATIVE SCENES-FOLDER
import {execFileSync} from 'node:child_process';
import {readFileSync, readdirSync} from 'node:fs';
import path from 'node:path';
import {solverOf} from './solver.mjs';

const [page, native, folder] = process.argv.slice(2);
const ask = solverOf(page);
const failures = [];
const check = (met, what) => { if (!met) failures.push(what); };
// Of the largest number of its unit on the branch. A change of one hardpoint by one ulp moves them by as much (native:
// elements 5e-11, characteristics 6e-9, toe of the published recursion on the double wishbone's braking 2e-11). The two
// differ in the mathematical library (glibc, musl) and in the order of sums (vectors of two, none), by an ulp here and
// there. Positions and angles of the series stay within 1e-12 (Ackermann is a quotient of small angles); a force is a stiffness times a difference of positions, a
// characteristic near a pole a quotient of such differences, as are instant centres and roll centres (each of its own size);
// and the published recursion adds up its rounding.
const bounds = {parameter: 0, geometry: 1e-12, motion: 1e-12, published: 3e-11, ratio: 1e-11, drive: 1e-11, reaction: 1e-11, element: 1e-10, characteristic: 1e-8, centre: 1e-8};
const worsts = {};
let matrices = 0, proved = 0, compared = 0, worst = 0, where = '', identical = 0;

const compare = (name, settings) => {
  const there = JSON.parse(execFileSync(native, [path.join(folder, name), ...settings.map(s => s.join('='))], {maxBuffer: 1 << 30}));
  let opened, solved;
  try {
    opened = ask('open', {source: readFileSync(path.join(folder, name), 'utf8'), name: 'scene.yaml'});
    solved = ask('solve', {request: {settings, points: 40, published: true}});
  } catch (error) {
    check(there.error === error.message, `${name}: "${error.message}" is not "${there.error}"`);
    return;
  }
  check(JSON.stringify(opened.head) === JSON.stringify(there.open), `${name}: opened otherwise`);
  if (there.error !== undefined || there.head.trouble) { check(solved.head.trouble === there.head?.trouble, `${name}: ${solved.head.trouble}`); return; }
  // Compliance matrices, and proofs of the same points: by the same rounding, but of states that differ by some ulp.
  const request = {settings, points: 40, only: opened.head.branches.at(-1)?.name};
  if (there.compliance) {
    const own = ask('compliance', {request});
    check(own.why_not === there.compliance.why_not && String(own.causes) === String(there.compliance.causes), `${name}: compliance: ${own.why_not}`);
    for (const point of own.why_not === undefined ? ['patch', 'centre'] : []) {
      const rows = there.compliance[point], most = Math.max(...rows.flatMap(r => r.values.map(Math.abs)));
      rows.forEach((row, r) => row.values.forEach((v, c) => { ++matrices; check(Math.abs(own[point][r].values[c] - v) <= 1e-8 * most && row.name === own[point][r].name, `${name}: ${row.name} ${c}: ${v} ${own[point][r].values[c]}`); }));
    }
    const {proof} = ask('prove', {request, first: 0, count: 3});
    check(proof.stations.length === there.proof.stations.length && JSON.stringify(proof.claim) === JSON.stringify(there.proof.claim), `${name}: proofs`);
    proof.stations.forEach((own, k) => {
      const station = there.proof.stations[k];
      for (const key of ['a', 'answer', 'stable']) check(own[key] === station[key], `${name}: ${request.only} proof at ${station.a}: ${key} ${own[key]} is not ${station[key]}`);
      proved += own.answer === 'proved';
      check(own.answer !== 'proved' || (own.error_mm <= proof.claim.mm && own.error_mm < 10 * station.error_mm && station.error_mm < 10 * own.error_mm), `${name}: bound ${own.error_mm} ${station.error_mm}`);
    });
  }
  const {head} = there, wheels = head.drawing.wheels.length, seen = head.channels.length + 3 * (head.drawing.points.length + wheels);
  const wide = 1 + seen + 3 * (wheels ? 4 * wheels + 1 : 0);
  check(solved.numbers.length === there.numbers.length, `${name}: another count of numbers`);
  head.branches.forEach((branch, b) => {
    const own = solved.head.branches[b];
    for (const key of ['name', 'unit', 'outcome', 'points', 'at', 'start']) check(branch[key] === own[key], `${name}: ${branch.name}: ${key}`);
    const unitOf = column => column === 0 ? 'parameter' : column > seen ? `coordinate ${column - seen}` : there.open.channels[column - 1]?.unit ?? 'geometry';
    for (const [part, size] of [[branch, wide], [branch.published, 1 + head.channels.length]]) {
      if (!part) continue;
      // relative to the largest number of that unit on the branch, of lengths and angles at least 1: what is zero but for
      // rounding has no digits of its own
      const scales = new Map();
      for (let at = 0; at < part.points * size; ++at) {
        const value = Math.abs(+there.numbers[part.at + at]), unit = unitOf(at % size);
        if (Number.isFinite(value)) scales.set(unit, Math.max(scales.get(unit) ?? 1, value));
      }
      for (let column = 0; column < size; ++column) {
        // the moment of an axle is the difference of two wheel loads [N] at some metre from the middle
        const isDifference = head.channels[column - 1] === 'roll_moment';
        const scale = Math.max(scales.get(unitOf(column)) ?? 1, isDifference ? scales.get('N') ?? 1 : 1);
        for (let k = 0; k < part.points; ++k) {
          const a = there.numbers[part.at + k * size + column], x = a === 'nan' || a === '-nan' ? NaN : a === 'inf' ? Infinity : a === '-inf' ? -Infinity : +a;
          const y = solved.numbers[part.at + k * size + column];
          if (Number.isNaN(x) && Number.isNaN(y)) continue;
          ++compared;
          if (x === y) { ++identical; continue; }
          const off = Math.abs(x - y) / scale, at = `${name} ${settings} ${branch.name} ${head.channels[column - 1] ?? 'geometry'} ${k}: ${x} ${y}`;
          if (!(off <= worst)) { worst = off; where = at; }
          const moves = column === 0 ? 'parameter' : column > seen ? 'centre' : there.open.channels[column - 1]?.kind ?? 'geometry';
          const kind = moves !== 'motion' ? moves : part === branch.published ? 'published' : unitOf(column) === '%' ? 'ratio' : 'motion';
          check(off <= bounds[kind], `${at}: ${off}`);
          if (!(off <= worsts[kind]?.[0])) worsts[kind] = [off, at];
        }
      }
    }
  });
};
const scenes = readdirSync(folder).filter(name => name.endsWith('.yaml'));
for (const name of scenes) compare(name, []);
compare('double_wishbone.yaml', [['points.tie_rod_inner.z', '0.006'], ['springs.coil.rate', '110000']]);
compare('mcpherson.yaml', [['points.tie_rod_inner.z', 'low']]);
compare('mcpherson.yaml', [['points.nowhere.z', '1']]);

// While a number is moved: what is shown is that of a solve by itself, and nothing else is computed.
let moved = 0, dragged = 0;
const drag = (name, number, from, only) => {
  const source = readFileSync(path.join(folder, name), 'utf8'), {head} = ask('open', {source, name: 'scene.yaml'});
  const rates = head.channels.filter(c => c.kind === 'characteristic').map(c => c.name), everywhere = rates.filter((_, k) => k % 5 === 0);
  const solve = (k, shown) => ask('solve', {request: {settings: [[number, String(from + 1e-3 * k)]], points: 10, only, shown}});
  const moves = [1, 4, -2, 3].map(k => [k, solve(k, {everywhere, at: [0]})]);
  for (const [k, {head: {channels, branches: [branch]}, numbers}] of moves) {
    ask('open', {source, name: 'scene.yaml'});
    const alone = solve(k).numbers, wide = alone.length / branch.points;
    check(numbers.length === alone.length, `${name}: another count of numbers while moved`);
    const scaleOf = c => Math.max(1, ...Array.from({length: branch.points}, (_, p) => Math.abs(alone[p * wide + 1 + c])).filter(Number.isFinite));
    channels.forEach((channel, c) => {
      const scale = scaleOf(c), kept = !rates.includes(channel) || everywhere.includes(channel);
      for (let p = 0; p < branch.points; ++p) {
        const is = numbers[p * wide + 1 + c], by = alone[p * wide + 1 + c];
        if (!kept && numbers[p * wide] !== 0) { check(Number.isNaN(is), `${name}: ${channel} is computed where it is not shown`); continue; }
        ++moved;
        if (is === by || (Number.isNaN(is) && Number.isNaN(by))) continue;
        const off = Math.abs(is - by) / scale;
        dragged = Math.max(dragged, off);
        check(off <= 1e-8, `${name}: ${channel} ${numbers[p * wide]} while moved: ${is} ${by}`);
      }
    });
  }
};
drag('double_wishbone.yaml', 'points.tie_rod_inner.z', .001, 'travel');
drag('front_axle.yaml', 'points.upper_ball_left.z', 0.243, 'opposite');
drag('mcpherson.yaml', 'points.tie_rod_inner.z', -.015, 'jounce');

// Errors end in a message, and the next call works.
const scene = readFileSync(path.join(folder, 'double_wishbone.yaml'), 'utf8');
const says = (source, part) => {
  try { ask('open', {source, name: 'bad.yaml'}); check(false, `accepted: ${source.slice(0, 40)}`); } catch (error) {
    check(error.kind === 'input' && error.message.startsWith('bad.yaml') && error.message.includes(part), `"${error.message}" has no "${part}"`);
  }
};
ask('open', {source: scene, name: 'a.yaml'});
says('', 'empty');
says('a: [1', 'invalid YAML');
says('elastocheck: 1\nname: x\nunits: {length: mile}\n', ':3: units.length');
says('a: \u0000', 'plain text');
says(scene.replace('rate: 95e3', 'rate: -1'), 'springs.coil.rate');
says('x'.repeat((1 << 20) + 1), 'larger than 1 MiB');
for (const request of [{settings: 1}, {settings: [['a']]}, {settings: [], points: 0}, {settings: [], points: 1.5}, {settings: [], shown: 'all'}, {settings: [], shown: {everywhere: [1], at: []}}, {settings: [], published: 1}])
  try { ask('solve', {request}); check(false, `accepted: ${JSON.stringify(request)}`); } catch (error) { check(error.kind === 'input', error.message); }
check(ask('solve', {request: {settings: [], points: 8}}).head.branches.length === 7, 'the scene opened last is solved after errors');
// All points of a branch are proved, in ascending order. Requests that are none are refused.
ask('open', {source: scene, name: 'a.yaml'});
const points = ask('prove', {request: {settings: [], points: 40, only: 'travel'}, first: 0, count: 99}).proof.stations;
check(points.length === 41 && points.every((s, k) => s.answer === 'proved' && (!k || s.a > points[k - 1].a)), 'all points of a branch are proved, in order');
for (const request of [{settings: [], only: 'nowhere'}, {settings: [['a']]}])
  try { ask('prove', {request, first: 0, count: 1}); check(false, 'proved nothing'); } catch (error) { check(error.kind === 'input', error.message); }
for (const [given, part] of [[{}, 'as wishes.hpp'], [{vary: [], want: []}, 'at least one'], [{vary: [['points.nowhere.z', 0, 1]], want: [['toe', 'travel', 0, 0]]}, 'no such number'],
  [{vary: [['springs.coil.rate', 1, 2]], want: [['toe', 'travel', 0, 0]]}, 'not within its limits'], [{vary: [['springs.coil.rate', 8e4, 1e5]], want: [['toe', 'nowhere', 0, 0]]}, 'no output'],
  [{vary: [['springs.coil.rate', 8e4, '1e5']], want: [['toe', 'travel', 0, 0]]}, 'as wishes.hpp'], [{vary: [['springs.coil.rate', -8e4, 1e5]], want: [['wheel_rate', 'travel', 0, 1]]}, 'springs.coil.rate']])
  try { ask('wish', {request: {settings: [], ...given}}); check(false, `granted: ${JSON.stringify(given)}`); } catch (error) { check(error.kind === 'input' && error.message.includes(part), `"${error.message}" has no "${part}"`); }
const text = ask('rewrite', {request: {settings: [['points.tie_rod_inner.z', '0.006']]}}).text;
check(text.includes('tie_rod_inner: [-0.279, 0.596, 0.006]') && text.includes('# Front suspension with double wishbones'), 'rewritten text');

console.log(`${moved} numbers while a number is moved, largest difference ${dragged.toExponential(1)}`);
console.log(`${matrices} entries of compliance matrices, ${proved} points proved`);
console.log(`${scenes.length} scenes, ${compared} numbers compared, ${identical} identical, largest difference ${worst.toExponential(1)} of the largest of its unit (${where})`);
for (const [kind, [off, at]] of Object.entries(worsts)) console.log(`  ${kind}: ${off.toExponential(1)}  ${at}`);
for (const failure of failures.slice(0, 20)) console.error(failure);
if (failures.length || compared < 10000 || matrices < 500 || proved < 50 || moved < 1000) { console.error(`${failures.length} failures`); process.exit(1); }
