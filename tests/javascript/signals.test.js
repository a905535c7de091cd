import assert from "node:assert/strict";
import { mock, test } from "node:test";

import {
  batch,
  computed,
  each,
  effect,
  owned,
  root,
  signal,
  untracked,
} from "../../webviz/page/web/signals.js";

/** @import {Readable} from "webviz/signals.js" */

/**
 * An effect that keeps what it reads.
 *
 * @template T
 * @param {() => T} read
 */
function follow(read) {
  /** @type {T[]} */
  const seen = [];
  const end = effect(() => {
    seen.push(read());
  });
  return { seen, end };
}

/**
 * What is printed as errors while `act` runs.
 *
 * @param {() => unknown} act
 */
function errorsOf(act) {
  /** @type {string[]} */
  const errors = [];
  const printed = mock.method(console, "error", (/** @type {Error} */ error) =>
    errors.push(error.message),
  );
  act();
  printed.mock.restore();
  return errors;
}

test("an effect runs again when a signal it has read changes, before the write returns", () => {
  const count = signal(1);
  const { seen, end } = follow(() => count.value);
  count.value = 2;
  count.value = 2;
  assert.deepEqual(seen, [1, 2]);
  end();
  count.value = 3;
  assert.deepEqual([seen, count.readers.size], [[1, 2], 0]);
});

test("an effect depends on the signals of its last run", () => {
  const [isOn, text] = [signal(true), signal("a")];
  const { seen } = follow(() => isOn.value && text.value);
  isOn.value = false;
  text.value = "b";
  assert.deepEqual(seen, ["a", false]);
  assert.equal(text.readers.size, 0);
});

test("an effect runs once for all that a batch has written, also where it throws", () => {
  const [x, y] = [signal(1), signal(1)];
  const { seen } = follow(() => x.value + y.value);
  batch(() => {
    x.value = 2;
    batch(() => (y.value = 2));
    assert.deepEqual(seen, [2]);
  });
  assert.throws(() =>
    batch(() => {
      x.value = 3;
      throw new Error("no");
    }),
  );
  assert.deepEqual(seen, [2, 4, 5]);
});

test("a computed value is made once for all its readers, and only while somebody reads it", () => {
  const count = signal(1);
  let made = 0;
  const double = computed(() => {
    made += 1;
    return count.value * 2;
  });
  count.value = 2;
  assert.deepEqual([made, double.value, double.value, made], [0, 4, 4, 1]);
  const [one, other] = [follow(() => double.value), follow(() => double.value + 1)];
  count.value = 3;
  assert.deepEqual([one.seen, other.seen, made], [[4, 6], [5, 7], 2]);
  one.end();
  other.end();
  count.value = 4;
  assert.deepEqual([made, count.readers.size, double.value], [2, 0, 8]);
});

test("an effect does not run where computed values stay as they were", () => {
  const count = signal(1);
  const isOdd = computed(() => count.value % 2 === 1);
  const words = computed(() => (isOdd.value ? "odd" : "even"));
  const { seen } = follow(() => words.value);
  count.value = 3;
  count.value = 4;
  assert.deepEqual(seen, ["odd", "even"]);
});

test("no effect sees one value of now and another of before", () => {
  const count = signal(1);
  const [next, double] = [computed(() => count.value + 1), computed(() => count.value * 2)];
  const { seen } = follow(() => [count.value, next.value, double.value]);
  count.value = 2;
  assert.deepEqual(seen, [
    [1, 2, 2],
    [2, 3, 4],
  ]);
});

test("an error of a computed value is thrown where it is read, until it can be computed", () => {
  const count = signal(0);
  const inverse = computed(() => {
    if (count.value === 0) throw new Error("division by zero");
    return 1 / count.value;
  });
  assert.throws(() => inverse.value, { message: "division by zero" });
  const { seen } = follow(() => {
    try {
      return inverse.value;
    } catch (error) {
      return String(error);
    }
  });
  count.value = 2;
  assert.deepEqual(seen, ["Error: division by zero", 0.5]);
});

test("an effect that throws does not stop others, nor itself the next time", () => {
  const count = signal(1);
  /** @type {number[]} */
  const seen = [];
  effect(() => {
    if (count.value === 2) throw new Error("not two");
    seen.push(count.value);
  });
  const other = follow(() => count.value);
  assert.deepEqual(
    errorsOf(() => (count.value = 2)),
    ["not two"],
  );
  count.value = 3;
  assert.deepEqual(
    [seen, other.seen],
    [
      [1, 3],
      [1, 2, 3],
    ],
  );
});

