// A drawing as one page of PDF: paths, and words in Helvetica and Symbol, which every reader has; their widths are Adobe's.
const WIDTHS = [278, 278, 355, 556, 556, 889, 667, 191, 333, 333, 389, 584, 278, 333, 278, 278, 556, 556, 556, 556, 556, 556, 556, 556, 556, 556, 278, 278, 584, 584, 584, 556, 1015, 667, 667, 722, 722, 667, 611, 778, 722, 278, 500, 667, 556, 833, 722, 778, 667, 778, 722, 667, 611, 722, 667, 944, 667, 667, 611, 278, 278, 278, 469, 556, 333, 556, 556, 500, 556, 556, 278, 556, 556, 222, 222, 500, 222, 833, 556, 556, 556, 556, 333, 500, 278, 556, 500, 722, 500, 500, 500, 334, 260, 334, 584];
// Of letters beyond ASCII the code and the width, in Helvetica (WinAnsi) and in Symbol.
const WESTERN = {"\u00b1": [0xb1, 584], "\u00b0": [0xb0, 400], "\u00b7": [0xb7, 278], "\u00d7": [0xd7, 584], "\u2026": [0x85, 1000], "\u2013": [0x96, 556],
  "\u2014": [0x97, 1000], "\u00bd": [0xbd, 834], "\u00b5": [0xb5, 556]};
const SYMBOL = {"\u2212": [0x2d, 549], "\u2032": [0xa2, 247], "\u221a": [0xd6, 549], "\u2264": [0xa3, 549], "\u2265": [0xb3, 549], "\u03b1": [97, 631],
  "\u03b2": [98, 549], "\u03b3": [103, 411], "\u03b4": [100, 494], "\u03b8": [113, 521], "\u03bb": [108, 549], "\u03bd": [110, 521], "\u03c1": [114, 549],
  "\u03c6": [102, 521], "\u03c8": [121, 686], "\u03c9": [119, 686], "\u03b6": [122, 494], "\u0394": [68, 612]};
const RAISED = "\u2070\u00b9\u00b2\u00b3\u2074\u2075\u2076\u2077\u2078\u2079";
const INHERITED = {fill: "#000000", stroke: "none", "stroke-width": "1", "stroke-linecap": "butt", "stroke-linejoin": "round", "stroke-dasharray": "none",
  "fill-opacity": "1", "stroke-opacity": "1", "text-anchor": "start", "font-size": "8.75px", "font-style": "normal", "font-weight": "normal"};
const fixed = v => String(Math.round(v * 1000) / 1000 + 0);
const TURNS = {rotate: ([a, x = 0, y = 0]) => { const t = a * Math.PI / 180, c = Math.cos(t), s = Math.sin(t); return [c, s, -s, c, x - c * x + s * y, y - s * x - c * y]; },
  translate: ([x, y = 0]) => [1, 0, 0, 1, x, y], scale: ([x, y = x]) => [x, 0, 0, y, 0, 0], matrix: v => v};

class Sheet {
  constructor(svg) {
    this.out = [];
    this.states = new Map();
    this.svg = svg;
    this.walk(svg, {...INHERITED, opacity: 1});
  }

  put(...words) { this.out.push(words.map(w => typeof w === "number" ? fixed(w) : w).join(" ")); }

  styled(e, above) {
    const style = {...above}, own = {};
    for (const name of [...Object.keys(INHERITED), "opacity", "display"]) {
      const v = e.style?.getPropertyValue(name) || e.getAttribute(name);
      if (v) own[name] = v;
    }
    Object.assign(style, own, {opacity: above.opacity * parseFloat(own.opacity ?? 1)});
    if (own["font-size"]?.endsWith("em")) style["font-size"] = String(parseFloat(own["font-size"]) * parseFloat(above["font-size"]));
    return style;
  }

