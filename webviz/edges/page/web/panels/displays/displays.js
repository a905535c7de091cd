// The panel "Displays".

import { el, setChildren } from "../../dom.js";
import { watch } from "../../stores.js";

export const displays = {
  name: "displays",
  title: "Displays",
  open(element) {
    const tree = el("div", { class: "wv-tree", role: "tree", "aria-label": "Displays" });
    element.append(tree);
    return watch("displays", (rows) => {
      setChildren(tree, rows.get("order").map((id) => el("div", {}, rows.get(id).name)));
    });
  },
};
