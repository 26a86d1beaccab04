// SPDX-License-Identifier: Apache-2.0
// Reads the data and fills the page. `window.navvy.ready` is resolved when all is shown.
(function () {
  'use strict';
  const navvy = window.navvy = window.navvy || {};

  let shown = null;

  // Shows a run in all sections below the comparison.
  function showRun(data, runs, index) {
    if (shown) {
      shown.clock && shown.clock.stop();
      shown.parts.forEach(part => part && part.destroy && part.destroy());
    }
    const run = runs[index], clock = run.span ? new navvy.Clock(run.span) : null;
    navvy.showHead(data, runs, index, value => showRun(data, runs, +value));
    navvy.showPlayer(run, clock);
    navvy.showOutcome(run);
    navvy.showResults(run);
    const parts = [navvy.showCharts(run, clock), navvy.showPlan(run, clock),
                   navvy.showScene3d(run, clock)];
    navvy.showMedia(run, clock);
    navvy.showSceneText(run);
    if (clock) clock.set(clock.time);
    shown = {run, clock, parts};
    navvy.shown = shown;
  }

  function showContents() {
    const bar = navvy.clear(document.getElementById('contents'));
    for (const section of document.querySelectorAll('main > section'))
      bar.append(navvy.el('a', {href: '#' + section.id}, section.querySelector('h2').textContent));
  }

  async function start() {
    const data = navvy.readDocument();
    const runs = await Promise.all(data.runs.map(navvy.readRun));
    navvy.runs = runs;
    if (data.live) {
      shown = await navvy.showLive(data, runs[0]);
      navvy.shown = shown;
      navvy.onRedraw(reason => shown.parts.forEach(part => part && part.redraw(reason)));
      return;
    }
    const comparison = navvy.showComparison(runs);
    showRun(data, runs, 0);
    showContents();
    navvy.onRedraw(reason => {
      if (comparison) comparison.redraw(reason);
      shown.parts.forEach(part => part && part.redraw && part.redraw(reason));
    });
  }

  // Heights of a run (its number or the run) at a time: {nx, ny, values [m]}; null without heights.
  navvy.heights = function (run, time) {
    const one = typeof run === 'number' ? navvy.runs[run] : run;
    return one && one.ground ? one.ground.heights(time) : null;
  };

  function refuse(error) {
    document.querySelector('main').hidden = true;
    navvy.clear(document.getElementById('head')).append(navvy.el('h1', null, 'Navvy run report'),
      navvy.absent(`This page cannot be shown: ${error.message || error}.`));
  }

  navvy.ready = new Promise((resolve, reject) => {
    const go = () => start().then(resolve, error => { refuse(error); reject(error); });
    if (document.readyState === 'loading') document.addEventListener('DOMContentLoaded', go);
    else go();
  });
  // The page already says why; the console need not repeat it.
  navvy.ready.catch(() => {});
})();
