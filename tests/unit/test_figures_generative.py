"""Pictures of the generative half: what is in them is checked, and that odd data draw too."""

import json
from pathlib import Path
from xml.etree import ElementTree

import numpy as np
import pandas as pd
import pytest
from matplotlib.colors import to_rgb
from matplotlib.patches import Ellipse
from matplotlib.path import Path as Path2D
from matplotlib.text import Text
from PIL import Image

from pagd.dataset.frame import INDEPENDENT, completed, write_frame
from pagd.design import PARAMETERS
from pagd.errors import Status
from pagd.figures.generative import captions as texts
from pagd.figures.generative.bending_twist import bending_twist_figure
from pagd.figures.generative.comparison import comparison_figure
from pagd.figures.generative.distributions import distance_in_deviations, distributions_figure
from pagd.figures.generative.draw import CAPTIONS_NAME, PICTURES, draw_generative
from pagd.figures.generative.embedding import SHOWN, embedding_figure
from pagd.figures.generative.facts import facts_of
from pagd.figures.generative.feasibility import feasibility_figure
from pagd.figures.generative.force_bending import force_bending_figure
from pagd.figures.generative.hull import hull_figure
from pagd.figures.generative.labels import label_points
from pagd.figures.generative.mixture import mixture_figure
from pagd.figures.generative.modes import draw_modes
from pagd.figures.generative.novelty_performance import novelty_performance_figure
from pagd.figures.generative.plane import Gaussian, draw_gaussian
from pagd.figures.generative.projection import (
    gaussians_of,
    load_generated_plane,
    load_plane,
    principal_axes,
)
from pagd.figures.generative.results import GenerativePaths, NothingToDraw
from pagd.figures.generative.screened import (
    screened_beside_full_figure,
    screened_figure,
    screened_novelty_figure,
)
from pagd.figures.style import (
    FAINT,
    INK,
    MODE_LOOKS,
    STATUS_COLOURS,
    mode_look,
    new_figure,
    set_resolution,
)
from pagd.record import Record, versions, write_record
from pagd.tables import DESIGNS, GENERATED, PERFORMANCE, Column, write_rows, write_table

ALPHA = {"bending": (0.0, 0.0), "twisting": (1.0, 1.0), "mixed": (0.4, 0.6)}
CENTRES = {"bending": (-10.0, 0.0), "twisting": (10.0, 0.0), "mixed": (0.0, 0.0)}


# A small, realistic run -----------------------------------------------------------------------


def designs(modes, origins="random", prefix="d", seed=1):
    """Designs from the sampling box, a mode each, with places around the centre of their mode."""
    rng = np.random.default_rng(seed)
    box = {
        symbol: rng.uniform(parameter.low, parameter.high, len(modes)).round(2)
        for symbol, parameter in PARAMETERS.items()
    }
    frame = pd.DataFrame(box)
    frame["N"] = rng.integers(6, 15, len(modes))
    frame["alpha"] = [rng.uniform(*ALPHA[mode]) for mode in modes]
    frame.loc[frame["alpha"] == 0.0, "theta"] = 0.0
    ids = [f"{prefix}{i:04d}" for i in range(1, len(modes) + 1)]
    frame = completed(frame[list(INDEPENDENT)], ids, origins)
    places = np.array([CENTRES[mode] for mode in modes]) + rng.normal(0.0, 2.0, (len(modes), 2))
    return frame.assign(z1=places[:, 0], z2=places[:, 1])


