"use strict";
const byId = (id) => document.getElementById(id);
const trouble = (text) => { byId("trouble").hidden = false; byId("trouble").textContent = text; };
window.addEventListener("error", (event) => trouble(event.message));
window.addEventListener("unhandledrejection", (event) => trouble(String(event.reason)));

const run = JSON.parse(byId("run").textContent);
const rows = run.equilibria, events = run.events, recorded = run.frames;
const rowCount = rows.number.length;
const colour = { disk: "#e9e6df", rim: "#a9a59b", rattler: "#9fb8cf", force: "#8c1c13", contact: "#777", opened: "#d97a00", closed: "#0b4f94", motion: "#111" };
const segmentColours = ["#1f4e79", "#c55a11", "#548235", "#7b3f99", "#997300", "#a61c3c"];
const told = (value) => Math.abs(value) < 2 ** -52 ? 0 : Number(value); // smaller strains are below the digits of a length
const sci = (value, digits) => value === null ? "–" : told(value).toExponential(digits);
const short = (value, digits = 6) => value === null ? "–" : String(Number(told(value).toPrecision(digits)));

// --- the numbers of the frames ---------------------------------------------------------------------------------------

async function unpack(text) {
  const packed = Uint8Array.from(atob(text), (c) => c.charCodeAt(0));
  const stream = new Blob([packed]).stream().pipeThrough(new DecompressionStream("deflate"));
  return new Uint8Array(await new Response(stream).arrayBuffer());
}

function* integers(bytes) {
  let value = 0, factor = 1;
  for (const byte of bytes) {
    value += (byte & 127) * factor;
    factor *= 128;
    if (byte < 128) {
      yield value % 2 === 0 ? value / 2 : -(value + 1) / 2;
      value = 0;
      factor = 1;
    }
  }
}

/// Everything that is drawn, frame by frame.
const film = { count: 0, positions: [], arrows: [], forces: [], frameOf: new Map() };

async function decode() {
  const size = recorded.coordinates;
  const next = integers(await unpack(recorded.moves));
  const here = new Float64Array(size);
  for (let f = 0; f < recorded.event.length; ++f) {
    for (let k = 0; k < size; ++k) here[k] += next.next().value;
    film.positions.push(Float32Array.from(here, (x) => x * recorded.resolution));
    if (recorded.equilibrium[f] >= 0) film.frameOf.set(recorded.equilibrium[f], f);
  }
  const arrows = await unpack(recorded.arrows); // one byte each: they are small
  for (let k = 0; k < recorded.longest.length; ++k) {
    film.arrows.push(Int8Array.from(arrows.subarray(k * size, (k + 1) * size), (b) => (b & 1 ? -(b + 1) / 2 : b / 2)));
  }
  const forces = await unpack(recorded.forces);
  let at = 0;
  for (const count of recorded.force_count) {
    film.forces.push(forces.subarray(at, at + count));
    at += count;
  }
  film.count = recorded.event.length;
}

// --- which contacts there are ----------------------------------------------------------------------------------------

const eventsOf = new Map(); // of an equilibrium: its first arc, and the one after its last
for (let e = 0; e < events?.equilibrium.length; ++e) {
  const range = eventsOf.get(events.equilibrium[e]) ?? [e, e];
  eventsOf.set(events.equilibrium[e], [range[0], e + 1]);
}
const relisted = new Map(); // of an equilibrium: the list in the order of its state
const listCache = new Map();

const openedBy = (event) => [events.opened[2 * event], events.opened[2 * event + 1]];
const closedBy = (event) => [events.closed[2 * event], events.closed[2 * event + 1]];

function exchange(list, event) {
  const [i, j] = openedBy(event);
  for (let l = 0; l < list.length; l += 2) {
    if (list[l] === i && list[l + 1] === j) {
      [list[l], list[l + 1]] = closedBy(event);
      return;
    }
  }
}

/// Contacts of an equilibrium, two numbers each.
function contactsOf(equilibrium) {
  const way = [];
  let from = equilibrium;
  while (from >= 0 && !listCache.has(from) && !relisted.has(from)) {
    way.push(from);
    from = rows.previous[from] ?? -1;
  }
  if (from < 0) return null;
  let list = listCache.get(from) ?? Float64Array.from(relisted.get(from));
  listCache.set(from, list);
  for (const to of way.reverse()) {
    list = list.slice();
    const [first, end] = eventsOf.get(to) ?? [0, 0];
    for (let e = first; e < end; ++e) exchange(list, e);
    listCache.set(to, list);
  }
  return list;
}

/// The equilibrium that a frame is, or that its arc left.
function baseOf(frame) {
  if (recorded.equilibrium[frame] >= 0) return recorded.equilibrium[frame];
  const goal = events.equilibrium[recorded.event[frame]];
  return goal < rowCount ? rows.previous[goal] : rowCount - 1;
}

