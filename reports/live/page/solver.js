// ---- The solver in its workers. A worker that does not begin a call, or does not end it, is
// started again.
import {$} from './base.js';

export const patience = {begin: 3e3, end: 60e3};  // [ms]
// A module with an instruction of SIMD, which a browser without SIMD rejects.
const simd = new Uint8Array([
  0, 97, 115, 109, 1,  0, 0, 0, 1,  5, 1,   96, 0,   1,  123, 3,
  2, 1,  0,   10,  10, 1, 8, 0, 65, 0, 253, 15, 253, 98, 11
]);
export const browsers = 'Chrome and Edge from 91, Firefox from 113, Safari from 16.4';

// Decodes base64 and decompresses.
export const unpacked = async (text, format) => {
  const coded = atob(text), bytes = new Uint8Array(coded.length);
  for (let k = 0; k < coded.length; ++k) bytes[k] = coded.charCodeAt(k);
  const plain = new Blob([bytes]).stream().pipeThrough(new DecompressionStream(format));
  return new Response(plain, {headers: {'Content-Type': 'application/wasm'}});
};

class Solver {
  // Calls wait until the module is compiled, while the worker starts.
  constructor(module) {
    this.compiled = module.then(compiled => { this.module = compiled; });
    this.calls = 0;
    this.waiting = new Map();  // in the order of the calls
    this.scene = null;
    this.start();
  }
  start() {
    const blob = new Blob([$('worker').textContent], {type: 'text/javascript'});
    const worker = this.worker = new Worker(URL.createObjectURL(blob));
    worker.onmessage = ({data}) => this.worker === worker && this.receive(data);
    worker.onerror = event => this.worker === worker && this.restart(event.message);
    worker.onmessageerror = () =>
        this.worker === worker && this.restart('its answer cannot be read');
    const again = [this.ask('start')];
    if (this.scene) again.push(this.ask('open', this.scene));
    for (const call of again) call.catch(() => 0);  // the next call reports the error
    this.watch ??= setInterval(() => this.check(), 200);
  }
  receive({id, begun, ...data}) {
    const call = this.waiting.get(id);
    if (!call) return;
    if (begun) { call.begun = performance.now(); return; }
    this.waiting.delete(id);
    this.since = performance.now();
    if (data.error === undefined) call.resolve(data);
    else call.reject(Object.assign(new Error(data.error), {kind: data.kind}));
  }
  ask(what, data = {}) {
    const post = (resolve, reject) => {
      if (!this.waiting.size) this.since = performance.now();
      this.waiting.set(++this.calls, {resolve, reject, what});
      const more = what === 'start' ? {module: this.module} : data;
      this.worker.postMessage({id: this.calls, what, ...more});
    };
    return this.module ? new Promise(post) : this.compiled.then(() => new Promise(post));
  }
  async open(scene) {
    const answer = await this.ask('open', scene);
    this.scene = scene;
    return answer;
  }
  // Restarts the worker if the oldest call has waited too long for its begin, or for its end.
  check() {
    const [call] = this.waiting.values(), now = performance.now();
    if (!call) return;
    if (!call.begun && now - this.since > patience.begin) this.restart('it did not answer');
    else if (call.begun && now - call.begun > patience.end && call.what !== 'wish')
      this.restart(`no answer within ${patience.end / 1e3} s`);
  }
  restart(why, kind = 'stopped') {
    const failed = [...this.waiting.values()];
    this.waiting.clear();
    this.worker.terminate();
    this.since = performance.now();
    this.start();
    const error = () => Object.assign(new Error(kind === 'cancelled' ? why
      : `the solver stopped (${why}) and was started again`), {kind});
    for (const call of failed) call.reject(error());
  }
}

// `front` solves the numbers that are moved, `back` everything else; with one core they are the
// same.
export const solvers = {front: null, back: null};
const compiled = async after => {
  await after;
  if (typeof WebAssembly !== 'object' || !WebAssembly.validate(simd) ||
      typeof DecompressionStream !== 'function')
    throw new Error(
        `this browser cannot run the solver, which needs WebAssembly with SIMD: ${browsers}`);
  return WebAssembly.compileStreaming(unpacked($('solver').textContent.trim(), 'gzip'));
};
// Compiles the solver after the first picture, which would share the processor with it.
export const startSolvers = after => {
  const module = compiled(after);
  solvers.front = new Solver(module);
  solvers.back = navigator.hardwareConcurrency > 1 ? new Solver(module) : solvers.front;
};
// Opens a scene in both; the scene that was open stays where the new one is rejected.
export const openIn = async scene => {
  const [{head}] = await Promise.all(
      [...new Set([solvers.front, solvers.back])].map(solver => solver.open(scene)));
  return head;
};
