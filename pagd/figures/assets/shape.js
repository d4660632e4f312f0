// ---- turnable shapes ------------------------------------------------------------------------

async function unpack(text, Type) {
  const raw = atob(text);
  const bytes = new Uint8Array(raw.length);
  for (let i = 0; i < raw.length; i++) bytes[i] = raw.charCodeAt(i);
  const inflated = new Blob([bytes]).stream().pipeThrough(new DecompressionStream("deflate"));
  return new Type(await new Response(inflated).arrayBuffer());
}

class Shape {
  static async of(data) {
    const Index = data.index_bits === 16 ? Uint16Array : Uint32Array;
    const shape = new Shape();
    shape.pressure = data.pressure_kPa;
    shape.count = data.vertices;
    shape.step = data.step_mm;
    shape.top = data.top;
    [shape.triangles, shape.edges, shape.rest, shape.change, shape.values] = await Promise.all([
      unpack(data.triangles, Index),
      unpack(data.edges, Index),
      unpack(data.rest, Int16Array),
      unpack(data.change, Int16Array),
      unpack(data.strain, Uint8Array),
    ]);
    shape.sum();
    return shape;
  }

  // Changes of the change become displacements: two running sums over the states.
  sum() {
    const size = 3 * this.count;
    for (let times = 0; times < 2; times++) {
      for (let i = size; i < this.change.length; i++) this.change[i] += this.change[i - size];
    }
    this.positions = new Int16Array(size + this.change.length);
    this.positions.set(this.rest);
    for (let i = 0; i < this.change.length; i++) {
      this.positions[size + i] = this.rest[i % size] + this.change[i];
    }
  }

  corner(which) {
    const result = new Uint32Array(this.triangles.length / 3);
    for (let i = 0; i < result.length; i++) result[i] = this.triangles[3 * i + which];
    return result;
  }

  coordinates(state) {
    return [0, 1, 2].map((axis) => {
      const start = (3 * state + axis) * this.count;
      const steps = this.positions.subarray(start, start + this.count);
      return Float32Array.from(steps, (value) => value * this.step);
    });
  }

  strain(state) {
    const values = this.values.subarray(state * this.count, (state + 1) * this.count);
    return Float32Array.from(values, (value) => (value / 255) * this.top);
  }

  lines(xyz) {
    return xyz.map((along) => {
      const result = new Array((3 * this.edges.length) / 2);
      for (let i = 0, k = 0; i < this.edges.length; i += 2) {
        result[k++] = along[this.edges[i]];
        result[k++] = along[this.edges[i + 1]];
        result[k++] = null;
      }
      return result;
    });
  }

  ranges() {
    return [0, 1, 2].map((axis) => {
      let [low, high] = [Infinity, -Infinity];
      for (let state = 0; state < this.pressure.length; state++) {
        const start = (3 * state + axis) * this.count;
        for (let i = start; i < start + this.count; i++) {
          low = Math.min(low, this.positions[i]);
          high = Math.max(high, this.positions[i]);
        }
      }
      return [low * this.step - 3, high * this.step + 3];
    });
  }
}

// The shape of a design with its slider, in a box of the page; beside it the angles and the course of
// the centre line, where the box has places for them.
class Viewer {
  constructor(box, design, { shape, path }) {
    this.design = design;
    this.data = shape;
    this.path = path;
    this.top = shape.top;
    this.element = box.querySelector(".shape");
    this.slider = box.querySelector("input");
    this.button = box.querySelector("button");
    this.output = box.querySelector("output");
    this.shape = null;
    this.wanted = false;
    this.shown = false;
    this.timer = null;
    const last = this.data.pressure_kPa.length - 1;
    this.slider.max = last;
    this.slider.value = last;
    this.slider.addEventListener("input", () => this.stop() || this.update());
    this.button.addEventListener("click", () => (this.timer ? this.stop() : this.play()));
    this.label();
    this.angles = path && box.querySelector(".angles");
    this.course = path && box.querySelector(".course");
    if (this.angles) this.drawAngles();
    if (this.course) this.drawCourse();
    this.redraw = () =>
      this.shown && Plotly.react(this.element, this.traces(), this.layout(), options);
    redraws.add(this.redraw);
    this.watch();
  }

