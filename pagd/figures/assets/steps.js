// ---- steps of the analyses of one design ----------------------------------------------------

const analysisNames = { free: "free", held: "tip held" };

// Title, what lies along, what is drawn, the analyses that know it, and how a point is told.
const stepPlots = [
  {
    title: "Blocked force",
    x: ["pressure_kPa", "pressure, kPa"],
    y: ["force_N", "force, N"],
    about: "%{y:.3~r} N at %{x:.4~r} kPa",
  },
  {
    title: "Smallest gap between walls",
    x: ["pressure_kPa", "pressure, kPa"],
    y: ["gap_mm", "gap, mm"],
    about: "%{y:.3~r} mm at %{x:.4~r} kPa",
  },
  {
    title: "Pressure and cavity volume",
    x: ["volume", "volume / volume without pressure"],
    y: ["pressure_kPa", "pressure, kPa"],
    about: "%{y:.4~r} kPa at %{x:.3~r} times the volume",
  },
];

function stepLine(name, steps, { x, y, about }) {
  const colour = content.analyses[name];
  return {
    type: "scatter",
    mode: "lines+markers",
    name: analysisNames[name],
    x: steps[x[0]],
    y: steps[y[0]],
    hovertemplate: about + "<extra></extra>",
    line: { color: colour, width: 2 },
    marker: { color: colour, size: 4 },
  };
}

// A plot of which no analysis knows anything is left out.
function drawSteps(box, analyses) {
  if (!box) return;
  for (const plot of stepPlots) {
    const names = Object.keys(analyses).filter((name) => plot.y[0] in analyses[name]);
    if (!names.length) continue;
    const element = document.createElement("div");
    element.className = "plot";
    box.append(element);
    register(
      element,
      () => names.map((name) => stepLine(name, analyses[name], plot)),
      () =>
        flatLayout(plot.title, axis(plot.x[1]), axis(plot.y[1]), {
          showlegend: names.length > 1,
          legend: { x: 0.02, y: 0.98, bgcolor: "rgba(0,0,0,0)" },
        }),
    );
  }
}
