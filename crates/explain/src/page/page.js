'use strict';
// One file, no library: a canvas for space, an SVG for the tree, plain elements for the rest.
const data = JSON.parse(document.getElementById('data').textContent);
const e = data.explanation;
const $ = (id) => document.getElementById(id);
const KINDS = ['camera', 'reflected', 'refracted', 'glossy', 'diffuse', 'lit', 'blocked', 'normals'];
const SAYS = { ambient: 'ambient', photons: 'photons', light: 'light', medium: 'medium shines' };
const NAMES = { lit: 'shadow rays that arrive', blocked: 'blocked', normals: 'normals' };
const state = { sample: 0, all: false, depth: 0, hidden: new Set(), chosen: null, yaw: 0, pitch: 0, zoom: 1, pan: [0, 0, 0] };

// ---- numbers

const UNIT = 2 ** -64;
const color = (sums) => sums.map((s) => Number(BigInt(s)) * UNIT);
const sum = (v) => v.reduce((a, b) => a + b, 0);
const light = (tree) => (tree.is_invalid ? 0 : Math.max(0, sum(color(tree.sums))));
function brightest() {
  let best = 0;
  e.trees.forEach((t, i) => { if (light(t) > light(e.trees[best])) best = i; });
  return best;
}
const short = (v) => (typeof v === 'number' ? (v === 0 ? '0' : Math.abs(v) >= 1e-3 && Math.abs(v) < 1e5 ? String(+v.toPrecision(4)) : v.toExponential(2)) : String(v));
const vector = (v) => (v ? v.map(short).join('  ') : '');
const percent = (s) => (s >= 0.0995 ? (s * 100).toFixed(0) : s >= 0.001 ? (s * 100).toFixed(1) : s > 0 ? '< 0.1' : '0') + ' %';
const css = (name) => getComputedStyle(document.documentElement).getPropertyValue('--' + name).trim();
const kindOf = (node) => (node.kind === 'passed' ? 'camera' : node.kind);
const maxDepth = Math.max(0, ...e.trees.flatMap((t) => t.rays.map((r) => r.depth)));

// ---- vectors

const add = (a, b) => [a[0] + b[0], a[1] + b[1], a[2] + b[2]];
const sub = (a, b) => [a[0] - b[0], a[1] - b[1], a[2] - b[2]];
const mul = (a, s) => [a[0] * s, a[1] * s, a[2] * s];
const dot = (a, b) => a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
const cross = (a, b) => [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]];
const length = (a) => Math.hypot(...a);
const unit = (a) => mul(a, 1 / (length(a) || 1));

// ---- what is in space

const bytes = Uint8Array.from(atob(data.lines), (c) => c.charCodeAt(0));
const wires = new Float32Array(bytes.buffer, 0, bytes.length >> 2);
// Median of the wires and hits: planes without end must not make everything else small.
const spread = (() => {
  const points = [];
  for (const t of e.trees) for (const r of t.rays) { points.push(r.origin); if (r.hit) points.push(r.hit.position); }
  const axis = (k) => points.map((p) => p[k]).filter(Number.isFinite).sort((a, b) => a - b);
  const at = (a, u) => (a.length ? a[Math.min(a.length - 1, Math.floor(u * a.length))] : 0);
  const xs = [0, 1, 2].map(axis);
  const low = xs.map((a) => at(a, 0.02)), high = xs.map((a) => at(a, 0.98));
  return { center: mul(add(low, high), 0.5), radius: Math.max(0.5 * length(sub(high, low)), 1e-6) };
})();
const far = 2.5 * spread.radius;

