// SPDX-License-Identifier: Apache-2.0
// Section of the 3D view.
(function () {
  'use strict';
  const navvy = window.navvy = window.navvy || {};
  const {el} = navvy;

  // The renderer serves whichever run is shown, as browsers limit the number of contexts.
  let renderer = null;

  // Returns the renderer, or null in a browser without WebGL. The library would print an error
  // there, so the context is made here.
  function sharedRenderer() {
    if (renderer) return renderer;
    const canvas = el('canvas', {'aria-label': '3D view of ground and machines'});
    const wish = {alpha: true, antialias: true};
    const context = canvas.getContext('webgl2', wish) || canvas.getContext('webgl', wish);
    if (!context) return null;
    renderer = new THREE.WebGLRenderer({canvas, context, alpha: true, antialias: true});
    renderer.gammaOutput = true;  // colours of the data are linear
    renderer.gammaFactor = 2.2;
    return renderer;
  }

  class SceneView {
    constructor(run, clock, body) {
      const canvas = renderer.domElement;
      this.run = run;
      this.clock = clock;
      this.renderer = renderer;
      this.scene = new THREE.Scene();
      this.addLights();
      if (run.ground) this.addGround();
      if (run.frames) this.scene.add((this.movers = new navvy.Movers(run)).object);
      this.addCamera(canvas);
      this.request = navvy.drawWhenSeen(canvas, () => this.draw());
      this.controls.addEventListener('change', this.request);
      if (clock) clock.on(this.request);
      this.text = el('p', {class: 'muted'});
      body.append(this.makeControls(), el('div', {class: 'view3d'}, canvas), this.text);
      this.caption();
      this.home();
      this.draw();
    }

    addLights() {
      this.scene.add(new THREE.HemisphereLight(0xffffff, 0x7a7065, 0.6));
      const sun = new THREE.DirectionalLight(0xffffff, 0.85);
      sun.position.set(-0.5, -0.7, 1);
      this.scene.add(sun);
    }

    addGround() {
      this.ground = new navvy.GroundMesh(this.run);
      this.scene.add(this.ground.object, this.ground.sides);
    }

    // Takes what a live run has changed: scales, and the part of the site that is shown finely.
    refresh() {
      if (this.movers && this.movers.fitForces()) this.caption();
      if (this.ground && navvy.regionGrew(this.run)) {
        const {byChange, object, sides} = this.ground;
        for (const old of [object, sides]) {
          this.scene.remove(old);
          old.geometry.dispose();
          old.material.dispose();
        }
        this.addGround();
        this.ground.byChange = byChange;
      }
      this.request();
    }

    addCamera(canvas) {
      this.camera = new THREE.PerspectiveCamera(40, 1, 0.1, 10000);
      this.camera.up.set(0, 0, 1);
      const controls = this.controls = new THREE.OrbitControls(this.camera, canvas);
      controls.enableKeys = false;
      controls.maxPolarAngle = 0.495 * Math.PI;
      // The wheel scrolls the page until somebody clicks into the view.
      controls.enableZoom = false;
      canvas.onpointerdown = () => { controls.enableZoom = true; };
      canvas.onpointerleave = () => { controls.enableZoom = false; };
    }

    // Middle [m] and size [m] of the part of the site where work is done.
    extent() {
      const {run} = this;
      if (!run.grid) {
        const pose = run.links.length ? navvy.linkPose(run, 0, {a: 0, b: 0, share: 0}) : [0, 0, 0];
        return {middle: new THREE.Vector3(pose[0], pose[1], pose[2]), size: 12};
      }
      const {x0, y0, x1, y1} = navvy.activeRegion(run), {cell_m, origin_m, nx} = run.grid;
      const x = (x0 + x1) / 2, y = (y0 + y1) / 2;
      const z = run.ground.height(Math.floor(y) * nx + Math.floor(x));
      return {middle: new THREE.Vector3(origin_m[0] + x * cell_m, origin_m[1] + y * cell_m, z),
              size: Math.max(4, Math.hypot(x1 - x0, y1 - y0) * cell_m)};
    }

    home() {
      const {middle, size} = this.extent();
      const {clientWidth: width, clientHeight: height} = this.renderer.domElement;
      // A narrow view needs more distance to show the same width.
      const far = 1.15 * size * Math.max(1, 1.6 * height / (width || height));
      // The near half of the ground takes more of the picture, so the view aims below the middle.
      middle.z -= 0.12 * size;
      this.controls.target.copy(middle);
      this.camera.position.copy(middle).add(
        new THREE.Vector3(-0.5, -0.68, 0.6).multiplyScalar(far));
      this.camera.near = size / 200;
      this.camera.far = size * 100;
      this.camera.updateProjectionMatrix();
      this.controls.update();
    }

    makeControls() {
      const bar = el('div', {class: 'controls'});
      const button = (text, act) => bar.append(el('button', {
        type: 'button', onclick: () => { act(); this.request(); }}, text));
      if (this.ground)
        bar.append(navvy.choice('Colour of the ground', [[1, 'Cut and fill'], [0, 'Soil']], 1,
          value => { this.ground.byChange = Boolean(value); this.request(); }));
      if (this.movers && (this.movers.perMetre > 0 || this.run.live))
        bar.append(navvy.choice('Force arrows', [[1, 'Forces'], [0, 'No forces']], 1,
          value => { this.movers.showForces = Boolean(value); this.request(); }));
      if (this.movers && this.movers.particles.geometry.attributes.position.count > 0)
        bar.append(navvy.choice('Loose particles', [[1, 'Particles'], [0, 'No particles']], 1,
          value => { this.movers.particles.visible = Boolean(value); this.request(); }));
      button('Reset view', () => this.home());
      button('From above', () => this.above());
      return bar;
    }

    above() {
      const {middle, size} = this.extent();
      this.controls.target.copy(middle);
      this.camera.position.copy(middle).add(new THREE.Vector3(0, -0.01 * size, 1.3 * size));
      this.controls.update();
    }

    caption() {
      const forces = this.movers && this.movers.perMetre > 0 ?
        ` Force arrows: 1 m is ${navvy.number(this.movers.perMetre / 1000)} kN.` : '';
      const missing = this.movers ? '' :
        ' The run has no recorded frames, so no machines are shown.';
      this.text.textContent = 'Drag to turn, right button to move, click and wheel to zoom. ' +
        'Ground red where cut, blue where filled.' + forces + missing;
    }

    draw() {
      const {clientWidth: width, clientHeight: height} = this.renderer.domElement;
      if (!width || !height) return;
      this.renderer.setPixelRatio(Math.min(2, window.devicePixelRatio || 1));
      this.renderer.setSize(width, height, false);
      this.camera.aspect = width / height;
      this.camera.updateProjectionMatrix();
      const time = this.clock ? this.clock.time : Infinity;
      if (this.ground) {
        this.run.ground.seek(time);
        this.ground.update();
      }
      if (this.movers) this.movers.update(time);
      this.renderer.render(this.scene, this.camera);
    }

    destroy() {
      this.controls.dispose();
      this.scene.traverse(object => {
        if (object.geometry) object.geometry.dispose();
        if (object.material) object.material.dispose();
      });
    }
  }

  navvy.showScene3d = function (run, clock) {
    const body = navvy.sectionBody('scene3d');
    const refuse = text => { body.append(navvy.absent(text)); return null; };
    if (!run.ground && !run.frames)
      return refuse('This run has neither readable heights nor frames, so there is no 3D view.');
    if (!window.THREE || !THREE.OrbitControls)
      return refuse('The library of the 3D view is missing in this page.');
    if (!sharedRenderer())
      return refuse('This browser has no WebGL, so the 3D view is left out. The rest of the page ' +
                    'works without it.');
    const view = new SceneView(run, clock, body);
    return {view, redraw: view.request, destroy: () => view.destroy()};
  };
})();
