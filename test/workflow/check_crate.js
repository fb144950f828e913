const path = require('path'), fs = require('fs');
const [, , module_folder, crate] = process.argv, lib = path.join(module_folder, 'lib');
const context = require(path.join(lib, 'context.json'));
globalThis.fetch = async () => ({ok: true, json: async () => context});
const {Validator} = require(path.join(lib, 'validator.js'));
(async () => {
  const validator = new Validator();
  validator.parseJSON(fs.readFileSync(path.join(crate, 'ro-crate-metadata.json'), 'utf8'));
  await validator.crate.resolveContext();
  await validator.validate();
  validator.checkFiles(Object.fromEntries(fs.readdirSync(crate, {recursive: true}).map(
    name => [name, {exists: true, inCrate: false, isDir: fs.lstatSync(path.join(crate, name)).isDirectory()}])));
  const wrong = validator.results.filter(one => one.status === 'error');
  console.log(JSON.stringify(wrong, null, 1));
  process.exit(wrong.length > 0 ? 1 : 0);
})();