function contactsAt(frame) {
  if (recorded.equilibrium[frame] >= 0) return contactsOf(recorded.equilibrium[frame]);
  const start = contactsOf(baseOf(frame));
  if (!start) return null;
  const list = start.slice(), last = recorded.event[frame];
  for (let e = eventsOf.get(events.equilibrium[last])[0]; e <= last; ++e) exchange(list, e);
  return list;
}

const most = 2 ** 34; // more than there are disks with images; j is from -9
const pairs = (list) => { const all = []; for (let l = 0; l < list.length; l += 2) all.push(list[l] * most + list[l + 1] + 9); return all; };
const pairOf = (number) => [Math.floor(number / most), number % most - 9];

/// What opened and closed to come here: in the arc, or in the whole rearrangement.
function changesAt(frame) {
  const number = recorded.equilibrium[frame], event = recorded.event[frame];
  if (number < 0) return { opened: [openedBy(event)], closed: [closedBy(event)] };
  const before = rows.previous[number] >= 0 ? contactsOf(rows.previous[number]) : null, after = contactsOf(number);
  if (!before || !after || relisted.has(number)) return { opened: [], closed: [] };
  const was = new Set(pairs(before)), is = new Set(pairs(after));
  return { opened: [...was].filter((p) => !is.has(p)).map(pairOf), closed: [...is].filter((p) => !was.has(p)).map(pairOf) };
}

/// The second disk of a contact, and by how many periods it is moved: two signed bytes above its number.
const diskOf = (j) => j % run.packing.radii.length;
function imageOf(j) {
  const k = j < 0 ? 0 : Math.floor(j / run.packing.radii.length);
  return [k << 24 >> 24, k << 16 >> 24];
}

/// Of a disk the first member of its body, which stands for the body.
const bodyOf = (i) => run.packing.body ? run.packing.body[i] : i;
function rattlersOf(equilibrium) {
  const frame = film.frameOf.get(equilibrium), flags = new Uint8Array(run.packing.radii.length);
  const forces = frame === undefined ? undefined : film.forces[recorded.force[frame]], list = forces && contactsOf(equilibrium);
  if (!list) return flags;
  flags.fill(1);
  for (let l = 0; l < forces.length; ++l) {
    if (forces[l] === 0) continue;
    flags[bodyOf(list[2 * l])] = 0;
    if (list[2 * l + 1] >= 0) flags[bodyOf(diskOf(list[2 * l + 1]))] = 0;
  }
  return flags.map((_, i) => flags[bodyOf(i)]);
}

const wallNames = { "-1": "left", "-2": "bottom", "-3": "right", "-4": "top" };
function contactName([i, j]) {
  if (j === -9) return i < 0 ? "?" : `held ${"xy"[i % 2]} of grain ${Math.floor(i / 2)}`;
  const [mx, my] = imageOf(j);
  return `${i}-${wallNames[j] ?? diskOf(j)}` + (mx || my ? `(${mx},${my})` : "");
}

// --- canvases --------------------------------------------------------------------------------------------------------

/// Takes what a canvas takes and keeps it as SVG: circles and lines, the texts of this page alone.
class Paper {
  elements = []; path = ""; dash = []; globalAlpha = 1; lineWidth = 1; lineCap = "butt"; fillStyle = "#000"; strokeStyle = "#000";
  beginPath() { this.path = ""; }
  moveTo(x, y) { this.path += `M${x.toFixed(2)} ${y.toFixed(2)}`; }
  lineTo(x, y) { this.path += `L${x.toFixed(2)} ${y.toFixed(2)}`; }
  arc(x, y, r) { this.moveTo(x + r, y); for (const side of [-1, 1]) this.path += `A${r.toFixed(2)} ${r.toFixed(2)} 0 0 1 ${(x + side * r).toFixed(2)} ${y.toFixed(2)}`; }
  setLineDash(dash) { this.dash = dash; }
  add(look) { if (this.path) this.elements.push(`<path d="${this.path}" opacity="${this.globalAlpha}" ${look}/>`); }
  fill() { this.add(`fill="${this.fillStyle}"`); }
  stroke() { this.add(`fill="none" stroke="${this.strokeStyle}" stroke-width="${this.lineWidth}" stroke-linecap="${this.lineCap}" stroke-dasharray="${this.dash.join(" ")}"`); }
  fillText() {}
}
let paper = null; // in place of the canvas of the packing while it is saved

/// The packing as it is shown, as the text of an SVG file.
function picture() {
  const { clientWidth: width, clientHeight: height } = byId("packing");
  paper = new Paper();
  drawPacking();
  const drawn = paper.elements.join("\n");
  paper = null;
  return `<svg xmlns="${"http:"}//www.w3.org/2000/svg" width="${width}" height="${height}" viewBox="0 0 ${width} ${height}">\n<rect width="100%" height="100%" fill="#fff"/>\n${drawn}\n</svg>\n`;
}

