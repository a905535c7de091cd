// What stands in the window: of webviz, see main.js and head.html, and of viser's page.

interface Window {
  webviz: {
    /** viser's id of this page, null until it is connected. */
    browser: number | null;
    answer(token: string): void;
    probe(number: number): void;
    connect(told: { browser: number; key: string; version: string }): Promise<void>;
    hasView(): boolean;
    pick(xy: [number, number]): unknown;
  };
  webvizStarted(): void;
  /** True in a page that was exported with a recorded run. */
  webvizRun?: boolean;
  /** viser has no types of it; viser_page.js alone reads it, and says what has to be there. */
  __viserMutable: any;
}
