// The page's worker in Node.js: the same script and the same WebAssembly as in a browser.
import {readFileSync} from 'node:fs';
import vm from 'node:vm';
import {gunzipSync} from 'node:zlib';

export const parts = page => {
  const html = readFileSync(page, 'utf8'), part = id => html.match(new RegExp(`<script type="text/plain" id="${id}">([^]*?)</script>`))[1];
  return {html, worker: part('worker'), solver: gunzipSync(Buffer.from(part('solver'), 'base64'))};
};
export const solverOf = page => {
  const {worker, solver} = parts(page);
  let answer;
  const self = {postMessage: data => { answer = data; }};
  vm.runInNewContext(worker, {self, WebAssembly, TextEncoder, TextDecoder, Uint8Array, Float64Array, performance, RangeError, Error, JSON, console});
  const ask = (what, data = {}) => {
    self.onmessage({data: {id: 1, what, ...data}});
    if (answer.error !== undefined) throw Object.assign(new Error(answer.error), {kind: answer.kind});
    return answer;
  };
  ask('start', {bytes: solver});
  return ask;
};
