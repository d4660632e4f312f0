// ---- the page -------------------------------------------------------------------------------

function openCard(name) {
  const card = document.getElementById("design-" + name);
  if (!card) return;
  card.open = true;
  card.scrollIntoView();
}

// Links to a design lead to its card, and open it.
function followLinks() {
  const follow = () => {
    const name = decodeURIComponent(location.hash);
    if (name.startsWith("#design-")) openCard(name.slice("#design-".length));
  };
  addEventListener("hashchange", follow);
  document.addEventListener("click", (event) => {
    const link = event.target.closest('a[href^="#design-"]');
    if (link && link.hash === location.hash) follow();
  });
  follow();
}

followDark();
prepareBoxes();
prepareExplorer();
drawPaths();
drawShapes();
followLinks();
dark.addEventListener("change", followDark);
dark.addEventListener("change", () => redraws.forEach((draw) => draw()));
