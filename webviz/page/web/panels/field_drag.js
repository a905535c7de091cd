// Topics and fields that are dragged: out of lists of them, onto panels and the scene.

/** @typedef {{topic: string, path: string}} Field a field of a topic, or all of it: "" */

const TYPE = "application/x-webviz-field";

/**
 * Lets an element be dragged as a field.
 *
 * @param {HTMLElement} element
 * @param {() => Field | null} field null where there is none
 */
export function dragField(element, field) {
  element.draggable = true;
  element.addEventListener("dragstart", (event) => {
    const dragged = field();
    if (!dragged || !event.dataTransfer) return event.preventDefault();
    event.dataTransfer.setData(TYPE, JSON.stringify(dragged));
    event.dataTransfer.setData("text/plain", messagePath(dragged));
    event.dataTransfer.effectAllowed = "copy";
  });
}

/**
 * Takes fields that are dropped on an element, which is marked while one is over it.
 *
 * @param {HTMLElement} element
 * @param {() => ((field: Field, event: DragEvent) => unknown) | null | undefined} taker null while none
 *   is taken
 */
export function takeFields(element, taker) {
  /** @param {DragEvent} event */
  const isField = ({ dataTransfer }) => Boolean(dataTransfer?.types.includes(TYPE) && taker());
  /** @param {boolean} isOver */
  const mark = (isOver) => element.toggleAttribute("data-drop", isOver);
  element.addEventListener("dragover", (event) => {
    if (!isField(event)) return;
    event.preventDefault();
    mark(true);
  });
  element.addEventListener("dragleave", (event) => {
    const to = /** @type {Node | null} */ (event.relatedTarget);
    if (!element.contains(to)) mark(false);
  });
  element.addEventListener("drop", (event) => {
    mark(false);
    if (!isField(event)) return;
    event.preventDefault();
    const text = event.dataTransfer?.getData(TYPE);
    if (text) taker()?.(JSON.parse(text), event);
  });
}

/**
 * The message path of a field.
 *
 * @param {Field} field
 */
export function messagePath({ topic, path }) {
  const full = topic.startsWith("/") ? topic : `/${topic}`;
  return path ? `${full}.${path}` : full;
}
