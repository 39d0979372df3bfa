// Answers questions (one JSON per line of stdin) by the WebAssembly in the folder argv[2]; an answer per line.
// With a second argument, CPU milliseconds per question are written to that file, a line each.
"use strict";
const fs = require("fs"), path = require("path");
const folder = process.argv[2], core_of = require(path.join(folder, "studio_core.js"));

(async () => {
  const core = await core_of({wasmBinary: fs.readFileSync(path.join(folder, "studio_core.wasm"))});
  const times = [];
  for (const line of fs.readFileSync(0, "utf8").split("\n").filter(Boolean)) {
    const size = core.lengthBytesUTF8(line) + 1, at = core._malloc(size);
    core.stringToUTF8(line, at, size);
    const began = process.cpuUsage();
    process.stdout.write(core.UTF8ToString(core._joulepath_answer(at)).replaceAll("\n", "") + "\n");
    core._free(at);
    const took = process.cpuUsage(began);
    times.push((took.user + took.system) / 1000);
  }
  if (process.argv[3]) fs.writeFileSync(process.argv[3], times.join("\n") + "\n");
})();
