// What was wrong on the live page under a hand: each by mouse, keyboard or fingers.
// node hand.mjs ELASTOCHECK SCENES-FOLDER [PICTURES-FOLDER]
import {readFileSync, writeFileSync} from 'node:fs';
import path from 'node:path';
import {browser, byProgram, check, click, folder, handleOf, idle, near, pageOf, pictureOf, run, runTests, scene, scenes, set, settings,
  textOf, value, viewFrom, wait} from './harness.mjs';

const wishbone = scene('double_wishbone');
const press = (x, y, more) => browser.mouse('mousePressed', x, y, more);
const to = async (x, y, more) => { await browser.mouse('mouseMoved', x, y, more); await idle(); };
const letGo = async (x, y, more) => { await browser.mouse('mouseReleased', x, y, more); await idle(); };
const typeIn = async (number, text) => {
  await run(`{ const e = document.querySelector('#list [data-path="${number}"] input[type=text]'); e.scrollIntoView({block: 'center'}); e.focus(); e.select(); }`);
  await browser.send('Input.insertText', {text});
  await browser.key('Enter');
};
const rowOf = name => run(`[...document.querySelectorAll('#static [data-channel=${name}] td')].map(td => td.textContent)`);
const opacity = selector => run(`+getComputedStyle(document.querySelector('${selector}')).opacity`);
const statusIs = (kind, what, seconds = 20) => browser.until(`document.body.dataset.status === '${kind}'`, what, seconds);
const chart = name => `#charts [data-channel=${name}]`;
const pointsOf = selector => run(`(document.querySelector('${selector}')?.getAttribute('d') ?? '').split('L').length`);
const valueOf = async name => value((await textOf(`${chart(name)} .value`)).split(' ')[0]);

