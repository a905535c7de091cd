import assert from "node:assert/strict";
import test from "node:test";
import { csvText } from "../../webviz/page/web/csv.js";

test("numbers stay numbers, texts are quoted", () => {
  assert.equal(
    csvText([
      ["a", "b"],
      [-1.5, 'c "d",\ne'],
    ]),
    '"a","b"\n-1.5,"c ""d"",\ne"\n',
  );
  assert.equal(csvText([]), "");
});

test("no text is computed by a spreadsheet", () => {
  const texts = ["=1+1", "+1+1", "-a", "@SUM(A1)", "\t=1", "\r=1", " =1", "\n=1", "-1|calc"];
  for (const text of texts) assert.equal(csvText([[text]]), `"'${text}"\n`);
  for (const text of ["a=1", "/tf", "'=1", "", "-1.5", "+2e3"])
    assert.equal(csvText([[text]]), `"${text}"\n`);
});