  walk(e, above) {
    if (["defs", "title", "desc", "clipPath", "style"].includes(e.localName)) return;
    const style = this.styled(e, above), clip = /#([^")]+)/.exec(e.getAttribute("clip-path") ?? "")?.[1];
    if (style.display === "none") return;
    this.put("q");
    for (const [, kind, values] of (e.getAttribute("transform") ?? "").matchAll(/(\w+)\(([^)]*)\)/g))
      this.put(...TURNS[kind](values.split(/[\s,]+/).filter(Boolean).map(Number)), "cm");
    if (clip) {
      const box = this.svg.querySelector(`#${CSS.escape(clip)} rect`);
      if (box) this.put(...["x", "y", "width", "height"].map(n => Number(box.getAttribute(n))), "re W n");
    }
    if (e.localName === "path") this.path(e.getAttribute("d"), style);
    else if (e.localName === "use") this.use(e, style);
    else if (e.localName === "text") this.text(e, style);
    else for (const child of e.children) this.walk(child, style);
    this.put("Q");
  }

  use(e, style) {
    const shape = this.svg.querySelector(`#${CSS.escape(e.getAttribute("href").slice(1))}`);
    this.put(1, 0, 0, 1, Number(e.getAttribute("x") ?? 0), Number(e.getAttribute("y") ?? 0), "cm");
    if (shape) this.path(shape.getAttribute("d"), this.styled(shape, style));
  }

  colour(text, operator) {
    if (!text || text === "none") return false;
    const parts = text.startsWith("#") ? [1, 3, 5].map(i => parseInt(text.slice(i, i + 2), 16)) : text.match(/[\d.]+/g)?.slice(0, 3).map(Number);
    if (!parts) return false;
    this.put(...parts.map(v => v / 255), operator);
    return true;
  }

  // Opaque as the drawing says; a state for every pair of opacities.
  veil(style) {
    const pair = ["fill-opacity", "stroke-opacity"].map(n => fixed(style.opacity * parseFloat(style[n])));
    if (pair.join() === "1,1") return;
    const key = pair.join();
    if (!this.states.has(key)) this.states.set(key, `G${this.states.size}`);
    this.put(`/${this.states.get(key)} gs`);
  }

  path(d, style) {
    const filled = parseFloat(style["fill-opacity"]) > 0 && this.colour(style.fill, "rg"), width = parseFloat(style["stroke-width"]);
    const stroked = width > 0 && this.colour(style.stroke, "RG");
    if (!filled && !stroked) return;
    this.veil(style);
    if (stroked) {
      this.put(width, "w", {butt: 0, round: 1, square: 2}[style["stroke-linecap"]] ?? 0, "J", {miter: 0, round: 1, bevel: 2}[style["stroke-linejoin"]] ?? 1, "j");
      const dashes = style["stroke-dasharray"];
      if (dashes && dashes !== "none") this.put(`[${dashes.split(/[\s,]+/).map(v => fixed(parseFloat(v))).join(" ")}] 0 d`);
    }
    let x = 0, y = 0;
    for (const [, letter, rest] of d.matchAll(/([MLHVCQz])([^MLHVCQz]*)/gi)) {
      const v = rest.split(/[\s,]+/).filter(Boolean).map(Number);
      if (letter === "M" || letter === "L") for (let i = 0; i < v.length; i += 2) { [x, y] = [v[i], v[i + 1]]; this.put(x, y, letter === "M" && !i ? "m" : "l"); }
      else if (letter === "H") { x = v.at(-1); this.put(x, y, "l"); }
      else if (letter === "V") { y = v.at(-1); this.put(x, y, "l"); }
      else if (letter === "C") for (let i = 0; i < v.length; i += 6) { this.put(...v.slice(i, i + 6), "c"); [x, y] = [v[i + 4], v[i + 5]]; }
      else if (letter === "Q") for (let i = 0; i < v.length; i += 4) {
        const [a, b, c, e] = v.slice(i, i + 4);
        this.put(x + 2 * (a - x) / 3, y + 2 * (b - y) / 3, c + 2 * (a - c) / 3, e + 2 * (b - e) / 3, c, e, "c");
        [x, y] = [c, e];
      } else this.put("h");
    }
    this.put(filled && stroked ? "B" : filled ? "f" : "S");
  }

  // Letters with their font, code, width, size and height over the line.
  letters(e, style) {
    const out = [];
    let level = 0;
    for (const part of e.childNodes) {
      const own = part.nodeType === Node.ELEMENT_NODE ? this.styled(part, style) : style, size = parseFloat(own["font-size"]);
      if (part.nodeType === Node.ELEMENT_NODE) level += parseFloat(part.getAttribute("dy") ?? 0) * (part.getAttribute("dy")?.endsWith("em") ? size : 1);
      const font = own["font-style"] === "italic" ? "O" : /bold|[67]00/.test(own["font-weight"]) ? "B" : "H";
      for (const ch of part.textContent.normalize("NFD").replace(/\s+/g, " ")) {
        if (ch === "\u2032" && out.at(-1)) out.at(-1).wide += 0.07 * size;
        out.push(...this.letter(ch, font, size, level));
      }
    }
    return out;
  }

  letter(ch, font, size, level) {
    const code = ch.charCodeAt(0), power = ch === "\u207b" ? "\u2212" : RAISED.indexOf(ch) >= 0 ? String(RAISED.indexOf(ch)) : "";
    if (power) return this.letter(power, font, 0.68 * size, level - 0.36 * size);
    if (code === 0x307) return [{font, code: 0x2e, wide: 0, size, level: level - 0.62 * size, back: 0.36 * size}];
    if (SYMBOL[ch]) return [{font: "S", code: SYMBOL[ch][0], wide: SYMBOL[ch][1] * size / 1000, size, level, slant: font === "O"}];
    const [coded, wide] = WESTERN[ch] ?? (code >= 32 && code < 127 ? [code, WIDTHS[code - 32]] : ch === "\u202f" || ch === "\u00a0" ? [32, 200] : [0x3f, 556]);
    return [{font, code: coded, wide: wide * size / 1000, size, level}];
  }

  text(e, style) {
    const letters = this.letters(e, style), long = letters.reduce((sum, l) => sum + l.wide, 0);
    let x = Number(e.getAttribute("x") ?? 0) - long * {start: 0, middle: 0.5, end: 1}[style["text-anchor"]];
    const y = Number(e.getAttribute("y") ?? 0);
    if (!letters.length || !this.colour(style.fill, "rg")) return;
    this.veil(style);
    this.put("BT");
    for (const l of letters) {
      this.put(`/${l.font}`, l.size, "Tf", 1, 0, l.slant ? 0.21 : 0, -1, x - (l.back ?? 0), y + l.level, `Tm <${l.code.toString(16).padStart(2, "0")}> Tj`);
      x += l.wide;
    }
    this.put("ET");
  }
}

