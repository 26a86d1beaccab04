// SPDX-License-Identifier: Apache-2.0
// Section of the charts: choice of machine and channels, common zoom and hover, cycles.
(function () {
  'use strict';
  const navvy = window.navvy = window.navvy || {};
  const {el} = navvy;

  class ChartSection {
    constructor(run, clock, body) {
      this.run = run;
      this.clock = clock;
      this.times = run.telemetry.column(0);
      this.machines = navvy.machinesOf(run.telemetry);
      this.machine = this.machines[0];
      this.more = false;
      this.chosen = [];
      this.charts = [];
      this.sync = null;
      this.host = el('div', {class: 'charts'});
      this.phaseKey = el('div', {class: 'legend phases'});
      body.append(this.controls(), this.phaseKey, this.host);
      clock.on(time => this.charts.forEach(chart => chart.place(time)));
      this.build();
    }

    controls() {
      const bar = el('div', {class: 'controls'});
      if (this.machines.length > 1)
        bar.append(navvy.select('Machine', this.machines.map(name => [name, name]),
                                name => { this.machine = name; this.build(); }));
      const names = this.run.telemetry.names.map((name, i) => [i, name]).slice(1);
      bar.append(
        navvy.select('Add a channel', [['', 'choose\u2026']].concat(names), index => {
          if (index === '' || this.chosen.includes(+index)) return;
          this.chosen.push(+index);
          this.build();
        }),
        navvy.choice('Charts', [[0, 'Main charts'], [1, 'All charts']], 0,
                     value => { this.more = Boolean(value); this.build(); }),
        el('button', {type: 'button', onclick: () => this.zoom(null)}, 'Whole run'),
        el('span', {class: 'muted'}, 'Time in s. Drag to zoom, double-click for the whole run, ' +
           'click to set the time.'));
      return bar;
    }

    build() {
      this.clear();
      const {run, machine} = this;
      const own = (run.raw.phases || []).find(one => one.machine === machine);
      const colors = navvy.phaseColors(run.raw.phases);
      const groups = this.chosen.map(index => this.chosenChart(index)).concat(
        navvy.chartGroups(run.telemetry, machine).filter(group => this.more || !group.more));
      const options = {phases: own ? own.spans : null, colors, pick: x => this.clock.set(x),
                       hover: row => this.charts.forEach(chart => chart.showValues(row))};
      this.charts = groups.map(group => new navvy.Chart(this.host, group, this.times, options));
      this.charts.forEach(chart => chart.start());
      if (!groups.length)
        this.host.append(navvy.absent('All grouped channels are zero; add a channel to see it.'));
      if (Dygraph.synchronize && this.charts.length > 1)
        this.sync = Dygraph.synchronize(this.charts.map(chart => chart.graph),
                                        {zoom: true, selection: true, range: false});
      this.showPhases(own, colors);
      this.charts.forEach(chart => chart.place(this.clock.time));
    }

    chosenChart(index) {
      const remove = () => {
        this.chosen = this.chosen.filter(other => other !== index);
        this.build();
      };
      return Object.assign(navvy.channelChart(this.run.telemetry, index), {remove});
    }

    showPhases(own, colors) {
      navvy.clear(this.phaseKey);
      if (!own || !own.spans.length) return;
      this.phaseKey.append(`Phases of ${own.machine}:`);
      for (const name of new Set(own.spans.map(span => span.name))) {
        const mark = el('i', {class: 'band'});
        mark.style.background = colors.get(name);
        this.phaseKey.append(el('span', {class: 'item'}, mark, name));
      }
    }

    // Shows a window of time in all charts, or the whole run for null.
    zoom(window) {
      for (const chart of this.charts) chart.graph.updateOptions({dateWindow: window});
    }

    clear() {
      if (this.sync) this.sync.detach();
      this.sync = null;
      this.charts.forEach(chart => chart.destroy());
      this.charts = [];
      navvy.clear(this.host);
    }

    // The library follows the size itself; colours of bands and lines come from the scheme.
    redraw(reason) {
      if (reason === 'scheme') this.build();
      else this.charts.forEach(chart => chart.place(this.clock.time));
    }
  }

  // Shows the section. Returns what to call when the colour scheme changes and when it goes.
  navvy.showCharts = function (run, clock) {
    const body = navvy.sectionBody('charts');
    let section = null;
    if (run.telemetry && window.Dygraph) section = new ChartSection(run, clock, body);
    else
      body.append(navvy.absent(run.telemetry ?
        'The library of the charts is missing in this page.' :
        'This run has no telemetry.csv that can be read, so there are no charts.'));
    body.append(el('h3', null, 'Cycles'), navvy.cycleTable(run, cycle => {
      const margin = 0.05 * (cycle.end_s - cycle.start_s);
      if (section) section.zoom([cycle.start_s - margin, cycle.end_s + margin]);
      if (clock) clock.set(cycle.lift_out_s);
    }));
    return {section, redraw: reason => section && section.redraw(reason),
            destroy: () => section && section.clear()};
  };
})();
