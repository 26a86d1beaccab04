// SPDX-License-Identifier: Apache-2.0
// Table of the dig cycles. A row zooms the charts to its cycle and sets the time.
(function () {
  'use strict';
  const navvy = window.navvy = window.navvy || {};
  const {el} = navvy;

  const kColumns = [
    ['Start [s]', c => c.start_s, 1, 1], ['Lift-out [s]', c => c.lift_out_s, 1, 1],
    ['Duration [s]', c => c.end_s - c.start_s, 1, 1],
    ['Payload at lift-out [kg]', c => c.payload_at_lift_out_kg, 1, 1],
    ['Payload at dump [kg]', c => c.payload_at_dump_kg, 1, 1],
    ['Peak force [kN]', c => c.force_peak_n, 1e-3, 2],
    ['Peak digging force [kN]', c => c.draft_peak_n, 1e-3, 2],
    ['Peak uplift [kN]', c => c.uplift_peak_n, 1e-3, 2]
  ];

  function cell(cycle, [, read, scale, decimals]) {
    const value = read(cycle);
    return navvy.quantity(value, '', navvy.isNumber(value) ?
      navvy.fixed(value * scale, decimals) : undefined);
  }

  function row(cycle, index, act) {
    const line = el('tr', {tabindex: 0, class: 'chooses',
                           title: 'Show this cycle in the charts', onclick: act,
                           onkeydown: event => { if (event.key === 'Enter') act(); }},
                    el('td', {class: 'numeric'}, index + 1), el('td', null, cycle.machine));
    for (const column of kColumns) line.append(el('td', {class: 'numeric'}, cell(cycle, column)));
    return line;
  }

  // Table whose rows call choose(cycle).
  navvy.cycleTable = function (run, choose) {
    const list = run.summary && run.summary.cycle_list;
    if (!list || !list.length)
      return navvy.absent(list ? 'No dig cycle was completed.' :
        'Without summary.json there is no list of cycles.');
    const holder = navvy.table([{text: 'No.', numeric: true}, 'Machine'].concat(
      kColumns.map(([text]) => ({text, numeric: true}))), [], {id: 'cycles'});
    const body = holder.querySelector('tbody');
    list.forEach((cycle, index) => {
      const line = row(cycle, index, () => {
        body.querySelectorAll('.chosen').forEach(other => other.classList.remove('chosen'));
        line.classList.add('chosen');
        choose(cycle);
      });
      body.append(line);
    });
    holder.classList.add('tall');
    return holder;
  };
})();
