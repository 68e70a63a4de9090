"use strict";
// The page itself: controls, figures and values. All numbers come from bench.js, in a worker where there can be one.
const mountBench = (root, data, source, prefix = "bench") => {
  const make = (tag, attributes = {}, ...inside) => {
    const out = document.createElement(tag);
    for (const [name, value] of Object.entries(attributes)) {
      if (name.startsWith("on")) out.addEventListener(name.slice(2), value);
      else if (value === true) out.setAttribute(name, "");
      else if (value !== false && value !== null) out.setAttribute(name, value);
    }
    out.append(...inside.flat().filter((x) => x !== null && x !== ""));
    return out;
  };
  const escaped = (text) => String(text).replace(/[&<>"]/g, (c) => ({ "&": "&amp;", "<": "&lt;", ">": "&gt;", '"': "&quot;" })[c]);
  const spelled = (symbol) => [symbol[0], make("sub", {}, symbol.slice(1).replace("_", "")), symbol[1] === "_" ? "" : "′"];
  const plain = (symbol) => (symbol[1] === "_" ? symbol : `${symbol}′`);

  // Numbers: two digits of U95, a value to the same decimal.
  const digits = (size) => Math.min(Math.max(1 - Math.floor(Math.log10(size)), 0), 12);
  const signed = (text) => text.replace("-", "−");
  const value = (x, u95) => {
    if (x === null) return "no value";
    if (!u95) return signed(String(Number(x.toPrecision(4))));
    return `${signed(x.toFixed(digits(u95)))} ± ${u95.toFixed(digits(u95))}`;
  };
  const short = (x, n = 3) => signed(String(Number(x.toPrecision(n))));
  const relative = (x, u95) => { const share = 100 * u95 / Math.abs(x); return share < 100 ? `${Number(share.toPrecision(2))} %` : "> 100 %"; };

  const isAngle = (s) => "vw".includes(s.variable), isControl = (s) => s.variable.startsWith("d");
  const setting = (s, x, n = 3) => {
    if (isAngle(s)) return `${short(Math.asin(Math.min(Math.max(x, -1), 1)) * 180 / Math.PI, n)}°`;
    if (isControl(s)) return `${short(x * 180 / Math.PI, n)}°`;
    return short(x, n);
  };
  const limitName = (s) => (isAngle(s) || isControl(s) ? "Largest angle" : `Largest ${s.variable}′`);

  // What is chosen.
  const edits = {};
  const wanted = data.sweeps.findIndex((s) => s.wanted);
  const state = { index: Math.max(wanted, 0), view: "force", file: 0, zigzag: 0 };
  const editOf = (index) => edits[index] || (edits[index] = { limit: null, dropped: null });
  // A step of the slider is a level of the setting.
  const levels = (s) => [...s.choices.filter((c) => c.limit !== null).map((c) => c.limit), Math.max(...s.x.map(Math.abs))];

  // The worker, or this thread where a page may have none.
  let worker = null, asked = 0, running = false, next = null, here = null;
  const local = () => here || (here = benchOf(data));
  const work = (bench, { id, edits: chosen, index, file, zigzag }, say) => {
    const { campaigns, ...found } = bench.view(chosen, index), f = data.files[file];
    say({ id, ...found });
    const z = f && f.zigzags[zigzag];
    if (!z) return say({ id, last: true });
    const part = (from) => (x) => say({ id, part: from + x / 2 });
    const trim = (m) => (m.lost ? m : {
      time: m.time, north: m.state.map((s) => s[0]), east: m.state.map((s) => s[1]), heading: m.state.map((s) => s[13]),
      rudder: m.controls.map((c) => c[0]), figures: m.figures, determined: m.determined, why: m.why,
    });
    const unknown = [...new Set(z.links.map((l) => l[1]))].filter((i) => {
      const s = data.sweeps[i], found = campaigns[s.campaign].rows[data.campaigns[s.campaign].sweeps.indexOf(i)];
      return "YN".includes(s.component) && found.value !== null && Math.abs(found.value) <= found.u95;
    }).map((i) => data.sweeps[i].symbol);
    say({ id, unknown, motion: trim(bench.motion(z, campaigns, part(0))), still: trim(zigzagOf(z, z.law.coefficient, part(0.5))), last: true });
  };
  try {
    const text = `${source}\nconst data = ${JSON.stringify(data)};\nconst bench = benchOf(data);\nconst work = ${work};\nonmessage = (e) => work(bench, e.data, (m) => postMessage(m));`;
    worker = new Worker(URL.createObjectURL(new Blob([text], { type: "text/javascript" })));
    worker.onmessage = (e) => heard(e.data);
    worker.onerror = (e) => { e.preventDefault(); worker = null; running = false; if (next) ask(); };
  } catch (none) { worker = null; }
  const ask = () => {
    const chosen = JSON.parse(JSON.stringify(edits));
    next = { id: ++asked, edits: chosen, index: state.index, file: state.file, zigzag: state.zigzag };
    root.dataset.state = "computing";
    right.setAttribute("aria-busy", "true");
    bar.value = 0;
    bar.classList.add("running");
    if (running) return;
    running = true;
    const job = next;
    if (worker) worker.postMessage(job);
    else setTimeout(() => work(local(), job, heard), 0);
  };
  const heard = (m) => {
    if (m.id === asked) {
      Object.assign(shown, m);
      if (m.part) bar.value = m.part;
      if (m.row) show();
      if (m.last) { showMotion(); root.dataset.state = "ready"; right.removeAttribute("aria-busy"); bar.classList.remove("running"); }
    }
    if (!m.last) return;
    running = false;
    if (next && next.id > m.id) ask();
  };
  const shown = {};

  // Controls.
  const select = make("select", { id: `${prefix}-coefficient`, onchange: (e) => { state.index = Number(e.target.value); chosen(); } });
  const campaignNames = Object.keys(data.campaigns);
  for (const name of campaignNames) {
    const own = data.campaigns[name].sweeps.filter((i) => data.sweeps[i].value !== null);
    select.append(make("optgroup", { label: name }, own.map((i) => make("option", { value: i }, `${plain(data.sweeps[i].symbol)} of ${name}`))));
  }
  const slider = make("input", { type: "range", id: `${prefix}-limit`, min: 0, step: 1, oninput: () => moved() });
  const limitText = make("output", { for: `${prefix}-limit` }), limitLabel = make("label", { for: `${prefix}-limit`, class: "label" });
  const points = make("div", { class: "points", role: "group", "aria-label": "Points used", tabindex: "0" });
  const shareText = make("span"), pointsLegend = make("legend");
  const share = make("button", { type: "button", onclick: () => { shareEdit(); changed(); } }, shareText);
  const reset = make("button", { type: "button", onclick: () => { delete edits[state.index]; chosen(); } }, "Reset");
  const resetAll = make("button", { type: "button", onclick: () => { for (const k of Object.keys(edits)) delete edits[k]; chosen(); } }, "Reset all");
  const left = make("div", { class: "controls" },
    make("div", { class: "first" },
      make("fieldset", {}, make("label", { for: select.id, class: "label" }, "Coefficient"), select),
      make("fieldset", {}, limitLabel, slider, limitText)),
    make("div", { class: "more" },
      make("fieldset", {}, pointsLegend, points),
      make("div", { class: "row" }, reset, resetAll, share)));

  const current = () => data.sweeps[state.index];
  const moved = () => {
    const all = levels(current()), i = Number(slider.value);
    edits[state.index] = { limit: i === all.length - 1 ? null : all[i], dropped: null };
    changed();
  };
  const toggle = (i) => {
    edits[state.index] = { limit: null, dropped: editOf(state.index).dropped === i ? null : i };
    changed();
  };
  const siblings = () => data.campaigns[current().campaign].sweeps.filter((i) => i !== state.index && data.sweeps[i].table === current().table && data.sweeps[i].variable === current().variable);
  const shareEdit = () => {
    const edit = editOf(state.index), label = edit.dropped === null ? null : current().labels[edit.dropped];
    for (const i of siblings()) {
      const at = label === null ? -1 : data.sweeps[i].labels.indexOf(label), same = { limit: edit.limit, dropped: at < 0 ? null : at };
      if (local().isUntouched(same) || local().choiceOf(i, same)) edits[i] = same;
    }
  };
  const within = (s, edit, i) => edit.limit === null || Math.abs(s.x[i]) <= edit.limit * (1 + data.sameLevel);
  const controls = () => {
    const s = current(), edit = edits[state.index] || { limit: null, dropped: null }, all = levels(s);
    select.value = String(state.index);
    limitLabel.textContent = limitName(s);
    slider.max = String(all.length - 1);
    const at = edit.limit === null ? all.length - 1 : all.findIndex((x) => x === edit.limit);
    slider.value = String(at);
    const used = s.x.filter((_, i) => within(s, edit, i) && edit.dropped !== i).length;
    const said = `${setting(s, all[at])}: ${used} of ${s.x.length} points`;
    limitText.textContent = said;
    slider.setAttribute("aria-valuetext", said);
    pointsLegend.textContent = `Points used: ${used}; leave one out`;
    const order = s.x.map((_, i) => i).sort((a, b) => s.x[a] - s.x[b] || a - b), focus = document.activeElement && document.activeElement.dataset ? document.activeElement.dataset.point : undefined;
    points.replaceChildren(...order.map((i) => {
      const beyond = !within(s, edit, i), id = `${prefix}-point-${i}`;
      return make("div", { class: `choice${beyond ? " beyond" : ""}`, title: s.labels[i] },
        make("input", { type: "checkbox", id, "data-point": i, checked: edit.dropped !== i && !beyond, disabled: beyond, onchange: () => toggle(i) }),
        make("label", { for: id }, setting(s, s.x[i]), make("span", { class: "unseen" }, `, ${s.labels[i]}`)));
    }));
    if (focus !== undefined) { const again = points.querySelector(`[data-point="${focus}"]`); if (again) again.focus(); }
    const others = siblings();
    share.hidden = !others.length;
    shareText.textContent = `Same for ${others.map((i) => plain(data.sweeps[i].symbol)).join(", ")}`;
    reset.disabled = !edits[state.index] || local().isUntouched(edits[state.index]);
    resetAll.disabled = Object.keys(edits).every((k) => local().isUntouched(edits[k]));
  };
  const chosen = () => {
    const uses = data.files.findIndex((f) => f.indices.some((i) => i.sources.includes(state.index)) || f.zigzags.some((z) => z.links.some((l) => l[1] === state.index)));
    if (uses >= 0) { state.file = uses; state.zigzag = 0; }
    changed();
  };
  const changed = () => { controls(); ask(); };

  // Drawings: colours are those of the report; a saved file takes what stands after the commas.
  const colour = { ink: "var(--fig-ink, #1c2126)", muted: "var(--fig-muted, #5d666f)", rule: "var(--fig-rule, #d9dde1)", band: "var(--fig-band, #9aa5b1)", a: "var(--fig-a, #0067a8)", b: "var(--fig-b, #c04f00)", c: "var(--fig-c, #007a58)" };
  const ticks = (low, high, most) => {
    const raw = (high - low) / most, power = 10 ** Math.floor(Math.log10(raw)), step = [1, 2, 5, 10].map((m) => m * power).find((v) => v >= raw), out = [];
    for (let i = Math.ceil(low / step - 1e-9); i * step <= high + 1e-9 * step; i++) out.push([i * step, signed(String(Number((i * step).toPrecision(6))))]);
    return out;
  };
  const frame = (w, h, x, y, names, margin) => {
    const [ml, mt, mr, mb] = margin, px = (v) => ml + (v - x[0]) / (x[1] - x[0]) * (w - ml - mr), py = (v) => h - mb - (v - y[0]) / (y[1] - y[0]) * (h - mt - mb);
    const out = [`<rect x="${ml}" y="${mt}" width="${w - ml - mr}" height="${h - mt - mb}" fill="none" stroke="${colour.rule}"/>`];
    for (const [v, text] of ticks(x[0], x[1], Math.max(w / 90, 3))) out.push(`<path d="M${px(v).toFixed(1)} ${mt}V${h - mb}" stroke="${colour.rule}"/><text x="${px(v).toFixed(1)}" y="${h - mb + 17}" text-anchor="middle" fill="${colour.muted}">${text}</text>`);
    for (const [v, text] of ticks(y[0], y[1], Math.max(h / 55, 3))) out.push(`<path d="M${ml} ${py(v).toFixed(1)}H${w - mr}" stroke="${colour.rule}"/><text x="${ml - 7}" y="${(py(v) + 4).toFixed(1)}" text-anchor="end" fill="${colour.muted}">${text}</text>`);
    out.push(`<text x="${w - mr}" y="${h - 6}" text-anchor="end" fill="${colour.ink}">${escaped(names[0])}</text><text x="${ml}" y="${mt - 9}" fill="${colour.ink}">${escaped(names[1])}</text>`);
    return { out, px, py, path: (a, b) => a.map((v, i) => `${i ? "L" : "M"}${px(v).toFixed(2)} ${py(b[i]).toFixed(2)}`).join("") };
  };
  const whole = (w, h, title, said, inside) => `<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 ${w} ${h}" role="img" aria-label="${escaped(`${title}. ${said}`)}" font-family="Helvetica, Arial, sans-serif" font-size="13"><title>${escaped(title)}</title>${inside.join("")}</svg>`;
  const clip = (w, h, m, inside, id) => `<clipPath id="${id}"><rect x="${m[0]}" y="${m[1]}" width="${w - m[0] - m[2]}" height="${h - m[1] - m[3]}"/></clipPath><g clip-path="url(#${id})">${inside.join("")}</g>`;
  const padded = (values, share) => { const a = Math.min(...values), b = Math.max(...values), d = (b - a || Math.abs(a) || 1) * share; return [a - d, b + d]; };

  const widthOf = (box) => Math.round(Math.min(Math.max(box.clientWidth, 320), 1200));
  const sweepFigure = () => {
    const s = current(), edit = edits[state.index] || { limit: null, dropped: null }, { row, before } = shown, w = widthOf(picture), h = Math.round(Math.max(0.5 * w, 240)), m = [66, 28, 14, 44];
    const ratio = state.view === "ratio", has = row.value !== null, middle = has ? row.curve[(data.nodes - 1) / 2] : before.curve[(data.nodes - 1) / 2];
    const most = Math.max(...s.x.map(Math.abs), ...s.leftOut.map((p) => Math.abs(p[0])));
    const near = 0.04 * most, at = (x, y) => (ratio ? [Math.abs(x), (y - middle) / x] : [x, y]);
    const drawn = s.x.map((x, i) => ({ i, x, y: s.y[i], xy: at(x, s.y[i]) })).filter((p) => !ratio || Math.abs(p.x) > near);
    const others = s.leftOut.filter((p) => p[1] !== null && (!ratio || Math.abs(p[0]) > near)).map((p) => ({ p, xy: at(p[0], p[1]) }));
    const across = ratio ? [0, most * 1.04] : padded([-most, most].filter((v) => !s.oneSided || Math.min(...s.x) * v > 0 || Math.max(...s.x) * v > 0).concat(0), 0.04);
    const levelsOf = drawn.map((p) => p.xy[1]), side = (x) => x >= across[0] && x <= across[1];
    if (!ratio && has) levelsOf.push(...row.curve.filter((_, i) => side(row.at[i])));
    if (ratio && has) levelsOf.push(row.value - row.u95, row.value + row.u95, before.value);
    const up = padded(levelsOf, 0.1), name = `${s.component}′`, f = frame(w, h, across, up, ratio ? [`|${s.variable}′|`, `(${name} − ${name} at rest) / ${s.variable}′`] : [s.across.replaceAll("'", "′"), name], m), inside = [];
    const polygon = (x, low, high) => `<path d="${f.path(x, low)}L${f.path(x.slice().reverse(), high.slice().reverse()).slice(1)}Z" fill="${colour.band}" fill-opacity="0.35"/>`;
    if (has && !ratio) {
      inside.push(polygon(row.at, row.curve.map((v, i) => v - row.half[i]), row.curve.map((v, i) => v + row.half[i])));
      inside.push(`<path d="${f.path(row.at, row.curve)}" fill="none" stroke="${colour.a}" stroke-width="1.8"/>`);
      const end = 0.6 * most, line = (slope) => f.path([-end, end], [middle - end * slope, middle + end * slope]);
      inside.push(`<path d="${line(row.value)}" fill="none" stroke="${colour.b}" stroke-width="1.8"/>`);
      for (const v of [row.value - row.u95, row.value + row.u95]) inside.push(`<path d="${line(v)}" fill="none" stroke="${colour.b}" stroke-dasharray="2 3"/>`);
      inside.push(`<path d="${line(before.value)}" fill="none" stroke="${colour.muted}" stroke-dasharray="7 4"/>`);
    } else if (has) {
      const lower = row.value - row.u95, upper = row.value + row.u95, x0 = f.px(0), x1 = f.px(across[1]);
      inside.push(`<rect x="${x0}" y="${f.py(upper).toFixed(1)}" width="${x1 - x0}" height="${(f.py(lower) - f.py(upper)).toFixed(1)}" fill="${colour.b}" fill-opacity="0.16"/>`);
      inside.push(`<path d="M${x0} ${f.py(row.value).toFixed(1)}H${x1}" stroke="${colour.b}" stroke-width="1.8"/><path d="M${x0} ${f.py(before.value).toFixed(1)}H${x1}" stroke="${colour.muted}" stroke-dasharray="7 4"/>`);
      for (const side of [1, -1]) {
        const x = row.at.filter((v) => v * side > near), y = x.map((v) => (row.curve[row.at.indexOf(v)] - middle) / v);
        if (x.length > 1 && s.x.some((v) => v * side > near)) inside.push(`<path d="${f.path(x.map(Math.abs), y)}" fill="none" stroke="${colour.a}" stroke-width="1.6"${side < 0 ? ' stroke-dasharray="5 3"' : ""}/>`);
      }
    }
    for (const { p, xy } of others) { const x = f.px(xy[0]), y = f.py(xy[1]); inside.push(`<path d="M${(x - 4).toFixed(1)} ${(y - 4).toFixed(1)}l8 8m0-8l-8 8" stroke="${colour.muted}"><title>${escaped(`${p[2]}: ${p[3]}`)}</title></path>`); }
    for (const p of drawn) {
      const gone = edit.dropped === p.i, far = !within(s, edit, p.i), wrong = row.removed.includes(p.i), own = gone || far ? colour.muted : wrong ? colour.b : colour.a;
      const words = `${s.labels[p.i]}: ${s.variable}′ ${short(p.x, 4)}, ${name} ${short(p.y, 4)}${gone ? ", left out by you" : far ? `, beyond the ${limitName(s).toLowerCase()}` : wrong ? ", does not fit the others: left out by the fit" : ""}`;
      inside.push(`<circle class="point" data-at="${p.i}" cx="${f.px(p.xy[0]).toFixed(2)}" cy="${f.py(p.xy[1]).toFixed(2)}" r="5" fill="${gone || far || wrong ? "var(--paper, #fff)" : own}" stroke="${own}" stroke-width="1.5"${far ? ' stroke-dasharray="2 2"' : ""}><title>${escaped(words)}</title></circle>`);
    }
    const said = has ? `${plain(s.symbol)} ${value(row.value, row.u95)}` : "no value";
    return whole(w, h, `${s.body.replaceAll("_", " ")}: ${name} over ${s.variable}′, ${s.campaign}`, said, [...f.out, clip(w, h, m, inside, `${prefix}-sweep`)]);
  };
  // Words inside a figure, broken to its width.
  const wrapped = (sentences, width) => sentences.flatMap((sentence) => sentence.split(" ").reduce((out, word) => {
    const last = out[out.length - 1];
    if (last && (last.length + word.length + 1) * 6.9 < width) out[out.length - 1] = `${last} ${word}`; else out.push(word);
    return out;
  }, []));
  const written = (sentences, x, y, width) => wrapped(sentences, width).map((line, i) => `<text x="${x}" y="${y + 18 * i}" fill="${colour.ink}">${escaped(line)}</text>`);
  const notice = (sentences) => {
    const w = widthOf(track), lines = written(sentences, 14, 30, w - 28), h = Math.max(36 + 18 * lines.length, 90);
    return whole(w, h, "Track of the zigzag", sentences.join(" "), [`<rect x="0.5" y="0.5" width="${w - 1}" height="${h - 1}" fill="none" stroke="${colour.rule}"/>`, ...lines]);
  };
  const notKnown = () => `U95 of ${shown.unknown.map(plain).join(", ")} includes zero: the slope is not known, and the zigzag is that of its value only`;
  const stopped = (run) => (run.determined > 0 ? `Stopped at ${short(run.determined, 4)} s: ${run.why}.` : `Not determined: ${run.why.startsWith("no data") ? "" : "the first orders leave the data; "}${run.why}.`);
  // As the report draws a track: east to the right, north up, one scale; the dot is the start.
  const trackFigure = () => {
    const w = widthOf(track), { motion, still } = shown, lines = [];
    const cut = (run) => { const n = run.determined === Infinity ? run.time.length : Math.max(run.time.findIndex((t) => t > run.determined), 1); return [run.east.slice(0, n), run.north.slice(0, n)]; };
    if (still && !still.lost) lines.push([...cut(still), colour.muted, "7 4", still]);
    if (motion && !motion.lost) lines.push([...cut(motion), colour.a, "", motion]);
    const words = shown.unknown.length ? [`${notKnown()}.`] : [];
    if (motion.why) words.push(stopped(motion));
    if (lines.every((l) => l[0].length < 2)) return notice(words);
    const drawn = lines.filter((l) => l[0].length > 1);
    if (drawn.some((l) => l[4].determined !== Infinity)) words.push("Cross: no value from here on.");
    const told = written(words, 4, 16, w - 8), above = 18 * told.length, h = Math.round(Math.max(0.5 * w, 300)) + above, m = [56, 28 + above, 14, 44];
    let across = padded(lines.flatMap((l) => l[0]), 0.1), up = padded(lines.flatMap((l) => l[1]), 0.04);
    const wide = w - m[0] - m[2], tall = h - m[1] - m[3], per = Math.max((across[1] - across[0]) / wide, (up[1] - up[0]) / tall);
    const about = ([low, high], half) => [0.5 * (low + high) - half, 0.5 * (low + high) + half];
    across = about(across, 0.5 * per * wide);
    up = about(up, 0.5 * per * tall);
    const f = frame(w, h, across, up, ["east, m", "north, m"], m), inside = [];
    for (const [east, north, own, dash, run] of drawn) {
      inside.push(`<path d="${f.path(east, north)}" fill="none" stroke="${own}" stroke-width="1.8"${dash ? ` stroke-dasharray="${dash}"` : ""}/>`);
      if (run.determined !== Infinity) inside.push(`<path d="M${(f.px(east[east.length - 1]) - 5).toFixed(1)} ${(f.py(north[north.length - 1]) - 5).toFixed(1)}l10 10m0-10l-10 10" stroke="${own}" stroke-width="2"><title>no value from here on</title></path>`);
    }
    inside.push(`<circle cx="${f.px(0).toFixed(1)}" cy="${f.py(0).toFixed(1)}" r="4" fill="${colour.a}"><title>start</title></circle>`);
    return whole(w, h, "Track of the zigzag", ["blue now, dashed grey as in the study", ...words].join(". "), [...told, ...f.out, clip(w, h, m, inside, `${prefix}-track`)]);
  };
  const picture = make("div", { onclick: (e) => { const at = e.target.dataset && e.target.dataset.at; if (at !== undefined) { const i = Number(at), edit = editOf(state.index); if (within(current(), edit, i)) toggle(i); } } });
  const track = make("div");
  const save = (box, name) => make("button", { type: "button", class: "save", onclick: () => {
    const svg = box.querySelector("svg");
    if (!svg) return;
    const text = new XMLSerializer().serializeToString(svg).replace(/var\(--[a-z-]+, (#[0-9a-f]+)\)/g, "$1").replace(/(<svg[^>]*>)/, '$1<rect width="100%" height="100%" fill="#fff"/>');
    const link = make("a", { href: URL.createObjectURL(new Blob([text], { type: "image/svg+xml" })), download: `${name()}.svg` });
    link.click();
    setTimeout(() => URL.revokeObjectURL(link.href), 1000);
  } }, "Save SVG");
  const viewChoice = ["force", "ratio"].map((v) => make("input", { type: "radio", name: `${prefix}-view`, id: `${prefix}-view-${v}`, checked: v === state.view, onchange: () => { state.view = v; if (shown.row) show(); } }));
  const viewLabels = viewChoice.map((b) => make("label", { for: b.id }));
  const key = make("p", { class: "quiet" });
  const zigzagChoice = make("select", { id: `${prefix}-zigzag`, onchange: (e) => { [state.file, state.zigzag] = e.target.value.split(" ").map(Number); changed(); } });
  data.files.forEach((f, i) => f.zigzags.forEach((z, j) => zigzagChoice.append(make("option", { value: `${i} ${j}` }, `${z.name} zigzag, ${f.name}`))));
  const zigzagBox = make("section", { class: "zigzag", "aria-label": "Track of the zigzag" }, make("div", { class: "row" }, make("label", { for: zigzagChoice.id, class: "unseen" }, "Zigzag"), zigzagChoice, save(track, () => "zigzag")), track);
  zigzagChoice.style.width = "auto";
  const centre = make("div", { class: "pictures" },
    make("div", { class: "row" }, viewChoice.map((b, i) => make("span", { class: "choice" }, b, viewLabels[i])), save(picture, () => `${current().campaign} ${current().symbol}`)),
    picture, key, zigzagBox);

  const number = make("p", { class: "big" }), said = make("div", { class: "said", "aria-live": "polite" }), rest = make("div", { class: "compared" }), indexBox = make("section", { class: "index" }), motionBox = make("section", { class: "motion" });
  const bar = make("progress", { max: 1, value: 0, "aria-label": "Computing the zigzag" });
  const right = make("div", { class: "values" }, make("section", { class: "value" }, bar, said, rest), indexBox, motionBox);
  const table = (caption, head, rows) => make("table", {}, make("caption", {}, caption), make("thead", {}, make("tr", {}, head.map((t, i) => make("th", { scope: "col", class: i ? "number" : false }, t)))),
    make("tbody", {}, rows.map((r) => make("tr", {}, r.map((c, i) => (i ? make("td", { class: "number" }, c) : make("th", { scope: "row" }, c)))))));
  // A sign without an interval is said with the reason, not as a finding.
  const byValue = (x) => x.sense.endsWith(", no U95");
  const senseOf = (x) => (byValue(x) ? `${x.sense.replace(", no U95", "")}, but ${x.why.replace("no U95: ", "").replaceAll("'", "′")}` : x.sense);
  const show = () => {
    const s = current(), { row, before } = shown, edit = edits[state.index] || { limit: null, dropped: null }, has = row.value !== null;
    viewLabels[0].textContent = `${s.component}′ over ${s.variable}′`;
    viewLabels[1].textContent = `slope: ${s.component}′/${s.variable}′ over |${s.variable}′|`;
    picture.innerHTML = sweepFigure();
    key.textContent = `Orange: slope at the origin with U95. Blue: fitted curve, grey its 95 % band. Dashed grey: slope of the study. Click a point to leave it out. Crosses: left out by the study.`;
    number.textContent = has ? value(row.value, row.u95) : "no value";
    const lines = [make("h2", {}, ...spelled(s.symbol), ` of ${s.campaign}`), number];
    if (has) lines.push(make("p", {}, `U95 ${relative(row.value, row.u95)}${Math.abs(row.value) <= row.u95 ? "; the sign is open" : ""}`));
    else lines.push(make("p", { class: "warn" }, row.reason));
    if (row.removed.length) lines.push(make("p", { class: "warn" }, `Left out by the fit, does not fit the others: ${row.removed.map((i) => s.labels[i]).join(", ")}`));
    if (s.status === "form_rejected") lines.push(make("p", { class: "warn" }, "The study rejects the form of this sweep."));
    if (!local().isUntouched(edit)) lines.push(make("p", { class: "quiet" }, "U95 does not include the effect of your choice of points."));
    said.replaceChildren(...lines);
    const apart = (x) => (has ? `${row.value > x ? "+" : ""}${short(row.value - x, 2)}` : "");
    const rows = [["Study", value(before.value, before.u95), apart(before.value)], ...s.published.map(([name, x]) => [name, short(x, 4), apart(x)])];
    const budget = has ? row.parts.map(([name, half]) => `${name} ${Math.round(100 * (half / row.u95) ** 2)} %`).join(", ") : "";
    if (budget) said.append(make("p", { class: "quiet" }, `Variance: ${budget}`));
    rest.replaceChildren(table("Compared with", ["source", "value", "difference"], rows));
    const list = [];
    data.files.forEach((f, i) => f.indices.forEach((x, j) => {
      const [now, then] = shown.indices[i][j], uses = x.sources.includes(state.index);
      if (!uses && !x.sources.some((k) => k >= 0 && edits[k] && !local().isUntouched(edits[k]))) return;
      list.push(make("p", { class: "big" }, ...spelled(x.name), ` ${value(now.value, now.u95)}`),
        make("p", {}, make("span", { class: !/stable/.test(now.sense) || byValue(now) ? "warn" : now.sense.startsWith("stable") ? "pass" : "fail" }, senseOf(now)), ` (${f.name}; study ${value(then.value, then.u95)}, ${senseOf(then)})`));
      if (now.why && !byValue(now)) list.push(make("p", { class: "quiet" }, now.why));
      const fixed = x.symbols.map((t, n) => (x.sources[n] < 0 ? `${t.replace("'", "′")} ${short(x.values[n], 4)} (${x.origins[n]})` : "")).filter(Boolean);
      if (fixed.length) list.push(make("p", { class: "quiet" }, `Not on this page: ${fixed.join(", ")}`));
    }));
    if (!list.length) list.push(make("p", { class: "quiet" }, "No stability index uses this coefficient."));
    indexBox.replaceChildren(make("h2", {}, "Course stability, positive is stable"), ...list);
  };
  const angleOf = (f) => (f.unit === "rad" ? [f.value * 180 / Math.PI, "°"] : [f.value, ` ${f.unit}`]);
  const showMotion = () => {
    const f = data.files[state.file], z = f && f.zigzags[state.zigzag], { motion, still } = shown;
    zigzagBox.hidden = !data.files.some((file) => file.zigzags.length);
    if (!z) {
      track.innerHTML = f && f.why ? notice([`No zigzag: ${f.why}.`]) : "";
      zigzagChoice.value = "";
      motionBox.replaceChildren(make("h2", {}, "Zigzag"), make("p", { class: "quiet" }, f ? `${f.name} makes none: ${f.why}.` : "The study makes no parameter file."));
      return;
    }
    zigzagChoice.value = `${state.file} ${state.zigzag}`;
    const head = make("h2", {}, `Zigzag ${z.name}, ${f.name}`);
    if (motion.lost) {
      track.innerHTML = notice([`Not determined: ${plain(motion.lost)} has no value.`]);
      motionBox.replaceChildren(head, make("p", { class: "warn" }, `no motion: ${plain(motion.lost)} has no value`));
      return;
    }
    track.innerHTML = trackFigure();
    const cell = (x) => { if (x.value === null) return x.status === "not determined" ? "no value" : x.status; const [v, unit] = angleOf(x); return `${v.toFixed(Math.min(Math.max(2 - Math.floor(Math.log10(Math.abs(v) || 1)), 0), 4))}${unit}`; };
    const rows = motion.figures.map((x, i) => [x.name, cell(x), cell(still.figures[i])]), notes = [];
    if (shown.unknown.length) notes.push(make("p", { class: "warn" }, `${notKnown()}.`));
    if (motion.why) notes.push(make("p", { class: "warn" }, stopped(motion)));
    const beyond = [...new Set(motion.figures.filter((x) => x.status === "extrapolated").map((x) => x.why))];
    if (beyond.length) notes.push(make("p", { class: "quiet" }, `Extrapolated, ${beyond[beyond.length - 1]}.`));
    notes.push(make("p", { class: "quiet" }, `Runge-Kutta of order 4, ${short(z.step, 3)} s. Terms tied to a slope follow it; no term is fitted again.`));
    motionBox.replaceChildren(head, ...notes.splice(0, shown.unknown.length ? 1 : 0), table("", ["quantity", "now", "study"], rows), ...notes);
  };

  root.replaceChildren(left, centre, right);
  let redraw = 0;
  new ResizeObserver(() => { clearTimeout(redraw); redraw = setTimeout(() => { if (shown.row) show(); if (shown.motion) showMotion(); }, 120); }).observe(picture);
  root.dataset.ready = "true";
  root.bench = { data, edits, state, shown, local, changed: () => chosen() };
  chosen();
  return () => { if (worker) worker.terminate(); };
};
