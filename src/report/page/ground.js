// SPDX-License-Identifier: Apache-2.0
// Heights of the ground over time.
//
// The file holds the tiles that changed in each frame. The heights they replaced are kept beside
// them, so the time can move forwards and backwards at the cost of the changed tiles only.
(function () {
  'use strict';
  const navvy = window.navvy = window.navvy || {};

  const kTile = 16;
  navvy.kTileSize = 2 + kTile * kTile;
  navvy.kNoDesign = -32768;
  // A smaller change [m] is settling, not work, and does not widen the part that views show.
  const kVisibleChange = 0.02;

  class Ground {
    constructor(grid, start, frames) {
      this.grid = grid;
      this.start = start;
      this.now = start.slice();
      this.frame = -1;
      this.times = frames.times;
      this.tiles = frames.tiles;
      this.offsets = new Uint32Array(frames.counts.length + 1);
      frames.counts.forEach((count, i) => { this.offsets[i + 1] = this.offsets[i] + count; });
      this.before = this.tiles ? new Int16Array(this.tiles.length) : null;
      this.changed = null;
      this.largestChange = 0;
      this.first();
    }

    // Goes through all frames once: fills `before` and finds where and how much heights change.
    first() {
      for (let frame = 0; frame + 1 < this.offsets.length; ++frame)
        for (let tile = this.offsets[frame]; tile < this.offsets[frame + 1]; ++tile) {
          const at = tile * navvy.kTileSize;
          this.before[at] = this.tiles[at];
          this.before[at + 1] = this.tiles[at + 1];
          this.eachColumn(at, (column, value, x, y) => {
            this.before[value] = this.now[column];
            this.now[column] = this.tiles[value];
            this.note(column, x, y);
          });
        }
      this.frame = this.offsets.length - 2;
    }

    // Widens what is known of the changes by the present height of a column.
    note(column, x, y) {
      const change = Math.abs(this.now[column] - this.start[column]) * this.grid.unit_m;
      if (change > this.largestChange) this.largestChange = change;
      if (change < kVisibleChange) return;
      if (!this.changed) this.changed = {x0: x, y0: y, x1: x + 1, y1: y + 1};
      const box = this.changed;
      if (x < box.x0) box.x0 = x;
      if (y < box.y0) box.y0 = y;
      if (x >= box.x1) box.x1 = x + 1;
      if (y >= box.y1) box.y1 = y + 1;
    }

    // Takes tiles of a live run, which has no frames to go back to.
    take(tiles) {
      if (tiles.length % navvy.kTileSize) throw new Error('a tile of the ground is cut off');
      this.tiles = tiles;
      for (let at = 0; at < tiles.length; at += navvy.kTileSize)
        this.eachColumn(at, (column, value, x, y) => {
          this.now[column] = tiles[value];
          this.note(column, x, y);
        });
    }

    // Calls act(index of the column, index of the value, x, y) for the columns of a tile.
    eachColumn(at, act) {
      const {nx, ny} = this.grid;
      const x0 = this.tiles[at] * kTile, y0 = this.tiles[at + 1] * kTile;
      const xs = Math.min(kTile, nx - x0), ys = Math.min(kTile, ny - y0);
      for (let j = 0; j < ys; ++j)
        for (let i = 0; i < xs; ++i)
          act((y0 + j) * nx + x0 + i, at + 2 + j * kTile + i, x0 + i, y0 + j);
    }

    copy(frame, from) {
      for (let tile = this.offsets[frame]; tile < this.offsets[frame + 1]; ++tile)
        this.eachColumn(tile * navvy.kTileSize, (column, value) => {
          this.now[column] = from[value];
        });
    }

    // Brings `now` to the latest frame at or before a time. Returns that frame, -1 is the start.
    seek(time) {
      const target = navvy.indexAt(this.times, time);
      while (this.frame < target) this.copy(++this.frame, this.tiles);
      while (this.frame > target) this.copy(this.frame--, this.before);
      return this.frame;
    }

    height(column) { return this.grid.base_m + this.grid.unit_m * this.now[column]; }

    heights(time) {
      this.seek(time);
      const values = new Float32Array(this.now.length);
      for (let i = 0; i < values.length; ++i) values[i] = this.height(i);
      return {nx: this.grid.nx, ny: this.grid.ny, values};
    }

    // Volumes [m3] below and above the start at the present frame.
    volumes() {
      const scale = this.grid.unit_m * this.grid.cell_m * this.grid.cell_m;
      let cut = 0, fill = 0;
      for (let i = 0; i < this.now.length; ++i) {
        const change = this.now[i] - this.start[i];
        if (change < 0) cut -= change; else fill += change;
      }
      return {cut: cut * scale, fill: fill * scale};
    }
  }
  navvy.Ground = Ground;

  function widen(box, x, y) {
    box.x0 = Math.min(box.x0, x); box.x1 = Math.max(box.x1, x);
    box.y0 = Math.min(box.y0, y); box.y1 = Math.max(box.y1, y);
  }

  // Widens a box by the place of a link in every frame.
  function widenByMachines(run, box) {
    const {grid, frames} = run;
    if (!frames) return;
    for (let at = 0; at + 6 < frames.poses.length; at += 7)
      widen(box, (frames.poses[at] - grid.origin_m[0]) / grid.cell_m,
            (frames.poses[at + 1] - grid.origin_m[1]) / grid.cell_m);
  }

  function widenByDesign(run, box) {
    if (!run.design) return;
    const {nx, ny} = run.grid;
    for (let y = 0, k = 0; y < ny; ++y)
      for (let x = 0; x < nx; ++x, ++k)
        if (run.design[k] !== navvy.kNoDesign) { widen(box, x, y); widen(box, x + 1, y + 1); }
  }

  // Part of the site in which anything happens, in columns: changes, design and machines, with a
  // margin. The whole site if nothing happens.
  navvy.activeRegion = function (run) {
    if (run.region) return run.region;
    const {nx, ny, cell_m} = run.grid;
    const box = Object.assign({x0: Infinity, y0: Infinity, x1: -Infinity, y1: -Infinity},
                              run.ground.changed || {});
    widenByMachines(run, box);
    widenByDesign(run, box);
    const margin = (run.margin_m || 2) / cell_m;
    const whole = !(box.x1 > box.x0 && box.y1 > box.y0);
    run.region = whole ? {x0: 0, y0: 0, x1: nx, y1: ny} : {
      x0: Math.max(0, Math.floor(box.x0 - margin)), y0: Math.max(0, Math.floor(box.y0 - margin)),
      x1: Math.min(nx, Math.ceil(box.x1 + margin)), y1: Math.min(ny, Math.ceil(box.y1 + margin))
    };
    return run.region;
  };

  // Returns true if work was done outside of the region that views show, which is then renewed.
  navvy.regionGrew = function (run) {
    const old = run.region, grid = run.grid;
    if (!old) return false;
    const box = Object.assign({x0: Infinity, y0: Infinity, x1: -Infinity, y1: -Infinity},
                              run.ground.changed || {});
    widenByMachines(run, box);
    // A machine may leave the site; what is outside needs no ground.
    const inside = Math.max(0, box.x0) >= old.x0 && Math.max(0, box.y0) >= old.y0 &&
                   Math.min(grid.nx, box.x1) <= old.x1 && Math.min(grid.ny, box.y1) <= old.y1;
    if (inside) return false;
    run.region = null;
    navvy.activeRegion(run);
    return true;
  };
})();
