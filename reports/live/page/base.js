// ---- Elements, numbers, vectors
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
// What is drawn again after every solve is described first, and compared with what was described
// before: only what differs is touched, since the browser lays out and paints what is, and an
// entry that stays keeps its focus.
export const sketch = (tag, attributes = {}, ...children) =>
    ({tag, attributes, children: children.filter(child => child !== null)});
const elementOf = it => typeof it === 'string' ?
    document.createTextNode(it) :
    make(it.tag, it.attributes, ...it.children.map(elementOf));
const sketched = new WeakMap();  // element -> sketches of its children
export const show = (parent, ...children) => {
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
      for (const name in is.attributes)
        if (is.attributes[name] !== was.attributes[name]) assign(node, name, is.attributes[name]);
      for (const name in was.attributes) if (!(name in is.attributes)) assign(node, name, false);
      change(node, was.children, is.children);
    }
    node = next;
  }
};
export const minus = text => String(text).replaceAll('-', '−');
// Four significant digits.
export const shown = value => Number.isNaN(value) ? '–' :
    !Number.isFinite(value)                       ? 'undefined' :
    Math.abs(value) < 5e-10                       ? '0' :
                                                    minus(+value.toPrecision(4));
export const signed = value =>
    Number.isFinite(value) && value >= 5e-10 ? '+' + shown(value) : shown(value);
// The shortest decimal of ten digits, for a setting.
export const written = value => String(+value.toPrecision(10));
export const millimetres = {mm: 1, cm: 10, m: 1000, in: 25.4};
// A message over the page, which moves nothing.
export const trouble = text => {
  if ($('trouble').textContent !== text) $('trouble').textContent = text;
  $('trouble').hidden = !text;
};
