// ---- Elements, numbers, vectors
const $ = id => document.getElementById(id);
const assign = (element, name, value) => typeof value === 'function' ? element[name] = value
  : value === false ? element.removeAttribute(name) : element.setAttribute(name, value === true ? '' : value);
const make = (tag, attributes = {}, ...children) => {
  const svg = ['svg', 'g', 'path', 'circle', 'line', 'text', 'rect', 'title'].includes(tag);
  const element = svg ? document.createElementNS('http://www.w3.org/2000/svg', tag) : document.createElement(tag);
  for (const [name, value] of Object.entries(attributes)) assign(element, name, value);
  element.append(...children.filter(child => child !== null));
  return element;
};
// What is drawn again after every solve is described first, and compared with what was described before: only what
// differs is touched, since the browser lays out and paints what is, and an entry that stays keeps its focus.
const sketch = (tag, attributes = {}, ...children) => ({tag, attributes, children: children.filter(child => child !== null)});
const elementOf = it => typeof it === 'string' ? document.createTextNode(it) : make(it.tag, it.attributes, ...it.children.map(elementOf));
const sketched = new WeakMap();  // element -> sketches of its children
const show = (parent, ...children) => {
  change(parent, sketched.get(parent) ?? [], children);
  sketched.set(parent, children);
};
const change = (parent, before, after) => {
  let node = parent.firstChild;
  for (let k = 0; k < Math.max(before.length, after.length); ++k) {
    const was = before[k], is = after[k], next = node?.nextSibling;
    if (was === undefined) parent.append(elementOf(is));
    else if (is === undefined) node.remove();
    else if (typeof is === 'string' && typeof was === 'string') { if (is !== was) node.data = is; }
    else if (is.tag !== was.tag) node.replaceWith(elementOf(is));
    else {
      for (const name in is.attributes) if (is.attributes[name] !== was.attributes[name]) assign(node, name, is.attributes[name]);
      for (const name in was.attributes) if (!(name in is.attributes)) assign(node, name, false);
      change(node, was.children, is.children);
    }
    node = next;
  }
};
const minus = text => String(text).replaceAll('-', '−');
// Four significant digits.
const shown = value => Number.isNaN(value) ? '–' : !Number.isFinite(value) ? 'undefined' : Math.abs(value) < 5e-10 ? '0'
  : minus(+value.toPrecision(4));
const signed = value => Number.isFinite(value) && value >= 5e-10 ? '+' + shown(value) : shown(value);
// The shortest decimal of ten digits, for a setting.
const written = value => String(+value.toPrecision(10));
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
  // The point nearest to a parameter, and that at it: -1 where there is none.
  near(branch, a) {
    let best = branch.start;
    for (let k = 0; k < branch.points; ++k) if (Math.abs(this.a(branch, k) - a) < Math.abs(this.a(branch, best) - a)) best = k;
    return best;
  }
  exact(branch, a) {
    if (!branch?.points) return -1;
    const k = this.near(branch, a);
    return Math.abs(this.a(branch, k) - a) <= 1e-9 * Math.max(1, Math.abs(a)) ? k : -1;
  }
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
