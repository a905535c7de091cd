// Types of a recorded run, see webviz/shell/export/.

import type { DeclaredProperty } from "../contents.js";
import type { ToPage } from "../messages.js";
import type { Vec3, Wxyz } from "../types.js";

/** Its key, node, phase, and the message itself. */
export type SceneItem = [key: string, node: string, phase: "create" | "remove" | "", message: any];
/** Seconds, ROS time, numbers of messages that came and went, of values, and of pictures. */
export type RecordedFrame = [
  at: number,
  ros: number,
  added: number[],
  gone: number[],
  values: [store: string, key: string, number: number][],
  pictures: [display: string, numbers: number[]][],
];
/** Some seconds of the run, with the numbers of the first message, value and picture in it. */
export interface RawChunk {
  messages: { first: number; items: SceneItem[] };
  /** Items in another order than their numbers, with the place of each number; columns may have the
   * numbers of items that several share. */
  values: { first: number; items: unknown[]; places: number[]; shared: unknown[] };
  pictures: { first: number; items: number[] };
  start: {
    scene: number[];
    stores: Record<string, Record<string, number>>;
    panes: Record<string, number[]>;
  };
  frames: RecordedFrame[];
  /** Start, size, and size of the numbers whose bytes are shuffled. */
  buffers: [start: number, size: number, width: number][];
}
/** An unpacked one. */
export interface Chunk extends RawChunk {
  number: number;
  bytes: Uint8Array<ArrayBuffer>;
}
/** Where each chunk begins. */
export interface ChunkIndex {
  times: number[];
  message: number;
  value: number;
  picture: number;
}
/** What the file says of its run. */
export interface About {
  names: string[];
  start: number;
  duration: number;
  /** The moment that it begins with. */
  at: number;
  index: ChunkIndex[];
  greeting: ToPage[];
  /** The saved views, and the properties of each type. */
  views: Record<string, View>;
  view_forms: Record<string, DeclaredProperty[]>;
  /** The node that each frame can be followed by. */
  frame_nodes: Record<string, string>;
  stores: Record<string, Record<string, unknown>>;
}
/** What is shown at a moment, by the numbers in the chunks. */
export interface RecordedState {
  ros: number;
  scene: Set<number>;
  stores: Map<string, Map<string, number>>;
  panes: Map<string, number[]>;
}
/** A message of the scene without its content. */
export type MessageFacts = { number: number; key: string; node: string; phase: string };
/** The playback of a run. */
export interface Playing {
  position: number;
  isPlaying: boolean;
  rate: number;
  loop: boolean;
  selected: [number, number] | null;
}
/** A view, as config files have it. */
export interface View {
  type: string;
  target_frame: string;
  invert_z_axis?: boolean;
  point_towards?: string;
  lock_camera?: boolean;
  distance?: number;
  yaw?: number;
  pitch?: number;
  focal_point?: Vec3;
  position?: Vec3;
  scale?: number;
  angle?: number;
  x?: number;
  y?: number;
}
/** Where a camera is and what it looks at. */
export type ViewCamera = [position: Vec3, lookAt: Vec3];
/** Where the coordinates of a view are in the fixed frame. */
export type ViewRig = { origin: Vec3; wxyz: Wxyz };
/** A value of each item of a node, or the one that all have. */
export type Column = { all: unknown } | { each: unknown[] } | { numbers: number[]; unit: string };
/** The details of what is drawn as one node; see webviz/engine/pipeline/selectable.py. */
export type NodeValues = Map<string, any>;
