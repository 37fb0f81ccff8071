// What the live page offers under the hand, on a wheel and on a mirrored axle: curves by what a branch moves, both wheels in
// a chart, the drawing's axes and centres, groups, lengths that stay, pictures, units, wishes before they are taken over.
// [BROWSER=firefox] node offers.mjs ELASTOCHECK SCENES-FOLDER [PICTURES-FOLDER]
import {writeFileSync} from 'node:fs';
import path from 'node:path';
import {browser, byProgram, check, click, folder, handleOf, idle, inFirefox, near, pageOf, pictureOf, run, runTests, scene, set, settings, textOf, value,
  viewFrom, wait} from './harness.mjs';

const wishbone = scene('double_wishbone'), axle = scene('front_axle');
const pages = {wishbone: pageOf(wishbone, 'wishbone'), axle: pageOf(axle, 'axle')};
const open = name => browser.open(pages[name], {width: 1500, height: 1000});
const press = (x, y, more) => browser.mouse('mousePressed', x, y, more);
const to = async (x, y, more) => { await browser.mouse('mouseMoved', x, y, more); await idle(); };
const letGo = async (x, y, more) => { await browser.mouse('mouseReleased', x, y, more); await idle(); };
const middleOf = selector => run(`(e => { e.scrollIntoView({block: 'center'}); const {x, y, width, height} = e.getBoundingClientRect(); return [x + width / 2, y + height / 2]; })(document.querySelector(${JSON.stringify(selector)}))`);
const clickOn = async selector => { const at = await middleOf(selector); await press(...at); await letGo(...at); };
const hover = (x, y) => to(x, y, {button: 'none', buttons: 0});
const drag = async (name, dx, dy, more) => {
  await run('window.scrollTo(0, 0)');
  const [x, y] = await handleOf(name);
  await press(x, y, more);
  await to(x + dx, y + dy, more);
  await letGo(x + dx, y + dy, more);
};
const charts = () => run(`[...document.querySelectorAll('#charts .chart')].map(c => c.dataset.channel)`);
const numbersOf = (...names) => run(`${JSON.stringify(names)}.map(n => 1e3 * numberOf('points.' + n))`);
const pixels = () => run(`(async () => { const picture = await createImageBitmap(window.live.saved), canvas = document.createElement('canvas');
  canvas.width = picture.width; canvas.height = picture.height; const brush = canvas.getContext('2d'); brush.drawImage(picture, 0, 0);
  const data = new Uint32Array(brush.getImageData(0, 0, picture.width, picture.height).data.buffer);
  return {type: window.live.saved.type, width: picture.width, height: picture.height, colours: new Set(data).size, paper: data.filter(v => v === data[0]).length / data.length}; })()`);

