"use strict";
// A zigzag by the fixed-step march of coeflab/motion: the same rates, steps, crossings and figures.
const zigzagOf = (v, coefficients, told = () => {}) => {
  const NEAR = 1e-9, SLOWEST = 1e-9, FLAT = 1e-12, SLACK = 1e-6, MOVING = 1e-3, SECANTS = 8, UNCOVERED = "no data cover it";
  const ANGLES = { dr: "rudder angle", ds: "stern plane angle", db: "bow plane angle" };
  const law = v.law, many = law.source.length, offset = 1 + law.powers.length, pool = new Float64Array(offset + 2 * many);
  const total = new Float64Array(9), angled = law.angled;

  const force = (s, angles) => {
    const speed = Math.sqrt(s[7] * s[7] + s[8] * s[8] + s[9] * s[9]), slow = Math.max(speed, SLOWEST);
    const alpha = angled ? Math.atan2(s[9], s[7]) : 0;
    const beta = angled && speed > 0 ? Math.asin(Math.min(Math.max(s[8] / speed, -1), 1)) : 0;
    const base = [s[7], s[8], s[9], s[10], s[11], s[12], angles[0], angles[1], angles[2], speed, alpha, beta];
    pool[0] = 1;
    law.powers.forEach((n, i) => { pool[1 + i] = n === 1 ? speed : n === 2 ? speed * speed : slow ** n; });
    for (let i = 0; i < many; i++) {
      let value = base[law.source[i]];
      if (law.prime[i]) value = value * law.prime[i] / slow;
      if (law.low[i] !== null && value < law.low[i]) value = law.low[i];
      if (law.high[i] !== null && value > law.high[i]) value = law.high[i];
      pool[offset + i] = value;
      pool[offset + many + i] = Math.abs(value);
    }
    total.fill(0);
    for (let t = 0; t < coefficients.length; t++) {
      let product = coefficients[t];
      for (const row of law.rows[t]) product *= pool[row];
      total[law.component[t]] += product;
    }
    if (angled) {
      const ca = Math.cos(alpha), sa = Math.sin(alpha), cb = Math.cos(beta), sb = Math.sin(beta), [d, y, l] = total.subarray(6);
      total[0] += -ca * cb * d - ca * sb * y + sa * l;
      total[1] += -sb * d + cb * y;
      total[2] += -sa * cb * d - sa * sb * y - ca * l;
    }
    return total;
  };
  const rates = (s, angles, wrench, inverse = v.inverse) => {
    const [w, x, y, z] = s.subarray(3, 7), [U, V, W, p, q, r] = s.subarray(7, 13), out = new Float64Array(14);
    const ax = 1 - 2 * (y * y + z * z), ay = 2 * (x * y + w * z), az = 2 * (x * z - w * y);
    const bx = 2 * (x * y - w * z), by = 1 - 2 * (x * x + z * z), bz = 2 * (y * z + w * x);
    const cx = 2 * (x * z + w * y), cy = 2 * (y * z - w * x), cz = 1 - 2 * (x * x + y * y);
    out[0] = ax * U + bx * V + cx * W;
    out[1] = ay * U + by * V + cy * W;
    out[2] = az * U + bz * V + cz * W;
    out[3] = -0.5 * (x * p + y * q + z * r);
    out[4] = 0.5 * (w * p + y * r - z * q);
    out[5] = 0.5 * (w * q + z * p - x * r);
    out[6] = 0.5 * (w * r + x * q - y * p);
    const turning = ax * (r * by - q * cy) - ay * (r * bx - q * cx), flat = ax * ax + ay * ay, all = force(s, angles);
    const [lx, ly, lz] = v.lever, e = v.excess;
    const weight = [e * az, e * bz, e * cz, ly * cz - lz * bz, lz * az - lx * cz, lx * bz - ly * az];
    for (let i = 0; i < 6; i++) all[i] += wrench[i] + weight[i];
    for (const [i, j, k, entry] of v.quadratics) all[i] += entry * s[7 + j] * s[7 + k];
    for (let i = 0; i < 6; i++) { let a = 0; for (let j = 0; j < 6; j++) a += inverse[i][j] * all[j]; out[7 + i] = a; }
    out[13] = flat > FLAT ? turning / flat : 0;
    return out;
  };

  // Orders: null stands for an angle that follows at once.
  const o = v.orders;
  const reach = (begin, target) => [0, 1, 2].map((i) => (o.rate[i] === null ? 0 : Math.abs(target[i] - begin[i]) / o.rate[i]));
  const ramp = (begin, target, since) => {
    const all = reach(begin, target), t = Math.max(since, 0);
    return [0, 1, 2].map((i) => (all[i] > t ? begin[i] + (target[i] - begin[i]) * (t / all[i]) : target[i]));
  };
  const march = () => {
    const h = v.step, count = o.longest.length, steps = Math.ceil(o.longest.reduce((a, b) => a + b, 0) / h - NEAR);
    let state = Float64Array.from(v.start), phase = 0, begun = 0, begin = o.begin, live = true, ended = 0, endTime = 0;
    const levelOf = (s, p) => (o.watched[p] ? o.sign[p] * (s[13] - o.value[p]) : 1);
    const step = (since, length) => {
      const target = o.angles[phase], wrench = o.wrench[phase];
      const add = (k, f) => { const s = Float64Array.from(state); for (let i = 0; i < 14; i++) s[i] += f * k[i]; return s; };
      const middle = ramp(begin, target, since + 0.5 * length);
      const k1 = rates(state, ramp(begin, target, since), wrench), k2 = rates(add(k1, 0.5 * length), middle, wrench);
      const k3 = rates(add(k2, 0.5 * length), middle, wrench), k4 = rates(add(k3, length), ramp(begin, target, since + length), wrench);
      const s = Float64Array.from(state);
      for (let i = 0; i < 14; i++) s[i] += length / 6 * (k1[i] + 2 * (k2[i] + k3[i]) + k4[i]);
      const norm = Math.sqrt(s[3] * s[3] + s[4] * s[4] + s[5] * s[5] + s[6] * s[6]);
      for (let i = 3; i < 7; i++) s[i] /= norm;
      return s;
    };
    const out = { records: [[0, Float64Array.from(state)]], switches: [], states: [], met: [] };
    let level = levelOf(state, 0);
    const stop = (how, when) => { live = false; ended = how; endTime = when; };
    for (let j = 1; j <= steps && live; j++) {
      if (j % 250 === 0) told(j / steps);
      let remain = h;
      while (remain > 0) {
        const until = j * h, left = remain, since = until - left - begun, room = o.longest[phase] - since;
        let length = Math.min(left, room);
        for (const kink of reach(begin, o.angles[phase])) if (kink - since > NEAR * h) length = Math.min(length, kink - since);
        let trial = step(since, length), here = levelOf(trial, phase);
        const crossed = level < 0 && here >= 0;
        if (crossed) {
          let a = 0, atA = level, b = length, atB = here, side = 0;
          for (let i = 0; i < SECANTS; i++) {
            length = Math.min(Math.max(atB > atA ? (a * atB - b * atA) / (atB - atA) : b, a), b);
            trial = step(since, length);
            const now = levelOf(trial, phase);
            if (now < 0) { if (side < 0) atB *= 0.5; atA = now; a = length; side = -1; }
            else { if (side > 0) atA *= 0.5; atB = now; b = length; side = 1; }
          }
          here = 0;
        }
        if (!trial.every(Number.isFinite)) { stop(1, until - left); break; }
        state = trial;
        level = here;
        remain = length >= left ? 0 : left - length;
        const now = until - left + length, speed = Math.sqrt(state[7] ** 2 + state[8] ** 2 + state[9] ** 2);
        if (speed > v.fastest) { stop(2, now); break; }
        if (crossed || room - length <= NEAR * h) {
          out.switches.push(now);
          out.states.push(Float64Array.from(state));
          out.met.push(crossed);
          if (phase + 1 === count) { stop(0, now); break; }
          begin = ramp(begin, o.angles[phase], now - begun);
          phase += 1;
          begun = now;
          level = levelOf(state, phase);
        }
      }
      if (live || (endTime >= j * h - NEAR * h && ended === 0)) out.records.push([j * h, Float64Array.from(state)]);
    }
    const rows = [...out.records, ...out.switches.map((t, i) => [t, out.states[i]]), [endTime, state]];
    const sorted = rows.map((r, i) => [r, i]).sort((a, b) => a[0][0] - b[0][0] || a[1] - b[1]).map((r) => r[0]);
    const gap = NEAR * Math.max(steps * h, 1) / (steps + 1);
    const kept = sorted.filter((r, i) => i === 0 || r[0] - sorted[i - 1][0] > gap);
    return { ...out, ended, count, time: kept.map((r) => r[0]), state: kept.map((r) => r[1]) };
  };

  // What the file lacks for a steady turn, and where the motion leaves the data.
  const lacking = (limit) => {
    if (limit.limited) return "";
    const n = limit.at.length, matrix = limit.at.map(() => new Array(n).fill(0)), start = Float64Array.from(v.start);
    start.set([1, 0, 0, 0], 3);
    start.fill(0, 8, 13);
    const none = [0, 0, 0], still = [0, 0, 0, 0, 0, 0];
    limit.at.forEach((j, c) => {
      const size = 1e-5 * limit.scale[c], up = Float64Array.from(start), down = Float64Array.from(start);
      up[7 + j] += size;
      down[7 + j] -= size;
      const a = rates(up, none, still, limit.inverse), b = rates(down, none, still, limit.inverse);
      limit.at.forEach((i, r) => { matrix[r][c] = (a[7 + i] - b[7 + i]) / (2 * size); });
    });
    let growth = n ? matrix[0][0] : 0;
    if (n === 2) {
      const [[a, b], [c, d]] = matrix, half = 0.5 * (a + d), root = 0.25 * (a - d) ** 2 + b * c;
      growth = half + (root > 0 ? Math.sqrt(root) : 0);
    }
    return growth <= 0 ? "" : limit.words;
  };
  const flagsOf = (m) => {
    const out = new Map(), n = m.time.length, names = v.motions;
    const dr = m.time.map((t, i) => m.controls[i]);
    const valueOf = (name, i) => {
      if (v.controls.includes(name)) return dr[i][["dr", "ds", "db"].indexOf(name)];
      const s = m.state[i], speed = Math.max(Math.sqrt(s[7] ** 2 + s[8] ** 2 + s[9] ** 2), SLOWEST);
      const angle = name.startsWith("asin("), motion = angle ? name[5] : name[0], at = names.indexOf(motion);
      const prime = s[7 + at] / speed * ("pqr".includes(motion) ? v.length : 1);
      return angle ? Math.asin(Math.min(Math.max(prime, -1), 1)) : prime;
    };
    const readable = (name) => v.controls.includes(name) || /^[uvwpqr]'$/.test(name) || /^asin\([uvw]\/U\)$/.test(name);
    const spoken = new Set();
    for (const [name, ranges] of v.ranges) {
      if (!readable(name)) continue;
      spoken.add(v.controls.includes(name) ? name : name.startsWith("asin(") ? name[5] : name[0]);
      out.set(name, m.time.map((_, i) => { const x = valueOf(name, i); return !ranges.some(([a, b]) => x >= a - SLACK && x <= b + SLACK); }));
    }
    for (const name of [...names.slice(1).map((x) => `${x}'`), ...v.controls]) {
      if (spoken.has(name.replace("'", ""))) continue;
      const far = m.time.map((_, i) => Math.abs(valueOf(name, i)) > MOVING);
      if (far.some(Boolean)) out.set(`${name}: ${UNCOVERED}`, far);
    }
    out.set("astern", m.state.map((s) => s[7] < -SLACK * Math.max(Math.sqrt(s[7] ** 2 + s[8] ** 2 + s[9] ** 2), SLOWEST)));
    if (law.tabled.some(Boolean)) {
      out.set("beyond a table's edge", m.state.map((s, i) => {
        force(s, m.controls[i]);
        const speed = Math.max(Math.sqrt(s[7] ** 2 + s[8] ** 2 + s[9] ** 2), SLOWEST);
        const plain = [s[7], s[8], s[9], s[10], s[11], s[12], ...m.controls[i], speed, Math.atan2(s[9], s[7]), Math.asin(Math.min(Math.max(s[8] / speed, -1), 1))];
        return law.source.some((source, j) => {
          const x = plain[source] * (law.prime[j] ? law.prime[j] / speed : 1);
          return law.tabled[j] && ((law.low[j] !== null && x < law.low[j]) || (law.high[j] !== null && x > law.high[j]));
        });
      }));
    }
    return { out, n };
  };

  const crossing = (time, values, level, rises, after = -Infinity) => {
    const signed = values.map((x) => (rises ? x - level : level - x));
    for (let i = 0; i + 1 < time.length; i++) if (signed[i] < 0 && signed[i + 1] >= 0 && time[i + 1] > after) {
      return time[i] + signed[i] / (signed[i] - signed[i + 1]) * (time[i + 1] - time[i]);
    }
    return null;
  };
  const valueAt = (time, values, when) => {
    if (when <= time[0]) return values[0];
    for (let i = 0; i + 1 < time.length; i++) if (when <= time[i + 1]) {
      return values[i] + (values[i + 1] - values[i]) / (time[i + 1] - time[i]) * (when - time[i]);
    }
    return values[values.length - 1];
  };
  const extreme = (time, values, largest, after) => {
    const y = largest ? values : values.map((x) => -x);
    for (let i = 1; i + 1 < y.length; i++) if (y[i] >= y[i - 1] && y[i] > y[i + 1] && time[i] > after) {
      const p = time[i - 1] - time[i], q = time[i + 1] - time[i];
      const a = ((y[i - 1] - y[i]) / p - (y[i + 1] - y[i]) / q) / (p - q), b = (y[i - 1] - y[i]) / p - a * p;
      const shift = a < 0 ? Math.min(Math.max(-b / (2 * a), p), q) : 0, height = y[i] + b * shift + a * shift * shift;
      return [time[i] + shift, largest ? height : -height];
    }
    return null;
  };

  const m = march(), last = m.time[m.time.length - 1];
  m.controls = m.time.map((t) => {
    let begin = o.begin, since = 0;
    for (let k = 0; k < m.count; k++) {
      const end = m.switches[k];
      if (end === undefined || k + 1 === m.count || t < end) return ramp(begin, o.angles[k], t - since);
      begin = ramp(begin, o.angles[k], end - since);
      since = end;
    }
    return begin;
  });
  const { out: flags } = flagsOf(m), missing = v.limits.map((l) => [l.rate, lacking(l)]);
  const turn = (missing.find(([rate]) => rate === "r") || ["", ""])[1];
  const decisive = (names, rate) => names.filter((n) => !n.endsWith(UNCOVERED) || n === `${rate}': ${UNCOVERED}`);
  const judged = (name, value, unit, when) => {
    if (value === null) return { name, value, unit, status: "not reached", why: `not within ${Number(last.toPrecision(6))} s` };
    const names = [...flags].filter(([, f]) => f.some((x, i) => x && m.time[i] <= when)).map(([n]) => n);
    if (!names.length) return { name, value, unit, status: "ok", why: "" };
    const bare = names.filter((n) => n.endsWith(UNCOVERED)), left = names.filter((n) => !n.endsWith(UNCOVERED));
    const said = (all) => all.map((n) => ANGLES[n] || n).join(", ");
    const beyond = [left.length ? `beyond the data in ${said(left)}` : "", bare.length ? `no data on ${said(bare.map((n) => n.slice(0, -2 - UNCOVERED.length)))}` : ""].filter(Boolean).join("; ");
    if (turn && decisive(names, "r").length) return { name, value: null, unit, status: "not determined", why: left.length ? `beyond the data in ${said(left)}; ${turn}` : turn };
    return { name, value, unit, status: "extrapolated", why: beyond };
  };
  const psi = m.state.map((s) => s[13]), north = m.state.map((s) => s[0]), reached = (i) => (m.met[i] ? m.switches[i] : null);
  const first = reached(0), figures = [judged("initial turning time", first, "s", first)];
  figures.push(judged("initial turning distance", first === null ? null : valueAt(m.time, north, first), "m", first));
  for (const [i, word] of [[1, "first"], [2, "second"]]) {
    const begins = reached(i - 1), peak = begins === null ? null : extreme(m.time, psi, i === 1, begins);
    figures.push(judged(`${word} overshoot`, peak === null ? null : Math.abs(peak[1]) - v.execute, "rad", peak && peak[0]));
  }
  const back = first === null ? null : crossing(m.time, psi, 0, false, first);
  const again = back === null ? null : crossing(m.time, psi, 0, true, back);
  const third = again === null ? null : crossing(m.time, psi, 0, false, again);
  figures.push(judged("reach", back, "s", back));
  figures.push(judged("period", third === null || back === null ? null : third - back, "s", third));
  let determined = Infinity, why = "";
  for (const [rate, words] of missing) if (words && determined === Infinity) {
    const left = decisive([...flags].filter(([, f]) => f.includes(true)).map(([n]) => n), rate);
    if (left.some((n) => n.endsWith(UNCOVERED))) { determined = 0; why = words; }
    else if (left.length) { determined = m.time[Math.min(...left.map((n) => flags.get(n).indexOf(true)))]; why = words; }
  }
  return { time: m.time, state: m.state, controls: m.controls, figures, determined, why, ended: m.ended, switches: m.switches };
};
