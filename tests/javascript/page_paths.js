// Resolves the names by which modules of the page import each other, as its import map does.

import { registerHooks } from "node:module";

const WEBVIZ = new URL("../../webviz/", import.meta.url).href;
const OF_FEATURE = /^webviz\/(?=features\/)/;
const OF_PAGE = /^webviz\//;

registerHooks({
  resolve: (name, context, next) =>
    next(name.replace(OF_FEATURE, WEBVIZ).replace(OF_PAGE, `${WEBVIZ}page/web/`), context),
});