function segments() {
  const out = [];
  const trees = state.all ? e.trees.map((t, i) => [t, i]) : [[e.trees[state.sample], state.sample]];
  for (const [tree, index] of trees) {
    tree.rays.forEach((r, i) => {
      if (r.depth > state.depth) return;
      const end = r.hit ? r.hit.position : add(r.origin, mul(r.direction, far));
      const kind = kindOf(r);
      if (!state.hidden.has(kind)) out.push({ a: r.origin, b: end, kind, index, node: i, open: !r.hit });
      if (r.hit && !state.all && !state.hidden.has('normals')) {
        out.push({ a: end, b: add(end, mul(r.hit.shading_normal, 0.07 * spread.radius)), kind: 'normals', index, node: i });
      }
      r.asked.forEach((q, k) => {
        if (!length(q.direction) || !['lit', 'blocked'].includes(q.answer.what)) return;
        const b = q.answer.blocker;
        const distance = b ? b.distance : typeof q.distance === 'number' ? q.distance : far;
        if (!state.hidden.has(q.answer.what)) {
          out.push({ a: end, b: add(end, mul(q.direction, Math.min(distance, 4 * far))), kind: q.answer.what, index, node: i, asked: k });
        }
      });
    });
  }
  return out;
}

// ---- 3D

const space = $('scene'), pen = space.getContext('2d');
const start = (() => {
  // From behind the camera's shoulder, so that its rays are seen from the side.
  const d = unit(data.camera.direction);
  return { yaw: Math.atan2(-d[0], -d[2]) + 0.5, pitch: Math.max(-1.2, Math.min(1.2, Math.asin(-d[1]) + 0.35)) };
})();
function resetView() { Object.assign(state, { yaw: start.yaw, pitch: start.pitch, zoom: 1, pan: [0, 0, 0] }); }
resetView();
state.sample = brightest();

function view() {
  const back = [Math.sin(state.yaw) * Math.cos(state.pitch), Math.sin(state.pitch), Math.cos(state.yaw) * Math.cos(state.pitch)];
  const right = unit(cross([0, 1, 0], back)), up = cross(back, right);
  const center = add(spread.center, state.pan), distance = (2.1 * spread.radius) / state.zoom;
  return { eye: add(center, mul(back, distance)), back, right, up, near: 0.02 * distance };
}

function projector(w, h) {
  const v = view(), focal = 0.5 * Math.min(w, h * 1.4) * 1.9;
  const local = (p) => { const d = sub(p, v.eye); return [dot(d, v.right), dot(d, v.up), -dot(d, v.back)]; };
  const flat = (c) => [w / 2 + (focal * c[0]) / c[2], h / 2 - (focal * c[1]) / c[2]];
  // A line, cut where it would pass behind the viewer.
  return (a, b) => {
    let p = local(a), q = local(b);
    if (p[2] < v.near && q[2] < v.near) return null;
    const cut = (x, y) => { const t = (v.near - x[2]) / (y[2] - x[2]); return add(x, mul(sub(y, x), t)); };
    if (p[2] < v.near) p = cut(p, q); else if (q[2] < v.near) q = cut(q, p);
    const s = flat(p), t = flat(q);
    return [s[0], s[1], t[0], t[1]];
  };
}

let drawn = [];
function fit(canvas, context) {
  const ratio = window.devicePixelRatio || 1, w = canvas.clientWidth, h = canvas.clientHeight;
  if (canvas.width !== Math.round(w * ratio) || canvas.height !== Math.round(h * ratio)) {
    canvas.width = Math.round(w * ratio);
    canvas.height = Math.round(h * ratio);
  }
  context.setTransform(ratio, 0, 0, ratio, 0, 0);
  context.clearRect(0, 0, w, h);
  return [w, h];
}

