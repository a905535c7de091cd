// Playing of recordings and of the past: a timeline in the bar of the time, a banner over the scene.

import { overlay } from "webviz/overlay/overlay.js";
import { timeBarTimeline } from "webviz/shell/time_bar.js";
import { banner } from "webviz/features/playback/rewound.js";
import { timeline } from "webviz/features/playback/timeline.js";

export const install = () =>
  timeBarTimeline((places) => {
    overlay("scene", "rewound", banner());
    return timeline(places);
  });
