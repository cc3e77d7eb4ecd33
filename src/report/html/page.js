// SPDX-License-Identifier: Apache-2.0
// report/html/page.js: the page from its sections.

const VIEWERS = [];  // of the page, in order

// A page of one section needs no second title.
const heading = section => REPORT.sections.length > 1 ? el('h2', {}, section.title) : null;

function imageSection(section, number) {
  const viewer = new Viewer(section, number), set = section.sets[0], parts = [];
  VIEWERS.push(viewer);
  if (section.cases) parts.push(validationTable(section, viewer));
  parts.push(viewer.element);
  if (!section.cases && set) {
    for (const comparison of set.comparisons || []) {
      parts.push(...metricTable(comparison, [set.images[comparison.image].name, set.images[set.reference].name]));
    }
    for (const image of set.images) {
      const title = set.images.length > 1 ? [el('h3', {}, image.name)] : [];
      const details = [...(image.stats ? planParts(image.stats) : []),
        el('div', {class: 'columns'},
           el('div', {}, factTable('What the file says', image.facts)),
           image.stats ? el('div', {}, factTable('Counts and times of the render', facts({...image.stats, plan: undefined}).filter(([, v]) => v !== 'undefined'))) : null)];
      parts.push(...title, ...details);
    }
  }
  return el('section', {}, heading(section), (section.notes || []).map(note => el('p', {class: 'note'}, note)), parts);
}

function build() {
  const page = document.getElementById('page');
  page.append(el('p', {class: 'lead'}, REPORT.summary), ...REPORT.notes.map(note => el('p', {class: 'note'}, note)));
  REPORT.sections.forEach((section, number) => {
    page.append(section.kind === 'bench' ? benchSection(section) : imageSection(section, number));
  });
  page.append(el('footer', {}, `Made by ${REPORT.generator}. This page holds all that it shows and asks no network for anything. `,
                 el('button', {onclick: showKeys}, 'Keys')));
  document.addEventListener('keydown', event => {
    if (event.key === '?' && !event.target.matches('input')) showKeys();
  });
}

build();
