// Views in space: mouse, fingers, keys or buttons turn them, bring them closer and move them.
const TURN = Math.PI / 24, ZOOM = 1.2, SHIFT = 24, PICK = 14;

class Space extends Picture {
  constructor(figure, data, board) {
    super(figure, data, board);
    figure.view = this;
    const [azimuth, elevation] = data.body ? [-1.2, 0.3] : [-0.6, 0.45], level = Math.cos(elevation);
    this.camera.position.set(level * Math.cos(azimuth), level * Math.sin(azimuth), Math.sin(elevation)).multiplyScalar(FAR / 2);
    this.legend();
    this.controls();
    this.listen();
    figure.hidden = false;
    // A view is made when a reader comes near it, so that a page with many opens at once.
    new IntersectionObserver(([seen], watch) => { if (seen.isIntersecting) { watch.disconnect(); this.near = true; this.draw(); } }, {rootMargin: "100%"}).observe(this.canvas);
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
    const moves = [["◀", "Turn left", {left: TURN}], ["▶", "Turn right", {left: -TURN}], ["▲", "Turn up", {up: TURN}], ["▼", "Turn down", {up: -TURN}],
      ["+", "Closer", {closer: ZOOM}], ["−", "Farther", {closer: 1 / ZOOM}]];
    const button = (sign, name, act) => {
      const out = made("button", "switch", row);
      out.type = "button";
      out.textContent = sign;
      if (name) { out.setAttribute("aria-label", name); out.title = name; }
      out.addEventListener("click", act);
    };
    for (const [sign, name, move] of moves) button(sign, name, () => this.move(move));
    button("Reset", "", () => this.reset());
  }

  listen() {
    const keys = {ArrowLeft: [1, 0], ArrowRight: [-1, 0], ArrowUp: [0, 1], ArrowDown: [0, -1]}, {canvas} = this;
    const orbit = this.orbit = new THREE.OrbitControls(this.camera, canvas);
    Object.assign(orbit, {minZoom: 0.5, maxZoom: 40, zoomSpeed: 1.4});
    orbit.update();
    orbit.saveState();
    canvas.style.touchAction = "pan-y"; // one finger up or down still reads on
    orbit.addEventListener("change", () => { this.say(null); this.draw(); });
    canvas.addEventListener("keydown", e => {
      if (e.ctrlKey || e.metaKey || e.altKey) return;
      const [left, up] = keys[e.key] ?? [];
      if (keys[e.key]) this.move(e.shiftKey ? {pan: [left * SHIFT, up * SHIFT]} : {left: left * TURN, up: up * TURN});
      else if (e.key === "+" || e.key === "=") this.move({closer: ZOOM});
      else if (e.key === "-") this.move({closer: 1 / ZOOM});
      else if (e.key === "Home" || e.key === "0") this.reset();
      else return;
      e.preventDefault();
    });
    canvas.addEventListener("pointermove", e => { if (!e.buttons) this.pick(e); });
    canvas.addEventListener("pointerleave", () => this.say(null));
    // The wheel reads on until the view was chosen.
    this.plot.addEventListener("wheel", e => { if (document.activeElement !== canvas) e.stopPropagation(); }, {capture: true});
    this.said = made("div", "said", this.plot);
    this.said.style.display = "none";
    new ResizeObserver(() => this.draw()).observe(canvas);
    matchMedia("(prefers-color-scheme: dark)").addEventListener("change", () => this.draw());
  }

  reset() { this.near = true; this.orbit.reset(); }

  // The controls tell when the view has changed, and then it is drawn.
  move({left = 0, up = 0, closer = 1, pan = null}) {
    const {orbit} = this;
    this.near = true;
    if (left) orbit.rotateLeft(left);
    if (up) orbit.rotateUp(up);
    if (closer !== 1) orbit.dollyIn(1 / closer);
    if (pan) orbit.pan(...pan);
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

const spaces = [...document.querySelectorAll("script.space")], board = spaces.length ? drawingBoard() : null;
if (board) for (const data of spaces) new Space(data.closest("figure"), JSON.parse(data.textContent), board);
