// Bodies and surfaces in space by three.js (the page's other script), with letters and axes by a plain canvas over them.
// One drawing board of the graphics card serves all views of a page: a browser gives a page few of them.
const STEPS = 65535, PNG_GRAIN = 3, GRAIN = 1000, CREASE = 35 * Math.PI / 180, FAR = 20;
const DISC = {
  vertexShader: `uniform float size; void main() {
    gl_Position = projectionMatrix * modelViewMatrix * vec4(position, 1.0); gl_Position.z -= 0.004; gl_PointSize = size; }`,
  fragmentShader: `uniform float size, rim; uniform vec3 fill, edge; void main() {
    float far = size * length(gl_PointCoord - 0.5), most = 0.5 * size;
    if (far > most) discard;
    gl_FragColor = vec4(mix(fill, edge, smoothstep(most - rim - 0.7, most - rim + 0.3, far)), 1.0 - smoothstep(most - 1.0, most, far)); }`,
};

const unpacked = (text, Kind) => {
  const bytes = Uint8Array.from(atob(text), c => c.charCodeAt(0));
  return new Kind(bytes.buffer);
};
const dot = (a, b) => a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
const unit = (x, y, z) => { const n = Math.hypot(x, y, z) || 1; return [x / n, y / n, z / n]; };

// Normals at the corners of triangles: the mean of the neighbours that meet gently there, each by its angle.
function normals(at, index) {
  const many = index.length, own = new Float32Array(many), angles = new Float32Array(many), out = new Float32Array(3 * many);
  for (let i = 0; i < many; i += 3) {
    const [p, q, r] = [at[index[i]], at[index[i + 1]], at[index[i + 2]]], sides = [[p, q], [q, r], [r, p]].map(([f, t]) => unit(t[0] - f[0], t[1] - f[1], t[2] - f[2]));
    const [a, b] = sides;
    own.set(unit(a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]), i);
    for (let k = 0; k < 3; k++) angles[i + k] = Math.acos(Math.max(-1, Math.min(1, -dot(sides[k], sides[(k + 2) % 3]))));
  }
  const first = new Uint32Array(at.length + 1), around = new Uint32Array(many), least = Math.cos(CREASE);
  for (const j of index) first[j + 1]++;
  for (let j = 0; j < at.length; j++) first[j + 1] += first[j];
  const next = first.slice();
  index.forEach((j, i) => { around[next[j]++] = i; });
  index.forEach((j, i) => {
    const f = i - i % 3;
    let x = 0, y = 0, z = 0;
    for (let n = first[j]; n < first[j + 1]; n++) {
      const i = around[n], g = i - i % 3, like = own[f] * own[g] + own[f + 1] * own[g + 1] + own[f + 2] * own[g + 2];
      if (like > least) { x += angles[i] * own[g]; y += angles[i] * own[g + 1]; z += angles[i] * own[g + 2]; }
    }
    out.set(unit(x, y, z), 3 * i);
  });
  return out;
}

// The board, made when a page has a view; nothing where the browser has no WebGL.
function drawingBoard() {
  if (!globalThis.THREE) return null;
  const sheet = document.createElement("canvas"), traits = {alpha: true, antialias: true, depth: true, stencil: false};
  const context = sheet.getContext("webgl2", traits);
  if (!context) return null;
  const out = new THREE.WebGLRenderer({canvas: sheet, context, ...traits});
  out.setClearColor(0, 0);
  return out;
}

class Picture {
  constructor(figure, data, board) {
    this.figure = figure;
    this.data = data;
    this.board = board;
    figure.classList.toggle("body", data.body);
    this.plot = figure.querySelector(".plot");
    this.canvas = figure.querySelector("canvas");
    this.off = new Set();
    this.span = data.axes.map(a => a.ends[1] - a.ends[0]);
    this.largest = Math.max(...this.span);
    this.half = data.body ? this.span.map(s => s / this.largest) : [1, 1, 0.72];
    this.flip = data.body ? [1, -1, -1] : [1, 1, 1];
    this.camera = new THREE.OrthographicCamera(-1, 1, 1, -1, 0.1, FAR);
    this.camera.up.set(0, 0, 1);
    this.scene = new THREE.Scene();
    this.lights();
  }