/// The drawing area in CSS pixels, sharp on every screen.
function prepared(canvas) {
  if (paper && canvas.id === "packing") return { pen: paper, width: canvas.clientWidth, height: canvas.clientHeight };
  const scale = window.devicePixelRatio || 1, width = canvas.clientWidth, height = canvas.clientHeight;
  if (canvas.width !== Math.round(width * scale)) canvas.width = Math.round(width * scale);
  if (canvas.height !== Math.round(height * scale)) canvas.height = Math.round(height * scale);
  const pen = canvas.getContext("2d");
  pen.setTransform(scale, 0, 0, scale, 0, 0);
  pen.clearRect(0, 0, width, height);
  return { pen, width, height };
}

const view = { zoom: 1, x: 0, y: 0 }; // x, y: centre, in parts of the frame
let current = 0;

/// So many periods of the cell; nothing in a box.
function periods(q, [mx, my]) {
  const n = run.packing.radii.length;
  return [mx * q[2 * n] + my * (q[2 * n + 2] ?? 0), my * q[2 * n + 1]];
}
const cornersOf = (q) => [[0, 0], [1, 0], [1, 1], [0, 1]].map((m) => periods(q, m));

/// What is drawn: the box, or the cell with room for images.
function frameOf(q) {
  const { radii, upper, periodic } = run.packing, n = radii.length, low = [0, 0], high = [q[2 * n], q[2 * n + 1]];
  for (let a = 0; a < 2; ++a) {
    if (periodic[0] || periodic[1]) {
      const corners = cornersOf(q).map((c) => c[a]), room = periodic[a] ? 2.5 * Math.max(...radii) : 0;
      [low[a], high[a]] = [Math.min(...corners) - room, Math.max(...corners) + room];
    }
    if (periodic[a] || upper[a] !== "absent") continue;
    high[a] = 0;
    for (let i = 0; i < n; ++i) high[a] = Math.max(high[a], q[2 * i + a] + radii[i]);
  }
  return { low, high, size: [high[0] - low[0], high[1] - low[1]] };
}

/// Coordinates with the disks in the cell, and by how many periods each was moved to get there.
function inCell(q) {
  const { radii, periodic } = run.packing, n = radii.length, turns = new Int32Array(2 * n), wrapped = q.slice();
  for (let i = 0; i < n; ++i) {
    for (const a of [1, 0]) {
      if (!periodic[a]) continue;
      const turn = Math.floor((wrapped[2 * i + a] - (a === 0 ? wrapped[2 * i + 1] / q[2 * n + 1] * (q[2 * n + 2] ?? 0) : 0)) / q[2 * n + a]);
      const [x, y] = periods(q, a === 0 ? [turn, 0] : [0, turn]);
      turns[2 * i + a] = turn;
      wrapped[2 * i] -= x;
      wrapped[2 * i + 1] -= y;
    }
  }
  return { q: wrapped, turns };
}

function placed(canvas, q) {
  const { pen, width, height } = prepared(canvas), frame = frameOf(q), [w, h] = frame.size, border = 12;
  const scale = view.zoom * Math.min((width - 2 * border) / w, (height - 2 * border) / h);
  const left = width / 2 - scale * (frame.low[0] + w * (0.5 + view.x)), low = height / 2 + scale * (frame.low[1] + h * (0.5 + view.y));
  return { pen, frame, scale, x: (u) => left + scale * u, y: (v) => low - scale * v, width, height };
}

function addLines(pen, lines) {
  for (const [a, b, c, d] of lines) {
    pen.moveTo(a, b);
    pen.lineTo(c, d);
  }
}

function strokeLines(pen, lines) {
  pen.beginPath();
  addLines(pen, lines);
  pen.stroke();
}

/// Draws many small shapes, some at a time: long paths are slow.
function inParts(count, pen, add, finish) {
  const part = 100;
  for (let begin = 0; begin < count; begin += part) {
    pen.beginPath();
    for (let k = begin; k < Math.min(count, begin + part); ++k) add(k);
    finish();
  }
}

/// The disks, and in a cell their images: those are paler.
function drawDisks(at, q, flags) {
  const along = (a) => run.packing.periodic[a] ? [-1, 0, 1] : [0];
  for (const mx of along(0)) for (const my of along(1)) {
    const [x, y] = periods(q, [mx, my]);
    at.pen.globalAlpha = mx || my ? 0.4 : 1;
    drawCopy({ ...at, x: (u) => at.x(u + x), y: (v) => at.y(v + y) }, q, flags);
  }
  at.pen.globalAlpha = 1;
}

