// Poses and data in one step.
//
// viser takes messages while it draws a frame: poses are in that frame, but data only when React
// has rebuilt the nodes, in the next. So messages are taken in a callback of their own right before:
// what React has to do is done when it ends. The first batch of a connection, which makes the nodes,
// is left to viser.

import * as viser from "webviz/viser_page.js";

export function install() {
  const request = window.requestAnimationFrame.bind(window);
  const take = () => {
    if (!viser.isFirstBatch()) viser.takeMessages();
  };
  window.requestAnimationFrame = (draw) => {
    request(take);
    return request(draw);
  };
}
