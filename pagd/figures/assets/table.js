// ---- tables: sorting and filtering ----------------------------------------------------------

function orderOf(cell) {
  if (cell.dataset.order !== undefined) return Number(cell.dataset.order);
  const text = cell.textContent.trim();
  return text === "–" ? null : text;
}

// Numbers before words; what is not known always comes last.
function compare(a, b, sign) {
  if (a === null || b === null) return (a === null) - (b === null);
  if (typeof a !== typeof b) return typeof a === "number" ? -1 : 1;
  return sign * (typeof a === "number" ? a - b : a.localeCompare(b, "en", { numeric: true }));
}

function sortBy(table, heading) {
  const falling = heading.getAttribute("aria-sort") === "ascending";
  for (const other of heading.parentElement.children) other.removeAttribute("aria-sort");
  heading.setAttribute("aria-sort", falling ? "descending" : "ascending");
  const [body, column, sign] = [table.tBodies[0], heading.cellIndex, falling ? -1 : 1];
  const rows = [...body.rows].map((row) => [orderOf(row.cells[column]), row]);
  rows.sort(([a], [b]) => compare(a, b, sign));
  body.append(...rows.map(([, row]) => row));
}

// A row stays if it has all words of the filter.
function filter(table, text) {
  const words = text.toLowerCase().split(/\s+/).filter(Boolean);
  const rows = [...table.tBodies[0].rows];
  for (const row of rows) {
    const content = [...row.cells].map((cell) => cell.textContent).join(" ").toLowerCase();
    row.hidden = !words.every((word) => content.includes(word));
  }
  return `${rows.filter((row) => !row.hidden).length} of ${rows.length} designs`;
}

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

function prepareTables() {
  prepareBoxes();
  for (const table of document.querySelectorAll("table.sortable")) {
    for (const heading of table.tHead.rows[0].cells) {
      heading.querySelector("button").addEventListener("click", () => sortBy(table, heading));
    }
    const input = document.querySelector(`input[data-filters="${table.id}"]`);
    const count = document.querySelector(`[data-count="${table.id}"]`);
    const apply = () => (count.textContent = filter(table, input.value));
    input.addEventListener("input", apply);
    apply();
  }
}