function drawCopy(at, q, flags) {
  const radii = run.packing.radii;
  for (const rattler of [0, 1]) {
    at.pen.fillStyle = rattler ? colour.rattler : colour.disk;
    at.pen.strokeStyle = rattler ? "#5f7f9d" : colour.rim;
    at.pen.lineWidth = 0.6;
    const add = (i) => {
      const x = at.x(q[2 * i]), y = at.y(q[2 * i + 1]), r = radii[i] * at.scale;
      if (flags[i] !== rattler || x < -r || y < -r || x > at.width + r || y > at.height + r) return;
      at.pen.moveTo(x + r, y);
      at.pen.arc(x, y, r, 0, 2 * Math.PI);
    };
    const large = at.scale * radii[0] > 5; // the rim of smaller ones is not worth its time
    inParts(radii.length, at.pen, add, () => { at.pen.fill(); if (large || rattler) at.pen.stroke(); });
  }
}

/// From the centre of the disk to that of the other, moved by so many periods, or to the wall.
function segment(at, q, i, j, image = [0, 0]) {
  const x = at.x(q[2 * i]), y = at.y(q[2 * i + 1]), n = run.packing.radii.length;
  if (j >= 0) {
    const [dx, dy] = periods(q, image);
    return [x, y, at.x(q[2 * j] + dx), at.y(q[2 * j + 1] + dy)];
  }
  const axis = (-1 - j) % 2, wall = j >= -2 ? 0 : q[2 * n + axis];
  return axis === 0 ? [x, y, at.x(wall), y] : [x, y, x, at.y(wall)];
}

/// The line of a contact; two where it goes through a border of the cell: from either side.
function segments(at, { q, turns }, i, j) {
  if (j < 0) return [segment(at, q, i, j)];
  const disk = diskOf(j), image = imageOf(j).map((m, a) => m + turns[2 * disk + a] - turns[2 * i + a]);
  const there = segment(at, q, i, disk, image);
  return image[0] || image[1] ? [there, segment(at, q, disk, i, [-image[0], -image[1]])] : [there];
}

function drawContacts(at, place, list, forces) {
  const mean = 0.2 * at.scale * run.packing.radii.reduce((a, b) => a + b, 0) / run.packing.radii.length;
  const groups = new Map(); // lines of one width together
  for (let l = 0; l < list.length / 2; ++l) {
    if (list[2 * l + 1] === -9) continue;
    const width = forces && byId("forces").checked ? forces[l] : 0;
    if (!groups.has(width)) groups.set(width, []);
    groups.get(width).push(l);
  }
  at.pen.lineCap = "round";
  for (const [width, members] of groups) {
    at.pen.strokeStyle = width > 0 ? colour.force : colour.contact;
    at.pen.lineWidth = width > 0 ? Math.max(0.3, mean * width / recorded.parts) : 0.4;
    const add = (k) => addLines(at.pen, segments(at, place, list[2 * members[k]], list[2 * members[k] + 1]));
    inParts(members.length, at.pen, add, () => at.pen.stroke());
  }
}

function drawChange(at, place, [i, j], style, dash) {
  if (i < 0 || j === -9) return;
  for (const [ink, width] of [["#fff", 7], [style, 4]]) {
    at.pen.setLineDash(ink === "#fff" ? [] : dash);
    at.pen.lineCap = "butt";
    at.pen.strokeStyle = ink;
    at.pen.lineWidth = width;
    strokeLines(at.pen, segments(at, place, i, j));
  }
  at.pen.setLineDash([]);
}

/// The longest arrow has three mean radii.
function drawMotion(at, q, arrows) {
  const radii = run.packing.radii, unit = 3 / 31 * at.scale * radii.reduce((a, b) => a + b, 0) / radii.length;
  at.pen.strokeStyle = colour.motion;
  at.pen.lineWidth = 1.1;
  at.pen.lineCap = "butt";
  const every = Math.ceil(radii.length / 1500 / view.zoom ** 2); // more arrows than these are not seen, but wait for
  const add = (k) => {
    const i = k * every;
    const dx = arrows[2 * i] * unit, dy = -arrows[2 * i + 1] * unit, length = Math.hypot(dx, dy);
    if (length < 3) return;
    const x = at.x(q[2 * i]), y = at.y(q[2 * i + 1]), head = Math.min(6, length / 2) / length;
    at.pen.moveTo(x, y);
    at.pen.lineTo(x + dx, y + dy);
    at.pen.lineTo(x + dx - head * (dx + dy / 2), y + dy - head * (dy - dx / 2));
    at.pen.moveTo(x + dx, y + dy);
    at.pen.lineTo(x + dx - head * (dx - dy / 2), y + dy - head * (dy + dx / 2));
  };
  inParts(Math.floor(radii.length / every), at.pen, add, () => at.pen.stroke());
}

