"""What the page does for views: a script that every browser runs when it joins.

`window.webvizView.show(view)` places the camera. A view follows its target frame by a pose that is
put before the camera's own when a frame is drawn, read from the node of that frame at that very
moment: robot and camera move in the same picture, and whoever turns the camera meanwhile turns it
relative to the frame. TopDownOrtho is viser's camera far above with a narrow field of view, so that
all that asks for these two (dragging, sizes of points and labels) stays right, and the projection
of the picture and of rays is replaced by a parallel one.
"""

from __future__ import annotations

import json

from webviz.api.views.placement import EYE, FIELD_OF_VIEW, FLAT_FIELD_OF_VIEW, RAISED
from webviz.edges.scene.names import ROOT

REPORT = "webviz view"
"""Marks the messages by which a page tells which view it has, and how large."""

_CONSTANTS = {
    "ROOT": ROOT,
    "REPORT": REPORT,
    "RAISED": RAISED,
    "EYE": EYE,
    "FIELD_OF_VIEW": FIELD_OF_VIEW,
    "FLAT_FIELD_OF_VIEW": FLAT_FIELD_OF_VIEW,
    "NEAR_PX": 4,  # what the mouse points at although it is not quite there
    "SENT_MS": 100,  # after which viser has told where the camera is
}


def as_script(source: str) -> str:
    """JavaScript in a scope of its own that knows the constants of views."""
    constants = "".join(f"const {key} = {json.dumps(value)};" for key, value in _CONSTANTS.items())
    return f"(function () {{{constants}{source}}})();"


