// ---- steps of the analyses of one design ----------------------------------------------------

const analysisNames = { free: "free", held: "held" };

// Title, what lies along, what is drawn, and how a point is told.
const stepPlots = [
  {
    title: "Blocked force",
    x: ["pressure_kPa", "pressure, kPa"],
    y: ["force_N", "force, N"],
    about: "%{y:.3~r} N at %{x:.4~r} kPa",
  },
  {
    title: "Smallest gap",
    x: ["pressure_kPa", "pressure, kPa"],
    y: ["gap_mm", "gap, mm"],
    about: "%{y:.3~r} mm at %{x:.4~r} kPa",
  },
  {
    title: "Cavity volume",
    x: ["volume", "cavity volume / unloaded volume"],
    y: ["pressure_kPa", "pressure, kPa"],
    about: "%{y:.4~r} kPa at %{x:.3~r} times the volume",
  },
];

function stepLine(name, steps, { x, y, about }) {
  const colour = content.analyses[name];
  return {
    type: "scatter",
    mode: "lines+markers",
    connectgaps: true, // not every step need know its force
    name: analysisNames[name],
    x: steps[x[0]],
    y: steps[y[0]],
    hovertemplate: about + "<extra></extra>",
    line: { color: colour, width: 2 },
    marker: { color: colour, size: 4 },
  };
}

function drawStepPlot(element, analyses, plot) {
  const names = Object.keys(analyses).filter((name) => plot.y[0] in analyses[name]);
  register(
    element,
    () => names.map((name) => stepLine(name, analyses[name], plot)),
    () =>
      flatLayout(plot.title, axis(plot.x[1]), axis(plot.y[1]), { showlegend: names.length > 1 }),
  );
}

// A plot of which no analysis knows anything is left out. All places are there before the first is
// drawn, or it would take the width of those to come.
function drawSteps(box, analyses) {
  if (!box) return;
  const known = ({ y: [key] }) => Object.values(analyses).some((steps) => key in steps);
  const plots = stepPlots.filter(known).map((plot) => [document.createElement("div"), plot]);
  for (const [element] of plots) element.className = "plot";
  box.append(...plots.map(([element]) => element));
  for (const [element, plot] of plots) drawStepPlot(element, analyses, plot);
}
