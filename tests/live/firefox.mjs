// A page in headless Firefox by the Marionette protocol, with what the tests ask of browser.mjs. A page gets a script that
// evaluates what the tests ask for; its policy else stays.
import {spawn} from 'node:child_process';
import {createHash} from 'node:crypto';
import {mkdtempSync, readFileSync, writeFileSync} from 'node:fs';
import net from 'node:net';
import {tmpdir} from 'node:os';
import path from 'node:path';
import {pathToFileURL} from 'node:url';
import {Browser} from './browser.mjs';

const hook = 'window.evaluate = async text => JSON.stringify([await (0, eval)(text)]); window.complaints = []; addEventListener("error", e => complaints.push(e.message));';
const keys = {Tab: '\uE004', Enter: '\uE007', Escape: '\uE00C', ArrowLeft: '\uE012', ArrowUp: '\uE013', ArrowRight: '\uE014', ArrowDown: '\uE015'};
const modifiers = {2: '\uE009', 8: '\uE008'};  // Ctrl, Shift
const freePort = () => new Promise(resolve => {
  const server = net.createServer().listen(0, '127.0.0.1', () => { const {port} = server.address(); server.close(() => resolve(port)); });
});

export class Firefox extends Browser {
  static async start() {
    const firefox = new Firefox(), port = await freePort();
    Object.assign(firefox, {profile: mkdtempSync(path.join(tmpdir(), 'live-')), calls: 0, waiting: new Map(), requests: [], complaints: [], dialogs: []});
    writeFileSync(path.join(firefox.profile, 'user.js'), Object.entries({'marionette.port': port, 'browser.shell.checkDefaultBrowser': false,
      'datareporting.policy.dataSubmissionEnabled': false, 'app.update.enabled': false, 'toolkit.telemetry.enabled': false,
      'network.captive-portal-service.enabled': false, 'network.connectivity-service.enabled': false, 'browser.download.dir': firefox.profile,
      'browser.download.folderList': 2, 'browser.download.alwaysOpenPanel': false}).map(([name, value]) => `user_pref(${JSON.stringify(name)}, ${JSON.stringify(value)});\n`).join(''));
    firefox.process = spawn('firefox-esr', ['--headless', '--marionette', '--no-remote', '--profile', firefox.profile],
      {stdio: 'ignore', env: {...process.env, HOME: firefox.profile, MOZ_CRASHREPORTER_DISABLE: '1'}});
    await firefox.connect(port, Date.now() + 60e3);
    await firefox.ask('WebDriver:NewSession', {capabilities: {alwaysMatch: {unhandledPromptBehavior: 'accept'}}});
    return firefox;
  }
  async connect(port, end) {
    this.socket = net.connect(port, '127.0.0.1');
    let rest = Buffer.alloc(0);
    try {
      await new Promise((resolve, reject) => { this.socket.once('data', resolve); this.socket.once('error', reject); });
    } catch (error) {
      if (Date.now() > end) throw error;
      await new Promise(resolve => setTimeout(resolve, 200));
      return this.connect(port, end);
    }
    this.socket.on('data', data => {
      for (rest = Buffer.concat([rest, data]);;) {
        const colon = rest.indexOf(':'), size = +rest.subarray(0, colon);
        if (colon < 0 || rest.length < colon + 1 + size) return;
        const [, id, error, result] = JSON.parse(rest.subarray(colon + 1, colon + 1 + size));
        rest = rest.subarray(colon + 1 + size);
        const call = this.waiting.get(id);
        this.waiting.delete(id);
        error ? call?.reject(new Error(error.message)) : call?.resolve(result);
      }
    });
  }
  ask(name, params = {}) {
    return new Promise((resolve, reject) => {
      const text = JSON.stringify([0, ++this.calls, name, params]);
      this.waiting.set(this.calls, {resolve, reject});
      this.socket.write(`${Buffer.byteLength(text)}:${text}`);
    });
  }
  async run(expression) {
    const script = `const done = arguments[1], page = window.wrappedJSObject ?? window;
      page.evaluate(arguments[0]).then(text => done({text}), error => done({error: String(error)}));`;
    const {value} = await this.ask('WebDriver:ExecuteAsyncScript', {script, args: [expression], scriptTimeout: 90e3});
    if (value.error !== undefined) throw new Error(value.error);
    return JSON.parse(value.text)[0];
  }
  async open(file, {width = 1280, height = 900} = {}) {
    const html = readFileSync(file, 'utf8'), copy = file.replace(/\.html$/, '.firefox.html');
    const allowed = `'wasm-unsafe-eval' 'unsafe-eval' 'sha256-${createHash('sha256').update(hook).digest('base64')}'`;
    writeFileSync(copy, html.replace(`'wasm-unsafe-eval'`, () => allowed).replace('<style>', () => `<script>${hook}</script><style>`));
    await this.ask('WebDriver:SetWindowRect', {width, height: height + 100});
    await this.ask('WebDriver:Navigate', {url: pathToFileURL(copy).href});
    await this.until(`document.readyState === 'complete' && window.live && window.live.ready > 0 && isIdle()`, 'the page is ready');
  }
  act(pointer, held = 0) {
    const key = modifiers[held], pause = {type: 'pause'};
    const actions = [{type: 'pointer', id: 'mouse', parameters: {pointerType: 'mouse'}, actions: key ? [pause, ...pointer, pause] : pointer}];
    if (key) actions.push({type: 'key', id: 'keys', actions: [{type: 'keyDown', value: key}, ...pointer.map(() => pause), {type: 'keyUp', value: key}]});
    return this.ask('WebDriver:PerformActions', {actions});
  }
  mouse(type, x, y, {modifiers: held} = {}) {
    const move = {type: 'pointerMove', x: Math.round(x), y: Math.round(y), duration: 0, origin: 'viewport'};
    const then = {mousePressed: [{type: 'pointerDown', button: 0}], mouseReleased: [{type: 'pointerUp', button: 0}]}[type] ?? [];
    return this.act([move, ...then], held);
  }
  type(texts) {
    const actions = texts.flatMap(value => ['keyDown', 'keyUp'].map(type => ({type, value})));
    return this.ask('WebDriver:PerformActions', {actions: [{type: 'key', id: 'keys', actions}]});
  }
  key(key) { return this.type([keys[key] ?? key]); }
  send(method, {text} = {}) {
    if (method === 'Input.insertText') return this.type([...text]);
    throw new Error(`${method} is not of Firefox`);
  }
  async picture(file) {
    writeFileSync(file, Buffer.from((await this.ask('WebDriver:TakeScreenshot', {full: false})).value, 'base64'));
  }
}
