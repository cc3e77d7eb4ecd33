// SPDX-License-Identifier: Apache-2.0
// view/html/images.js: pages of images follow their files. Behind the report's script, in pages that
// are served.

// How a viewer looks at its pictures, kept while the page is loaded again.
const LOOKS = ['at', 'a', 'shown', 'mode', 'layer', 'split', 'mark', 'look'];

function keepLooks() {
  const looks = VIEWERS.map(viewer => ({...Object.fromEntries(LOOKS.map(name => [name, viewer[name]])),
                                        camera: [viewer.camera.scale, viewer.camera.x, viewer.camera.y]}));
  sessionStorage.setItem(location.pathname, JSON.stringify(looks));
}

function bringBackLooks() {
  const looks = JSON.parse(sessionStorage.getItem(location.pathname) || '[]');
  sessionStorage.removeItem(location.pathname);
  looks.forEach((kept, i) => {
    const viewer = VIEWERS[i], {images} = viewer || {images: []};
    // Files may have other layers, and other sizes, than before.
    if (!images.some(image => image.layers.some(layer => layer.name === kept.layer))) return;
    for (const name of LOOKS) viewer[name] = kept[name];
    [viewer.camera.scale, viewer.camera.x, viewer.camera.y] = kept.camera;
    viewer.update();
  });
}

class Following {
  constructor() {
    this.banner = el('p', {class: 'note bad', role: 'alert', hidden: true});
    document.querySelector('h1').after(this.banner);
    refuseDrops(() => this.show(DROPPED));
    this.open(false);
  }
  show(text) {
    this.banner.textContent = text;
    this.banner.hidden = !text;
  }
  open(again) {
    const address = new URL('socket', location.href);
    address.protocol = address.protocol.replace('http', 'ws');
    const socket = new WebSocket(address);
    // Another server may have other files.
    socket.onopen = () => { if (again) this.reload(); };
    socket.onmessage = ({data}) => {
      const message = JSON.parse(data);
      if (message.reload) this.reload();
      else this.show(message.banner);
    };
    socket.onclose = () => {
      this.show('no connection: trying again…');
      setTimeout(() => this.open(true), 1000);
    };
  }
  reload() {
    keepLooks();
    location.reload();
  }
}

document.querySelector('footer').firstChild.textContent = `Made by ${REPORT.generator}, which tells this page when its files change. `;
bringBackLooks();
new Following();
