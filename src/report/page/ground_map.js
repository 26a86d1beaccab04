// SPDX-License-Identifier: Apache-2.0
// Section of the plan view: cut and fill at the chosen time, or the difference to the design.
(function () {
  'use strict';
  const navvy = window.navvy = window.navvy || {};
  const {el} = navvy;

  // Sides of columns between those with and without a design, as [x0, y0, x1, y1] in metres.
  function designOutline(run) {
    const {nx, ny, cell_m, origin_m} = run.grid, segments = [];
    if (!run.design) return segments;
    const inside = (x, y) => x >= 0 && y >= 0 && x < nx && y < ny &&
      run.design[y * nx + x] !== navvy.kNoDesign;
    const add = (x0, y0, x1, y1) => segments.push(
      [origin_m[0] + x0 * cell_m, origin_m[1] + y0 * cell_m,
       origin_m[0] + x1 * cell_m, origin_m[1] + y1 * cell_m]);
    for (let y = 0; y <= ny; ++y)
      for (let x = 0; x <= nx; ++x) {
        if (inside(x, y) !== inside(x - 1, y)) add(x, y, x, y + 1);
        if (inside(x, y) !== inside(x, y - 1)) add(x, y, x + 1, y);
      }
    return segments;
  }

  // Largest difference to the design at the start and at the end [m].
  function designLimit(run) {
    const {design, ground, grid} = run;
    let most = 0;
    for (let k = 0; k < design.length; ++k)
      if (design[k] !== navvy.kNoDesign)
        most = Math.max(most, Math.abs(ground.now[k] - design[k]),
                        Math.abs(ground.start[k] - design[k]));
    return most * grid.unit_m;
  }

  const round = value => navvy.niceAbove(Math.max(0.05, value));

  class PlanSection {
    constructor(run, clock, body) {
      this.run = run;
      this.clock = clock;
      this.mode = 'change';
      this.sheet = document.createElement('canvas');
      this.outline = designOutline(run);
      run.ground.seek(Infinity);
      this.limits = {change: round(run.ground.largestChange),
                     design: run.design ? round(designLimit(run)) : 1};
      this.side = el('div', {class: 'side'});
      const view = el('div', {class: 'view'});
      body.append(this.controls(), el('div', {class: 'with-side'}, view, this.side));
      this.map = new navvy.MapView(view, run.grid, navvy.activeRegion(run));
      this.fillSide();
      this.draw();
      if (clock) clock.on(navvy.drawWhenSeen(body, () => this.draw()));
    }

    controls() {
      const {grid} = this.run;
      const region = navvy.choice('Part', [['work', 'Work area'], ['site', 'Whole site']], 'work',
        value => {
          this.map.region = value === 'site' ? {x0: 0, y0: 0, x1: grid.nx, y1: grid.ny} :
            navvy.activeRegion(this.run);
          this.draw();
        });
      const mode = navvy.choice(
        'Shown', [['change', 'Cut and fill'], ['design', 'Against the design']], this.mode,
        value => { this.mode = value; this.fillSide(); this.draw(); });
      return el('div', {class: 'controls'}, this.run.design ? mode : null, region);
    }

    fillSide() {
      const change = this.mode === 'change';
      this.volumes = el('div');
      navvy.clear(this.side).append(
        navvy.scaleBar(this.limits[this.mode], change ? 'cut' : 'below the design',
                       change ? 'fill' : 'above the design'),
        this.volumes, this.key());
    }

    key() {
      const items = [];
      const item = (kind, text) =>
        items.push(el('span', {class: 'item'}, el('i', {class: kind}), text));
      if (this.outline.length) item('key-design', 'outline of the design');
      if ((this.run.raw.paths || []).length) item('key-path', 'planned path');
      if (this.run.frames) item('key-machine', 'machine');
      return el('div', {class: 'legend'}, items);
    }

    // Volumes at the chosen time from the heights, beside those of the summary at the end.
    showVolumes() {
      const now = this.run.ground.volumes(), score = (this.run.summary || {}).score || {};
      const sum = key => ['inside', 'outside'].map(area => (score[area] || {})[key])
        .filter(navvy.isNumber).reduce((a, b) => (a || 0) + b, undefined);
      const cell = value => navvy.quantity(value, '', navvy.fixed(value, 2));
      const time = this.clock ? `At ${navvy.fixed(this.clock.time, 1)} s` : 'At the end';
      navvy.clear(this.volumes).append(navvy.table(
        ['Volume [m\u00b3]', {text: 'Cut', numeric: true}, {text: 'Fill', numeric: true}],
        [[time, cell(now.cut), cell(now.fill)],
         ['Summary, end', cell(sum('cut_m3')), cell(sum('fill_m3'))]]));
    }

    draw() {
      const {run, clock} = this, {ground, grid, design} = run, unit = grid.unit_m;
      ground.seek(clock ? clock.time : Infinity);
      const {now, start} = ground;
      const change = k => (now[k] - start[k]) * unit;
      const error = k => design[k] === navvy.kNoDesign ? NaN : (now[k] - design[k]) * unit;
      this.map.draw({
        limit: this.limits[this.mode], value: this.mode === 'change' ? change : error,
        height: k => now[k] * unit, text: k => this.describe(k),
        overlay: (context, map) => this.overlay(context, map)
      });
      this.showVolumes();
    }

    describe(k) {
      const {ground, design, grid} = this.run;
      let text = `height ${navvy.fixed(ground.height(k), 3)} m, change ` +
        `${navvy.signed((ground.now[k] - ground.start[k]) * grid.unit_m, 3)} m`;
      if (!design) return text;
      if (design[k] === navvy.kNoDesign) return text + ', no design here';
      text += `, design ${navvy.fixed(grid.base_m + design[k] * grid.unit_m, 3)} m`;
      return text + `, difference ${navvy.signed((ground.now[k] - design[k]) * grid.unit_m, 3)} m`;
    }

    overlay(context, map) {
      this.drawDesign(context, map);
      this.drawPaths(context, map);
      this.drawMachines(context, map);
    }

    drawDesign(context, map) {
      context.strokeStyle = navvy.color('--map-design');
      context.lineWidth = 1.6;
      context.beginPath();
      for (const [x0, y0, x1, y1] of this.outline) {
        context.moveTo(map.x(x0), map.y(y0));
        context.lineTo(map.x(x1), map.y(y1));
      }
      context.stroke();
    }

    drawPaths(context, map) {
      context.strokeStyle = navvy.color('--map-path');
      context.lineWidth = 1.6;
      context.setLineDash([6, 4]);
      for (const path of this.run.raw.paths || []) {
        context.beginPath();
        for (const point of path.points) context.lineTo(map.x(point[0]), map.y(point[1]));
        context.stroke();
      }
      context.setLineDash([]);
    }

    drawMachines(context, map) {
      const {run} = this;
      if (!run.frames || !this.clock) return;
      const at = navvy.between(run.frames.times, this.clock.time);
      run.links.forEach((link, i) => {
        const shapes = new Path2D();
        for (const outline of navvy.linkOutlines(link, navvy.linkPose(run, i, at))) {
          outline.forEach(([x, y], k) => shapes[k ? 'lineTo' : 'moveTo'](map.x(x), map.y(y)));
          shapes.closePath();
        }
        this.drawUnion(context, map, shapes);
      });
    }

    // Fills shapes and draws the outline of them all together: the lines inside are erased on a
    // canvas of its own before it is copied.
    drawUnion(context, map, shapes) {
      const sheet = this.sheet, own = sheet.getContext('2d');
      sheet.width = map.canvas.width;
      sheet.height = map.canvas.height;
      own.setTransform(context.getTransform());
      own.strokeStyle = navvy.color('--map-machine');
      own.lineWidth = 2.6;
      own.stroke(shapes);
      own.globalCompositeOperation = 'destination-out';
      own.fill(shapes);
      own.globalCompositeOperation = 'source-over';
      own.fillStyle = navvy.color('--map-machine-fill');
      own.fill(shapes);
      context.save();
      context.resetTransform();
      context.drawImage(sheet, 0, 0);
      context.restore();
    }
  }

  navvy.showPlan = function (run, clock) {
    const body = navvy.sectionBody('plan');
    if (!run.ground) {
      body.append(navvy.absent('This run has no readable heights, so there is no map.'));
      return null;
    }
    const section = new PlanSection(run, clock, body);
    return {redraw: () => { section.fillSide(); section.draw(); }};
  };
})();
