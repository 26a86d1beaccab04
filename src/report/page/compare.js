// SPDX-License-Identifier: Apache-2.0
// Comparison of two runs: key results, one channel of both, difference of the heights at the end.
(function () {
  'use strict';
  const navvy = window.navvy = window.navvy || {};
  const {el} = navvy;

  function difference(a, b, unit) {
    if (!navvy.isNumber(a) || !navvy.isNumber(b)) return [navvy.quantity(undefined), ''];
    const share = a !== 0 ? navvy.signed(100 * (b - a) / Math.abs(a), 1) : '';
    const cell = navvy.resultValue(b - a, unit);
    const value = cell.querySelector('.value');
    if (b > a) value.textContent = '+' + value.textContent;
    return [cell, share];
  }

  function results([a, b]) {
    if (!a.summary || !b.summary)
      return navvy.absent(`Run ${a.summary ? 'B' : 'A'} has no summary.json, so results cannot ` +
                          'be compared.');
    const rows = [];
    for (const [, label, unit, read] of navvy.resultRows()) {
      const x = read(a.summary), y = read(b.summary);
      if (!navvy.isNumber(x) && !navvy.isNumber(y)) continue;
      rows.push([label, navvy.resultValue(x, unit), navvy.resultValue(y, unit),
                 ...difference(x, y, unit)]);
    }
    return navvy.table(['Quantity'].concat(['A', 'B', 'B \u2212 A', 'in % of A'].map(
      text => ({text, numeric: true}))), rows, {id: 'differences'});
  }

  // Rising times of both runs, each once.
  function mergedTimes(a, b) {
    const all = Float64Array.from([...a, ...b]).sort();
    return all.filter((time, i) => i === 0 || time !== all[i - 1]);
  }

  // Values at the merged times; NaN where this run has no sample.
  function spread(times, own, values) {
    const out = new Float32Array(times.length).fill(NaN);
    for (let i = 0, k = 0; i < times.length && k < own.length; ++i)
      if (times[i] === own[k]) out[i] = values[k++];
    return out;
  }

  class Overlay {
    constructor(runs, names) {
      this.runs = runs;
      this.host = el('div', {class: 'charts one'});
      this.element = el('div', {class: 'block'}, el('h3', null, 'One channel of both runs'),
        el('div', {class: 'controls'}, navvy.select('Channel', names.map(name => [name, name]),
                                                    name => this.show(name))), this.host);
      const payload = names.find(name => /\/payload$/.test(name)) || names[0];
      this.element.querySelector('select').value = payload;
      this.name = payload;
    }

    show(name) {
      this.name = name;
      if (this.chart) this.chart.destroy();
      const [a, b] = this.runs.map(run => run.telemetry);
      const own = [a.column(0), b.column(0)], times = mergedTimes(own[0], own[1]);
      const series = [a, b].map((telemetry, i) => {
        const one = navvy.channelChart(telemetry, telemetry.names.indexOf(name)).series[0];
        return {label: 'AB'[i], unit: one.unit, values: spread(times, own[i], one.values)};
      });
      this.chart = new navvy.Chart(this.host, {title: name, unit: series[0].unit, series, of: 2},
                                   times, {connect: true}).start();
    }
  }

  function sharedNames([a, b]) {
    if (!a.telemetry || !b.telemetry) return null;
    return a.telemetry.names.slice(1).filter(name => b.telemetry.names.indexOf(name) > 0);
  }

  // Says why the heights of two runs cannot be subtracted, or null.
  function gridsDiffer([a, b]) {
    if (!a.grid || !b.grid) return `run ${a.grid ? 'B' : 'A'} has no readable heights`;
    const size = grid => `${grid.nx} \u00d7 ${grid.ny} columns of ${grid.cell_m} m`;
    if (size(a.grid) !== size(b.grid))
      return `A has ${size(a.grid)} and B has ${size(b.grid)}`;
    if (a.grid.origin_m.some((value, i) => Math.abs(value - b.grid.origin_m[i]) > 1e-6))
      return 'their sites lie at different places';
    return null;
  }

  function union(p, q) {
    return {x0: Math.min(p.x0, q.x0), y0: Math.min(p.y0, q.y0),
            x1: Math.max(p.x1, q.x1), y1: Math.max(p.y1, q.y1)};
  }

  class DifferenceMap {
    constructor([a, b], body) {
      this.a = a.ground.heights(Infinity).values;
      this.b = b.ground.heights(Infinity).values;
      let most = 0;
      for (let k = 0; k < this.a.length; ++k)
        most = Math.max(most, Math.abs(this.b[k] - this.a[k]));
      this.most = most;
      this.limit = navvy.niceAbove(Math.max(0.02, most));
      const view = el('div', {class: 'view'});
      this.side = el('div', {class: 'side'});
      body.append(el('div', {class: 'with-side'}, view, this.side));
      this.map = new navvy.MapView(view, a.grid,
                                   union(navvy.activeRegion(a), navvy.activeRegion(b)));
    }

    draw() {
      const {a, b} = this;
      navvy.clear(this.side).append(navvy.scaleBar(this.limit, 'B below A', 'B above A'),
        el('p', {class: 'muted'}, `Largest difference ${navvy.fixed(this.most, 3)} m.`));
      this.map.draw({limit: this.limit, value: k => b[k] - a[k], height: k => b[k],
        text: k => `A ${navvy.fixed(a[k], 3)} m, B ${navvy.fixed(b[k], 3)} m, B \u2212 A ` +
          `${navvy.signed(b[k] - a[k], 3)} m`});
    }
  }

  // Shows the section, or removes it when there is one run. Returns what redraws it.
  navvy.showComparison = function (runs) {
    if (runs.length < 2) {
      document.getElementById('compare').remove();
      return null;
    }
    const body = navvy.sectionBody('compare'), names = sharedNames(runs);
    body.append(el('p', null, ...runs.flatMap((run, i) => [
      el('strong', null, 'AB'[i]), ` is ${run.name} in ${run.raw.folder}${i ? '.' : '; '}`])));
    const right = el('div', {class: 'block'});
    body.append(el('div', {class: 'pair'}, el('div', {class: 'block'}, results(runs)), right));
    let overlay = null;
    if (names && names.length && window.Dygraph) {
      overlay = new Overlay(runs, names);
      right.append(overlay.element);
      overlay.show(overlay.name);
    } else
      right.append(navvy.absent('The runs share no channel of telemetry, so none is compared.'));
    right.append(el('h3', null, 'Difference of the heights at the end'));
    const why = gridsDiffer(runs);
    const map = why ? null : new DifferenceMap(runs, right);
    if (why) right.append(navvy.absent(`The heights cannot be compared: ${why}.`));
    else map.draw();
    return {redraw: reason => {
      if (overlay && reason === 'scheme') overlay.chart.recolor();
      if (map) map.draw();
    }};
  };
})();