function drawSpace() {
  const [w, h] = fit(space, pen), project = projector(w, h);
  pen.lineCap = 'round';
  pen.strokeStyle = css('wire');
  pen.lineWidth = 1;
  pen.beginPath();
  for (let i = 0; i + 5 < wires.length; i += 6) {
    const l = project([wires[i], wires[i + 1], wires[i + 2]], [wires[i + 3], wires[i + 4], wires[i + 5]]);
    if (l) { pen.moveTo(l[0], l[1]); pen.lineTo(l[2], l[3]); }
  }
  pen.stroke();
  const origin = e.trees[state.sample].rays[0].origin, eye = project(origin, add(origin, mul(unit(data.camera.direction), 0.01 * spread.radius)));
  if (eye) {
    pen.fillStyle = css('ink');
    pen.font = '13px system-ui, sans-serif';
    pen.fillText('eye', eye[0] + 6, eye[1] + 14);
    pen.beginPath();
    pen.arc(eye[0], eye[1], 4, 0, 7);
    pen.fill();
  }
  drawn = [];
  for (const s of segments()) {
    const l = project(s.a, s.b);
    if (!l) continue;
    const isChosen = state.chosen && state.chosen.index === s.index && state.chosen.node === s.node && state.chosen.asked === s.asked;
    pen.strokeStyle = pen.fillStyle = css(s.kind === 'normals' ? 'normal' : s.kind);
    pen.globalAlpha = state.all && !isChosen ? 0.45 : 1;
    pen.lineWidth = isChosen ? 4 : s.kind === 'camera' ? 2 : s.kind === 'normals' ? 1 : 1.7;
    pen.setLineDash(s.kind === 'lit' || s.kind === 'blocked' ? [5, 4] : s.open ? [10, 4] : []);
    pen.beginPath();
    pen.moveTo(l[0], l[1]);
    pen.lineTo(l[2], l[3]);
    pen.stroke();
    pen.setLineDash([]);
    const size = Math.hypot(l[2] - l[0], l[3] - l[1]);
    if (s.kind !== 'normals' && size > 14 && !state.all) {
      // An arrow in the middle: the way that the ray is traced.
      const [ux, uy] = [(l[2] - l[0]) / size, (l[3] - l[1]) / size], [mx, my] = [0.55 * l[2] + 0.45 * l[0], 0.55 * l[3] + 0.45 * l[1]];
      pen.beginPath();
      pen.moveTo(mx + 6 * ux, my + 6 * uy);
      pen.lineTo(mx - 4 * ux - 4 * uy, my - 4 * uy + 4 * ux);
      pen.lineTo(mx - 4 * ux + 4 * uy, my - 4 * uy - 4 * ux);
      pen.fill();
    }
    if (s.kind !== 'normals' && !s.open) {
      pen.beginPath();
      pen.arc(l[2], l[3], isChosen ? 4.5 : 2.5, 0, 7);
      pen.fill();
    }
    pen.globalAlpha = 1;
    if (s.kind !== 'normals') drawn.push({ l, s });
  }
}

function nearest(x, y) {
  let best = null, least = 9;
  for (const { l, s } of drawn) {
    const dx = l[2] - l[0], dy = l[3] - l[1], n = dx * dx + dy * dy || 1;
    const t = Math.max(0, Math.min(1, ((x - l[0]) * dx + (y - l[1]) * dy) / n));
    const d = Math.hypot(x - l[0] - t * dx, y - l[1] - t * dy);
    if (d < least) { least = d; best = s; }
  }
  return best;
}

let drag = null;
space.addEventListener('pointerdown', (v) => { drag = { x: v.clientX, y: v.clientY, pan: v.shiftKey || v.button === 1 }; space.setPointerCapture(v.pointerId); });
space.addEventListener('pointerup', () => { drag = null; });
space.addEventListener('pointermove', (v) => {
  if (drag) {
    const [dx, dy] = [v.clientX - drag.x, v.clientY - drag.y];
    Object.assign(drag, { x: v.clientX, y: v.clientY });
    if (drag.pan) move(-dx, dy); else { state.yaw -= dx * 0.008; state.pitch = Math.max(-1.5, Math.min(1.5, state.pitch + dy * 0.008)); }
    later();
    return;
  }
  const box = space.getBoundingClientRect();
  choose(nearest(v.clientX - box.left, v.clientY - box.top));
});
space.addEventListener('wheel', (v) => { v.preventDefault(); state.zoom = Math.max(0.05, Math.min(400, state.zoom * Math.exp(-v.deltaY * 0.0012))); later(); }, { passive: false });
function move(dx, dy) {
  const v = view(), s = (2.1 * spread.radius) / state.zoom / space.clientHeight;
  state.pan = add(state.pan, add(mul(v.right, dx * s), mul(v.up, dy * s)));
}

// ---- 2D: surfaces are nodes, rays are edges, as the course draws it

const SVG = 'http://www.w3.org/2000/svg';
function make(name, attributes, parent, text) {
  const x = document.createElementNS(SVG, name);
  for (const k in attributes) x.setAttribute(k, attributes[k]);
  if (text !== undefined) x.textContent = text;
  parent.appendChild(x);
  return x;
}