test("an error of the first run of an effect is thrown where it is created, and ends it", () => {
  const count = signal(1);
  const make = () =>
    effect(() => {
      effect(() => void count.value);
      throw new Error(`no ${count.value}`);
    });
  assert.throws(make, { message: "no 1" });
  assert.equal(count.readers.size, 0);
});

test("effects that never come to rest are stopped, and reported", () => {
  const [count, other] = [signal(0), signal(0)];
  const { seen } = follow(() => other.value);
  const start = () => effect(() => void (count.value += 1));
  const errors = errorsOf(start);
  assert.match(String(errors.at(-1)), /keeps changing its own inputs/);
  other.value = 1;
  assert.deepEqual(seen, [0, 1]);
});

test("effects end with the effect that created them, and before it runs again", () => {
  const [chosen, text] = [signal("a"), signal("x")];
  /** @type {string[]} */
  const seen = [];
  /** @type {string[]} */
  const ended = [];
  const end = root((end) => {
    effect(() => {
      const own = chosen.value;
      effect(() => void seen.push(own + text.value));
      owned(() => ended.push(own));
    });
    return end;
  });
  chosen.value = "b";
  text.value = "y";
  assert.deepEqual([seen, ended], [["ax", "bx", "by"], ["a"]]);
  end();
  text.value = "z";
  assert.deepEqual([seen.length, ended, text.readers.size], [3, ["a", "b"], 0]);
});

test("an outer effect runs first, so that an inner one never reads a removed value", () => {
  const chosen = signal(/** @type {{name: string} | null} */ ({ name: "a" }));
  const isBold = signal(false);
  /** @type {unknown[]} */
  const seen = [];
  effect(() => {
    if (chosen.value) effect(() => void seen.push([chosen.value?.name, isBold.value]));
  });
  const errors = errorsOf(() =>
    batch(() => {
      isBold.value = true;
      chosen.value = null;
    }),
  );
  assert.deepEqual([seen, errors], [[["a", false]], []]);
});

test("an effect may end itself", () => {
  const count = signal(0);
  /** @type {number[]} */
  const seen = [];
  root((end) =>
    effect(() => {
      seen.push(count.value);
      if (count.value === 1) {
        end();
        effect(() => void seen.push(count.value));
      }
    }),
  );
  count.value = 1;
  count.value = 2;
  assert.deepEqual([seen, count.readers.size], [[0, 1, 1], 0]);
});

test("an untracked read adds no dependency", () => {
  const [x, y] = [signal(1), signal(1)];
  const { seen } = follow(() => x.value + untracked(() => y.value));
  y.value = 5;
  x.value = 2;
  assert.deepEqual(seen, [2, 7]);
});

test("rows are made once for each key, in the order of the list, and follow their items", () => {
  const list = signal([
    { id: 1, text: "a" },
    { id: 2, text: "b" },
  ]);
  /** @type {number[]} */
  const made = [];
  /** @type {number[]} */
  const ended = [];
  const rows = each(
    () => list.value,
    ({ id }) => id,
    (item, id) => {
      made.push(id);
      owned(() => ended.push(id));
      const row = { text: "" };
      effect(() => (row.text = item.value.text));
      return row;
    },
  );
  const { seen } = follow(rows);
  list.value = [
    { id: 3, text: "c" },
    { id: 2, text: "B" },
    { id: 2, text: "twice" },
  ];
  assert.deepEqual([made, ended], [[1, 2, 3], [1]]);
  assert.deepEqual(
    seen[1].map(({ text }) => text),
    ["c", "twice"],
  );
  assert.equal(seen[1][1], seen[0][1]);
  list.value = [{ id: 1, text: "again" }];
  assert.deepEqual(
    [made, ended],
    [
      [1, 2, 3, 1],
      [1, 2, 3],
    ],
  );
});

test("10 000 rows that were made and removed leave no reader behind", () => {
  const [shared, list] = [signal(0), signal(/** @type {number[]} */ ([]))];
  const shown = computed(() => shared.value + 1);
  const row = (/** @type {Readable<number>} */ item) => {
    effect(() => void (item.value + shared.value));
    effect(() => void shown.value);
  };
  const end = root((end) => {
    const rows = each(
      () => list.value,
      (number) => number,
      row,
    );
    effect(() => void rows());
    return end;
  });
  list.value = Array.from({ length: 10_000 }, (_, index) => index);
  assert.equal(shared.readers.size, 10_001);
  list.value = [5];
  assert.equal(shared.readers.size, 2);
  end();
  assert.deepEqual([shared.readers.size, list.readers.size, shown.readers.size], [0, 0, 0]);
});
