// SPDX-License-Identifier: Apache-2.0
// Machines, cylinders, loose particles, force arrows and paths in the 3D view.
(function () {
  'use strict';
  const navvy = window.navvy = window.navvy || {};

  function shapeGeometry(visual) {
    if (visual.box) return new THREE.BoxBufferGeometry(...visual.box);
    if (visual.sphere) return new THREE.SphereBufferGeometry(visual.sphere, 20, 14);
    if (visual.cylinder) {
      const [radius, length] = visual.cylinder;
      const geometry = new THREE.CylinderBufferGeometry(radius, radius, length, 24);
      // The library's cylinders stand along y, those of the data along z.
      geometry.rotateX(Math.PI / 2);
      return geometry;
    }
    const geometry = new THREE.BufferGeometry();
    geometry.setAttribute('position', new THREE.BufferAttribute(visual.mesh.points, 3));
    geometry.setIndex(new THREE.BufferAttribute(visual.mesh.triangles, 1));
    return geometry;
  }

  function shape(visual) {
    // Flat shading takes normals from the faces, so meshes need none of their own.
    const material = new THREE.MeshPhongMaterial({flatShading: !visual.cylinder && !visual.sphere,
                                                  side: THREE.DoubleSide, shininess: 12,
                                                  specular: 0x181818});
    material.color.setRGB(...(visual.color || [0.5, 0.5, 0.5]));
    const mesh = new THREE.Mesh(shapeGeometry(visual), material);
    setPose(mesh, visual.pose);
    return mesh;
  }

  function setPose(object, [x, y, z, qw, qx, qy, qz]) {
    object.position.set(x, y, z);
    object.quaternion.set(qx, qy, qz, qw);
  }

  // Cylinder of length 1 along z from its base, to be turned and stretched.
  function rod(radius, color) {
    const geometry = new THREE.CylinderBufferGeometry(radius, radius, 1, 16);
    geometry.rotateX(Math.PI / 2);
    geometry.translate(0, 0, 0.5);
    const material = new THREE.MeshPhongMaterial({shininess: 40, specular: 0x333333});
    material.color.setRGB(...color);
    return new THREE.Mesh(geometry, material);
  }

  const kAlong = [0, 0, 1];

  // Length of the arrow of the largest force [m].
  const kLongestArrow = 2.5;

  class Movers {
    constructor(run) {
      this.run = run;
      this.object = new THREE.Group();
      this.links = run.links.map(link => {
        const group = new THREE.Group();
        link.visuals.forEach(visual => group.add(shape(visual)));
        return this.add(group);
      });
      this.cylinders = (run.raw.cylinders || []).map(one => ({
        length: one.barrel_length_m,
        barrel: this.add(rod(one.radius_m, [0.05, 0.055, 0.06])),
        rod: this.add(rod(0.55 * one.radius_m, [0.6, 0.62, 0.64]))
      }));
      this.makeForces();
      this.makeParticles();
      this.makePaths();
    }

    add(object) {
      this.object.add(object);
      return object;
    }

    makeForces() {
      const count = (this.run.raw.forces || []).length;
      this.perMetre = 0;
      this.fitForces();
      this.forces = [];
      for (let i = 0; i < count; ++i)
        this.forces.push(this.add(new THREE.ArrowHelper(
          new THREE.Vector3(...kAlong), new THREE.Vector3(), 1, 0xd01c5b)));
    }

    // Makes arrows short enough for the largest force so far. Returns true if their scale changed.
    fitForces() {
      const {forces} = this.run.frames, before = this.perMetre;
      let most = 0;
      for (let i = 0; i + 5 < forces.length; i += 6)
        most = Math.max(most, Math.hypot(forces[i + 3], forces[i + 4], forces[i + 5]));
      if (most > 0) this.perMetre = Math.max(before, navvy.niceAbove(most / kLongestArrow));
      return this.perMetre !== before;
    }

    makeParticles() {
      const {frames, grid, raw} = this.run, offsets = frames.particleOffsets;
      let most = frames.mostParticles || 0;
      for (let i = 0; i + 1 < offsets.length; ++i)
        most = Math.max(most, offsets[i + 1] - offsets[i]);
      const geometry = new THREE.BufferGeometry();
      geometry.setAttribute('position', new THREE.BufferAttribute(new Float32Array(3 * most), 3));
      const material = new THREE.PointsMaterial({size: grid ? 0.6 * grid.cell_m : 0.05});
      const soil = (raw.soils && raw.soils[0] && raw.soils[0].color) || [0.3, 0.22, 0.14];
      // Brighter than the ground, so that they stand out against it.
      material.color.setRGB(...soil.map(value => Math.min(1, 1.5 * value + 0.03)));
      this.particles = this.add(new THREE.Points(geometry, material));
      this.particles.frustumCulled = false;
    }

    makePaths() {
      const {run} = this, {grid, ground} = run;
      const heightAt = point => {
        if (point.length > 2 && navvy.isNumber(point[2])) return point[2];
        if (!ground) return 0;
        const clamp = (v, n) => Math.max(0, Math.min(n - 1, Math.floor(v)));
        const x = clamp((point[0] - grid.origin_m[0]) / grid.cell_m, grid.nx);
        const y = clamp((point[1] - grid.origin_m[1]) / grid.cell_m, grid.ny);
        return grid.base_m + grid.unit_m * ground.start[y * grid.nx + x];
      };
      this.paths = (run.raw.paths || []).map(path => {
        const geometry = new THREE.BufferGeometry().setFromPoints(path.points.map(point =>
          new THREE.Vector3(point[0], point[1], heightAt(point) + 0.08)));
        return this.add(new THREE.Line(geometry, new THREE.LineBasicMaterial({color: 0xe0a800})));
      });
    }

    update(time) {
      const at = navvy.between(this.run.frames.times, time);
      this.links.forEach((group, i) => setPose(group, navvy.linkPose(this.run, i, at)));
      this.cylinders.forEach((one, i) => this.moveCylinder(one, i, at));
      this.forces.forEach((arrow, i) => this.moveForce(arrow, i, at));
      this.showParticles(navvy.indexAt(this.run.frames.times, time));
    }

    six(values, count, i, at) {
      return [0, 1, 2, 3, 4, 5].map(k => navvy.blend(values, 6 * count, 6 * i + k, at));
    }

    moveCylinder(one, i, at) {
      const p = this.six(this.run.frames.cylinders, this.cylinders.length, i, at);
      const base = new THREE.Vector3(p[0], p[1], p[2]), pin = new THREE.Vector3(p[3], p[4], p[5]);
      const length = base.distanceTo(pin);
      const turn = new THREE.Quaternion().setFromUnitVectors(
        new THREE.Vector3(...kAlong), pin.clone().sub(base).normalize());
      for (const [mesh, size] of [[one.barrel, Math.min(one.length, length)], [one.rod, length]]) {
        mesh.visible = length > 1e-4;
        mesh.position.copy(base);
        mesh.quaternion.copy(turn);
        mesh.scale.set(1, 1, Math.max(size, 1e-4));
      }
    }

    moveForce(arrow, i, at) {
      const f = this.six(this.run.frames.forces, this.forces.length, i, at);
      const size = Math.hypot(f[3], f[4], f[5]);
      arrow.visible = this.showForces !== false && this.perMetre > 0 && size > 0.01 * this.perMetre;
      if (!arrow.visible) return;
      arrow.position.set(f[0], f[1], f[2]);
      arrow.setDirection(new THREE.Vector3(f[3] / size, f[4] / size, f[5] / size));
      const length = size / this.perMetre;
      arrow.setLength(length, Math.min(0.3, 0.4 * length), Math.min(0.16, 0.2 * length));
    }

    showParticles(frame) {
      const {frames, grid} = this.run, {geometry} = this.particles;
      const unit = grid ? grid.particle_unit_m || 0.01 : 0;
      const from = frames.particleOffsets[Math.max(0, frame)];
      const count = frame < 0 || !grid ? 0 : frames.particleOffsets[frame + 1] - from;
      const position = geometry.attributes.position.array;
      for (let i = 0; i < count; ++i) {
        const at = 3 * (from + i);
        position[3 * i] = grid.origin_m[0] + unit * frames.particles[at];
        position[3 * i + 1] = grid.origin_m[1] + unit * frames.particles[at + 1];
        position[3 * i + 2] = grid.base_m + unit * frames.particles[at + 2];
      }
      geometry.setDrawRange(0, count);
      geometry.attributes.position.needsUpdate = true;
    }
  }
  navvy.Movers = Movers;
})();
