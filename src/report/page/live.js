// SPDX-License-Identifier: Apache-2.0
// A run as it goes on: frames arrive as server-sent events, commands are sent by POST.
(function () {
  'use strict';
  const navvy = window.navvy = window.navvy || {};
  const {el} = navvy;

  // Longest interval without a new value of a slider that is being moved [ms].
  const kCommandPeriod = 50;
  // Particles that a frame may hold, with the few that its thinning may add.
  const kMostParticles = 4096;
  // Ground around the machines [m] that is shown finely from the start.
  const kMargin = 6;

  // Replaces the only frame of a run by a row of a replay.
  function takeFrame(run, row) {
    const array = (key, Type) => navvy.plainArray(row[key], Type, key);
    const poses = array('poses', Float32Array), cylinders = array('cylinders', Float32Array);
    const forces = array('forces', Float32Array), particles = array('particles', Int16Array);
    if (poses.length !== 7 * run.links.length ||
        cylinders.length !== 6 * (run.raw.cylinders || []).length ||
        forces.length !== 6 * (run.raw.forces || []).length || particles.length % 3)
      throw new Error('a frame does not fit the header');
    if (run.ground) run.ground.take(array('tiles', Int16Array));
    const count = Math.min(kMostParticles, particles.length / 3);
    run.frames = Object.assign(run.frames || {}, {
      times: [row.time_s], poses, cylinders, forces, particles, particleOffsets: [0, count],
      mostParticles: kMostParticles
    });
  }

  // Sends a command; its refusal is shown, not thrown.
  async function send(page, command) {
    try {
      const answer = await fetch('control', {
        method: 'POST', headers: {'Content-Type': 'application/json'}, body: JSON.stringify(command)
      });
      const text = await answer.json();
      page.say(answer.ok ? '' : text.error);
    } catch (error) {
      page.say('The run does not answer.');
    }
  }

  // Head of the page: name, state and numbers that change.
  class Head {
    constructor(data, run) {
      this.state = el('span', {class: 'badge fair', id: 'state'}, 'waiting');
      this.values = {};
      const facts = el('dl', {class: 'facts'});
      for (const [key, label] of [['time', 'Simulated time'], ['speed', 'Speed'],
                                  ['step', 'Steps'], ['particles', 'Active particles'],
                                  ['phase', 'Machines'], ['rate', 'Updates']])
        facts.append(el('div', null, el('dt', null, label),
                        this.values[key] = el('dd', null, '\u2013')));
      this.message = el('p', {class: 'alarm', id: 'message', hidden: true});
      navvy.clear(document.getElementById('head')).append(
        el('p', {class: 'kicker'}, 'Navvy ' + data.version + ', live'),
        el('div', {class: 'title'}, el('h1', null, run.name), this.state), facts, this.message);
    }

    show(key, content) { this.values[key].replaceChildren(content); }

    badge(text, kind) {
      this.state.textContent = text;
      this.state.className = 'badge ' + kind;
    }

    say(text) {
      this.message.hidden = !text;
      this.message.textContent = text;
    }
  }

  // Bar at the bottom: pause, steps, pace.
  function showBar(page) {
    const bar = navvy.clear(document.getElementById('player'));
    const pause = el('button', {type: 'button', class: 'play', id: 'pause',
                                onclick: () => send(page, {pause: !page.paused})}, 'Pause');
    const steps = el('input', {type: 'number', id: 'steps', min: 1, max: 100000, value: 1,
                               'aria-label': 'Number of steps'});
    const step = el('button', {type: 'button', id: 'step', title: 'Take steps, then pause',
                               onclick: () => send(page, {step: Math.max(1, +steps.value || 1)})},
                    'Step');
    const length = page.live.step_s ? `steps of ${navvy.number(1000 * page.live.step_s)} ms` : '';
    const pace = navvy.choice('Pace', [[0, 'As fast as possible'], [1, 'Real time'],
                                       [0.25, '\u00bc real time']], 0,
                              value => send(page, {pace: value}));
    bar.append(pause, step, steps, el('span', {class: 'muted'}, length), pace);
    page.onState(live => {
      pause.textContent = live.paused ? 'Resume' : 'Pause';
      for (const button of pace.children)
        button.setAttribute('aria-pressed', String(+button.dataset.choice === live.pace));
    });
  }

  const endOf = name => name.slice(name.lastIndexOf('/') + 1);
  const partOf = name => name.split('/').slice(1, -1).join('/');

  // Angles are shown in degrees and sent in radians.
  function scaleOf(unit) {
    return /rad/.test(unit) ? {factor: 180 / Math.PI, unit: unit.replace('rad', '\u00b0')} :
      {factor: 1, unit};
  }

  // Row of a joint: name, slider of its target, target, measured value.
  function jointRow(page, input, index) {
    const {factor, unit} = scaleOf(input.unit);
    const target = el('td', {class: 'numeric'}, '\u2013'), measured = el('td', {class: 'numeric'});
    const slider = el('input', {type: 'range', min: input.low, max: input.high, step: 'any',
                                value: 0, 'data-input': input.name,
                                'aria-label': input.name});
    let touched = false;
    slider.addEventListener('input', () => {
      touched = true;
      target.textContent = navvy.fixed(factor * slider.value, 1);
      page.set(input.name, +slider.value);
    });
    page.onState(live => {
      const value = (live.values || [])[index];
      measured.textContent = navvy.fixed(factor * value, 1);
      // Until it is moved, a slider of a position follows the joint.
      const follows = !touched && endOf(input.name) === 'position';
      if (follows && navvy.isNumber(value)) slider.value = value;
    });
    return el('tr', null, el('td', null, partOf(input.name)), el('td', null, slider), target,
              measured, el('td', {class: 'muted'}, unit));
  }

  function jointTable(page, machine, kind) {
    const rows = [];
    page.live.inputs.forEach((input, index) => {
      if (input.machine === machine && endOf(input.name) === kind &&
          navvy.isNumber(input.low) && navvy.isNumber(input.high))
        rows.push(jointRow(page, input, index));
    });
    if (!rows.length) return null;
    const head = ['Joint', kind === 'position' ? 'Target position' : 'Target velocity', 'Target',
                  'Measured', ''].map((text, i) =>
      el('th', {class: i === 2 || i === 3 ? 'numeric' : null, scope: 'col'}, text));
    return el('div', {class: 'scroll', 'data-kind': kind},
              el('table', null, el('thead', null, el('tr', null, head)), el('tbody', null, rows)));
  }

  // Section with the joints of a machine.
  function showJoints(page, machine) {
    const tables = ['position', 'velocity'].map(kind => jointTable(page, machine, kind))
      .filter(table => table);
    if (!tables.length) return null;
    const choose = kind => tables.forEach(table => { table.hidden = table.dataset.kind !== kind; });
    const kinds = tables.map(table => table.dataset.kind);
    choose(kinds[0]);
    const state = el('p', {class: 'muted'});
    page.onState((live, row) => {
      const phase = (row.phases || [])[page.machines.indexOf(machine)];
      state.textContent = phase === 'inputs' ? 'Inputs drive this machine; its program has ended.' :
        phase === 'idle' ? 'This machine has no program.' :
          'Moving a slider ends the program of this machine.';
    });
    return el('section', {class: 'joints'}, el('h2', null, 'Joints of ' + machine),
              navvy.choice('Kind of target', kinds.map(kind =>
                [kind, kind === 'position' ? 'Positions' : 'Velocities']), kinds[0], choose),
              state, tables);
  }

  // The page of a live run: what it knows, and who is told of a new frame.
  class Live {
    constructor(data, run) {
      this.live = data.live;
      this.run = run;
      this.machines = [...new Set(run.links.map(link => link.machine))];
      this.listeners = [];
      this.updates = 0;
      this.arrivals = [];
      this.waiting = {};
      this.head = new Head(data, run);
    }

    onState(act) { this.listeners.push(act); }
    say(text) { this.head.say(text); }

    // Sends the values of sliders, a few times per second at most.
    set(name, value) {
      this.waiting[name] = value;
      if (this.timer) return;
      this.timer = setTimeout(() => {
        this.timer = 0;
        const inputs = this.waiting;
        this.waiting = {};
        send(this, {inputs});
      }, kCommandPeriod);
    }

    take(row) {
      takeFrame(this.run, row);
      ++this.updates;
      this.row = row;
      const now = performance.now();
      this.arrivals.push(now);
      while (this.arrivals[0] < now - 2000) this.arrivals.shift();
      const live = row.live || {};
      this.paused = Boolean(live.paused);
      this.showHead(row, live);
      this.listeners.forEach(act => act(live, row));
    }

    showHead(row, live) {
      const {head} = this;
      head.badge(this.paused ? 'paused' : 'running', this.paused ? 'fair' : 'good');
      head.show('time', navvy.quantity(row.time_s, 's', navvy.fixed(row.time_s, 2)));
      head.show('speed', navvy.isNumber(live.speed) ?
        navvy.fixed(live.speed, 2) + ' \u00d7 real time' : '\u2013');
      head.show('step', navvy.number(live.step));
      head.show('particles', navvy.number(live.particles));
      head.show('phase', this.machines.map((name, i) =>
        name + ': ' + ((row.phases || [])[i] || '\u2013')).join(', ') || '\u2013');
      head.show('rate', navvy.fixed(this.arrivals.length / 2, 0) + ' per second');
      if (live.message) this.say(live.message);
    }

    // Calls act() for each frame. Resolves at the first one, or at the end of the run.
    listen(act) {
      return new Promise(resolve => {
        const source = new EventSource('events');
        source.onmessage = event => {
          try {
            this.take(JSON.parse(event.data));
          } catch (error) {
            this.say(`A frame could not be read: ${error.message || error}.`);
          }
          act();
          resolve();
        };
        source.onerror = () => this.head.badge('not connected', 'bad');
        source.addEventListener('end', event => {
          source.close();
          this.finish(JSON.parse(event.data));
          resolve();
        });
      });
    }

    finish(text) {
      this.ended = true;
      this.head.badge('ended', 'fair');
      document.getElementById('player').hidden = true;
      this.say(text);
      // The folder of an ended run is served as the page of its results.
      if (!this.live.control)
        this.head.message.append(' ', el('a', {href: ''}, 'Show its report'));
    }
  }

  // Shows the live page; resolves when the first frame is drawn.
  navvy.showLive = async function (data, run) {
    run.live = true;
    run.margin_m = kMargin;
    document.body.classList.add('live');
    for (const section of document.querySelectorAll('main > section'))
      if (section.id !== 'scene3d') section.remove();
    document.getElementById('contents').hidden = true;
    document.getElementById('player').hidden = !data.live.control;
    const page = navvy.live = new Live(data, run), parts = [];
    if (data.live.control) {
      showBar(page);
      document.querySelector('main').append(
        ...page.machines.map(name => showJoints(page, name)).filter(section => section));
    }
    if (run.faults.length) page.say(run.faults.join(' '));
    await page.listen(() => {
      if (!run.frames) return;
      if (!parts.length) parts.push(navvy.showScene3d(run, null));
      else if (parts[0]) parts[0].view.refresh();
    });
    return {run, clock: null, parts};
  };
})();
