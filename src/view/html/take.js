// SPDX-License-Identifier: Apache-2.0
// view/html/take.js: what can be taken away: the scene, the command that renders it, the picture.

function save(name, blob) {
  const link = el('a', {href: URL.createObjectURL(blob), download: name});
  link.click();
  setTimeout(() => URL.revokeObjectURL(link.href), 10000);
}

// What makes one tree of the other: [[pointer, value]...]. Members that have gone make the object
// around them a whole new value.
function differences(before, after, pointer = '') {
  if (JSON.stringify(before) === JSON.stringify(after)) return [];
  const objects = [before, after].every(v => v && typeof v === 'object') && Array.isArray(before) === Array.isArray(after);
  if (!objects || Object.keys(before).some(name => !(name in after))) return [[pointer, after]];
  if (Array.isArray(after) && (after.length !== before.length || typeof after[0] === 'number')) return [[pointer, after]];
  return Object.keys(after).flatMap(name => name in before ? differences(before[name], after[name], `${pointer}/${token(name)}`)
                                                           : [[`${pointer}/${token(name)}`, after[name]]]);
}

const isModel = file => /\.(gltf|glb|obj|ply)$/i.test(file);

// For a POSIX shell.
const quoted = text => /^[\w@%+=:,./-]+$/.test(text) ? text : `'${text.replaceAll("'", `'\\''`)}'`;

function commandLine({file, given, original, scene, look, samples}) {
  // A model's own lights are replaced whole: what a command line says of one is all of it.
  const whole = ([pointer, value]) => isModel(file) && /^\/lights\/./.test(pointer) ? [pointer.split('/').slice(0, 3).join('/'), null] : [pointer, value];
  const changed = new Map(differences(original, scene).filter(([pointer]) => pointer !== '').map(whole));
  const sets = [...changed].map(([pointer, value]) => [pointer, value ?? valueAt(scene, pointer)])
      .map(([pointer, value]) => `--set ${quoted(`${pointer}=${JSON.stringify(value)}`)}`);
  const shown = [...(look.tone !== 'neutral' ? [`--tonemap ${look.tone}`] : []), ...(look.exposure ? [`--exposure ${look.exposure}`] : [])];
  return ['nacre render', quoted(file || 'scene.json'), ...(file ? given.map(quoted) : []), ...(samples ? [`--spp ${samples}`] : []), ...shown, ...sets, '-o picture.exr -o picture.png'].join(' ');
}

const baseName = view => view.name.textContent.replace(/\.\w+$/, '').replace(/[^\w-]+/g, '_') || 'scene';

// `view`: what the page holds. EXR and report are made by the server, which sends them (page.js).
function takeAway(view) {
  const {viewer} = view, base = baseName(view), compared = viewer.images.length > 1;
  const whole = view.whole && view.original && Object.keys(view.original).length > 0 && !isModel(view.file);
  const command = commandLine({...view, look: viewer.look, samples: viewer.head?.ofSamples});
  const text = el('textarea', {readonly: true, rows: 6, 'aria-label': 'Command line'}, command);
  // What takes a while, or may fail, is told on the page.
  const make = what => () => {
    dialog.close();
    view.status.textContent = view.spoken.textContent = 'making the file…';
    view.act.take(what);
  };
  const dialog = el('dialog', {'aria-label': 'Take away', onclose: () => dialog.remove()}, el('h3', {}, 'Take away'),
    el('div', {class: 'row'},
       whole || !view.file ? el('button', {onclick: () => save(`${base}.json`, new Blob([JSON.stringify(view.scene, null, 2) + '\n'], {type: 'application/json'}))}, 'Scene as JSON') : null,
       el('button', {onclick: () => viewer.live.canvas.toBlob(blob => save(`${base}.png`, blob))}, 'Picture as PNG'),
       el('button', {disabled: !view.open, onclick: make('exr')}, 'EXR with all layers'),
       el('button', {disabled: !view.open || !compared, title: compared ? null : 'Keep a picture as A first', onclick: make('report')}, 'Report of A and B')),
    el('p', {class: 'soft'}, 'EXR and report take as long as they take to render and compare; then the browser saves them.'),
    el('p', {}, view.file ? 'The command that renders this picture:' : 'The command that renders this picture, once the scene is saved as scene.json:'), text,
    el('div', {class: 'row'}, el('button', {onclick: () => { text.select(); navigator.clipboard?.writeText(text.value); }}, 'Copy'),
       el('button', {onclick: () => dialog.close()}, 'Close')));
  document.body.append(dialog);
  dialog.showModal();
}
