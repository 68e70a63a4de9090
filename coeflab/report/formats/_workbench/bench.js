"use strict";
// From an edit to value, U95, G_h and the terms of the force law, as coeflab/fits and coeflab/vehicle/stability.py have them.
const benchOf = (data) => {
  // np.interp and np.gradient of one curve.
  const interpolated = (at, x, y) => {
    if (at <= x[0]) return y[0];
    for (let i = 0; i + 1 < x.length; i++) if (at <= x[i + 1]) return y[i] + (y[i + 1] - y[i]) / (x[i + 1] - x[i]) * (at - x[i]);
    return y[y.length - 1];
  };
  const gradient = (y, x) => y.map((_, i) => {
    if (i === 0) return (y[1] - y[0]) / (x[1] - x[0]);
    if (i === y.length - 1) return (y[i] - y[i - 1]) / (x[i] - x[i - 1]);
    const a = x[i] - x[i - 1], b = x[i + 1] - x[i];
    return -b / (a * (a + b)) * y[i - 1] + (b - a) / (a * b) * y[i] + a / (b * (a + b)) * y[i + 1];
  });

  const isUntouched = (edit) => !edit || (edit.limit === null && edit.dropped === null);
  const asFound = (index) => {
    const s = data.sweeps[index], b = s.base;
    return {
      index, kept: s.x.map((_, i) => i), value: s.value, fit: b.fit, random: b.random, at: b.at, curve: b.curve, half: b.half,
      misfit: new Map(s.labels.map((label, i) => [label, b.misfit[i]])), removed: b.removed, reason: b.reason, status: "",
    };
  };
  const choiceOf = (index, edit) => data.sweeps[index].choices.find((c) => c.limit === edit.limit && c.dropped === edit.dropped);
  const fitted = (index, edit) => {
    if (isUntouched(edit)) return asFound(index);
    const s = data.sweeps[index], found = choiceOf(index, edit), middle = (data.nodes - 1) / 2;
    if (found.value === null) return { ...found, index, u95: null };
    const at = found.curve.map((_, i) => found.reach * (i / middle - 1));
    return { ...found, index, u95: null, at, misfit: new Map(found.kept.map((i, j) => [s.labels[i], found.misfit[j]])) };
  };

  // A sweep's value as a function of input errors, the curve held fixed.
  const perturbed = (one) => {
    const s = data.sweeps[one.index], moment = "KMN".includes(s.component), rate = "pqr".includes(s.variable), middle = (data.nodes - 1) / 2;
    let moved = new Array(data.nodes).fill(0);
    if (!rate) { const g = gradient(one.curve, one.at); moved = g.map((v) => v - g[middle]); }
    return (error) => {
      const plus = (name) => 1 + (error[name] || 0);
      const across = rate ? plus("rate") * plus("length") / plus("speed") : 1;
      const up = plus(moment ? "moment" : "force") / (plus("density") * plus("speed") ** 2 * plus("length") ** (moment ? 3 : 2));
      let offset = rate ? 0 : -(error.angle || 0);
      if ("vw".includes(s.variable)) offset = Math.sin(offset);
      return up / across * (one.value + interpolated(offset, one.at, moved));
    };
  };
  const sensitivities = (campaign, fits) => {
    const { inputs, sweeps, first, second } = campaign, names = Object.keys(inputs), out = sweeps.map(() => ({}));
    if (!names.length) return out;
    const each = fits.map((f) => (f.value === null ? null : perturbed(f)));
    const values = (error) => {
      const about = each.map((f) => (f ? f(error) : 0)), dx = error.reference_point || 0;
      return about.map((value, i) => {
        let a = 0, b = 0;
        about.forEach((other, j) => { a += other * first[i][j]; b += other * second[i][j]; });
        return value + dx * a + dx * dx * b;
      });
    };
    const nominal = values({});
    for (const name of names) {
      const step = 0.01 * inputs[name], up = values({ [name]: step }), down = values({ [name]: -step });
      sweeps.forEach((_, i) => {
        const g = (up[i] - down[i]) / (2 * step);
        out[i][name] = Math.abs(g * inputs[name]) > 1e-9 * Math.abs(nominal[i]) ? g : 0;
      });
    }
    return out;
  };

  // Every coefficient of a campaign with its U95, and their covariance.
  const campaignOf = (name, edits) => {
    const campaign = data.campaigns[name], fits = campaign.sweeps.map((i) => fitted(i, edits[i])), moves = sensitivities(campaign, fits);
    const rows = fits.map((f, i) => {
      const s = data.sweeps[f.index];
      if (f.value === null) return { ...f, parts: [] };
      const form = Math.sqrt(Math.max(f.fit ** 2 - f.random ** 2, 0)), parts = [["scatter", f.random], ["model form", form]];
      for (const [part, share] of s.studies) parts.push([part, share * Math.abs(f.value)]);
      for (const [input, g] of Object.entries(moves[i])) if (g) parts.push([input.replace("_", " "), Math.abs(g) * campaign.inputs[input]]);
      return { ...f, parts, moves: moves[i], u95: Math.sqrt(parts.reduce((sum, [, half]) => sum + half * half, 0)) };
    });
    const covariance = rows.map((a, i) => rows.map((b, j) => {
      if (a.value === null || b.value === null) return NaN;
      const one = data.sweeps[a.index], other = data.sweeps[b.index];
      let out = 0;
      if (i === j) out = (a.fit / 2) ** 2;
      else if (one.readings === other.readings) {
        let both = 0, left = 0, right = 0;
        for (const v of a.misfit.values()) left += v * v;
        for (const [label, v] of b.misfit) { right += v * v; both += v * (a.misfit.get(label) || 0); }
        const size = Math.sqrt(left) * Math.sqrt(right);
        if (size > 0) out = both / size * a.random * b.random / 4;
      }
      for (const [input, half] of Object.entries(campaign.inputs)) out += a.moves[input] * b.moves[input] * half * half / 4;
      for (const [part, share, id] of one.studies) {
        const same = other.studies.find((t) => t[0] === part && t[2] === id);
        if (same) out += share * a.value * same[1] * b.value / 4;
      }
      return out;
    }));
    return { rows, covariance };
  };

  const indexOf = (index, campaigns) => {
    const values = index.values.slice(), cells = index.covariance.map((row) => row.map((v) => (v === null ? NaN : v)));
    const live = index.sources.map((s) => {
      if (s < 0) return null;
      const name = data.sweeps[s].campaign, i = data.campaigns[name].sweeps.indexOf(s);
      return { campaign: campaigns[name], name, i };
    });
    live.forEach((a, i) => {
      if (!a) return;
      values[i] = a.campaign.rows[a.i].value;
      live.forEach((b, j) => { if (b && b.name === a.name) cells[i][j] = a.campaign.covariance[a.i][b.i]; });
    });
    const lost = values.findIndex((v) => v === null);
    if (lost >= 0) return { name: index.name, value: null, u95: null, sense: "no value", why: `${index.symbols[lost]} has no value` };
    const [slopeForce, lever, rateForce, rateMoment] = values, a = rateForce - index.mass, b = rateMoment - index.moment;
    const product = lever * a / (slopeForce * b), value = 1 - product;
    const g = [product / slopeForce, -a / (slopeForce * b), -lever / (slopeForce * b), product / b];
    const out = { name: index.name, value, u95: null, why: "" }, bounded = cells.every((row) => row.every(Number.isFinite));
    const damping = [[index.symbols[0], slopeForce, 2 * Math.sqrt(cells[0][0])], [`${index.symbols[3]} - xG'm'`, b, 2 * Math.sqrt(cells[3][3])]];
    const driven = damping.find(([, size]) => size >= 0), open = bounded ? damping.find(([, size, half]) => Math.abs(size) <= half) : null;
    const bare = index.symbols.filter((_, i) => !Number.isFinite(cells[i][i]));
    if (!bounded) out.why = `no U95: ${bare.length ? bare.join(", ") : index.symbols.join(", ")} ${bare.length === 1 ? "has" : "have"} none`;
    else if (open) out.why = `no U95: U95 of ${open[0]} includes zero`;
    else {
      let variance = 0;
      g.forEach((x, i) => g.forEach((y, j) => { variance += x * cells[i][j] * y; }));
      out.u95 = 2 * Math.sqrt(Math.max(variance, 0));
    }
    if (driven) out.why = `${driven[0]} is not below zero: the sign of ${index.name} is no criterion`;
    const decided = !driven && (out.u95 === null || Math.abs(value) > out.u95);
    const words = `${value > 0 ? "stable" : "unstable"}${index.name === "G_v" ? " at high speed" : ""}`;
    out.sense = decided ? words + (out.u95 === null ? ", no U95" : "") : driven ? "no verdict" : "sign open";
    return out;
  };

  const coefficientsOf = (vehicle, campaigns) => {
    const out = vehicle.law.coefficient.slice();
    for (const [term, source, factor] of vehicle.links) {
      const name = data.sweeps[source].campaign, row = campaigns[name].rows[data.campaigns[name].sweeps.indexOf(source)];
      if (row.value === null) return { lost: data.sweeps[source].symbol };
      out[term] += factor * (row.value - data.sweeps[source].value);
    }
    return { out };
  };

  // Everything that a file's answer needs; `edits` by index of the sweep.
  const answer = (edits) => {
    const campaigns = {};
    for (const name of Object.keys(data.campaigns)) campaigns[name] = campaignOf(name, edits);
    return campaigns;
  };
  const motion = (vehicle, campaigns, told) => {
    const { out, lost } = coefficientsOf(vehicle, campaigns);
    return lost ? { lost } : zigzagOf(vehicle, out, told);
  };
  // What a page shows of one coefficient: its row now and as the study has it, and the indices of every file.
  const view = (edits, index) => {
    const campaigns = answer(edits), before = answer({}), name = data.sweeps[index].campaign, at = data.campaigns[name].sweeps.indexOf(index);
    const found = { row: campaigns[name].rows[at], before: before[name].rows[at] };
    return { campaigns, ...found, indices: data.files.map((f) => f.indices.map((i) => [indexOf(i, campaigns), indexOf(i, before)])) };
  };
  return { fitted, choiceOf, isUntouched, view, campaignOf, answer, indexOf, coefficientsOf, motion };
};
