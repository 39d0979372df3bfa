// Formulas of the site by KaTeX, which stands beside this file; what scrolls takes the focus of the keyboard.
addEventListener("DOMContentLoaded", () => {
  for (const formula of document.querySelectorAll(".math"))
    katex.render(formula.textContent, formula, {displayMode: formula.tagName === "DIV", throwOnError: false});
  const reach = () => {
    for (const box of document.querySelectorAll(".content pre, .content table, .content .table-wrapper, .content .math")) {
      if (box.scrollWidth > box.clientWidth && box.clientWidth > 0) box.tabIndex = 0;
      else box.removeAttribute("tabindex");
    }
  };
  addEventListener("load", reach);
  addEventListener("resize", reach);
});
