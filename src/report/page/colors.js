// SPDX-License-Identifier: Apache-2.0
// Colours of changes in height: red is cut, blue is fill, and more colour means more change.
(function () {
  'use strict';
  const navvy = window.navvy = window.navvy || {};

  const kLight = {cut: [[244, 165, 130], [178, 24, 43]], none: [238, 236, 231],
                  fill: [[146, 197, 222], [33, 102, 172]]};
  const kDark = {cut: [[150, 66, 48], [255, 138, 101]], none: [52, 57, 63],
                 fill: [[38, 96, 140], [100, 190, 255]]};

  const mix = (a, b, t) => [0, 1, 2].map(i => a[i] + (b[i] - a[i]) * t);

  // Colour (0 to 255) of a share -1 (cut) to 1 (fill).
  function between(scheme, share) {
    const [half, full] = share < 0 ? scheme.cut : scheme.fill;
    const size = Math.min(1, Math.abs(share));
    return size < 0.5 ? mix(scheme.none, half, 2 * size) : mix(half, full, 2 * size - 1);
  }

  // Table of 512 colours, so that painting a map looks each column up.
  navvy.changeColors = function (dark) {
    const table = new Uint8Array(512 * 3);
    for (let i = 0; i < 512; ++i)
      between(dark ? kDark : kLight, (i - 255.5) / 255.5)
        .forEach((value, k) => { table[3 * i + k] = value; });
    return table;
  };

  navvy.changeIndex = function (share) {
    const index = Math.round(255.5 + 255.5 * share);
    return index < 0 ? 0 : index > 511 ? 511 : index;
  };

  // Bar with the colours and values from -limit to limit.
  navvy.scaleBar = function (limit, low, high) {
    const {el} = navvy;
    const table = navvy.changeColors(navvy.isDark()), stops = [];
    for (let i = 0; i <= 16; ++i) {
      const k = 3 * Math.min(511, i * 32);
      stops.push(`rgb(${table[k]},${table[k + 1]},${table[k + 2]})`);
    }
    const bar = el('div', {class: 'bar'});
    bar.style.background = `linear-gradient(to right, ${stops.join(',')})`;
    const decimals = limit < 0.1 ? 3 : limit < 2 ? 2 : 1;
    const ticks = [-1, -0.5, 0, 0.5, 1].map(share =>
      el('span', null, navvy.signed(share * limit, decimals)));
    return el('div', {class: 'scale'},
              el('div', {class: 'ends'}, el('span', null, low), el('span', null, '[m]'),
                 el('span', null, high)), bar, el('div', {class: 'ticks'}, ticks));
  };
})();