function drawTree() {
  const svg = $('tree'), tree = e.trees[state.sample];
  svg.replaceChildren();
  const nodes = tree.rays.map((r, i) => ({ r, i, children: [] }));
  nodes.forEach((n) => { if (n.r.parent !== null && n.r.depth <= state.depth) nodes[n.r.parent].children.push(n); });
  const ROW = 78, WIDE = 118;
  let leaves = 0, deepest = 0;
  const items = [];
  // Each ray's end, with the lights that were asked from it as leaves.
  const place = (n, level) => {
    deepest = Math.max(deepest, level);
    const asked = n.r.asked.map((q, k) => ({ q, k })).filter(({ q }) => (q.answer.what === 'lit' ? !state.hidden.has('lit') : !state.hidden.has('blocked')));
    const shown = n.children.filter((c) => !state.hidden.has(kindOf(c.r)));
    const slots = [];
    asked.forEach((a) => { slots.push(leaves++); a.x = slots[slots.length - 1]; a.level = level + 1; deepest = Math.max(deepest, level + 1); });
    shown.forEach((c) => slots.push(place(c, level + 1)));
    const x = slots.length ? (slots[0] + slots[slots.length - 1]) / 2 : leaves++;
    Object.assign(n, { x, level });
    items.push({ n, asked, shown });
    return x;
  };
  place(nodes[0], 1);
  const width = Math.max(1, leaves) * WIDE + 20, height = (deepest + 1) * ROW + 20;
  Object.entries({ width, height, viewBox: `0 0 ${width} ${height}` }).forEach(([k, v]) => svg.setAttribute(k, v));
  const px = (x) => 10 + WIDE / 2 + x * WIDE, py = (level) => 26 + level * ROW;
  const whole = Math.max(light(tree), 1e-300);
  const edge = (x0, l0, x1, l1, kind, label, chosen) => {
    make('line', { x1: px(x0), y1: py(l0) + 13, x2: px(x1), y2: py(l1) - 13, stroke: css(kind), 'stroke-width': chosen ? 4 : 2, 'stroke-dasharray': kind === 'lit' || kind === 'blocked' ? '5 4' : 'none' }, svg);
    if (label) make('text', { class: 'small', x: (px(x0) + px(x1)) / 2 + 5, y: (py(l0) + py(l1)) / 2 + 3 }, svg, label);
  };
  const first = nodes[0];
  make('text', { x: px(first.x), y: py(0) + 2, 'text-anchor': 'middle' }, svg, 'eye');
  edge(first.x, 0, first.x, 1, 'camera', '', isChosen(first.i));
  for (const { n, asked, shown } of items) {
    for (const c of shown) {
      const lobe = c.r.sent && c.r.sent.lobe;
      const weight = c.r.sent ? Math.max(...c.r.throughput) / (Math.max(...n.r.throughput) || 1) : 1;
      edge(n.x, n.level, c.x, c.level, kindOf(c.r), lobe ? `${lobe.replace(/_/g, ' ')} x ${short(+weight.toFixed(3))}` : '', isChosen(c.i));
    }
    for (const a of asked) edge(n.x, n.level, a.x, a.level, a.q.answer.what === 'lit' ? 'lit' : 'blocked', '', isChosen(n.i, a.k));
  }
  for (const { n, asked } of items) {
    const g = make('g', { class: 'node' + (isChosen(n.i) ? ' chosen' : '') }, svg);
    const name = n.r.hit ? n.r.hit.object : 'background';
    const own = sum(n.r.saw.map((s) => sum(color(s.contribution.sums))));
    make('rect', { x: px(n.x) - 52, y: py(n.level) - 13, width: 104, height: 26, rx: n.r.hit ? 4 : 13, fill: css('panel'), stroke: css(kindOf(n.r)), 'stroke-width': 1.6 }, g);
    make('text', { x: px(n.x), y: py(n.level) + 4, 'text-anchor': 'middle' }, g, name.length > 15 ? name.slice(0, 14) + '…' : name);
    const says = own > 0 ? `${SAYS[n.r.saw[0].what] || 'shines'} ${percent(own / whole)}` : n.r.ended && n.r.ended !== 'absorbed' && n.r.ended !== 'escaped' ? `ended: ${n.r.ended}` : '';
    if (says) make('text', { class: 'small', x: px(n.x), y: py(n.level) + 25, 'text-anchor': 'middle' }, g, says);
    g.addEventListener('pointerenter', () => choose({ index: state.sample, node: n.i }));
    for (const a of asked) {
      const h = make('g', { class: 'node' + (isChosen(n.i, a.k) ? ' chosen' : '') }, svg);
      const lit = a.q.answer.what === 'lit';
      make('circle', { cx: px(a.x), cy: py(a.level), r: 10, fill: lit ? css('lit') : css('panel'), stroke: css(lit ? 'lit' : 'blocked'), 'stroke-width': 1.8 }, h);
      make('text', { x: px(a.x), y: py(a.level) + 25, 'text-anchor': 'middle' }, h, a.q.light || 'no light');
      const share = a.q.answer.contribution ? percent(sum(color(a.q.answer.contribution.sums)) / whole) : a.q.answer.blocker ? `behind ${a.q.answer.blocker.object}` : a.q.answer.what.replace('_', ' ');
      make('text', { class: 'small', x: px(a.x), y: py(a.level) + 39, 'text-anchor': 'middle' }, h, share);
      h.addEventListener('pointerenter', () => choose({ index: state.sample, node: n.i, asked: a.k }));
    }
  }
}
const isChosen = (node, asked) => state.chosen && state.chosen.index === state.sample && state.chosen.node === node && state.chosen.asked === asked;

