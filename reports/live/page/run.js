// ---- Answers of the solver (reports/live/engine.hpp) for one set of numbers: the drawing, the
// trim, and the branches that are solved, each from an answer of its own.
export class Run {
  constructor(settings, fast = false) {
    this.settings = settings;  // [[path, text], ...]
    this.fast = fast;  // whether the published recursion is solved too
    this.key = keyOf(settings);
    this.branches = [];
    this.place = new Map();  // index of each output
  }
  // Takes the branches of an answer that are not here yet, or of which not all was computed.
  take({head, numbers}, whole = true) {
    if (head.trouble) throw Object.assign(new Error(head.trouble), {kind: 'trim'});
    const {branches, ...more} = head;
    if (!this.drawing) {
      Object.assign(this, more);
      this.count = head.channels.length;
      this.place = new Map(head.channels.map((name, k) => [name, k]));
      const {points: {length: points}, wheels: {length: wheels}} = head.drawing;
      this.wide = 1 + this.count + 3 * (points + wheels + (wheels ? 4 * wheels + 1 : 0));
    }
    for (const branch of branches) {
      const old = this.branch(branch.name);
      if (!old) this.branches.push({...branch, numbers, whole});
      else if (whole && !old.whole) Object.assign(old, branch, {numbers, whole});
    }
    return this;
  }
  branch(name) { return this.branches.find(b => b.name === name); }
  a(branch, k) { return branch.numbers[branch.at + k * this.wide]; }
  // Index of the point nearest to a parameter; exact(): of the point at it, -1 if there is none.
  near(branch, a) {
    let best = branch.start;
    for (let k = 0; k < branch.points; ++k)
      if (Math.abs(this.a(branch, k) - a) < Math.abs(this.a(branch, best) - a)) best = k;
    return best;
  }
  exact(branch, a) {
    if (!branch?.points) return -1;
    const k = this.near(branch, a);
    return Math.abs(this.a(branch, k) - a) <= 1e-9 * Math.max(1, Math.abs(a)) ? k : -1;
  }
  value(branch, k, channel) { return branch.numbers[branch.at + k * this.wide + 1 + channel]; }
  // NaN where there is no such point or output.
  valueAt(branch, name, k) {
    return branch?.points && k >= 0 ? this.value(branch, k, this.place.get(name) ?? -1) : NaN;
  }
  vector(branch, k, place) {
    const at = branch.at + k * this.wide + 1 + this.count + 3 * place;
    return [...branch.numbers.subarray(at, at + 3)];
  }
  point(branch, k, i) { return this.vector(branch, k, i); }
  spin(branch, k, wheel) { return this.vector(branch, k, this.drawing.points.length + wheel); }
  // points_of_figures() of the catalogue: four points of each wheel, then the roll centre.
  guide(branch, k, i) {
    return this.vector(branch, k, this.drawing.points.length + this.drawing.wheels.length + i);
  }
  // [[a, value], ...] of a channel by its name
  curve(branch, name) {
    const c = this.place.get(name);
    if (c === undefined || !branch) return [];
    return Array.from({length: branch.points}, (_, k) =>
      [this.a(branch, k), this.value(branch, k, c)]);
  }
  published(branch, name) {
    const c = this.place.get(name), fast = branch?.published;
    if (c === undefined || !fast) return [];
    return Array.from({length: fast.points}, (_, k) => {
      const at = fast.at + k * (1 + this.count);
      return [branch.numbers[at], branch.numbers[at + 1 + c]];
    });
  }
}
export const keyOf = settings => JSON.stringify([...settings]);
