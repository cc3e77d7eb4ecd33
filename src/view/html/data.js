// SPDX-License-Identifier: Apache-2.0
// view/html/data.js: what the page was made with, and where samples come from: pictures bring them.

const REPORT = JSON.parse(document.getElementById('report').textContent);
const SCHEMA = REPORT.schema;

// A layer of an image with its samples, or null: {kind, names, planes}.
async function loadLayer(image, name) {
  const layer = image.layers.find(l => l.name === name);
  const planes = layer && await image.samples(layer);
  return planes ? {kind: layer.kind, names: layer.channels.map(c => c.name), planes} : null;
}

function kindOfLayer(name) {
  if (name === 'N') return ['normal', 'XYZ'];
  if (name === 'P') return ['number', 'XYZ'];
  if (name === 'Z') return ['number', 'Z'];
  return name.startsWith('id.') ? ['id', 'I'] : ['color', 'RGB'];
}
const describeLayer = name => {
  const [kind, letters] = kindOfLayer(name);
  return {name, kind, channels: [...letters].map(letter => ({name: letter}))};
};
