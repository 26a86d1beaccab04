// SPDX-License-Identifier: Apache-2.0
// Groups channels of telemetry.csv into charts, by their names and units.
(function () {
  'use strict';
  const navvy = window.navvy = window.navvy || {};

  // Units that people read, with the factor from the unit of the file.
  const kShown = {
    'N': ['kN', 1e-3], 'N m': ['kN\u00b7m', 1e-3], 'Pa': ['MPa', 1e-6], 'W': ['kW', 1e-3],
    'rad': ['\u00b0', 180 / Math.PI], 'rad/s': ['\u00b0/s', 180 / Math.PI],
    'm3/s': ['L/min', 60000], '1': ['', 1]
  };
  navvy.shownUnit = unit => kShown[unit] || [unit || '', 1];

  // Charts of a machine in the order of the page. `more` groups are only drawn on demand.
  const kGroups = [
    {title: 'Payload', unit: 'kg', match: /\/payload$/},
    {title: 'Soil force on tools', unit: 'N', match: /\/smooth_force_[xyz]$/, or: /\/force_[xyz]$/},
    {title: 'Cylinder forces', unit: 'N', match: /\/cylinder_force$/},
    {title: 'Cylinder pressures', unit: 'Pa', match: /^(?!.*\/pump\/).*pressure/},
    {title: 'Pump pressure', unit: 'Pa', match: /\/pump\/pressure$/},
    {title: 'Power', unit: 'W', match: /\/power$/, pump: true},
    {title: 'Joint speeds', unit: 'rad/s', match: /\/velocity$/},
    {title: 'Joint speeds', unit: 'm/s', match: /\/velocity$/},
    {title: 'Speed of the machine', unit: 'm/s', match: /\/velocity\/[xyz]$/},
    {title: 'Pump flow', unit: 'm3/s', match: /\/pump\/flow$/, more: true},
    {title: 'Rock force on tools', unit: 'N', match: /\/rock_force_[xyz]$/, more: true},
    {title: 'Joint angles', unit: 'rad', match: /\/position$/, more: true},
    {title: 'Joint positions', unit: 'm', match: /\/position$/, more: true},
    {title: 'Wheel slip', unit: '1', match: /\/slip$/, more: true},
    {title: 'Tyre loads', unit: 'N', match: /\/load$/, more: true},
    {title: 'Stability margin', unit: 'm', match: /\/stability\/(loaded_)?margin$/, more: true}
  ];
  const kMostSeries = 8;

  // Machines that have channels, in the order of the file.
  navvy.machinesOf = function (telemetry) {
    const names = new Set();
    for (const name of telemetry.names) {
      const slash = name.indexOf('/');
      if (slash > 0 && !name.startsWith('soil/')) names.add(name.slice(0, slash));
    }
    return [...names];
  };

  function largest(column) {
    let most = 0;
    for (const value of column) if (Math.abs(value) > most) most = Math.abs(value);
    return most;
  }

  function scaled(column, factor) {
    return factor === 1 ? column : column.map(value => value * factor);
  }

  // Name of a channel without the machine, and without the part that all of a chart share.
  function shortLabel(name, machine) {
    const text = name.startsWith(machine + '/') ? name.slice(machine.length + 1) : name;
    const short = text.replace(/\/(payload|cylinder_force|velocity|position|slip|load)$/, '')
      .replace(/_joint$/, '').replace(/(smooth_|rock_)?force_/, '').replace(/^velocity\//, '');
    return short || text;
  }

  function channel(telemetry, index, label) {
    const [unit, factor] = navvy.shownUnit(telemetry.units[index]);
    return {name: telemetry.names[index], label, unit,
            values: scaled(telemetry.column(index), factor)};
  }

  // Series of a machine that match a pattern and a unit and are not zero throughout.
  function matching(telemetry, machine, pattern, unit) {
    const found = [];
    telemetry.names.forEach((name, index) => {
      if (!name.startsWith(machine + '/') || !pattern.test(name)) return;
      if (telemetry.units[index] !== unit || largest(telemetry.column(index)) === 0) return;
      found.push(channel(telemetry, index, shortLabel(name, machine)));
    });
    return found;
  }

  // Hydraulic power of the pump; no channel holds it, so it is formed from pressure and flow.
  function pumpPower(telemetry, machine) {
    const pressure = telemetry.names.indexOf(machine + '/pump/pressure');
    const flow = telemetry.names.indexOf(machine + '/pump/flow');
    if (pressure < 0 || flow < 0) return [];
    const p = telemetry.column(pressure), q = telemetry.column(flow);
    const values = p.map((value, i) => value * q[i] / 1000);
    if (largest(values) === 0) return [];
    return [{name: '', label: 'pump: pressure \u00d7 flow', unit: 'kW', values}];
  }

  function most(series) {
    if (series.length <= kMostSeries) return series;
    const size = new Map(series.map(one => [one, largest(one.values)]));
    const kept = [...series].sort((a, b) => size.get(b) - size.get(a)).slice(0, kMostSeries);
    return series.filter(one => kept.includes(one));
  }

  // Returns [{title, unit, series, of, more}] for a machine; `of` counts the series found.
  navvy.chartGroups = function (telemetry, machine) {
    const charts = [];
    for (const group of kGroups) {
      let series = matching(telemetry, machine, group.match, group.unit);
      if (!series.length && group.or) series = matching(telemetry, machine, group.or, group.unit);
      if (group.pump) series = series.concat(pumpPower(telemetry, machine));
      if (!series.length) continue;
      charts.push({title: group.title, unit: navvy.shownUnit(group.unit)[0], series: most(series),
                   of: series.length, more: Boolean(group.more)});
    }
    const particles = telemetry.names.indexOf('soil/particles');
    if (particles >= 0 && largest(telemetry.column(particles)) > 0)
      charts.push({title: 'Active particles', unit: '', of: 1, more: true,
                   series: [channel(telemetry, particles, 'soil/particles')]});
    return charts;
  };

  // Chart of a single channel.
  navvy.channelChart = function (telemetry, index) {
    const series = channel(telemetry, index, telemetry.names[index]);
    return {title: telemetry.names[index], unit: series.unit, series: [series], of: 1};
  };
})();
