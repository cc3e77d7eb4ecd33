// SPDX-License-Identifier: Apache-2.0
// view/html/explain.js: where a pixel's value comes from: what lies there, what each light adds, and
// the lobe at this point as a polar plot with viewer and lights.

const three = v => (v || []).map(x => show(x, 4)).join('  ');
const degrees = cosine => Math.acos(Math.min(Math.max(cosine, -1), 1)) * 180 / Math.PI;
const sum3 = list => list.reduce((total, v) => total.map((t, i) => t + v[i]), [0, 0, 0]);

class Explanation {
  constructor() {
    this.body = el('div', {});
    this.element = el('details', {class: 'explain', open: true, hidden: true}, el('summary', {}, 'Where this value comes from'), this.body);
  }

  // Whether it explains a picture before this one; then it is seen to.
  outdated(revision) {
    const old = !this.element.hidden && this.revision !== revision;
    this.element.classList.toggle('old', old);
    return old && this.element.open;
  }

  show(json, look, revision) {
    this.element.hidden = false;
    this.revision = revision;
    this.element.classList.remove('old');
    const {x, y, value} = json, codes = [0, 0, 0];
    displayCodes(TONES[look.tone], 2 ** look.exposure, ...value, codes, 0);
    const end = [['linear value', three(value)], [`display code, ${look.tone.replaceAll('_', ' ')}, ${show(look.exposure, 3)} stops`, codes.join('  ')]];
    if (json.background) {
      this.body.replaceChildren(el('p', {}, `Pixel ${x}, ${y}: the ray through its centre meets nothing.`), table(null, end, {caption: 'Pixel', words: true}));
      return;
    }
    const facts = [['shape', json.shape], ['material', `${json.material} (${json.model.replaceAll('_', ' ')})`],
                   ['position', three(json.position)], ['normal', three(json.normal)], ['to viewer', three(json.to_view)]];
    for (const [name, value] of Object.entries(json.mapped)) facts.push([`${name.replaceAll('_', ' ')}, by its map`, Array.isArray(value) ? three(value) : show(value, 4)]);
    const {lights, layers} = json, names = lights.map(l => l.name);
    const row = (name, of) => [name, ...lights.map(of)];
    const terms = (name, label = name) => lights.some(l => l.terms && name in l.terms)
        ? [row(label, l => l.terms && name in l.terms ? Array.isArray(l.terms[name]) ? three(l.terms[name]) : show(l.terms[name], 5) : '')] : [];
    const angle = (name, label) => row(label, l => name in l ? `${show(l[name], 4)} (${show(degrees(l[name]), 3)}°)` : '');
    const rows = [row('state', l => l.state),
                  row('distance', l => l.distance === null ? '∞' : l.distance === undefined ? '' : show(l.distance, 4)), row('irradiance', l => l.irradiance ? three(l.irradiance) : ''),
                  angle('n_dot_l', 'n·l'), angle('n_dot_v', 'n·v'), angle('n_dot_h', 'n·h'), angle('v_dot_h', 'v·h'),
                  ...terms('alpha', 'α'), ...terms('D'), ...terms('G'), ...terms('F'), ...terms('shininess', 'exponent'), ...terms('r_dot_v', 'r·v'), ...terms('lobe'), ...terms('theta_half', 'θ half'), ...terms('theta_diff', 'θ difference'), ...terms('phi_diff', 'φ difference'),
                  ...this.covers(lights, row),
                  row('diffuse radiance', l => l.diffuse ? three(l.diffuse) : ''), row('specular radiance', l => l.specular ? three(l.specular) : ''),
                  row('rendered, diffuse', l => three(l.rendered_diffuse)), row('rendered, specular', l => three(l.rendered_specular)),
                  row('rendered, both', l => three(l.rendered))].filter(([, ...cells]) => cells.some(Boolean));
    const parts = [...lights.map(l => [`light ${l.name}`, l.rendered]), ['ambient light', layers.ambient], ['emission', layers.emission]];
    const total = [...parts.map(([name, v]) => [name, three(v)]), ['sum', three(sum3(parts.map(([, v]) => v)))],
                   ['of it diffuse', three(layers.diffuse)], ['of it specular', three(layers.specular)], ...end];
    this.body.replaceChildren(
        el('p', {class: 'soft'}, `Pixel ${x}, ${y}, through its centre. Terms in double; radiances in linear units.` +
           (lights.some(l => l.to_light && !l.irradiance) ? ' Angles of area lights are to their middle.' : '')),
        el('div', {class: 'columns'}, el('div', {}, table(null, facts, {caption: 'What is there', words: true})),
           el('div', {}, table(null, total, {caption: 'How it adds up', words: true}))),
        el('div', {class: 'columns'}, el('div', {}, lights.length ? table(['light', ...names], rows, {caption: 'What each light brings'}) : null),
           el('div', {}, this.polar(json), this.curves(json))));
  }

