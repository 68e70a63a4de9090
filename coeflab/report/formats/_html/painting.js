// Bodies and surfaces in space, painted back to front on a plain canvas.
const LIGHT = [0.35, 0.45, 0.82], STEPS = 65535;

const unpacked = (text, Kind) => {
  const bytes = Uint8Array.from(atob(text), c => c.charCodeAt(0));
  return new Kind(bytes.buffer);
};
const dot = (a, b) => a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
const unit = a => { const n = Math.hypot(...a) || 1; return a.map(v => v / n); };
const cross = (a, b) => [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]];
const minus = (a, b) => [a[0] - b[0], a[1] - b[1], a[2] - b[2]];
const lit = normal => 0.62 + 0.38 * Math.abs(dot(normal, unit(LIGHT)));

class Picture {
  constructor(figure, data) {
    this.figure = figure;
    this.data = data;
    figure.classList.toggle("body", data.body);
    this.plot = figure.querySelector(".plot");
    this.canvas = figure.querySelector("canvas");
    this.off = new Set();
    const span = data.axes.map(a => a.ends[1] - a.ends[0]);
    const largest = Math.max(...span);
    this.half = data.body ? span.map(s => s / largest) : [1, 1, 0.72];
    this.flip = data.body ? [1, -1, -1] : [1, 1, 1];
    this.layers = data.layers.map(layer => this.layer(layer));
  }

  // Places from -half to half about the middle, forward or right, left or back, up.
  centred(share) { return share.map((s, k) => this.flip[k] * this.half[k] * (2 * s - 1)); }

  layer(layer) {
    const places = unpacked(layer.places, Uint16Array);
    const index = unpacked(layer.index, layer.wide === "2" ? Uint16Array : Uint32Array);
    const at = [];
    for (let i = 0; i < places.length; i += 3) at.push(this.centred([0, 1, 2].map(k => places[i + k] / STEPS)));
    const many = {triangles: 3, lines: 2, points: 1}[layer.kind], items = [];
    for (let i = 0; i < index.length; i += many) {
      const corners = Array.from(index.subarray(i, i + many), j => at[j]);
      const middle = [0, 1, 2].map(k => corners.reduce((sum, c) => sum + c[k], 0) / many);
      const normal = many === 3 ? unit(cross(minus(corners[1], corners[0]), minus(corners[2], corners[0]))) : null;
      items.push({layer, corners, middle, normal, note: layer.notes[i / many]});
    }
    return {...layer, items};
  }

  aim() {
    const [ca, sa, ce, se] = [Math.cos(this.azimuth), Math.sin(this.azimuth), Math.cos(this.elevation), Math.sin(this.elevation)];
    this.right = [-sa, ca, 0];
    this.toward = [ca * ce, sa * ce, se];
    this.up = [-ca * se, -sa * se, ce];
  }

  // Across and down on the canvas, in CSS pixels.
  flat(p) { return [this.wide / 2 + this.scale * dot(p, this.right), this.middle - this.scale * dot(p, this.up)]; }

  colours() {
    const style = getComputedStyle(document.documentElement), out = {};
    const brush = this.canvas.getContext("2d");
    for (const name of ["ink", "muted", "rule", "band", "a", "b", "c", "d"]) out[name] = style.getPropertyValue(`--fig-${name}`).trim();
    out.paper = style.getPropertyValue("--paper").trim();
    this.rgb = Object.fromEntries(Object.entries(out).map(([name, text]) => {
      brush.fillStyle = text;
      return [name, [1, 3, 5].map(i => parseInt(brush.fillStyle.slice(i, i + 2), 16))];
    }));
    this.named = out;
  }

