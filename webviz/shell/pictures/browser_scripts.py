"""Scripts for the page in a headless browser."""

VISER = 'const viser = await import("webviz/viser_page.js");'
"""Begins a script that reads what the page alone may: of viser, through its own module."""

CANVAS = f"""async () => {{ {VISER}
  const canvas = viser.canvas();
  return [canvas.width, canvas.height];
}}"""

DRAW = f"""async (count) => {{ {VISER}
  for (let i = 0; i < count; i++) {{
    viser.requestRender();
    await new Promise(requestAnimationFrame);
  }}
}}"""

PIXEL = f"""async (point) => {{ {VISER}
  const [camera, canvas, root] = [viser.camera(), viser.canvas(), viser.node("/webviz")];
  root.updateWorldMatrix(true, false);
  camera.updateMatrixWorld();
  const p = root.position.clone().set(...point).applyMatrix4(root.matrixWorld);
  p.project(camera);
  return [(p.x + 1) / 2 * canvas.width, (1 - p.y) / 2 * canvas.height];
}}"""

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

# Everything in a frame except the rendering, since callbacks read and change nodes. Messages are
# handled when they come, without a timer that runs while nothing does.
HOLD = f"""async () => {{ {VISER}
  const gl = viser.gl();
  viser.canvas().style.visibility = "hidden";  // nor does the browser draw its page anew
  window.webvizRender = gl.render.bind(gl);
  gl.render = (scene, camera) => {{
    scene.updateMatrixWorld();
    camera.updateMatrixWorld();
    scene.onBeforeRender(gl, scene, camera, null);
  }};
  let isDue = false;
  const look = () => {{
    isDue = viser.hasMessages();
    if (!isDue) return;
    setTimeout(look, 4);  // also if the frame fails
    viser.advance();
  }};
  viser.filterMessages((messages) => {{
    if (!isDue) setTimeout(look);
    isDue = true;
    return messages;
  }});
  look();
}}"""

# Decoded data makes React render, whose effects may decode more. Hence wait for some quiet frames
# in a row, each with a separate task for React. A frame that requests another one is not quiet, as
# viser renders new glyphs of labels for at most 5 ms per frame.
SETTLE = f"""async (milliseconds) => {{ {VISER}
  const deadline = performance.now() + milliseconds;
  for (let quiet = 0; quiet < 4; ) {{
    const isAsked = viser.advance();
    const busy = isAsked || viser.hasMessages() || window.webvizUnpacking.size > 0;
    quiet = busy ? 0 : quiet + 1;
    if (performance.now() > deadline) return false;
    await new Promise((resume) => setTimeout(resume, busy ? 5 : 0));
  }}
  return true;
}}"""

OPAQUE = f"""async () => {{ {VISER}
  window.webvizRender?.(viser.scene(), viser.camera());
  return viser.canvas().toDataURL("image/png");
}}"""

TRANSPARENT = f"""async () => {{ {VISER}
  const gl = viser.gl();
  const alpha = gl.getClearAlpha();
  const enabled = viser.backgroundMaterial().uniforms.enabled;
  const was = enabled.value;
  try {{
    enabled.value = false;
    gl.setClearAlpha(0);
    (window.webvizRender ?? gl.render)(viser.scene(), viser.camera());
    return viser.canvas().toDataURL("image/png");
  }} finally {{
    enabled.value = was;
    gl.setClearAlpha(alpha);
    viser.requestRender();
  }}
}}"""

# A picture with the scene over and under it, and with its marks, drawn by the modules of the page.
PANE = """
async ([width, height, camera, warp, hidden, marks, url]) => {
  const viser = await import("webviz/viser_page.js");
  const load = (name) => import(`webviz/images/${name}.js`);
  const { paint, placeIn } = await load("camera_overlay");
  const { undistort } = await load("undistort");
  const { drawMarks } = await load("marks");
  const picture = new Image();
  picture.src = url;
  await picture.decode();
  const make = (width, height) => {
    const canvas = document.createElement("canvas");
    return Object.assign(canvas, { width, height }).getContext("2d");
  };
  const size = [picture.naturalWidth, picture.naturalHeight];
  const undistorted = warp && make(...size);
  if (undistorted) undistort(picture, warp, undistorted);
  const image = undistorted ? undistorted.canvas : picture;
  const context = make(width, height);
  const gl = viser.gl();
  const {render} = gl;
  if (window.webvizRender) gl.render = window.webvizRender;
  try {
    paint(context, { image, size, camera, hidden });
    drawMarks(context, marks, placeIn({ camera, warp, size }, width, height));
  } finally {
    gl.render = render;
  }
  context.globalCompositeOperation = "destination-over"; // black, as on the page
  context.fillRect(0, 0, width, height);
  return context.canvas.toDataURL("image/png");
}
"""