  // Browsers keep only some WebGL pictures alive: those out of sight are given up. The last entry is
  // how it stands, where there are several.
  watch() {
    const seen = (entries) => (entries.at(-1).isIntersecting ? this.show() : this.hide());
    this.watcher = new IntersectionObserver(seen, { rootMargin: "300px" });
    this.watcher.observe(this.element);
  }

  close() {
    this.watcher.disconnect();
    redraws.delete(this.redraw);
    this.hide();
  }

  get state() {
    return Number(this.slider.value);
  }

  async show() {
    this.wanted = true;
    this.shape = this.shape || (await Shape.of(this.data));
    if (this.shown || !this.wanted) return;
    this.shown = true;
    this.element.replaceChildren();
    Plotly.newPlot(this.element, this.traces(), this.layout(), options);
  }

  hide() {
    this.wanted = false;
    if (!this.shown) return;
    this.stop();
    this.shown = false;
    this.camera = this.element.layout.scene.camera;
    Plotly.purge(this.element);
  }

  traces() {
    const shape = this.shape;
    const xyz = shape.coordinates(this.state);
    const [x, y, z] = xyz;
    const [a, b, c] = shape.lines(xyz);
    const [ra, rb, rc] = shape.lines(shape.coordinates(0));
    const steps = content.strain.colours.length - 1;
    return [
      {
        type: "mesh3d",
        x, y, z,
        i: shape.corner(0),
        j: shape.corner(1),
        k: shape.corner(2),
        intensity: shape.strain(this.state),
        cmin: 0,
        cmax: this.top,
        colorscale: content.strain.colours.map((value, i) => [i / steps, value]),
        colorbar: this.bar(),
        lighting: { ambient: 0.55, diffuse: 0.6, specular: 0.08, roughness: 0.8, fresnel: 0.1 },
        lightposition: { x: -300, y: -800, z: 1500 },
        hovertemplate: "strain %{intensity:.3f}<br>x %{x:.1f}, y %{y:.1f}, z %{z:.1f} mm<extra></extra>",
      },
      {
        type: "scatter3d", mode: "lines", x: a, y: b, z: c,
        line: { color: "rgba(40,30,30,0.55)", width: 1.5 },
        hoverinfo: "skip", showlegend: false,
      },
      {
        type: "scatter3d", mode: "lines", x: ra, y: rb, z: rc,
        line: { color: colour("faint"), width: 1 },
        opacity: 0.45, hoverinfo: "skip", showlegend: false,
      },
    ];
  }

  get narrow() {
    return this.element.clientWidth < 560;
  }

  bar() {
    const title = { text: content.strain.label, side: this.narrow ? "bottom" : "right" };
    const place = this.narrow ? { orientation: "h", y: -0.02, yanchor: "top", len: 0.9 } : { len: 0.8 };
    return { title, thickness: 12, outlinewidth: 0, ...place };
  }

  // A narrow picture shows less to the sides: the eye steps back.
  firstCamera() {
    const { clientWidth: width, clientHeight: height } = this.element;
    const back = Math.max(1, 1.3 / ((width - (this.narrow ? 0 : 100)) / height));
    return {
      eye: { x: -0.75 * back, y: -1.75 * back, z: 0.75 * back },
      center: { x: 0, y: 0, z: -0.08 },
      projection: { type: "perspective" },
    };
  }

