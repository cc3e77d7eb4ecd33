// SPDX-License-Identifier: Apache-2.0
// report/html/bench.js: a run of scripts/bench: its headlines, diagrams and tables.

function median(values) {
  const sorted = [...values].sort((a, b) => a - b), half = sorted.length >> 1;
  return sorted.length % 2 ? sorted[half] : (sorted[half - 1] + sorted[half]) / 2;
}
const words = name => name.replaceAll('_', ' ');

// ns per hit and light by model and target: an iteration's time over the hits that it shades.
function kernelPlot(data) {
  const rows = new Map(), targets = ['scalar_baseline', ...data.targets];
  for (const [name, result] of Object.entries(data.benchmarks)) {
    const [kind, model, target, more] = name.split('/'), rate = result.counters && result.counters.items_per_second;
    if (kind !== 'shade' || more !== undefined || !rate || !targets.includes(target)) continue;
    if (!rows.has(model)) rows.set(model, {name: words(model), values: targets.map(() => undefined)});
    rows.get(model).values[targets.indexOf(target)] = 1e9 / rate;
  }
  const best = targets.indexOf(data.best_target);
  const sorted = [...rows.values()].sort((a, b) => (a.values[best] || 0) - (b.values[best] || 0));
  return dotPlot('Kernels', ['plain C++', ...data.targets], sorted, 'ns per hit and light, one thread');
}

function visibilityPlot(data) {
  const spheres = {grid: 25, '1e3': 1024, '1e4': 10000, '1e5': 99856};
  const series = [['embree_sphere_point', 'Embree’s spheres, bare, float'], ['embree_user', 'nacre on Embree’s tree, exact'],
                  ['tiles', 'nacre’s tiles, exact']].map(([key, name]) => ({name, points: Object.entries(spheres)
      .filter(([scene]) => data.benchmarks[`visibility/${key}/${scene}`])
      .map(([scene, count]) => [count, 1e-6 * median(data.benchmarks[`visibility/${key}/${scene}`].ns)])}));
  return linePlot('Camera rays', series, 'spheres', 'ms per frame of 1920×1080');
}

function stagePlot(data) {
  const found = Object.entries(data.benchmarks).map(([name, result]) => [name.match(/^frame\/(\w+)\/1920x1080\/1spp\/(\w+)$/), result])
      .filter(([match]) => match && match[2] === data.best_target);
  const stageOf = ([, result]) => Object.fromEntries(Object.entries(result.counters || {}).filter(([k]) => k.startsWith('ms_')).map(([k, v]) => [k.slice(3), v]));
  const names = ['sample', 'intersect', 'refine', 'light', 'shadow', 'shade', 'film', 'output']
      .filter(name => found.some(f => stageOf(f)[name] > 0.05));
  return names.length ? barPlot('A frame by stage', names, found.map(f => ({name: words(f[0][1]), values: names.map(n => stageOf(f)[n] || 0)})),
                                `ms per frame of 1920×1080, one sample a pixel, one thread, ${data.best_target}`) : null;
}

function precisionPlot(data, key, title, scale, yLabel) {
  const runs = data.precision && data.precision[key];
  if (!runs) return null;
  return linePlot(title, Object.entries(runs).map(([name, points]) => ({name, points: points
      .map(p => [Math.sqrt(p.rel_mse), scale * p.seconds])})), 'relative error (root of relMSE)', yLabel);
}

function lightsPlot(data) {
  const lights = Object.entries(data.lights || {}).filter(([, light]) => light.curves);
  return linePlot('Run time against error: sampled lights', lights.flatMap(([name, light]) => Object.entries(light.curves)
      .map(([kind, points]) => ({name: `${name}, ${kind}`, points: points.map(p => [p.error, p.seconds, `${p.what}: ${show(100 * p.error, 3)} %, ${show(p.seconds, 3)} s`])}))),
      'relative RMSE over the spheres', 's per process, one thread');
}

function scalingPlots(data) {
  const curve = (title, names, field, factor, xLabel, yLabel) => linePlot(title, names.filter(n => data.scaling[n]).map(n => ({
      name: data.scaling[n].fits && data.scaling[n].fits[field] ? `${n}: n^${show(data.scaling[n].fits[field].exponent, 2)}` : n,
      points: data.scaling[n].points.map(p => [p.size, factor * p[field]])})), xLabel, yLabel);
  if (!data.scaling) return [];
  return [curve('Time by shapes', ['spheres', 'triangles'], 'frame_s', 1e3, 'spheres or triangles', 'frame, ms'),
          curve('Time by lights', ['point lights', 'spot lights'], 'frame_s', 1e3, 'lights', 'frame, ms'),
          curve('Time by pixels', ['pixels'], 'frame_s', 1e3, 'pixels', 'frame, ms'),
          curve('Time by threads', ['threads'], 'frame_s', 1e3, 'threads', 'frame, ms'),
          curve('Memory by shapes', ['spheres', 'triangles'], 'mib', 1, 'spheres or triangles', 'peak memory, MiB')];
}

function benchSection(section) {
  const {data} = section, size = data.settings && data.settings.precision_size;
  const processes = Object.entries(data.processes || {}).map(([name, p]) =>
      [words(name), show(1e3 * median(p.seconds), 3), show(Math.min(...p.seconds.map(s => 1e3 * s)), 3), show(median(p.mib), 3), p.seconds.length]);
  return el('section', {}, heading(section),
    el('p', {class: 'lead'}, `Measured by scripts/bench on ${data.machine.processor}, ${data.machine.cores} cores; ` +
                             'times are medians of repetitions. Point at a mark for its numbers.'),
    el('div', {class: 'columns'},
       el('div', {}, precisionPlot(data, 'frame', 'Run time against error: frames', 1e3, `ms per frame of ${size}, one thread`)),
       el('div', {}, precisionPlot(data, 'process', 'Run time against error: processes', 1, `s per process, ${size}, all threads`))),
    kernelPlot(data), stagePlot(data),
    el('div', {class: 'columns'}, [lightsPlot(data), visibilityPlot(data), ...scalingPlots(data)].map(figure => figure && el('div', {}, figure))),
    el('div', {class: 'columns'},
       el('div', {}, el('h3', {}, 'Headline numbers'), table(['name', 'value'], Object.entries(data.summary || {}).map(([k, v]) => [words(k), show(v, 3)]), {caption: 'a over b: how many times faster a is'})),
       el('div', {}, processes.length ? [el('h3', {}, 'Processes'), table(['process', 'ms', 'fastest', 'MiB', 'rounds'], processes, {caption: 'From spawn to exit, all threads'})] : null,
          el('h3', {}, 'Machine and settings'), factTable('Machine', facts(data.machine)), factTable('Settings', facts(data.settings || {})))));
}