def training_designs(count=120):
    modes = ["bending", "twisting"] * (count // 2)
    origins = ["random"] * (count - 20) + ["jitter"] * 10 + ["interpolation"] * 7
    return designs(modes, [*origins, "published", "published", "table2"])


def generated_designs(modes=("bending", "twisting", "mixed") * 20):
    found = designs(list(modes), "generated", "g", seed=2)
    return found.assign(novelty=0.5, novelty_plane=0.01, component=0)


MIXTURE = {
    "components": 3,
    "weights": [0.4, 0.3, 0.3],
    "means": [[-10.0, 0.0], [10.0, 0.0], [0.0, 0.0]],
    "covariances": [[[4.0, 0.0], [0.0, 4.0]]] * 3,
    "bridge": 2,
    "bic": {"1": 900.0, "2": 700.0, "3": 710.0},
}


def simulated(name, origin, mode, status="ok", bending=90.0, **values):
    failed_early = bending is None
    return {
        "design_id": name,
        "name": name,
        "origin": origin,
        "mode": mode,
        "measured_mode": None if failed_early else mode,
        "status": status,
        "reason": None if status == "ok" else "why",
        "fidelity": "full",
        "pressure_kPa": None if failed_early else 50.0,
        "bending_deg": bending,
        "twist_deg": None if failed_early else 10.0,
        "work_density_kJ_m3": None if failed_early else 2.0,
        "blocked_force_N": None if failed_early else 0.5,
        "blocked_force_variant": None if failed_early else "edge",
        "novelty": 1.0,
    } | values


SIMULATED = [
    simulated("bending", "table2", "bending", twist_deg=0.0, novelty=0.0),
    simulated("twisting", "table2", "twisting", twist_deg=-50.0, novelty=0.2),
    simulated("gibbon_multi", "published", "bending", bending=140.0, novelty=0.7),
    simulated("g0001", "generated", "bending", bending=30.0, novelty=1.2),
    simulated("g0002", "generated", "mixed", bending=200.0, measured_mode="twisting"),
    simulated("g0003", "generated", "mixed", "not_converged", bending=20.0),
    simulated("g0004", "generated", "twisting", "mesh_failed", bending=None),
    simulated("g0005", "generated", "twisting", novelty=None),
]


def screened(kind, modes, **values):
    """Designs by a chamber each, of rising bending."""
    return [
        simulated(f"{kind}{i:04d}", "generated", mode, bending=10.0 * i, fidelity="cells", **values)
        for i, mode in enumerate(modes, 1)
    ]


def performance(rows=SIMULATED):
    return pd.DataFrame(rows, columns=[column.name for column in PERFORMANCE])


def comparison(values):
    """Rows of all modes of one metric in one space: generator to (value, low, high)."""
    return pd.DataFrame(
        [
            {"generator": name, "space": "encoded", "mode": "all", "metric": "coverage"}
            | {"better": "higher", "value": value, "low": low, "high": high}
            for name, (value, low, high) in values.items()
        ]
    )


AREAS = pd.DataFrame({"training": [1.0, 1.0, 2.0, 0.0], "generated": [2.0, 2.0, 4.0, 1.0]})


def square(kind, size):
    """The corners of a square in order, and its middle."""
    corners = size * np.array([[0, 0], [1, 0], [1, 1], [0, 1], [0.5, 0.5]])
    frame = pd.DataFrame(corners, columns=["z1", "z2"])
    return frame.assign(set=kind, corner=[0.0, 1.0, 2.0, 3.0, None])


HULLS = pd.concat([square("training", 1.0), square("generated", 2.0)], ignore_index=True)


def leave_record(folder, **sections):
    record = Record(
        stage="embedding",
        design_id="all",
        status=Status.ok,
        reason=None,
        figures={"trustworthiness": 0.91, "redrawn_by_generator": 1537},
        configuration=sections,
        versions=versions(1),
        timings_s={"wall": 1.0, "cpu": 1.0},
        peak_memory_MB=1.0,
    )
    write_record(record, folder)


def leave_results(folder, method="tsne", dimensions=2):
    """Leave what the stages of the generative half leave, in the places of a run."""
    training, generated = training_designs(), generated_designs()
    write_frame(folder / "dataset" / "designs.parquet", training, DESIGNS)
    leave_points(folder / "embedding", training, dimensions)
    leave_record(folder / "embedding", embedding={"method": method, "perplexity": 30.0, "seed": 7})
    write_frame(folder / "generated" / "designs.parquet", generated, GENERATED)
    (folder / "generated" / "mixture.json").write_text(json.dumps(MIXTURE), encoding="utf-8")
    leave_record(folder / "generated", generator={"method": "gmm", "seed": 8})
    rows = comparison({"gmm": (0.6, None, None), "random": (0.4, 0.3, 0.5)})
    leave_table(folder / "diversity" / "comparison.parquet", rows)
    leave_table(folder / "diversity" / "hull.parquet", AREAS)
    leave_table(folder / "diversity" / "hull_points.parquet", HULLS)
    write_rows(folder / "summary" / "performance.parquet", PERFORMANCE, SIMULATED)
    for name, kind, count in (("generated", "g", 20), ("training", "d", 10)):
        rows = screened(kind, ["bending", "twisting", "mixed"] * count, novelty=None)
        write_rows(folder / "screening" / name / "performance.parquet", PERFORMANCE, rows)
    return folder


def leave_points(folder, training, dimensions):
    rng = np.random.default_rng(3)
    places = training[["z1", "z2"]].to_numpy()
    places = np.hstack([places, rng.normal(size=(len(places), max(0, dimensions - 2)))])
    columns = {f"z{i + 1}": places[:, i] for i in range(dimensions)}
    declared = [Column("design_id", "string", "", ""), *(real(name) for name in columns)]
    write_table(
        folder / "points.parquet", declared, {"design_id": training["design_id"], **columns}
    )


def real(name):
    return Column(name, "double", "1", "")


def leave_table(path, frame):
    kinds = [real(n) if frame[n].dtype.kind == "f" else Column(n, "string", "", "") for n in frame]
    write_table(path, kinds, {name: frame[name] for name in frame})


@pytest.fixture(scope="module", autouse=True)
def usual_resolution():
    """The resolution holds for all pictures made later: those of other tests must not be small."""
    yield
    set_resolution(150)


@pytest.fixture(scope="module")
def results(tmp_path_factory):
    return leave_results(tmp_path_factory.mktemp("results"))


# Reading pictures -----------------------------------------------------------------------------


def points_in(axes):
    """Number of points of all groups drawn as points."""
    return sum(len(collection.get_offsets()) for collection in axes.collections)


def legend_of(axes_or_figure):
    holder = axes_or_figure
    legend = holder.get_legend() if hasattr(holder, "get_legend") else holder.legends[0]
    return [text.get_text() for text in legend.get_texts()]


def words_in(axes):
    return [text.get_text() for text in axes.texts]


def heading(axes):
    return axes.get_title(loc="left")


# Colours --------------------------------------------------------------------------------------

# Machado, Oliveira and Fernandes 2009, Table 1, severity 1.0.
DEFICIENCIES = {
    "protanopia": [
        [0.152286, 1.052583, -0.204868],
        [0.114503, 0.786281, 0.099216],
        [-0.003882, -0.048116, 1.051998],
    ],
    "deuteranopia": [
        [0.367322, 0.860646, -0.227968],
        [0.280085, 0.672501, 0.047413],
        [-0.011820, 0.042940, 0.968881],
    ],
    "tritanopia": [
        [1.255528, -0.076749, -0.178779],
        [-0.078411, 0.930809, 0.147602],
        [0.004733, 0.691367, 0.303900],
    ],
}


def lab(linear):
    """CIE L*a*b* of linear sRGB (IEC 61966-2-1), white D65."""
    to_xyz = [[0.4124, 0.3576, 0.1805], [0.2126, 0.7152, 0.0722], [0.0193, 0.1192, 0.9505]]
    x, y, z = np.cbrt(np.clip(to_xyz @ linear, 0.0, None) / [0.9505, 1.0, 1.089])
    return np.array([116 * y - 16, 500 * (x - y), 200 * (y - z)])


def linear_rgb(colour):
    values = np.array(to_rgb(colour))
    return np.where(values <= 0.04045, values / 12.92, ((values + 0.055) / 1.055) ** 2.4)


@pytest.mark.parametrize("sight", DEFICIENCIES)
def test_modes_are_told_apart_by_every_eye(sight):
    seen = [lab(DEFICIENCIES[sight] @ linear_rgb(look.colour)) for look in MODE_LOOKS.values()]
    for i in range(3):
        # A difference of 2 is just seen side by side; 20 is another colour.
        assert np.linalg.norm(seen[i] - seen[i - 1]) > 20.0


def test_modes_are_told_apart_without_colour():
    assert len({look.marker for look in MODE_LOOKS.values()}) == len(MODE_LOOKS)
    assert mode_look("unheard of").marker not in {look.marker for look in MODE_LOOKS.values()}


def test_every_status_has_a_colour():
    assert set(STATUS_COLOURS) == {status.value for status in Status}
    assert len(set(STATUS_COLOURS.values())) == len(STATUS_COLOURS)


# Embedding ------------------------------------------------------------------------------------


def test_embedding_shows_all_designs_by_category_and_by_origin():
    left, right = embedding_figure(training_designs(), "tsne").axes
    assert points_in(left) == points_in(right) == 120
    assert legend_of(left) == ["bending (60)", "twisting (60)"]
    assert set(legend_of(right)) == {
        "random (100)",
        "jitter (10)",
        "interpolation (7)",
        "published (2)",
        "Table 2 (1)",
    }
    assert left.get_xlabel() == "t-SNE 1"
    assert len(left.get_xticks()) == 0


def test_embedding_of_many_shows_a_seeded_choice():
    many = pd.concat([training_designs()] * 10, ignore_index=True)
    offsets = [
        embedding_figure(many, seed=seed).axes[0].collections[0].get_offsets().tolist()
        for seed in (1, 1, 2)
    ]
    assert points_in(embedding_figure(many).axes[0]) == SHOWN
    assert offsets[0] == offsets[1] != offsets[2]


def test_embedding_of_a_single_design():
    left, right = embedding_figure(training_designs().head(1)).axes
    assert points_in(left) == points_in(right) == 1


# Mixture --------------------------------------------------------------------------------------


def gaussians(count=3):
    return [
        Gaussian(np.array([10.0 * k, 0.0]), np.diag([4.0, 1.0]), 0.3, k == 2) for k in range(count)
    ]


def test_mixture_shows_modes_ellipses_and_the_choice_of_their_number():
    generated = generated_designs()
    bic = {1: 900.0, 2: 700.0, 3: 710.0}
    figure = mixture_figure(training_designs(), generated, gaussians(), bic, 3, "tsne")
    plane, curve, shares = figure.axes
    ellipses = [patch for patch in plane.patches if isinstance(patch, Ellipse)]
    assert points_in(plane) == 120 + 60
    assert legend_of(plane)[1:] == ["bending (20)", "twisting (20)", "mixed (20)"]
    assert len(ellipses) == 6
    assert sum(ellipse.get_linestyle() != "-" for ellipse in ellipses) == 2
    assert words_in(plane) == ["Gaussian, 30%", "Gaussian, 30%", "bridging Gaussian, 30%"]
    assert legend_of(curve) == ["least: K = 2", "used: K = 2 + bridge"]
    assert curve.lines[-1].get_xydata().tolist() == [[2.0, 0.7]]
    assert sum(bar.get_height() for bar in shares.patches) == 20
    assert "33 %" in heading(shares)


@pytest.mark.parametrize(
    ("count", "components", "expected"),
    [
        (2, 3, ["least: K = 2", "used: K = 3"]),
        (3, 1, ["least: K = 2"]),
        (0, None, ["least: K = 2"]),
    ],
)
def test_used_number_of_gaussians_is_that_of_em(count, components, expected):
    bic = {1: 900.0, 2: 700.0, 3: 710.0}
    found = mixture_figure(
        training_designs(), generated_designs(), gaussians(count), bic, components
    )
    assert legend_of(found.axes[1]) == expected


def test_bins_of_alpha_treat_both_modes_alike_and_cut_no_fraction():
    generated = generated_designs(["mixed"] * 9)
    shares = mixture_figure(training_designs(), generated).axes[2]
    edges = np.array([bar.get_x() for bar in shares.patches])
    width = shares.patches[0].get_width()
    fractions = np.array([part / whole for whole in range(4, 17) for part in range(1, whole)])
    np.testing.assert_allclose(edges + edges[::-1] + width, 1.0)
    assert len(edges) == 9
    assert np.abs(fractions[:, None] - [*edges, edges[-1] + width]).min() > 0.002
    assert edges[0] < fractions.min()
    assert fractions.max() < edges[-1] + width


def test_mixture_without_gaussians_and_without_mixed_designs():
    generated = generated_designs(["bending"] * 5)
    plane, curve, shares = mixture_figure(training_designs(), generated).axes
    assert not [patch for patch in plane.patches if isinstance(patch, Ellipse)]
    assert words_in(curve) == ["this generator has no Gaussians to count"]
    assert words_in(shares) == ["no mixed design among 5"]


def test_ellipses_lie_at_their_standard_deviations():
    covariance = np.array([[5.0, 2.0], [2.0, 3.0]])
    axes = new_figure(3.0, 3.0).add_subplot()
    draw_gaussian(axes, Gaussian(np.array([1.0, 2.0]), covariance, 1.0, False), (1.0, 2.0))
    for deviation, ellipse in zip((1.0, 2.0), axes.patches, strict=True):
        around = ellipse.get_patch_transform().transform(ellipse.get_path().vertices[:-1:3])
        away = around - [1.0, 2.0]
        squares = np.einsum("ni,ij,nj->n", away, np.linalg.inv(covariance), away)
        np.testing.assert_allclose(np.sqrt(squares), deviation, rtol=1e-6)


def test_gaussians_of_another_space_are_not_drawn(results):
    plane = load_plane(GenerativePaths.under(results))
    assert [gaussian.bridges for gaussian in gaussians_of(MIXTURE, plane)] == [False, False, True]
    full = MIXTURE | {"means": np.zeros((3, 17)).tolist()}
    assert gaussians_of(full, plane) == []
    assert gaussians_of(MIXTURE | {"weights": None}, plane) == []


def test_principal_axes_are_those_of_the_greatest_spread():
    rng = np.random.default_rng(1)
    points = rng.normal(size=(500, 3)) * [1.0, 9.0, 4.0]
    np.testing.assert_allclose(np.abs(principal_axes(points)), [[0, 0], [1, 0], [0, 1]], atol=0.05)
    np.testing.assert_allclose(principal_axes(-points), principal_axes(points), atol=1e-12)


def test_without_a_reduction_the_plane_is_that_of_principal_components(tmp_path):
    """The projection of training designs must be the same by their points and by their encoding."""
    results = leave_results(tmp_path, "none")
    paths = GenerativePaths.under(results)
    plane_of_two = load_plane(paths)
    encoded = encoded_points(paths)
    leave_encoded(paths.embedding, plane_of_two.training, encoded)
    plane = load_plane(paths)
    training = plane.training.assign(z1=np.nan, z2=np.nan)
    write_frame(paths.generated / "designs.parquet", with_generated_columns(training), GENERATED)
    again = load_generated_plane(paths, plane)
    np.testing.assert_allclose(again[["z1", "z2"]], plane.training[["z1", "z2"]], atol=1e-9)
    assert plane.training["z1"].var() > plane.training["z2"].var() > 1.0


def encoded_points(paths):
    from pagd.encoding import Encoder

    training = load_plane(paths).training
    return Encoder().fit(training).transform(training)


def leave_encoded(folder, training, encoded):
    columns = {f"z{i + 1}": encoded[:, i] for i in range(encoded.shape[1])}
    declared = [Column("design_id", "string", "", ""), *(real(name) for name in columns)]
    write_table(
        folder / "points.parquet", declared, {"design_id": training["design_id"], **columns}
    )


def with_generated_columns(frame):
    return frame.assign(novelty=0.0, novelty_plane=None, component=None)


# Hulls ----------------------------------------------------------------------------------------


def test_hulls_are_drawn_through_their_corners_and_compared():
    plane, areas = hull_figure(np.zeros((7, 2)), HULLS, AREAS).axes
    assert legend_of(plane) == ["all training (7)", "training (5)", "generated (5)"]
    np.testing.assert_array_equal(
        plane.lines[1].get_xydata(), [[0, 0], [2, 0], [2, 2], [0, 2], [0, 0]]
    )
    assert heading(areas) == "areas of 4 draws\ngenerated / training: 2.00 (95 %: 2.00 to 2.00)"
    assert sum(bar.get_height() for bar in areas.patches) == 8


def test_hulls_without_area():
    flat = HULLS.assign(z2=0.0, corner=np.nan)
    plane, areas = hull_figure(np.zeros((1, 2)), flat, AREAS * 0.0).axes
    assert points_in(plane) == 1 + 10
    assert "no area" in heading(areas)


# Comparison -----------------------------------------------------------------------------------


def test_comparison_has_a_dot_a_generator_and_a_line_for_the_training_designs():
    rows = comparison(
        {"gmm": (0.6, 0.5, 0.7), "kde": (0.5, None, None), "training": (0.9, None, None)}
    )
    figure = comparison_figure(rows)
    (axes,) = figure.axes
    dots = axes.collections[-1].get_offsets()
    np.testing.assert_array_equal(dots, [[0.6, 0], [0.5, 1]])
    assert [label.get_text() for label in axes.get_yticklabels()] == ["gmm", "kde"]
    assert axes.lines[0].get_xdata() == [0.9, 0.9]
    assert legend_of(figure) == ["gmm: the one used", "training designs"]
    assert words_in(axes) == ["all parameters  more is better →"]
    ends = [segment[:, 0].tolist() for segment in axes.collections[0].get_segments()]
    assert ends == [[0.5, 0.7], [0.5, 0.5]]


def test_comparison_leaves_out_single_modes_and_what_is_not_defined():
    rows = comparison({"gmm": (0.6, None, None)})
    others = [rows.assign(mode="mixed"), rows.assign(metric="dpp", value=None)]
    assert len(comparison_figure(pd.concat([rows, *others])).axes) == 1
    with pytest.raises(NothingToDraw):
        comparison_figure(rows.assign(value=None))


# Performance ----------------------------------------------------------------------------------


def test_novelty_is_shown_against_three_measures():
    figure = novelty_performance_figure(performance())
    assert len(figure.axes) == 3
    for axes in figure.axes:
        # Two of the eight have no bending, or no novelty.
        assert points_in(axes) == 6
        assert set(words_in(axes)) == {"Table 2: bending", "Table 2: twisting", "gibbon_multi"}
    twist = [y for c in figure.axes[1].collections for y in c.get_offsets()[:, 1]]
    assert max(twist) == 50.0
    assert min(twist) == 0.0
    assert legend_of(figure)[:3] == ["bending (3)", "twisting (1)", "mixed (2)"]


def test_rank_correlation_is_that_of_the_ranks():
    rows = [
        simulated(f"g{i}", "generated", "mixed", novelty=float(i), bending=float(i**3))
        for i in range(1, 6)
    ]
    bending, twist, _ = novelty_performance_figure(performance(rows)).axes
    assert heading(bending) == "bending (rank correlation 1.00)"
    assert heading(twist) == "|twist|"  # all the same: no correlation


def test_bending_against_twist_names_known_designs_and_crosses_failed_ones():
    figure = bending_twist_figure(performance())
    (axes,) = figure.axes
    assert points_in(axes) == 7
    assert set(words_in(axes)) == {"Table 2: bending", "Table 2: twisting", "gibbon_multi"}
    assert heading(axes) == "bending and twist of 7 simulated designs (1 more gave no result)"
    # Only a cross is drawn in two strokes.
    crosses = [c for c in axes.collections if (c.get_paths()[0].codes == Path2D.MOVETO).sum() == 2]
    assert np.concatenate([c.get_offsets() for c in crosses]).tolist() == [[20.0, 10.0]]
    assert legend_of(figure)[3:] == ["Table 2 or published", "failed: as far as it came"]


def test_screened_designs_are_shown_with_both_fronts():
    new = screened("g", ["bending", "mixed"], blocked_force_N=2.0)
    old = screened("d", ["bending", "bending", "twisting"])
    figure = screened_figure(performance(new), performance(old))
    assert [heading(axes) for axes in figure.axes] == [
        "twist and bending",
        "blocked force and bending",
        "blocked force and twist",
    ]
    of_force = figure.axes[1]
    assert points_in(of_force) == 5
    stairs = {line.get_color(): line.get_xydata().tolist() for line in of_force.get_lines()}
    assert stairs[INK] == [[0, 2], [20, 2], [20, 0]]
    assert stairs[FAINT] == [[0, 0.5], [30, 0.5], [30, 0]]
    assert legend_of(figure)[:2] == ["bending (1)", "mixed (1)"]


def test_doubted_forces_are_not_shown_but_beside_full_analyses():
    cells = performance(screened("g", ["bending"] * 3, novelty=1.0, blocked_force_N=2.0))
    cells["doubt"], cells["fidelity"] = [None, "Far.", None], "cells"
    old = performance(screened("d", ["bending"]))
    twist, force, _ = screened_figure(cells, old).axes
    assert (points_in(twist), points_in(force)) == (4, 3)
    held = {"blocked_force_N": 1.0, "blocked_force_pressure_kPa": 50.0}
    full = performance([simulated("g0002", "generated", "bending", bending=12.0, **held)])
    cells["blocked_force_pressure_kPa"] = 50.0
    novelty = screened_novelty_figure(cells, full).axes[2]
    # Two that are trusted, the full analysis, and the line to the doubted one.
    assert points_in(novelty) == 2 + 1 + 1
    line = next(c for c in novelty.collections if hasattr(c, "get_segments"))
    assert sorted(line.get_segments()[0][:, 1]) == [1.0, 2.0]


def test_full_analyses_are_set_beside_cells_at_the_same_pressure():
    cells = performance(screened("g", ["bending"] * 3, novelty=1.0))
    full = performance(
        [
            simulated("g0001", "generated", "bending", bending=12.0),
            simulated("g0002", "generated", "bending", bending=20.0, pressure_kPa=40.0),
            simulated("g0003", "generated", "bending", "not_converged", bending=30.0),
            simulated("g0004", "generated", "bending", bending=30.0),
        ]
    )
    figure = screened_beside_full_figure(cells, full)
    assert points_in(figure.axes[0]) == 1
    assert heading(figure.axes[0]) == "bending (median error 16.7 %)"
    novelty = screened_novelty_figure(cells, full).axes[0]
    # The line between both results of a design counts too.
    assert points_in(novelty) == 3 + 1 + 1
    assert points_in(screened_novelty_figure(cells, None).axes[0]) == 3
    with pytest.raises(NothingToDraw, match="simulated as a whole"):
        screened_beside_full_figure(cells, full.iloc[1:])


def test_only_the_wanted_pictures_are_drawn(tmp_path):
    results = leave_results(tmp_path / "results")
    assert draw_generative(results, tmp_path / "out", 50, names=("screened",)) == {}
    assert {path.name for path in (tmp_path / "out").iterdir()} == {"screened.png", CAPTIONS_NAME}


def test_force_against_bending_leaves_out_what_was_not_held():
    free = simulated("g0006", "generated", "mixed", blocked_force_N=None)
    strong = simulated("g0007", "generated", "mixed", bending=10.0, blocked_force_N=3.5)
    figure = force_bending_figure(performance([*SIMULATED, free, strong]))
    (axes,) = figure.axes
    assert points_in(axes) == 8
    assert heading(axes) == "blocked force and bending of 8 simulated designs"
    points = [tuple(point) for c in axes.collections for point in c.get_offsets()]
    assert (10.0, 3.5) in points
    assert (axes.get_xlabel(), axes.get_ylabel()) == (
        "bending of the free tip, degrees",
        "blocked force, N",
    )


def test_force_of_a_held_tip_that_ended_early_is_crossed():
    held = simulated("g0001", "generated", "mixed", blocked_force_status="ok")
    buckled = simulated("g0002", "generated", "mixed", bending=10.0, blocked_force_N=3.5)
    both = performance([held, buckled | {"blocked_force_status": "buckled"}])
    (axes,) = force_bending_figure(both).axes
    crosses = [c for c in axes.collections if (c.get_paths()[0].codes == Path2D.MOVETO).sum() == 2]
    assert np.concatenate([c.get_offsets() for c in crosses]).tolist() == [[10.0, 3.5]]


OF_PERFORMANCE = (bending_twist_figure, force_bending_figure, novelty_performance_figure)


@pytest.mark.parametrize("figure", OF_PERFORMANCE)
def test_performance_without_any_number_is_no_picture(figure):
    failed = performance([simulated("g", "generated", "mixed", "mesh_failed", bending=None)])
    with pytest.raises(NothingToDraw):
        figure(failed)


@pytest.mark.parametrize("figure", OF_PERFORMANCE)
def test_performance_of_a_single_design(figure):
    for axes in figure(performance(SIMULATED[:1])).axes:
        assert points_in(axes) == 1


def test_labels_lie_apart():
    axes = new_figure(4.0, 4.0).add_subplot()
    points = np.array([[0.5, 0.5], [0.51, 0.5], [0.5, 0.51], [0.51, 0.51]])
    label_points(axes, points, ["first one", "second one", "third one", "fourth one"], points)
    axes.get_figure().draw_without_rendering()
    # Without the lines that lead to the points.
    boxes = [Text.get_window_extent(text) for text in axes.texts]
    assert not any(boxes[i].overlaps(boxes[j]) for i in range(4) for j in range(i))


# Feasibility ----------------------------------------------------------------------------------


def test_feasibility_has_shares_that_add_up_and_counts():
    by_mode, by_origin, matrix = feasibility_figure(performance()).axes
    assert [t.get_text() for t in by_mode.get_yticklabels()] == [
        "bending\n(3)",
        "twisting\n(3)",
        "mixed\n(2)",
    ]
    assert sum(bar.get_width() for bar in by_mode.patches) == pytest.approx(3.0)
    assert sum(int(text) for text in words_in(by_mode) if text) == len(SIMULATED)
    assert sum(int(text) for text in words_in(by_origin) if text) == len(SIMULATED)
    columns = [label.get_text() for label in matrix.get_xticklabels()]
    assert columns == ["bending", "twisting", "mixed", "not\nmeasured"]
    counts = np.array([int(text) for text in words_in(matrix)]).reshape(3, 4)
    np.testing.assert_array_equal(counts, [[3, 0, 0, 0], [0, 2, 0, 1], [0, 1, 1, 0]])


def test_feasibility_when_everything_failed():
    failed = performance([simulated("g", "generated", "mixed", "mesh_failed", bending=None)])
    by_mode, _, matrix = feasibility_figure(failed).axes
    assert words_in(by_mode) == ["1"]
    assert [label.get_text() for label in matrix.get_xticklabels()] == ["mixed", "not\nmeasured"]


# Distributions --------------------------------------------------------------------------------


def test_distance_of_distributions_is_in_standard_deviations():
    sample = np.random.default_rng(1).normal(5.0, 3.0, 200)
    assert distance_in_deviations(sample, sample) == 0.0
    assert distance_in_deviations(sample, sample + 2.0 * sample.std()) == pytest.approx(2.0)
    assert distance_in_deviations(sample, np.array([])) is None
    assert distance_in_deviations(np.ones(3), np.ones(3)) is None


def test_distributions_show_every_parameter_with_all_designs():
    figure = distributions_figure(training_designs(), generated_designs())
    panels, legend = figure.axes[:-1], figure.axes[-1]
    assert len(panels) == 11
    assert legend_of(legend)[0] == "training (120)"
    for axes in panels:
        *modes, outline = axes.patches
        assert sum(outline.get_data().values) == pytest.approx(1.0)
        top = modes[-1].get_data()
        assert sum(top.values) == pytest.approx(1.0)
        assert words_in(axes)[0].startswith("distance")


def test_slant_is_compared_among_slanted_designs():
    theta = distributions_figure(training_designs(), generated_designs()).axes[9]
    assert heading(theta) == "θ, °"
    assert len(theta.patches) == 3  # twisting, mixed, training: none that only bends


def test_distributions_of_a_single_design():
    one = generated_designs(["bending"])
    figure = distributions_figure(training_designs().head(1), one)
    assert words_in(figure.axes[0]) == ["no comparison"]


# Captions -------------------------------------------------------------------------------------


def test_every_picture_has_a_caption():
    assert set(PICTURES) == set(texts.CAPTIONS)


def test_captions_say_only_what_is_known():
    unknown = texts.captions({})
    assert all(unknown.values())
    assert not any("{" in text or "Seed" in text for text in unknown.values())


def test_captions_know_what_the_configuration_says():
    config = {"embedding": {"method": "pca", "seed": 4, "perplexity": 30.0}, "diversity": None}
    found = texts.caption("embedding", texts.facts_of_settings(config))
    assert "Method: principal components." in found
    assert "Seed 4." in found
    assert "erplexity" not in found


def test_captions_carry_the_numbers_of_the_run(results):
    found = texts.captions(facts_of(GenerativePaths.under(results)))
    assert "Perplexity 30;" in found["embedding"]
    assert "Trustworthiness 0.910" in found["embedding"]
    assert "Seed 7." in found["embedding"]
    assert "all 120" in found["embedding"]
    assert "20 mixed designs out of 60" in found["mixture"]
    assert "30 % of the weight" in found["mixture"]
    assert "1,537 draws were made again." in found["mixture"]
    assert "those of Table 2 as stars" in found["embedding"]
    assert "it is least with 2." in found["mixture"]
    assert "8 designs were simulated, 6 ended well." in found["feasibility"]
    held = "7 of 8 simulated designs have a blocked force (lower edge of the tip held)."
    assert held in found["force_bending"]
    assert not any("{" in text for text in found.values())


def test_without_a_bridge_no_caption_speaks_of_one(tmp_path):
    leave_results(tmp_path)
    (tmp_path / "generated" / "mixture.json").write_text(json.dumps(MIXTURE | {"bridge": None}))
    found = texts.captions(facts_of(GenerativePaths.under(tmp_path)))["mixture"]
    assert "Ellipses: 3 Gaussians" in found
    assert not any(word in found for word in ("dashed", "barycentre", "again"))


def test_the_report_says_of_the_bridge_what_the_page_says():
    """A caption of the report knows the configuration only, so that it has a text of its own."""
    report = Path(__file__).parents[2] / "workflow" / "report" / "generative.rst"
    said = " ".join(report.read_text(encoding="utf-8").split())
    (bridge,) = [text for text in texts.CAPTIONS["mixture"] if "barycentre" in text]
    assert bridge.replace(", with {bridge_weight} of the weight,", "") in said


# All together ---------------------------------------------------------------------------------


def test_all_pictures_of_a_run_are_drawn(results, tmp_path):
    assert draw_generative(results, tmp_path, 50) == {}
    written = json.loads((tmp_path / CAPTIONS_NAME).read_text(encoding="utf-8"))
    assert list(written) == list(PICTURES)
    for name in PICTURES:
        with Image.open(tmp_path / f"{name}.png") as picture:
            assert len(picture.convert("RGB").getcolors(1 << 20)) > 20


def test_without_results_there_is_no_picture_but_a_reason(tmp_path):
    missing = draw_generative(tmp_path / "nothing", tmp_path / "out", 50)
    assert set(missing) == {*PICTURES, "modes"}
    assert missing["mixture"] == "There is no data set."
    assert [path.name for path in (tmp_path / "out").iterdir()] == [CAPTIONS_NAME]


@pytest.mark.parametrize("name", ["mixture", "distributions"])
def test_without_generated_designs_there_is_no_picture_of_them(tmp_path, name):
    results = leave_results(tmp_path / "results")
    (results / "generated" / "designs.parquet").unlink()
    with pytest.raises(NothingToDraw, match="no generated designs"):
        PICTURES[name](GenerativePaths.under(results), tmp_path / "out.png")
    assert not (tmp_path / "out.png").exists()


def test_designs_that_were_not_drawn_in_the_plane(tmp_path):
    results = leave_results(tmp_path / "results")
    frame = generated_designs().assign(z1=None, z2=None)
    write_frame(results / "generated" / "designs.parquet", frame, GENERATED)
    with pytest.raises(NothingToDraw, match="not drawn in the plane"):
        PICTURES["mixture"](GenerativePaths.under(results), tmp_path / "out.png")


def test_of_more_principal_components_the_first_two_are_shown(tmp_path):
    paths = GenerativePaths.under(leave_results(tmp_path, "pca", 3))
    plane = load_plane(paths)
    np.testing.assert_array_equal(plane.training[["z1", "z2"]], training_designs()[["z1", "z2"]])
    three = {"means": [[1.0, 2.0, 3.0]], "covariances": [np.diag([4.0, 5.0, 6.0]).tolist()]}
    (gaussian,) = gaussians_of(three | {"weights": [1.0], "bridge": None}, plane)
    np.testing.assert_array_equal(gaussian.mean, [1.0, 2.0])
    np.testing.assert_array_equal(gaussian.covariance, np.diag([4.0, 5.0]))


def test_a_single_coordinate_is_no_plane(tmp_path):
    paths = GenerativePaths.under(leave_results(tmp_path, "pca", 1))
    with pytest.raises(NothingToDraw, match="no two coordinates"):
        load_plane(paths)


def test_picture_for_the_documentation_is_small_and_always_the_same(results, tmp_path):
    for name in ("one.svg", "two.svg"):
        draw_modes(GenerativePaths.under(results), tmp_path / name)
    content = (tmp_path / "one.svg").read_bytes()
    assert content == (tmp_path / "two.svg").read_bytes()
    assert len(content) < 150_000
    drawn = "".join(ElementTree.fromstring(content).itertext())
    assert "bridging Gaussian" in drawn
    assert "mixed" in drawn
    assert "mixed (20)" not in drawn
    assert "drawn: 120 of 120 training designs, 60 of 60 generated" in drawn
    assert b"<dc:date>" not in content


def test_picture_for_the_documentation_is_committed():
    """It is written by draw_modes from the results of the default configuration."""
    picture = Path(__file__).parents[2] / "docs" / "modes.svg"
    assert picture.stat().st_size < 150_000
    drawn = "".join(ElementTree.parse(picture).getroot().itertext())
    assert "bridging Gaussian" in drawn
