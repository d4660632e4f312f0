// ---- all designs: a table, and a plot of any two figures --------------------------------------

// With more points than this, the graphics card draws them.
const MANY_POINTS = 3000;
const FORMATS = {};

// Numbers as everywhere on the page: a true minus, digits in threes.
function written(value, digits) {
  FORMATS[digits] ??= new Intl.NumberFormat("en", {
    minimumFractionDigits: digits,
    maximumFractionDigits: digits,
  });
  return FORMATS[digits].format(value).replace("-", "−");
}

function escapeText(text) {
  const element = document.createElement("span");
  element.textContent = text;
  return element.innerHTML.replaceAll('"', "&quot;");
}

class Explorer {
  constructor({ columns, rows, links }) {
    this.columns = columns;
    this.rows = rows;
    this.links = new Set(links);
    this.chosen = new Set();
    this.shown = rows.map((_, i) => i);
    this.place = Object.fromEntries(columns.map(({ key }, i) => [key, i]));
    this.element = document.getElementById("plot-explorer");
    this.count = document.getElementById("explorer-count");
    this.whenChosen = () => {};
  }

  start() {
    this.fillChoices();
    this.draw = register(this.element, () => this.traces(), () => this.layout());
    this.listenToPlot();
    this.table = this.makeTable();
    document.getElementById("explorer-clear").addEventListener("click", () => this.choose([]));
  }

  // ---- plot

  fillChoices() {
    const numbers = this.columns.filter(({ digits }) => digits !== null);
    const wanted = { x: "bending_deg", y: "twist_deg" };
    for (const [axis, key] of Object.entries(wanted)) {
      const list = document.getElementById(`explorer-${axis}`);
      list.append(...numbers.map(({ heading, key }) => new Option(heading, key)));
      list.value = key in this.place ? key : (numbers[0] || {}).key;
      list.addEventListener("change", () => this.draw());
      this[axis] = list;
    }
  }

  value(row, key) {
    return this.rows[row][this.place[key]];
  }

  traces() {
    const [x, y] = [this.x.value, this.y.value];
    const known = this.shown.filter((i) => this.value(i, x) != null && this.value(i, y) != null);
    const modes = [...new Set(known.map((i) => this.value(i, "mode")))];
    const order = Object.keys(content.modes);
    modes.sort((a, b) => order.indexOf(a) - order.indexOf(b));
    return modes.map((mode) => {
      const rows = known.filter((i) => this.value(i, "mode") === mode);
      return this.trace(String(mode ?? "unknown"), rows, x, y);
    });
  }

  trace(mode, rows, x, y) {
    const chosen = rows.flatMap((row, i) => (this.chosen.has(row) ? [i] : []));
    const full = (row) => this.value(row, "analysis") === "full";
    return {
      type: this.rows.length > MANY_POINTS ? "scattergl" : "scatter",
      mode: "markers",
      name: mode,
      x: rows.map((row) => this.value(row, x)),
      y: rows.map((row) => this.value(row, y)),
      customdata: rows,
      text: rows.map((row) => this.about(row)),
      hovertemplate: "%{text}<br>%{x:.4g}, %{y:.4g}<extra></extra>",
      selectedpoints: this.chosen.size ? chosen : null,
      unselected: { marker: { opacity: 0.15 } },
      marker: {
        color: modeColour(mode),
        size: rows.map((row) => (full(row) ? 10 : 5)),
        opacity: rows.map((row) => (full(row) ? 1 : 0.55)),
        line: { width: rows.map((row) => (full(row) ? 1 : 0)), color: colour("sheet") },
      },
    };
  }

  about(row) {
    const words = ["design_id", "origin", "status", "analysis"].map((key) => this.value(row, key));
    return escapeText(words.filter(Boolean).join(", "));
  }

  layout() {
    const title = (key) => {
      const { heading, unit } = this.columns[this.place[key]] || { heading: "", unit: "" };
      return unit ? `${heading}, ${unit}` : heading;
    };
    return flatLayout("", axis(title(this.x.value)), axis(title(this.y.value)), {
      dragmode: "select",
      showlegend: true,
      legend: { orientation: "h", x: 0, y: 1.02, yanchor: "bottom", itemsizing: "constant" },
      // Another pair of figures is another picture, whose ranges are its own.
      uirevision: `${this.x.value} ${this.y.value}`,
    });
  }

