"use strict";

const content = JSON.parse(document.getElementById("data").textContent);
const dark = window.matchMedia("(prefers-color-scheme: dark)");
const options = { responsive: true, displaylogo: false, displayModeBar: false };
const redraws = new Set();

function colour(name) {
  return getComputedStyle(document.documentElement).getPropertyValue("--" + name).trim();
}

function font() {
  return { family: getComputedStyle(document.body).fontFamily, size: 12, color: colour("ink") };
}

function modeColour(mode) {
  return content.modes[mode] || colour("faint");
}

// A pressure with its unit, to four significant digits.
function kilopascals(pressure) {
  return Number(pressure.toPrecision(4)) + " kPa";
}

const plain = { showlegend: false };

// ---- flat plots -----------------------------------------------------------------------------

function axis(title, more) {
  return {
    title: { text: title, standoff: 6 },
    gridcolor: colour("line"),
    zerolinecolor: colour("faint"),
    zerolinewidth: 1,
    automargin: true,
    ...more,
  };
}

function flatLayout(title, x, y, more) {
  return {
    title: { text: title, x: 0, xref: "paper", font: { size: 14 } },
    font: font(),
    paper_bgcolor: "rgba(0,0,0,0)",
    plot_bgcolor: "rgba(0,0,0,0)",
    margin: { l: 56, r: 12, t: 36, b: 44 },
    hovermode: "closest",
    legend: { orientation: "h", y: 1.02, x: 1, xanchor: "right", yanchor: "bottom" },
    dragmode: false,
    xaxis: x,
    yaxis: y,
    ...more,
  };
}

function register(element, traces, layout) {
  const draw = () => Plotly.react(element, traces(), layout(), options);
  redraws.add(draw);
  draw();
  return draw;
}

// A plot that is not wanted any more.
function forget(element, draw) {
  redraws.delete(draw);
  Plotly.purge(element);
}
