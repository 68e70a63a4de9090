// Figures as SVG, PNG, PDF and their numbers as CSV; tables as CSV and LaTeX; all of them in one ZIP. Equal pages give equal files.
const DPI = 600, STUDY = document.querySelector("main").dataset.study || "report";
const bytes = text => new TextEncoder().encode(text);

const CRC = Uint32Array.from({length: 256}, (_, n) => { for (let k = 0; k < 8; k++) n = n & 1 ? 0xedb88320 ^ (n >>> 1) : n >>> 1; return n >>> 0; });
const crc32 = data => { let c = ~0; for (const b of data) c = CRC[(c ^ b) & 255] ^ (c >>> 8); return ~c >>> 0; };

function save(name, type, content) {
  const link = document.createElement("a"), address = URL.createObjectURL(new Blob([content], {type}));
  link.href = address;
  link.download = `${STUDY}-${name}`;
  link.click();
  setTimeout(() => URL.revokeObjectURL(address), 10000);
}

// The styles that the page keeps once for all drawings, by class.
const shared = new Map([...document.styleSheets].flatMap(sheet => [...sheet.cssRules])
  .filter(rule => /^figure svg \.s\d+$/.test(rule.selectorText ?? "")).map(rule => [rule.selectorText.slice(12), rule.style.cssText]));