// ---- numbers of what is pointed at

function choose(s) {
  if (!s) return;
  const same = state.chosen && state.chosen.index === s.index && state.chosen.node === s.node && state.chosen.asked === s.asked;
  if (same) return;
  state.chosen = { index: s.index, node: s.node, asked: s.asked };
  if (s.index !== state.sample) { state.sample = s.index; $('sample').value = e.trees[s.index].sample; drawHistogram(); }
  tell();
  later();
}

function tell() {
  if (!state.chosen) return;
  const r = e.trees[state.chosen.index].rays[state.chosen.node];
  const lines = [];
  const say = (name, value) => { if (value !== undefined && value !== null && value !== '') lines.push(name.padEnd(20) + value); };
  if (state.chosen.asked !== undefined) {
    const q = r.asked[state.chosen.asked];
    lines.push(`light asked: ${q.light || 'none'}   ${q.answer.what.replace('_', ' ')}`, '');
    say('from', r.hit ? `${r.hit.object} (${r.hit.material})` : 'a medium');
    say('distance', short(q.distance));
    say('direction', vector(q.direction));
    say('chance of its choice', short(q.chance));
    say('radiance over pdf', vector(q.radiance_over_pdf));
    say('pdf', short(q.pdf) + ' per sr');
    say('bsdf', vector(q.bsdf) + '  per sr');
    say('cosine', short(q.cosine));
    say('MIS weight', short(q.mis_weight));
    if (q.answer.blocker) say('blocked by', `${q.answer.blocker.object} (${q.answer.blocker.material}), primitive ${q.answer.blocker.primitive}, after ${short(q.answer.blocker.distance)}`);
    if (q.answer.contribution) say('adds to the pixel', vector(color(q.answer.contribution.sums)));
  } else {
    lines.push(`${r.kind} ray   depth ${r.depth}   ->  ${r.hit ? `${r.hit.object} (${r.hit.material})` : 'background'}`, '');
    say('origin', vector(r.origin));
    say('direction', vector(r.direction));
    if (r.hit) {
      say('distance', short(r.hit.distance));
      say('position', vector(r.hit.position));
      say('normal', vector(r.hit.normal) + (r.hit.is_front ? '' : '   (hit from within)'));
      say('shading normal', vector(r.hit.shading_normal));
      say('uv', vector(r.hit.uv));
      say('primitive', String(r.hit.primitive));
    }
    if (r.sent) {
      say('sent by', `${(r.sent.lobe || '').replace(/_/g, ' ')}   bsdf ${vector(r.sent.bsdf)}   pdf ${short(r.sent.pdf)}   cosine ${short(r.sent.cosine)}   survival ${short(r.sent.survival)}`);
    }
    say('throughput', vector(r.throughput));
    say('wavelengths', r.wavelengths ? vector(r.wavelengths) + '  nm' : '');
    say('inside of', r.inside.join(', '));
    r.saw.forEach((s) => say(`sees ${s.what}`, `radiance ${vector(s.radiance)}   MIS weight ${short(s.mis_weight)}   adds ${vector(color(s.contribution.sums))}`));
    r.not_sent.forEach((s) => say('not sent', `${(s.lobe || 'any').replace(/_/g, ' ')}: ${s.fate.replace('_', ' ')}`));
    say('ended', r.ended);
    say('searched', `${r.nodes} nodes, ${r.primitives} primitives`);
    say('time', r.time ? short(r.time) + ' s' : '');
  }
  $('numbers').textContent = lines.join('\n');
}

