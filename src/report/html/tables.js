// SPDX-License-Identifier: Apache-2.0
// report/html/tables.js: figures of comparisons and validations, plans, facts.

const METRICS = [
  ['layer', m => m.layer], ['RMSE', m => show(m.rmse)], ['relMSE', m => show(m.rel_mse)],
  ['PSNR, dB', m => m.psnr_db === null ? '∞' : show(m.psnr_db)], ['max abs', m => show(m.max_abs)],
  ['max rel', m => show(m.max_rel)], ['99.9 % rel', m => show(m.p999_rel)],
  ['SSIM', m => show(m.ssim, 5)], ['FLIP mean', m => m.flip ? show(m.flip.mean) : '–'],
  ['FLIP max', m => m.flip ? show(m.flip.max) : '–'], ['HDR-FLIP mean', m => m.hdr_flip ? show(m.hdr_flip.mean) : '–'],
  ['worst at', m => m.max_abs > 0 ? m.max_abs_at.join(', ') : '–'],
];

function metricTable(comparison, names) {
  const {verdict} = comparison, caption = `${names[0]} against ${names[1]}`;
  const notes = verdict.layers.flatMap(m => (m.notes || []).map(note => `${m.layer}: ${note}`));
  for (const m of verdict.layers) {
    if (m.zero_mismatches) notes.push(`${m.layer}: ${m.zero_mismatches} samples are 0 in the reference only, and have no relative error`);
    if (m.nonfinite_mismatches) notes.push(`${m.layer}: ${m.nonfinite_mismatches} samples are not finite in one picture only`);
  }
  const layers = [...verdict.layers].sort((a, b) => (b.layer === 'beauty') - (a.layer === 'beauty'));
  return [table(METRICS.map(([name]) => name), layers.map(m => METRICS.map(([, get]) => get(m))), {caption}),
          notes.map(note => el('p', {class: 'note'}, note))].flat();
}

// Each case of a validation; its name opens its pictures.
function validationTable(section, viewer) {
  const rows = section.cases.map(c => {
    const open = c.set === undefined ? c.name
               : el('button', {onclick: () => { viewer.open(c.set); viewer.element.scrollIntoView({block: 'start'}); }}, c.name);
    const m = c.layers && c.layers[0];
    return [open, {text: c.outcome, class: c.outcome === 'match' ? 'good' : 'bad'}, m ? show(m.rmse, 3) : '–',
            m ? show(m.max_rel, 3) : '–', m ? show(m.p999_rel, 3) : '–',
            m && m.flip ? show(m.flip.mean, 3) : '–', c.pixels ? `${c.exceeding_pixels} of ${c.pixels}` : '–', {text: c.reason, class: 'wrap'}];
  });
  return table(['reference', 'outcome', 'RMSE', 'max rel', '99.9 % rel', 'FLIP mean', 'pixels beyond', {text: 'why these tolerances, or what differs', class: 'wrap'}],
               rows, {caption: 'References'});
}

function planParts(stats) {
  const parts = [], {time_ms: time, plan} = stats;
  if (plan && plan.length) {
    parts.push(el('h3', {}, 'Render plan'),
               table(['what', '', 'why'], plan.map(item => [{text: item.what, class: 'wrap'}, {text: item.used ? 'used' : 'skipped', class: item.used ? 'good' : ''},
                                                            {text: item.reason, class: 'wrap'}]), {words: true, caption: 'What the renderer used and what it skipped'}));
  }
  const stages = time && time.stages_all_threads;
  if (stages && Object.values(stages).some(v => v > 0)) {
    const names = Object.keys(stages).filter(name => stages[name] > 0);
    parts.push(barPlot('Where the time went', names, [{name: 'all threads', values: names.map(name => stages[name])}], 'ms'));
  }
  return parts;
}

// Nested facts as one list of two columns.
function facts(object, prefix = '') {
  return Object.entries(object).flatMap(([key, value]) => {
    const name = prefix + key.replaceAll('_', ' ');
    if (Array.isArray(value)) {
      const plain = value.filter(item => item === null || typeof item !== 'object');
      const nested = value.filter(item => item !== null && typeof item === 'object');
      return [...(plain.length || !nested.length ? [[name, plain.join(', ')]] : []),
              ...nested.flatMap((item, i) => facts(item, nested.length > 1 ? `${name} ${i + 1} ` : `${name} `))];
    }
    if (value !== null && typeof value === 'object') return facts(value, `${name} `);
    return [[name, typeof value === 'number' ? show(value, 6) : String(value)]];
  });
}
const factTable = (caption, rows) => table(null, rows.map(([k, v]) => [k, {text: v, class: 'wrap'}]), {words: true, caption});
