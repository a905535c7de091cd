"""What viser's page does differently for us: a script that every browser runs when it joins."""

from __future__ import annotations

from webviz.edges.scene.images import TILE_PREFIX

# Constants of three.js: NoToneMapping = 0, NearestFilter = 1003.
PAGE_SCRIPT = """
(function install() {
  const scene = window.__viserMutable && window.__viserMutable.scene;
  const root = scene && scene.__r3f && scene.__r3f.root;
  if (!root) return requestAnimationFrame(install);
  if (scene.webviz) return;
  scene.webviz = true;

  // Colours as they were sent: no film curve (viser's page turns ACES on).
  Object.defineProperty(root.getState().gl, "toneMapping", { get: () => 0, set: () => {} });

  // viser's word of a browser without a graphics card is on its console too; here it hides robots.
  const style = document.createElement("style");
  style.textContent = "#webgl-software-rendering { display: none; }";
  document.head.append(style);

  // Controls that go: viser's page would update them after it has removed them, if both wait for
  // the same frame, and report an error.
  const queue = window.__viserMutable.messageQueue;
  const push = queue.push;
  queue.push = function (...messages) {
    for (const { type, uuid } of messages) {
      if (type !== "GuiRemoveMessage") continue;
      for (let i = queue.length - 1; i >= 0; i--) {
        if (queue[i].type === "GuiUpdateMessage" && queue[i].uuid === uuid) queue.splice(i, 1);
      }
    }
    return push.apply(this, messages);
  };

  // Ctrl+S is a command; the camera of viser, which listens further out, would walk as well.
  document.documentElement.addEventListener("keydown", (event) => {
    if (event.ctrlKey || event.metaKey || event.altKey) event.stopPropagation();
  });

  // Poses and data in one step. viser takes messages while it draws a frame: poses are in that
  // frame, but data only when React has rebuilt the nodes, in the next. So messages are taken in a
  // callback of their own right before: what React has to do is done when it ends. The first batch
  // of a connection, which makes the nodes, is left to viser.
  const mutable = window.__viserMutable;
  const request = window.requestAnimationFrame.bind(window);
  const take = () => {
    if (mutable.firstMessageBatch || !mutable.messageQueue.length) return;
    if (mutable.drainMessageQueue) mutable.drainMessageQueue();
  };
  window.requestAnimationFrame = (draw) => {
    request(take);
    return request(draw);
  };

  // The tab of the browser is called as the panel is.
  setInterval(() => {
    const panel = document.querySelector("[data-page-title]");
    if (panel) document.title = panel.dataset.pageTitle;
  }, 500);

  // Pictures: sharp cells; behind lines and meshes of the same plane, and by layer over each other;
  // never hiding what is blended later; not a white sheet while the first texture is decoded.
  const refs = window.__viserMutable.nodeRefFromName;
  // By 0.05 % of the distance, in a parallel projection by some steps of the depth buffer: more
  // than errors of rounding, less than what lies between two things. Units of a polygon offset
  // would hardly count, and three.js takes them for the opposite when it reverses the depth; its
  // factor is for lines, which are up to half a pixel wider than what they stand for.
  const pushBack = (shader) => {
    shader.vertexShader = shader.vertexShader.replace("#include <project_vertex>", `
      #include <project_vertex>
      #ifdef USE_REVERSED_DEPTH_BUFFER
        gl_Position.z -= isPerspectiveMatrix(projectionMatrix) ? 5e-4 * gl_Position.z : 2e-6;
      #else
        gl_Position.z += isPerspectiveMatrix(projectionMatrix)
          ? 5e-4 * (gl_Position.w - gl_Position.z) : 4e-6;
      #endif`);
  };
  const layerOf = (name) => parseInt(name.split("/TILE")[1]);
  const before = scene.onBeforeRender;
  scene.onBeforeRender = function (...args) {
    for (const name in refs) {
      if (!name.includes("/TILE") || !refs[name]) continue;
      refs[name].traverse((object) => {
        const material = object.material;
        if (!object.isMesh || !material || material.side !== 2) return;
        const texture = material.map;
        object.visible = !!texture;
        if (texture && texture.magFilter !== 1003) {
          texture.magFilter = 1003;
          texture.needsUpdate = true;
        }
        if (material.onBeforeCompile !== pushBack) {
          object.renderOrder = layerOf(name) - 1e6;
          material.depthWrite = false;
          material.polygonOffset = true;
          material.polygonOffsetFactor = 0.5;
          material.onBeforeCompile = pushBack;
          material.needsUpdate = true;
        }
      });
    }
    return before.apply(this, args);
  };
})();
""".replace("TILE", TILE_PREFIX)