function drawWalls(at, q) {
  const { low: [left, down], high: [right, up] } = at.frame, { lower, upper, radii, periodic } = run.packing;
  const [w, h] = [q[2 * radii.length], q[2 * radii.length + 1]];
  const sides = [[lower[0], 0, down, 0, up], [lower[1], left, 0, right, 0], [upper[0], w, down, w, up], [upper[1], left, h, right, h]];
  for (const [kind, a, b, c, d] of sides) {
    if (kind === "absent") continue;
    at.pen.strokeStyle = kind === "fixed" ? "#222" : "#8f8f8f";
    at.pen.lineWidth = 3;
    strokeLines(at.pen, [[at.x(a), at.y(b), at.x(c), at.y(d)]]);
  }
  const corners = cornersOf(q);
  at.pen.setLineDash([8, 5]);
  at.pen.strokeStyle = "#222";
  at.pen.lineWidth = 1.5;
  for (let side = 0; side < 4; ++side) { // sides 0 and 2 are along x: they repeat along y
    if (!periodic[(side + 1) % 2]) continue;
    const [[a, b], [c, d]] = [corners[side], corners[(side + 1) % 4]];
    strokeLines(at.pen, [[at.x(a), at.y(b), at.x(c), at.y(d)]]);
  }
  at.pen.setLineDash([]);
}

function drawPacking() {
  const canvas = byId("packing");
  if (film.count === 0) {
    const { pen } = prepared(canvas);
    pen.font = "14px sans-serif";
    pen.fillText("no packing is known: see What is drawn", 12, 24);
    return;
  }
  const place = inCell(film.positions[current]), q = place.q, list = contactsAt(current), isEquilibrium = recorded.equilibrium[current] >= 0;
  const at = placed(canvas, q);
  drawDisks(at, q, byId("rattlers").checked ? rattlersOf(baseOf(current)) : new Uint8Array(run.packing.radii.length));
  if (list) drawContacts(at, place, list, isEquilibrium ? film.forces[recorded.force[current]] : undefined);
  drawWalls(at, q);
  if (byId("changes").checked) {
    const changes = changesAt(current);
    for (const pair of changes.opened) drawChange(at, place, pair, colour.opened, [7, 5]);
    for (const pair of changes.closed) drawChange(at, place, pair, colour.closed, []);
  }
  const arrows = film.arrows[isEquilibrium ? recorded.whole[current] : recorded.arrow[current]];
  if (byId("motion").checked && arrows) drawMotion(at, q, arrows);
}

// --- the staircase ---------------------------------------------------------------------------------------------------

const ratioOf = (event) => { // events have the stress only
  const k = [Math.min(events.equilibrium[event], rowCount - 1), ...rows.sigma2.keys()].find((row) => rows.sigma2[row]) ?? 0;
  return events.sigma2[event] * rows.ratio[k] / rows.sigma2[k];
};
const placeOf = (frame) => recorded.equilibrium[frame] >= 0
  ? [rows.eps2[recorded.equilibrium[frame]], rows.ratio[recorded.equilibrium[frame]]]
  : [events.eps2[recorded.event[frame]], ratioOf(recorded.event[frame])];

function niceTicks(low, high, most) {
  const raw = (high - low) / most, power = 10 ** Math.floor(Math.log10(raw));
  const step = [1, 2, 5, 10].map((f) => f * power).find((s) => s >= raw), ticks = [];
  for (let k = Math.ceil(low / step); k * step <= high; ++k) ticks.push(k * step);
  return { ticks, digits: Math.max(0, -Math.floor(Math.log10(step) + 1e-9)) };
}

let chart = null;
function scaleChart(width, height) {
  const x = rows.eps2, y = rows.ratio, span = (v) => { let a = Infinity, b = -Infinity; for (const u of v) { a = Math.min(a, u); b = Math.max(b, u); } const c = b > a ? b - a : Math.abs(b) || 1; return [a - 0.04 * c, b + 0.04 * c]; };
  const [x0, x1] = span(x), [y0, y1] = span(y), left = 64, low = 34, top = 26, right = 14;
  chart = { x: (u) => left + (u - x0) / (x1 - x0) * (width - left - right), y: (v) => height - low - (v - y0) / (y1 - y0) * (height - low - top), x0, x1, y0, y1, left, low, top, right };
}

