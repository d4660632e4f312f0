// ---- up to four designs side by side ----------------------------------------------------------

const MOST_COMPARED = 4;

// What is drawn of all of them: title, unit, and the points of one design.
const comparedPlots = [
  ["Bending of the tip", "degrees", ({ path }) => path && [path.pressure_kPa, path.bending_deg]],
  ["Twist of the tip", "degrees", ({ path }) => path && [path.pressure_kPa, path.twist_deg]],
  ["Blocked force", "force, N", ({ steps: { held } }) => held && [held.pressure_kPa, held.force_N]],
  [
    "Cavity volume",
    "volume / unloaded volume",
    ({ steps: { free } }) => free && [free.pressure_kPa, free.volume],
  ],
];

class Comparison {
  constructor(explorer) {
    this.explorer = explorer;
    this.box = document.getElementById("compare");
    this.button = document.getElementById("explorer-compare");
    this.slider = this.box.querySelector(".together input");
    this.output = this.box.querySelector(".together output");
    this.missing = this.box.querySelector(".missing");
    this.viewers = [];
    this.plots = [];
    this.asked = 0;
    this.button.addEventListener("click", () => this.show([...explorer.chosen]));
    this.box.querySelector(".close").addEventListener("click", () => this.close());
    this.slider.addEventListener("input", () => this.press(Number(this.slider.value)));
    explorer.whenChosen = () => this.allow();
    this.allow();
  }

  allow() {
    const count = this.explorer.chosen.size;
    this.button.disabled = count < 2 || count > MOST_COMPARED;
    this.button.title = this.button.disabled ? `Select two to ${MOST_COMPARED} designs` : "";
  }

  close() {
    this.asked++;
    this.box.hidden = true;
    delete this.box.dataset.shown;
    this.viewers.forEach((viewer) => viewer.close());
    this.plots.forEach(([element, draw]) => forget(element, draw));
    [this.viewers, this.plots] = [[], []];
    for (const part of this.box.querySelectorAll(".columns, .grid")) part.replaceChildren();
  }

  async show(rows) {
    this.close();
    const asked = this.asked;
    this.box.hidden = false;
    this.box.scrollIntoView();
    this.tabulate(rows);
    const linked = rows.filter((row) => this.explorer.links.has(row));
    const found = await Promise.all(linked.map((row) => this.load(row)));
    // Closed, or asked for other designs, while the files were read.
    if (asked !== this.asked) return;
    this.missing.textContent = found.map(({ error }) => error).filter(Boolean).join(" ");
    const compared = found
      .filter(({ error }) => !error)
      .map((one, i) => ({ ...one, dash: "solid", colour: content.palette[i] }));
    this.addShapes(compared.filter(({ shape }) => shape));
    this.addPlots(compared);
    this.box.dataset.shown = "yes";
  }

  async load(row) {
    const name = this.explorer.value(row, "design_id");
    try {
      return { ...(await loadCard(name)), name };
    } catch (error) {
      return { error: error.message };
    }
  }

  // All figures that one of the designs has, a column a design.
  tabulate(rows) {
    const { columns } = this.explorer;
    const known = columns.filter(({ key }) => rows.some((row) => this.explorer.value(row, key) != null));
    const head = (tag, text) => {
      const cell = document.createElement(tag);
      cell.textContent = text;
      return cell;
    };
    const lines = known.map(({ heading, unit, key, digits }) => {
      const line = document.createElement("tr");
      const values = rows.map((row) => {
        const value = this.explorer.value(row, key);
        if (value == null) return "–";
        return digits === null ? String(value) : written(value, digits);
      });
      line.append(
        head("th", unit ? `${heading}, ${unit}` : heading),
        ...values.map((text) => head(key === "design_id" ? "th" : "td", text)),
      );
      return line;
    });
    this.box.querySelector("tbody").replaceChildren(...lines);
  }

  addShapes(compared) {
    const columns = this.box.querySelector(".columns");
    this.viewers = compared.map((one) => {
      const column = document.createElement("article");
      const title = document.createElement("h3");
      title.textContent = one.name;
      title.style.setProperty("--design", one.colour);
      column.append(title, copyOf("shape"));
      columns.append(column);
      return new Viewer(column, one, one);
    });
    // One scale of colours for all.
    const top = Math.max(0, ...compared.map(({ shape }) => shape.top));
    for (const viewer of this.viewers) viewer.top = top;
    const most = Math.max(0, ...compared.map(({ shape }) => Math.max(...shape.pressure_kPa)));
    this.box.querySelector(".together").hidden = !most;
    this.slider.max = most;
    this.slider.value = most;
    if (most) this.press(most);
  }

  // Each shape goes to its recorded pressure that is nearest; of two that are, to the first.
  press(pressure) {
    this.tell(pressure);
    for (const viewer of this.viewers) {
      const off = viewer.data.pressure_kPa.map((one) => Math.abs(one - pressure));
      viewer.slider.value = off.indexOf(Math.min(...off));
      viewer.stop();
      viewer.update();
    }
  }

  tell(pressure) {
    this.output.textContent = kilopascals(pressure);
  }

  addPlots(compared) {
    const wanted = comparedPlots
      .map(([title, unit, points]) => {
        const there = compared.filter((one) => points(one)?.every(Boolean));
        return { title, unit, points, there, element: document.createElement("div") };
      })
      .filter(({ there }) => there.length);
    for (const { element } of wanted) element.className = "plot";
    // All places are there before the first is drawn, or it would take the width of the others.
    this.box.querySelector(".grid").append(...wanted.map(({ element }) => element));
    for (const { title, unit, points, there, element } of wanted) {
      const about = { connectgaps: true, hovertemplate: "%{x:.4~r} kPa: %{y:.4~r}" };
      const draw = register(
        element,
        () => there.map((one) => curve(one, ...points(one), about)),
        () => flatLayout(title, axis("pressure, kPa"), axis(unit), { showlegend: there.length > 1 }),
      );
      this.plots.push([element, draw]);
    }
  }
}

function prepareComparison(explorer) {
  return explorer && new Comparison(explorer);
}
