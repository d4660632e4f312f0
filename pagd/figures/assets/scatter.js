// ---- one point a simulated design -----------------------------------------------------------

const known = ["table2", "published"];
const shapes = { bending: "circle", twisting: "triangle-up", mixed: "diamond" };

function symbol(point) {
  if (point.status !== "ok") return "x-thin-open";
  return (shapes[point.mode] || "square") + (known.includes(point.origin) ? "-open" : "");
}

function cloud(mode, points, x, y) {
  const reached = (p) => (p.pressure_kPa === null ? "" : `, ${kilopascals(p.pressure_kPa)}`);
  const about = (p) =>
    `${p.design_id} (${p.origin})<br>${p.status.replaceAll("_", " ")}${reached(p)}`;
  return {
    type: "scatter",
    mode: "markers",
    showlegend: false,
    x: points.map((p) => p[x]),
    y: points.map((p) => p[y]),
    customdata: points.map((p) => (p.link ? p.design_id : "")),
    text: points.map(about),
    hovertemplate: "%{text}<br>%{x:.3g}, %{y:.3g}<extra></extra>",
    marker: {
      color: modeColour(mode),
      size: 10,
      symbol: points.map(symbol),
      line: { width: points.map((p) => (p.status === "ok" ? 1 : 2)), color: modeColour(mode) },
    },
  };
}

// An entry of the legend, which would else look like the first point of its mode.
function entry(mode) {
  const marker = { color: modeColour(mode), size: 10, symbol: shapes[mode] || "square" };
  return { type: "scatter", mode: "markers", name: mode, x: [null], y: [null], marker };
}

function drawCloud(id, [x, xLabel], [y, yLabel]) {
  const element = document.getElementById(id);
  if (!element) return;
  const there = content.points.filter((p) => p[x] !== null && p[y] !== null);
  const of = (mode) => there.filter((p) => p.mode === mode);
  const all = [...new Set([...Object.keys(content.modes), ...there.map((p) => p.mode)])];
  const modes = all.filter((mode) => of(mode).length);
  register(
    element,
    () => modes.flatMap((mode) => [cloud(mode, of(mode), x, y), entry(mode)]),
    () =>
      flatLayout("", axis(xLabel), axis(yLabel), {
        legend: { orientation: "h", x: 0, y: 1.02, yanchor: "bottom" },
      }),
  );
  element.on("plotly_click", ({ points: [point] }) => {
    if (point.customdata) openCard(point.customdata);
  });
}

function drawClouds() {
  const bending = ["bending_deg", "bending, °"];
  drawCloud("plot-bending_twist", bending, ["twist_deg", "twist, °"]);
  drawCloud("plot-novelty_bending", ["novelty", "novelty"], bending);
  drawCloud("plot-force_bending", bending, ["blocked_force_N", "blocked force, N"]);
}