function drawAxes(pen, width, height) {
  pen.font = "12px sans-serif";
  pen.strokeStyle = "#e2ded5";
  pen.fillStyle = "#1c1b19";
  pen.lineWidth = 1;
  const power = Math.floor(Math.log10(Math.max(Math.abs(chart.x0), Math.abs(chart.x1)))), unit = power < -2 ? 10 ** power : 1;
  const across = niceTicks(chart.x0 / unit, chart.x1 / unit, Math.max(2, width / 110)), up = niceTicks(chart.y0, chart.y1, Math.max(2, height / 60));
  pen.textAlign = "center";
  for (const t of across.ticks) {
    strokeLines(pen, [[chart.x(t * unit), chart.top, chart.x(t * unit), height - chart.low]]);
    pen.fillText(t.toFixed(across.digits), chart.x(t * unit), height - chart.low + 15);
  }
  pen.textAlign = "right";
  for (const t of up.ticks) {
    strokeLines(pen, [[chart.left, chart.y(t), width - chart.right, chart.y(t)]]);
    pen.fillText(t.toFixed(up.digits), chart.left - 6, chart.y(t) + 4);
  }
  pen.fillText(`strain ${run.words.strain}` + (unit === 1 ? "" : ` (10${[...String(power)].map((c) => "⁻⁰¹²³⁴⁵⁶⁷⁸⁹"["-0123456789".indexOf(c)]).join("")})`), width - chart.right, height - 5);
  pen.textAlign = "left";
  pen.fillText(`stress ratio ${run.words.ratio}`, 6, 15);
}

function drawStairs() {
  const { pen, width, height } = prepared(byId("stairs"));
  if (rowCount === 0) return;
  scaleChart(width, height);
  drawAxes(pen, width, height);
  pen.lineWidth = 1.5;
  for (let k = 0; k < rowCount; ++k) {
    const p = rows.previous[k];
    if (p < 0) continue;
    pen.beginPath();
    pen.moveTo(chart.x(rows.eps2[p]), chart.y(rows.ratio[p]));
    pen.lineTo(chart.x(rows.eps2[p]), chart.y(rows.ratio[k]));
    pen.lineTo(chart.x(rows.eps2[k]), chart.y(rows.ratio[k]));
    pen.strokeStyle = segmentColours[rows.segment[k] % segmentColours.length];
    pen.stroke();
  }
  if (film.count === 0) return;
  const [x, y] = placeOf(current);
  pen.beginPath();
  pen.arc(chart.x(x), chart.y(y), 6, 0, 2 * Math.PI);
  pen.fillStyle = recorded.equilibrium[current] >= 0 ? "#111" : "#fff";
  pen.strokeStyle = "#111";
  pen.lineWidth = 2;
  pen.fill();
  pen.stroke();
}

function nearest(px, py) {
  let best = current, least = Infinity;
  for (let f = 0; f < film.count; ++f) {
    const [x, y] = placeOf(f);
    const d = Math.hypot(chart.x(x) - px, chart.y(y) - py) - (recorded.equilibrium[f] >= 0 ? 1 : 0); // equilibria first
    if (d < least) [best, least] = [f, d];
  }
  return best;
}

// --- words and tables ------------------------------------------------------------------------------------------------

function row(cells, words = []) {
  const line = document.createElement("tr");
  cells.forEach((text, k) => {
    const cell = document.createElement("td");
    cell.textContent = text;
    if (words.includes(k)) cell.className = "words";
    line.append(cell);
  });
  return line;
}

const provedWords = (k) => rows.proved[k] === 1 ? (rows.certified[k] === 1 ? "yes, with a certificate" : "yes") : "no";

function fillEquilibria() {
  const body = byId("equilibria").tBodies[0];
  for (let k = 0; k < rowCount; ++k) {
    const line = row([rows.number[k], run.segments[rows.segment[k]] ?? rows.segment[k], short(rows.ratio[k], 9), sci(rows.eps2[k], 4), rows.arcs[k], rows.h[k], rows.rattlers[k], sci(rows.margin[k], 1), provedWords(k)], [1, 8]);
    line.addEventListener("click", () => film.frameOf.has(k) && show(film.frameOf.get(k)));
    body.append(line);
  }
}

function fillNumbers(k) {
  const body = byId("numbers").tBodies[0];
  const stress = (value) => value === null ? "unbounded" : short(value, 9);
  const list = [["number", rows.number[k]], ["segment", run.segments[rows.segment[k]] ?? rows.segment[k]], [run.words.ratio, short(rows.ratio[k], 12)], [run.words.strain, short(rows.eps2[k], 9)], [run.words.other_strain, short(rows.eps1[k], 9)],
    [`supported interval of ${run.words.stress}`, `${stress(rows.sigma2_low[k])} to ${stress(rows.sigma2_high[k])}`], ["solid fraction", short(rows.solid_fraction[k], 8)], ["contacts, with a force", `${rows.contacts[k]}, ${rows.backbone[k]}`],
    ["rattlers", rows.rattlers[k]], ["self-stresses h", rows.h[k]], ["held coordinates", rows.held[k]], ["smallest margin", sci(rows.margin[k], 2)], ["decided by", ["signs and counts", "double", "double-double", "MPFR", "exact numbers"][rows.decided_by[k]] ?? "–"], ["proved", provedWords(k)]];
  body.replaceChildren(...list.map(([name, value]) => row([name, value], [0])));
}

