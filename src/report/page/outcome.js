// SPDX-License-Identifier: Apache-2.0
// Head of the page, outcome of the programs, mass ledger, goals and forbidden event.
(function () {
  'use strict';
  const navvy = window.navvy = window.navvy || {};
  const {el} = navvy;

  function fact(name, value) {
    if (value === null || value === undefined || value === '') return null;
    return el('div', {class: 'fact'}, el('dt', null, name), el('dd', null, value));
  }

  // Buttons that choose which of two runs the sections below show.
  function runChoice(runs, index, act) {
    if (runs.length < 2) return null;
    const entries = runs.map((run, i) => [i, 'AB'[i] + ': ' + (run.raw.folder || run.name)]);
    return el('div', {class: 'run-choice'}, el('span', {class: 'label'}, 'Run shown'),
              navvy.choice('Run shown', entries, index, act));
  }

  function notesOf(run) {
    const notes = (run.raw.notes || []).concat(run.faults);
    if (!run.raw.complete)
      notes.unshift('This run is not complete: it was stopped or broke off, or files are missing.');
    if (!notes.length) return null;
    return el('ul', {class: 'notes'}, notes.map(note => el('li', null, note)));
  }

  navvy.showHead = function (data, runs, index, choose) {
    const head = navvy.clear(document.getElementById('head'));
    const run = runs[index], summary = run.summary || {}, info = run.raw.run || {};
    const status = summary.status || (run.raw.complete ? null : 'incomplete');
    head.append(
      el('p', {class: 'kicker'}, 'Navvy run report'),
      el('div', {class: 'title'}, el('h1', null, run.name || 'Run without a name'),
         status ? navvy.badge(status, navvy.stateKind(status)) : null));
    if (summary.message) head.append(el('p', {class: 'reason'}, summary.message));
    head.append(el('dl', {class: 'facts'}, [
      fact('Folder', run.raw.folder),
      fact('Device', summary.device || info.device),
      fact('Navvy', info.navvy || data.version),
      fact('Simulated time', summary.simulated_time_s === undefined ? null :
        navvy.quantity(summary.simulated_time_s, 's')),
      fact('Real-time factor', summary.real_time_factor === undefined ? null :
        navvy.quantity(summary.real_time_factor, '')),
      fact('State hash', summary.state_hash ? el('code', null, summary.state_hash) : null),
      fact('Report made', (data.made || '').replace('T', ' ').replace('Z', ' UTC'))
    ].filter(Boolean)));
    head.append(...[notesOf(run), runChoice(runs, index, choose)].filter(Boolean));
  };

  function stepRow(step) {
    return [step.step, step.kind, navvy.badge(step.state, navvy.stateKind(step.state)),
            el('span', {class: 'reason'}, step.reason || ''),
            navvy.quantity(step.start_s, '', navvy.fixed(step.start_s, 1)),
            navvy.quantity(step.end_s, '', navvy.fixed(step.end_s, 1))];
  }

  function program(one) {
    const count = one.steps ? `step ${one.step} of ${one.steps}` : one.kind;
    const line = el('summary', null, el('strong', null, one.machine), ' ',
                    navvy.badge(one.state, navvy.stateKind(one.state)),
                    el('span', {class: 'muted'}, `${count}, at ${navvy.fixed(one.time_s, 1)} s`),
                    one.reason ? el('span', {class: 'reason'}, one.reason) : null);
    const steps = one.step_list || [];
    if (!steps.length) return el('div', {class: 'program'}, ...line.childNodes);
    const headings = [{text: 'Step', numeric: true}, 'Kind', 'State', 'Reason',
                      {text: 'Start [s]', numeric: true}, {text: 'End [s]', numeric: true}];
    return el('details', {class: 'program', open: steps.length <= 8}, line,
              navvy.table(headings, steps.map(stepRow)));
  }

  function programs(summary) {
    const list = summary.programs || [];
    return el('div', {class: 'block'}, el('h3', null, 'Programs'),
              list.length ? list.map(program) : navvy.absent('No machine has a program.'));
  }

  function ledgerRow(soil) {
    const keys = ['columns_change_kg', 'particles_kg', 'left_site_kg', 'loaded_kg'];
    return [soil.soil].concat(keys.map(key =>
      navvy.quantity(soil[key], '', navvy.fixed(soil[key], 1))));
  }

  function ledger(summary) {
    const ledger = summary.mass_ledger, block = el('div', {class: 'block'});
    block.append(el('h3', null, 'Mass ledger'));
    if (!ledger) {
      block.append(navvy.absent('The summary has no mass ledger.'));
      return block;
    }
    const units = ledger.error_units;
    const verdict = units === 0 ? navvy.badge('balanced', 'good') :
      navvy.badge('not balanced', 'bad');
    block.append(el('p', {id: 'ledger'}, verdict, ' ', el('span', {class: 'muted'},
      units === 0 ? 'No mass was lost or created.' :
        `Error ${navvy.number(units * ledger.unit_kg)} kg (${navvy.number(units)} units).`)));
    const headings = ['Mass [kg] of soil'].concat(
      ['Change of the ground', 'Active particles', 'Left the site', 'Loaded at the start'].map(
        text => ({text, numeric: true})));
    block.append(navvy.table(headings, (ledger.soils || []).map(ledgerRow)));
    return block;
  }

  function goalRow(goal) {
    const least = goal.at_least !== undefined, bound = least ? goal.at_least : goal.at_most;
    return [goal.goal, (least ? 'at least ' : 'at most ') + navvy.number(bound),
            goal.value === undefined ? goal.reason || 'not measured' :
              navvy.quantity(goal.value, ''),
            navvy.badge(goal.met ? 'met' : 'missed', goal.met ? 'good' : 'bad')];
  }

  function goals(summary) {
    const list = summary.goals || [];
    const headings = ['Goal', 'Bound', {text: 'Value', numeric: true}, 'Result'];
    return el('div', {class: 'block'}, el('h3', null, 'Goals'),
              list.length ? navvy.table(headings, list.map(goalRow), {id: 'goals'}) :
                navvy.absent('The scene has no goals.'));
  }

  function forbidden(event) {
    if (!event) return null;
    return el('p', {class: 'alarm'}, navvy.badge('forbidden event', 'bad'), ' ',
              el('strong', null, event.event), ` at ${navvy.fixed(event.time_s, 2)} s. `,
              event.reason || '');
  }

  navvy.showOutcome = function (run) {
    const body = navvy.sectionBody('outcome'), summary = run.summary;
    if (!summary) {
      body.append(navvy.absent('This run has no summary.json, so its outcome is not known.'));
      return;
    }
    const event = forbidden(summary.forbidden_event);
    if (event) body.append(event);
    body.append(programs(summary),
                el('div', {class: 'columns'}, ledger(summary), goals(summary)));
  };
})();
