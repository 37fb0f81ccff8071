// The live page in a browser: what a hand does with it, against the program.
// node page.mjs ELASTOCHECK SCENES-FOLDER [PICTURES-FOLDER]
import {execFileSync} from 'node:child_process';
import {mkdtempSync, readFileSync, rmSync, statSync, writeFileSync} from 'node:fs';
import {tmpdir} from 'node:os';
import path from 'node:path';
import {Browser} from './browser.mjs';

const [program, scenes, pictures] = process.argv.slice(2).map(file => path.resolve(file));
const folder = mkdtempSync(path.join(tmpdir(), 'live-pages-'));
const scene = name => path.join(scenes, name + '.yaml');
const pageOf = (file, name) => {
  const page = path.join(folder, name + '.html');
  execFileSync(program, ['live', file, '-o', page]);
  return page;
};
const failures = [];
const check = (met, what) => { if (!met) { failures.push(what); console.error('failed: ' + what); } };
const near = (a, b, bound, what) => check(Math.abs(a - b) <= bound, `${what}: ${a} is not ${b} within ${bound}`);
const browser = await Browser.start();
const run = expression => browser.run(expression);
const idle = () => browser.until('!busy && !due', 'the solver is idle');
const wait = seconds => new Promise(resolve => setTimeout(resolve, 1e3 * seconds));
const pictureOf = async (name, full) => { if (pictures) await browser.picture(path.join(pictures, name + '.png'), full); };
const settings = async () => run('[...state.settings]');
// The middle of a handle on the screen.
const handleOf = name => run(`(() => { const b = [...document.querySelectorAll('.handle')].find(h => h.dataset.name === ${JSON.stringify(name)}).querySelector('.hit').getBoundingClientRect();
  return [b.x + b.width / 2, b.y + b.height / 2]; })()`);
// Curves of a branch by the program: [[parameter, value, ...], ...].
const byProgram = (file, branch, channels, changes) => execFileSync(program, ['solve', file, '--method', 'series', '--steps', '40', '--channels', channels.join(','),
  ...changes.flatMap(([p, v]) => ['--set', `${p}=${v}`])], {stdio: ['ignore', 'pipe', 'ignore']}).toString().trim().split('\n')
  .filter(line => line.startsWith(branch + ',')).map(line => { const cells = line.split(','); return [cells[2], ...cells.slice(-channels.length)].map(Number); });