  listenToPlot() {
    this.element.on("plotly_selected", (event) => {
      if (event) this.choose(event.points.map((point) => point.customdata));
    });
    this.element.on("plotly_deselect", () => this.choose([]));
    this.element.on("plotly_click", ({ points: [point] }) => {
      if (this.links.has(point.customdata)) openCard(this.value(point.customdata, "design_id"));
    });
  }

  // ---- table

  makeTable() {
    const first = this.columns.length;
    const table = new DataTable("#explorer-table", {
      data: this.rows,
      columns: [...this.columns.map((column, i) => this.column(column, i)), this.orderOfChosen()],
      // Chosen rows come first, whatever else they are sorted by.
      orderFixed: { pre: [[first, "asc"]] },
      order: [],
      deferRender: true,
      scrollX: true,
      pageLength: 10,
      lengthMenu: [10, 25, 100, 1000],
      // A click on a name opens its card, and marks nothing.
      select: { style: "multi+shift", selector: "td:not(:first-child)", info: false },
      fixedColumns: { start: innerWidth > 760 ? 1 : 0 },
      layout: { topStart: null, topEnd: "search", bottomStart: ["info", "pageLength"] },
      language: {
        info: "_START_ to _END_ of _TOTAL_ designs",
        infoFiltered: "(of _MAX_)",
        search: "Find",
      },
    });
    table.on("draw", () => this.follow());
    table.on("user-select", () => setTimeout(() => this.takeOver()));
    return table;
  }

  column({ heading, unit, digits }, i) {
    const numeric = digits !== null;
    return {
      title: unit ? `${heading} <small>${unit}</small>` : heading,
      type: numeric ? "num" : "string",
      className: numeric ? "dt-right" : "dt-left",
      columnControl: ["order", numeric ? ["search"] : ["search", "searchList"]],
      render: (value, how, row, { row: number }) => this.cell(value, how, i, number),
    };
  }

  cell(value, how, column, number) {
    const { digits, key } = this.columns[column];
    if (how !== "display") return value ?? (digits === null ? "" : null);
    if (value === null) return "–";
    if (digits !== null) return written(value, digits);
    const text = escapeText(String(value));
    if (key === "status") {
      return `<span class="status ${value === "ok" ? "ok" : "failed"}">${text}</span>`;
    }
    const linked = key === "design_id" && this.links.has(number);
    return linked ? `<a href="#design-${encodeURIComponent(value)}">${text}</a>` : text;
  }

  orderOfChosen() {
    return {
      data: null,
      visible: false,
      searchable: false,
      type: "num",
      render: (data, how, row, { row: number }) => (this.chosen.has(number) ? 0 : 1),
    };
  }

  // The plot shows what the filters of the table leave.
  follow() {
    const shown = this.table.rows({ search: "applied" }).indexes().toArray().sort((a, b) => a - b);
    this.tell(shown.length);
    if (shown.join() === this.shown.join()) return;
    this.shown = shown;
    this.draw();
  }

  // Rows that were marked in the table are the chosen ones.
  takeOver() {
    this.chosen = new Set(this.table.rows({ selected: true }).indexes().toArray());
    this.tell(this.shown.length);
    this.draw();
    this.whenChosen();
  }

  choose(rows) {
    this.chosen = new Set(rows);
    this.table.rows().deselect();
    this.table.rows(rows).select();
    this.table.rows().invalidate().draw();
    this.draw();
    this.whenChosen();
  }

  tell(shown) {
    const chosen = this.chosen.size ? `, ${this.chosen.size} selected` : "";
    this.count.textContent = `${shown} of ${this.rows.length} designs${chosen}`;
  }
}

function prepareExplorer() {
  if (!document.getElementById("explorer-table")) return null;
  const explorer = new Explorer(content.explorer);
  explorer.start();
  explorer.tell(explorer.rows.length);
  return explorer;
}

// DataTables has a look of its own for the dark.
function followDark() {
  document.documentElement.classList.toggle("dark", dark.matches);
}
