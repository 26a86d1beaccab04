// SPDX-License-Identifier: Apache-2.0
// Key results: the numbers of summary.json that describe the work.
(function () {
  'use strict';
  const navvy = window.navvy = window.navvy || {};
  const {el} = navvy;

  const at = (object, path) =>
    path.split('/').reduce((o, key) => o === undefined || o === null ? undefined : o[key], object);

  // Mean of a value over the machines that have it, weighted by their cycles.
  function overMachines(summary, key) {
    const machines = (at(summary, 'score/machines') || []).filter(m => navvy.isNumber(m[key]));
    const cycles = machines.reduce((sum, m) => sum + m.cycles, 0);
    if (!cycles) return undefined;
    if (machines.length === 1) return machines[0][key];
    return machines.reduce((sum, m) => sum + m.cycles * m[key], 0) / cycles;
  }

  function meanPayload(summary) {
    const mean = overMachines(summary, 'payload_mean_kg');
    const list = summary.payload_kg || [];
    if (mean !== undefined || !list.length) return mean;
    return list.reduce((a, b) => a + b, 0) / list.length;
  }

  function inAndOut(summary, key) {
    const parts = [at(summary, 'score/inside/' + key), at(summary, 'score/outside/' + key)];
    const known = parts.filter(navvy.isNumber);
    return known.length ? known.reduce((a, b) => a + b, 0) : undefined;
  }

  // Rows [key, label, unit, value of a summary] of the main results; the comparison uses them too.
  const kMain = [
    ['cycles', 'Cycles', '', s => s.cycles],
    ['payload_mean_kg', 'Mean payload', 'kg', meanPayload],
    ['fill_factor', 'Mean fill factor', '', s => overMachines(s, 'fill_factor_mean')],
    ['bank_volume_m3', 'Bank volume dug', 'm\u00b3', s => s.bank_volume_m3],
    ['bank_volume_m3_per_h', 'Production, bank', 'm\u00b3/h',
     s => at(s, 'score/bank_volume_m3_per_h')],
    ['energy_kj_per_m3', 'Energy per bank volume', 'kJ/m\u00b3',
     s => at(s, 'score/energy_kj_per_m3')],
    ['cut_m3', 'Cut', 'm\u00b3', s => inAndOut(s, 'cut_m3')],
    ['fill_m3', 'Fill', 'm\u00b3', s => inAndOut(s, 'fill_m3')]
  ];
  const kMore = [
    ['loose_volume_m3', 'Loose volume', 'm\u00b3', s => s.loose_volume_m3],
    ['moved_kg', 'Mass moved', 'kg', s => at(s, 'score/moved_kg')],
    ['moved_t_per_h', 'Mass moved per hour', 't/h', s => at(s, 'score/moved_t_per_h')],
    ['work_time_s', 'Work time', 's', s => at(s, 'score/work_time_s')],
    ['energy_j', 'Work of drives and cylinders', 'J', s => s.energy_j],
    ['bucket_force_peak_n', 'Peak soil force on a tool', 'N', s => s.bucket_force_peak_n],
    ['bucket_draft_peak_n', 'Peak digging force', 'N', s => s.bucket_draft_peak_n],
    ['rock_force_peak_n', 'Peak rock force on a tool', 'N', s => s.rock_force_peak_n],
    ['collision_count', 'Collisions', '', s => s.collision_count],
    ['particles_peak', 'Active particles, peak', '', s => s.particles_peak],
    ['simulated_time_s', 'Simulated time', 's', s => s.simulated_time_s],
    ['wall_time_s', 'Wall time', 's', s => s.wall_time_s],
    ['real_time_factor', 'Real-time factor', '', s => s.real_time_factor]
  ];
  const kShape = [
    ['completion', 'Completion', '1'], ['coverage', 'Coverage', '1'],
    ['volume_error', 'Volume error', '1'], ['rms_error_m', 'Error, rms', 'm'],
    ['over_dig_rms_m', 'Over-dig, rms', 'm'], ['over_dig_max_m', 'Over-dig, largest', 'm'],
    ['under_dig_rms_m', 'Under-dig, rms', 'm'], ['under_dig_max_m', 'Under-dig, largest', 'm'],
    ['batter_deg', 'Batter', '\u00b0'], ['design_batter_deg', 'Batter of the design', '\u00b0']
  ].map(([key, label, unit]) => ['shape/' + key, label, unit, s => at(s, 'score/shape/' + key)]);

  navvy.resultRows = () => kMain.concat(kMore, kShape);

  // Shows shares in percent, work in kJ and forces in kN; data-value keeps the unit of the file.
  navvy.resultValue = function (value, unit) {
    if (unit === '1') return navvy.quantity(value, '', navvy.percent(value));
    if (unit === 'J' || unit === 'N')
      return navvy.quantity(value, 'k' + unit, navvy.number(value / 1000));
    return navvy.quantity(value, unit);
  };

  function tile(summary, [key, label, unit, read]) {
    return el('div', {class: 'tile', 'data-key': key}, el('div', {class: 'label'}, label),
              navvy.resultValue(read(summary), unit));
  }

  function listOf(title, summary, rows, id) {
    const known = rows.filter(row => navvy.isNumber(row[3](summary)));
    return el('div', {class: 'block'}, el('h3', null, title), navvy.table(
      ['Quantity', {text: 'Value', numeric: true}],
      known.map(([, label, unit, read]) => [label, navvy.resultValue(read(summary), unit)]), {id}));
  }

  function shape(summary) {
    const title = 'Shape against the design';
    if (at(summary, 'score/shape')) return listOf(title, summary, kShape, 'shape');
    return el('div', {class: 'block'}, el('h3', null, title),
              navvy.absent('The scene has no design and no dig area, so no shape is scored.'));
  }

  function volumes(summary) {
    const rows = [['Inside the design', 'inside'], ['Outside the design', 'outside']].map(
      ([label, key]) => [label].concat(['cut_m3', 'fill_m3'].map(
        which => navvy.quantity(at(summary, `score/${key}/${which}`), ''))));
    const design = at(summary, 'score/shape');
    if (design)
      rows.push(['Commanded by the design', navvy.quantity(design.design_cut_m3, ''),
                 navvy.quantity(design.design_fill_m3, '')]);
    return navvy.table(['Volume [m\u00b3]', {text: 'Cut', numeric: true},
                        {text: 'Fill', numeric: true}], rows, {id: 'volumes'});
  }

  const kMachine = [
    ['cycles', 'Cycles'], ['cycle_mean_s', 'Cycle [s]', 'cycle_spread_s'],
    ['payload_mean_kg', 'Payload [kg]', 'payload_spread_kg'],
    ['fill_factor_mean', 'Fill factor', 'fill_factor_spread'], ['stations', 'Stations'],
    ['distance_driven_m', 'Driven [m]'], ['work_j', 'Work [kJ]']
  ];

  function machineCell(machine, [key, , spread]) {
    const value = machine[key];
    const cell = navvy.quantity(value, '',
                                key === 'work_j' ? navvy.number(value / 1000) : undefined);
    if (spread && navvy.isNumber(machine[spread]))
      cell.append(el('span', {class: 'muted'}, ' \u00b1 ' + navvy.number(machine[spread], 2)));
    return cell;
  }

  function machines(summary) {
    const list = at(summary, 'score/machines') || [];
    if (!list.length) return null;
    const headings = ['Machine'].concat(kMachine.map(([, text]) => ({text, numeric: true})));
    return el('div', {class: 'block'}, el('h3', null, 'Machines (mean \u00b1 standard deviation)'),
              navvy.table(headings, list.map(machine =>
                [machine.machine].concat(kMachine.map(row => machineCell(machine, row))))));
  }

  navvy.showResults = function (run) {
    const body = navvy.sectionBody('results'), summary = run.summary;
    if (!summary) {
      body.append(navvy.absent('This run has no summary.json, so there are no results.'));
      return;
    }
    body.append(el('div', {class: 'tiles'}, kMain.map(row => tile(summary, row))));
    const table = machines(summary);
    if (table) body.append(table);
    const cut = el('div', {class: 'block'}, el('h3', null, 'Cut and fill'), volumes(summary));
    body.append(el('div', {class: 'columns'}, el('div', {class: 'stack'}, cut, shape(summary)),
                   listOf('Further results', summary, kMore, 'more')));
  };
})();
