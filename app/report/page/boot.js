"use strict";
// Modules of one file: each becomes an address of its own, and an import map gives the addresses their names.
window.joulepath = {errors: []};
window.addEventListener("error", (event) => window.joulepath.errors.push(String(event.message)));
window.addEventListener("unhandledrejection", (event) => window.joulepath.errors.push(String(event.reason)));
{
  const imports = {};
  for (const module of document.querySelectorAll("script[type='text/x-module']"))
    imports[module.dataset.name] = URL.createObjectURL(new Blob([module.textContent], {type: "text/javascript"}));
  const map = document.createElement("script");
  map.type = "importmap";
  map.textContent = JSON.stringify({imports});
  document.head.append(map);
  const start = document.createElement("script");
  start.type = "module";
  start.textContent = `import "${document.documentElement.dataset.starts}";`;
  document.body.append(start);
}
