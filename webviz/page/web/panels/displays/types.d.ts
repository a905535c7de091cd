// Types that the modules of the tree share.

import type { DisplayRow } from "../../contents.js";
import type { makeRow } from "./row.js";
import type { VirtualList } from "../../controls/virtual.js";

/** A display, a group, or the options that hold for everything. */
export interface Item extends DisplayRow {
  id: string;
  parent: Item | null;
  /** Made of names; it is its own and lasts when the viewer starts anew. */
  path: string;
  /** Whether nothing switches it off. */
  isActive: boolean;
  isGroup: boolean;
  children: Item[];
  /** Of the options that hold for everything. */
  note?: string;
}

/** The displays from top to bottom, by id, and those in no group. */
export type Model = { items: Item[]; byId: Map<string, Item>; top: Item[] };
/** Where displays can go, ids as of the command MoveDisplay. */
export type Place = { group: string; before: string; depth?: number };
/** The row of an item. */
export type Row = ReturnType<typeof makeRow>;
/** Where keys move displays. */
export type Way = "up" | "down" | "out" | "into";

/** The tree as its parts know it. */
export interface Tree {
  element: HTMLElement;
  canvas: HTMLElement;
  list: VirtualList<Item, Row>;
  model(): Model;
  rows(): Item[];
  refresh(): void;
  /** Gives the focus to the row that keys act on. */
  focus(): void;
  showActive(): void;
  /** Renames an item as soon as it is there; null none. */
  rename(id: string | null): void;
  itemAt(target: EventTarget | null): Item | null;
  setOpen(item: Item, open: boolean): void;
  setSearch(text: string): void;
  /** Opens the menu of an item, at a place of the window or at its row. */
  openMenu(id: string, x?: number, y?: number): void;
  close(): void;
}
