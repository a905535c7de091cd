// Types that modules share; those of the server are in messages.d.ts and contents.d.ts.

import type { Matrix4, Object3D, Vector3, WebGLProgramParametersWithUniforms } from "three";
import type { LiveTopic, Stores } from "./contents.js";
import type { Tools } from "./messages.js";
import type { Readable } from "./signals.js";

/** x and y, in pixels unless it is said otherwise. */
export type Vec2 = [number, number];
/** x, y and z, in metres unless it is said otherwise. */
export type Vec3 = [number, number, number];
/** A quaternion: w, x, y, z. */
export type Wxyz = [number, number, number, number];

/** Values of a store by key: its own keys, and items under all others. */
export interface StoreValues<S extends { own: object; items: unknown }> extends Iterable<
  [string, S["items"]]
> {
  get<K extends keyof S["own"]>(key: K): S["own"][K];
  get(key: string): S["items"] | undefined;
  has(key: string): boolean;
  keys(): MapIterator<string>;
  values(): MapIterator<S["items"]>;
  entries(): MapIterator<[string, S["items"]]>;
  readonly size: number;
}

/** Name of a store, without what stands behind the colon. */
export type StoreName = keyof Stores;
/** The store of a name with its argument. */
export type Named<N extends string> = N extends StoreName
  ? Stores[N]
  : N extends `${infer S extends StoreName}:${string}`
    ? Stores[S]
    : never;
/** Values of a store by its name. */
export type ValuesOf<N extends string> = StoreValues<Named<N>>;
/** A store that is read in effects, whose values come later; see `store`. */
export interface StoreReader<S extends { own: object; items: unknown }> {
  get<K extends keyof S["own"]>(key: K): S["own"][K] | undefined;
  get(key: string): S["items"] | undefined;
  has(key: string): boolean;
  all(): StoreValues<S>;
  isThere(): boolean;
}

/** The value of an attribute; null and undefined are none. */
type Plain = string | number | boolean | null | undefined;
/** What `el` takes as an attribute: a value, what is read for one, or a listener. */
export type Attribute = Plain | Readable<Plain> | ((event: any) => unknown);
/** What is shown in an element. */
export type Child = Node | string | null | undefined;
/** What `el` takes as children: some, or what is read for them. */
export type Children = Child | Child[] | Readable<Child> | (() => Child | Child[]);
/** Ends what was begun. */
export type End = () => void;

/** A panel of the side; see `panels.js`. */
export interface Panel {
  name: string;
  title: string;
  /** Its place among the tabs; the last without it. */
  order?: number;
  /** Fills an element, and the middle of its head if it has filters or actions; returns what ends that. */
  open(element: HTMLElement, head: HTMLElement): End | void;
  /** Removes it, if it was added. */
  remove?(): unknown;
  /** Where it is unless it is placed: "In the tabs" without it. */
  home?: string;
  /** Its tab is there while it is open only. */
  isOnDemand?: boolean;
}

/** What became of a command, and what it made, such as `display`. */
export type Outcome = { level: string; text: string; [made: string]: string };

/** An option of a list: `label` is shown in place of the value, `note` at the right. */
export type Choice = { value: string; label?: string; note?: string; level?: string };
/** What messages tell of a property: the rate of a topic, or names and how many have each. */
export type LiveFacts = LiveTopic | Record<string, number | string>;
/** Sends the value of a property by its path; returns the promise of `act`. */
export type SendProperty = (path: string, value: unknown) => unknown;
/** The values of a form, by "value.", "offered." or "topic." and a path; they are read in effects. */
export type FormValues = { get(key: string): any };
/** What a control is made with; values are of the kind of its property, and read in effects. */
export interface ControlOptions<T = any> {
  label: string;
  /** Its tooltip. */
  help?: string;
  /** What the viewer has, undefined before that is known. */
  value(): T | undefined;
  /** Sends what was entered; may return the promise of `act`. */
  change(value: T): unknown;
  /** Says why that means nothing, "" if all is well. */
  refused(text: string): void;
  /** What messages tell of topics, and of switches whose names are "offered". */
  live?(): LiveFacts | undefined;
  /** What holds for switches of other names, for properties with an "otherwise". */
  otherwise?(): unknown;
}
/** A control of a property; see `control.js`. */
export interface Control {
  element: HTMLElement;
  focus(): void;
  /** Makes a label change the value when it is dragged. */
  handle?(label: HTMLElement): void;
}