// ---- the left side

// `names` stand out.
function rich(element, text) {
  element.replaceChildren(...text.split('`').map((part, i) => {
    if (i % 2 === 0) return document.createTextNode(part);
    const name = document.createElement('code');
    name.textContent = part;
    return name;
  }));
}

function drawPicture() {
  const canvas = $('picture'), p = data.picture, context = canvas.getContext('2d');
  const [w, h] = p ? [p.width, p.height] : [e.size[0], e.size[1]];
  Object.assign(canvas, { width: w, height: h });
  const x = ((e.pixel[0] + 0.5) / e.size[0]) * w, y = ((e.pixel[1] + 0.5) / e.size[1]) * h, r = Math.max(3, w / 45);
  const mark = () => {
    for (const [style, wide] of [['#000', 3], ['#fff', 1.2]]) {
      context.strokeStyle = style;
      context.lineWidth = wide * Math.max(1, w / 380);
      context.beginPath();
      context.arc(x, y, r, 0, 7);
      for (const [dx, dy] of [[1, 0], [-1, 0], [0, 1], [0, -1]]) { context.moveTo(x + dx * r, y + dy * r); context.lineTo(x + dx * r * 1.9, y + dy * r * 1.9); }
      context.stroke();
    }
  };
  if (!p) return mark();
  const image = new Image();
  image.onload = () => { context.drawImage(image, 0, 0); mark(); };
  image.src = 'data:image/png;base64,' + p.png;
}

function drawStories() {
  for (const s of data.stories.slice(0, 14)) {
    const row = document.createElement('div'), share = document.createElement('b'), text = document.createElement('div'), bar = document.createElement('i');
    row.className = 'story';
    share.textContent = percent(s.share);
    rich(text, s.text);
    bar.style.width = `${Math.max(0, Math.min(100, s.share * 100))}%`;
    text.append(bar);
    row.append(share, text);
    row.title = `in ${s.samples} of ${e.all_samples} samples`;
    $('stories').append(row);
  }
  if (!data.stories.length) $('stories').textContent = 'Nothing: the pixel is black.';
}

const histogram = $('histogram'), ink = histogram.getContext('2d');
function drawHistogram() {
  const [w, h] = fit(histogram, ink), n = e.trees.length, most = Math.max(...e.trees.map(light), 1e-300), wide = w / n;
  e.trees.forEach((t, i) => {
    const tall = Math.max(1, ((h - 6) * light(t)) / most);
    ink.fillStyle = t.is_invalid ? css('blocked') : i === state.sample ? css('reflected') : css('bar');
    ink.fillRect(i * wide + (wide > 3 ? 0.5 : 0), h - (t.is_invalid ? h : tall), Math.max(0.8, wide - 1), t.is_invalid ? h : tall);
  });
}
histogram.addEventListener('click', (v) => show(Math.floor(((v.clientX - histogram.getBoundingClientRect().left) / histogram.clientWidth) * e.trees.length)));

// ---- controls

function show(i) {
  state.sample = Math.max(0, Math.min(e.trees.length - 1, i));
  state.chosen = null;
  $('sample').value = e.trees[state.sample].sample;
  drawHistogram();
  later();
}
function setDepth(d) {
  state.depth = Math.max(0, Math.min(maxDepth, d));
  $('depth').value = state.depth;
  $('depth_value').textContent = state.depth;
  later();
}
let waits = false;
function later() {
  if (waits) return;
  waits = true;
  requestAnimationFrame(() => { waits = false; drawSpace(); drawTree(); });
}
function setTheme(dark) { document.documentElement.classList.toggle('dark', dark); drawHistogram(); later(); }

