// ---- Pictures: a chart or the drawing as PNG, in the colours of the page. The style of each
// element becomes its attributes, since a picture has no style sheet.
import {$, make, trouble} from './base.js';
import {save, stem} from './files.js';
import {referenceName, state} from './state.js';
import {H, W, words} from './charts.js';

const drawn = ['fill', 'fill-opacity', 'stroke', 'stroke-width', 'stroke-dasharray',
  'stroke-linecap', 'stroke-linejoin', 'font-size', 'font-weight', 'opacity', 'paint-order'];
const usual = {'fill-opacity': '1', 'stroke-dasharray': 'none', 'stroke-linecap': 'butt',
  'stroke-linejoin': 'miter', 'font-weight': '400', opacity: '1', 'paint-order': 'normal',
  stroke: 'none'};
const geometry = ['d', 'x', 'y', 'x1', 'x2', 'y1', 'y2', 'cx', 'cy', 'r', 'width', 'height',
  'viewBox', 'transform', 'text-anchor'];
export const copyOf = element => {
  const style = getComputedStyle(element);
  if (element.matches('.hit, title') || style.display === 'none') return null;
  const fresh = document.createElementNS(element.namespaceURI, element.localName);
  for (const name of geometry)
    if (element.hasAttribute(name)) fresh.setAttribute(name, element.getAttribute(name));
  if (!['svg', 'g'].includes(element.localName))
    for (const name of drawn) {
      const value = style.getPropertyValue(name);
      const fits = name.startsWith('font') ? element.localName === 'text'
        : !name.startsWith('stroke') || style.stroke !== 'none';
      if (value !== usual[name] && fits) fresh.setAttribute(name, value);
    }
  for (const child of element.childNodes) {
    const made = child.nodeType === Node.TEXT_NODE ? child.cloneNode() : copyOf(child);
    if (made) fresh.append(made);
  }
  return fresh;
};
const colour = name => getComputedStyle(document.body).getPropertyValue(name).trim();
// Draws an SVG at `times` its size, and saves it.
const savePicture = async (picture, wide, high, times, name) => {
  const all = {xmlns: 'http://www.w3.org/2000/svg', width: wide, height: high,
    viewBox: `0 0 ${wide} ${high}`, 'font-family': 'system-ui, sans-serif'};
  for (const [key, value] of Object.entries(all)) picture.setAttribute(key, value);
  const text = new XMLSerializer().serializeToString(picture), image = new Image();
  image.src = URL.createObjectURL(new Blob([text], {type: 'image/svg+xml'}));
  try {
    await image.decode();
    const canvas = make('canvas', {width: Math.round(times * wide),
      height: Math.round(times * high)});
    const brush = canvas.getContext('2d');
    brush.fillStyle = colour('--paper');
    brush.fillRect(0, 0, canvas.width, canvas.height);
    brush.drawImage(image, 0, 0, canvas.width, canvas.height);
    canvas.toBlob(blob => save(window.live.saved = blob, name, 'image/png'), 'image/png');
  } catch (error) { trouble(`no picture: ${error.message}`); } finally {
    URL.revokeObjectURL(image.src);
  }
};
// Saves a chart with its heading and a legend of its lines.
export const saveChart = chart => {
  const svg = copyOf(chart.querySelector('svg')), whole = make('svg');
  for (const [name, value] of Object.entries({x: 0, y: 20, width: W, height: H}))
    svg.setAttribute(name, value);
  const [title, value] = [...chart.querySelectorAll('h3 span')].map(span => span.textContent);
  const say = (text, x, y, more) =>
    whole.append(make('text', {x, y, 'font-size': 9, fill: colour('--ink'), ...more}, text));
  const sides = [...chart.querySelectorAll('.side')].map(s => s.textContent);
  say(title, 4, 13, {'font-weight': 600});
  say(value, W - 4, 13, {'text-anchor': 'end', fill: colour('--accent')});
  const lines = [state.info.title, ...sides.length ? [`${sides[0]}, dashed: ${sides[1]}`] : [],
    ...chart.querySelector('path.was') ? [`pale: ${referenceName()}`] : []];
  say(lines.join(' · '), 4, H + 31, {'font-size': 7, fill: colour('--quiet')});
  whole.append(svg);
  const {channel, branch} = chart.dataset;
  savePicture(whole, W, H + 36, 4, `${stem()} ${words(channel)} ${branch}.png`);
};
$('drawing-png').onclick = () => {
  const {width, height} = $('drawing').viewBox.baseVal;
  savePicture(copyOf($('drawing')), width, height, 2, `${stem()} drawing.png`);
};
