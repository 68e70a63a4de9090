// Values of points and curves by pointer and keyboard; legend entries and windows as switches.
const NEAR_POINT = 16, NEAR_CURVE = 28, SVG = "http://www.w3.org/2000/svg";

const made = (tag, className, parent) => {
  const out = document.createElement(tag);
  out.className = className;
  parent.append(out);
  return out;
};
const number = v => {
  const size = Math.abs(v);
  const text = size !== 0 && (size < 1e-5 || size >= 1e6) ? v.toExponential(3) : String(Number(v.toPrecision(5)));
  return text.replace(/-/g, "−");
};
const inside = ([left, top, wide, tall], [x, y]) => x >= left && x <= left + wide && y >= top && y <= top + tall;
// Bars are met anywhere along them.
const distance = (bars, dx, dy) =>
  bars === "across" ? Math.abs(dy) + 0.01 * Math.abs(dx) : bars ? Math.abs(dx) + 0.01 * Math.abs(dy) : Math.hypot(dx, dy);
const valued = (name, v, unit) => `${name} = ${number(v)}${unit ? ` ${unit}` : ""}`;

// A row of switches; calls `turned` with the key and whether it is on.
function switches(row, entries, turned) {
  for (const [key, fill] of entries) {
    const button = made("button", "switch", row);
    button.type = "button";
    button.setAttribute("aria-pressed", "true");
    fill(button);
    button.addEventListener("click", () => {
      const on = button.getAttribute("aria-pressed") !== "true";
      button.setAttribute("aria-pressed", String(on));
      turned(key, on);
    });
  }
}

// The drawing's own sample of a series, moved into a small drawing.
function swatch(sample, parent) {
  const box = sample.getBBox(), tall = Math.max(10, box.height + 2);
  const svg = document.createElementNS(SVG, "svg");
  svg.setAttribute("viewBox", `${box.x - 1} ${box.y + box.height / 2 - tall / 2} ${box.width + 2} ${tall}`);
  svg.setAttribute("width", 1.25 * (box.width + 2));
  svg.setAttribute("height", 1.25 * tall);
  svg.setAttribute("aria-hidden", "true");
  svg.append(sample);
  parent.append(svg);
}

// The words of a drawn label with its italics and indices; they wrap, which words of a drawing cannot.
function lettered(label, parent) {
  let level = 0;
  for (const part of (label.querySelector("text") ?? label).childNodes) {
    const look = part.nodeType === Node.ELEMENT_NODE ? part : null;
    level += parseFloat(look?.getAttribute("dy") ?? 0) * parseFloat(look?.getAttribute("font-size") ?? 1);
    const tags = [Math.abs(level) < 0.01 ? "" : level > 0 ? "sub" : "sup", look?.getAttribute("font-style") ? "i" : ""];
    let place = parent;
    for (const tag of tags.filter(Boolean)) place = made(tag, "", place);
    place.append(part.textContent);
  }
}

class Plot {
  constructor(figure, data) {
    this.figure = figure;
    this.panels = data.panels;
    this.plot = figure.querySelector(".plot");
    this.svg = this.plot.querySelector("svg");
    this.off = new Set();
    this.offGroups = new Set();
    this.at = null;
    this.legend();
    this.groups();
    this.probe(data.title);
    this.zoom = new Zoom(this);
  }

  artists(key) { return this.svg.querySelectorAll(`[data-series="${CSS.escape(key)}"]`); }

  legend() {
    const drawn = this.svg.querySelector("[data-legend]");
    if (!drawn) return;
    const row = made("div", "switches", this.figure);
    row.setAttribute("role", "group");
    row.setAttribute("aria-label", "Shown in the drawing");
    this.plot.before(row);
    const foot = drawn.getBBox(), box = this.svg.viewBox.baseVal;
    this.figure.whole = {box: this.svg.getAttribute("viewBox"), legend: drawn.cloneNode(true)};
    const labels = [...drawn.querySelectorAll("[data-label]")];
    const samples = [...drawn.querySelectorAll("[data-swatch]")];
    samples.forEach((sample, i) => {
      const key = sample.dataset.swatch;
      const fill = place => { swatch(sample, place); lettered(labels[i], made("span", "", place)); };
      if (!key) fill(made("span", "entry", row));
      else switches(row, [[key, fill]], (k, on) => this.turn(k, on));
    });
    drawn.remove();
    const cut = foot.y + foot.height - 1;
    this.svg.setAttribute("viewBox", `${box.x} ${cut} ${box.width} ${box.y + box.height - cut}`);
  }

