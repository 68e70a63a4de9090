// Views in space: drag, arrow keys or buttons turn them.
const TURN = Math.PI / 24, ZOOM = 1.2, PICK = 14;

class Space extends Picture {
  constructor(figure, data) {
    super(figure, data);
    this.home = data.body ? [-1.2, 0.3, 1] : [-0.6, 0.45, 1];
    this.legend();
    this.controls();
    this.listen();
    figure.hidden = false;
    this.reset();
  }

  legend() {
    const names = new Map(this.data.layers.filter(l => l.name).map(l => [l.name, l]));
    const row = made("div", "switches", this.figure);
    row.setAttribute("role", "group");
    row.setAttribute("aria-label", "Shown in the view");
    this.plot.before(row);
    switches(row, [...names].map(([name, layer]) => [name, place => {
      const sample = made("i", `sample ${layer.kind}`, place);
      sample.style.setProperty("--own", `var(--fig-${layer.colour})`);
      place.append(name);
    }]), (name, on) => { this.off[on ? "delete" : "add"](name); this.draw(); });
  }

  controls() {
    const row = made("div", "switches controls", this.figure);
    row.setAttribute("role", "group");
    row.setAttribute("aria-label", "Turn the view");
    this.plot.after(row);
    const moves = [["◀", "Turn left", [-TURN, 0, 1]], ["▶", "Turn right", [TURN, 0, 1]], ["▲", "Turn up", [0, TURN, 1]],
      ["▼", "Turn down", [0, -TURN, 1]], ["+", "Closer", [0, 0, ZOOM]], ["−", "Farther", [0, 0, 1 / ZOOM]]];
    const button = (sign, name, act) => {
      const out = made("button", "switch", row);
      out.type = "button";
      out.textContent = sign;
      if (name) { out.setAttribute("aria-label", name); out.title = name; }
      out.addEventListener("click", act);
    };
    for (const [sign, name, move] of moves) button(sign, name, () => this.move(...move));
    button("Reset", "", () => this.reset());
  }

  listen() {
    const keys = {ArrowLeft: [-TURN, 0, 1], ArrowRight: [TURN, 0, 1], ArrowUp: [0, TURN, 1], ArrowDown: [0, -TURN, 1],
      "+": [0, 0, ZOOM], "=": [0, 0, ZOOM], "-": [0, 0, 1 / ZOOM]};
    const {canvas} = this;
    canvas.addEventListener("keydown", e => {
      if (e.ctrlKey || e.metaKey || e.altKey) return;
      if (keys[e.key]) this.move(...keys[e.key]);
      else if (e.key === "Home" || e.key === "0") this.reset();
      else return;
      e.preventDefault();
    });
    let from = null;
    canvas.addEventListener("pointerdown", e => { from = [e.clientX, e.clientY]; canvas.setPointerCapture(e.pointerId); });
    canvas.addEventListener("pointermove", e => {
      if (!from) return this.pick(e);
      this.move((from[0] - e.clientX) / 130, (e.clientY - from[1]) / 130, 1);
      from = [e.clientX, e.clientY];
    });
    for (const end of ["pointerup", "pointercancel"]) canvas.addEventListener(end, () => { from = null; });
    canvas.addEventListener("pointerleave", () => this.say(null));
    canvas.addEventListener("wheel", e => {
      if (document.activeElement !== canvas) return;
      this.move(0, 0, e.deltaY < 0 ? 1.08 : 1 / 1.08);
      e.preventDefault();
    }, {passive: false});
    this.said = made("div", "said", this.plot);
    this.said.style.display = "none";
    new ResizeObserver(() => this.draw()).observe(canvas);
    matchMedia("(prefers-color-scheme: dark)").addEventListener("change", () => this.draw());
  }

  reset() { [this.azimuth, this.elevation, this.zoom] = this.home; this.draw(); }

  move(azimuth, elevation, zoom) {
    this.azimuth += azimuth;
    this.elevation = Math.max(-1.55, Math.min(1.55, this.elevation + elevation));
    this.zoom = Math.max(0.5, Math.min(8, this.zoom * zoom));
    this.say(null);
    this.draw();
  }

  pick(e) {
    const frame = this.canvas.getBoundingClientRect(), x = e.clientX - frame.left, y = e.clientY - frame.top;
    let best = null;
    for (const point of this.seen || []) {
      const far = Math.hypot(point.at[0] - x, point.at[1] - y);
      if (far < PICK && (!best || far < best.far)) best = {far, point};
    }
    this.say(best && best.point);
  }

  say(point) {
    if (!this.said) return;
    this.said.style.display = point && point.note ? "" : "none";
    if (!point || !point.note) return;
    const strong = document.createElement("strong"), span = document.createElement("span");
    strong.textContent = point.layer.name;
    span.textContent = point.note;
    this.said.replaceChildren(strong, span);
    const left = Math.min(this.wide - this.said.offsetWidth - 4, point.at[0] + 12);
    this.said.style.left = `${Math.max(4, left)}px`;
    this.said.style.top = `${Math.max(2, point.at[1] - this.said.offsetHeight - 10)}px`;
  }
}

for (const data of document.querySelectorAll("script.space")) new Space(data.closest("figure"), JSON.parse(data.textContent));
