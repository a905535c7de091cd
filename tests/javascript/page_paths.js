// Resolves what features import as the page does, which has their folders beside its own modules.

import { registerHooks } from "node:module";

const WEBVIZ = new URL("../../webviz/", import.meta.url).href;
const OF_PAGE = /^\.\.\/\.\.\//;

registerHooks({
  resolve: (name, context, next) =>
    context.parentURL?.startsWith(`${WEBVIZ}features/`)
      ? next(name.replace(OF_PAGE, `${WEBVIZ}page/web/`), context)
      : next(name, context),
});
