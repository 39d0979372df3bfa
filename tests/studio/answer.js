// Answers questions (one JSON per line of stdin) by the WebAssembly in the folder argv[2]; an answer per line.
"use strict";
const fs = require("fs"), path = require("path");
const folder = process.argv[2], core_of = require(path.join(folder, "studio_core.js"));

(async () => {
  const core = await core_of({wasmBinary: fs.readFileSync(path.join(folder, "studio_core.wasm"))});
  for (const line of fs.readFileSync(0, "utf8").split("\n").filter(Boolean)) {
    const size = core.lengthBytesUTF8(line) + 1, at = core._malloc(size);
    core.stringToUTF8(line, at, size);
    process.stdout.write(core.UTF8ToString(core._joulepath_answer(at)) + "\n");
    core._free(at);
  }
})();