  // The sun comes over the reader's left shoulder and turns with him; the sky is brighter than the ground.
  lights() {
    this.scene.add(new THREE.HemisphereLight(0xffffff, 0x8c949c, this.data.body ? 1.75 : 2.4));
    const sun = new THREE.DirectionalLight(0xffffff, this.data.body ? 1.9 : 0.9);
    sun.position.set(-0.5, 0.75, 1);
    this.camera.add(sun, sun.target);
    this.scene.add(this.camera);
  }

  // Places from -half to half about the middle, forward or right, left or back, up.
  centred(share) { return share.map((s, k) => this.flip[k] * this.half[k] * (2 * s - 1)); }

  layer(layer) {
    const places = unpacked(layer.places, Uint16Array), index = unpacked(layer.index, layer.wide === "2" ? Uint16Array : Uint32Array);
    const at = [];
    for (let i = 0; i < places.length; i += 3) at.push(this.centred([0, 1, 2].map(k => places[i + k] / STEPS)));
    const corners = new Float32Array(index.length * 3);
    index.forEach((j, i) => corners.set(at[j], 3 * i));
    const out = {...layer, index, places: at, at: Array.from(index, j => at[j])};
    out.parts = this[layer.kind](out, corners);
    for (const part of out.parts) { part.frustumCulled = false; this.scene.add(part); }
    return out;
  }

  // Smooth where neighbours meet gently, with an edge where they do not; a film lets what is within shine through its near side.
  triangles(layer, corners) {
    const shape = new THREE.BufferGeometry().setAttribute("position", new THREE.BufferAttribute(corners, 3)), film = layer.opacity < 1;
    shape.setAttribute("normal", new THREE.BufferAttribute(normals(layer.places, layer.index), 3));
    const side = {side: THREE.DoubleSide, polygonOffset: true, polygonOffsetFactor: 1, polygonOffsetUnits: 1};
    const paint = new THREE.MeshPhongMaterial({...side, shininess: 24, transparent: film, opacity: layer.opacity, depthWrite: !film, vertexColors: !this.data.body});
    if (!this.data.body) shape.setAttribute("color", new THREE.BufferAttribute(new Float32Array(corners.length), 3));
    const skin = new THREE.Mesh(shape, paint), out = [skin];
    if (film) {
      const first = new THREE.Mesh(shape, new THREE.MeshBasicMaterial({...side, colorWrite: false}));
      [first.renderOrder, skin.renderOrder] = [2, 3];
      out.push(first);
    }
    if (this.data.body) {
      // Corners are told apart by four decimals there.
      const large = shape.clone().scale(GRAIN, GRAIN, GRAIN), sharp = new THREE.EdgesGeometry(large, CREASE * 180 / Math.PI).scale(1 / GRAIN, 1 / GRAIN, 1 / GRAIN);
      const edges = this.strokes(sharp.getAttribute("position").array, 1);
      if (edges) { edges.renderOrder = film ? 4 : 0; edges.isEdge = true; out.push(edges); }
    }
    return out;
  }

  lines(layer, corners) { return [this.strokes(corners, layer.name === "axis" ? 1.2 : 0.9)].filter(Boolean); }

  strokes(ends, width) {
    if (!ends.length) return null;
    const paint = new THREE.LineMaterial({transparent: true, depthWrite: false});
    paint.wide = width;
    return new THREE.LineSegments2(new THREE.LineSegmentsGeometry().setPositions(ends), paint);
  }

  points(layer, corners) {
    const uniforms = {size: {value: 1}, rim: {value: 1}, fill: {value: null}, edge: {value: null}};
    const paint = new THREE.ShaderMaterial({...DISC, uniforms, transparent: true, depthTest: !this.data.body});
    paint.wide = 2 * (layer.label ? 5.5 : 3.1);
    const out = new THREE.Points(new THREE.BufferGeometry().setAttribute("position", new THREE.BufferAttribute(corners, 3)), paint);
    out.renderOrder = 6;
    return [out];
  }