const percentile = (list, share) => [...list].sort((a, b) => a - b)[Math.min(list.length - 1, Math.floor(share * list.length))];
const report = [];

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
    report.push(`double wishbone, ${await run('state.now.branches.length')} branches, ${draws.length} moves: solve p95 ${(1e3 * percentile(draws.map(d => d.solve), .95)).toFixed(1)} ms, ` +
      `draw p95 ${(1e3 * percentile(draws.map(d => d.draw), .95)).toFixed(1)} ms, both p95 ${(1e3 * percentile(draws.map(d => d.all), .95)).toFixed(1)} ms, median ${(1e3 * percentile(draws.map(d => d.all), .5)).toFixed(1)} ms`);
    const changes = await settings();
    check(changes.length === 1 && changes[0][0] === 'points.tie_rod_inner.z' && +changes[0][1] > .001, 'dragged up: ' + JSON.stringify(changes));
    check(before !== await run(`document.querySelector('[data-channel=toe] path.now').getAttribute('d')`), 'the curve moved');
    check(before === await run(`document.querySelector('[data-channel=toe] path.was')?.getAttribute('d')`) || await run(`document.querySelector('[data-channel=toe] path.was') !== null`), 'the old curve stays');
    for (const branch of await run('state.now.branches.map(b => b.name)')) {
      const channels = ['toe', 'camber', 'wheel_centre_z', 'track_change', ...branch === 'travel' ? ['bump_steer', 'lateral_force_steer', 'roll_centre_height'] : []];
      const rows = byProgram(scene('double_wishbone'), branch, channels, changes);
      const own = await run(`${JSON.stringify(channels)}.map(c => state.now.curve(branchOf(state.now, ${JSON.stringify(branch)}), c))`);
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
    const [message, marked] = await type('springs.coil.rate', '120e3');
    check(message === '' && marked === 'false', 'a number again: ' + message);
    // a mechanism that cannot be closed, or a trim that cannot be met
    const [far] = await type('points.tie_rod_outer.y', '9');
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
  async keyboardAlone() {
    await run(`document.activeElement.blur(); document.getElementById('snap').focus()`);
    await browser.key('Tab');
    const name = await run(`document.activeElement.dataset?.name`);
    check(name !== undefined && name !== null, 'Tab reaches a hardpoint');
    await browser.key('ArrowUp');
    await idle();
    const changes = await settings();
    check(changes.length === 1 && changes[0][0] === `points.${name}.z`, 'arrow up moves it up: ' + JSON.stringify(changes));
    near(+changes[0][1], await run(`state.of.get('points.${name}.z').value`) + .001, 1e-9, 'by one step');
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
    await run(`remember(); put('springs.coil.rate', '96000'); changed()`);
    await idle();
    check(await run(`document.getElementById('trouble').hidden && state.now !== state.base`), 'and is solved again: ' + await run(`document.getElementById('trouble').textContent`));
    check(await paste(text) === '' && (await run('state.info.title')).includes('McPherson'), 'a pasted scene opens: ' + await run('state.info.title'));
    const {root} = await browser.send('DOM.getDocument'), {nodeId} = await browser.send('DOM.querySelector', {nodeId: root.nodeId, selector: '#file'});
    await browser.send('DOM.setFileInputFiles', {nodeId, files: [scene('trailing_arm')]});
    await browser.until(`state.file === 'trailing_arm.yaml' && !busy && !!state.now`, 'a scene from disk opens');
    check(await run(`document.getElementById('trouble').hidden && document.querySelectorAll('#charts .chart').length > 2`), 'and is drawn');
    const marked = text.replace(/^name: .*$/m, `name: '<img src=x onerror="window.broken=1"></script><script>window.broken=1</script>'`);
    check(await paste(marked) === '', 'markup in a name is accepted');
    check((await run(`document.getElementById('title').textContent`)).startsWith('<img') && await run(`document.querySelectorAll('img').length === 0 && window.broken === undefined`), 'and stays text');
    const file = path.join(folder, 'marked.yaml');
    writeFileSync(file, marked);
    await browser.open(pageOf(file, 'marked'));
    check((await run(`document.getElementById('title').textContent`)).startsWith('<img') && await run(`document.querySelectorAll('img').length === 0 && window.broken !== 1`), 'in the file too');
  },
  async limitPointIsShown() {
    await browser.open(pageOf(path.join(scenes, '..', 'extremes', 'over_centre.yaml'), 'over_centre'));
    check((await run(`document.getElementById('ending').textContent`)).includes('limit point'), 'limit point: ' + await run(`document.getElementById('ending').textContent`));
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
    report.push(`front axle, ${await run('state.now.branches.length')} branches, ${draws.length} moves: solve p95 ${(1e3 * percentile(draws.map(d => d.solve), .95)).toFixed(1)} ms, both p95 ${(1e3 * percentile(draws.map(d => d.all), .95)).toFixed(1)} ms, median ${(1e3 * percentile(draws.map(d => d.all), .5)).toFixed(1)} ms`);
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
  }
};
try {
  for (const [name, test] of Object.entries(tests)) {
    const start = Date.now();
    try { await test(); } catch (error) { check(false, `${name}: ${error.stack}`); }
    console.log(`${name}: ${((Date.now() - start) / 1e3).toFixed(1)} s`);
    check(browser.complaints.length === 0, `${name}: the browser complains: ${browser.complaints.splice(0).join('; ')}`);
  }
} finally {
  browser.stop();
  rmSync(folder, {recursive: true, force: true});
}
for (const line of report) console.log(line);
console.log(`${Object.keys(tests).length} tests, ${failures.length} failures`);
process.exit(failures.length ? 1 : 0);