VIEW_SCRIPT = as_script("""
(function install() {
  const mutable = window.__viserMutable;
  const scene = mutable && mutable.scene;
  const root = scene && scene.__r3f && scene.__r3f.root;
  const world = root && mutable.nodeRefFromName[ROOT];
  const controls = world && mutable.cameraControl;
  if (!controls) return requestAnimationFrame(install);
  if (window.webvizView) return;

  const camera = mutable.camera;
  const canvas = mutable.canvas;
  const vector = (xyz) => camera.position.clone().fromArray(xyz);
  const matrix = () => camera.matrixWorld.clone().identity();
  let view = null;
  let rig = null;
  let height = canvas.clientHeight;
  let place = null;
  let isLost = false;

  const isFlat = () => view !== null && view.type === "TopDownOrtho";
  const controlled = () => mutable.cameraControl;

  // The world of viser has z up, that of three.js y up.
  const toThree = () => {
    world.updateWorldMatrix(true, false);
    return world.matrixWorld;
  };

  // Where the target frame is: its position, and its yaw for a view that turns with it.
  function follow() {
    const node = view !== null && view.frame && mutable.nodeRefFromName[view.frame];
    if (!node) return;
    const up = toThree();
    const m = up.clone().invert().multiply(node.matrixWorld).elements;
    const yaw = view.turns ? Math.atan2(m[1], m[0]) : 0;
    rig = matrix().makeRotationZ(yaw).setPosition(m[12], m[13], m[14]);
    rig.premultiply(up).multiply(up.clone().invert());
  }

  // A parallel projection as large as the camera's own is where it looks at.
  function flatten(camera) {
    const distance = controlled().distance;
    const top = distance * Math.tan((camera.fov * Math.PI) / 360);
    const right = top * camera.aspect;
    camera.projectionMatrix.makeOrthographic(
      -right, right, top, -top, distance / 100, distance * 2,
      camera.coordinateSystem, camera.reversedDepth,
    );
    camera.projectionMatrixInverse.copy(camera.projectionMatrix).invert();
  }

  function adopt(camera) {
    if (camera.webviz) return;
    camera.webviz = true;
    const { updateProjectionMatrix, updateMatrixWorld } = camera;
    camera.updateProjectionMatrix = function () {
      updateProjectionMatrix.call(this);
      if (isFlat()) flatten(this);
    };
    camera.updateMatrixWorld = function (force) {
      updateMatrixWorld.call(this, force);
      if (rig === null) return;
      this.matrixWorld.premultiply(rig);
      this.matrixWorldInverse.copy(this.matrixWorld).invert();
    };
  }

  const Raycaster = root.getState().raycaster.constructor;
  const fromCamera = Raycaster.prototype.setFromCamera;
  Raycaster.prototype.setFromCamera = function (point, camera) {
    fromCamera.call(this, point, camera);
    if (!isFlat() || !camera.webviz) return;
    const near = camera.reversedDepth ? 1 : -1;
    this.ray.origin.set(point.x, point.y, near).unproject(camera);
    this.ray.direction.set(0, 0, -1).transformDirection(camera.matrixWorld);
  };

  // Labels stand where their parents were in the frame before, unless that is brought up to date
  // between viser's placing of nodes (priority -1000) and of labels (0).
  root.getState().internal.subscribe(
    { current: () => rig !== null && scene.updateMatrixWorld() }, -900, root,
  );

  // When a lost connection is back, viser puts the camera where browsers begin: it goes back from
  // there to where it was before the first messages came.
  root.getState().internal.subscribe({ current: remember }, -1e6, root);
  function remember() {
    if (mutable.firstMessageBatch) isLost = true;
    if (isLost || view === null) return;
    const controls = controlled();
    place = [controls.getPosition(vector([0, 0, 0])), controls.getTarget(vector([0, 0, 0]))];
  }
  function rejoin() {
    const [position, target] = place;
    controlled().setLookAt(...position.toArray(), ...target.toArray(), false);
    mutable.sendCamera();
    setTimeout(report, SENT_MS);
  }

  // What viser keeps before the camera, and the cross where it turns about, without knowing rigs.
  const cross = scene.children.find((child) => {
    let found = false;
    child.traverse((part) => (found ||= part.geometry?.parameters?.width === 0.4));
    return found;
  });
  function dress(camera) {
    if (cross) cross.visible = rig === null;
    for (const child of scene.children) {
      if (child.material && child.material === mutable.backgroundMaterial) {
        const depth = isFlat() ? controlled().distance : 1;
        const tall = 2 * depth * Math.tan((camera.fov * Math.PI) / 360);
        const scale = matrix().makeScale(tall * camera.aspect, tall, 1).setPosition(0, 0, -depth);
        child.matrixWorld.multiplyMatrices(camera.matrixWorld, scale);
      }
    }
  }

  const before = scene.onBeforeRender;
  scene.onBeforeRender = function (gl, scene, camera, target) {
    before.call(this, gl, scene, camera, target);
    adopt(camera);
    if (isFlat()) flatten(camera);
    follow();
    camera.updateMatrixWorld();
    dress(camera);
    settle();
  };

  // XYOrbit looks at a point that is as far from its focal point, along the camera's own up, as the
  // camera is far away. Turning and zooming leave the focal point, moving moves it on the ground.
  let focal = null;
  let aimed = null;
  const isRaised = () =>
    view !== null && (view.type === "XYOrbit" || view.type === "ThirdPersonFollower");
  function raise() {
    const { azimuthAngle, polarAngle, distance } = controlled();
    const back = -Math.cos(polarAngle);
    return vector([
      back * Math.sin(azimuthAngle), Math.sin(polarAngle), back * Math.cos(azimuthAngle),
    ]).multiplyScalar(RAISED * distance);
  }
  function settle() {
    if (!isRaised() || focal === null) return;
    const controls = controlled();
    const target = controls.getTarget(vector([0, 0, 0]));
    focal.add(target).sub(aimed).setY(0);
    const wanted = focal.clone().add(raise());
    aimed = target;
    if (target.distanceTo(wanted) < 1e-9 * (1 + wanted.length())) return;
    controls.moveTo(wanted.x, wanted.y, wanted.z, false);
    aimed = wanted;
  }

  function report() {
    mutable.sendMessage({
      type: "LocalStorageGetItemResponseMessage",
      request_uuid: REPORT,
      value: JSON.stringify({
        number: view.number, type: view.type, target_frame: view.target_frame,
        width: canvas.clientWidth, height: canvas.clientHeight,
      }),
      error: null,
    });
  }

  new ResizeObserver(() => {
    const tall = canvas.clientHeight;
    if (view === null || tall === 0 || tall === height) return;
    if (isFlat()) controlled().dollyTo((controlled().distance * tall) / height, false);
    height = tall;
    setTimeout(report, SENT_MS);
  }).observe(canvas);

  function show(wanted) {
    if (view === null || view.frame !== wanted.frame) rig = null;
    view = wanted;
    height = canvas.clientHeight;
    const controls = controlled();
    const up = toThree();
    const target = vector(view.look_at);
    const offset = vector(view.position).sub(target);
    const fov = isFlat() ? FLAT_FIELD_OF_VIEW : FIELD_OF_VIEW;
    if (isFlat()) offset.setLength(height / view.scale / 2 / Math.tan(fov / 2));
    const position = target.clone().add(offset).applyMatrix4(up);
    target.applyMatrix4(up);
    controls.minDistance = view.type === "FPS" ? EYE : 0.01;
    controls.maxDistance = Infinity;
    mutable.configuredMaxOrbitDistance = 1e7;
    controls.minPolarAngle = 0;
    controls.maxPolarAngle = Math.PI;
    camera.fov = (fov * 180) / Math.PI;
    adopt(camera);
    controls.setLookAt(...position.toArray(), ...target.toArray(), false);
    controls.update(0);
    aimed = controls.getTarget(vector([0, 0, 0]));
    focal = isRaised() ? aimed.clone().sub(raise()) : null;
    if (isFlat()) controls.minPolarAngle = controls.maxPolarAngle = controls.polarAngle;
    camera.updateProjectionMatrix();
    if (window.webvizMouse) window.webvizMouse.arm();
    mutable.sendCamera();
    mutable.requestRender();
    setTimeout(report, SENT_MS);
  }

  window.webvizView = {
    type: () => (view === null ? "" : view.type),
    rig: () => (rig === null ? matrix() : rig),
    raised: () => (isRaised() ? raise() : vector([0, 0, 0])),
    show,
    report,
    join: (start) => {
      isLost = false;
      if (place === null) show(start);
      else rejoin();
    },
  };
})();
""")


def call(function: str, argument: str = "") -> str:
    """A script that calls a function of the page once the page has it.

    Args:
        function: an object of the window and its method, such as `webvizView.show`.
        argument: JavaScript, such as JSON.
    """
    return f"""
(function call() {{
  if (!window.{function.partition(".")[0]}) return requestAnimationFrame(call);
  window.{function}({argument});
}})();
"""