await browser.open(pageOf(wishbone, 'wishbone'), {width: 1500, height: 1000});
const tests = {
  async comparesWithTheSceneAsOpened() {
    await viewFrom('Front');
    await set('motion', 21, 'input');
    await set('table-at', 'shown', 'change');
    const [x, y] = await handleOf('upper_rear'), figures = ['camber', 'roll_centre_height'], shares = [2e-3, 2e-3];
    const program = changes => byProgram(wishbone, 'travel', figures, changes).find(row => Math.abs(row[0] - 4) < 1e-9).slice(1);
    const changesAreRight = async when => {
      const was = program([]), now = program(await settings());
      for (const [k, name] of figures.entries())
        near(value((await rowOf(name))[4]), now[k] - was[k], shares[k] * Math.abs(now[k] - was[k]), `${when}: change of ${name}`);
    };
    await press(x, y);
    for (const up of [3, 6, 3, 0]) await to(x, y - up);
    for (const up of [4, 8]) await to(x, y - up);
    await changesAreRight('during the drag');
    check(await pointsOf(`${chart('toe')} path.was`) === 41, 'the curve as opened keeps its points: ' + await pointsOf(`${chart('toe')} path.was`));
    await letGo(x, y - 8);
    await changesAreRight('at rest');
    check((await run(`document.querySelector('#static').dataset.solve === document.querySelector('${chart('toe')}').dataset.solve
      && document.getElementById('drawing').dataset.solve === document.querySelector('#static').dataset.solve`)), 'all of one solve');
    check((await textOf('#state')).startsWith('solve ' + await run(`document.getElementById('drawing').dataset.solve`)), 'which is named: ' + await textOf('#state'));
    await click('reset');
    await set('table-at', 'start', 'change');
    await set('motion', 20, 'input');
  },
  async dragSolvesTheShownBranchAtItsPoints() {
    await viewFrom('Front');
    const [x, y] = await handleOf('spring_lower'), stop = () => run(`[...document.querySelectorAll('#notes .stop')].map(li => li.textContent)[0]`);
    await press(x, y);
    await to(x, y - 3);
    const during = await stop(), points = await pointsOf(`${chart('toe')} path.now`), branches = await run('state.now.branches.length');
    await letGo(x, y - 3);
    check(during === await stop(), `a stop closes where it closes at rest: ${during}, ${await stop()}`);
    check(points === 41, `${points} points during a drag`);
    check(branches === 1 && await run('state.now.branches.length') === 7, `${branches} branches during a drag`);
    await click('reset');
  },
  // What is written is laid out and painted, while the worker solves.
  async aMoveWritesWhatItMoves() {
    await viewFrom('Front');
    const [x, y] = await handleOf('tie_rod_inner');
    await press(x, y);
    await to(x, y - 3);
    await run(`{ window.live.draws.length = 0; window.touched = new Set();
      window.watcher = new MutationObserver(list => list.forEach(m => touched.add(m.target.dataset.name ?? m.attributeName)));
      watcher.observe(document.getElementById('handles'), {attributes: true, subtree: true});
      watcher.observe(document.body, {attributes: true, attributeFilter: ['data-status']}); }`);
    for (let k = 4; k < 9; ++k) await to(x, y - k);
    const [written, slowest] = await run('watcher.disconnect(), [[...touched], Math.max(...window.live.draws.map(d => d.all))]');
    const expected = written.filter(name => name !== 'data-status' || slowest < .2);
    check(String(expected) === 'tie_rod_inner', `a move writes ${written}, the slowest ${slowest} s`);
    await letGo(x, y - 8);
    await click('reset');
  },
  async arrowsOfWhatTheTrimHolds() {
    await set('effect', 'toe', 'change');
    await browser.until(`!document.getElementById('effects').hidden`, 'an answer to the arrows');
    check(await run(`document.querySelectorAll('#effects li').length`) === 0, 'no row of rounding: ' + await textOf('#effects ol'));
    check((await textOf('#effects h3')).includes('the trim holds'), await textOf('#effects h3'));
    check(await run(`document.querySelectorAll('.arrow').length`) === 0, 'no arrow of rounding');
    await set('effect', '', 'change');
  },
  async targetOfABranchThatEndsEarly() {
    await browser.open(pageOf(path.join(scenes, '..', 'extremes', 'over_centre.yaml'), 'over_centre'));
    await run(`document.querySelector('.chart .aim').click()`);
    for (const [name, end] of [['low', -1e9], ['high', 1e9]])
      await run(`{ const e = document.getElementById('target').elements.${name}; e.value = '${end}'; e.dispatchEvent(new Event('input')); }`);
    const kind = await run(`document.querySelector('.chart').className`);
    check(!/met/.test(kind) && /open/.test(kind), 'neither met nor missed: ' + kind);
    check(/1 branch solved, 1 ends early/.test(await textOf('#state')), await textOf('#state'));
    // A mechanism that does not reach: no point on any branch.
    await browser.open(path.join(folder, 'wishbone.html'));
    await typeIn('points.tie_rod_outer.z', '9000');
    await idle();
    const points = await run('state.now.branches.reduce((sum, b) => sum + b.points, 0)');
    check(points > 0 || !/7 branches solved/.test(await textOf('#state')), 'branches without a point are not solved: ' + await textOf('#state'));
  },
  async aDeadWorkerIsSaidAndReplaced() {
    await browser.open(path.join(folder, 'wishbone.html'));
    await browser.until(`/41 of 41/.test(document.getElementById('notes').textContent)`, 'proved');
    await run(`(typeof solvers === 'object' ? solvers.front.worker : worker).terminate()`);
    await run(`typeof patience === 'object' && (patience.begin = 1500)`);
    const before = await valueOf('wheel_rate');
    await typeIn('springs.coil.rate', '120');
    await wait(.9);
    check(await run(`document.body.dataset.status`) === 'solving' && await opacity('#charts') < .6, `dimmed: ${await textOf('#state')}, ${await opacity('#charts')}`);
    check(!/41 of 41/.test(await textOf('#notes')), 'no proof of other numbers: ' + await textOf('#notes'));
    await browser.until(`document.body.dataset.status === 'solved' && /1 number changed/.test(document.getElementById('state').textContent)`, 'solved by a new worker', 15);
    check(await valueOf('wheel_rate') > before + 5, `the new rate: ${before} ${await valueOf('wheel_rate')}`);
    await wait(.5);
    check(await opacity('#charts') > .9, 'no longer dimmed');
    await click('reset');
  },
  async whatIsNoNumberIsNotSolvedNotSaved() {
    await browser.until(`/41 of 41/.test(document.getElementById('notes').textContent)`, 'proved');
    const top = () => run(`document.getElementById('drawing').getBoundingClientRect().top + scrollY`), place = await top();
    await typeIn('springs.coil.rate', 'abc');
    await idle();
    await wait(.6); // dimming begins .3 s after the change and takes .15 s
    check(await run(`document.body.dataset.status`) === 'failed' && (await textOf('#state')).startsWith('not solved'), 'failed: ' + await textOf('#state'));
    check(await opacity('#charts') < .6 && await opacity('#scenery') < .6 && !/41 of 41/.test(await textOf('#notes')), `dimmed, without proofs: ${await opacity('#charts')}, ${await opacity('#scenery')}, ${await textOf('#notes')}`);
    check(await top() === place, 'the message moves nothing: ' + (await top() - place));
    await pictureOf('failed');
    await run('window.live.saved = undefined');
    await run(`document.getElementById('save').click()`);
    await wait(.5);
    check(await run('window.live.saved === undefined'), 'not saved: ' + /rate: abc/.test(await run('window.live.saved') ?? ''));
    check((await textOf('#trouble')).includes('not saved'), 'and said: ' + await textOf('#trouble'));
    await click('reset');
    check(await run(`document.body.dataset.status`) === 'solved' && await run(`document.getElementById('trouble').hidden`), 'solved again');
  },
  async aLongSolveIsCancelled() {
    const file = path.join(folder, 'million.yaml');
    writeFileSync(file, readFileSync(wishbone, 'utf8').replace('to: 0.08, steps: 80', 'to: 0.08, steps: 1000000'));
    const begun = Date.now();
    await browser.open(pageOf(file, 'million'));
    check(Date.now() - begun < 15e3, `the first picture does not wait for a million steps: ${(Date.now() - begun) / 1e3} s`);
    await run(`document.getElementById('published')?.click()`);
    await browser.until(`document.getElementById('cancel') && !document.getElementById('cancel').hidden`, 'a long solve can be cancelled', 10);
    const {x, y} = await run(`(({x, y}) => ({x: x + 5, y: y + 5}))(document.getElementById('cancel').getBoundingClientRect())`);
    await press(x, y);
    await letGo(x, y);
    await statusIs('failed', 'cancelled', 3);
    check((await textOf('#state')).includes('cancelled'), await textOf('#state'));
    await run(`document.getElementById('published').click()`);
    await statusIs('solved', 'solved after that', 10);
  },
  async aFileOpenedDuringADrag() {
    await browser.open(path.join(folder, 'wishbone.html'));
    await viewFrom('Front');
    const [x, y] = await handleOf('upper_ball');
    await press(x, y);
    await to(x, y - 4);
    await run(`openFiles([new File([${JSON.stringify(readFileSync(scene('trailing_arm'), 'utf8'))}], 'trailing_arm.yaml')])`);
    await to(x, y - 8);
    await letGo(x, y - 8);
    check(await run(`state.file`) === 'trailing_arm.yaml' && (await settings()).length === 0, 'the new scene is as opened');
    await run(`state.saved = '[]'`);
    await browser.open(path.join(folder, 'wishbone.html'));
  },
  async aClickKeepsWhatCanBeRedone() {
    await viewFrom('Front');
    const [x, y] = await handleOf('upper_ball');
    await press(x, y);
    await to(x, y - 6);
    await letGo(x, y - 6);
    await click('undo');
    const [u, v] = await handleOf('lower_ball');
    await press(u, v);
    await letGo(u, v);
    check(!await run(`document.getElementById('redo').disabled`), 'redo is still there');
    await click('redo');
    check((await settings()).length > 0, 'and works');
    await click('reset');
  },
  async undoInsideAnEntry() {
    const shownIn = () => run(`document.activeElement.value`), undo = async () => {
      for (const type of ['rawKeyDown', 'keyUp'])
        await browser.send('Input.dispatchKeyEvent', {type, key: 'z', code: 'KeyZ', windowsVirtualKeyCode: 90, modifiers: 2, commands: type === 'rawKeyDown' ? ['undo'] : []});
      await idle();
    };
    await typeIn('springs.coil.rate', '120');
    await idle();
    await undo();
    check(await shownIn() === '95' && (await settings()).length === 0, `what is shown is solved: ${await shownIn()} ${JSON.stringify(await settings())}`);
    await run('document.activeElement.select()');
    await browser.send('Input.insertText', {text: '77'});
    await undo();
    check(await shownIn() === '95' && (await settings()).length === 0, `text not entered is taken back: ${await shownIn()}`);
    await run('document.activeElement.blur()');
    await idle();
    check((await settings()).length === 0, 'and stays so');
  },
  async aSecondFingerEndsTheDrag() {
    await viewFrom('Front');
    const [x, y] = await handleOf('upper_ball');
    const touch = (type, ...points) => browser.send('Input.dispatchTouchEvent', {type, touchPoints: points.map(([px, py], id) => ({x: px, y: py, id}))});
    await touch('touchStart', [x, y]);
    await touch('touchMove', [x, y - 20]);
    await touch('touchMove', [x, y - 30]);
    await idle();
    await touch('touchStart', [x, y - 30], [x + 80, y + 60]);
    await touch('touchMove', [x, y - 30], [x + 90, y + 70]);
    await touch('touchEnd');
    await idle();
    check(await pointsOf(`${chart('toe')} path.now`) === 41 && await run('state.now.branches.length') === 7, 'all is solved at rest: ' + await pointsOf(`${chart('toe')} path.now`));
    check((await settings()).length > 0 && !await run(`document.getElementById('undo').disabled`), 'what was dragged stays, and can be undone');
    await click('reset');
  },
  async aBrowserWithoutSimd() {
    const {identifier} = await browser.send('Page.addScriptToEvaluateOnNewDocument', {source: 'WebAssembly.validate = () => false;'});
    await browser.send('Page.navigate', {url: 'file://' + path.join(folder, 'wishbone.html')});
    await wait(2);
    check(/Chrome.*91.*Firefox.*Safari/.test(await textOf('#trouble')), 'which browsers can: ' + await textOf('#trouble'));
    await browser.send('Page.removeScriptToEvaluateOnNewDocument', {identifier});
    check(readFileSync(path.join(folder, 'wishbone.html'), 'utf8').includes('<noscript>'), 'and without scripts');
    await browser.open(path.join(folder, 'wishbone.html'));
  },
  async whatTheNumbersMean() {
    const text = await run(`document.querySelector('#static [data-trim="springs.coil.preload"]').textContent`);
    check(/changed by.*makes force 7\d{3}/.test(text.replace(/\s+/g, ' ')), 'the preload that the trim makes, and the change: ' + text);
    check(await run(`document.querySelectorAll('#charts .band, #charts .fastline').length`) === 0 && !/published recursion off/.test(await textOf('#charts')), 'the published recursion is not shown');
    await run(`document.getElementById('published')?.click()`);
    await idle();
    check(await run(`document.querySelectorAll('#charts .band').length`) > 3 && /published recursion off/.test(await textOf('#charts')), 'but where it is asked for');
    await run(`document.getElementById('published')?.click()`);
    await idle();
    check(await run(`document.querySelectorAll('#charts .band').length`) === 0, 'and off again');
  },
  // ---- Under the hand
  async dragsByStepsAndByTenths() {
    await viewFrom('Front');
    const [x, y] = await handleOf('upper_ball'), z0 = await run(`numberOf('points.upper_ball.z')`), z = async () => 1e3 * (await run(`numberOf('points.upper_ball.z')`) - z0);
    await press(x, y);
    await to(x, y - 5);
    near(await z(), 5, 1e-6, 'a pixel is a step at most');
    check(/z \+5 mm/.test(await run(`document.querySelector('.handle.chosen text').textContent`)), 'how far, beside the handle: ' + await run(`document.querySelector('.handle.chosen text').textContent`));
    await to(x, y - 7, {modifiers: 8});
    near(await z(), .7, 1e-6, 'Shift: a tenth');
    await browser.key('Escape');
    await idle();
    check((await settings()).length === 0, 'Escape takes it back');
    await to(x, y - 9);
    await letGo(x, y - 9);
    check((await settings()).length === 0 && await run(`document.getElementById('undo').disabled`), 'and ends the drag');
    // In an oblique view along one axis: that which the pointer follows, or the chosen one.
    await viewFrom('Oblique');
    const [u, v] = await handleOf('upper_ball');
    await press(u, v);
    await to(u + 1, v - 20);
    await letGo(u + 1, v - 20);
    check((await settings()).length === 1 && (await settings())[0][0] === 'points.upper_ball.z', 'along z: ' + JSON.stringify(await settings()));
    await click('reset');
  },
  async turnsPansZoomsAndFits() {
    await run(`window.scrollTo(0, 0)`);
    const box = await run(`(({x, y, width, height}) => [x, y, width, height])(document.getElementById('drawing').getBoundingClientRect())`);
    const [x, y] = [box[0] + 20, box[1] + 20], state_ = () => run('JSON.stringify(view)'), wheel = () => browser.send('Input.dispatchMouseEvent', {type: 'mouseWheel', x, y, deltaX: 0, deltaY: 60});
    await press(box[0] + 30, 5);
    await letGo(box[0] + 30, 5);
    const before = await state_();
    await wheel();
    await wait(.3);
    check(await state_() === before && await run('scrollY') > 0, 'the page scrolls over the drawing');
    await run(`window.scrollTo(0, 0)`);
    await press(x, y, {modifiers: 8});
    await to(x + 30, y + 10, {modifiers: 8});
    await letGo(x + 30, y + 10, {modifiers: 8});
    const [yaw, centre] = await run('[view.yaw, view.centre]');
    check(yaw === JSON.parse(before).yaw && JSON.stringify(centre) !== JSON.stringify(JSON.parse(before).centre), 'Shift moves the view');
    const [hx, hy] = await handleOf('upper_ball');
    await browser.send('Input.dispatchMouseEvent', {type: 'mouseWheel', x: hx, y: hy, deltaX: 0, deltaY: -120});
    await wait(.3);
    const [zx, zy] = await handleOf('upper_ball');
    check(await run('view.zoom') > 1.1 && Math.hypot(zx - hx, zy - hy) < 1.5 && await run('scrollY') === 0, 'once pressed it zooms, at the cursor: ' + [zx - hx, zy - hy]);
    await run(`document.getElementById('fit').click()`);
    near(await run('view.zoom'), 1, 0, 'the whole');
  },
  async chartsAnswerThePointer() {
    const box = await run(`(({x, y, width, height}) => [x, y, width, height])(document.querySelector('${chart('toe')} svg').getBoundingClientRect())`);
    const at = [box[0] + box[2] * .8, box[1] + box[3] * .4];
    await to(...at);
    check(/mm: .*deg/.test(await textOf('#readout')) && !await run(`document.getElementById('readout').hidden`), 'values at the pointer: ' + await textOf('#readout'));
    await press(...at);
    await letGo(...at);
    check(value((await textOf('#motion-at')).split(' ')[0]) > 40, 'a click sets the position: ' + await textOf('#motion-at'));
    await run(`document.querySelector('${chart('toe')} .enlarge').click()`);
    check(await run(`document.querySelector('${chart('toe')}').offsetWidth`) > 1.8 * box[2], 'enlarged');
    await run(`document.querySelector('${chart('toe')} .enlarge').click()`);
    await run(`document.getElementById('csv').click()`);
    const lines = (await run('window.live.saved')).split('\n'), row = lines.find(line => line.startsWith('travel,80,mm,toe,deg,'));
    near(+row?.split(',')[5], byProgram(wishbone, 'travel', ['toe'], []).at(-1)[1], 1e-7, 'curves as a table: ' + lines[0]);
    await run(`document.getElementById('choose').open = true`);
    await set('search', 'bump st', 'input');
    const seen = await run(`[...document.querySelectorAll('#choose div label')].filter(l => !l.hidden).map(l => l.textContent)`);
    check(seen.length > 0 && seen.every(t => t.includes('bump_st')), 'a list to search: ' + seen);
    await run(`document.getElementById('choose').open = false`);
    await set('motion', 20, 'input');
  },
  async variantsAreKeptAndCompared() {
    await viewFrom('Front');
    const [x, y] = await handleOf('tie_rod_inner');
    await press(x, y);
    await to(x, y - 4);
    await letGo(x, y - 4);
    const first = await settings();
    await click('keep');
    await press(...await handleOf('tie_rod_inner'));
    await to(x, y - 9);
    await letGo(x, y - 9);
    check(await run(`document.querySelectorAll('${chart('toe')} path.variant.A').length`) === 1, 'A is in the charts');
    await set('compare', 'A', 'change');
    await idle();
    await set('motion', 40, 'input');
    await set('table-at', 'shown', 'change');
    const toe = changes => byProgram(wishbone, 'travel', ['toe'], changes).at(-1)[1], now = await settings();
    near(value((await rowOf('toe'))[4]), toe(now) - toe(first), 1e-3 * Math.abs(toe(now) - toe(first)), 'the change against A');
    check((await textOf('#static thead')).includes('A'), 'which is named');
    // Kept in the browser: the page warns, and offers it again.
    browser.dialogs.length = 0;
    await browser.open(path.join(folder, 'wishbone.html'));
    check(browser.dialogs.includes('beforeunload'), 'leaving is asked for');
    check((await settings()).length === 0 && !await run(`document.getElementById('restore').hidden`), 'opened as it is in the file');
    await click('restore');
    check(JSON.stringify(await settings()) === JSON.stringify(now) && await run('state.variants.length') === 1, 'and restored');
    await run(`[...document.querySelectorAll('#variants button')][0].click()`);
    await idle();
    check(JSON.stringify(await settings()) === JSON.stringify(first), 'back to A: ' + JSON.stringify(await settings()));
    await pictureOf('variants', true);
    await run(`[...document.querySelectorAll('#variants button')][1].click()`);
    await click('reset');
  },
  async keyboardReachesTheCurves() {
    await run(`document.activeElement.blur(); window.scrollTo(0, 0)`);
    await browser.open(path.join(folder, 'wishbone.html'));
    await browser.key('Tab');
    check(await textOf(':focus') === 'To the curves', 'the first Tab: ' + await textOf(':focus'));
    await browser.key('Enter');
    await browser.key('Tab');
    check(await run(`document.activeElement.closest('#charts') !== null`), 'the next one is in the charts');
  },
  async printsTheResults() {
    await browser.send('Emulation.setEmulatedMedia', {media: 'print'});
    const seen = await run(`[...document.querySelectorAll('button,select,input[type=range]')].filter(e => e.offsetParent !== null).length`);
    check(seen === 0, `${seen} buttons on paper`);
    check(await run(`document.querySelector('#drawing').offsetParent !== null || document.querySelector('#drawing').getBoundingClientRect().width > 100`) && await run(`document.querySelectorAll('#charts .chart').length`) > 3, 'drawing and charts');
    await pictureOf('print', true);
    await browser.send('Emulation.setEmulatedMedia', {media: ''});
  },
};
await runTests(tests);
