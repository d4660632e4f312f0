// ---- the page -------------------------------------------------------------------------------

followDark();
prepareBoxes();
prepareComparison(prepareExplorer());
drawPaths();
prepareCards();
followLinks();
dark.addEventListener("change", followDark);
dark.addEventListener("change", () => redraws.forEach((draw) => draw()));
