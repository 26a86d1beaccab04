// SPDX-License-Identifier: Apache-2.0
// Map of a value per column on a canvas: hill shading, grid with labels, overlays, hover.
(function () {
  'use strict';
  const navvy = window.navvy = window.navvy || {};
  const {el} = navvy;

  const kMargin = {left: 48, right: 12, top: 10, bottom: 36};
  // More pixels than this per side of the image would not be seen.
  const kMostPixels = 1000;

  class MapView {
    constructor(host, grid, region) {
      this.grid = grid;
      this.region = region;
      this.image = document.createElement('canvas');
      this.canvas = el('canvas', {class: 'map', role: 'img', 'aria-label': 'Map of the ground'});
      this.readout = el('div', {class: 'readout'});
      this.host = el('div', {class: 'map-holder'}, this.canvas, this.readout);
      host.append(this.host);
      this.canvas.addEventListener('pointermove', event => this.hover(event));
      this.canvas.addEventListener('pointerdown', event => this.hover(event));
      this.canvas.addEventListener('pointerleave', () => { this.hovered = null; this.describe(); });
    }

    // `layer`: {value(k) [m] or NaN, height(k) [m], limit [m], overlay(context, map), text(k)}.
    draw(layer) {
      this.layer = layer;
      this.layout();
      this.paint();
      const context = this.context;
      context.imageSmoothingEnabled = this.perCell < 1;
      context.drawImage(this.image, kMargin.left, kMargin.top, this.w, this.h);
      this.drawGrid(context);
      context.save();
      context.beginPath();
      context.rect(kMargin.left, kMargin.top, this.w, this.h);
      context.clip();
      if (layer.overlay) layer.overlay(context, this);
      context.restore();
      this.describe();
    }

    // Width [px] that the map may have: that of the grid around it, less the column beside it. The
    // width of its own column follows from the map.
    available() {
      const frame = this.host.closest('.with-side'), style = getComputedStyle(frame);
      const columns = style.gridTemplateColumns.split(' ');
      const beside = columns.length > 1 ? parseFloat(columns[1]) + parseFloat(style.columnGap) : 0;
      return Math.max(200, frame.clientWidth - beside);
    }

    // Fits the region into the width of the page and most of the height of the window.
    layout() {
      const {x0, y0, x1, y1} = this.region, {cell_m, origin_m} = this.grid;
      const wide = this.available();
      const high = Math.max(260, Math.min(620, 0.72 * window.innerHeight));
      this.perCell = Math.min((wide - kMargin.left - kMargin.right) / (x1 - x0),
                              (high - kMargin.top - kMargin.bottom) / (y1 - y0));
      this.w = this.perCell * (x1 - x0);
      this.h = this.perCell * (y1 - y0);
      this.low = [origin_m[0] + x0 * cell_m, origin_m[1] + y0 * cell_m];
      this.perMetre = this.perCell / cell_m;
      const width = this.w + kMargin.left + kMargin.right;
      const height = this.h + kMargin.top + kMargin.bottom, ratio = window.devicePixelRatio || 1;
      this.canvas.width = Math.round(width * ratio);
      this.canvas.height = Math.round(height * ratio);
      this.canvas.style.width = width + 'px';
      this.canvas.style.height = height + 'px';
      this.context = this.canvas.getContext('2d');
      this.context.scale(ratio, ratio);
    }

    x(metres) { return kMargin.left + (metres - this.low[0]) * this.perMetre; }
    y(metres) { return kMargin.top + this.h - (metres - this.low[1]) * this.perMetre; }

    // Paints the values into the image, one pixel per column or per group of columns.
    paint() {
      const {x0, y0, x1, y1} = this.region;
      const stride = Math.max(1, Math.ceil(Math.max(x1 - x0, y1 - y0) / kMostPixels));
      const w = Math.ceil((x1 - x0) / stride), h = Math.ceil((y1 - y0) / stride);
      this.image.width = w;
      this.image.height = h;
      const context = this.image.getContext('2d'), pixels = context.createImageData(w, h);
      const colors = navvy.changeColors(navvy.isDark());
      for (let j = 0; j < h; ++j)
        for (let i = 0; i < w; ++i)
          this.pixel(pixels.data, 4 * ((h - 1 - j) * w + i), x0 + i * stride, y0 + j * stride,
                     stride, colors);
      context.putImageData(pixels, 0, 0);
    }

    pixel(data, at, x, y, stride, colors) {
      const {nx, ny, cell_m} = this.grid, {layer} = this, k = y * nx + x;
      const right = x + stride < nx ? k + stride : k, up = y + stride < ny ? k + stride * nx : k;
      // Light comes from the upper left. It must stay weak, or it hides the colours of the change.
      const light = (layer.height(right) - layer.height(up)) / (cell_m * stride);
      const shade = 1 + 0.06 * Math.max(-1, Math.min(1, light));
      const value = layer.value(k);
      const known = value === value;
      const color = 3 * navvy.changeIndex(known ? value / layer.limit : 0);
      for (let i = 0; i < 3; ++i) data[at + i] = colors[color + i] * shade;
      data[at + 3] = known ? 255 : 110;
    }

    // Distance of lines [m] such that labels do not touch.
    labelStep() {
      const steps = [1, 5, 10, 20, 50, 100, 200, 500, 1000];
      return steps.find(step => step * this.perMetre >= 42) || 5000;
    }

    drawGrid(context) {
      context.font = '12px system-ui, sans-serif';
      context.lineWidth = 1;
      if (this.perMetre >= 12) this.lines(context, 1, navvy.color('--map-grid'));
      if (this.perMetre >= 3) this.lines(context, 5, navvy.color('--map-grid-5'));
      const step = this.labelStep();
      if (this.perMetre < 3) this.lines(context, step, navvy.color('--map-grid-5'));
      context.strokeStyle = navvy.color('--rule');
      context.strokeRect(kMargin.left, kMargin.top, this.w, this.h);
      this.labels(context, step);
    }

    // Calls act for the multiples of `step` within the map along an axis.
    each(axis, step, act) {
      const low = this.low[axis], high = low + (axis ? this.h : this.w) / this.perMetre;
      for (let i = Math.ceil(low / step - 1e-6); i * step <= high + 1e-6; ++i) act(i * step);
    }

    lines(context, step, color) {
      context.strokeStyle = color;
      context.beginPath();
      this.each(0, step, metres => {
        context.moveTo(this.x(metres), kMargin.top);
        context.lineTo(this.x(metres), kMargin.top + this.h);
      });
      this.each(1, step, metres => {
        context.moveTo(kMargin.left, this.y(metres));
        context.lineTo(kMargin.left + this.w, this.y(metres));
      });
      context.stroke();
    }

    labels(context, step) {
      context.fillStyle = navvy.color('--muted');
      context.textAlign = 'center';
      context.textBaseline = 'top';
      const below = kMargin.top + this.h + 6;
      this.each(0, step, metres => context.fillText(navvy.number(metres), this.x(metres), below));
      context.fillText('x [m]', kMargin.left + this.w / 2, below + 14);
      context.textAlign = 'right';
      context.textBaseline = 'middle';
      this.each(1, step, metres => context.fillText(navvy.number(metres), kMargin.left - 6,
                                                    this.y(metres)));
      context.save();
      context.translate(9, kMargin.top + this.h / 2);
      context.rotate(-Math.PI / 2);
      context.textAlign = 'center';
      context.fillText('y [m]', 0, 0);
      context.restore();
    }

    hover(event) {
      const place = this.canvas.getBoundingClientRect();
      const x = Math.floor((event.clientX - place.left - kMargin.left) / this.perCell) +
        this.region.x0;
      const y = Math.floor((kMargin.top + this.h - (event.clientY - place.top)) / this.perCell) +
        this.region.y0;
      const {x0, y0, x1, y1} = this.region;
      this.hovered = x >= x0 && x < x1 && y >= y0 && y < y1 ? [x, y] : null;
      this.describe();
    }

    describe() {
      if (!this.hovered) {
        this.readout.textContent = 'Point at the map to read heights.';
        return;
      }
      const [x, y] = this.hovered, {nx, cell_m, origin_m} = this.grid;
      const metres = (i, axis) => navvy.fixed(origin_m[axis] + (i + 0.5) * cell_m, 2);
      this.readout.textContent = `x ${metres(x, 0)} m, y ${metres(y, 1)} m: ` +
        this.layer.text(y * nx + x);
    }
  }
  navvy.MapView = MapView;
})();