  layout() {
    const ranges = this.shape.ranges();
    const sizes = ranges.map(([low, high]) => high - low);
    const largest = Math.max(...sizes);
    const side = (name, i) => ({
      title: { text: name + ", mm" },
      range: ranges[i],
      nticks: Math.max(3, Math.round((8 * sizes[i]) / largest)),
      gridcolor: colour("line"),
      zerolinecolor: colour("line"),
      showspikes: false,
      backgroundcolor: "rgba(0,0,0,0)",
    });
    // The box's diagonal fills the picture, whatever its shape.
    const ratio = sizes.map((size) => (2.05 * size) / Math.hypot(...sizes));
    return {
      font: font(),
      paper_bgcolor: "rgba(0,0,0,0)",
      margin: { l: 0, r: 0, t: 0, b: this.narrow ? 60 : 0 },
      uirevision: "kept",
      scene: {
        xaxis: side("x", 0),
        yaxis: side("y", 1),
        zaxis: side("z", 2),
        aspectmode: "manual",
        aspectratio: { x: ratio[0], y: ratio[1], z: ratio[2] },
        camera: this.camera || this.firstCamera(),
      },
    };
  }

  label() {
    this.output.textContent = kilopascals(this.data.pressure_kPa[this.state]);
  }

  update() {
    this.label();
    if (this.angles) Plotly.relayout(this.angles, { shapes: [this.mark()] });
    if (this.course) Plotly.restyle(this.course, this.now(), [1]);
    if (!this.shown) return;
    const xyz = this.shape.coordinates(this.state);
    const lines = this.shape.lines(xyz);
    Plotly.restyle(
      this.element,
      {
        x: [xyz[0], lines[0]],
        y: [xyz[1], lines[1]],
        z: [xyz[2], lines[2]],
        intensity: [this.shape.strain(this.state), undefined],
      },
      [0, 1],
    );
  }

  play() {
    this.button.textContent = "⏸";
    const last = Number(this.slider.max);
    if (this.state === last) this.slider.value = 0;
    this.timer = setInterval(() => {
      if (this.state === last) return this.stop();
      this.slider.value = this.state + 1;
      this.update();
    }, 450);
    this.update();
  }

  stop() {
    clearInterval(this.timer);
    this.timer = null;
    this.button.textContent = "▶";
  }

  mark() {
    const pressure = this.data.pressure_kPa[this.state];
    return {
      type: "line", xref: "x", yref: "paper", x0: pressure, x1: pressure, y0: 0, y1: 1,
      line: { color: colour("faint"), width: 1.5, dash: "dot" },
    };
  }

  drawAngles() {
    const path = this.path;
    const line = (name, values, dash) => ({
      ...curve(this.design, path.pressure_kPa, values, {
        name, hovertemplate: name + " %{y:.1f}° at %{x:.4~r} kPa<extra></extra>",
      }),
      line: { color: this.design.colour, width: 2, dash },
    });
    register(
      this.angles,
      () => [line("bending", path.bending_deg, "solid"), line("twist", path.twist_deg, "dash")],
      () =>
        flatLayout("Angles", axis("pressure, kPa"), axis("degrees"), { shapes: [this.mark()] }),
    );
  }

  // The centre line at the pressure of the slider.
  now() {
    const [x, , z] = this.path.lines[Math.min(this.state, this.path.lines.length - 1)];
    return { x: [x], y: [z] };
  }

  // The centre lines at all pressures from the side, and the way of the tip.
  drawCourse() {
    const lines = this.path.lines;
    const all = (axis) => lines.flatMap((line) => [...line[axis], null]);
    const tip = (axis) => lines.map((line) => line[axis][line[axis].length - 1]);
    const text = this.path.pressure_kPa.map(kilopascals);
    const quiet = { type: "scatter", mode: "lines", hoverinfo: "skip", showlegend: false };
    register(
      this.course,
      () => [
        { ...quiet, x: all(0), y: all(2), line: { color: colour("faint"), width: 1 } },
        { ...quiet, ...flat(this.now()), line: { color: this.design.colour, width: 4 } },
        {
          ...curve(this.design, tip(0), tip(2), { showlegend: false, text }),
          hovertemplate: "tip at %{text}<br>x %{x:.1f}, z %{y:.1f} mm<extra></extra>",
        },
      ],
      () => {
        const fixed = { automargin: false };
        const equal = { ...fixed, scaleanchor: "x", scaleratio: 1 };
        return flatLayout("Trajectory, side", axis("x, mm", fixed), axis("z, mm", equal));
      },
    );
  }
}

function flat({ x: [x], y: [y] }) {
  return { x, y };
}
