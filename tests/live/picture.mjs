// Writes the picture of the README: the drawing and some curves of a live page, with a hardpoint moved, as one SVG.
// node picture.mjs PAGE OUTPUT
import {writeFileSync} from 'node:fs';
import {Browser} from './browser.mjs';

const [page, output] = process.argv.slice(2);
const browser = await Browser.start();
try {
  await browser.open(page, {width: 1100, height: 900});
  await browser.run(`(async () => {
    edit(() => putCoordinates('tie_rod_inner', add(coordinatesOf('tie_rod_inner'), 1, [0, 0, 12]))); choose('tie_rod_inner');
    view.yaw = 40; view.pitch = 18; view.zoom = 1.15; draw3d(); state.curves = ['toe', 'camber', 'roll_centre_height', 'wheel_rate']; drawCharts(); })()`);
  await browser.until('isIdle() && state.settings.size === 1 && proofOf(state.branch)?.done', 'solved and proved');
  writeFileSync(output, await browser.run(`(() => {
    const wide = 900, high = 356, whole = make('svg', {xmlns: 'http://www.w3.org/2000/svg', viewBox: '0 0 ' + wide + ' ' + high, 'font-family': 'system-ui, sans-serif'});
    whole.append(make('rect', {width: wide, height: high, fill: '#fff'}), make('rect', {x: 0, y: 0, width: 420, height: high, rx: 6, fill: '#f5f7f9'}));
    const drawing = copyOf(document.getElementById('drawing'));
    for (const [name, value] of Object.entries({x: 0, y: 0, width: 420, height: high})) drawing.setAttribute(name, value);
    whole.append(drawing);
    [...document.querySelectorAll('#charts .chart')].forEach((chart, k) => {
      const x = 436 + 236 * (k % 2), y = 178 * Math.floor(k / 2), svg = copyOf(chart.querySelector('svg'));
      for (const [name, value] of Object.entries({x, y: y + 22, width: 224, height: 122})) svg.setAttribute(name, value);
      const say = (text, px, py, more) => whole.append(make('text', {x: px, y: py, 'font-size': 11, fill: '#22272e', ...more}, text));
      say(chart.querySelector('h3 span').textContent, x, y + 16, {'font-weight': 600});
      say(chart.querySelector('.value').textContent, x + 222, y + 16, {'font-weight': 600, fill: '#1b62a5', 'text-anchor': 'end'});
      say(chart.querySelector('.fast span').textContent, x, y + 156, {'font-size': 9, fill: '#5b6470'});
      whole.append(svg);
    });
    return new XMLSerializer().serializeToString(whole) + '\\n';
  })()`));
} finally { browser.stop(); }
