// ---- Elements, numbers, units
const pageAsRead = document.documentElement.cloneNode(true);
export const wholePage = () => pageAsRead.outerHTML;
export const $ = id => document.getElementById(id);
const assign = (element, name, value) => typeof value === 'function' ? element[name] = value :
    value === false ? element.removeAttribute(name) :
                      element.setAttribute(name, value === true ? '' : value);
export const make = (tag, attributes = {}, ...children) => {
  const svg = ['svg', 'g', 'path', 'circle', 'line', 'text', 'rect', 'title'].includes(tag);
  const element = svg ? document.createElementNS('http://www.w3.org/2000/svg', tag) :
                        document.createElement(tag);
  for (const [name, value] of Object.entries(attributes)) assign(element, name, value);
  element.append(...children.filter(child => child !== null));
  return element;
};
// Elements that are drawn after every solve are described by sketches. Only the differences from
// the last sketches are applied, so that the browser lays out and paints less, and an entry keeps
// its focus.
export const sketch = (tag, attributes = {}, ...children) =>
    ({tag, attributes, children: children.filter(child => child !== null)});
const elementOf = part => typeof part === 'string' ?
    document.createTextNode(part) :
    make(part.tag, part.attributes, ...part.children.map(elementOf));
const sketched = new WeakMap();  // element -> sketches of its children
export const show = (parent, ...children) => {
  change(parent, sketched.get(parent) ?? [], children);
  sketched.set(parent, children);
};
const change = (parent, before, after) => {
  let node = parent.firstChild;
  for (let k = 0; k < Math.max(before.length, after.length); ++k) {
    const was = before[k], is = after[k], next = node?.nextSibling;
    if (was === is) { /* drawn before */ }
    else if (was === undefined) parent.append(elementOf(is));
    else if (is === undefined) node.remove();
    else if (typeof is === 'string' && typeof was === 'string') { if (is !== was) node.data = is; }
    else if (is.tag !== was.tag) node.replaceWith(elementOf(is));
    else {
      for (const name in is.attributes)
        if (is.attributes[name] !== was.attributes[name]) assign(node, name, is.attributes[name]);
      for (const name in was.attributes) if (!(name in is.attributes)) assign(node, name, false);
      change(node, was.children, is.children);
    }
    node = next;
  }
};
// Four significant digits.
export const shown = value => Number.isNaN(value) ? '–' :
    !Number.isFinite(value)                       ? 'undefined' :
    Math.abs(value) < 5e-10                       ? '0' :
                                                    minus(+value.toPrecision(4));
export const signed = value =>
    Number.isFinite(value) && value >= 5e-10 ? '+' + shown(value) : shown(value);
// The shortest decimal of ten digits, for a setting.
export const written = value => String(+value.toPrecision(10));
// ---- Units of the page, mm, deg, N and N·m, for those of the file: [unit, factor to it].
const pageUnits = {
  mm: ['mm', 1], m: ['mm', 1e3], cm: ['mm', 10], in: ['mm', 25.4], deg: ['deg', 1],
  rad: ['deg', 180 / Math.PI], N: ['N', 1], kN: ['N', 1e3], 'N·m': ['N·m', 1],
  'N·mm': ['N·m', 1e-3], 'kN·m': ['N·m', 1e3], 'kN·mm': ['N·m', 1]
};
export const pageUnit = unit => {
  const parts = unit.split('/').map(part => pageUnits[part]);
  return !parts.every(Boolean) || parts.length > 2 ? [unit, 1]
    : [parts.map(p => p[0]).join('/'), parts[0][1] / (parts[1]?.[1] ?? 1)];
};
// Text and attributes are written only where they differ: the browser lays out and paints anew
// what is written.
export const write = (element, text) => {
  if (element.textContent !== text) element.textContent = text;
};
export const writeAttributes = (element, attributes) => {
  for (const [name, value] of Object.entries(attributes))
    if (element.getAttribute(name) !== value) element.setAttribute(name, value);
};
// A message over the page, which moves nothing.
export const trouble = text => {
  write($('trouble'), text);
  $('trouble').hidden = !text;
};
