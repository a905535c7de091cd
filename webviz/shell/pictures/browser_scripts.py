"""Scripts for the page in a headless browser."""

CANVAS = """() => {
  const {canvas} = window.__viserMutable;
  return [canvas.width, canvas.height];
}"""

# three.js decodes every texture, including those in GLB files, from an object URL, which it revokes
# when the texture is ready.
COUNT_UNPACKING = """
(() => {
  const under_way = (window.webvizUnpacking = new Set());
  const { createObjectURL, revokeObjectURL } = URL;
  URL.createObjectURL = (object) => {
    const url = createObjectURL.call(URL, object);
    if (object.type?.startsWith("image/")) under_way.add(url);
    return url;
  };
  URL.revokeObjectURL = (url) => {
    under_way.delete(url);
    revokeObjectURL.call(URL, url);
  };
})();
"""

# Everything in a frame except the rendering, since callbacks read and change nodes.
HOLD = """
() => {
  const {canvas, messageQueue, scene} = window.__viserMutable;
  const {advance, gl} = scene.__r3f.root.getState();
  canvas.style.visibility = "hidden";  // nor does the browser draw its page anew
  window.webvizRender = gl.render.bind(gl);
  gl.render = (scene, camera) => {
    scene.updateMatrixWorld();
    camera.updateMatrixWorld();
    scene.onBeforeRender(gl, scene, camera, null);
  };
  setInterval(() => messageQueue.length > 0 && advance(performance.now()), 4);
}
"""

# Decoded data makes React render, whose effects may decode more. Hence wait for some quiet frames
# in a row, each with a separate task for React. A frame that requests another one is not quiet, as
# viser renders new glyphs of labels for at most 5 ms per frame.
SETTLE = """
async (milliseconds) => {
  const page = window.__viserMutable;
  const {advance} = page.scene.__r3f.root.getState();
  const deadline = performance.now() + milliseconds;
  for (let quiet = 0; quiet < 4; ) {
    let busy = false;
    const {requestRender} = page;
    page.requestRender = () => {
      busy = true;
      requestRender();
    };
    advance(performance.now());
    page.requestRender = requestRender;
    busy ||= page.messageQueue.length > 0 || window.webvizUnpacking.size > 0;
    quiet = busy ? 0 : quiet + 1;
    if (performance.now() > deadline) return false;
    await new Promise((resume) => setTimeout(resume, busy ? 5 : 0));
  }
  return true;
}
"""

OPAQUE = """
() => {
  const {scene, camera, canvas} = window.__viserMutable;
  window.webvizRender?.(scene, camera);
  return canvas.toDataURL("image/png");
}
"""

TRANSPARENT = """
() => {
  const {scene, camera, canvas, backgroundMaterial, requestRender} = window.__viserMutable;
  const {gl} = scene.__r3f.root.getState();
  const alpha = gl.getClearAlpha();
  const {enabled} = backgroundMaterial.uniforms;
  const was = enabled.value;
  try {
    enabled.value = false;
    gl.setClearAlpha(0);
    (window.webvizRender ?? gl.render)(scene, camera);
    return canvas.toDataURL("image/png");
  } finally {
    enabled.value = was;
    gl.setClearAlpha(alpha);
    requestRender();
  }
}
"""

# A picture with the scene over and under it, drawn by the modules of the page.
PANE = """
async ([width, height, sight, warp, hidden, url]) => {
  const load = (name) => import(new URL(`webviz/images/${name}.js`, location.href));
  const [{ paint }, { bend }] = [await load("over"), await load("bend")];
  const picture = new Image();
  picture.src = url;
  await picture.decode();
  const make = (width, height) => {
    const canvas = document.createElement("canvas");
    return Object.assign(canvas, { width, height }).getContext("2d");
  };
  const size = [picture.naturalWidth, picture.naturalHeight];
  const bent = warp && make(...size);
  if (bent) bend(picture, warp, bent);
  const image = bent ? bent.canvas : picture;
  const context = make(width, height);
  const {gl} = window.__viserMutable.scene.__r3f.root.getState();
  const {render} = gl;
  if (window.webvizRender) gl.render = window.webvizRender;
  try {
    paint(context, { image, size, sight, hidden });
  } finally {
    gl.render = render;
  }
  context.globalCompositeOperation = "destination-over"; // black, as on the page
  context.fillRect(0, 0, width, height);
  return context.canvas.toDataURL("image/png");
}
"""