// A drawing as one may take it away: with its legend, without what a pointer does, colours as on paper.
function standing(figure) {
  const svg = figure.querySelector(".plot > svg").cloneNode(true), whole = figure.whole;
  svg.querySelectorAll(".ring").forEach(e => e.remove());
  if (whole) {
    svg.setAttribute("viewBox", whole.box);
    svg.append(whole.legend.cloneNode(true));
  }
  for (const e of [svg, ...svg.querySelectorAll("*")]) {
    const own = shared.get(e.getAttribute("class")), more = e.getAttribute("style");
    if (own) { e.removeAttribute("class"); e.setAttribute("style", more ? `${own} ${more}` : own); }
    const style = e.getAttribute("style");
    if (style) e.setAttribute("style", style.replace(/var\(--[\w-]+, *(#[0-9a-fA-F]{6})\)/g, "$1"));
    for (const name of e.getAttributeNames()) if (name.startsWith("data-")) e.removeAttribute(name);
  }
  const [, , wide, tall] = svg.getAttribute("viewBox").split(" ").map(Number);
  svg.setAttribute("width", `${wide}pt`);
  svg.setAttribute("height", `${tall}pt`);
  return {svg, wide, tall};
}
const asText = svg => new XMLSerializer().serializeToString(svg) + "\n";

async function asPng({svg, wide, tall}) {
  const image = new Image(), canvas = document.createElement("canvas"), scale = DPI / 72;
  image.src = "data:image/svg+xml;charset=utf-8," + encodeURIComponent(asText(svg));
  await image.decode();
  [canvas.width, canvas.height] = [Math.round(wide * scale), Math.round(tall * scale)];
  const brush = canvas.getContext("2d");
  brush.fillStyle = "#fff";
  brush.fillRect(0, 0, canvas.width, canvas.height);
  brush.drawImage(image, 0, 0, canvas.width, canvas.height);
  const blob = await new Promise(done => canvas.toBlob(done, "image/png"));
  const png = new Uint8Array(await blob.arrayBuffer()), chunk = new Uint8Array(21), view = new DataView(chunk.buffer);
  view.setUint32(0, 9);
  chunk.set(bytes("pHYs"), 4);
  view.setUint32(8, Math.round(DPI / 0.0254));
  view.setUint32(12, Math.round(DPI / 0.0254));
  chunk[16] = 1;
  view.setUint32(17, crc32(chunk.subarray(4, 17)));
  return new Blob([png.subarray(0, 33), chunk, png.subarray(33)]);
}

// Numbers of a figure, one line a point.
const quoted = cell => /[",\n]/.test(cell) ? `"${cell.replace(/"/g, '""')}"` : cell;
const asCsv = rows => rows.map(row => row.map(cell => quoted(bare(String(cell ?? "")))).join(",") + "\n").join("");
function numbersCsv(figure) {
  const {panels} = JSON.parse(figure.querySelector("script.numbers").textContent), many = panels.length > 1;
  const named = (p, k) => bare(p.units[k] ? `${p.names[k]} [${p.units[k]}]` : p.names[k]), head = (k, other) =>
    new Set(panels.map(p => named(p, k))).size === 1 ? named(panels[0], k) : other;
  const rows = [[...(many ? ["panel"] : []), "series", head(0, "across"), head(1, "value"), "group", "note"]];
  for (const p of panels) for (const s of p.series) s.x.forEach((x, i) =>
    rows.push([...(many ? [named(p, 1)] : []), s.name, x, s.y[i], s.groups?.[i], s.notes?.[i]]));
  const kept = rows[0].map((_, k) => rows.some((row, i) => i && row[k] !== undefined && row[k] !== ""));
  return asCsv(rows.map(row => row.filter((_, k) => kept[k])));
}

// Tables.
const cells = row => [...row.cells];
const wantedOf = table => table.parentElement.querySelector("script.rows");
function tableCsv(table) {
  const wanted = wantedOf(table);
  if (wanted) {
    const {rows} = JSON.parse(wanted.textContent), names = Object.keys(rows[0]);
    return asCsv([names, ...rows.map(row => names.map(name => row[name]))]);
  }
  return asCsv([...table.rows].map(row => cells(row).map(c => c.textContent.trim())));
}
const TEX = {"\\": "\\textbackslash{}", "&": "\\&", "%": "\\%", "$": "\\$", "#": "\\#", "_": "\\_", "{": "\\{", "}": "\\}",
  "~": "\\textasciitilde{}", "^": "\\textasciicircum{}", "\u2212": "$-$", "\u00b1": "$\\pm$", "\u00d7": "$\\times$", "\u00b0": "$^\\circ$",
  "\u2026": "\\ldots{}", "\u2264": "$\\le$", "\u2265": "$\\ge$", "\u00b7": "$\\cdot$", "\u2013": "--", "\u2032": "$'$", "\u00bd": "$\\tfrac12$", "\u202f": "\\,",
  "\u221a": "$\\surd$", "<": "$<$", ">": "$>$", "|": "$|$"};
const GREEKS = {"\u03b1": "alpha", "\u03b2": "beta", "\u03b3": "gamma", "\u03b4": "delta", "\u03b8": "theta", "\u03bb": "lambda", "\u03bd": "nu", "\u03c1": "rho", "\u03c6": "phi",
  "\u03c8": "psi", "\u03c9": "omega", "\u03b6": "zeta"};
const plainTex = text => [...text].map(ch => GREEKS[ch] ? `$\\${GREEKS[ch]}$` : TEX[ch] ?? ch).join("");
const mathTex = text => [...text].map(ch => GREEKS[ch] ? `\\${GREEKS[ch]} ` : {"\u2212": "-", "\u202f": "\\,"}[ch] ?? (TEX[ch] ?? ch).replace(/^\$(.*)\$$/, "$1")).join("");
// Runs of italics, indices, powers and primes are one formula.
function tex(node) {
  if (node.nodeType === Node.TEXT_NODE) return plainTex(node.textContent);
  if (node.matches(".unseen, [aria-hidden]")) return "";
  if (!["I", "SUB", "SUP", "U", "B"].includes(node.tagName)) return [...node.childNodes].map(tex).join("");
  return `$${formula(node)}$`;
}
function formula(node) {
  if (node.nodeType === Node.TEXT_NODE) return mathTex(node.textContent);
  const inner = () => [...node.childNodes].map(formula).join("");
  if (node.tagName === "B") return "";
  if (node.tagName === "U") return "'";
  if (node.tagName === "SUB") return `_{${inner()}}`;
  if (node.tagName === "SUP") return `^{${inner()}}`;
  return node.classList.contains("dot") ? `\\dot{${mathTex(node.firstChild.textContent)}}` : inner();
}
const joined = text => text.replace(/\$-\$(\d[\d.]*)/g, "$-$1$").replace(/\$\$/g, "").replace(/\$ \$/g, " ").trim();
function tableTex(table) {
  const [head, ...rows] = [...table.rows], left = c => c.classList.contains("left") || c.tagName === "TH" && c.scope === "row";
  const line = row => cells(row).map(c => joined(tex(c))).join(" & ") + " \\\\\n";
  return `% ${STUDY}, needs \\usepackage{booktabs}\n\\begin{table}\n\\caption{${joined(tex(table.caption))}}\n` +
    `\\begin{tabular}{${cells(head).map(c => left(c) ? "l" : "r").join("")}}\n\\toprule\n${line(head)}\\midrule\n` +
    `${rows.map(line).join("")}\\bottomrule\n\\end{tabular}\n\\end{table}\n`;
}

// Everything in one archive, stored as it is; the day of a file is the first one that an archive can hold.
function zip(files) {
  const parts = [], directory = [];
  let at = 0, length = 0;
  const words = (...values) => {
    const out = new Uint8Array(values.reduce((sum, [width]) => sum + width, 0)), view = new DataView(out.buffer);
    let place = 0;
    for (const [width, v] of values) { view[width === 2 ? "setUint16" : "setUint32"](place, v, true); place += width; }
    return out;
  };
  for (const [path, content] of files) {
    const name = bytes(path), data = bytes(content);
    const common = [[2, 20], [2, 0x800], [2, 0], [2, 0], [2, 33], [4, crc32(data)], [4, data.length], [4, data.length], [2, name.length], [2, 0]];
    parts.push(words([4, 0x04034b50], ...common), name, data);
    directory.push(words([4, 0x02014b50], [2, 20], ...common, [2, 0], [2, 0], [2, 0], [4, 0], [4, at]), name);
    at += 30 + name.length + data.length;
    length += 46 + name.length;
  }
  return new Blob([...parts, ...directory, words([4, 0x06054b50], [2, 0], [2, 0], [2, files.length], [2, files.length], [4, length], [4, at], [2, 0])]);
}

const figures = [...document.querySelectorAll("figure:not(.space)")], drawnTables = [...document.querySelectorAll("main table")];
const tableName = table => table.dataset.name ?? table.caption.id ?? "table";
function everything() {
  const files = [];
  for (const f of figures) {
    files.push([`figures/${f.id}.svg`, asText(standing(f).svg)]);
    if (f.querySelector("script.numbers")) files.push([`figures/${f.id}.csv`, numbersCsv(f)]);
  }
  for (const t of drawnTables) files.push([`tables/${tableName(t)}.csv`, tableCsv(t)], [`tables/${tableName(t)}.tex`, tableTex(t)]);
  return zip(files);
}

// Buttons.
const said = text => bare(text.trim()).replace(/\.$/, "");
function saver(place, name, what, kinds) {
  const row = made("div", "save", place);
  row.setAttribute("role", "group");
  row.setAttribute("aria-label", `Save ${what}`);
  made("span", "", row).textContent = name;
  for (const [kind, act] of kinds) {
    const button = made("button", "", row);
    button.type = "button";
    button.textContent = kind;
    button.addEventListener("click", act);
  }
  return row;
}
const figureKinds = f => [
  ["SVG", () => save(`${f.id}.svg`, "image/svg+xml", asText(standing(f).svg))],
  ["PNG", async () => save(`${f.id}.png`, "image/png", await asPng(standing(f)))],
  ["PDF", () => save(`${f.id}.pdf`, "application/pdf", asPdf(standing(f)))],
  ...(f.querySelector("script.numbers") ? [["CSV", () => save(`${f.id}.csv`, "text/csv", numbersCsv(f))]] : []),
];
const tableKinds = t => [
  ["CSV", () => save(`${tableName(t)}.csv`, "text/csv", tableCsv(t))],
  ["LaTeX", () => save(`${tableName(t)}.tex`, "application/x-tex", tableTex(t))],
];
const title = f => said(f.querySelector("figcaption strong").textContent);
const first = document.querySelector("#answer");
for (const f of figures) if (!first?.contains(f)) saver(f, "Save", title(f), figureKinds(f));
for (const f of document.querySelectorAll("figure.space:not([hidden])")) {
  saver(f, "Save", title(f), [["PNG", async () => save(`${f.id}.png`, "image/png", await f.view.png())]]);
}
for (const t of drawnTables) if (!first?.contains(t)) {
  const row = saver(t.parentElement.parentElement, "Save", said(t.caption.textContent), tableKinds(t));
  let after = t.parentElement;
  while (after.nextElementSibling?.classList.contains("note")) after = after.nextElementSibling;
  after.after(row);
}
if (first) {
  const place = made("div", "downloads", first.querySelector(".aside") ?? first), names = ["Left figure", "Right figure", document.getElementById("answer-axes") ? "Axes" : "Body"];
  made("h3", "", place).textContent = "Save";
  for (const t of first.querySelectorAll("table")) saver(place, "Table", said(t.caption.textContent), tableKinds(t));
  [...first.querySelectorAll("figure:not(.space)")].forEach((f, i) => saver(place, names[i], title(f), figureKinds(f)));
  saver(place, "All figures, tables", "all figures and tables of this page",
    [["ZIP", () => save("figures-and-tables.zip", "application/zip", everything())]]);
}
