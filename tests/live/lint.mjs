// The modules of the live page: each imports what it uses and nothing else, what is imported is exported; lines below 100
// characters, functions below 60 lines; only state.js changes the state.
// node lint.mjs PAGE-FOLDER SHARED-SCRIPT...
import {readFileSync, readdirSync} from 'node:fs';
import path from 'node:path';

const [folder, ...shared] = process.argv.slice(2);
const others = shared.map(file => [path.basename(file), readFileSync(file, 'utf8')]);  // with the page of a report
const failures = [];
const sources = new Map(readdirSync(folder).filter(name => name.endsWith('.js')).map(name =>
  [name, readFileSync(path.join(folder, name), 'utf8')]));
// Without comments and texts; what stands in a text between ${ and } stays.
const bare = text => text.replace(/\/\/ .*$/gm, '').replace(/'(?:[^'\\\n]|\\.)*'/g, `''`)
  .replace(/`(?:[^`\\]|\\.)*`/g, whole => [...whole.matchAll(/\$\{([^}]*)\}/g)].map(m => `(${m[1]})`).join(' ') || '0');
const namesOf = list => list.split(',').map(name => name.trim()).filter(Boolean);
const modules = new Map([...sources].map(([name, text]) => {
  const imports = [...text.matchAll(/^import \{([^}]*)\} from '\.\/(\w+\.js)';$/gm)].map(m => [m[2], namesOf(m[1])]);
  const exported = [...text.matchAll(/^export (?:const|class|function) ([\w$]+)/gm)].map(m => m[1]);
  return [name, {imports, exported, body: bare(text.replace(/^import [^;]*;$/gm, ''))}];
}));
const owner = new Map([...modules].flatMap(([name, {exported}]) => exported.map(e => [e, name])));
const uses = (body, name) => new RegExp(`(?<![\\w$.]|\\.\\.\\.)(?:\\.\\.\\.)?${name.replace('$', '\\$')}(?![\\w$])(?!:)`).test(body);
const declares = (body, name) => new RegExp(`(?:const|let|class) (?:[^=;]*[ ,{[])?${name.replace('$', '\\$')}\\b[^;]*=|[({,\\s]${name}\\b[^()]*\\) =>|\\b${name} =>`).test(body);
for (const [name, {imports, body}] of modules) {
  const imported = new Set();
  for (const [from, list] of imports)
    for (const item of list) {
      imported.add(item);
      if (!modules.get(from)?.exported.includes(item)) failures.push(`${name}: ${from} does not export ${item}`);
      if (!uses(body, item)) failures.push(`${name}: ${item} is imported and not used`);
    }
  if (name === 'worker.js') continue;
  for (const [item, from] of owner)
    if (from !== name && !imported.has(item) && uses(body, item) && !declares(body, item))
      failures.push(`${name}: ${item} of ${from} is used and not imported`);
}
// One script has them all: no name stands for two things.
const first = new Map();
for (const [name, text] of [...others, ...sources])
  for (const [, item] of name === 'worker.js' ? [] : text.matchAll(/^(?:export )?(?:const|let|class|function) ([\w$]+)/gm))
    if (first.has(item)) failures.push(`${name}: ${item} is a name of ${first.get(item)}, too`);
    else first.set(item, name);
// The state is changed by functions of its own module.
for (const [name, {body}] of modules)
  for (const [change] of name === 'state.js' ? [] : body.matchAll(/\bstate\.\w+ (?:\|\|)?= |Object\.assign\(state\b|\bstate\.\w+\.(?:set|delete|clear|push|splice)\(/g))
    failures.push(`${name}: changes the state: ${change}`);
const longest = {line: 100, function: 60};
for (const [name, text] of [...sources, ...others]) {
  let begin = 0;
  text.split('\n').forEach((line, k) => {
    if (line.length >= longest.line && sources.has(name))
      failures.push(`${name}:${k + 1}: ${line.length} characters`);
    if (/^(export )?(const|class|function|\$)/.test(line)) begin = k;
    if (/^\};?$/.test(line) && k - begin >= longest.function && !/class/.test(text.split('\n')[begin]))
      failures.push(`${name}:${begin + 1}: a function of ${k - begin + 1} lines`);
  });
}
for (const failure of failures) console.error(failure);
console.log(`${sources.size} modules, ${failures.length} failures`);
process.exit(failures.length ? 1 : 0);
