// Playing of recordings and of the past: a timeline in the bar of the time, a banner over the scene.

import { overlay } from "../../overlay/overlay.js";
import { timeBarTimeline } from "../../shell/time_bar.js";
import { banner } from "./rewound.js";
import { timeline } from "./timeline.js";

export const install = () =>
  timeBarTimeline((places) => {
    overlay("scene", "rewound", banner());
    return timeline(places);
  });
