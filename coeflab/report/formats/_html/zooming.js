// A closer look at a drawing: wheel, drag and the keys + - 0. Lines keep their width, points their size, ticks are made anew.
const CLOSER = 1.25, DEEPEST = 200, SNUG = 0.6, LARGEST = 24;
// Markers are small about their point; a larger shape is an area that was drawn where it stands.
const spread = path => Math.max(...(path.getAttribute("d")?.match(/-?\d+(?:\.\d+)?/g) ?? [0]).map(v => Math.abs(v)));

class Zoom {
  constructor(plot) {
    this.plot = plot;
    this.texts = [...plot.svg.querySelectorAll("text:not([data-label])")].filter(t => !/rotate\(-?90/.test(t.getAttribute("transform") ?? ""));
    this.views = plot.panels.filter(p => !p.bars).map(p => this.view(p)).filter(v => v.marks[1] && v.parts.length);
    for (const v of this.views) v.marks[0] ??= this.views.find(o => o.marks[0] && this.abreast(o, v))?.marks[0];
    this.views = this.views.filter(v => v.marks[0]);
    if (this.views.length) this.listen();
  }

  // What moves with a panel, and the ticks of its axes.
  view(panel) {
    const {svg} = this.plot, [left, top, wide, tall] = panel.frame, parts = [];
    const rooms = new Set([...svg.querySelectorAll("clipPath")].filter(c => {
      const r = c.querySelector("rect"), at = r && ["x", "y", "width", "height"].map(n => Number(r.getAttribute(n)));
      return at && at.every((v, i) => Math.abs(v - panel.frame[i]) < SNUG);
    }).map(c => c.id));
    for (const e of svg.querySelectorAll("[clip-path]")) {
      if (!rooms.has(/#([^")]+)/.exec(e.getAttribute("clip-path"))?.[1])) continue;
      for (const m of [e, ...e.querySelectorAll("*")]) {
        const shape = m.localName === "use" && svg.querySelector(`#${CSS.escape(m.getAttribute("href").slice(1))}`);
        if (shape && spread(shape) > LARGEST) {
          if (!parts.some(p => p.e === shape)) parts.push({e: shape, d: shape.getAttribute("d"), by: [m.x.baseVal.value, m.y.baseVal.value]});
        } else if (shape) parts.push({e: m, x: m.x.baseVal.value, y: m.y.baseVal.value});
        else if (m.localName === "path" && !m.closest("defs")) parts.push({e: m, d: m.getAttribute("d")});
      }
    }
    const out = {panel, parts, whole: [panel.across, panel.up], now: [panel.across, panel.up]};
    const at = t => [Number(t.getAttribute("x")), Number(t.getAttribute("y"))];
    const below = this.texts.filter(t => { const [x, y] = at(t); return y > top + tall && y < top + tall + 22 && x > left - 2 && x < left + wide + 2; });
    const beside = this.texts.filter(t => { const [x, y] = at(t); return x < left && x > left - 16 && y > top - 4 && y < top + tall + 8; });
    const factorOf = (texts, [low, high], place) => [0, 3, -3, 6, -6, 9, -9].map(k => 10 ** k).find(f => texts.length > 1 && texts.every(t => {
      const v = Number(t.textContent.replace("−", "-")) / f, [x, y] = at(t);
      return Number.isFinite(v) && Math.abs(place((v - low) / (high - low)) - (texts === below ? x : y - 2.9)) < SNUG;
    }));
    const marks = [[below, factorOf(below, panel.across, s => left + wide * s)], [beside, factorOf(beside, panel.up, s => top + tall * (1 - s))]];
    out.marks = marks.map(([texts, factor]) => factor && {texts, factor, most: texts.length + 1});
    const ends = d => [...d.matchAll(/M\s*([-\d.]+)\s+([-\d.]+)\s*L\s*([-\d.]+)\s+([-\d.]+)/g)].map(m => m.slice(1).map(Number));
    const near = (a, b) => Math.abs(a - b) < SNUG;
    out.rules = [0, 1].map(k => out.parts.find(({d}) => d && !/[CQz]/.test(d) && ends(d).length > 1 && ends(d).every(([a, b, c, e]) =>
      k ? near(b, e) && near(a, left) && near(c, left + wide) : near(a, c) && Math.abs(Math.abs(b - e) - tall) < SNUG)));
    out.parts = out.parts.filter(p => !out.rules.includes(p));
    out.ticks = [...svg.querySelectorAll("path:not([clip-path])")].map(e => ({e, d: e.getAttribute("d")})).find(({d}) => ends(d).length > 2 &&
      ends(d).every(([a, b, c, e]) => near(a, c) && near(b, top + tall) && near(Math.abs(e - b), 3) || near(b, e) && near(a, left) && near(a - c, 3)));
    return out;
  }

  abreast(a, b) { return a.panel.frame[0] === b.panel.frame[0] && a.panel.frame[2] === b.panel.frame[2] && a.whole[0].join() === b.whole[0].join(); }

  listen() {
    const {probed: probe, svg} = this.plot;
    probe.setAttribute("aria-label", `${probe.getAttribute("aria-label")} Plus and minus: closer and farther; 0: whole.`);
    const seen = e => { const to = svg.getScreenCTM(); return [(e.clientX - to.e) / to.a, (e.clientY - to.f) / to.d]; };
    probe.addEventListener("wheel", e => {
      if (document.activeElement !== probe) return;
      e.preventDefault();
      this.scale(e.deltaY < 0 ? 1 / CLOSER : CLOSER, seen(e));
    }, {passive: false});
    let from = null;
    probe.addEventListener("pointerdown", e => { if (this.closer()) { from = seen(e); probe.setPointerCapture(e.pointerId); } });
    probe.addEventListener("pointermove", e => {
      if (!from || !e.buttons) return;
      const to = seen(e);
      this.shift(from, to);
      from = to;
    });
    for (const end of ["pointerup", "pointercancel"]) probe.addEventListener(end, () => { from = null; });
    probe.addEventListener("keydown", e => {
      if (e.ctrlKey || e.metaKey || e.altKey) return;
      if (e.key === "+" || e.key === "=") this.scale(1 / CLOSER);
      else if (e.key === "-") this.scale(CLOSER);
      else if (e.key === "0") this.reset();
      else return;
      e.preventDefault();
    });
  }

  closer() { return this.views.some(v => v.now !== v.whole && v.now.join() !== v.whole.join()); }

  // The panel under a place, and which of its axes the place speaks of.
  under([x, y]) {
    const inX = v => x >= v.panel.frame[0] && x <= v.panel.frame[0] + v.panel.frame[2];
    const inY = v => y >= v.panel.frame[1] && y <= v.panel.frame[1] + v.panel.frame[3];
    const view = this.views.find(inY) ?? this.views.at(-1);
    return [view, inX(view) || !inY(view), inY(view) || !inX(view)];
  }

  scale(by, place) {
    const first = this.views[0].panel.frame, [x, y] = place ?? [first[0] + first[2] / 2, first[1] + first[3] / 2];
    const [view, across, up] = this.under([x, y]), [left, top, wide, tall] = view.panel.frame;
    const shares = [Math.min(1, Math.max(0, (x - left) / wide)), Math.min(1, Math.max(0, 1 - (y - top) / tall))];
    this.move(view, [across, up].map((yes, k) => {
      const [low, high] = view.now[k];
      if (!yes) return view.now[k];
      const middle = low + shares[k] * (high - low);
      return [middle + (low - middle) * by, middle + (high - middle) * by];
    }));
  }

  shift(from, to) {
    const [view] = this.under(from), [, , wide, tall] = view.panel.frame;
    const by = [(from[0] - to[0]) / wide, (to[1] - from[1]) / tall];
    this.move(view, view.now.map(([low, high], k) => [low + by[k] * (high - low), high + by[k] * (high - low)]), true);
  }

  reset() { for (const v of this.views) this.draw(v, v.whole); this.after(); }

  // A range stays inside the whole one; panels that stand on one another keep one axis.
  move(view, wanted, sliding = false) {
    const kept = wanted.map(([low, high], k) => {
      const [first, last] = view.whole[k], whole = last - first, long = Math.max(Math.min((high - low) / whole, 1), 1 / DEEPEST) * whole;
      if (!sliding && (high - low) / whole < 1 / DEEPEST) return view.now[k];
      const at = Math.min(Math.max((low - first) / whole, 0), 1 - long / whole) * whole + first;
      return [at, at + long];
    });
    for (const v of this.views) this.draw(v, v === view ? kept : this.abreast(v, view) ? [kept[0], v.now[1]] : v.now);
    this.after();
  }

  after() {
    this.plot.hide();
    if (!this.button) {
      this.button = made("button", "switch back", this.plot.plot);
      this.button.type = "button";
      this.button.textContent = "Whole";
      this.button.addEventListener("click", () => { this.reset(); this.plot.probed.focus(); });
    }
    this.button.hidden = !this.closer();
  }

  draw(view, now) {
    const {panel} = view, [left, top, wide, tall] = panel.frame, [across, up] = view.whole;
    view.now = now;
    [panel.across, panel.up] = now;
    const moved = (k, p) => {
      const [low, high] = view.whole[k], value = low + (k ? 1 - (p - top) / tall : (p - left) / wide) * (high - low);
      const share = (value - now[k][0]) / (now[k][1] - now[k][0]);
      return Math.round(100 * (k ? top + tall * (1 - share) : left + wide * share)) / 100;
    };
    for (const part of view.parts) {
      if (part.d === undefined) { part.e.setAttribute("x", moved(0, part.x)); part.e.setAttribute("y", moved(1, part.y)); continue; }
      const by = part.by ?? [0, 0];
      let k = 1;
      part.e.setAttribute("d", part.d.replace(/-?\d+(?:\.\d+)?/g, v => { k = 1 - k; return fixedTo(moved(k, Number(v) + by[k]) - by[k]); }));
    }
    const whole = now.join() === view.whole.join(), strokes = ["", ""], short = [];
    view.marks.forEach(({texts, factor, most}, k) => {
      const own = !k ? this.views.every(v => v === view || !this.abreast(v, view) || v.panel.frame[1] < top) : true;
      const places = whole ? [] : round(now[k].map(v => v * factor), most), show = v => {
        const share = (v / factor - now[k][0]) / (now[k][1] - now[k][0]);
        return k ? top + tall * (1 - share) : left + wide * share;
      };
      for (const [v] of places) {
        const p = fixedTo(show(v));
        strokes[k] += k ? `M${left} ${p}L${left + wide} ${p}` : `M${p} ${top}L${p} ${top + tall}`;
        short.push(k ? `M${left} ${p}L${left - 3} ${p}` : `M${p} ${top + tall}L${p} ${top + tall + 3}`);
      }
      if (!own) return;
      for (const old of texts) old.style.display = whole ? "" : "none";
      for (const old of view[`made${k}`] ?? []) old.remove();
      view[`made${k}`] = places.map(([v, said]) => {
        const out = texts[0].cloneNode();
        out.style.display = "";
        out.removeAttribute("transform");
        out.textContent = said;
        out.setAttribute(k ? "y" : "x", fixedTo(show(v) + (k ? 2.9 : 0)));
        texts[0].after(out);
        return out;
      });
    });
    view.rules.forEach((rule, k) => rule?.e.setAttribute("d", whole ? rule.d : strokes[k] || "M0 0"));
    if (view.ticks) view.ticks.e.setAttribute("d", whole ? view.ticks.d : short.join("") || "M0 0");
  }
}

const fixedTo = v => Math.round(100 * v) / 100;
// Round values between two ends with their texts, as many decimals as tell them apart.
function round([a, b], most) {
  const low = Math.min(a, b), high = Math.max(a, b), raw = (high - low) / Math.max(most, 2), power = 10 ** Math.floor(Math.log10(raw));
  const step = [1, 2, 2.5, 5, 10].map(s => s * power).find(s => s >= raw * 0.999), out = [];
  const decimals = Math.max(0, -Math.floor(Math.log10(step) + 1e-9) + (Math.abs(step / power - 2.5) < 1e-9 ? 1 : 0));
  for (let i = Math.ceil(low / step - 1e-9); i * step <= high + 1e-9 * step; i++) out.push([i * step, (i * step + 0).toFixed(decimals).replace(/^-(?=0\.?0*$)/, "").replace("-", "−")]);
  return out;
}