  draw() {
    const {canvas} = this, wide = canvas.clientWidth, tall = canvas.clientHeight, fine = devicePixelRatio || 1;
    if (!wide) return;
    [this.wide, this.tall, this.fine] = [wide, tall, fine];
    [canvas.width, canvas.height] = [Math.round(wide * fine), Math.round(tall * fine)];
    const radius = Math.hypot(...this.half);
    this.middle = tall / 2 - (this.data.body ? 0 : 6);
    this.aim();
    const reach = axis => this.half.reduce((sum, h, k) => sum + h * Math.abs(axis[k]), 0);
    this.scale = this.zoom * (this.data.body
      ? Math.min(0.44 * wide / Math.max(...this.half), 0.44 * tall / reach(this.up))
      : 0.5 * Math.min(wide, tall) / radius);
    this.colours();
    const brush = canvas.getContext("2d");
    brush.setTransform(fine, 0, 0, fine, 0, 0);
    brush.clearRect(0, 0, wide, tall);
    if (!this.data.body) this.box(brush);
    const shown = this.layers.filter(l => !this.off.has(l.name));
    this.paint(brush, shown.filter(l => l.opacity === 1 && !(this.data.body && l.kind === "points")));
    for (const layer of shown.filter(l => l.opacity < 1)) this.veil(brush, layer);
    if (this.data.body) { this.paint(brush, shown.filter(l => l.kind === "points")); this.triad(brush); }
    this.labels(brush, shown);
    this.seen = shown.filter(l => l.kind === "points").flatMap(l => l.items.map(i => ({at: this.flat(i.middle), layer: l, note: i.note})));
  }

  // A translucent skin: its near side, opaque, on a sheet of its own, then laid over the rest.
  veil(brush, layer) {
    const sheet = document.createElement("canvas");
    [sheet.width, sheet.height] = [this.canvas.width, this.canvas.height];
    const own = sheet.getContext("2d");
    own.setTransform(this.fine, 0, 0, this.fine, 0, 0);
    this.paint(own, [{...layer, items: layer.items.filter(i => dot(i.normal, this.toward) > 0)}]);
    brush.save();
    brush.setTransform(1, 0, 0, 1, 0, 0);
    brush.globalAlpha = layer.opacity;
    brush.drawImage(sheet, 0, 0);
    brush.restore();
  }

  paint(brush, layers) {
    const items = layers.flatMap(l => l.items);
    const lift = {triangles: 0, lines: 0.012, points: 0.03};
    const depth = new Map(items.map(i => [i, dot(i.middle, this.toward) + lift[i.layer.kind]]));
    items.sort((a, b) => depth.get(a) - depth.get(b));
    for (const item of items) this[item.layer.kind](brush, item);
  }

  triangles(brush, {layer, corners, middle, normal}) {
    const own = this.rgb[layer.colour], paper = this.rgb.paper;
    const share = this.data.body ? 1 : 0.25 + 0.6 * (middle[2] / this.half[2] + 1) / 2;
    const bright = lit(normal);
    const mixed = own.map((v, k) => Math.round((share * v + (1 - share) * paper[k]) * bright));
    brush.fillStyle = brush.strokeStyle = `rgb(${mixed.join(" ")})`;
    brush.lineWidth = 0.6;
    brush.lineJoin = "round";
    brush.beginPath();
    corners.forEach((c, i) => brush[i ? "lineTo" : "moveTo"](...this.flat(c)));
    brush.closePath();
    brush.fill();
    brush.stroke();
  }

  lines(brush, {layer, corners}) { this.stroke(brush, corners, this.named[layer.colour], 0.8); }

  stroke(brush, corners, colour, width) {
    brush.strokeStyle = colour;
    brush.lineWidth = width;
    brush.beginPath();
    corners.forEach((c, i) => brush[i ? "lineTo" : "moveTo"](...this.flat(c)));
    brush.stroke();
  }

  points(brush, {layer, middle}) {
    const [x, y] = this.flat(middle);
    brush.beginPath();
    brush.arc(x, y, layer.label ? 5 : 2.6, 0, 2 * Math.PI);
    brush.fillStyle = this.named[layer.colour];
    brush.fill();
    brush.strokeStyle = this.named.paper;
    brush.lineWidth = 1;
    brush.stroke();
  }

  text(brush, words, x, y, align, colour = "ink") {
    brush.font = "12px " + getComputedStyle(this.plot).fontFamily;
    brush.textAlign = align;
    brush.textBaseline = "middle";
    const wide = brush.measureText(words).width, left = align === "center" ? x - wide / 2 : align === "right" ? x - wide : x;
    const kept = Math.max(3, Math.min(this.wide - wide - 3, left));
    brush.textAlign = "left";
    brush.lineWidth = 3;
    brush.lineJoin = "round";
    brush.strokeStyle = this.named.paper;
    brush.strokeText(words, kept, y);
    brush.fillStyle = this.named[colour];
    brush.fillText(words, kept, y);
  }

