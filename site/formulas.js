// Formulas of the site by KaTeX, which stands beside this file.
addEventListener("DOMContentLoaded", () => {
  for (const formula of document.querySelectorAll(".math"))
    katex.render(formula.textContent, formula, {displayMode: formula.tagName === "DIV", throwOnError: false});
});