/** An object of the scene, of three.js or of what viser draws with; its flags say of which class. */
export interface SceneObject extends Object3D {
  children: SceneObject[];
  parent: SceneObject | null;
  isMesh?: boolean;
  isInstancedMesh?: boolean;
  isInstancedMesh2?: boolean;
  isLineSegments2?: boolean;
  isPoints?: boolean;
  isLight?: boolean;
  isText?: undefined;
  /** Set on one that a module has changed. */
  webviz?: boolean;
  /** Of one that is drawn several times. */
  instancesCount?: number;
  getMatrixAt?(number: number, into: Matrix4): Matrix4;
  /** Of three.js, with attributes of its own. */
  geometry?: any;
  /** Of three.js or one of viser's own, with uniforms of its own. */
  material?: any;
  traverse(visit: (object: SceneObject) => unknown): void;
}
/** A text of the scene, of which three.js has no object; see `texts.js`. */
export interface SceneText {
  isText: true;
  isPoints?: undefined;
  isLineSegments2?: undefined;
  number: number;
  /** In the coordinates of its node. */
  local: Vec3;
  /** In coordinates of three.js. */
  place: Vector3;
  /** Around it: left, bottom, width and height in metres along the screen. */
  rect: [number, number, number, number];
}
/** The program of a material before it is compiled. */
export type Shader = Pick<WebGLProgramParametersWithUniforms, "vertexShader" | "fragmentShader">;
/** A message of viser's, of which modules read some fields. */
export type ViserMessage = { type: string; [field: string]: any };

/** First and last value. */
export type Range = [number, number];
/** A rectangle of a canvas, in pixels. */
export type Area = { left: number; top: number; width: number; height: number };
/** A part of a curve: its times in seconds and values; NaN ends a line. */
export type Piece = { times: Float64Array; values: Float64Array };
/** A curve as the server describes it: its pieces from the first to before the last. */
export type Facts = { key: number; name: string; problem: string; chunks: [number, number]; axis: number; unit: string };
/** A curve of a chart. */
export type Curve = { key: number; name: string; problem: string; pieces: Piece[]; axis: number; unit: string };
/** Seconds from the start, level, and text. */
export type LoggedEvent = [number, string, string];

/** The node of the viewer that an object belongs to; `first` is the number of its first point. */
export type NodePart = { group: string; key: string; path: string; first: number };
/** An object that displays draw, see `things`. */
export type SceneThing = { object: SceneObject | SceneText; name: string; node: NodePart; ordinal: number };
/** A thing of the scene as `pickAt` found it; `at` and `local` are empty if it is gone. */
export type Picked = {
  group: string;
  key: string;
  path: string;
  name: string;
  ordinal: number;
  object: SceneObject | SceneText;
  number: number | null;
  color: Vec3 | null;
  item: number | null;
  at: Vec3 | [];
  local: Vec3 | [];
  /** In coordinates of three.js. */
  point: Vector3;
  outline?: Shape | null;
};
/** What is under a point of the window: a thing, or the ground. */
export type Hit = Picked | { point: Vector3; object: null };
/** Points in coordinates of three.js, and which of them are joined. */
export type Shape = { points: Vector3[]; edges: number[][] };
/** The shape around something, and whether something else is drawn there now. */
export type Outline = Shape & { isOld: boolean };
/** What this page has selected; `oldSince` counts in ms. */
export type Selected = Picked & { id: number; isKnown?: boolean; oldSince?: number | null };

/** An event of the pointer over the scene. */
export type SceneEvent = PointerEvent | WheelEvent;
/** A tool as the viewer describes it. */
export type ViewerTool = Tools["tools"][number];
/** What a gesture adds to a tool; see `gestures.js`. */
export interface GestureParts {
  /** A sentence on what to do. */
  hint?: string;
  icon?: string;
  cursor?: string;
  /** Takes an event before the camera; whether it did. */
  pointer?(event: SceneEvent): boolean;
  /** Called when the tool becomes active. */
  select?(): void;
  /** Called when it is not any more. */
  leave?(): void;
}
/** A tool of the registry. */
export interface Tool extends GestureParts, Partial<Omit<ViewerTool, "icon">> {
  id: string;
  name: string;
  tooltip: string;
  icon: string;
  /** Its place among the others. */
  order: number;
  /** Whether its button is an icon only. */
  isLean?: boolean;
}
/** What gestures know of a tool of the registry or of the viewer. */
export type ToolFacts = Pick<
  Tool,
  "id" | "name" | "gesture" | "surface" | "several" | "stays" | "asks"
>;
/** A finished gesture; `yaws` and `several` are of poses that were collected. */
export type MadeGesture = {
  points: Vec3[];
  yaw: number;
  keys: string[];
  yaws?: number[];
  several?: string;
};
/** Makes what a tool of the viewer has besides its name. */
export type Gesture = (tool: ViewerTool, finish: (result: Partial<MadeGesture> & { points: Vec3[] }) => void) => GestureParts;

/** A rectangle of the window, in CSS pixels. */
export type Box = { left: number; top: number; right: number; bottom: number };
/** The store "playback" with "first", "duration", "position" and "ago" at a moment; see `moment.js`. */
export type Moment = Map<string, any>;