  turn(key, on) {
    this.off[on ? "delete" : "add"](key);
    for (const artist of this.artists(key)) artist.style.display = on ? "" : "none";
    this.hide();
  }

  groups() {
    const by = this.panels.find(p => p.grouped);
    if (!by) return;
    const every = this.panels.flatMap(p => p.series.flatMap(s => s.groups || []));
    const names = [...new Set(every)].sort((a, b) => Number(a) - Number(b));
    if (names.length < 2) return;
    const row = made("div", "switches groups", this.figure);
    row.setAttribute("role", "group");
    row.setAttribute("aria-label", `${by.grouped}s shown`);
    this.plot.after(row);
    made("span", "entry", row).textContent = `${by.grouped}s${by.units[0] ? ` [${by.units[0]}]` : ""}`;
    const entries = names.map(name => [name, button => { button.textContent = name; }]);
    this.marks = this.grouped(names);
    switches(row, entries, (name, on) => {
      this.offGroups[on ? "delete" : "add"](name);
      for (const mark of this.marks.get(name)) mark.style.display = on ? "" : "none";
      this.hide();
    });
  }

  // Marks of the drawing by the group that each stands in; a series stands a little beside its windows.
  grouped(names) {
    const out = new Map(names.map(name => [name, []]));
    for (const panel of this.panels) for (const series of panel.series) {
      const aside = series.x[0] - Number(series.groups[0]);
      const places = names.map(name => this.place(panel, Number(name) + aside, 0)[0]);
      for (const artist of this.artists(series.key)) for (const mark of artist.querySelectorAll("use, path")) {
        if (mark.closest("defs")) continue;
        const x = mark.localName === "use" ? mark.x.baseVal.value : parseFloat(mark.getAttribute("d").slice(1));
        const far = places.map(p => Math.abs(p - x));
        out.get(names[far.indexOf(Math.min(...far))]).push(mark);
      }
    }
    return out;
  }

  place(panel, x, y) {
    const [left, top, wide, tall] = panel.frame;
    let right = (x - panel.across[0]) / (panel.across[1] - panel.across[0]);
    if (panel.bars) right = Math.max(0, Math.min(1, right));
    const up = (y - panel.up[0]) / (panel.up[1] - panel.up[0]);
    return [left + wide * right, top + tall * (1 - up)];
  }

  // Whether a place lies in the frame; a bar that leaves it ends at its edge.
  within(panel, x, y) {
    const [left, top, wide, tall] = panel.frame, [px, py] = this.place(panel, x, y);
    return px > left - 1 && px < left + wide + 1 && py > top - 1 && py < top + tall + 1;
  }

  shown(series, i) { return !this.off.has(series.key) && !(series.groups && this.offGroups.has(series.groups[i])); }

  // Series that the keyboard goes through, each with the points that are shown.
  stops() {
    return this.panels.flatMap(panel => panel.series.map(series => {
      const order = series.x.map((_, i) => i).filter(i => this.shown(series, i) && this.within(panel, series.x[i], series.y[i]));
      const rank = panel.bars === "across" ? i => -series.y[i] : i => series.x[i];
      return {panel, series, order: order.sort((a, b) => rank(a) - rank(b))};
    })).filter(s => s.order.length);
  }

  probe(title) {
    this.ring = document.createElementNS(SVG, "circle");
    this.ring.setAttribute("r", "5");
    this.ring.setAttribute("class", "ring");
    this.svg.append(this.ring);
    this.said = made("div", "said", this.plot);
    const probe = this.probed = made("div", "probe", this.plot);
    probe.tabIndex = 0;
    probe.setAttribute("role", "slider");
    probe.setAttribute("aria-label", `Values of ${title}. Left and right: points; up and down: series.`);
    probe.setAttribute("aria-valuemin", "0");
    this.hide();
    probe.addEventListener("pointermove", e => this.point(e));
    probe.addEventListener("pointerdown", e => this.point(e));
    probe.addEventListener("pointerleave", () => this.hide());
    probe.addEventListener("focus", () => { if (!this.at && probe.matches(":focus-visible")) this.step(0, 0); });
    probe.addEventListener("blur", () => this.hide());
    probe.addEventListener("keydown", e => this.key(e));
  }

  key(e) {
    const moves = {ArrowRight: [1, 0], ArrowLeft: [-1, 0], ArrowDown: [0, 1], ArrowUp: [0, -1],
      PageDown: [10, 0], PageUp: [-10, 0], Home: [-Infinity, 0], End: [Infinity, 0]};
    if (e.key === "Escape") this.hide();
    else if (moves[e.key]) { this.step(...moves[e.key]); e.preventDefault(); }
  }

