// ---- trajectories and angles of all designs -------------------------------------------------

function curve(design, x, y, more) {
  return {
    type: "scatter",
    mode: "lines+markers",
    name: design.name,
    x,
    y,
    line: { color: design.colour, width: 2, dash: design.dash },
    marker: { color: design.colour, size: 6 },
    ...more,
  };
}

// More lines than this in one plot are drawn as one a mode.
const MOST_LINES = 40;

// The designs of one mode in their own colours, or all in the colours of their modes.
class Paths {
  constructor(designs) {
    this.designs = designs;
    this.group = "";
    this.drawGroups();
    this.drawKey();
    this.draw();
  }

  get grouped() {
    return content.groups.length > 0;
  }

  get shown() {
    const chosen = this.designs.filter((design) => !this.group || design.mode === this.group);
    if (!this.byMode) return chosen;
    return chosen.map((d) => ({ ...d, dash: "solid", colour: modeColour(d.mode) }));
  }

  get byMode() {
    const size = this.designs.filter(({ mode }) => mode === this.group).length;
    return this.grouped && (!this.group || size > MOST_LINES);
  }

  // Many lines of one colour are one line with gaps, or a browser would take minutes.
  joined(lines) {
    if (lines.length <= MOST_LINES) return lines;
    const found = new Map();
    for (const line of lines) {
      const key = `${line.line.color} ${line.opacity} ${line.mode}`;
      if (!found.has(key)) found.set(key, { ...line, x: [], y: [], text: [] });
      const all = found.get(key);
      const text = line.x.map((_, i) => [line.name, line.text?.[i]].filter(Boolean).join(", "));
      all.x.push(...line.x, null);
      all.y.push(...line.y, null);
      all.text.push(...text, null);
    }
    const template = "%{text}<br>%{x:.4~r}, %{y:.4~r}<extra></extra>";
    return [...found.values()].map((all) => ({
      ...all,
      connectgaps: false,
      ...(all.hoverinfo === "skip" ? {} : { hovertemplate: template }),
    }));
  }

  drawGroups() {
    if (!this.grouped) return;
    const buttons = ["", ...content.groups].map((group) => {
      const button = document.createElement("button");
      button.type = "button";
      button.textContent = group || "all, by mode";
      button.setAttribute("aria-pressed", group === this.group);
      button.addEventListener("click", () => this.choose(group, button));
      return button;
    });
    document.getElementById("groups").replaceChildren(...buttons);
  }

  choose(group, button) {
    this.group = group;
    for (const other of button.parentElement.children) {
      other.setAttribute("aria-pressed", other === button);
    }
    this.drawKey();
    this.redraw.forEach((draw) => draw());
  }

  // One key for all plots, as text of the page: it wraps, and covers no title.
  drawKey() {
    const groups = this.group ? [this.group] : content.groups;
    const names = this.byMode
      ? groups.map((mode) => ({ name: mode, colour: modeColour(mode) }))
      : this.shown;
    const entries = names.map(({ name, colour, dash }) => {
      const entry = document.createElement("li");
      entry.textContent = name;
      entry.style.setProperty("--design", colour);
      if (dash && dash !== "solid") entry.className = "dashed";
      return entry;
    });
    document.getElementById("key").replaceChildren(...entries);
  }

  draw() {
    // Equal scales and margins that follow the labels would chase each other.
    const fixed = { automargin: false };
    const equal = { scaleanchor: "x", scaleratio: 1 };
    this.redraw = [
      ["side", "Tips from the side", 0, "x, mm"],
      ["front", "Tips from the front", 1, "y, mm"],
    ].map(([id, title, across, label]) =>
      register(
        document.getElementById("plot-" + id),
        () => this.joined(this.shown.flatMap((design) => this.path(design, across))),
        () => flatLayout(title, axis(label, fixed), axis("z, mm", { ...equal, ...fixed }), plain),
      ),
    );
    for (const [id, title] of [
      ["bending", "Bending of the tip"],
      ["twist", "Twist of the tip"],
    ]) {
      const angle = { hovertemplate: "%{x:.4~r} kPa: %{y:.1f}°" };
      const line = (d) => this.thin(curve(d, d.path.pressure_kPa, d.path[id + "_deg"], angle));
      this.redraw.push(
        register(
          document.getElementById("plot-" + id),
          () => this.joined(this.shown.map(line)),
          () => flatLayout(title, axis("pressure, kPa"), axis("degrees"), plain),
        ),
      );
    }
    this.drawForces();
  }

  // Designs whose tip was not held have no line.
  drawForces() {
    const element = document.getElementById("plot-force");
    if (!element) return;
    const force = { connectgaps: true, hovertemplate: "%{x:.4~r} kPa: %{y:.3~r} N" };
    const line = ({ held, ...d }) => this.thin(curve(d, held.pressure_kPa, held.force_N, force));
    this.redraw.push(
      register(
        element,
        () => this.joined(this.shown.filter(({ held }) => held).map(line)),
        () => flatLayout("Blocked force", axis("pressure, kPa"), axis("force, N"), plain),
      ),
    );
  }

  // Many lines are thin, and their markers small.
  thin(trace) {
    if (!this.grouped) return trace;
    return { ...trace, line: { ...trace.line, width: 1.4 }, marker: { ...trace.marker, size: 4 } };
  }

  path(design, across) {
    const { tip, last } = design.path;
    const shape = {
      ...curve(design, last[across], last[2], { mode: "lines", hoverinfo: "skip" }),
      line: { color: design.colour, width: this.grouped ? 3 : 6 },
      opacity: 0.25,
    };
    const text = design.path.pressure_kPa.map(kilopascals);
    const place = { text, hovertemplate: "%{text}<br>%{x} mm, %{y} mm" };
    return [shape, this.thin(curve(design, tip[across], tip[2], place))];
  }
}

// They are drawn when they come into sight: whoever opens a page of many need not wait for them.
function drawPaths() {
  const designs = content.designs.filter((design) => design.path);
  if (!designs.length) return;
  const watch = new IntersectionObserver((entries) => {
    if (!entries.at(-1).isIntersecting) return;
    watch.disconnect();
    new Paths(designs);
  }, { rootMargin: "600px" });
  watch.observe(document.getElementById("plot-side"));
}
