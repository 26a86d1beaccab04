// SPDX-License-Identifier: Apache-2.0
// Unpacks the data of the page: base64 text of gzip-compressed little-endian arrays.
(function () {
  'use strict';
  const navvy = window.navvy = window.navvy || {};

  function bytesOf(text) {
    const binary = atob(text);
    const bytes = new Uint8Array(binary.length);
    for (let i = 0; i < binary.length; ++i) bytes[i] = binary.charCodeAt(i);
    return bytes;
  }
  navvy.bytesOf = bytesOf;

  // Array of a text of base64 without compression, as in frames of a live run.
  navvy.plainArray = function (text, Type, what) {
    const bytes = bytesOf(text || '');
    if (bytes.length % Type.BYTES_PER_ELEMENT) throw new Error(what + ' is cut off');
    return new Type(bytes.buffer);
  };

  async function inflate(bytes) {
    if (typeof DecompressionStream === 'undefined')
      throw new Error('this browser has no DecompressionStream; use Chrome 80, Firefox 113, ' +
                      'Safari 16.4 or later');
    const stream = new Blob([bytes]).stream().pipeThrough(new DecompressionStream('gzip'));
    return new Response(stream).arrayBuffer();
  }

  // Returns the array of the packed text, with `length` values unless that is undefined.
  navvy.unpack = async function (text, Type, length, what) {
    const buffer = text ? await inflate(bytesOf(text)) : new ArrayBuffer(0);
    const whole = Math.floor(buffer.byteLength / Type.BYTES_PER_ELEMENT);
    if (length !== undefined && whole !== length)
      throw new Error(`${what} has ${whole} values instead of ${length}`);
    return new Type(buffer, 0, whole);
  };

  // Adds the arrays of the ground: heights at the start, the design, and changes in tiles.
  async function unpackGround(raw, run) {
    if (!raw.grid) return;
    const grid = raw.grid, cells = grid.nx * grid.ny;
    const start = await navvy.unpack(raw.start, Int16Array, cells, 'start');
    if (raw.design) run.design = await navvy.unpack(raw.design, Int16Array, cells, 'design');
    const frames = raw.frames, none = {times: [], counts: new Uint32Array(0), tiles: null};
    if (!frames || !frames.tile_counts)
      run.ground = new navvy.Ground(grid, start, none);
    else {
      const counts = await navvy.unpack(frames.tile_counts, Uint32Array, frames.times.length,
                                        'tile_counts');
      const sum = counts.reduce((a, b) => a + b, 0);
      const tiles = await navvy.unpack(frames.tiles, Int16Array, sum * navvy.kTileSize, 'tiles');
      run.ground = new navvy.Ground(grid, start, {times: frames.times, counts, tiles});
    }
    run.grid = grid;
  }

  // Adds poses, cylinders, forces and particles of the frames.
  async function unpackFrames(raw, run) {
    const frames = raw.frames;
    if (!frames || !frames.times || frames.times.length === 0) return;
    const n = frames.times.length;
    const links = (raw.links || []).length, cylinders = (raw.cylinders || []).length;
    const forces = (raw.forces || []).length;
    const counts = await navvy.unpack(frames.particle_counts, Uint16Array, undefined, '');
    const sum = counts.reduce((a, b) => a + b, 0);
    const offsets = new Uint32Array(n + 1);
    for (let i = 0; i < n; ++i) offsets[i + 1] = offsets[i] + (counts[i] || 0);
    run.frames = {
      times: Float64Array.from(frames.times),
      poses: await navvy.unpack(frames.poses, Float32Array, n * links * 7, 'poses'),
      cylinders: await navvy.unpack(frames.cylinders, Float32Array, n * cylinders * 6, 'cylinders'),
      forces: await navvy.unpack(frames.forces, Float32Array, n * forces * 6, 'forces'),
      particles: await navvy.unpack(frames.particles, Int16Array, 3 * sum, 'particles'),
      particleOffsets: offsets
    };
  }

  async function unpackLinks(raw, run) {
    for (const link of raw.links || []) {
      const visuals = [];
      for (const visual of link.visuals || []) {
        const shape = Object.assign({}, visual);
        if (visual.mesh)
          shape.mesh = {
            points: await navvy.unpack(visual.mesh.points, Float32Array),
            triangles: await navvy.unpack(visual.mesh.triangles, Uint32Array)
          };
        visuals.push(shape);
      }
      run.links.push({machine: link.machine, link: link.link, visuals});
    }
  }

  async function unpackTelemetry(raw, run) {
    const source = raw.telemetry;
    if (!source || !source.rows) return;
    const k = source.names.length, m = source.rows;
    const values = await navvy.unpack(source.values, Float32Array, m * k, 'telemetry');
    const columns = new Map();
    run.telemetry = {
      names: source.names, units: source.units || [], rows: m,
      // Columns are copied out of the rows when they are first used.
      column(index) {
        if (!columns.has(index)) {
          const column = new Float32Array(m);
          for (let row = 0; row < m; ++row) column[row] = values[row * k + index];
          columns.set(index, column);
        }
        return columns.get(index);
      }
    };
  }

  // Unpacks one run. A part that cannot be read is left out, and `faults` says why.
  navvy.readRun = async function (raw) {
    const run = {raw, name: raw.name || '', grid: null, ground: null, design: null, frames: null,
                 telemetry: null, links: [], summary: raw.summary || null, faults: []};
    const parts = [[unpackGround, 'the ground'], [unpackLinks, 'the shapes of the machines'],
                   [unpackFrames, 'the frames'], [unpackTelemetry, 'the telemetry']];
    for (const [read, what] of parts) {
      try {
        await read(raw, run);
      } catch (error) {
        run.faults.push(`The page could not read ${what}: ${error.message || error}.`);
      }
    }
    run.span = timeSpan(run);
    return run;
  };

  // First and last time that the run shows.
  function timeSpan(run) {
    const ends = [];
    if (run.frames) ends.push(run.frames.times[0], run.frames.times[run.frames.times.length - 1]);
    if (run.telemetry) {
      const times = run.telemetry.column(0);
      ends.push(times[0], times[times.length - 1]);
    }
    const known = ends.filter(navvy.isNumber);
    return known.length ? [Math.min(...known), Math.max(...known)] : null;
  }

  // Index of the last of the rising `times` that is at or before `time`, or -1.
  navvy.indexAt = function (times, time) {
    let low = 0, high = times.length;
    while (low < high) {
      const middle = (low + high) >> 1;
      if (times[middle] <= time) low = middle + 1; else high = middle;
    }
    return low - 1;
  };

  navvy.readDocument = function () {
    const element = document.getElementById('navvy-data');
    if (!element) throw new Error('the page has no data');
    const data = JSON.parse(element.textContent);
    if (data.format !== 1) throw new Error(`the data have format ${data.format}; expected 1`);
    return data;
  };
})();
