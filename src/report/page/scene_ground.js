// SPDX-License-Identifier: Apache-2.0
// Mesh of the ground in the 3D view.
//
// The mesh is a grid of unequal spacing with at most 300 x 300 vertices: every column where work is
// done, if they are few enough, and a coarse grid for the rest of the site.
(function () {
  'use strict';
  const navvy = window.navvy = window.navvy || {};

  const kMost = 300, kMostInside = 240;

  // Rising indices 0 ... n - 1: about every column from `low` to `high`, few elsewhere.
  navvy.unevenIndices = function (n, low, high) {
    const inner = Math.max(1, Math.ceil((high - low) / kMostInside));
    const inside = [];
    for (let i = low; i < high; i += inner) inside.push(i);
    if (inside[inside.length - 1] !== high - 1) inside.push(high - 1);
    const rest = low + (n - high), left = kMost - inside.length - 4;
    const outer = Math.max(inner, Math.ceil(rest / left));
    const before = [], after = [];
    for (let i = low - outer; i > 0; i -= outer) before.unshift(i);
    if (low > 0) before.unshift(0);
    for (let i = high - 1 + outer; i < n - 1; i += outer) after.push(i);
    if (high < n) after.push(n - 1);
    return before.concat(inside, after);
  };

  class GroundMesh {
    constructor(run) {
      const region = navvy.activeRegion(run), {nx, ny} = run.grid;
      this.run = run;
      this.xs = navvy.unevenIndices(nx, region.x0, region.x1);
      this.ys = navvy.unevenIndices(ny, region.y0, region.y1);
      this.byChange = true;
      const count = this.xs.length * this.ys.length;
      const geometry = this.geometry = new THREE.BufferGeometry();
      for (const name of ['position', 'normal', 'color'])
        geometry.setAttribute(name, new THREE.BufferAttribute(new Float32Array(3 * count), 3));
      geometry.setIndex(new THREE.BufferAttribute(this.triangles(), 1));
      const material = new THREE.MeshLambertMaterial({vertexColors: THREE.VertexColors,
                                                      side: THREE.DoubleSide});
      this.object = new THREE.Mesh(geometry, material);
      this.object.frustumCulled = false;
      this.makeSides();
      this.placeColumns();
    }

    // Walls around the site, which make it look like a block of ground.
    makeSides() {
      const w = this.xs.length, h = this.ys.length, ring = [];
      for (let i = 0; i < w; ++i) ring.push(i);
      for (let j = 1; j < h; ++j) ring.push(j * w + w - 1);
      for (let i = w - 2; i >= 0; --i) ring.push((h - 1) * w + i);
      for (let j = h - 2; j >= 0; --j) ring.push(j * w);
      this.ring = ring;
      const index = [];
      for (let i = 0; i + 1 < ring.length; ++i) {
        const k = 2 * i;
        index.push(k, k + 1, k + 2, k + 1, k + 3, k + 2);
      }
      const geometry = new THREE.BufferGeometry();
      geometry.setAttribute('position',
                            new THREE.BufferAttribute(new Float32Array(6 * ring.length), 3));
      geometry.setIndex(index);
      const material = new THREE.MeshPhongMaterial({side: THREE.DoubleSide, flatShading: true,
                                                    specular: 0});
      material.color.setRGB(...this.soil().map(value => 0.6 * value));
      this.sides = new THREE.Mesh(geometry, material);
      this.sides.frustumCulled = false;
    }

    // The floor of the block lies below all that was ever dug.
    updateSides() {
      const position = this.geometry.attributes.position.array;
      const side = this.sides.geometry.attributes.position;
      if (this.floor === undefined || this.run.live) {
        let low = Infinity;
        for (let at = 2; at < position.length; at += 3) low = Math.min(low, position[at]);
        this.floor = low - Math.max(0.5, 1.2 * this.run.ground.largestChange);
      }
      this.ring.forEach((k, i) => {
        for (let axis = 0; axis < 3; ++axis) {
          side.array[6 * i + axis] = position[3 * k + axis];
          side.array[6 * i + 3 + axis] = axis === 2 ? this.floor : position[3 * k + axis];
        }
      });
      side.needsUpdate = true;
    }

    // Linear colour of the soil.
    soil() {
      const soils = this.run.raw.soils;
      return (soils && soils[0] && soils[0].color) || [0.3, 0.22, 0.14];
    }

    triangles() {
      const w = this.xs.length, h = this.ys.length;
      const index = new Uint32Array(6 * (w - 1) * (h - 1));
      let at = 0;
      for (let j = 0; j + 1 < h; ++j)
        for (let i = 0; i + 1 < w; ++i) {
          const k = j * w + i;
          index.set([k, k + 1, k + w, k + 1, k + w + 1, k + w], at);
          at += 6;
        }
      return index;
    }

    placeColumns() {
      const {cell_m, origin_m} = this.run.grid, position = this.geometry.attributes.position.array;
      let at = 0;
      for (const y of this.ys)
        for (const x of this.xs) {
          position[at] = origin_m[0] + (x + 0.5) * cell_m;
          position[at + 1] = origin_m[1] + (y + 0.5) * cell_m;
          at += 3;
        }
    }

    // Takes heights and colours from the present frame of the ground.
    update() {
      this.limit = navvy.niceAbove(Math.max(0.05, this.run.ground.largestChange));
      const {ground, grid} = this.run, position = this.geometry.attributes.position.array;
      let at = 2;
      for (const y of this.ys)
        for (const x of this.xs) {
          position[at] = ground.height(y * grid.nx + x);
          at += 3;
        }
      this.shade();
      this.tint();
      this.updateSides();
      for (const name of ['position', 'normal', 'color'])
        this.geometry.attributes[name].needsUpdate = true;
    }

    // Normals from central differences, which is much cheaper than from triangles.
    shade() {
      const w = this.xs.length, h = this.ys.length;
      const p = this.geometry.attributes.position.array;
      const normal = this.geometry.attributes.normal.array;
      for (let j = 0; j < h; ++j)
        for (let i = 0; i < w; ++i) {
          const left = 3 * (j * w + Math.max(0, i - 1));
          const right = 3 * (j * w + Math.min(w - 1, i + 1));
          const down = 3 * (Math.max(0, j - 1) * w + i);
          const up = 3 * (Math.min(h - 1, j + 1) * w + i);
          const sx = (p[right + 2] - p[left + 2]) / (p[right] - p[left] || 1);
          const sy = (p[up + 2] - p[down + 2]) / (p[up + 1] - p[down + 1] || 1);
          const size = Math.hypot(sx, sy, 1), k = 3 * (j * w + i);
          normal[k] = -sx / size;
          normal[k + 1] = -sy / size;
          normal[k + 2] = 1 / size;
        }
    }

    // Soil colour; where the height changed, mixed with the colour of cut or fill.
    tint() {
      const {ground, grid} = this.run, color = this.geometry.attributes.color.array;
      const soil = this.soil();
      const cut = [0.55, 0.06, 0.03], fill = [0.04, 0.2, 0.5];
      let at = 0;
      for (const y of this.ys)
        for (const x of this.xs) {
          const k = y * grid.nx + x;
          const share = (ground.now[k] - ground.start[k]) * grid.unit_m / this.limit;
          const part = this.byChange ? Math.min(1, 1.6 * Math.sqrt(Math.abs(share))) * 0.85 : 0;
          const paint = Math.abs(share) < 0.01 ? soil : share < 0 ? cut : fill;
          for (let i = 0; i < 3; ++i) color[at++] = soil[i] + (paint[i] - soil[i]) * part;
        }
    }
  }
  navvy.GroundMesh = GroundMesh;
})();