function asPdf({svg, wide, tall}) {
  const [left, top] = svg.getAttribute("viewBox").split(" ").map(Number), sheet = new Sheet(svg);
  const content = `1 0 0 -1 ${fixed(-left)} ${fixed(tall + top)} cm\n${sheet.out.join("\n")}\n`;
  const font = (name, more = "/Encoding /WinAnsiEncoding") => `<< /Type /Font /Subtype /Type1 /BaseFont /${name} ${more} >>`;
  const states = [...sheet.states].map(([pair, name]) => `/${name} << /ca ${pair.split(",")[0]} /CA ${pair.split(",")[1]} >>`).join(" ");
  const objects = ["<< /Type /Catalog /Pages 2 0 R >>", "<< /Type /Pages /Kids [3 0 R] /Count 1 >>",
    `<< /Type /Page /Parent 2 0 R /MediaBox [0 0 ${fixed(wide)} ${fixed(tall)}] /Contents 4 0 R /Resources << /ExtGState << ${states} >> /Font << ` +
    "/H 5 0 R /O 6 0 R /B 7 0 R /S 8 0 R >> >> >>", `<< /Length ${content.length} >>\nstream\n${content}endstream`,
    font("Helvetica"), font("Helvetica-Oblique"), font("Helvetica-Bold"), font("Symbol", "")];
  let out = "%PDF-1.4\n";
  const places = objects.map((body, i) => { const at = out.length; out += `${i + 1} 0 obj\n${body}\nendobj\n`; return at; });
  const table = places.map(at => `${String(at).padStart(10, "0")} 00000 n \n`).join(""), start = out.length;
  return `${out}xref\n0 ${objects.length + 1}\n0000000000 65535 f \n${table}trailer\n<< /Size ${objects.length + 1} /Root 1 0 R >>\nstartxref\n${start}\n%%EOF\n`;
}