/// Scrolls its table to a row, and nothing else.
function reveal(line) {
  const frame = line?.closest(".scroll");
  if (!frame) return;
  const above = line.offsetTop - frame.querySelector("thead").offsetHeight, below = line.offsetTop + line.offsetHeight - frame.clientHeight;
  if (frame.scrollTop > above) frame.scrollTop = above;
  if (frame.scrollTop < below) frame.scrollTop = below;
}

const mostArcs = 400; // rows of the table
function fillArcs(k) {
  const body = byId("arcs").tBodies[0], [first, end] = eventsOf.get(k) ?? [0, 0];
  const chosen = film.count ? recorded.event[current] : -1;
  const begin = end - first > mostArcs ? Math.max(first, Math.min(chosen - mostArcs / 2, end - mostArcs)) : first, stop = Math.min(end, begin + mostArcs);
  const lines = [];
  for (let e = begin; e < stop; ++e) {
    const line = row([events.arc[e], events.kind[e], contactName(openedBy(e)), contactName(closedBy(e)), sci(events.eps2[e], 6), short(events.displacement[e], 3)], [1]);
    if (e === chosen) line.className = "here";
    const frame = recorded.event.indexOf(e);
    line.addEventListener("click", () => frame >= 0 && show(frame));
    lines.push(line);
  }
  body.replaceChildren(...lines);
  byId("more_arcs").textContent = stop - begin < end - first ? `${stop - begin} of ${end - first} arcs` : end === first ? "none" : "";
  reveal(body.querySelector(".here"));
}

function describe() {
  const number = recorded.equilibrium[current], event = recorded.event[current];
  const arrows = number >= 0 ? recorded.whole[current] : recorded.arrow[current];
  const longest = arrows >= 0 ? ` Longest arrow: ${short(recorded.longest[arrows], 3)}.` : "";
  if (number >= 0) return `Equilibrium ${number}: ${run.words.ratio} = ${short(rows.ratio[number], 9)}, ${run.words.strain} = ${short(rows.eps2[number], 6)}, ${rows.arcs[number] === 1 ? "1 arc" : rows.arcs[number] + " arcs"} led here.` + longest;
  const [first, end] = eventsOf.get(events.equilibrium[event]);
  return `Towards equilibrium ${events.equilibrium[event]}, end of arc ${events.arc[event]} of ${end - first}: ${contactName(openedBy(event))} opened, ${contactName(closedBy(event))} closed, ${run.words.strain} = ${short(events.eps2[event], 6)}.` + longest;
}

// --- going about -----------------------------------------------------------------------------------------------------

let shownRow = -1;
function show(frame) {
  if (film.count === 0) return;
  current = Math.max(0, Math.min(film.count - 1, frame));
  const number = recorded.equilibrium[current] >= 0 ? recorded.equilibrium[current] : events.equilibrium[recorded.event[current]];
  byId("slide").value = current;
  byId("where").textContent = describe();
  document.body.dataset.frame = current;
  document.body.dataset.equilibrium = number;
  if (number < rowCount) fillNumbers(number);
  fillArcs(number);
  if (number !== shownRow) {
    const lines = byId("equilibria").tBodies[0].rows;
    lines[shownRow]?.classList.remove("here");
    lines[number]?.classList.add("here");
    reveal(lines[number]);
    shownRow = number;
  }
  draw();
}

let waiting = false;
function draw() {
  if (waiting) return;
  waiting = true;
  requestAnimationFrame(() => { waiting = false; drawStairs(); drawPacking(); });
}

function otherEquilibrium(step) {
  for (let f = current + step; f >= 0 && f < film.count; f += step) if (recorded.equilibrium[f] >= 0) return show(f);
}

let playing = null;
function play(on) {
  if (on === (playing !== null)) return;
  if (!on) {
    playing = null;
  } else {
    if (current === film.count - 1) show(0);
    const begin = playing = { time: performance.now(), frame: current, speed: Number(byId("speed").value) };
    const step = (now) => {
      if (playing !== begin) return;
      const frame = begin.frame + Math.floor((now - begin.time) / 1000 * begin.speed);
      if (frame !== current) show(frame);
      if (current === film.count - 1) play(false); else requestAnimationFrame(step);
    };
    requestAnimationFrame(step);
  }
  byId("play").textContent = playing ? "stop" : "play";
  byId("play").setAttribute("aria-pressed", String(playing !== null));
}

function zoom(factor) {
  view.zoom = Math.max(1, Math.min(60, view.zoom * factor));
  if (view.zoom === 1) view.x = view.y = 0;
  draw();
}

const toggle = (id) => { byId(id).checked = !byId(id).checked; draw(); };
const keys = {
  ArrowRight: () => show(current + 1), ArrowLeft: () => show(current - 1), ArrowUp: () => otherEquilibrium(1), ArrowDown: () => otherEquilibrium(-1),
  PageDown: () => otherEquilibrium(1), PageUp: () => otherEquilibrium(-1), Home: () => show(0), End: () => show(film.count - 1), " ": () => play(playing === null),
  f: () => toggle("forces"), r: () => toggle("rattlers"), c: () => toggle("changes"), m: () => toggle("motion"),
  "+": () => zoom(1.5), "-": () => zoom(1 / 1.5), 0: () => zoom(0),
};

