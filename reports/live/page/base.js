// ---- Elements, numbers, vectors
const $ = id => document.getElementById(id);
const make = (tag, attributes = {}, ...children) => {
  const svg = ['svg', 'g', 'path', 'circle', 'line', 'text', 'rect', 'title'].includes(tag);
  const element = svg ? document.createElementNS('http://www.w3.org/2000/svg', tag) : document.createElement(tag);
  for (const [name, value] of Object.entries(attributes)) if (value !== false) element.setAttribute(name, value === true ? '' : value);
  element.append(...children.filter(child => child !== null));
  return element;
};
const minus = text => String(text).replaceAll('-', '−');
// Four significant digits.
const shown = value => Number.isNaN(value) ? '–' : !Number.isFinite(value) ? 'undefined' : Math.abs(value) < 5e-10 ? '0'
  : minus(+value.toPrecision(4));
const signed = value => Number.isFinite(value) && value >= 5e-10 ? '+' + shown(value) : shown(value);
// The shortest decimal of ten digits, for a setting.
const written = value => String(+value.toPrecision(10));
const add = (a, t, b) => a.map((v, k) => v + t * b[k]);
const dot = (a, b) => a.reduce((sum, v, k) => sum + v * b[k], 0);
const px = value => value.toFixed(1);
const path = (points, end = '') => points.length ? 'M' + points.map(p => px(p[0]) + ',' + px(p[1])).join('L') + end : '';
const millimetres = {mm: 1, cm: 10, m: 1000, in: 25.4};

// ---- Answers of the solver (reports/live/engine.hpp)
class Run {
  constructor({head, numbers}) {
    Object.assign(this, head);
    this.numbers = numbers;
    const channels = this.count = head.channels.length;
    this.place = new Map(head.channels.map((name, k) => [name, k]));
    this.wide = 1 + channels + 3 * head.drawing.points.length + 3 * head.drawing.wheels.length;
  }
  a(branch, k) { return this.numbers[branch.at + k * this.wide]; }
  value(branch, k, channel) { return this.numbers[branch.at + k * this.wide + 1 + channel]; }
  vector(branch, k, place) {
    const at = branch.at + k * this.wide + 1 + this.count + 3 * place;
    return [this.numbers[at], this.numbers[at + 1], this.numbers[at + 2]];
  }
  point(branch, k, i) { return this.vector(branch, k, i); }
  spin(branch, k, wheel) { return this.vector(branch, k, this.drawing.points.length + wheel); }
  // [[a, value], ...] of a channel by its name
  curve(branch, name) {
    const c = this.place.get(name);
    if (c === undefined || !branch) return [];
    return Array.from({length: branch.points}, (_, k) => [this.a(branch, k), this.value(branch, k, c)]);
  }
  published(branch, name) {
    const c = this.place.get(name), fast = branch?.published;
    if (c === undefined || !fast) return [];
    return Array.from({length: fast.points}, (_, k) => {
      const at = fast.at + k * (1 + this.count);
      return [this.numbers[at], this.numbers[at + 1 + c]];
    });
  }
}