  labels(brush, shown) {
    const placed = [];
    for (const layer of shown) if (layer.label) {
      const [x, y] = this.flat(layer.items[0].middle);
      let at = y - 14;
      while (placed.some(([px, py]) => Math.abs(px - x) < 150 && Math.abs(py - at) < 14)) at -= 15;
      placed.push([x, at]);
      if (y - at > 20) {
        brush.strokeStyle = this.named.muted;
        brush.lineWidth = 0.7;
        brush.beginPath();
        brush.moveTo(x, y - 5);
        brush.lineTo(x, at + 6);
        brush.stroke();
      }
      this.text(brush, layer.label, x, at, "center");
    }
  }

  // x, y, z of the body in the lower left corner.
  triad(brush) {
    const length = 30, [cx, cy] = [44, this.tall - 44];
    [["x", [1, 0, 0]], ["y", [0, -1, 0]], ["z", [0, 0, -1]]].forEach(([name, along]) => {
      const dx = length * dot(along, this.right), dy = -length * dot(along, this.up);
      brush.strokeStyle = this.named.ink;
      brush.lineWidth = 1.2;
      brush.beginPath();
      brush.moveTo(cx, cy);
      brush.lineTo(cx + dx, cy + dy);
      brush.stroke();
      this.text(brush, name, cx + 1.32 * dx, cy + 1.32 * dy, "center", "muted");
    });
  }

  // The far walls with their lines, and the values along three edges.
  box(brush) {
    const [hx, hy, hz] = this.half;
    const far = [this.toward[0] > 0 ? -hx : hx, this.toward[1] > 0 ? -hy : hy, this.toward[2] > 0 ? -hz : hz];
    const mark = (k, v) => {
      const [low, high] = this.data.axes[k].ends;
      return this.half[k] * (2 * (v - low) / (high - low) - 1);
    };
    const line = (a, b, colour = "rule", width = 0.8) => this.stroke(brush, [a, b], this.named[colour], width);
    const moved = (axis, v, rest) => { const out = [...rest]; out[axis] = v; return out; };
    this.data.axes.forEach((axis, k) => {
      const others = [0, 1, 2].filter(o => o !== k);
      for (const v of axis.marks) {
        const at = mark(k, v);
        for (const o of others) {
          const from = moved(k, at, far), to = moved(o, -far[o], from);
          line(from, to);
        }
      }
    });
    for (const k of [0, 1, 2]) for (const o of [0, 1, 2]) if (o !== k) {
      const from = moved(o, -far[o], far);
      line(moved(k, -this.half[k], from), moved(k, this.half[k], from), "muted");
    }
    const edges = [[0, moved(1, -far[1], far)], [1, moved(0, -far[0], far)], [2, this.outer(far)]];
    for (const [k, base] of edges) this.edge(brush, k, base, mark);
  }

  // The upright edge of the far walls that lies outermost on the left.
  outer(far) {
    const ends = [[-far[0], far[1], 0], [far[0], -far[1], 0]];
    return ends.reduce((a, b) => this.flat(a)[0] <= this.flat(b)[0] ? a : b);
  }

  edge(brush, k, base, mark) {
    const axis = this.data.axes[k], at = v => { const out = [...base]; out[k] = v; return out; };
    const [mx, my] = this.flat(at(0)), [ox, oy] = this.flat([0, 0, k === 2 ? 0 : base[2]]);
    const out = Math.hypot(mx - ox, my - oy) || 1, away = k === 2 ? [-1, 0] : [(mx - ox) / out, (my - oy) / out];
    const align = away[0] > 0.35 ? "left" : away[0] < -0.35 ? "right" : "center";
    axis.marks.forEach((v, i) => {
      const [x, y] = this.flat(at(mark(k, v)));
      this.text(brush, axis.texts[i], x + 9 * away[0], y + 9 * away[1], align, "muted");
    });
    const name = axis.unit ? `${axis.name} [${axis.unit}]` : axis.name;
    if (k === 2) { const [x, y] = this.flat(at(this.half[2])); this.text(brush, name, x, y - 16, "center"); }
    else this.text(brush, name, mx + 62 * away[0], my + 44 * away[1], "center");
  }
}
