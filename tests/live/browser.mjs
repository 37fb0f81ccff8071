// A page in headless Chromium by the DevTools protocol over a pipe: no library, no port, no network.
import {spawn} from 'node:child_process';
import {mkdtempSync, rmSync, writeFileSync} from 'node:fs';
import {tmpdir} from 'node:os';
import path from 'node:path';
import {pathToFileURL} from 'node:url';

export class Browser {
  static async start() {
    const browser = new Browser();
    browser.profile = mkdtempSync(path.join(tmpdir(), 'live-'));
    browser.process = spawn('chromium', ['--headless=new', '--no-sandbox', '--disable-gpu', '--remote-debugging-pipe', '--no-first-run',
      '--disable-background-networking', '--disable-renderer-backgrounding', '--disable-backgrounding-occluded-windows',
      '--disable-background-timer-throttling', `--user-data-dir=${browser.profile}`, 'about:blank'], {stdio: ['ignore', 'ignore', 'ignore', 'pipe', 'pipe']});
    browser.calls = 0;
    browser.waiting = new Map();
    browser.requests = [];
    browser.complaints = [];
    browser.dialogs = [];
    let rest = '';
    browser.process.stdio[4].on('data', data => {
      const messages = (rest + data).split('\0');
      rest = messages.pop();
      for (const message of messages) browser.receive(JSON.parse(message));
    });
    const {targetInfos} = await browser.send('Target.getTargets');
    const page = targetInfos.find(t => t.type === 'page');
    browser.session = (await browser.send('Target.attachToTarget', {targetId: page.targetId, flatten: true})).sessionId;
    for (const domain of ['Page', 'Runtime', 'Network', 'Log']) await browser.send(`${domain}.enable`);
    await browser.send('Target.setAutoAttach', {autoAttach: true, waitForDebuggerOnStart: false, flatten: true});
    return browser;
  }
  receive({id, result, error, method, params}) {
    if (id) {
      const call = this.waiting.get(id);
      this.waiting.delete(id);
      error ? call.reject(new Error(error.message)) : call.resolve(result);
    } else if (method === 'Page.javascriptDialogOpening') {
      this.dialogs.push(params.type);
      this.send('Page.handleJavaScriptDialog', {accept: true});
    } else if (method === 'Network.requestWillBeSent') this.requests.push(params.request.url);
    else if (method === 'Runtime.exceptionThrown') this.complaints.push(params.exceptionDetails.exception?.description ?? params.exceptionDetails.text);
    else if (method === 'Log.entryAdded') this.complaints.push(params.entry.text);
  }
  send(method, params = {}) {
    return new Promise((resolve, reject) => {
      const id = ++this.calls;
      this.waiting.set(id, {resolve, reject});
      setTimeout(() => this.waiting.delete(id) && reject(new Error(`no answer to ${method}`)), 90e3).unref();
      this.process.stdio[3].write(JSON.stringify({id, method, params, sessionId: this.session}) + '\0');
    });
  }
  async run(expression) {
    const {result, exceptionDetails} = await this.send('Runtime.evaluate', {expression, awaitPromise: true, returnByValue: true});
    if (exceptionDetails) throw new Error(exceptionDetails.exception?.description ?? exceptionDetails.text);
    return result.value;
  }
  async until(expression, what = expression, seconds = +(process.env.PATIENCE ?? 60)) {
    for (const end = Date.now() + 1e3 * seconds; Date.now() < end;) {
      if (await this.run(expression)) return;
      await new Promise(resolve => setTimeout(resolve, 20));
    }
    throw new Error(`not within ${seconds} s: ${what}`);
  }
  async open(file, {width = 1280, height = 900, dark = false} = {}) {
    this.requests = [];
    await this.send('Emulation.setDeviceMetricsOverride', {width, height, deviceScaleFactor: 1, mobile: width < 500});
    await this.send('Emulation.setEmulatedMedia', {features: [{name: 'prefers-color-scheme', value: dark ? 'dark' : 'light'}]});
    await this.send('Page.navigate', {url: pathToFileURL(file).href});
    await this.until(`document.readyState === 'complete' && window.live && window.live.ready > 0 && isIdle()`, 'the page is ready');
  }
  mouse(type, x, y, more = {}) { return this.send('Input.dispatchMouseEvent', {type, x, y, button: 'left', buttons: type === 'mouseReleased' ? 0 : 1, clickCount: 1, ...more}); }
  async key(key) {
    for (const type of ['keyDown', 'keyUp']) await this.send('Input.dispatchKeyEvent', {type, key, code: key, ...key === 'Enter' && type === 'keyDown' ? {text: '\r'} : {}, windowsVirtualKeyCode: {Tab: 9, Enter: 13, Escape: 27, ArrowLeft: 37, ArrowUp: 38, ArrowRight: 39, ArrowDown: 40}[key]});
  }
  async picture(file, full = false) {
    writeFileSync(file, Buffer.from((await this.send('Page.captureScreenshot', {captureBeyondViewport: full})).data, 'base64'));
  }
  stop() { this.process.kill(); setTimeout(() => rmSync(this.profile, {recursive: true, force: true}), 200); }
}
