// SPDX-License-Identifier: Apache-2.0
// The chosen time, which charts, plan view and 3D view share, and the bar that sets it.
(function () {
  'use strict';
  const navvy = window.navvy = window.navvy || {};

  class Clock {
    constructor(span) {
      this.start = span[0];
      this.end = span[1];
      this.time = span[1];
      this.speed = 1;
      this.playing = false;
      this.listeners = [];
    }

    on(act) { this.listeners.push(act); }

    set(time) {
      this.time = Math.min(this.end, Math.max(this.start, time));
      for (const act of this.listeners) act(this.time);
    }

    play(on) {
      if (on === this.playing) return;
      this.playing = on;
      if (on && this.time >= this.end) this.time = this.start;
      this.last = performance.now();
      this.set(this.time);
      if (on) requestAnimationFrame(now => this.tick(now));
    }

    tick(now) {
      if (!this.playing) return;
      const next = this.time + this.speed * (now - this.last) / 1000;
      this.last = now;
      if (next >= this.end) this.playing = false;
      this.set(next);
      if (this.playing) requestAnimationFrame(later => this.tick(later));
    }

    // Ends playing for good: another run is shown.
    stop() {
      this.playing = false;
      this.listeners = [];
    }
  }
  navvy.Clock = Clock;

  // Text such as "digger: dig" of the machines whose phase is known at a time.
  function phasesAt(run, time) {
    const parts = [];
    for (const one of run.raw.phases || []) {
      const span = (one.spans || []).find(s => s.start_s <= time && time < s.end_s);
      if (span) parts.push(one.machine + ': ' + span.name);
    }
    return parts.join(', ');
  }

  // Fills the bar at the bottom of the window.
  navvy.showPlayer = function (run, clock) {
    const {el} = navvy, bar = navvy.clear(document.getElementById('player'));
    bar.hidden = !clock;
    if (!clock) return;
    const play = el('button', {type: 'button', class: 'play', title: 'Play or pause',
                               onclick: () => clock.play(!clock.playing)});
    const slider = el('input', {type: 'range', min: clock.start, max: clock.end, step: 'any',
                                'aria-label': 'Time in seconds',
                                oninput: () => { clock.play(false); clock.set(+slider.value); }});
    const speed = navvy.choice('Speed', [[1, '1\u00d7'], [4, '4\u00d7']], clock.speed,
                               value => { clock.speed = value; });
    const time = el('output', {class: 'time'}), phase = el('span', {class: 'phase'});
    bar.append(play, speed, slider, time, phase);
    clock.on(now => {
      play.textContent = clock.playing ? 'Pause' : 'Play';
      slider.value = now;
      time.textContent = navvy.fixed(now, 2) + ' / ' + navvy.fixed(clock.end, 2) + ' s';
      phase.textContent = phasesAt(run, now);
    });
  };
})();
