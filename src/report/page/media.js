// SPDX-License-Identifier: Apache-2.0
// Video, pictures, scene text and command line.
(function () {
  'use strict';
  const navvy = window.navvy = window.navvy || {};
  const {el} = navvy;

  function video(one) {
    const caption = el('figcaption', null, one.name);
    if (one.data) {
      const blob = new Blob([navvy.bytesOf(one.data)], {type: one.type});
      return el('figure', {class: 'video'},
                el('video', {controls: true, preload: 'metadata', src: URL.createObjectURL(blob)}),
                caption);
    }
    return el('figure', {class: 'video'},
              el('p', null, 'This video is a file beside the page: ', fileLink(one.file)), caption);
  }

  // Link to a file of the run's folder. An address with a scheme leads elsewhere and stays text.
  function fileLink(file) {
    const name = String(file || '');
    if (/^([a-z][a-z0-9+.-]*:|\/)/i.test(name)) return el('code', null, name);
    return el('a', {href: name.split('/').map(encodeURIComponent).join('/')}, name);
  }

  function picture(one, clock) {
    const image = el('img', {alt: `${one.camera} at ${navvy.fixed(one.time_s, 2)} s`,
                             loading: 'lazy', src: `data:${one.type};base64,${one.data}`});
    const holder = el('figure', {class: 'picture'}, image,
                      el('figcaption', null, `${one.camera}, ${navvy.fixed(one.time_s, 2)} s`));
    image.addEventListener('click', () => {
      holder.classList.toggle('large');
      if (clock && navvy.isNumber(one.time_s)) clock.set(one.time_s);
    });
    return holder;
  }

  navvy.showMedia = function (run, clock) {
    const body = navvy.sectionBody('media');
    const videos = run.raw.videos || [], pictures = run.raw.pictures || [];
    if (!videos.length && !pictures.length)
      body.append(navvy.absent('This run has no video and no pictures.'));
    if (videos.length) body.append(el('div', {class: 'videos'}, videos.map(video)));
    if (pictures.length)
      body.append(el('div', {class: 'pictures'}, pictures.map(one => picture(one, clock))));
  };

  // Command as a shell reads it.
  function commandLine(words) {
    return words.map(word => /^[\w@%+=:,./-]+$/.test(word) ? word :
      "'" + word.replace(/'/g, "'\\''") + "'").join(' ');
  }

  navvy.showSceneText = function (run) {
    const body = navvy.sectionBody('scene'), info = run.raw.run;
    body.append(el('h3', null, 'Command'), info && info.command && info.command.length ?
      el('pre', null, commandLine(info.command)) :
      navvy.absent('This run has no run.json, so its command is not known.'));
    const text = run.raw.scene_text;
    if (!text) {
      body.append(navvy.absent('This run has no scene.sdf.'));
      return;
    }
    body.append(el('details', null,
      el('summary', null, `scene.sdf (${navvy.number(text.split('\n').length)} lines)`),
      el('pre', {class: 'tall'}, text)));
  };
})();