function listen() {
  document.addEventListener("keydown", (event) => {
    const onControl = event.target.closest("select, button, input[type=checkbox]") && [" ", "Enter", "ArrowUp", "ArrowDown"].includes(event.key);
    if (event.ctrlKey || event.altKey || event.metaKey || onControl || event.target.tagName === "SELECT" || !keys[event.key]) return;
    event.preventDefault();
    if (event.key !== " ") play(false);
    keys[event.key]();
  });
  const press = { first: () => show(0), back_far: () => otherEquilibrium(-1), back: () => show(current - 1), on: () => show(current + 1), on_far: () => otherEquilibrium(1), last: () => show(film.count - 1) };
  for (const [id, act] of Object.entries(press)) byId(id).addEventListener("click", () => { play(false); act(); });
  byId("play").addEventListener("click", () => play(playing === null));
  byId("speed").addEventListener("change", () => { if (playing) { play(false); play(true); } });
  byId("slide").addEventListener("input", (event) => { play(false); show(Number(event.target.value)); });
  for (const id of ["forces", "rattlers", "changes", "motion"]) byId(id).addEventListener("change", draw);
  byId("in").addEventListener("click", () => zoom(1.5));
  byId("out").addEventListener("click", () => zoom(1 / 1.5));
  byId("whole").addEventListener("click", () => zoom(0));
  byId("save").addEventListener("click", () => {
    const link = document.createElement("a");
    link.href = URL.createObjectURL(new Blob([picture()], { type: "image/svg+xml" }));
    link.download = `packing-${document.body.dataset.equilibrium}.svg`;
    link.click();
    URL.revokeObjectURL(link.href);
  });
  byId("stairs").addEventListener("click", (event) => { play(false); if (chart) show(nearest(event.offsetX, event.offsetY)); });
  const canvas = byId("packing");
  let held = null;
  canvas.addEventListener("pointerdown", (event) => { held = [event.clientX, event.clientY]; canvas.setPointerCapture(event.pointerId); });
  canvas.addEventListener("pointermove", (event) => {
    if (!held || view.zoom === 1) return;
    const size = view.zoom * Math.min(canvas.clientWidth, canvas.clientHeight);
    view.x -= (event.clientX - held[0]) / size;
    view.y += (event.clientY - held[1]) / size;
    held = [event.clientX, event.clientY];
    draw();
  });
  canvas.addEventListener("pointerup", () => { held = null; });
  canvas.addEventListener("pointercancel", () => { held = null; });
  window.addEventListener("resize", fit);
}

/// The canvas of the packing has the shape of what is drawn.
function fit() {
  const canvas = byId("packing"), box = film.count ? frameOf(film.positions[0]).size : [2, 1], most = 0.82 * window.innerHeight;
  canvas.style.height = Math.round(Math.max(160, Math.min(most, canvas.clientWidth * box[1] / box[0]))) + "px";
  draw();
}

function introduce() {
  const name = run.scene_file.split("/").pop();
  document.title = `${name} – Isostat`;
  byId("name").textContent = name;
  for (const word of ["ratio", "strain"]) for (const place of document.getElementsByClassName(word)) place.textContent = run.words[word];
  run.segments.forEach((name, s) => {
    const key = document.createElement("span");
    key.className = "key";
    key.style.borderColor = segmentColours[s % segmentColours.length];
    byId("curves").append(" ", key, name);
  });
  const disks = run.packing ? `${run.packing.radii.length} disks, ` : "";
  byId("summary").textContent = `${run.program}: ${disks}${rowCount} equilibria, ${run.arcs} arcs; the run is: ${run.status}`;
  const proved = rows.proved.filter((p) => p === 1).length;
  byId("proved").textContent = `${proved} of ${rowCount} equilibria were proved when the run was made, at the level certify = "${run.level}":`;
  byId("levels").querySelector(`tr[data-level="${CSS.escape(run.level)}"]`)?.classList.add("here");
  for (const text of run.left_out) {
    const item = document.createElement("li");
    item.textContent = `Left out: ${text}`;
    byId("left_out").append(item);
  }
}

async function begin() {
  introduce();
  fillEquilibria();
  if (recorded) {
    recorded.list.forEach((list, f) => { if (list >= 0) relisted.set(recorded.equilibrium[f], recorded.lists[list]); });
    await decode();
  }
  byId("slide").max = Math.max(0, film.count - 1);
  listen();
  fit();
  show(0);
  document.body.dataset.ready = film.count;
}

begin();