const tests = {
  async firstCurvesByWhatABranchMoves() {
    await open('axle');
    const first = {parallel: ['toe', 'camber', 'roll_centre_height', 'wheel_rate', 'anti_dive'], opposite: ['roll_centre_height', 'roll_stiffness'],
      steering: ['ackermann', 'steer_gradient'], lateral: ['toe', 'camber', 'lateral_force_steer@parallel', 'lateral_force_steer@opposed', 'lateral_force_camber@parallel'],
      braking: ['toe', 'camber', 'braking_force_steer@both', 'braking_force_camber@both']};
    for (const [branch, expected] of Object.entries(first)) {
      await clickOn(`#branches [data-branch=${branch}]`);
      const list = await charts();
      check(expected.every((name, k) => list[k] === name) && list.length <= 9 && new Set(list).size === list.length, `${branch}: ${list}`);
    }
  },
  async bothWheelsInOneChart() {
    await clickOn('#branches [data-branch=opposite]');
    const toe = '#charts [data-channel=toe]';
    check(await run(`document.querySelectorAll('${toe} path.now').length`) === 2 && await run(`document.querySelectorAll('${toe} path.now.other').length`) === 1, 'two curves, one dashed');
    check(await textOf(`${toe} .fast`).then(t => /left.*right/.test(t)), 'which are named: ' + await textOf(`${toe} .fast`));
    const box = await run(`(({x, y, width, height}) => [x, y, width, height])(document.querySelector('${toe} svg').getBoundingClientRect())`);
    await hover(box[0] + box[2] * .85, box[1] + box[3] * .4);
    const words = await textOf('#readout'), [, a, left, right] = words.match(/^(\S+) mm: left (\S+) · right (\S+) deg$/) ?? [];
    const row = byProgram(axle, 'opposite', ['left.toe', 'right.toe'], []).find(r => Math.abs(r[0] - value(a ?? 'x')) < 1e-9);
    near(value(left ?? 'x'), row?.[1], 1e-3, `left: ${words}`);
    near(value(right ?? 'x'), row?.[2], 1e-3, `right: ${words}`);
    check(!await run(`document.getElementById('cursor').hidden`) && Math.abs(await run(`document.getElementById('cursor').getBoundingClientRect().x`) - box[0] - box[2] * .85) < 6, 'a line at the pointer');
    await run(`document.getElementById('csv').click()`);
    const table = await run('window.live.saved');
    check(/\nopposite,\S+,mm,left\.toe,deg,/.test(table) && /\nopposite,\S+,mm,right\.toe,deg,/.test(table), 'both in the table');
    await pictureOf('both_wheels');
  },
  async theOtherSideOfAMirroredAxle() {
    await viewFrom('Front');
    const names = ['tie_rod_inner_left.y', 'tie_rod_inner_left.z'], [y0, z0] = await numbersOf(...names);
    await drag('tie_rod_inner_right', 6, -4);
    const [y1, z1] = await numbersOf(...names);
    check(Math.abs(y1 - y0 + 6) < 2.1 && Math.abs(z1 - z0 - 4) < 1.1 && y1 < y0, `the right one moves both: ${[y1 - y0, z1 - z0]}`);
    const [left, right] = [await handleOf('tie_rod_inner_left'), await handleOf('tie_rod_inner_right')];
    check(Math.abs(left[1] - right[1]) < .6, 'at one height');
    check((await settings()).every(([p]) => p.startsWith('points.tie_rod_inner_left.')), JSON.stringify(await settings()));
    await pictureOf('mirrored');
    await click('reset');
    await viewFrom('Side');
    const [u, v] = await handleOf('tie_rod_inner_left');
    await press(u, v);
    check(/^(rack|tie_rod_inner_(left|right))$/.test(await run('state.held.name')), 'of handles that overlap the nearest: ' + await run('state.held.name'));
    await letGo(u, v);
  },
  async axesAndCentresAreTheFigures() {
    await open('wishbone');
    await viewFrom('Front');
    for (const a of [0, 40]) {
      const [, height, arm, side, caster, kingpin] = byProgram(wishbone, 'travel', ['roll_centre_height', 'front_view_swing_arm', 'side_view_swing_arm', 'caster', 'kingpin_inclination'], []).find(r => r[0] === a);
      const [roll, front, from, lower, upper, centre, patch] = await run(`(() => { const b = state.now.branch('travel'), k = state.now.exact(b, ${a}), g = i => state.now.guide(b, k, i), {wheels: [w]} = state.now.drawing;
        return [g(4), g(2), g(3), g(0), g(1), state.now.point(b, k, w.centre), state.now.point(b, k, w.patch)]; })()`);
      near(roll[2] - patch[2], height, 1e-6 * Math.abs(height) + 1e-9, `roll centre at ${a} mm`);
      near(roll[1], 0, 0, 'in the middle');
      near(centre[1] - front[1], arm, 1e-6 * Math.abs(arm), `instant centre from the front at ${a} mm`);
      near(from[0] - centre[0], side, 1e-6 * Math.abs(side), `from the side at ${a} mm`);
      const u = upper.map((v, k) => v - lower[k]), deg = 180 / Math.PI;
      near(Math.atan(-u[0] / u[2]) * deg, caster, 1e-7, `caster at ${a} mm`);
      near(Math.atan(-u[1] / u[2]) * deg, kingpin, 1e-7, `kingpin at ${a} mm`);
      // The patch moves across the line to its instant centre, so that the roll centre is on it.
      const slope = p => (p[2] - patch[2]) / (p[1] - patch[1]);
      near(slope(roll), slope(front), .02 * Math.abs(slope(front)) + .002, `one line at ${a} mm`);
    }
    const seen = kind => run(`document.querySelectorAll('#scenery .guide.${kind}').length`);
    check(await seen('roll') === 1 && await seen('instant') === 1, 'lines lead out of sight, without a mark there');
    await run('view.zoom = .1; draw3d()');
    check(await seen('roll') === 2 && await seen('kingpin') === 1 && await seen('instant') === 2, 'drawn with their lines');
    await click('fit');
    await pictureOf('centres');
    await viewFrom('Side');
    check(await seen('roll') === 0 && await seen('instant') === 1, 'from the side the line to the other instant centre, 20 m away');
    await clickOn('#guides');
    check(await seen('kingpin') === 0, 'and not where they are switched off');
    await clickOn('#guides');
    await viewFrom('Oblique');
    check(await run(`document.querySelectorAll('#scenery .road').length`) === 1, 'the road');
  },
  async linksTellTheirGeometry() {
    await viewFrom('Front');
    const [a, b] = [await handleOf('tie_rod_inner'), await handleOf('tie_rod_outer')], at = k => a[k] + .6 * (b[k] - a[k]);
    await hover(at(0), at(1));
    const words = await textOf('#readout'), [, length] = words.match(/^tie_rod: (\S+) mm, \S+ deg from the front, \S+ deg from the side$/) ?? [];
    const ends = await run(`['tie_rod_inner', 'tie_rod_outer'].map(coordinatesOf)`), {by} = await run(`state.now.trim.find(t => t.name.includes('tie_rod'))`);
    near(+length, Math.hypot(...ends[0].map((v, k) => v - ends[1][k])) + by, .06, `length of the tie rod, of which the trim makes ${by} mm: ${words}`);
  },
  async pointsMoveTogetherAndLengthsStay() {
    await viewFrom('Front');
    const names = ['lower_ball.z', 'upper_ball.z', 'upper_rear.z'], before = await numbersOf(...names);
    const [x, y] = await handleOf('lower_ball');
    await press(x, y, {modifiers: 2});
    await letGo(x, y, {modifiers: 2});
    await run(`choose('upper_ball')`);
    await clickOn('#group');
    check(await run(`document.querySelectorAll('.handle.grouped').length`) === 2 && await run(`document.getElementById('group').getAttribute('aria-pressed')`) === 'true', 'a group of two');
    await drag('lower_ball', 0, -5);
    const moved = (await numbersOf(...names)).map((v, k) => v - before[k]);
    near(moved[0], 5, 1e-6, 'the one that is dragged');
    near(moved[1], 5, 1e-6, 'the other of the group');
    near(moved[2], 0, 1e-9, 'and no other');
    await click('undo');
    check((await settings()).length === 0, 'one step to undo');
    await run(`choose('upper_ball')`);
    await clickOn('#group');
    // A length that stays: the other end does not move, the dragged one goes around it.
    const length = () => run(`Math.hypot(...coordinatesOf('tie_rod_inner').map((v, k) => v - coordinatesOf('tie_rod_outer')[k]))`), was = await length();
    const [first, later] = await run(`(async () => { choose('tie_rod_inner'); const top = () => document.querySelector('#links input').getBoundingClientRect().top, at = top();
      for (let k = 0; k < 3; ++k) await new Promise(done => requestAnimationFrame(() => setTimeout(done))); return [at, top()]; })()`);
    near(later, first, .1, 'what can be pressed stays where it is');
    check(/tie_rod, to tie_rod_outer: 3\d\d(\.\d)? mm/.test(await textOf('#links')), 'its links: ' + await textOf('#links'));
    await clickOn('#links input');
    await drag('tie_rod_inner', 3, -12);
    near(await length(), was, 2e-6, 'the length stays');
    check((await settings()).length >= 2 && await run(`numberOf('points.tie_rod_inner.z') > .008`), 'while the point moves: ' + JSON.stringify(await settings()));
    await pictureOf('length');
    await clickOn('#links input');
    await click('reset');
    await drag('tie_rod_inner', 3, -12);
    check(Math.abs(await length() - was) > 1, 'and is free again');
    await click('reset');
  },
  async picturesOfChartAndDrawing() {
    await run(`window.scrollTo(0, 0); window.live.saved = undefined`);
    await clickOn('#charts [data-channel=camber] .shot');
    await browser.until('window.live.saved?.size > 0', 'a picture of the chart', 10);
    const chart = await pixels();
    check(chart.type === 'image/png' && chart.width === 1056 && chart.colours > 20 && chart.paper > .5 && chart.paper < .99, 'a chart: ' + JSON.stringify(chart));
    await run('window.live.saved = undefined');
    await clickOn('#drawing-png');
    await browser.until('window.live.saved?.size > 0', 'a picture of the drawing', 10);
    const drawing = await pixels();
    check(drawing.type === 'image/png' && drawing.width > 900 && drawing.colours > 20 && drawing.paper > .5, 'the drawing: ' + JSON.stringify(drawing));
    check(await run(`document.getElementById('trouble').hidden`), 'no message: ' + await textOf('#trouble'));
  },
  async unitsOfThePage() {
    const units = await run(`[...new Set([...document.querySelectorAll('#list .unit')].map(u => u.textContent))].sort()`);
    check(units.every(u => ['', 'N', 'N/mm', 'N·m', 'N·m/deg', 'deg', 'mm', 'kg'].includes(u)) && units.includes('mm') && units.includes('N/mm'), 'units: ' + units);
    const entry = p => run(`document.querySelector('#list [data-path="${p}"] input[type=text]').value`);
    check(await entry('springs.coil.rate') === '95' && await entry('points.upper_ball.z') === '243', `${await entry('springs.coil.rate')} N/mm, ${await entry('points.upper_ball.z')} mm`);
    await set('find', 'upper_ball.z', 'input');
    await clickOn('#list [data-path="points.upper_ball.z"] input[type=text]');
    await run('document.activeElement.select()');
    await browser.send('Input.insertText', {text: '248.5'});
    await browser.key('Enter');
    await idle();
    check(JSON.stringify(await settings()) === '[["points.upper_ball.z","0.2485"]]', 'the file keeps its own: ' + JSON.stringify(await settings()));
    await set('find', '', 'input');
    await click('reset');
  },
  async aWishIsSeenBeforeItIsTakenOver() {
    await clickOn('#wishes summary');
    await browser.until(`document.querySelectorAll('#varies .vary').length === 3`, 'a figure, and the three coordinates that move it most', 60);
    check(await run(`document.querySelector('#wants .want select').value`) === 'toe' && await run(`[...document.querySelectorAll('#varies input[list]')].some(i => i.value.startsWith('points.tie_rod'))`), 'a useful first wish');
    await run(`document.getElementById('wants').replaceChildren(); addWant('toe', 'travel', 80, '-0.1')`);
    await clickOn('#wish-go');
    await browser.until(`!document.getElementById('wish-take').hidden`, 'an answer', 60);
    check((await settings()).length === 0 && await run(`document.querySelectorAll('#charts [data-channel=toe] path.variant.preview').length`) === 1, 'shown, and no number changed');
    await pictureOf('preview', true);
    await clickOn('#wish-drop');
    check(await run(`document.querySelectorAll('path.variant.preview').length`) === 0 && (await settings()).length === 0, 'discarded');
    await clickOn('#wish-go');
    await browser.until(`!document.getElementById('wish-take').hidden`, 'an answer again', 60);
    await clickOn('#wish-take');
    near(byProgram(wishbone, 'travel', ['toe'], await settings()).at(-1)[1], -.1, 1e-6, 'taken over');
    check(await run(`document.getElementById('wish-take').hidden`), 'once');
    await run(`document.getElementById('wishes').open = false`);
  },
  async whatIsShownBecomesTheReference() {
    await clickOn('#refer');
    check(await textOf('#was-name') === 'A' && await run(`document.getElementById('compare').value`) === 'A' && !await run('isChanged()'), 'compared with itself: ' + await textOf('#was-name'));
    await viewFrom('Front');
    await drag('upper_ball', 0, -4);
    check((await textOf('#static thead')).includes('A') && await run(`document.querySelectorAll('#charts path.was').length`) > 3, 'then with what it was');
    // The page with its numbers and variants as a file.
    const numbers = await settings();
    await run('window.live.saved = undefined');
    await clickOn('#save-page');
    const file = path.join(folder, 'saved.html');
    writeFileSync(file, await run('window.live.saved'));
    await browser.open(file, {width: 1500, height: 1000});
    await idle();
    check(JSON.stringify(await settings()) === JSON.stringify(numbers) && await run(`state.variants.map(v => v.name).join()`) === 'A', 'in the file: ' + JSON.stringify(await settings()));
    check(await run(`document.body.dataset.status`) === 'solved' && browser.complaints.length === 0, 'which opens and solves: ' + await textOf('#state'));
    await click('reset');
    await run(`localStorage.clear(); state.saved = '[]'`);
  },
  async byFingersOnAPhone() {
    await browser.open(pages.wishbone, {width: 390, height: 844});
    await viewFrom('Front');
    const [x, y] = await handleOf('upper_ball'), z = await run(`numberOf('points.upper_ball.z')`);
    const touch = (type, ...points) => browser.send('Input.dispatchTouchEvent', {type, touchPoints: points.map(([px, py], id) => ({x: px, y: py, id}))});
    await touch('touchStart', [x, y]);
    for (const up of [4, 8, 12]) await touch('touchMove', [x, y - up]);
    await idle();
    await touch('touchEnd');
    await idle();
    check(await run(`numberOf('points.upper_ball.z')`) > z + .004, 'a finger drags a hardpoint: ' + JSON.stringify(await settings()));
    check(await run('document.documentElement.scrollWidth') <= 390, 'no sideways scrolling: ' + await run('document.documentElement.scrollWidth'));
    await wait(.3);
    await pictureOf('phone');
    await click('reset');
  },
};
if (inFirefox) delete tests.byFingersOnAPhone;  // Marionette has no fingers on a page of this width
await runTests(tests);
