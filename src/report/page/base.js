// SPDX-License-Identifier: Apache-2.0
// Namespace of the page, creation of elements, and numbers with units as text.
(function () {
  'use strict';
  const navvy = window.navvy = window.navvy || {};

  // Creates an element. Text of the data only ever becomes a text node, never markup.
  navvy.el = function (tag, options, ...children) {
    const element = document.createElement(tag);
    for (const [name, value] of Object.entries(options || {})) {
      if (value === null || value === undefined || value === false) continue;
      if (name === 'class') element.className = value;
      else if (name.startsWith('on')) element.addEventListener(name.slice(2), value);
      else element.setAttribute(name, value === true ? '' : value);
    }
    for (const child of children.flat())
      if (child !== null && child !== undefined)
        element.append(child instanceof Node ? child : String(child));
    return element;
  };

  navvy.clear = function (element) {
    while (element.firstChild) element.removeChild(element.firstChild);
    return element;
  };

  // Body of a section, emptied.
  navvy.sectionBody = id => navvy.clear(document.querySelector('#' + id + ' .body'));

  // One line that says why a section has nothing to show.
  navvy.absent = text => navvy.el('p', {class: 'absent'}, text);

  const kDash = '\u2013', kMinus = '\u2212', kThinSpace = '\u202f';
  const formats = new Map();

  function format(options) {
    const key = JSON.stringify(options);
    if (!formats.has(key)) formats.set(key, new Intl.NumberFormat('en-US', options));
    return formats.get(key);
  }

  function typeset(text) {
    return text.replace(/,/g, kThinSpace).replace('-', kMinus);
  }

  const isNumber = value => typeof value === 'number' && Number.isFinite(value);
  navvy.isNumber = isNumber;

  // Number with four significant digits; whole numbers and large ones are not cut.
  navvy.number = function (value, digits = 4) {
    if (!isNumber(value)) return kDash;
    const size = Math.abs(value);
    if (size === 0) return '0';
    if (Number.isInteger(value) || size >= 1000)
      return typeset(format({maximumFractionDigits: 0}).format(value));
    if (size < 1e-4) return typeset(value.toExponential(2));
    return typeset(format({maximumSignificantDigits: digits}).format(value));
  };

  // Number with a fixed count of decimals, for columns that must align.
  navvy.fixed = function (value, decimals) {
    if (!isNumber(value)) return kDash;
    const text = format({minimumFractionDigits: decimals, maximumFractionDigits: decimals})
      .format(value);
    return typeset(/^-[0.,]*$/.test(text) ? text.slice(1) : text);
  };

  navvy.signed = function (value, decimals) {
    const text = navvy.fixed(value, decimals);
    return isNumber(value) && /[1-9]/.test(text) && value > 0 ? '+' + text : text;
  };

  navvy.percent = value => isNumber(value) ? navvy.fixed(100 * value, 1) + ' %' : kDash;

  // Value and unit; `data-value` keeps every digit of the number for scripts.
  navvy.quantity = function (value, unit, text) {
    const shown = text === undefined ? navvy.number(value) : text;
    const span = navvy.el('span', {class: 'quantity', 'data-value': isNumber(value) ? value : null},
                          navvy.el('span', {class: 'value'}, shown));
    if (unit && isNumber(value)) span.append(navvy.el('span', {class: 'unit'}, kThinSpace + unit));
    return span;
  };

  // Table from headings and rows of cells; a heading {text, numeric} aligns its column.
  navvy.table = function (headings, rows, options) {
    const {el} = navvy;
    const side = i => headings[i] && headings[i].numeric ? 'numeric' : null;
    const head = el('tr', null, headings.map((h, i) =>
      el('th', {class: side(i), scope: 'col'}, h.text === undefined ? h : h.text)));
    const body = rows.map(row => el('tr', null, row.map((cell, i) =>
      el('td', {class: side(i)}, cell))));
    const table = el('table', options, el('thead', null, head), el('tbody', null, body));
    return el('div', {class: 'scroll'}, table);
  };

  navvy.badge = (text, kind) => navvy.el('span', {class: 'badge ' + kind}, text);

  // Kind of badge for the state of a run, program or step.
  navvy.stateKind = function (state) {
    if (['finished', 'done'].includes(state)) return 'good';
    return ['running', 'incomplete', 'interrupted', 'inputs'].includes(state) ? 'fair' : 'bad';
  };

  // Group of buttons of which one is pressed.
  navvy.choice = function (label, entries, chosen, act) {
    const {el} = navvy;
    const group = el('div', {class: 'choice', role: 'group', 'aria-label': label});
    const press = value => {
      for (const button of group.children)
        button.setAttribute('aria-pressed', String(button.dataset.choice === String(value)));
    };
    for (const [value, text] of entries)
      group.append(el('button', {type: 'button', 'data-choice': value,
                                 onclick: () => { press(value); act(value); }}, text));
    press(chosen);
    return group;
  };

  navvy.select = function (label, entries, act) {
    const {el} = navvy;
    const list = el('select', {onchange: event => act(event.target.value)},
                    entries.map(([value, text]) => el('option', {value}, text)));
    return el('label', {class: 'select'}, label, ' ', list);
  };

  const dark = window.matchMedia('(prefers-color-scheme: dark)');
  navvy.isDark = () => dark.matches;
  navvy.color = name => getComputedStyle(document.documentElement).getPropertyValue(name).trim();

  // Views redraw when the colour scheme ('scheme') or the size of the window ('size') changes.
  const redraws = new Set();
  navvy.onRedraw = act => { redraws.add(act); return () => redraws.delete(act); };
  const redraw = reason => redraws.forEach(act => act(reason));
  dark.addEventListener('change', () => redraw('scheme'));
  let waiting = 0;
  window.addEventListener('resize', () => {
    clearTimeout(waiting);
    waiting = setTimeout(() => redraw('size'), 120);
  });

  // Returns a function that asks for draw() in the next picture; while the element is out of sight
  // drawing waits, so that playing costs no more than what is seen.
  navvy.drawWhenSeen = function (element, draw) {
    let wanted = false, seen = true, queued = false;
    const run = () => {
      queued = false;
      if (!wanted || !seen) return;
      wanted = false;
      draw();
    };
    const queue = () => {
      if (queued || !seen) return;
      queued = true;
      requestAnimationFrame(run);
    };
    new IntersectionObserver(entries => {
      seen = entries[entries.length - 1].isIntersecting;
      if (wanted) queue();
    }, {rootMargin: '200px'}).observe(element);
    return () => { wanted = true; queue(); };
  };

  // Smallest round number that is at least `value`, as the limit of a scale.
  navvy.niceAbove = function (value) {
    const power = Math.pow(10, Math.floor(Math.log10(value)));
    const steps = [1, 1.2, 1.6, 2, 3, 4, 5, 6, 8, 10];
    return power * steps.find(step => step * power >= value * 0.999999);
  };
})();
