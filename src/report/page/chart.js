// SPDX-License-Identifier: Apache-2.0
// One chart of series over time: title, legend with values, phase bands, line at the chosen time.
(function () {
  'use strict';
  const navvy = window.navvy = window.navvy || {};
  const {el} = navvy;

  navvy.seriesColors = () => [1, 2, 3, 4, 5, 6, 7, 8].map(i => navvy.color('--series-' + i));

  // Colours of phases by name, the same in all charts of a run.
  navvy.phaseColors = function (phases) {
    const names = [...new Set((phases || []).flatMap(one => one.spans.map(span => span.name)))];
    return new Map(names.map((name, i) => [name, navvy.color('--band-' + (i % 6 + 1))]));
  };

  class Chart {
    // `chart` is {title, unit, series: [{label, values}]}; `times` has the length of the values.
    constructor(host, chart, times, options) {
      this.chart = chart;
      this.times = times;
      this.options = options || {};
      this.values = [];
      this.area = el('div', {class: 'plot'});
      this.cursor = el('div', {class: 'cursor'});
      this.card = el('div', {class: 'chart'}, this.head(), el('div', {class: 'frame'}, this.area,
                                                              this.cursor));
      host.append(this.card);
    }

    // Draws the chart. Its size must be final, so all charts of a grid are added before.
    start() {
      this.graph = new Dygraph(this.area, this.rows(), this.settings());
      this.recolor();
      return this;
    }

    head() {
      const {title, unit, series, of} = this.chart;
      const cut = of > series.length ? `, ${series.length} largest of ${of}` : '';
      this.legend = el('div', {class: 'legend'}, series.map(one => {
        const value = el('span', {class: 'value'});
        this.values.push(value);
        return el('span', {class: 'item'}, el('i'), one.label, value);
      }));
      return el('div', {class: 'chart-head'},
                el('h3', null, title,
                   el('span', {class: 'unit'}, (unit ? ` [${unit}]` : '') + cut),
                   this.removal()),
                this.legend);
    }

    removal() {
      const {remove} = this.chart;
      if (!remove) return null;
      return el('button', {type: 'button', class: 'small', onclick: remove}, 'Remove');
    }

    rows() {
      const {times, chart} = this, rows = new Array(times.length);
      for (let i = 0; i < times.length; ++i) {
        const row = [times[i]];
        for (const one of chart.series)
          row.push(Number.isFinite(one.values[i]) ? one.values[i] : null);
        rows[i] = row;
      }
      return rows;
    }

    settings() {
      // Names of channels never reach the library, which writes labels as markup.
      const labels = ['t'].concat(this.chart.series.map((_, i) => 's' + i));
      const model = Object.assign({}, Dygraph.defaultInteractionModel);
      // A finger scrolls the page instead of the chart.
      for (const event of ['touchstart', 'touchmove', 'touchend']) delete model[event];
      return {
        labels, legend: 'never', resizable: 'passive', strokeWidth: 1.4, highlightCircleSize: 3,
        interactionModel: model, axisLabelFontSize: 12,
        connectSeparatedPoints: Boolean(this.options.connect),
        axes: {y: {axisLabelWidth: 54, pixelsPerLabel: 26,
                   axisLabelFormatter: value => navvy.number(value, 3)},
               x: {axisLabelFormatter: value => navvy.number(value, 4)}},
        underlayCallback: (context, area, graph) => this.bands(context, area, graph),
        drawCallback: () => this.place(this.time),
        highlightCallback: (event, x, points, row) => this.hover(row),
        unhighlightCallback: () => this.hover(null),
        clickCallback: (event, x) => { if (this.options.pick) this.options.pick(x); }
      };
    }

    bands(context, area, graph) {
      const {phases, colors} = this.options;
      if (!phases) return;
      context.save();
      for (const span of phases) {
        const left = Math.max(area.x, graph.toDomXCoord(span.start_s));
        const right = Math.min(area.x + area.w, graph.toDomXCoord(span.end_s));
        if (right <= left) continue;
        context.fillStyle = colors.get(span.name);
        context.fillRect(left, area.y, right - left, area.h);
      }
      context.restore();
    }

    // Charts that stand together show their values together.
    hover(row) {
      if (this.options.hover) this.options.hover(row);
      else this.showValues(row);
    }

    // Shows the values of a row, or those at the chosen time.
    showValues(row) {
      const at = row === null || row === undefined ? navvy.indexAt(this.times, this.time) : row;
      this.chart.series.forEach((one, i) => {
        const value = one.values[at];
        this.values[i].textContent = Number.isFinite(value) ? navvy.number(value) : '\u2013';
      });
    }

    // Puts the line at a time; a line outside of the plot is hidden.
    place(time) {
      this.time = time;
      if (!this.graph || time === undefined) return;
      const x = this.graph.toDomXCoord(time), area = this.graph.getArea();
      this.cursor.hidden = !(x >= area.x && x <= area.x + area.w);
      this.cursor.style.left = x + 'px';
      this.cursor.style.height = area.h + 'px';
      if (this.graph.getSelection() === -1) this.showValues(null);
    }

    recolor() {
      const colors = navvy.seriesColors().slice(0, this.chart.series.length);
      this.legend.querySelectorAll('i').forEach((mark, i) => {
        mark.style.background = colors[i];
      });
      this.graph.updateOptions({colors, gridLineColor: navvy.color('--grid'),
                                axisLineColor: navvy.color('--rule')});
    }

    destroy() {
      this.graph.destroy();
      this.card.remove();
    }
  }
  navvy.Chart = Chart;
})();