  step(along, across) {
    const stops = this.stops();
    if (!stops.length) return;
    const here = this.at || {row: 0, column: along ? -1 : 0};
    const row = (here.row + across + stops.length) % stops.length;
    const {panel, series, order} = stops[Math.min(row, stops.length - 1)];
    const column = Math.max(0, Math.min(order.length - 1, here.column + along));
    this.at = {row, column};
    const i = order[column];
    this.tell(panel, series, series.x[i], series.y[i], i, order.length - 1, column);
  }

  point(e) {
    const to = this.svg.getScreenCTM();
    const screen = ([x, y]) => [to.a * x + to.e, to.d * y + to.f];
    const at = [(e.clientX - to.e) / to.a, (e.clientY - to.f) / to.d];
    let best = null;
    for (const panel of this.panels) for (const series of panel.series) {
      if (this.off.has(series.key) || (panel.bars && !inside(panel.frame, at))) continue;
      const near = series.curve ? this.onCurve(panel, series, ...at) : null;
      const candidates = series.curve ? (near ? [near] : []) : series.x.map((x, i) => [x, series.y[i], i]);
      for (const [x, y, i] of candidates) {
        if ((i !== undefined && !this.shown(series, i)) || !this.within(panel, x, y)) continue;
        const [px, py] = screen(this.place(panel, x, y));
        const far = distance(panel.bars, px - e.clientX, py - e.clientY);
        const score = far + (series.curve ? NEAR_POINT : 0);
        if (far < (series.curve ? NEAR_CURVE : NEAR_POINT) && (!best || score < best.score)) best = {score, panel, series, x, y, i};
      }
    }
    if (best) this.tell(best.panel, best.series, best.x, best.y, best.i);
    else this.hide();
  }

  // Where a curve passes the pointer; the nearest place where it does so more than once.
  onCurve(panel, series, across, down) {
    const [left, top, wide, tall] = panel.frame;
    const x = panel.across[0] + (across - left) / wide * (panel.across[1] - panel.across[0]);
    const y = panel.up[1] - (down - top) / tall * (panel.up[1] - panel.up[0]);
    let best = null;
    for (let i = 1; i < series.x.length; i++) {
      const a = series.x[i - 1], b = series.x[i];
      if (a === b || (x - a) * (x - b) > 0) continue;
      const passed = series.y[i - 1] + (series.y[i] - series.y[i - 1]) * (x - a) / (b - a);
      if (!best || Math.abs(passed - y) < Math.abs(best[1] - y)) best = [x, passed];
    }
    return best;
  }

  tell(panel, series, x, y, i, most, now) {
    const note = series.notes && series.notes[i], stands = series.groups ? Number(series.groups[i]) : x;
    const lines = [series.name, valued(panel.names[0], stands, panel.units[0])];
    if (panel.bars !== "across") lines.push(valued(panel.names[1], y, panel.units[1]));
    if (note) lines[panel.bars === "across" ? "unshift" : "push"](note);
    this.said.replaceChildren(...lines.map((line, i) => {
      const out = document.createElement(i ? "span" : "strong");
      out.textContent = line;
      return out;
    }));
    const [cx, cy] = this.place(panel, x, y);
    this.ring.setAttribute("cx", cx);
    this.ring.setAttribute("cy", cy);
    this.ring.style.display = this.said.style.display = "";
    const to = this.svg.getScreenCTM(), frame = this.plot.getBoundingClientRect();
    const px = to.a * cx + to.e - frame.left, py = to.d * cy + to.f - frame.top;
    const {offsetWidth: wide, offsetHeight: tall} = this.said;
    this.said.style.left = `${Math.max(4, Math.min(frame.width - wide - 4, px + 12))}px`;
    this.said.style.top = `${py - tall - 12 > 0 ? py - tall - 12 : py + 14}px`;
    this.probed.setAttribute("aria-valuetext", lines.join(", "));
    if (most !== undefined) {
      this.probed.setAttribute("aria-valuemax", most);
      this.probed.setAttribute("aria-valuenow", now);
    }
  }

  hide() {
    this.at = null;
    this.ring.style.display = this.said.style.display = "none";
    this.probed.setAttribute("aria-valuemax", "0");
    this.probed.setAttribute("aria-valuenow", "0");
    this.probed.setAttribute("aria-valuetext", "no point chosen");
  }
}

for (const data of document.querySelectorAll("script.numbers")) {
  new Plot(data.closest("figure"), JSON.parse(data.textContent));
}
