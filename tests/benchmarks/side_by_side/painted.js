// What a page draws, before each animation frame: marks of publications, and stamps of panes.
//
// `window.watchPainted(place)` begins. Each entry of `window.__painted` is the time at which a frame
// with something new was handed on, in ms, and a coordinate, the bytes of a picture or a stamp.

(() => {
  const EXACT = 1e-3;
  const DEPTHS = { frame: -7, link: -8 };
  const blobs = new Map();
  const { createObjectURL } = URL;
  URL.createObjectURL = function (blob) {
    const url = createObjectURL.call(URL, blob);
    blobs.set(url, blob);
    return url;
  };

  window.__frames = 0;
  window.__painted = [];
  window.__long = [];
  const tasks = new PerformanceObserver((list) => {
    for (const { startTime, duration } of list.getEntries()) {
      window.__long.push([performance.timeOrigin + startTime, duration]);
    }
  });
  tasks.observe({ type: "longtask", buffered: true });

  const page = () => window.__viserMutable;

  function points(see) {
    page().scene.traverse((node) => {
      const x = node.isPoints && node.geometry.attributes.position?.array[0];
      if (typeof x === "number") see(node.uuid, x);
    });
  }

  // Where the scene is turned, x and z of a node in the fixed frame.
  function markOf(node, unturned, depth) {
    if (node.matricesTexture) {
      const values = node.matricesTexture._data;
      for (let i = 12; i < values.length; i += 16) {
        if (Math.abs(values[i + 2] - depth) < EXACT) return values[i];
      }
      return null;
    }
    const { elements } = unturned.clone().multiply(node.matrixWorld);
    return Math.abs(elements[14] - depth) < EXACT ? elements[12] : null;
  }

  let marked = null;
  function node(depth, see) {
    const { scene, nodeRefFromName } = page();
    if (!nodeRefFromName[""]) return;
    const unturned = nodeRefFromName[""].matrixWorld.clone().invert();
    const isThere = (one) => one && (one === scene || isThere(one.parent));
    if (!isThere(marked)) {
      marked = null;
      scene.traverse((one) => (marked ??= markOf(one, unturned, depth) === null ? null : one));
    }
    const x = marked && markOf(marked, unturned, depth);
    if (x !== null) see(marked.uuid, x);
  }

  function pictures(see) {
    const { scene, backgroundMaterial } = page();
    const textures = [backgroundMaterial?.uniforms.colorMap?.value];
    scene.traverse(({ material }) => textures.push(material?.map));
    for (const texture of textures) {
      const blob = blobs.get(texture?.image?.src);
      if (blob) see(texture.uuid, blob);
    }
    for (const { dataset } of document.querySelectorAll(".wv-pane")) {
      if (dataset.stamp) see("pane", { stamp: Number(dataset.stamp) });
    }
  }

  const LOOKS = {
    points,
    picture: pictures,
    frame: (see) => node(DEPTHS.frame, see),
    link: (see) => node(DEPTHS.link, see),
  };

  window.countFrames = () => {
    window.__frames += 1;
    requestAnimationFrame(window.countFrames);
  };

  window.watchPainted = (place) => {
    const known = new Map();
    let fresh = [];
    const see = (key, what) => {
      const id = what.stamp ?? what;
      if (known.get(key) === id) return;
      known.set(key, id);
      fresh.push(what);
    };
    const step = () => {
      const now = performance.timeOrigin + performance.now();
      window.__painted.push(...fresh.map((what) => [now, what]));
      fresh = [];
      LOOKS[place](see);
      requestAnimationFrame(step);
    };
    requestAnimationFrame(step);
    window.countFrames();
  };

  window.readPainted = async () => {
    const read = async (what) => {
      if (!(what instanceof Blob)) return what;
      const bytes = new Uint8Array(await what.arrayBuffer());
      let text = "";
      for (let i = 0; i < bytes.length; i += 0x8000) {
        text += String.fromCharCode(...bytes.subarray(i, i + 0x8000));
      }
      return { picture: btoa(text) };
    };
    return Promise.all(window.__painted.map(async ([now, what]) => [now, await read(what)]));
  };
})();