  // Which way the reader looks, and how many CSS pixels a length has.
  aim() {
    this.camera.updateMatrixWorld();
    const [right, up, toward] = [0, 1, 2].map(k => new THREE.Vector3().setFromMatrixColumn(this.camera.matrixWorld, k).toArray());
    Object.assign(this, {right, up, toward});
    const reach = axis => this.half.reduce((sum, h, k) => sum + h * Math.abs(axis[k]), 0), {wide, tall, camera} = this;
    const whole = this.data.body
      ? Math.min(0.44 * wide / Math.max(...this.half), 0.44 * tall / reach(this.up)) : 0.5 * Math.min(wide, tall) / Math.hypot(...this.half);
    this.middle = tall / 2 - (this.data.body ? 0 : 6);
    this.scale = whole * camera.zoom;
    [camera.left, camera.right, camera.top, camera.bottom] = [-wide / 2, wide / 2, this.middle, this.middle - tall].map(v => v / whole);
    camera.updateProjectionMatrix();
  }

  // Across and down on the canvas, in CSS pixels.
  flat(p) {
    const from = this.orbit.target.toArray(), by = p.map((v, k) => v - from[k]);
    return [this.wide / 2 + this.scale * dot(by, this.right), this.middle - this.scale * dot(by, this.up)];
  }

  colours() {
    const style = getComputedStyle(document.documentElement), brush = document.createElement("canvas").getContext("2d"), named = {}, rgb = {};
    for (const name of ["ink", "muted", "rule", "band", "a", "b", "c", "d", "paper"]) {
      named[name] = style.getPropertyValue(name === "paper" ? "--paper" : `--fig-${name}`).trim();
      brush.fillStyle = named[name];
      rgb[name] = [1, 3, 5].map(i => parseInt(brush.fillStyle.slice(i, i + 2), 16) / 255);
    }
    if (JSON.stringify(named) === JSON.stringify(this.named)) return;
    Object.assign(this, {named, rgb});
    const solid = list => new THREE.Color().setRGB(...list, THREE.SRGBColorSpace), mixed = (a, b, share) => a.map((v, k) => share * v + (1 - share) * b[k]);
    for (const layer of this.layers) for (const {material, geometry, isEdge} of layer.parts) {
      const own = rgb[layer.colour];
      if (material.uniforms?.fill) {
        material.uniforms.fill.value = new THREE.Color(...own);
        material.uniforms.edge.value = new THREE.Color(...rgb.paper);
      } else if (material.vertexColors) {
        const places = geometry.getAttribute("position"), colours = geometry.getAttribute("color");
        for (let i = 0; i < places.count; i++) {
          const high = 0.25 + 0.6 * (places.getZ(i) / this.half[2] + 1) / 2;
          colours.setXYZ(i, ...solid(mixed(own, rgb.paper, high)).toArray());
        }
        colours.needsUpdate = true;
        material.specular.set(0);
      } else {
        material.color.copy(solid(isEdge ? mixed(rgb.ink, own, 0.55) : own));
        material.specular?.setScalar(0.02);
      }
    }
  }

  draw() {
    const {canvas} = this, wide = canvas.clientWidth, tall = canvas.clientHeight;
    if (!wide || !this.near) return;
    Object.assign(this, {wide, tall});
    this.paint(canvas, devicePixelRatio || 1);
    this.seen = this.shown().filter(l => l.kind === "points").flatMap(l => l.at.map((p, i) => ({at: this.flat(p), layer: l, note: l.notes[i]})));
  }

  shown() { return this.layers.filter(l => !this.off.has(l.name)); }