$('title').textContent = `Pixel ${e.pixel[0]}, ${e.pixel[1]} of ${e.scene.split('/').pop()}`;
$('title').title = e.scene;
document.title = $('title').textContent;
rich($('summary'), data.summary);
for (const f of data.findings) {
  const item = document.createElement('li');
  rich(item, `${f.code}: ${f.text} (${f.cure}).`);
  $('findings').append(item);
}
$('caption').textContent = `linear ${e.value.map(short).join('  ')}   ${e.integrator}, ${e.color}, ${e.accelerator}, samples ${e.samples[0]} to ${e.samples[1] - 1}, seed ${e.seed}`;
$('hint').textContent = (e.trees.length < e.all_samples ? `${e.trees.length} of ${e.all_samples} samples are in this file. ` : '') + 'Keys: j k sample, [ ] depth, arrows turn, + - zoom, r view, t theme.';
$('depth').max = maxDepth;
KINDS.forEach((kind) => {
  const label = document.createElement('label'), box = document.createElement('input'), swatch = document.createElement('span');
  box.type = 'checkbox';
  box.checked = true;
  box.id = 'show_' + kind;
  box.addEventListener('change', () => { if (box.checked) state.hidden.delete(kind); else state.hidden.add(kind); later(); });
  swatch.className = 'swatch';
  swatch.style.background = `var(--${kind === 'normals' ? 'normal' : kind})`;
  label.append(box, swatch, NAMES[kind] || kind);
  $('kinds').append(label);
});
$('kinds').style.flexWrap = 'wrap';
$('sample').addEventListener('change', () => {
  const asked = Number($('sample').value);
  let best = 0;
  e.trees.forEach((t, i) => { if (Math.abs(t.sample - asked) < Math.abs(e.trees[best].sample - asked)) best = i; });
  show(best);
});
$('previous').addEventListener('click', () => show(state.sample - 1));
$('next').addEventListener('click', () => show(state.sample + 1));
$('all').addEventListener('change', () => { state.all = $('all').checked; later(); });
$('depth').addEventListener('input', () => setDepth(Number($('depth').value)));
$('reset').addEventListener('click', () => { resetView(); later(); });
$('theme').addEventListener('click', () => setTheme(!document.documentElement.classList.contains('dark')));
$('controls').addEventListener('submit', (v) => v.preventDefault());
const KEYS = {
  j: () => show(state.sample + 1), k: () => show(state.sample - 1),
  ']': () => setDepth(state.depth + 1), '[': () => setDepth(state.depth - 1),
  '+': () => { state.zoom *= 1.15; }, '=': () => { state.zoom *= 1.15; }, '-': () => { state.zoom /= 1.15; },
  ArrowLeft: () => { state.yaw -= 0.1; }, ArrowRight: () => { state.yaw += 0.1; },
  ArrowUp: () => { state.pitch = Math.min(1.5, state.pitch + 0.1); }, ArrowDown: () => { state.pitch = Math.max(-1.5, state.pitch - 0.1); },
  r: resetView, t: () => setTheme(!document.documentElement.classList.contains('dark')),
};
window.addEventListener('keydown', (v) => {
  if (v.ctrlKey || v.metaKey || v.altKey || v.target.tagName === 'INPUT') return;
  if (v.target === histogram && (v.key === 'ArrowLeft' || v.key === 'ArrowRight')) { show(state.sample + (v.key === 'ArrowLeft' ? -1 : 1)); v.preventDefault(); return; }
  const act = KEYS[v.key];
  if (!act) return;
  act();
  v.preventDefault();
  later();
});
window.addEventListener('resize', () => { drawHistogram(); later(); });
window.addEventListener('beforeprint', () => { drawSpace(); drawTree(); });

setTheme(window.matchMedia('(prefers-color-scheme: dark)').matches);
setDepth(maxDepth);
drawPicture();
drawStories();
show(state.sample);
