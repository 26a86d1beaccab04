// SPDX-License-Identifier: Apache-2.0
// Poses of links over time, and outlines of machines in plan.
(function () {
  'use strict';
  const navvy = window.navvy = window.navvy || {};

  // Rotates a vector by a unit quaternion (w, x, y, z).
  function rotate([w, x, y, z], v) {
    const tx = 2 * (y * v[2] - z * v[1]), ty = 2 * (z * v[0] - x * v[2]);
    const tz = 2 * (x * v[1] - y * v[0]);
    return [v[0] + w * tx + y * tz - z * ty, v[1] + w * ty + z * tx - x * tz,
            v[2] + w * tz + x * ty - y * tx];
  }
  // Point of a frame with pose (x, y, z, qw, qx, qy, qz) in the frame around it.
  function place(pose, point) {
    const r = rotate([pose[3], pose[4], pose[5], pose[6]], point);
    return [pose[0] + r[0], pose[1] + r[1], pose[2] + r[2]];
  }
  navvy.place = place;

  // Place of a time between two frames: {a, b, share}. Machines move evenly between frames, so that
  // playing looks smooth; the ground changes at frames only.
  navvy.between = function (times, time) {
    const a = Math.max(0, navvy.indexAt(times, time)), b = Math.min(times.length - 1, a + 1);
    const span = times[b] - times[a];
    return {a, b, share: span > 0 ? Math.min(1, Math.max(0, (time - times[a]) / span)) : 0};
  };

  // Value i of `count` values per frame, between frames.
  navvy.blend = function (values, count, i, {a, b, share}) {
    const from = values[a * count + i], to = values[b * count + i];
    return from + (to - from) * share;
  };

  // Pose of a link. Quaternions of opposite sign are the same rotation, so one is turned round.
  navvy.linkPose = function (run, link, at) {
    const count = run.links.length * 7, base = link * 7, poses = run.frames.poses;
    const pose = [];
    let dot = 0;
    for (let i = 3; i < 7; ++i)
      dot += poses[at.a * count + base + i] * poses[at.b * count + base + i];
    for (let i = 0; i < 7; ++i) {
      const from = poses[at.a * count + base + i];
      const to = poses[at.b * count + base + i] * (i > 2 && dot < 0 ? -1 : 1);
      pose.push(from + (to - from) * at.share);
    }
    const size = Math.hypot(pose[3], pose[4], pose[5], pose[6]) || 1;
    for (let i = 3; i < 7; ++i) pose[i] /= size;
    return pose;
  };

  function meshBox(points) {
    const low = [Infinity, Infinity, Infinity], high = [-Infinity, -Infinity, -Infinity];
    for (let i = 0; i < points.length; ++i) {
      low[i % 3] = Math.min(low[i % 3], points[i]);
      high[i % 3] = Math.max(high[i % 3], points[i]);
    }
    return points.length ? [low, high] : [[0, 0, 0], [0, 0, 0]];
  }

  function boxOf(visual) {
    if (visual.mesh) return meshBox(visual.mesh.points);
    const half = visual.box ? visual.box.map(size => size / 2) :
      visual.cylinder ? [visual.cylinder[0], visual.cylinder[0], visual.cylinder[1] / 2] :
        [visual.sphere || 0, visual.sphere || 0, visual.sphere || 0];
    return [half.map(value => -value), half];
  }

  // Corners of the box around each shape of a link, in the frame of the link.
  function corners(link) {
    if (link.corners) return link.corners;
    link.corners = [];
    for (const visual of link.visuals) {
      const box = boxOf(visual), points = [];
      for (let i = 0; i < 8; ++i)
        points.push(place(visual.pose, [box[i & 1][0], box[(i >> 1) & 1][1], box[i >> 2][2]]));
      link.corners.push(points);
    }
    return link.corners;
  }

  const turn = (o, a, b) => (a[0] - o[0]) * (b[1] - o[1]) - (a[1] - o[1]) * (b[0] - o[0]);

  function chain(points) {
    const hull = [];
    for (const point of points) {
      while (hull.length > 1 && turn(hull[hull.length - 2], hull[hull.length - 1], point) <= 0)
        hull.pop();
      hull.push(point);
    }
    hull.pop();
    return hull;
  }

  // Convex outlines in plan of the shapes of a link in a pose: lists of points [x, y].
  navvy.linkOutlines = (link, pose) => corners(link).map(points => {
    const placed = points.map(point => place(pose, point))
      .sort((a, b) => a[0] - b[0] || a[1] - b[1]);
    return chain(placed).concat(chain(placed.reverse()));
  });
})();