  // The view as it stands, so many dots a CSS pixel.
  paint(canvas, fine) {
    const [across, down] = [this.wide, this.tall].map(v => Math.round(v * fine)), {board, data} = this;
    [canvas.width, canvas.height] = [across, down];
    this.layers ??= data.layers.map(layer => this.layer(layer));
    this.aim();
    this.colours();
    for (const layer of this.layers) for (const part of layer.parts) {
      part.visible = !this.off.has(layer.name);
      const {uniforms, wide} = part.material;
      if (uniforms?.fill) [uniforms.size.value, uniforms.rim.value] = [wide * fine, fine];
      else if (wide) part.material.linewidth = wide * fine;
    }
    board.setSize(across, down, false);
    board.render(this.scene, this.camera);
    const brush = canvas.getContext("2d");
    brush.setTransform(fine, 0, 0, fine, 0, 0);
    const letters = data.body ? null : this.box(brush);
    brush.drawImage(board.domElement, 0, 0, this.wide, this.tall);
    letters?.();
    if (data.body) { this.triad(brush); this.ruler(brush); }
    this.labels(brush, this.shown());
  }

  // What is seen on a sheet of paper's colour, at a finer grain than a screen's.
  async png() {
    this.near = true;
    this.draw();
    const seen = document.createElement("canvas"), out = document.createElement("canvas");
    this.paint(seen, PNG_GRAIN);
    [out.width, out.height] = [seen.width, seen.height];
    const brush = out.getContext("2d");
    brush.fillStyle = this.named.paper;
    brush.fillRect(0, 0, out.width, out.height);
    brush.drawImage(seen, 0, 0);
    return new Promise(done => out.toBlob(done, "image/png"));
  }

  stroke(brush, corners, colour, width) {
    brush.strokeStyle = colour;
    brush.lineWidth = width;
    brush.beginPath();
    corners.forEach((c, i) => brush[i ? "lineTo" : "moveTo"](...this.flat(c)));
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
      const [x, y] = this.flat(layer.at[0]);
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

  // x, y, z of the body in the lower left corner, as arrows.
  triad(brush) {
    const length = 30, [cx, cy] = [44, this.tall - 44];
    brush.strokeStyle = brush.fillStyle = this.named.ink;
    brush.lineWidth = 1.3;
    [["x", [1, 0, 0]], ["y", [0, -1, 0]], ["z", [0, 0, -1]]].forEach(([name, along]) => {
      const dx = length * dot(along, this.right), dy = -length * dot(along, this.up), long = Math.hypot(dx, dy);
      brush.strokeStyle = brush.fillStyle = this.named.ink;
      brush.lineWidth = 1.3;
      brush.beginPath();
      brush.moveTo(cx, cy);
      brush.lineTo(cx + dx, cy + dy);
      brush.stroke();
      if (long > 8) {
        const [ux, uy] = [dx / long, dy / long], tip = s => [cx + dx - 6 * ux - s * 2.6 * uy, cy + dy - 6 * uy + s * 2.6 * ux];
        brush.beginPath();
        brush.moveTo(cx + dx + ux, cy + dy + uy);
        brush.lineTo(...tip(1));
        brush.lineTo(...tip(-1));
        brush.fill();
      }
      this.text(brush, name, cx + 1.32 * dx, cy + 1.32 * dy, "center", "muted");
    });
  }

  // A round length in metres in the lower right corner: the view has no perspective, so it holds everywhere.
  ruler(brush) {
    const dots = 2 * this.scale / this.largest, raw = 0.22 * this.wide / dots, power = 10 ** Math.floor(Math.log10(raw));
    const metres = [5, 2, 1].map(s => s * power).find(v => v <= raw), long = metres * dots, x = this.wide - 16, y = this.tall - 18;
    brush.strokeStyle = this.named.ink;
    brush.lineWidth = 1.3;
    brush.beginPath();
    brush.moveTo(x - long, y - 4);
    brush.lineTo(x - long, y);
    brush.lineTo(x, y);
    brush.lineTo(x, y - 4);
    brush.stroke();
    this.text(brush, `${Number(metres.toPrecision(3))} m`, x - long / 2, y - 9, "center", "muted");
  }

  // The far walls with their lines; returns what writes the values along three edges, over all else.
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
    return () => {
      for (const [k, base] of [[0, moved(1, -far[1], far)], [1, moved(0, -far[0], far)], [2, this.outer(far)]]) this.edge(brush, k, base, mark);
    };
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
