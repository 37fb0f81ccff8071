// What the tests of the live page share: the browser, pages of scenes, numbers of the program, the run of the tests.
// [BROWSER=firefox] node TESTS.mjs ELASTOCHECK SCENES-FOLDER [PICTURES-FOLDER]
import {execFileSync} from 'node:child_process';
import {mkdtempSync, rmSync} from 'node:fs';
import {tmpdir} from 'node:os';
import path from 'node:path';
import {Browser} from './browser.mjs';
import {Firefox} from './firefox.mjs';

export const [program, scenes, pictures] = process.argv.slice(2).map(file => path.resolve(file));
export const folder = mkdtempSync(path.join(tmpdir(), 'live-pages-'));
export const scene = name => path.join(scenes, name + '.yaml');
export const pageOf = (file, name) => {
  const page = path.join(folder, name + '.html');
  execFileSync(program, ['live', file, '-o', page]);
  return page;
};
const failures = [];
export const check = (met, what) => { if (!met) { failures.push(what); console.error('failed: ' + what); } };
export const near = (a, b, bound, what) => check(Math.abs(a - b) <= bound, `${what}: ${a} is not ${b} within ${bound}`);
export const inFirefox = process.env.BROWSER === 'firefox';
export const browser = await (inFirefox ? Firefox : Browser).start();
export const run = expression => browser.run(expression);
// A move of the mouse is handled with the next frame.
export const idle = async () => {
  await run('new Promise(done => requestAnimationFrame(() => setTimeout(done)))');
  await browser.until('isIdle()', 'the solver is idle');
};
export const wait = seconds => new Promise(resolve => setTimeout(resolve, 1e3 * seconds));
export const pictureOf = async (name, full) => {
  if (pictures) await browser.picture(path.join(pictures, name + '.png'), full);
};
export const settings = () => run('[...state.settings]');
export const click = async id => { await run(`document.getElementById('${id}').click()`); await idle(); };
export const value = text => +text.replaceAll('−', '-');
export const textOf = selector => run(`document.querySelector(${JSON.stringify(selector)})?.textContent`);
export const set = (id, to, event) => run(`{ const e = document.getElementById('${id}'); e.value = ${JSON.stringify(to)};
  e.dispatchEvent(new Event('${event}')); }`);
export const viewFrom = name => run(`window.scrollTo(0, 0); [...document.querySelectorAll('#views button')].find(b => b.textContent === '${name}').click()`);
// The middle of a handle on the screen.
export const handleOf = name => run(`(() => { const h = [...document.querySelectorAll('.handle')].find(h => h.dataset.name === ${JSON.stringify(name)});
  const b = h.querySelector('.hit').getBoundingClientRect(); return [b.x + b.width / 2, b.y + b.height / 2]; })()`);
// Curves of a branch by the program: [[parameter, value, ...], ...].
export const byProgram = (file, branch, channels, changes, steps = 40) => {
  const words = ['solve', file, '--method', 'series', '--steps', String(steps), '--channels', channels.join(','),
    ...changes.flatMap(([p, v]) => ['--set', `${p}=${v}`])];
  const lines = execFileSync(program, words, {stdio: ['ignore', 'pipe', 'ignore'], maxBuffer: 1 << 26}).toString().trim().split('\n');
  return lines.filter(line => line.startsWith(branch + ',')).map(line => {
    const cells = line.split(',');
    return [cells[2], ...cells.slice(-channels.length)].map(Number);
  });
};
export const percentile = (list, share) =>
  [...list].sort((a, b) => a - b)[Math.min(list.length - 1, Math.floor(share * list.length))];
export const report = [];

export const runTests = async tests => {
  try {
    const chosen = Object.entries(tests).filter(([name]) => !process.env.ONLY || process.env.ONLY.split(',').includes(name));
    for (const [name, test] of chosen) {
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
};
