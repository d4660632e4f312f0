// ---- boxes that scroll ------------------------------------------------------------------------

// A table with columns beyond its box fades there.
function fade(box) {
  const hidden = box.scrollWidth - box.clientWidth - box.scrollLeft;
  box.classList.toggle("more", hidden > 1);
}

function prepareBoxes() {
  const watcher = new ResizeObserver((entries) => entries.forEach(({ target }) => fade(target)));
  for (const box of document.querySelectorAll(".scroll")) {
    box.addEventListener("scroll", () => fade(box), { passive: true });
    watcher.observe(box);
  }
}
