// The live page in a browser: what is on it, against the program.
// node page.mjs ELASTOCHECK SCENES-FOLDER [PICTURES-FOLDER]
import {execFileSync} from 'node:child_process';
import {mkdirSync, readFileSync, statSync, writeFileSync} from 'node:fs';
import path from 'node:path';
import {deflateSync, inflateSync} from 'node:zlib';
import {browser, byProgram, check, folder, handleOf, idle, near, pageOf, percentile, pictureOf, program, report, run,
  runTests, scene, scenes, settings, wait} from './harness.mjs';

const tests = {
  async opensAndAsksForNothing() {
    const page = pageOf(scene('double_wishbone'), 'wishbone');
    report.push(`size of the page ${(statSync(page).size / 1e6).toFixed(2)} MB`);
    await browser.open(page);
    report.push(`first picture after ${(await run('window.live.ready')).toFixed(0)} ms`);
    check(await run(`document.getElementById('trouble').hidden`), 'no message: ' + await run(`document.getElementById('trouble').textContent`));
    check(await run(`document.querySelectorAll('#charts .chart').length`) >= 4, 'charts');
    check(await run(`document.querySelectorAll('.handle').length`) === 12, 'every hardpoint has a handle');
    check(browser.requests.every(url => url.startsWith('file:') || url.startsWith('blob:')) && browser.requests.filter(url => url.startsWith('file:')).length === 1,
      'no request: ' + browser.requests);
    await pictureOf('wishbone', true);
  },
  async firstPictureIsThePrograms() {
    const html = readFileSync(path.join(folder, 'wishbone.html'), 'utf8'), damaged = path.join(folder, 'damaged.html');
    writeFileSync(damaged, html.replace(/(id="solver">)[^<]*/, '$1'));
    await browser.send('Page.navigate', {url: 'file://' + damaged});
    await browser.until(`document.body?.dataset.status === 'failed'`, 'a page without its solver says so');
    check(await run(`document.querySelectorAll('#charts path.now').length`) >= 4 && await run(`document.querySelectorAll('#scenery .body').length`) > 4, 'and has its drawing and curves');
    const toe = byProgram(scene('double_wishbone'), 'travel', ['toe'], []);
    (await run(`state.now.curve(state.now.branch('travel'), 'toe')`)).forEach(([a, v], k) => { near(a, toe[k][0], 1e-9, 'position'); near(v, toe[k][1], 1e-7, 'toe'); });
    // A program that reads the scene otherwise than the solver of the page.
    const [, first] = html.match(/"first":"([^"]*)"/), read = inflateSync(Buffer.from(first, 'base64')).toString();
    writeFileSync(damaged, html.replace(first, () => deflateSync(read.replace('Double wishbone', 'Another')).toString('base64')));
    await browser.open(damaged);
    check(await run('state.info.title') === 'Double wishbone' && await run(`document.title`) === 'Double wishbone – elastocheck live', 'the solver of the page decides: ' + await run('document.title'));
    await browser.open(path.join(folder, 'wishbone.html'));
    check(await run('state.base.branches.length === 7 && state.base.branches.every(b => b.whole)'), 'which solves the scene as opened itself');
  },
  async policyForbidsScriptsAndNetwork() {
    const blocked = await run(`new Promise(done => { const seen = []; document.addEventListener('securitypolicyviolation', e => seen.push(e.effectiveDirective));
      const script = document.createElement('script'); script.textContent = 'window.broken = true'; document.body.append(script); script.remove();
      const image = new Image(); image.src = 'http://127.0.0.1:9/x.png'; fetch('http://127.0.0.1:9/').catch(() => 0);
      setTimeout(() => done([window.broken === true, ...seen]), 300); })`);
    check(blocked[0] === false && blocked.slice(1).some(d => d.startsWith('script-src')) && blocked.includes('img-src') && blocked.includes('connect-src'), 'policy: ' + blocked);
    browser.complaints = [];
  },
  async dragIsTheProgramsSet() {
    await run(`[...document.querySelectorAll('#views button')].find(b => b.textContent === 'Front').click()`);
    const before = await run(`document.querySelector('[data-channel=toe] path.now').getAttribute('d')`);
    const [x, y] = await handleOf('tie_rod_inner');
    await browser.mouse('mousePressed', x, y);
    await run('window.live.draws.length = 0');
    for (let k = 1; k <= 60; ++k) {
      await browser.mouse('mouseMoved', x + (k % 7), y - 8 * Math.sin(k / 9) - k % 5);
      await idle();
    }
    await browser.mouse('mouseMoved', x, y - 12);
    await browser.mouse('mouseReleased', x, y - 12);
    await idle();
    const draws = await run('window.live.draws');
    report.push(`double wishbone, ${await run('state.info.branches.length')} branches, ${draws.length} moves: solve p95 ${(1e3 * percentile(draws.map(d => d.solve), .95)).toFixed(1)} ms, ` +
      `draw p95 ${(1e3 * percentile(draws.map(d => d.draw), .95)).toFixed(1)} ms, both p95 ${(1e3 * percentile(draws.map(d => d.all), .95)).toFixed(1)} ms, median ${(1e3 * percentile(draws.map(d => d.all), .5)).toFixed(1)} ms`);
    const changes = await settings();
    check(changes.length === 1 && changes[0][0] === 'points.tie_rod_inner.z' && +changes[0][1] > .001, 'dragged up: ' + JSON.stringify(changes));
    check(before !== await run(`document.querySelector('[data-channel=toe] path.now').getAttribute('d')`), 'the curve moved');
    check(before === await run(`document.querySelector('[data-channel=toe] path.was')?.getAttribute('d')`) || await run(`document.querySelector('[data-channel=toe] path.was') !== null`), 'the old curve stays');
    for (const branch of await run('state.info.branches.map(b => b.name)')) {
      const channels = ['toe', 'camber', 'wheel_centre_z', 'track_change', ...branch === 'travel' ? ['bump_steer', 'lateral_force_steer', 'roll_centre_height'] : []];
      const rows = byProgram(scene('double_wishbone'), branch, channels, changes);
      const own = await run(`${JSON.stringify(channels)}.map(c => state.now.curve(state.now.branch(${JSON.stringify(branch)}), c))`);
      check(rows.length > 20 && rows.length === own[0].length, `${branch}: ${rows.length} points against ${own[0].length}`);
      rows.forEach((row, k) => channels.forEach((c, i) => { if (own[i][k]) { near(own[i][k][0], row[0], 1e-9 * Math.abs(row[0]), branch); near(own[i][k][1], row[i + 1], 1e-7, `${branch} ${c} ${k}`); } }));
    }
    await pictureOf('dragged', true);
  },
  async undoRedoReset() {
    const changes = await settings(), click = async id => { await run(`document.getElementById('${id}').click()`); await idle(); };
    await click('undo');
    check((await settings()).length === 0, 'undo');
    await click('redo');
    check(JSON.stringify(await settings()) === JSON.stringify(changes), 'redo');
    check(await run('commandLine()') === `elastocheck report double_wishbone.yaml --set points.tie_rod_inner.z=${changes[0][1]}`, await run('commandLine()'));
    await click('save');
    await browser.until('window.live.saved !== undefined', 'saved');
    const saved = path.join(folder, 'saved.yaml');
    writeFileSync(saved, await run('window.live.saved'));
    const lines = readFileSync(saved, 'utf8').split('\n'), old = readFileSync(scene('double_wishbone'), 'utf8').split('\n');
    check(lines.length === old.length && lines.filter((line, k) => line !== old[k]).length === 1, 'one line differs');
    const again = byProgram(saved, 'travel', ['toe'], []), set = byProgram(scene('double_wishbone'), 'travel', ['toe'], changes);
    check(JSON.stringify(again) === JSON.stringify(set), 'the saved scene gives the same curves');
    await click('reset');
    check((await settings()).length === 0, 'reset');
  },
  // Positions are parameters: a hold solves other points, and takes the scene as opened along through its start.
  async comparesAtTheShownParameter() {
    const figures = ['camber', 'roll_centre_height'], at = 4;
    const set = (id, value, event) => run(`document.getElementById('${id}').value = ${JSON.stringify(value)}; document.getElementById('${id}').dispatchEvent(new Event('${event}'))`);
    const value = text => +text.replaceAll('−', '-');
    const program = changes => byProgram(scene('double_wishbone'), 'travel', figures, changes).find(row => Math.abs(row[0] - at) < 1e-9).slice(1);
    const expectChange = async when => {
      const was = program([]), now = program(await settings());
      for (const [k, name] of figures.entries()) {
        const [, , old, is, by] = await run(`[...document.querySelectorAll('#static [data-channel=${name}] td')].map(td => td.textContent)`);
        near(value(old), was[k], 6e-4 * Math.abs(was[k]), `${when}: ${name} as opened`);
        near(value(is), now[k], 6e-4 * Math.abs(now[k]), `${when}: ${name} now`);
        near(value(by), now[k] - was[k], 2e-3 * Math.abs(now[k] - was[k]), `${when}: change of ${name}`);
      }
    };
    await set('motion', 21, 'input');
    await set('table-at', 'shown', 'change');
    // What is out of sight is not drawn while a number is moved.
    const windowOf = async height => { await browser.send('Emulation.setDeviceMetricsOverride', {width: 1280, height, deviceScaleFactor: 1, mobile: false}); await wait(.3); };
    const camber = () => run(`document.querySelector('#static [data-channel=camber]').textContent`);
    const [x, y] = await handleOf('upper_rear'), before = await camber();
    const to = async (...heights) => { for (const up of heights) { await browser.mouse('mouseMoved', x, y - up); await idle(); } };
    await browser.mouse('mousePressed', x, y);
    await to(3, 6, 3, 0, 4, 8);
    check(await camber() === before, 'a table out of sight waits: ' + await camber());
    await windowOf(2400);
    await expectChange('while held');
    await windowOf(900);
    await browser.mouse('mouseReleased', x, y - 8);
    await idle();
    await expectChange('released');
    check(await run('state.base.branches[0].points') === 41, 'the scene as opened keeps its points');
    await run(`document.getElementById('reset').click()`);
    await idle();
    // Arrows are of the numbers on the screen: none during a drag, those of what was dragged after it.
    await set('motion', 20, 'input');
    await set('effect', 'camber', 'change');
    await browser.until('state.effects && state.effects.length === 36', 'the effects are known');
    await browser.mouse('mousePressed', x, y);
    await to(4);
    check(await run(`state.effects === null && document.getElementById('effects').hidden`), 'no arrow of other numbers');
    await browser.mouse('mouseReleased', x, y - 4);
    await browser.until('state.effects && state.effects.length === 36', 'the effects are known again');
    const of = await run(`state.effects.find(e => e.path === 'points.upper_ball.y').by`), held = await settings(), y0 = await run(`numberOf('points.upper_ball.y')`);
    const [more, less] = [1e-4, -1e-4].map(h => byProgram(scene('double_wishbone'), 'travel', ['camber'], [...held, ['points.upper_ball.y', y0 + h]]).find(row => row[0] === 0)[1]);
    near(of, (more - less) / .2, 1e-3 * Math.abs(of), 'effect on the camber at the start');
    await set('effect', '', 'change');
    await set('table-at', 'start', 'change');
    await run(`document.getElementById('reset').click()`);
    await idle();
  },
  async nonsenseIsAMessage() {
    const type = async (p, text) => {
      await run(`(() => { const e = document.querySelector('#list [data-path="${p}"] input[type=text]'); e.focus(); e.value = ${JSON.stringify(text)}; e.dispatchEvent(new Event('change')); e.blur(); })()`);
      await idle();
      return run(`[document.getElementById('trouble').textContent, document.querySelector('#list [data-path="${p}"] input[type=text]').getAttribute('aria-invalid')]`);
    };
    for (const text of ['abc', '', '-1', '1e99', 'NaN', '1,5', '<b>', '0x10', ' ']) {
      const [message, marked] = await type('springs.coil.rate', text);
      check(message.includes('double_wishbone.yaml') && message.includes('springs.coil.rate') && marked === 'true', `'${text}': ${message} ${marked}`);
      check(await run(`document.querySelector('[data-channel=toe] path.now') !== null`), 'the last curves stay');
    }
    const [message, marked] = await type('springs.coil.rate', '120');
    check(message === '' && marked === 'false', 'a number again: ' + message);
    // a mechanism that cannot be closed, or a trim that cannot be met
    const [far] = await type('points.tie_rod_outer.y', '9000');
    check(far === '' || far.length > 10, far);
    await run(`document.getElementById('reset').click()`);
    await idle();
    check(await run(`document.getElementById('trouble').hidden`), 'reset clears the message');
  },
  async targetsAndArrows() {
    const low = async (from, to) => {
      await run(`document.querySelector('[data-channel=toe] .aim').click(); for (const [n, v] of [['low', '${from}'], ['high', '${to}']]) { const e = document.getElementById('target').elements[n]; e.value = v; e.dispatchEvent(new Event('input')); }`);
      return run(`document.querySelector('[data-channel=toe]').className`);
    };
    check((await low(-.5, .5)).includes('met') && (await low(0, .5)).includes('missed'), 'a target is met, or not');
    check((await low('x', .5)).includes('missed') && await run(`document.getElementById('target').elements.low.getAttribute('aria-invalid')`) === 'true', 'a target is a number');
    await run(`document.querySelector('#target button').click()`);
    // Arrows: each effect is the derivative that the program has.
    await run(`document.getElementById('motion').value = 40; document.getElementById('motion').dispatchEvent(new Event('input')); document.getElementById('effect').value = 'toe'; document.getElementById('effect').dispatchEvent(new Event('change'))`);
    await browser.until('state.effects && state.effects.length === 36', 'the effects are known');
    const of = await run(`state.effects.find(e => e.path === 'points.tie_rod_inner.z').by`);
    const out = execFileSync(program, ['sensitivity', scene('double_wishbone'), '--of', 'toe', '--to', 'points.tie_rod_inner.z', '--branch', 'travel', '--points', '2'], {stdio: ['ignore', 'pipe', 'ignore']}).toString();
    const exact = +out.split('travel to 80 mm')[1].match(/tie_rod_inner\.z +\S+ +(\S+) +deg per m/)[1] / 1e3;
    near(of, exact, .01 * Math.abs(exact), 'effect of a millimetre on toe at full jounce');
    check(await run(`document.querySelectorAll('.arrow').length`) > 3 && await run(`document.querySelectorAll('#effects li').length`) === 5, 'arrows and the list of five');
    await run(`[...document.querySelectorAll('#views button')].find(b => b.textContent === 'Oblique').click()`);
    await pictureOf('arrows');
    // A wished value by one number, and by the program with that number.
    const solve = async wish => {
      await run(`document.getElementById('wish').value = '${wish}'; document.querySelector('#effects li button').click()`);
      await browser.until(`state.settings.size === 1 || document.getElementById('wish').getAttribute('aria-invalid') === 'true' || !document.getElementById('trouble').hidden`, 'an answer to the wish');
      await idle();
    };
    await solve('nothing');
    check((await settings()).length === 0, 'a wish is a number');
    await solve('90');
    check((await settings()).length === 0 && (await run(`document.getElementById('trouble').textContent`)).includes('is not reached'), 'what cannot be reached is said: ' + JSON.stringify(await settings()));
    await run(`trouble(''); document.getElementById('wish').setAttribute('aria-invalid', 'false')`);
    await solve('-0.1');
    const found = await settings(), there = byProgram(scene('double_wishbone'), 'travel', ['toe'], found);
    check(found.length === 1 && found[0][0] === 'points.tie_rod_inner.z', 'solved for: ' + JSON.stringify(found));
    near(there.at(-1)[1], -.1, 2e-6, 'toe at full jounce as wished');
    await run(`document.getElementById('reset').click()`);
    await idle();
    await run(`document.getElementById('effect').value = ''; document.getElementById('effect').dispatchEvent(new Event('change')); state.station = null; draw();
      [...document.querySelectorAll('#views button')].find(b => b.textContent === 'Front').click()`);
    await idle();
  },
  async pointsAreProvedWhileNothingMoves() {
    const all = `shownBranches().every(b => proofOf(b.name)?.done)`, strips = kind => run(`[...document.querySelectorAll('#charts .chart')].map(c => c.querySelectorAll('.proof .${kind}').length)`);
    await browser.until(all, 'the points of the branch are proved');
    check((await strips('proved')).every(n => n === 41) && (await strips('unproved')).every(n => n === 0), 'each curve has 41 proved points: ' + await strips('proved'));
    const words = await run(`document.querySelector('#notes .proof').textContent`);
    check(/^41 of 41 points proved: .*within 1e−6 mm.*no other within .* mm, stable$/.test(words), 'in words: ' + words);
    // The program proves the points of the same branch, fewer of them.
    const certified = execFileSync(program, ['certify', scene('double_wishbone'), '--json'], {stdio: ['ignore', 'pipe', 'ignore'], maxBuffer: 1 << 26}).toString();
    check(JSON.parse(certified).scenes[0].results[0].verdict.grade === 'pass', 'the program proves them: ' + certified.slice(0, 200));
    // A point that is not proved, of a state as the solver would return it.
    await run(`{ const s = proofOf('travel').stations[3]; s.answer = 'open'; s.detail = 'reason'; drawCharts(); }`);
    check((await strips('unproved')).every(n => n === 1) && /^40 of 41 points proved.* at −68 mm not proved: reason$/.test(await run(`document.querySelector('#notes .proof').textContent`)), 'one not proved: ' + await run(`document.querySelector('#notes .proof').textContent`));
    // A change of a number discards them at once.
    await run(`edit(() => put('springs.coil.rate', '96000'))`);
    await idle();
    check((await strips('unproved')).every(n => n === 0) && !(await run(all)), 'proofs belong to the numbers');
    await browser.until(all, 'proved again');
    check((await strips('proved')).every(n => n === 41), 'and again for the new ones');
    // Numbers that are not solved have no proof.
    const unproved = async what => check((await strips('proved')).every(n => n === 0) && (await run(`document.querySelector('#notes .proof').textContent`)) === 'no proof: these numbers are not solved',
      what + ': ' + await run(`document.querySelector('#notes .proof').textContent`));
    await run(`edit(() => put('springs.coil.rate', 'abc'))`);
    await idle();
    await unproved('a number that is none');
    await run(`document.getElementById('reset').click()`);
    await idle();
    await browser.until(all, 'proved once more');
  },
  async tablesAreTheProgramsFigures() {
    const cells = name => run(`[...document.querySelectorAll('#static [data-channel=${name}] td')].map(td => td.textContent)`), value = text => +text.replaceAll('−', '-');
    const figures = ['lateral_force_steer', 'lateral_force_camber', 'braking_force_steer', 'traction_force_steer', 'aligning_torque_steer', 'aligning_torque_camber', 'camber', 'caster'];
    const groups = await run(`[...document.querySelectorAll('#static .group')].map(row => row.textContent)`);
    for (const title of ['adjusted by the trim', 'static values after the trim', 'lateral force at the contact patch', 'braking force at the contact patch', 'traction force at the wheel centre', 'aligning torque', 'steering'])
      check(groups.includes(title), `"${title}" is in ${groups}`);
    const change = [['bushings.lower_front.rates.x', '3000000'], ['springs.coil.bump_stop.clearance', '0.03']];
    await run(`edit(() => { for (const [p, v] of ${JSON.stringify(change)}) put(p, v); })`);
    await idle();
    const start = changes => byProgram(scene('double_wishbone'), 'travel', figures, changes).find(row => row[0] === 0).slice(1);
    const was = start([]), now = start(change);
    for (const [k, name] of figures.entries()) {
      const [, , old, is, by] = await cells(name);
      near(value(old), was[k], 6e-4 * Math.abs(was[k]), `${name} as opened`);
      near(value(is), now[k], 6e-4 * Math.abs(now[k]), `${name} now`);
      if (name !== 'caster') near(value(by), now[k] - was[k], 2e-3 * Math.abs(now[k] - was[k]) + 1e-9, `change of ${name}`);
    }
    // At the shown position too.
    await run(`document.getElementById('motion').value = 30; document.getElementById('motion').dispatchEvent(new Event('input')); document.getElementById('table-at').value = 'shown'; document.getElementById('table-at').dispatchEvent(new Event('change'))`);
    const [, , , there] = await cells('lateral_force_steer');
    const moved = byProgram(scene('double_wishbone'), 'travel', ['lateral_force_steer'], change).find(row => row[0] === 40)[1];
    near(value(there), moved, 6e-4 * Math.abs(moved), 'lateral force steer at 40 mm');
    check((await run(`document.getElementById('table-place').textContent`)) === 'travel 40 mm', await run(`document.getElementById('table-place').textContent`));
    // The largest force of a bushing over all branches.
    await run(`document.getElementById('forces').open = true; document.getElementById('forces-at').value = 'largest'; document.getElementById('forces-at').dispatchEvent(new Event('change'))`);
    await browser.until(`document.querySelector('#forces [data-channel="lower_front.elastic_force_y"]')`, 'forces');
    const force = await run(`[...document.querySelectorAll('#forces [data-channel="lower_front.elastic_force_y"] td')].map(td => td.textContent)`);
    const branches = await run('state.info.branches.map(b => b.name)');
    const most = branches.flatMap(b => byProgram(scene('double_wishbone'), b, ['lower_front.elastic_force_y'], change).map(row => [row[1], b])).reduce((a, b) => Math.abs(b[0]) > Math.abs(a[0]) ? b : a);
    near(value(force[3]), most[0], 6e-4 * Math.abs(most[0]), 'largest force of a bushing');
    check(force[5] === most[1], `on branch ${force[5]}, ${most[1]}`);
    // Curves of all bushings over every branch, with those of the scene as opened.
    await run(`document.getElementById('preset').value = 'forces of bushings'; document.getElementById('preset').dispatchEvent(new Event('change')); [...document.querySelectorAll('#branches button')].at(-1).click()`);
    await wait(.2);
    await idle();
    check(await run(`document.querySelectorAll('#charts .chart').length`) === 12 * branches.length && await run(`document.querySelectorAll('#charts path.was').length`) === 12 * branches.length, 'twelve curves a branch, and pale ones');
    await pictureOf('bushings');
    // Where the stop closes, and closed before.
    const note = await run(`[...document.querySelectorAll('#notes .stop')].map(li => li.textContent).find(t => t.startsWith('travel: coil.bump_stop closes'))`);
    const closing = changes => execFileSync(program, ['solve', scene('double_wishbone'), '--method', 'series', '--steps', '400', '--channels', 'coil.bump_stop.force', ...changes.flatMap(([p, v]) => ['--set', `${p}=${v}`])], {stdio: ['ignore', 'pipe', 'ignore'], maxBuffer: 1 << 26})
      .toString().split('\n').map(line => line.split(',')).find(c => c[0] === 'travel' && +c[2] > 0 && Math.abs(+c.at(-1)) > 0)[2];
    const [, nearNow, nearBefore] = note?.match(/near (\S+) mm, as opened near (\S+)/) ?? [];
    near(+nearNow, +closing(change) - .2, .2, `the stop closes (${note})`);
    near(+nearBefore, +closing([]) - .2, .2, 'and closed');
    await run(`document.getElementById('preset').value = 'usual curves'; document.getElementById('preset').dispatchEvent(new Event('change')); document.querySelector('#branches button').click(); document.getElementById('forces').open = false;
      document.getElementById('table-at').value = 'start'; document.getElementById('reset').click()`);
    await wait(.2);
    await idle();
  },
  async severalWishesAreTheProgramsSolveFor() {
    const set = (list, row, texts) => run(`{ const inputs = [...document.getElementById('${list}').children[${row}].querySelectorAll('input')]; ${JSON.stringify(texts)}.forEach((t, k) => { if (t !== null) inputs[k].value = t; }); wishLine(); }`);
    const answer = () => run(`document.getElementById('wish-answer').textContent`), go = async () => {
      await run(`document.getElementById('wish-go').click()`);
      await browser.until(`!document.getElementById('wish-go').disabled`, 'an answer to the wishes');
      await run(`document.getElementById('wish-take').hidden || document.getElementById('wish-take').click()`);
      await idle();
      return answer();
    };
    await run(`document.getElementById('wishes').open = true`);
    await browser.until(`document.getElementById('wants').children.length === 1`, 'a first wish');
    await run(`document.getElementById('wants').replaceChildren(); document.getElementById('varies').replaceChildren(); addWant('toe', 'travel', 80, ''); addWant('camber', 'travel', 80, '-1.5');
      for (const p of ['points.tie_rod_inner.z', 'points.upper_ball.z', 'springs.coil.rate']) addVaried(p)`);
    check((await go()).startsWith('Each wish needs'), 'a wish needs a value: ' + await answer());
    await set('wants', 0, ['80', 'nothing']);
    check((await go()).startsWith('Each wish needs') && await run(`document.querySelectorAll('#wants [aria-invalid=true]').length`) === 1, 'a number');
    await set('wants', 0, ['80', '-0.1']);
    await set('varies', 1, [null, '100', '300']);
    const line = await run(`document.getElementById('wish-line').textContent`);
    check((await go()).startsWith('Met, with the smallest change: toe'), 'met: ' + await answer());
    await pictureOf('wishes', true);
    const found = await settings(), rows = byProgram(scene('double_wishbone'), 'travel', ['toe', 'camber'], found);
    near(rows.at(-1)[1], -.1, 1e-6, 'toe at full jounce as wished');
    near(rows.at(-1)[2], -1.5, 1e-6, 'camber at full jounce as wished');
    // The command line on the page finds the same numbers, by the equilibrium leg and exact gradients.
    check(/^elastocheck solve-for double_wishbone.yaml( --vary \S+){3}( --want \S+){2}$/.test(line), line);
    const words = line.replaceAll("'", '').split(' ').slice(2), result = JSON.parse(execFileSync(program, ['solve-for', scene('double_wishbone'), ...words.slice(1), '--json', '--quiet'], {stdio: ['ignore', 'pipe', 'ignore']}).toString());
    const table = result.scenes[0].results[0].tables.numbers, [name, to] = ['number', 'to'].map(c => table.columns.findIndex(column => column.name === c));
    check(table.rows.length === 3, 'three numbers');
    for (const row of table.rows) near(+(found.find(([p]) => p === row[name])?.[1] ?? await run(`state.numbers.get('${row[name]}').value`)), row[to], 1e-6 * Math.max(.1, Math.abs(row[to])), `${row[name]} as by solve-for`);
    // What cannot be met: the nearest, with the number at its limit; undone in one step.
    await run(`document.getElementById('undo').click()`);
    await idle();
    check((await settings()).length === 0, 'undone in one step');
    await run(`document.getElementById('varies').replaceChildren(); addVaried('points.upper_ball.y'); document.getElementById('wants').children[0].remove()`);
    await set('wants', 0, ['80', '5']);
    check(/^Not met, this is nearest: camber .*upper_ball\.y at its (upper|lower) limit\.$/.test(await go()), 'nearest: ' + await answer());
    await run(`document.getElementById('reset').click()`);
    await idle();
    await run(`document.getElementById('varies').replaceChildren(); addVaried('springs.coil.rate')`);
    await run(`document.getElementById('wants').replaceChildren(); addWant('toe', 'travel', 0, '1')`);
    check((await go()).includes('none of these numbers moves it') && (await settings()).length === 0, 'nothing moves it: ' + await answer());
    await set('varies', 0, [null, '-1', '2']);
    check((await go()).includes('not within its limits') && (await settings()).length === 0, 'limits: ' + await answer());
    await run(`document.getElementById('wishes').open = false`);
  },
  async keyboardAlone() {
    await run(`document.activeElement.blur(); document.getElementById('snap').focus()`);
    await browser.key('Tab');
    const name = await run(`document.activeElement.dataset?.name`);
    check(name !== undefined && name !== null, 'Tab reaches a hardpoint');
    await browser.key('ArrowUp');
    await idle();
    const changes = await settings();
    check(changes.length === 1 && changes[0][0] === `points.${name}.z`, 'arrow up moves it up: ' + JSON.stringify(changes));
    near(+changes[0][1], await run(`state.numbers.get('points.${name}.z').value`) + .001, 1e-9, 'by one step');
    check(await run(`document.activeElement.dataset?.name`) === name, 'it keeps the focus');
    await browser.key('Enter');
    check(await run(`!document.getElementById('point').hidden`), 'Enter shows its numbers');
    await run(`document.getElementById('reset').click()`);
    await idle();
  },
  async brokenSceneIsTheReadersMessage() {
    const paste = async text => {
      await run(`document.getElementById('paste').click(); document.querySelector('#dialog textarea').value = ${JSON.stringify(text)}; document.getElementById('dialog-ok').click()`);
      await wait(.2);
      await idle();
      return run(`document.getElementById('trouble').textContent`);
    };
    const text = readFileSync(scene('mcpherson'), 'utf8');
    check((await paste(text.replace('elastocheck: 1', 'elastocheck: 1\nbodys: {}'))).includes(`pasted.yaml:`), 'unknown field');
    check((await paste('a: [')).startsWith('pasted.yaml:'), 'not YAML');
    check((await paste('')).startsWith('pasted.yaml'), 'empty');
    check(await run('state.info.title') === 'Double wishbone' && await run('!!state.now'), 'the scene before stays');
    await run(`edit(() => put('springs.coil.rate', '96000'))`);
    await idle();
    check(await run(`document.getElementById('trouble').hidden && isChanged()`), 'and is solved again: ' + await run(`document.getElementById('trouble').textContent`));
    check(await paste(text) === '' && (await run('state.info.title')).includes('McPherson'), 'a pasted scene opens: ' + await run('state.info.title'));
    const {root} = await browser.send('DOM.getDocument'), {nodeId} = await browser.send('DOM.querySelector', {nodeId: root.nodeId, selector: '#file'});
    await browser.send('DOM.setFileInputFiles', {nodeId, files: [scene('trailing_arm')]});
    await browser.until(`state.file === 'trailing_arm.yaml' && !!state.now`, 'a scene from disk opens');
    check(await run(`document.getElementById('trouble').hidden && document.querySelectorAll('#charts .chart').length > 2`), 'and is drawn');
    const marked = text.replace(/^name: .*$/m, `name: '<img src=x onerror="window.broken=1"></script><script>window.broken=1</script>'`);
    check(await paste(marked) === '', 'markup in a name is accepted');
    check((await run(`document.getElementById('title').textContent`)).startsWith('<img') && await run(`document.querySelectorAll('img').length === 0 && window.broken === undefined`), 'and stays text');
    const file = path.join(folder, 'marked.yaml');
    writeFileSync(file, marked);
    await browser.open(pageOf(file, 'marked'));
    check((await run(`document.getElementById('title').textContent`)).startsWith('<img') && await run(`document.querySelectorAll('img').length === 0 && window.broken !== 1`), 'in the file too');
  },
  async aFileIsDroppedOnThePage() {
    const drop = async (text, name) => {
      await run(`{ trouble(''); const data = new DataTransfer(); data.items.add(new File([${JSON.stringify(text)}], ${JSON.stringify(name)}));
        for (const type of ['dragover', 'drop']) document.dispatchEvent(new DragEvent(type, {dataTransfer: data, bubbles: true, cancelable: true})); }`);
      await browser.until(`!document.getElementById('trouble').hidden || (state.file === ${JSON.stringify(name)} && state.now)`, 'an answer to the file');
      await idle();
      return run(`document.getElementById('trouble').textContent`);
    };
    const text = readFileSync(scene('semi_trailing_arm'), 'utf8'), title = await run('state.info.title');
    const line = text.split('\n').findIndex(l => /^springs:/.test(l)) + 1, wrong = text.replace(/^springs:$/m, 'springs:\n  broken: {bodies: [arm, ground], rate: fast}');
    const message = await drop(wrong, 'dropped.yaml');
    check(line > 0 && message.startsWith(`dropped.yaml:${line + 1}: springs.broken`), 'file, line and field: ' + message);
    check(await run('state.info.title') === title, 'the scene before stays');
    check(await drop(text, 'dropped.yaml') === '' && await run('state.file') === 'dropped.yaml' && (await run('state.info.title')).includes('railing'), 'a dropped scene opens: ' + await run('state.info.title'));
    check(await run(`document.querySelectorAll('#charts .chart').length`) > 2, 'and is drawn');
    // A file with an error by the button.
    const file = path.join(folder, 'wrong.yaml');
    writeFileSync(file, wrong);
    const {root} = await browser.send('DOM.getDocument'), {nodeId} = await browser.send('DOM.querySelector', {nodeId: root.nodeId, selector: '#file'});
    await browser.send('DOM.setFileInputFiles', {nodeId, files: [file]});
    await browser.until(`document.getElementById('trouble').textContent.startsWith('wrong.yaml:${line + 1}: springs.broken')`, 'the message of a file with an error');
    check(await run('state.file') === 'dropped.yaml', 'the scene before stays');
  },
  async tablesOfTheSceneAreInTheFile() {
    const file = path.join(folder, 'with_table.yaml'), tables = path.join(folder, 'tables');
    const text = readFileSync(scene('double_wishbone'), 'utf8').replace('bump_stop: {clearance: 0.025, rate: 400e3}', 'bump_stop: {clearance: 0.025, curve: {file: tables/stop.csv}}');
    check(text.includes('tables/stop.csv'), 'a scene with a table');
    mkdirSync(tables);
    writeFileSync(file, text);
    writeFileSync(path.join(tables, 'stop.csv'), 'deflection,force\n0,0\n0.005,1000\n0.010,4000\n0.015,9000\n');
    await browser.open(pageOf(file, 'with_table'));
    check(await run(`document.getElementById('trouble').hidden`), 'it opens: ' + await run(`document.getElementById('trouble').textContent`));
    const rows = byProgram(file, 'travel', ['toe', 'coil.bump_stop.force'], []), own = await run(`['toe', 'coil.bump_stop.force'].map(c => state.now.curve(state.now.branch('travel'), c))`);
    check(rows.length > 20 && rows.length === own[0].length && Math.abs(rows.at(-1)[2]) > 1000, `${rows.length} points, force ${rows.at(-1)[2]}`);
    rows.forEach((row, k) => [0, 1].forEach(c => near(own[c][k][1], row[c + 1], 1e-7 * Math.max(1, Math.abs(row[c + 1])), `point ${k}`)));
    // After an error, which ends the solver's instance, the tables are there again.
    const paste = async source => {
      await run(`trouble(''); document.getElementById('paste').click(); document.querySelector('#dialog textarea').value = ${JSON.stringify(source)}; document.getElementById('dialog-ok').click()`);
      await browser.until(`!document.getElementById('trouble').hidden`, 'an answer to the text');
      await idle();
      return run(`document.getElementById('trouble').textContent`);
    };
    const message = await paste(text);
    check(/^pasted\.yaml:52: springs\.coil\.bump_stop\.curve\.file: .*not a file/.test(message), 'a pasted scene has no tables: ' + message);
    await run(`edit(() => put('springs.coil.rate', '96000'))`);
    await idle();
    check(await run(`document.getElementById('trouble').hidden && isChanged()`), 'the scene of the file is solved again: ' + await run(`document.getElementById('trouble').textContent`));
    // Opened together with its table.
    await run(`openFiles([new File([${JSON.stringify(text.replace('tables/', ''))}], 'a.yaml'), new File(['deflection,force\\n0,0\\n0.015,9000\\n'], 'stop.csv')])`);
    await idle();
    check(await run(`state.file === 'a.yaml' && document.getElementById('trouble').hidden`), 'a scene and its table: ' + await run(`document.getElementById('trouble').textContent`));
  },
  async idleMotionsAreNoted() {
    await browser.open(pageOf(scene('mcpherson'), 'mcpherson'));
    const inspected = execFileSync(program, ['inspect', scene('mcpherson')], {stdio: ['ignore', 'pipe', 'ignore']}).toString();
    const note = await run(`document.querySelector('#notes .idle')?.textContent`), [, motion] = note?.match(/nothing resists: (strut: rotation [^,]*)/) ?? [];
    check(motion !== undefined && inspected.includes(motion.slice(7)), `idle motion as inspected: ${note}`);
    await browser.until(`shownBranches().every(b => proofOf(b.name)?.done)`, 'the points are proved');
    check((await run(`document.querySelector('#notes .proof').textContent`)).startsWith('41 of 41 points proved'), 'with an idle motion');
  },
  async reportLinksToThePage() {
    const report = path.join(folder, 'report');
    execFileSync(program, ['report', scene('double_wishbone'), '--quick', '--live', '--branch', 'travel', '-o', report], {stdio: 'ignore'});
    await browser.send('Page.navigate', {url: 'file://' + path.join(report, 'report.html')});
    await browser.until(`document.readyState === 'complete' && document.querySelector('a[href="live.html"]') !== null`, 'the report links to the page');
    await run(`document.querySelector('a[href="live.html"]').click()`);
    await browser.until(`document.readyState === 'complete' && window.live?.ready > 0`, 'the link leads to the page');
    check(await run('state.info.title') === 'Double wishbone' && (await run('location.href')).endsWith('report/live.html'), 'of the scene');
    // Its compliance matrices are those of the report's equilibrium leg.
    await run(`document.getElementById('matrix').open = true`);
    await browser.until(`document.querySelectorAll('#matrix td').length > 40`, 'the compliance matrix');
    const {scenes: [{results}]} = JSON.parse(readFileSync(path.join(report, 'result.json'), 'utf8')), {compliance} = results.find(r => r.tables.compliance).tables, at = name => compliance.columns.findIndex(c => c.name === name);
    let compared = 0;
    for (const [point, key] of [['contact patch', 'patch'], ['wheel centre', 'centre']]) {
      const rows = compliance.rows.filter(r => r[at('leg')] === 'equilibrium' && r[at('point')] === point && r[at('a')] === 0), own = await run(`matrices.now.${key}`);
      const numbers = rows.map(r => r.slice(-7).filter(v => typeof v === 'number').slice(0, 6));
      rows.forEach((row, k) => own[k]?.values.forEach((v, c) => { ++compared; near(v, numbers[k][c], 1e-6, `${point}: ${own[k].name}, column ${c}`); }));
    }
    check(compared === 72, `${compared} entries of the matrices`);
  },
  async limitPointIsShown() {
    await browser.open(pageOf(path.join(scenes, '..', 'extremes', 'over_centre.yaml'), 'over_centre'));
    check((await run(`document.getElementById('ending').textContent`)).includes('limit point'), 'limit point: ' + await run(`document.getElementById('ending').textContent`));
    await browser.until(`proofOf('pull')?.done`, 'the points are proved');
    const [, from, to] = (await run(`document.getElementById('ending').textContent`)).match(/limit point proved: its parameter is between (\S+) and (\S+) /) ?? [];
    check(+from < +to && to - from < 1e-6 && +to < 64 && +from > 63, `bounds of the limit point: ${from} ${to}`);
    await pictureOf('over_centre', true);
  },
  async frontAxle() {
    await browser.open(pageOf(scene('front_axle'), 'axle'));
    await run(`[...document.querySelectorAll('#views button')].find(b => b.textContent === 'Front').click(); window.live.draws.length = 0`);
    const name = await run(`[...handles.keys()].find(n => n.includes('tie_rod_inner')) ?? [...handles.keys()][0]`), [x, y] = await handleOf(name);
    await browser.mouse('mousePressed', x, y);
    for (let k = 1; k <= 30; ++k) { await browser.mouse('mouseMoved', x, y - 8 * Math.sin(k / 5) - k % 5); await idle(); }
    await browser.mouse('mouseReleased', x, y - 4);
    await idle();
    const draws = await run('window.live.draws');
    report.push(`front axle, ${await run('state.info.branches.length')} branches, ${draws.length} moves: solve p95 ${(1e3 * percentile(draws.map(d => d.solve), .95)).toFixed(1)} ms, both p95 ${(1e3 * percentile(draws.map(d => d.all), .95)).toFixed(1)} ms, median ${(1e3 * percentile(draws.map(d => d.all), .5)).toFixed(1)} ms`);
    await pictureOf('axle', true);
  },
  async narrowAndDark() {
    await browser.open(path.join(folder, 'wishbone.html'), {width: 390, height: 844, dark: true});
    check(await run('document.documentElement.scrollWidth') <= 390, 'no sideways scrolling at 390 px: ' + await run('document.documentElement.scrollWidth'));
    check(await run(`getComputedStyle(document.body).backgroundColor`) === 'rgb(20, 24, 29)', 'dark');
    await pictureOf('narrow', true);
    await browser.open(path.join(folder, 'wishbone.html'), {dark: true});
    await run(`[...document.querySelectorAll('#branches button')].at(-1).click()`);
    await wait(.5);
    await idle();
    await pictureOf('dark', true);
  },
  async aSolverThatStoppedTakesTheProofAlong() {
    await browser.open(path.join(folder, 'wishbone.html'));
    await idle();
    await browser.until(`shownBranches().every(b => proofOf(b.name)?.done)`, 'the points are proved');
    await run(`solvers.front.worker.terminate(); edit(() => put('springs.coil.rate', '96000'))`);
    check(await run(`document.querySelectorAll('#charts .proof .proved').length`) === 0, 'no strip');
    check(await run(`document.querySelector('#notes .proof').textContent`) === 'no proof: these numbers are not solved', 'no words');
  }
};
await runTests(tests);
