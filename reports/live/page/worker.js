// The worker: runs the solver (WebAssembly) beside the page. A call that throws ends its instance;
// the next call gets a new one, made from the same compiled module, with the same scene opened
// again.
let module, api, scene = null;
const utf8 = new TextEncoder(), text = new TextDecoder();
class Refused extends Error { constructor(message, kind) { super(message); this.kind = kind; } }

const imports = () => {
  const given = {
    page: {
      thrown: (at, size, kind) => {
        throw new Refused(
            text.decode(new Uint8Array(api.memory.buffer, at, size).slice()),
            kind ? 'fault' : 'input');
      }
    }
  };
  // The C library names functions of an operating system; here each of them fails.
  for (const {module: from, name} of WebAssembly.Module.imports(module)) {
    given[from] ??= {};
    given[from][name] ??= name === 'proc_exit' ? () => {
      throw new Refused('the solver stopped', 'fault');
    } : () => 8;
  }
  return given;
};
const fresh = () => {
  api = new WebAssembly.Instance(module, imports()).exports;
  api._initialize();
  if (scene) enter(scene);
};
const enter = ({text, name, files}) => {
  for (const [file, content] of Object.entries(files ?? {})) call('file', file, content);
  return call('open', text, name);
};
// Calls a function of the solver. A text is passed as its address and size, an integer as it is.
const call = (name, ...words) => {
  if (!api) fresh();
  const given = [], reserved = [];
  try {
    for (const word of words) {
      if (typeof word === 'number') { given.push(word); continue; }
      const bytes = utf8.encode(word), at = api.reserve(bytes.length);
      new Uint8Array(api.memory.buffer, at, bytes.length).set(bytes);
      given.push(at, bytes.length);
      reserved.push(at);
    }
    api[name](...given);
    for (const at of reserved) api.release(at);
    return text.decode(new Uint8Array(api.memory.buffer, api.text(), api.text_size()).slice());
  } catch (error) {
    api = null;
    if (error instanceof Refused) throw error;
    throw new Refused(
        error instanceof RangeError ?
            'the calculation needs too much memory or too deep a recursion' :
            `the solver failed: ${error.message}`,
        'fault');
  }
};
const answers = {
  start: ({module: compiled, bytes}) => {
    module = compiled ?? new WebAssembly.Module(bytes);
    return {};
  },
  open: ({source, name, files}) => {
    const before = scene, given = {text: source, name, files};
    scene = null;
    if (files || before?.files) api = null;  // files belong to one scene
    try {
      const head = JSON.parse(enter(given));
      scene = given;
      return {head};
    } catch (error) {
      scene = before;
      throw error;
    } finally {
      if (!scene || scene === before) api = null;
    }
  },
  solve: ({request}) => {
    const start = performance.now(), head = JSON.parse(call('solve', JSON.stringify(request)));
    const numbers = new Float64Array(api.memory.buffer, api.numbers(), api.numbers_size()).slice();
    return {head, numbers, seconds: (performance.now() - start) / 1e3};
  },
  prove: ({request, first, count}) =>
      ({proof: JSON.parse(call('prove', JSON.stringify(request), first, count))}),
  compliance: ({request}) => JSON.parse(call('compliance', JSON.stringify(request))),
  wish: ({request}) => ({found: JSON.parse(call('wish', JSON.stringify(request)))}),
  rewrite: ({request}) => ({text: call('rewrite', JSON.stringify(request))})
};
self.onmessage = ({data}) => {
  self.postMessage({id: data.id, begun: true});
  try {
    const answer = answers[data.what](data);
    self.postMessage({id: data.id, ...answer}, answer.numbers ? [answer.numbers.buffer] : []);
  } catch (error) {
    self.postMessage({id: data.id, error: error.message, kind: error.kind ?? 'fault'});
  }
};
