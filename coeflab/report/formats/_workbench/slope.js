"use strict";
// The slope at the origin as coeflab/fits/statistics/origin_slope.py has it: the same members, grids and sums in doubles.
// Constants come from Python with the page (`k`), so that there is one place to change them.
const slopeAtOrigin = (k) => {
  const grid = (from, to, make) => Array.from({ length: to - from }, (_, i) => make(from + i));
  const dot = (a, b, n) => { let s = 0; for (let i = 0; i < n; i++) s += a[i] * b[i]; return s; };

  // Distributions: every number of degrees of freedom here is whole.
  const logGammaOfHalf = (n) => {
    let s = n % 2 ? 0.5 * Math.log(Math.PI) : 0;
    for (let i = n % 2 ? 1 : 2; i < n; i += 2) s += Math.log(i / 2);
    return s;
  };
  const logDensity = (nu) => logGammaOfHalf(nu) - 0.5 * nu * Math.log(Math.PI);
  const studentBelow = (nu, sine) => {
    const cosine2 = 1 - sine * sine, cosine = Math.sqrt(cosine2);
    let term = nu % 2 ? cosine : 1, sum = nu === 1 ? 0 : term;
    for (let i = nu % 2 ? 3 : 2; i < nu - 1; i += 2) { term *= cosine2 * (i - 1) / i; sum += term; }
    const inside = nu % 2 ? 2 / Math.PI * (Math.asin(sine) + sine * sum) : sine * sum;
    return 0.5 * (1 + inside);
  };
  const studentAt = (nu, share) => {
    let low = 0, high = 1;
    for (let i = 0; i < 80; i++) {
      const middle = 0.5 * (low + high);
      if (studentBelow(nu, middle) < share) low = middle; else high = middle;
    }
    return low * Math.sqrt(nu / (1 - low * low));
  };
  const TABLE = Float64Array.from(grid(1, 2000, (i) => Math.sin(0.5 * Math.PI * (-1 + i / 1000))));
  const tables = new Map();
  const tableOf = (nu) => {
    if (!tables.has(nu)) tables.set(nu, TABLE.map((u) => studentBelow(nu, u)));
    return tables.get(nu);
  };
  const looked = (u, table) => {
    const last = TABLE.length - 1;
    if (!(u > TABLE[0])) return table[0];
    if (u >= TABLE[last]) return table[last];
    let i = Math.min(Math.max(Math.floor((Math.asin(u) * 2 / Math.PI + 1) * 1000) - 1, 0), last - 1);
    while (TABLE[i] > u) i--;
    while (TABLE[i + 1] <= u) i++;
    return table[i] + (table[i + 1] - table[i]) / (TABLE[i + 1] - TABLE[i]) * (u - TABLE[i]);
  };

  const logSum = (values) => {
    let top = -Infinity;
    for (const v of values) if (v > top) top = v;
    if (top === -Infinity) return top;
    let s = 0;
    for (const v of values) s += Math.exp(v - top);
    return top + Math.log(s);
  };

  // Small dense matrices, row by row.
  const inverted = (m, p) => {
    const a = Float64Array.from(m), out = new Float64Array(p * p);
    for (let i = 0; i < p; i++) out[i * p + i] = 1;
    let log = 0;
    for (let c = 0; c < p; c++) {
      let best = c;
      for (let r = c + 1; r < p; r++) if (Math.abs(a[r * p + c]) > Math.abs(a[best * p + c])) best = r;
      if (best !== c) for (let j = 0; j < p; j++) {
        [a[c * p + j], a[best * p + j]] = [a[best * p + j], a[c * p + j]];
        [out[c * p + j], out[best * p + j]] = [out[best * p + j], out[c * p + j]];
      }
      const pivot = a[c * p + c];
      log += Math.log(Math.abs(pivot));
      for (let r = c + 1; r < p; r++) {
        const f = a[r * p + c] / pivot;
        if (f === 0) continue;
        for (let j = c; j < p; j++) a[r * p + j] -= f * a[c * p + j];
        for (let j = 0; j < p; j++) out[r * p + j] -= f * out[c * p + j];
      }
    }
    for (let j = 0; j < p; j++) for (let r = p - 1; r >= 0; r--) {
      let s = out[r * p + j];
      for (let i = r + 1; i < p; i++) s -= a[r * p + i] * out[i * p + j];
      out[r * p + j] = s / a[r * p + r];
    }
    return { inverse: out, log };
  };
  const cholesky = (m, n) => {
    const l = new Float64Array(n * n);
    for (let i = 0; i < n; i++) for (let j = 0; j <= i; j++) {
      let s = m[i * n + j];
      for (let c = 0; c < j; c++) s -= l[i * n + c] * l[j * n + c];
      l[i * n + j] = i === j ? Math.sqrt(s) : s / l[j * n + j];
    }
    return l;
  };
  const lowerInverse = (l, n) => {
    const out = new Float64Array(n * n);
    for (let j = 0; j < n; j++) for (let i = j; i < n; i++) {
      let s = i === j ? 1 : 0;
      for (let c = j; c < i; c++) s -= l[i * n + c] * out[c * n + j];
      out[i * n + j] = s / l[i * n + i];
    }
    return out;
  };
  // Least squares with the smallest solution, by one-sided Jacobi rotations; `columns` is p rows of n.
  const leastSquares = (columns, y) => {
    const p = columns.length, n = y.length;
    const u = columns.map((c) => Float64Array.from(c));
    const v = grid(0, p, (i) => Float64Array.from(grid(0, p, (j) => (i === j ? 1 : 0))));
    for (let sweep = 0; sweep < 60; sweep++) {
      let turned = false;
      for (let a = 0; a < p; a++) for (let b = a + 1; b < p; b++) {
        const aa = dot(u[a], u[a], n), bb = dot(u[b], u[b], n), ab = dot(u[a], u[b], n);
        if (ab === 0 || Math.abs(ab) <= 1e-16 * Math.sqrt(aa * bb)) continue;
        turned = true;
        const zeta = (bb - aa) / (2 * ab), t = (zeta < 0 ? -1 : 1) / (Math.abs(zeta) + Math.hypot(1, zeta));
        const c = 1 / Math.hypot(1, t), s = c * t;
        for (const [one, two] of [[u[a], u[b]], [v[a], v[b]]]) for (let i = 0; i < one.length; i++) {
          const first = one[i];
          one[i] = c * first - s * two[i];
          two[i] = s * first + c * two[i];
        }
      }
      if (!turned) break;
    }
    const size = u.map((c) => Math.sqrt(dot(c, c, n))), most = Math.max(...size), out = new Float64Array(p);
    for (let a = 0; a < p; a++) {
      if (size[a] <= 1e-15 * most) continue;
      const share = dot(u[a], y, n) / (size[a] * size[a]);
      for (let i = 0; i < p; i++) out[i] += share * v[a][i];
    }
    return out;
  };

  // Covariance of a remainder between two settings, one at |t| = 1.
  const seriesOf = (name, odd) => {
    const first = name === "powers" ? 2 : 3, step = name === "powers" ? 1 : odd ? 2 : 1, out = [];
    for (let i = first; i < k.ORDERS; i += step) out.push([i, k.DECAY ** i]);
    return out;
  };
  const remainder = (name, odd) => {
    if (name === "fractions") return (a, b) => {
      const sides = Math.sign(a) * Math.sign(b), x = Math.abs(a), y = Math.abs(b);
      let s = 0;
      for (let i = 0; i < k.NODES.length; i++) {
        const power = 2.75 + 1.25 * k.NODES[i];
        s += 0.5 * k.WEIGHTS[i] * x ** power * y ** power;
      }
      return sides * s;
    };
    if (name === "series" || name === "powers") {
      const terms = seriesOf(name, odd), total = terms.reduce((s, t) => s + t[1], 0);
      return (a, b) => {
        const u = name === "powers" ? Math.abs(a * b) : a * b;
        let s = 0;
        for (const [power, weight] of terms) s += weight * u ** power;
        return (name === "powers" ? Math.sign(a) * Math.sign(b) : 1) * s / total;
      };
    }
    const power = name[0] === "p" ? Number(name.slice(1)) : 0, onset = name[0] === "p" ? 0 : Number(name.slice(2));
    const q = 2 * power + 1, one = 1 / q - 2 / (q + 1) + 1 / (q + 2);
    return (a, b) => {
      const u = Math.max(Math.abs(a) - onset, 0) / (1 - onset), v = Math.max(Math.abs(b) - onset, 0) / (1 - onset);
      const m = Math.min(u, v), sides = Math.sign(a) * Math.sign(b);
      const size = (u * v / q - (u + v) * m / (q + 1) + m * m / (q + 2)) * m ** q / one;
      return size * (odd ? sides : sides > 0 ? 1 : 0);
    };
  };
  const termsAt = (t, even) => (even ? [1, t, t * t, t * Math.abs(t), t ** 3] : [1, t, t * Math.abs(t), t ** 3]);

  const specifications = (t, even, labels, stated, without) => {
    const n = t.length, out = [{ name: "none", odd: true, sizes: [0], kernel: () => 0, odds: k.NO_REMAINDER }];
    const smooth = (name, odd, odds) => {
      const f = remainder(name, odd);
      out.push({ name, odd, smooth: f, sizes: k.REMAINDER, kernel: (i, j) => f(t[i], t[j]), odds });
    };
    if (!without.includes("remainder")) {
      for (const [name, odds] of k.ODD) smooth(name, true, odds);
      if (even) for (const [name, odds] of k.SIDES) smooth(name, false, odds);
    }
    for (const c of k.FAR) {
      out.push({ name: "far", odd: true, sizes: k.BEYOND, kernel: (i, j) => (i === j && Math.abs(t[i]) > c ? 1 : 0), odds: k.LOOSE });
    }
    out.push({ name: "growing", odd: true, sizes: k.SCATTER, kernel: (i, j) => (i === j ? t[i] * t[i] : 0), odds: k.GROWING });
    if (new Set(labels).size < n) {
      out.push({ name: "settings", odd: true, sizes: k.SCATTER, kernel: (i, j) => (labels[i] === labels[j] ? 1 : 0), odds: k.SETTING });
    }
    if (stated) out.push({ name: "common", odd: true, sizes: k.SCATTER, kernel: (i, j) => (i === j ? 1 : 0), odds: k.COMMON });
    return out;
  };

  const logPrior = (sizes, curved, odds) => (sizes || [null]).map((size) => {
    const decade = curved.map((c) => {
      const most = Math.max(Math.log10(c[0]), Math.log10(c[1]), size === null ? -Infinity : Math.log10(size));
      return Math.min(Math.max(Math.floor(most + 0.01), -1), 5);
    });
    const weight = curved.map((c) => (c[0] > k.NOTHING ? k.QUADRATIC_ODDS : 1) * (c[0] > k.NOTHING && c[0] === c[1] ? k.ALIKE : 1));
    return { decade, weight };
  }).map((row, _, rows) => {
    return row.weight.map((w, i) => {
      const d = row.decade[i];
      let total = 0;
      for (const other of rows) for (let j = 0; j < other.weight.length; j++) if (other.decade[j] === d) total += other.weight[j];
      return Math.log(odds * (w * ((d < 0 ? k.NOTHING_CURVED : 1) / total)));
    });
  });

  const prepare = (x, variance, { odd = false, without = [] } = {}) => {
    const n = x.length, largest = Math.max(...x.map(Math.abs)), t = x.map((v) => v / largest);
    const ratios = variance || new Array(n).fill(1);
    const rounded = t.map((v) => Math.round(v * 1e9)), distinct = [...new Set(rounded)].sort((a, b) => a - b);
    const labels = rounded.map((v) => distinct.indexOf(v));
    const oneSided = !(Math.min(...t) < 0 && Math.max(...t) > 0);
    const even = !without.includes("even") && !oneSided && !odd;
    const terms = t.map((v) => termsAt(v, even)), p = terms[0].length;
    const specs = specifications(t, even, labels, variance !== null, without);
    const total = specs.reduce((s, m) => s + m.odds, 0);
    const nuisance = odd ? k.PINNED : even || oneSided ? k.NUISANCE : [[Infinity, 1]];
    const common = nuisance.reduce((s, v) => s + v[1], 0);
    const members = [];
    for (const spec of specs) {
      const sizes = spec.name === "none" ? k.SIZES : k.COARSE, kinds = [];
      for (const first of nuisance) for (const a of sizes) for (const b of sizes) {
        if (without.includes("v|v|") && a !== k.NOTHING || without.includes("cubic") && b !== k.NOTHING) continue;
        kinds.push({ first, curved: [a, b] });
      }
      const many = kinds.length, precision = kinds.map((g) => {
        const row = new Float64Array(p);
        if (even || oneSided || odd) row[even ? 2 : 0] = g.first[0] ** -2;
        row[p - 2] = g.curved[0] ** -2;
        row[p - 1] = g.curved[1] ** -2;
        return row;
      });
      const kernel = new Float64Array(n * n), flat = new Float64Array(n * p);
      for (let r = 0; r < n; r++) for (let c = 0; c < n; c++) kernel[r * n + c] = spec.kernel(r, c);
      const prior = logPrior(spec.name === "none" ? null : spec.sizes, kinds.map((g) => g.curved), spec.odds / total);
      for (const row of prior) for (let i = 0; i < many; i++) row[i] += Math.log(kinds[i].first[1] / common);
      spec.sizes.forEach((size, j) => {
        const whole = new Float64Array(n * n);
        for (let r = 0; r < n; r++) for (let c = 0; c < n; c++) whole[r * n + c] = (r === c ? ratios[r] : 0) + size * size * kernel[r * n + c];
        const factor = cholesky(whole, n), root = lowerInverse(factor, n);
        let logDet = 0;
        for (let i = 0; i < n; i++) logDet += Math.log(factor[i * n + i]);
        logDet *= 2;
        const columns = grid(0, p, () => new Float64Array(n));
        for (let i = 0; i < n; i++) for (let q = 0; q < p; q++) {
          let s = 0;
          for (let c = 0; c <= i; c++) s += root[i * n + c] * terms[c][q];
          columns[q][i] = s;
        }
        for (let q = 0; q < p; q++) for (let i = 0; i < n; i++) flat[i * p + q] = columns[q][i];
        const square = new Float64Array(p * p), across = new Float64Array(p * n), rowSize = new Float64Array(n);
        for (let a = 0; a < p; a++) for (let b = 0; b < p; b++) square[a * p + b] = dot(columns[a], columns[b], n);
        for (let r = 0; r < n; r++) {
          for (let i = r; i < n; i++) rowSize[r] += root[i * n + r] * root[i * n + r];
          for (let q = 0; q < p; q++) {
            let s = 0;
            for (let i = r; i < n; i++) s += columns[q][i] * root[i * n + r];
            across[q * n + r] = s;
          }
        }
        const cells = precision.map((own, at) => {
          const normal = Float64Array.from(square), scales = new Float64Array(p);
          for (let q = 0; q < p; q++) { normal[q * p + q] += own[q]; scales[q] = 1 / Math.sqrt(normal[q * p + q]); }
          for (let a = 0; a < p; a++) for (let b = 0; b < p; b++) normal[a * p + b] *= scales[a] * scales[b];
          const { inverse, log } = inverted(normal, p);
          for (let a = 0; a < p; a++) for (let b = 0; b < p; b++) inverse[a * p + b] *= scales[a] * scales[b];
          let scale = 0;
          for (let q = 0; q < p; q++) scale -= (own[q] > 0 ? Math.log(own[q]) : 0) + 2 * Math.log(scales[q]);
          const leverage = new Float64Array(n), slopeByRow = new Float64Array(n), checkable = new Uint8Array(n);
          const c = new Float64Array(p), gap = new Float64Array(p);
          for (let r = 0; r < n; r++) {
            for (let q = 0; q < p; q++) { c[q] = 0; for (let i = 0; i < p; i++) c[q] += inverse[q * p + i] * across[i * n + r]; }
            for (let q = 0; q < p; q++) gap[q] = -own[q] * c[q];
            for (let i = 0; i < n; i++) {
              let z = i >= r ? root[i * n + r] : 0;
              for (let q = 0; q < p; q++) z -= flat[i * p + q] * c[q];
              for (let q = 0; q < p; q++) gap[q] += flat[i * p + q] * z;
            }
            for (let q = 0; q < p; q++) for (let i = 0; i < p; i++) c[q] += inverse[q * p + i] * gap[i];
            let size = 0;
            for (let i = 0; i < n; i++) {
              let z = i >= r ? root[i * n + r] : 0;
              for (let q = 0; q < p; q++) z -= flat[i * p + q] * c[q];
              size += z * z;
            }
            for (let q = 0; q < p; q++) size += c[q] * c[q] * own[q];
            leverage[r] = size;
            slopeByRow[r] = c[1];
            checkable[r] = size > k.WEIGHTLESS * rowSize[r] ? 1 : 0;
          }
          return { inverse, precision: own, logPrior: prior[j][at], logDet: logDet + scale + log, leverage, slopeByRow, checkable };
        });
        members.push({ name: spec.name, smooth: spec.smooth, size, root, columns, cells });
      });
    }
    const free = odd ? [] : even ? [t.map(() => 1), t.map((v) => v * v)] : [t.map(() => 1)];
    return { x, t, n, p, largest, variance: ratios, flat: oneSided || odd ? 1 : 2, even, labels, terms, members, free: without.length ? null : free };
  };

  // Slopes that one-signed curves allow, as coeflab/fits/statistics/one_signed.py has them; null without a degree of freedom.
  const oneSigned = (d, y, more, noise, floor, least) => {
    const { n, t } = d, f = d.free.length, one = k.ONE_SIGNED, root = d.variance.map((v) => 1 / Math.sqrt(v));
    const weighed = (column) => Float64Array.from(column, (v, i) => v * root[i]);
    const free = d.free.map(weighed), slope = weighed(t);
    const bent = [
      ...one.POWERS.map((p) => weighed(t.map((v) => Math.sign(v) * Math.abs(v) ** p))),
      ...one.SATURATING.map((c) => weighed(t.map((v) => v * Math.abs(v) * (1 + 1 / c) / (1 + Math.abs(v) / c)))),
    ];
    // Gram-Schmidt, every column twice; a right-hand side is the last column, what is left of it the misfit.
    const factored = (columns) => {
      const basis = [], r = columns.map(() => new Float64Array(columns.length));
      columns.forEach((column, j) => {
        const own = Float64Array.from(column);
        for (let round = 0; round < 2; round++) basis.forEach((b, i) => {
          const s = dot(b, own, n);
          r[i][j] += s;
          for (let q = 0; q < n; q++) own[q] -= s * b[q];
        });
        r[j][j] = Math.sqrt(dot(own, own, n));
        basis.push(own.map((v) => v / (r[j][j] || 1)));
      });
      return r;
    };
    const found = [], right = weighed(y), costs = [];
    for (let m = 0; m <= Math.min(one.TERMS, n - f - 3); m++) {
      const sums = m === 0 ? [[]] : m === 1 ? bent.map((_, i) => [i]) : bent.flatMap((_, i) => grid(i + 1, bent.length, (j) => [i, j]));
      let some = false, cheapest = Infinity;
      for (const sum of sums) {
        const r = factored([...free, ...sum.map((i) => bent[i]), slope, right]), at = f + m, own = grid(0, at + 1, (i) => r[i][i]);
        if (!(Math.min(...own) > one.SINGULAR * Math.max(...own))) continue;
        some = true;
        const size = r[at][at], centre = r[at][at + 1] / size, misfit = r[at + 1][at + 1] ** 2;
        const back = (column) => {
          const c = new Array(m);
          for (let i = m - 1; i >= 0; i--) {
            c[i] = r[f + i][column];
            for (let j = i + 1; j < m; j++) c[i] -= r[f + i][f + j] * c[j];
            c[i] /= r[f + i][f + i];
          }
          return c;
        };
        const moves = back(at).map((v) => -v), edge = back(at + 1).map((v, i) => v / -moves[i] - centre);
        for (const up of [1, -1]) {
          const low = Math.max(-Infinity, ...edge.filter((_, i) => up * moves[i] > 0));
          const high = Math.min(Infinity, ...edge.filter((_, i) => up * moves[i] < 0));
          if (low > high) continue;
          found.push({ misfit, centre, size, low, high });
          cheapest = Math.min(cheapest, misfit + (size * Math.min(Math.max(0, low), high)) ** 2);
        }
      }
      if (!some) break;
      costs.push(cheapest);
    }
    if (!costs.length) return null;
    const freedom = n - f - 2 + more, best = Math.min(...costs), variance = Math.max((best + floor) / freedom, least);
    const ruled = Math.sqrt((costs[0] - best) / Math.max(variance, Number.MIN_VALUE)), [from, to] = one.RULED_OUT;
    const tail = one.TAILS[0] + (one.TAILS[1] - one.TAILS[0]) * Math.min(Math.max((ruled - from) / (to - from), 0), 1);
    const allowed = Math.min(best, noise ** 2 * (freedom + 2)) + studentAt(freedom, 1 - tail) ** 2 * variance;
    let lower = Infinity, upper = -Infinity;
    for (const s of found) {
      const reach = Math.sqrt(allowed - s.misfit) / s.size, low = Math.max(s.low, -reach), high = Math.min(s.high, reach);
      if (!(low <= high)) continue;
      lower = Math.min(lower, s.centre + low);
      upper = Math.max(upper, s.centre + high);
    }
    return [lower, upper];
  };

  // One size of a remainder: its parts of the mixture, and again without each row.
  const evaluate = (m, d, start, rest, nu, floor, least, deletions, main, gone) => {
    const { n, p } = d, whitened = new Float64Array(n), half = new Float64Array(p);
    for (let i = 0; i < n; i++) { let s = 0; for (let c = 0; c <= i; c++) s += m.root[i * n + c] * rest[c]; whitened[i] = s; }
    for (let q = 0; q < p; q++) half[q] = dot(m.columns[q], whitened, n);
    const left = new Float64Array(n), move = new Float64Array(p), gap = new Float64Array(p), all = [];
    const whole = logDensity(nu), fewer = logDensity(nu - 1);
    const away = () => {
      left.set(whitened);
      for (let q = 0; q < p; q++) { const f = move[q], col = m.columns[q]; for (let i = 0; i < n; i++) left[i] -= f * col[i]; }
    };
    for (const cell of m.cells) {
      const own = cell.precision, inv = cell.inverse;
      for (let q = 0; q < p; q++) gap[q] = half[q] - start[q] * own[q];
      for (let q = 0; q < p; q++) { move[q] = 0; for (let i = 0; i < p; i++) move[q] += gap[i] * inv[i * p + q]; }
      away();
      for (let q = 0; q < p; q++) gap[q] = dot(m.columns[q], left, n) - (start[q] + move[q]) * own[q];
      for (let q = 0; q < p; q++) for (let i = 0; i < p; i++) move[q] += gap[i] * inv[i * p + q];
      away();
      let squares = dot(left, left, n) + floor;
      for (let q = 0; q < p; q++) { const z = start[q] + move[q]; squares += z * z * own[q]; }
      const mean = start[1] + move[1], unit = inv[p + 1], variance = Math.max(squares / nu, least);
      main.weight.push(cell.logPrior + k.POWER * (whole - 0.5 * cell.logDet - 0.5 * nu * Math.log(squares)));
      main.mean.push(mean);
      main.variance.push(variance * unit);
      main.noise.push(variance);
      if (deletions) {
        const row = { weight: new Float64Array(n), slope: new Float64Array(n), variance: new Float64Array(n) };
        for (let r = 0; r < n; r++) {
          let error = 0;
          for (let i = r; i < n; i++) error += left[i] * m.root[i * n + r];
          const step = error / cell.leverage[r], after = Math.max(squares - error * step, floor);
          const likelihood = fewer - 0.5 * (cell.logDet + Math.log(cell.leverage[r]));
          row.weight[r] = cell.checkable[r] ? cell.logPrior + k.POWER * (likelihood - 0.5 * (nu - 1) * Math.log(after)) : -Infinity;
          row.slope[r] = mean - cell.slopeByRow[r] * step;
          row.variance[r] = Math.max(after / (nu - 1), least) * (unit + cell.slopeByRow[r] ** 2 / cell.leverage[r]);
        }
        all.push(row);
      }
    }
    if (!deletions) return;
    for (let r = 0; r < n; r++) {
      let top = -1e300, total = 0, centre = 0, spread = 0;
      for (const c of all) if (c.weight[r] > top) top = c.weight[r];
      for (const c of all) { const w = Math.exp(c.weight[r] - top); total += w; if (w) centre += w * c.slope[r]; }
      total = Math.max(total, 1e-300);
      centre /= total;
      for (const c of all) { const w = Math.exp(c.weight[r] - top); if (w) spread += w * (c.variance[r] + (c.slope[r] - centre) ** 2); }
      gone[r].push({ weight: top + Math.log(total), mean: centre, variance: spread / total });
    }
  };

  const mixtureQuantiles = (parts, most, tail) => {
    const kept = parts.slice().sort((a, b) => b.weight - a.weight).slice(0, k.KEPT);
    const total = logSum(kept.map((c) => c.weight));
    let middle = 0, sd = 0;
    for (const c of kept) { c.share = Math.exp(c.weight - total); middle += c.share * c.mean; }
    for (const c of kept) sd += c.share * (c.scale ** 2 + (c.mean - middle) ** 2);
    sd = Math.sqrt(sd);
    const fewest = kept.reduce((s, c) => Math.min(s, c.freedom), Infinity), top = kept.reduce((s, c) => Math.max(s, c.freedom), 0);
    const reach = 12 * Math.max(1, studentAt(fewest, 1 - tail) / 4) * sd;
    const below = (z) => {
      let s = 0;
      for (const c of kept) {
        const u = (z - c.mean) / c.scale;
        s += c.share * looked(u / Math.sqrt(c.freedom + u * u), tableOf(c.freedom === top ? top : top - 1));
      }
      return s;
    };
    const bisected = (short, low, high) => {
      for (let i = 0; i < k.HALVINGS; i++) {
        const z = 0.5 * (low + high);
        if (short(z)) low = z; else high = z;
      }
      return 0.5 * (low + high);
    };
    const ends = [tail, 0.5, 1 - tail].map((goal) => bisected((z) => below(z) < goal, middle - reach, middle + reach));
    const [lower, value, upper] = ends, sides = [value - lower, upper - value];
    const half = bisected((z) => below(value + z) - below(value - z) < 1 - 2 * tail, Math.min(...sides), Math.max(...sides));
    return { ends, half, sd };
  };

  const median = (values) => {
    const s = Array.from(values).sort((a, b) => a - b), h = s.length >> 1;
    return s.length % 2 ? s[h] : 0.5 * (s[h - 1] + s[h]);
  };

  const slopesOf = (d, y, stated, deletions = true) => {
    const n = d.n, centre = median(y);
    const size = y.reduce((s, v) => Math.max(s, Math.abs(v - centre)), 0) || 1;
    const scaled = y.map((v) => v / size), columns = grid(0, d.p, (q) => d.terms.map((row) => row[q]));
    const start = leastSquares(columns, scaled);
    const rest = scaled.map((v, i) => v - dot(d.terms[i], start, d.p));
    const nu = n - d.flat + (stated === null ? 0 : k.STATED_FREEDOM);
    const floor = n * k.ROUNDING ** 2 + (stated === null ? 0 : k.STATED_FREEDOM * stated / size ** 2);
    const least = stated === null ? 0 : stated / size ** 2;
    const check = deletions && n - d.flat >= 3;
    const main = { weight: [], mean: [], variance: [], noise: [] }, gone = grid(0, n, () => []);
    for (const m of d.members) evaluate(m, d, start, rest, nu, floor, least, check, main, gone);
    const evidence = logSum(main.weight), weights = main.weight.map((w) => Math.exp(w - evidence));
    let noise = 0, middle = 0;
    weights.forEach((w, i) => { noise += w * main.noise[i]; middle += w * main.mean[i]; });
    noise = Math.sqrt(noise);
    const tail = Math.min(Math.max(k.TAIL + k.TAIL_PER_DECADE * Math.log10(100 * Math.max(noise, k.ROUNDING)), k.TAILS[0]), k.TAILS[1]);
    const unit = size / d.largest;
    let wrong = new Array(n).fill(0), without = new Array(n).fill(NaN), parts;
    if (check) {
      const each = gone.map((list) => logSum(list.map((g) => g.weight)));
      const odds = [evidence + n * Math.log1p(-k.WRONG), ...each.map((e) => e + k.POWER * Math.log(0.5) + Math.log(k.WRONG))];
      const total = logSum(odds);
      for (let i = 0; i <= n; i++) odds[i] -= total;
      wrong = odds.slice(1).map(Math.exp);
      without = gone.map((list, i) => list.reduce((s, g) => s + Math.exp(g.weight - each[i]) * g.mean, 0) * unit);
      parts = main.weight.map((w, i) => ({ weight: w - evidence + odds[0], mean: main.mean[i], scale: Math.sqrt(main.variance[i]), freedom: nu }));
      gone.forEach((list, i) => list.forEach((g) => parts.push({ weight: g.weight - each[i] + odds[i + 1], mean: g.mean, scale: Math.sqrt(g.variance), freedom: nu - 1 })));
    } else {
      parts = main.weight.map((w, i) => ({ weight: w, mean: main.mean[i], scale: Math.sqrt(main.variance[i]), freedom: nu }));
    }
    const { ends, half, sd } = mixtureQuantiles(parts, nu, tail);
    const reached = d.free && oneSigned(d, scaled, stated === null ? 0 : k.STATED_FREEDOM, noise, floor, least) || [Infinity, -Infinity];
    const [low, high] = [Math.min(ends[0], reached[0]), Math.max(ends[2], reached[1])];
    const u95 = Math.max(half, reached[1] - ends[1], ends[1] - reached[0]);
    return { lower: low * unit, value: ends[1] * unit, upper: high * unit, u95: u95 * unit, sd: sd * unit, noise: noise * size, mean: middle * unit, wrong, without, weights };
  };

  // Rows that count, their relative variance and what is to be said of them.
  const rowsOf = (x, y, se, odd) => {
    let variance = null, stated = null;
    const usable = se ? se.filter((s) => Number.isFinite(s) && s > 0) : [];
    if (usable.length) {
      const middle = median(usable);
      variance = se.map((s) => Math.min(Math.max((Number.isFinite(s) && s > 0 ? s : middle) / middle, 1e-2), 1e2) ** 2);
      stated = middle ** 2;
    }
    const seen = new Set(), pairs = new Set(x.map((v, i) => `${v + 0}/${y[i] + 0}`));
    const again = x.map((v, i) => {
      const key = `${v + 0}/${y[i] + 0}/${variance ? variance[i] : ""}`;
      if (seen.has(key)) return true;
      seen.add(key);
      return false;
    });
    const off = x.map((v, i) => i).filter((i) => !again[i] || true).filter((i) => x[i] !== 0);
    let mirrored = off.length > 2 && off.every((i) => pairs.has(`${-x[i]}/${-y[i] + 0}`));
    if (odd) {
      const kept = x.filter((v) => v > 0).length >= x.filter((v) => v < 0).length ? 1 : -1;
      const there = new Set(x.map((v, i) => (v * kept > 0 ? `${v}/${y[i] + 0}` : "")));
      x.forEach((v, i) => { if (v * kept < 0 && there.has(`${-v}/${-y[i] + 0}`)) again[i] = true; });
      mirrored = false;
    }
    return { variance, stated, used: again.map((a) => !a), mirrored };
  };

  const estimate = (x, y, se, { odd = false, without = [] } = {}) => {
    const rows = rowsOf(x, y, se, odd), used = rows.used.slice(), n = x.length, removed = [];
    const wrong = new Array(n).fill(0), apart = new Array(n).fill(NaN);
    let withAll = NaN, design, many, kept;
    for (;;) {
      kept = x.map((_, i) => i).filter((i) => used[i]);
      const settings = new Set(kept.map((i) => x[i] + 0)).size;
      if (settings < 3 || !x.some((v) => v !== 0)) {
        return { status: "too few settings", reason: `${settings} different settings, at least 3 are needed`, used, wrong, removed, design: null };
      }
      const at = (values) => kept.map((i) => values[i]);
      design = prepare(at(x), rows.variance && at(rows.variance), { odd, without });
      many = slopesOf(design, at(y), rows.stated);
      kept.forEach((i, j) => { wrong[i] = many.wrong[j]; apart[i] = many.without[j]; });
      let worst = kept[0];
      for (const i of kept) if (wrong[i] > wrong[worst]) worst = i;
      if (wrong[worst] <= k.REMOVE || removed.length >= Math.max(1, Math.floor(n / 6)) || kept.length <= k.FEWEST) break;
      if (!removed.length) withAll = slopesOf(design, at(y), rows.stated, false).value;
      used[worst] = false;
      removed.push(worst);
    }
    const value = many.value, widen = rows.mirrored ? Math.SQRT2 : 1;
    const lower = value + widen * (many.lower - value), upper = value + widen * (many.upper - value), u95 = widen * many.u95;
    const status = removed.length ? "a wrong point was left out" : Math.abs(value) <= u95 ? "the sign is open" : "ok";
    return {
      value, lower, upper, u95, sd: widen * many.sd, status, reason: "", noise: many.noise, wrong, without: apart,
      used, removed, withAll: removed.length ? withAll : value, design, y: kept.map((i) => y[i]), weights: many.weights,
    };
  };

  // How much each used reading moves the slope, at the present weights.
  const byRow = (found) => {
    const d = found.design, out = new Float64Array(d.n), sum = new Float64Array(d.p), white = new Float64Array(d.n);
    let at = 0;
    for (const m of d.members) {
      sum.fill(0);
      for (const cell of m.cells) { const w = found.weights[at++]; for (let q = 0; q < d.p; q++) sum[q] += w * cell.inverse[q * d.p + 1]; }
      white.fill(0);
      for (let q = 0; q < d.p; q++) for (let i = 0; i < d.n; i++) white[i] += sum[q] * m.columns[q][i];
      for (let r = 0; r < d.n; r++) for (let i = r; i < d.n; i++) out[r] += white[i] * m.root[i * d.n + r];
    }
    return Array.from(out, (v) => v / d.largest);
  };

  // The fitted curve and the half-width of its 95 % band.
  const curve = (found, at) => {
    const d = found.design, { n, p } = d, to = at.map((v) => v / d.largest), y = found.y, nu = n - d.flat;
    const places = [];
    for (const m of d.members) for (const cell of m.cells) places.push([m, cell]);
    const order = found.weights.map((w, i) => i).sort((a, b) => found.weights[b] - found.weights[a]).slice(0, k.MOST_LIKELY);
    const whole = order.reduce((s, i) => s + found.weights[i], 0);
    const mean = new Float64Array(at.length), second = new Float64Array(at.length), kernels = new Map(), whites = new Map();
    const basis = to.map((t) => termsAt(t, d.even)), rest = new Float64Array(p), cross = new Float64Array(n), gap = new Float64Array(p);
    for (const i of order) {
      const share = found.weights[i] / whole, [m, cell] = places[i], inv = cell.inverse;
      if (!whites.has(m)) {
        const white = new Float64Array(n);
        for (let r = 0; r < n; r++) white[r] = dot(m.root.subarray(r * n, r * n + n), y, n);
        whites.set(m, white);
      }
      const b = new Float64Array(p), white = whites.get(m), left = new Float64Array(n);
      const away = () => { left.set(white); for (let q = 0; q < p; q++) for (let r = 0; r < n; r++) left[r] -= b[q] * m.columns[q][r]; };
      for (let round = 0; round < 2; round++) {
        away();
        for (let q = 0; q < p; q++) gap[q] = dot(m.columns[q], left, n) - cell.precision[q] * b[q];
        for (let q = 0; q < p; q++) for (let j = 0; j < p; j++) b[q] += inv[q * p + j] * gap[j];
      }
      away();
      let variance = dot(left, left, n);
      for (let q = 0; q < p; q++) variance += cell.precision[q] * b[q] * b[q];
      variance /= nu;
      if (m.smooth && !kernels.has(m)) {
        kernels.set(m, to.map((z) => {
          const raw = d.t.map((s) => m.size ** 2 * m.smooth(z, s)), out = new Float64Array(n);
          for (let r = 0; r < n; r++) { let s = 0; for (let c = 0; c <= r; c++) s += m.root[r * n + c] * raw[c]; out[r] = s; }
          return { cross: out, own: m.size ** 2 * m.smooth(z, z) };
        }));
      }
      for (let j = 0; j < at.length; j++) {
        const known = m.smooth ? kernels.get(m)[j] : null;
        if (known) cross.set(known.cross); else cross.fill(0);
        let centre = dot(cross, left, n), spread = known ? known.own - dot(cross, cross, n) : 0;
        for (let q = 0; q < p; q++) { rest[q] = basis[j][q] - dot(cross, m.columns[q], n); centre += basis[j][q] * b[q]; }
        for (let q = 0; q < p; q++) for (let c = 0; c < p; c++) spread += rest[q] * inv[q * p + c] * rest[c];
        mean[j] += share * centre;
        second[j] += share * (variance * spread + centre * centre);
      }
    }
    const factor = studentAt(nu, 0.975);
    return { mean: Array.from(mean), half: Array.from(mean, (v, j) => factor * Math.sqrt(Math.max(second[j] - v * v, 0))) };
  };

  return { estimate, byRow, curve, studentBelow, studentAt };
};