  // What lies over the base reflects some light itself, and leaves a share of what is below it.
  covers(lights, row) {
    const covered = lights.filter(l => l.covers), rows = [];
    if (!covered.length) return rows;
    rows.push(row('base, diffuse', l => l.base ? three(l.base.diffuse) : ''), row('base, specular', l => l.base ? three(l.base.specular) : ''));
    covered[0].covers.forEach(({name}, i) => {
      const of = get => l => l.covers ? get(l.covers[i]) : '';
      for (const [term, label] of [['n_dot_l', 'n·l'], ['n_dot_v', 'n·v'], ['n_dot_h', 'n·h'], ['alpha', 'α'], ['roughness', 'roughness'], ['D', 'D'], ['G', 'G'], ['V', 'V'],
                                     ['F', 'F'], ['albedo_l', 'albedo at n·l'], ['albedo_v', 'albedo at n·v']]) {
        if (covered.some(l => term in l.covers[i].terms)) {
          rows.push(row(`${name}: ${label}`, of(({terms}) => term in terms ? Array.isArray(terms[term]) ? three(terms[term]) : show(terms[term], 5) : '')));
        }
      }
      if (covered.some(l => l.covers[i].below.some(share => share !== 1))) rows.push(row(`${name} leaves of it`, of(({below}) => three(below))));
      rows.push(row(`${name} adds`, of(({diffuse, specular}) => three(sum3([diffuse, specular])))));
    });
    return rows;
  }

  // f n·l in the plane of normal and viewer. Lights outside of the plane are drawn at their angle
  // from the normal, on the side that they are on.
  polar({lobe, lights, normal, to_view: view}) {
    const {first_deg: first, view_deg: viewAngle, diffuse, specular} = lobe;
    const most = Math.max(...diffuse.map((d, i) => d + specular[i]), 1e-12), size = 150;
    const at = (deg, r) => [size * r * Math.sin(deg * Math.PI / 180), -size * r * Math.cos(deg * Math.PI / 180)];
    const path = values => values.map((v, i) => `${i ? 'L' : 'M'}${at(first + i, v / most).map(c => c.toFixed(1)).join(' ')}`).join('');
    const ray = (deg, text, index) => {
      const [x, y] = at(deg, 1.04), [u, v] = at(deg, 1.13);
      return [svg('line', {x1: 0, y1: 0, x2: x, y2: y, class: `k${index}`, 'stroke-width': 1.5, 'stroke-dasharray': index === 6 ? null : '5 3'}),
              svg('text', {x: u, y: v, 'text-anchor': 'middle', class: 'soft'}, text)];
    };
    const side = l => Math.sign(dot(add(view, normal, -dot(view, normal)), l)) || 1;
    const rings = [0.25, 0.5, 0.75, 1].map(r => svg('path', {d: `M${-size * r} 0A${size * r} ${size * r} 0 0 1 ${size * r} 0`, class: 'grid', fill: 'none'}));
    return el('figure', {}, svg('svg', {viewBox: '-200 -185 400 205', class: 'plot', role: 'img', 'aria-label': `Polar plot of the lobe; the outer ring is ${show(most, 3)}`},
        rings, svg('line', {x1: -size, y1: 0, x2: size, y2: 0, class: 'axis'}), svg('line', {x1: 0, y1: 0, x2: 0, y2: -size, class: 'grid'}),
        svg('path', {d: path(diffuse), class: 'line k2'}), svg('path', {d: path(diffuse.map((d, i) => d + specular[i])), class: 'line k1'}),
        ray(viewAngle, 'viewer', 6),
        lights.filter(l => l.to_light && l.n_dot_l > 0).map((l, i) => ray(-side(l.to_light) * degrees(l.n_dot_l), l.name, i % 2 ? 4 : 0)),
        svg('text', {x: size, y: 14, 'text-anchor': 'end', class: 'soft'}, show(most, 3))),
      el('figcaption', {class: 'soft'}, 'BRDF times n·l by the light’s direction: all (orange), diffuse (green); mean of the channels.'));
  }

  // `points`: [[degrees, value]...].
  curves({curves, lights, normal, to_view: view}) {
    const lit = lights.filter(l => l.terms && 'D' in l.terms), width = 330, height = 90;
    const plot = (title, points, marks) => {
      const most = Math.max(...points.map(p => p[1]), 1e-12), x = deg => 10 + (width - 20) * deg / 90, y = v => height - (height - 12) * v / most;
      return svg('svg', {viewBox: `0 0 ${width} ${height + 22}`, class: 'plot', role: 'img', 'aria-label': title},
          svg('line', {x1: 10, y1: height, x2: width - 10, y2: height, class: 'axis'}),
          svg('path', {d: points.map(([deg, v], i) => `${i ? 'L' : 'M'}${x(deg).toFixed(1)} ${y(v).toFixed(1)}`).join(''), class: 'line k0'}),
          marks.map(deg => svg('line', {x1: x(deg), x2: x(deg), y1: 8, y2: height, class: 'k1', 'stroke-width': 1.5, 'stroke-dasharray': '4 3'})),
          svg('text', {x: 10, y: height + 16, class: 'soft'}, title), svg('text', {x: width - 10, y: 12, 'text-anchor': 'end', class: 'soft'}, show(most, 3)));
    };
    const byDegree = values => values.map((v, i) => [i, v]);
    return el('figure', {},
        curves.distribution ? plot('D, angle of h 0–90°', byDegree(curves.distribution), lit.map(l => degrees(l.n_dot_h))) : null,
        curves.fresnel ? plot('F of the green channel, angle of v and h 0–90°', byDegree(curves.fresnel.map(f => f[1])), lit.map(l => degrees(l.v_dot_h))) : null,
        plot('albedo, angle of v 0–90°', curves.albedo, [degrees(dot(normal, view))]),
        el('figcaption', {class: 'soft'}, 'Dashed: the angles here. Albedo: the share of light from everywhere that is seen, mean of the channels.'));
  }
}
