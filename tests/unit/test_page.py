"""The page and its cards: their parts by their content."""

import base64
import dataclasses
import html
import json
import re
import zlib
from dataclasses import replace

import numpy as np
import pandas as pd
import pytest
from design_samples import TABLE2_MIXED
from figure_samples import SIZE, block, path_only, record, solved, states_of, three_designs
from PIL import Image

from pagd.dataset import frame_of
from pagd.errors import InputError
from pagd.figures import viewer
from pagd.figures.alternatives import ALTERNATIVES, alternative
from pagd.figures.angles import draw_angles
from pagd.figures.captions import TOGETHER, captions_of_design
from pagd.figures.generative.captions import CAPTIONS
from pagd.figures.groups import read_entries
from pagd.figures.load import Path3D
from pagd.figures.page import Study, write_page
from pagd.figures.page.cards import write_card
from pagd.figures.page.claims import claims, claims_of
from pagd.figures.page.explorer import explorer_data
from pagd.figures.page.generative import SHOWN_ELSEWHERE, comparison_table
from pagd.figures.page.libraries import datatables, plotly
from pagd.figures.page.rows import rows_of
from pagd.figures.page.screening import answer_of
from pagd.figures.surface import skin_of
from pagd.record import write_record
from pagd.tables import PERFORMANCE, write_rows

# ---- shapes and paths as data ---------------------------------------------------------------


def unpacked(text, kind):
    return np.frombuffer(zlib.decompress(base64.b64decode(text)), dtype=kind)


def positions_of(data):
    """Positions (p, 3, v) in mm, as the script of the page finds them."""
    shape = (len(data["pressure_kPa"]), 3, data["vertices"])
    rest = unpacked(data["rest"], "<i2").reshape(shape[1:])
    change = unpacked(data["change"], "<i2").reshape(shape[0] - 1, *shape[1:])
    moved = np.cumsum(np.cumsum(change, axis=0, dtype="<i2"), axis=0, dtype="<i2")
    return np.concatenate([rest[None], rest + moved]) * data["step_mm"]


@pytest.mark.parametrize("half", [False, True])
def test_viewer_keeps_shape_and_strain(half):
    states = states_of(block(half))
    data = viewer.viewer_data(states)
    count, index = data["vertices"], f"<u{data['index_bits'] // 8}"
    positions = positions_of(data)
    triangles = unpacked(data["triangles"], index).reshape(-1, 3)
    skin = skin_of(states.mesh)
    for state, u in enumerate(states.displacement):
        exact = skin.vectors(states.mesh.points) + skin.vectors(u)
        kept = positions[state].T[triangles]
        assert np.abs(kept - exact[skin.triangles]).max() <= 0.5001 * data["step_mm"]
    strain = unpacked(data["strain"], "<u1").reshape(4, count)[-1] / 255.0 * data["top"]
    exact = np.minimum(skin.scalars(states.strain[-1])[skin.triangles], data["top"])
    np.testing.assert_allclose(strain[triangles], exact, atol=data["top"] / 500.0)


def test_viewer_splits_a_box_into_its_six_sides():
    mesh = block(half=False)
    data = viewer.viewer_data(states_of(mesh))
    triangles = unpacked(data["triangles"], "<u2").reshape(-1, 3)
    rest = positions_of(data)[0].T
    normals = {}
    for triangle in triangles:
        a, b, c = rest[triangle]
        normal = np.cross(b - a, c - a)
        for vertex in triangle:
            normals.setdefault(vertex, set()).add(tuple(np.round(normal / np.abs(normal).max())))
    # No vertex belongs to two sides: shading has no reason to round the edges.
    assert {len(found) for found in normals.values()} == {1}
    edges = rest[unpacked(data["edges"], "<u2").reshape(-1, 2)]
    length = np.linalg.norm(edges[:, 0] - edges[:, 1], axis=1).sum()
    assert length == pytest.approx(4 * sum(SIZE), rel=1e-3)


def test_large_skins_go_by_their_corners(monkeypatch):
    states = states_of(block(half=False))
    fine = viewer.viewer_data(states)
    monkeypatch.setattr(viewer, "_MANY", 10)
    coarse = viewer.viewer_data(states)
    counts = [len(unpacked(data["triangles"], "<u2")) for data in (coarse, fine)]
    assert counts[0] * 4 == counts[1]


def test_path_of_the_tip_is_the_last_station():
    positions = np.arange(24.0).reshape(2, 4, 3)
    angles = np.array([[0.0, 1.0, 2.0, 3.0], [0.0, 2.0, 4.0, 6.0]])
    data = viewer.path_data(Path3D(np.array([0.0, 5.0]), positions, angles, -angles))
    assert data["bending_deg"] == [3.0, 6.0]
    assert data["twist_deg"] == [-3.0, -6.0]
    x, _, z = data["lines"][1]
    assert (x, z) == ([12.0, 15.0, 18.0, 21.0], [14.0, 17.0, 20.0, 23.0])


# ---- page of a few designs ------------------------------------------------------------------


@pytest.fixture(scope="module")
def designs(tmp_path_factory):
    return three_designs(tmp_path_factory.mktemp("designs"))


@pytest.fixture(scope="module")
def page(designs, tmp_path_factory):
    root = tmp_path_factory.mktemp("report")
    pictures = root / "pictures"
    draw_angles(designs, pictures / "angles.png")
    write_page(designs, root / "index.html", pictures)
    return root / "index.html"


def data_of(text):
    return json.loads(re.search(r'id="data">(.*?)</script>', text, re.DOTALL).group(1))


def titles_of(text):
    return re.findall(r"<h2>\d+\. (.*?)</h2>", text)


def card_of(page, name):
    """What the card of a design holds, which lies beside the page."""
    return card_of_folder(page.with_name("index_files") / name)


def card_of_folder(folder):
    text = (folder / "card.js").read_text(encoding="utf-8")
    return json.loads(text.removeprefix("takeCard(").removesuffix(");\n"))


def test_page_needs_no_other_file_but_its_cards(page):
    text = page.read_text(encoding="utf-8")
    scripts = re.sub(r"<script>.*?</script>", "", text, flags=re.DOTALL)
    assert not re.search(r"""(?:src|href)=["'](?!data:|#)""", scripts)
    assert "@import" not in scripts
    assert not re.search(r"url\((?!data:)", scripts)
    assert text.count("data:image/webp;base64,") == 1
    assert TOGETHER["angles"] in text


def test_page_tells_of_every_design(page):
    text = page.read_text(encoding="utf-8")
    data = data_of(text)["explorer"]
    place = {column["key"]: i for i, column in enumerate(data["columns"])}
    assert len(data["rows"]) == 3
    assert data["rows"][0][place["bending_deg"]] == pytest.approx(34.4, abs=0.05)
    assert data["rows"][1][place["tip_z_mm"]] == -5.25
    assert data["rows"][2][place["status"]] == "invalid geometry"
    names = [d["name"] for d in data_of(text)["designs"]]
    assert names == ["whole", "half", "failed"]
    assert text.count('" open><summary>') == 3
    assert re.findall('data-address="(.*?)"', text) == [f"index_files/{name}" for name in names]
    # What there is nothing of has no section.
    expected = ["Each design", "What was run", "Explorer", "Performance"]
    expected += ["Trajectories, angles and forces"]
    assert titles_of(text) == expected
    assert "Contact was off" not in text
    assert [bool(d["held"]) for d in data_of(text)["designs"]] == [True, True, False]


def test_a_card_holds_what_there_is_of_its_design(page):
    whole, half, failed = (card_of(page, name) for name in ("whole", "half", "failed"))
    for one in (whole, half):
        assert set(one["steps"]) == {"free", "held"}
        assert one["shape"]["vertices"] > 0
        assert "Blocked force (lower edge of the tip held): 0.690 N at 30 kPa." in one["markup"]
        assert "<dt>bending</dt>" in one["markup"]
        # All records, as they stand.
        assert "<summary>solve " in one["markup"]
        assert "&quot;schema&quot;: 1" in one["markup"]
    assert "t_ab = 9 is &lt;too thick&gt; &amp; leaves no cavity." in failed["markup"]
    assert (failed["shape"], failed["path"], failed["steps"]) == (None, None, {})


def test_a_card_offers_what_lies_beside_it(designs, tmp_path):
    (tmp_path / "body.stl").write_bytes(b"x" * 250_000)
    (tmp_path / "own.txt").write_text("not ours")
    write_card(designs[0], tmp_path)
    markup = card_of_folder(tmp_path)["markup"]
    assert '<a href="body.stl" download>body.stl</a> <small>0.2 MB</small> surface' in markup
    assert "own.txt" not in markup
    assert "solids.step" not in markup


@pytest.mark.parametrize(("contact", "word"), [(True, "on"), (False, "off")])
def test_page_tells_whether_chambers_could_touch(designs, tmp_path, contact, word):
    settings = {"solve": {"contact": contact, "maximum_pressure_kPa": 50.0}}
    made = dataclasses.replace(record("d", "solve"), configuration=settings)
    (tmp_path / "d" / "solve").mkdir(parents=True)
    write_record(made, tmp_path / "d" / "solve")
    write_page([tmp_path / "d"], tmp_path / "index.html")
    whole = (tmp_path / "index.html").read_text(encoding="utf-8")
    text = re.sub("<.*?>", " ", whole[whole.index("<main>") :][:20000])
    assert re.search(rf"contact between chambers\s+{word}\b", text)
    assert re.search(r"pressure up to\s+50 kPa", text)


def test_page_of_failed_designs_only(designs, tmp_path):
    write_page([designs[2], tmp_path / "never-run"], tmp_path / "index.html")
    text = (tmp_path / "index.html").read_text(encoding="utf-8")
    assert "invalid geometry" in text
    assert "not run" in text
    assert "No stage has left a record." in card_of(tmp_path / "index.html", "never-run")["markup"]


# ---- table ----------------------------------------------------------------------------------


def cells(row):
    found = re.findall(r"<t[hd][^>]*>(.*?)</t[hd]>", row)
    return [re.sub("<.*?>", "", cell) for cell in found]


def explored(rows, study=None):
    """What the explorer shows of some rows: a dictionary a row, by the headings."""
    data = explorer_data(rows, study or Study())
    headings = [column["heading"] for column in data["columns"]]
    return [dict(zip(headings, row, strict=True)) for row in data["rows"]], data


def test_the_explorer_has_a_column_for_whatever_is_known():
    rows = [
        {"design_id": "a", "link": True, "status": "ok", "origin": "own", "bending_deg": -1234.56},
        {"design_id": "b", "link": False, "status": "mesh_failed", "novelty": 0.5},
    ]
    (first, second), data = explored(rows)
    known = {"design": "a", "status": "ok", "analysis": "full", "origin": "own"}
    assert first == known | {"novelty": None, "bending": -1234.56}
    assert second["status"] == "mesh failed"
    assert second["novelty"] == 0.5
    assert data["links"] == [0]
    units = {column["heading"]: column["unit"] for column in data["columns"]}
    assert units["bending"] == "°"


def test_the_explorer_keeps_no_round_off():
    (first,), _ = explored([{"design_id": "a", "status": "ok", "twist_deg": -1e-14}])
    assert str(first["twist"]) == "0.0"
    (first,), _ = explored([{"design_id": "a", "status": "ok", "energy_balance": 0.01234567}])
    assert first["energy balance"] == 1.235


def test_the_explorer_has_designs_by_a_chamber_once_with_their_novelty(tmp_path):
    names = [column.name for column in PERFORMANCE]
    for folder, ids in (("generated", ("g1", "g2")), ("training", ("d1",))):
        rows = [{"design_id": one, "status": "ok", "bending_deg": 10.0} for one in ids]
        path = tmp_path / folder / "performance.parquet"
        path.parent.mkdir()
        write_rows(path, PERFORMANCE, [dict.fromkeys(names) | row for row in rows])
    study = Study(screened=tmp_path / "generated", screened_training=tmp_path / "training")
    simulated = [{"design_id": "g2", "status": "ok", "bending_deg": 11.0, "link": True}]
    found, _ = explored(simulated, study)
    assert [(row["design"], row["analysis"]) for row in found] == [
        ("g2", "full"),
        ("g1", "one chamber"),
        ("d1", "one chamber"),
    ]
    frame = frame_of([TABLE2_MIXED], ["g1"], ["generated"])
    drawn = tmp_path / "drawn" / "designs.parquet"
    drawn.parent.mkdir()
    frame.assign(novelty=2.5).to_parquet(drawn)
    found, _ = explored(simulated, replace(study, generated=drawn.parent))
    assert {row["design"]: row["novelty"] for row in found} == {"g2": None, "g1": 2.5, "d1": None}


def test_libraries_that_stand_in_the_page_end_no_script():
    for script in (plotly(), datatables()):
        assert "</script" not in script
    assert "window.DataTable=" in datatables()


def test_rows_are_those_of_the_summary_with_what_the_records_add(tmp_path):
    folder = solved(tmp_path / "drawn", size_mm=3.0, origin="published")
    entries = read_entries([folder])
    assert [row["design_id"] for row in rows_of(entries, [])] == ["drawn"]
    summary = [
        {"design_id": "other", "origin": "generated", "mode": "mixed", "status": "ok"},
        {"design_id": "drawn", "status": "ok", "novelty": 1.5, "blocked_force_N": None},
    ]
    other, drawn = rows_of(entries, summary)
    assert (other["design_id"], other["link"]) == ("other", False)
    assert (drawn["size_mm"], drawn["novelty"], drawn["link"]) == (3.0, 1.5, True)
    assert drawn["origin"] == "published"
    assert "blocked_force_N" not in drawn
    off = solved(tmp_path / "off", contact=False)
    told = {
        row["design_id"]: row.get("contact")
        for row in rows_of(read_entries([folder, off]), summary)
    }
    assert told == {"other": None, "drawn": True, "off": False}


# ---- comparison of generators ---------------------------------------------------------------


def measured(generator, metric, value, space="plane", low=None, high=None, mode="all"):
    keys = ("generator", "metric", "value", "space", "low", "high", "mode")
    return dict(zip(keys, (generator, metric, value, space, low, high, mode), strict=True))


COMPARISON = {
    "generator": "gmm",
    "spaces": {"plane": "plane of all", "encoded": "standardised"},
    "metrics": {
        "novelty": {"description": "mean distance", "better": "higher", "interval": "95 %"}
    },
    "rows": [
        measured("training", "novelty", 0.25, "encoded"),
        measured("random", "novelty", 12345.0, "encoded", -0.001234, 2.5),
        measured("gmm", "novelty", None, "encoded"),
        measured("gmm", "novelty", 99.0, "encoded", mode="mixed"),
        measured("gmm", "dpp", -3.5),
    ],
}


def test_comparison_has_a_table_a_space_and_the_own_generator_first():
    text = comparison_table(COMPARISON)
    plane, encoded = re.findall(r"<table>.*?</table>", text, re.DOTALL)
    assert text.index("plane of all") < text.index("standardised")
    rows = [cells(row) for row in re.findall(r"<tr>.*?</tr>", encoded)]
    assert rows == [
        ["generator", "novelty"],
        ["gmm", "–"],
        ["random", "12,345 [−0.00123, 2.50]"],
        ["training designs", "0.250"],
    ]
    assert "−3.50" in plane
    assert "<th>DPP score</th>" in plane
    assert re.findall("<h3>(.*?)</h3>", text) == ["Plane", "All parameters"]
    assert "mean distance; higher is better; in brackets: 95 %" in text


def test_comparison_of_nothing_is_nothing():
    assert comparison_table({}) == ""


# ---- the paper beside a run -----------------------------------------------------------------


def test_claims_are_beside_what_was_measured(study):
    rows = [
        {"design_id": "straight", "origin": "table2", "status": "ok", "pressure_kPa": 50.0}
        | {"bending_deg": 91.2, "twist_deg": 0.04},
        {"design_id": "failed", "origin": "table2", "status": "mesh_failed"},
    ]
    said = [one.measured for one in claims_of(study, rows)]
    assert said == [
        "1,900 designs: 901 bending, 999 twisting",
        "t-SNE with perplexity 30: of 50 % of the designs the nearest one in the plane is of their"
        " own category",
        "not by the data alone (gmm_plain: mixed 5 % of the designs); gmm: mixed 50 % of the"
        " designs, by a component between the two whose weight is a setting",
        "2 designs: 1 ok, 1 mesh failed",
        "straight at 50 kPa: bends by 91°, twists not",
    ]
    # Another generator has no such component; without a comparison, nothing is known of the plain.
    other = stage_record(study.dataset.with_name("kde"), {"mode_share": {"mixed": 0.02}})
    found = [one.measured for one in claims_of(Study(generated=other), [])]
    assert found == ["None: mixed 2 % of the designs"]


def test_diversity_is_beside_what_the_paper_says(study):
    rows = [
        measured("gmm", "hull_ratio", 1.18, low=0.87, high=1.61),
        *(
            measured(name, "novelty", value, "plane_sample")
            for name, value in {"gmm": 0.049, "training": 0.0096}.items()
        ),
    ]
    diversity = study.diversity.with_name("hull.json")
    diversity.write_text(json.dumps(COMPARISON | {"rows": rows}))
    novelty, hull = (one.measured for one in claims_of(Study(diversity=diversity), []))
    assert novelty.endswith("gmm 0.049, training designs among themselves 0.010")
    assert hull == "1.18 times the area (0.87 to 1.61 for other fifties); no larger hull is certain"
    rows[0]["low"] = 1.02
    diversity.write_text(json.dumps(COMPARISON | {"rows": rows}))
    told = [one.measured for one in claims_of(Study(diversity=diversity), [])]
    assert told[1] == "1.18 times the area (1.02 to 1.61 for other fifties)"


def test_own_designs_are_beside_no_paper():
    assert claims(Study(), [{"design_id": "a", "origin": "own", "status": "ok"}]) == ""


# ---- page of a study ------------------------------------------------------------------------


def stage_record(folder, figures, **configuration):
    folder.mkdir()
    made = record("all", "mesh", figures=figures)
    write_record(dataclasses.replace(made, configuration=configuration), folder)
    return folder


def pictures_in(folder, names):
    folder.mkdir()
    for name in names:
        Image.new("RGB", (400, 300), "white").save(folder / f"{name}.png")
    captions = {name: f"How {name} was <made>." for name in names}
    (folder / "captions.json").write_text(json.dumps(captions))


SCREENED_PICTURES = ("screened", "screened_novelty", "screened_beside_full")
FRONTS = {
    "training": 480,
    "generated": 1000,
    "comparisons": [
        {
            "objectives": ["bending_deg", "twist_deg", "blocked_force_N"],
            **{"compared": {"training": 480, "generated": 1210}, "drawn": 160},
            **{"ratio": 1.23, "low": 1.04, "high": 1.45, "p": 0.0125, "share": 0.68},
            "front": {"training": {"bending": 3}, "generated": {"mixed": 5, "twisting": 2}},
            "front_designs": [],
        }
    ],
}


@pytest.fixture(scope="module")
def study(tmp_path_factory):
    """A run of the generative half: what its stages, pictures and summary leave."""
    root = tmp_path_factory.mktemp("study")
    counts = {"bending": {"random": 900, "table2": 1}, "twisting": {"random": 999}}
    found = {"size": 1900, "counts": counts, "acceptance": {"bending": {"random": 0.5}}}
    dataset = stage_record(root / "dataset", found, dataset={"seed": 7})
    setting = {"method": "tsne", "perplexity": 30.0, "seed": 8}
    embedding = stage_record(root / "embedding", {"trustworthiness": 0.9}, embedding=setting)
    # Two islands, each of a straight and a slanted design.
    designs = [replace(TABLE2_MIXED, alpha=alpha) for alpha in (0.0, 0.0, 1.0, 1.0)]
    names = ["a", "b", "c", "d"]
    frame_of(designs, names, ["random"] * 4).to_parquet(dataset / "designs.parquet")
    places = np.array([[0.0, 0.0], [0.1, 0.0], [5.0, 0.0], [0.11, 0.0]])
    table = pd.DataFrame({"design_id": names, "z1": places[:, 0], "z2": places[:, 1]})
    table.to_parquet(embedding / "points.parquet")
    shares = {"bending": 0.25, "twisting": 0.25, "mixed": 0.5}
    refused = {"invalid": 2, "copies_of_training": 1, "duplicates": 3, "other_mode": 0}
    drawn = {"designs": 1000, "mode_share": shares, "novelty_mean": 1.25, "refused": refused}
    generated = stage_record(root / "generated", drawn, generator={"method": "gmm", "seed": 9})
    plain = {"mode_share": {"gmm_plain": {"bending": 0.48, "twisting": 0.47, "mixed": 0.05}}}
    comparison = stage_record(root / "comparison", plain)
    pictures_in(root / "simulated", SHOWN_ELSEWHERE)
    pictures_in(root / "screening", SCREENED_PICTURES)
    elsewhere = (*SHOWN_ELSEWHERE, *SCREENED_PICTURES)
    pictures_in(root / "pictures", [name for name in CAPTIONS if name not in elsewhere])
    ended = {"designs": 1000, "statuses": {"ok": 990, "bending_limit": 10}, "cpu_s_median": 1.25}
    screened = stage_record(root / "screened", ended)
    (root / "fronts.json").write_text(json.dumps(FRONTS))
    (root / "diversity.json").write_text(json.dumps(COMPARISON))
    rows = [
        {"design_id": f"d{i}", "origin": "generated", "mode": "mixed", "status": "ok"}
        | {"novelty": 0.1 * i, "bending_deg": 10.0 * i, "twist_deg": 1.0}
        for i in range(7)
    ]
    write_rows(root / "performance.parquet", PERFORMANCE, rows)
    return Study(
        dataset=dataset,
        embedding=embedding,
        generated=generated,
        diversity=root / "diversity.json",
        comparison=comparison,
        performance=root / "performance.parquet",
        pictures=root / "pictures",
        simulated=root / "simulated",
        screened=screened,
        fronts=root / "fronts.json",
        screening_pictures=root / "screening",
    )


@pytest.mark.parametrize(
    ("ratio", "p", "words"),
    [
        (1.2, 0.01, "force at once, generated designs do more: 20 % more in volume"),
        (0.8, 0.01, "generated designs do less: 20 % less in volume"),
        (0.8, 0.2, "no difference is certain: 20 % less in volume"),
    ],
)
def test_the_answer_is_as_sure_as_the_test(ratio, p, words):
    whole = FRONTS["comparisons"][0] | {"ratio": ratio, "p": p}
    assert words in answer_of(FRONTS | {"comparisons": [whole]})
    assert "Too few" in answer_of(FRONTS | {"comparisons": []})


def test_the_answer_begins_with_what_cells_are_sure_of():
    whole = FRONTS["comparisons"][0]
    free = whole | {"objectives": ["bending_deg", "twist_deg"], "ratio": 0.5, "p": 0.01}
    told = answer_of(FRONTS | {"comparisons": [whole, free]})
    assert told.startswith("By bending, twist at once, generated designs do less: 50 % less")
    assert told.count("at once") == 2
    assert answer_of(FRONTS | {"comparisons": [free]}).count("at once") == 1


PICTURES_TOGETHER = ("gallery", "trajectories", "angles", "forces")


@pytest.fixture(scope="module")
def whole_page(study, tmp_path_factory):
    """The page of five designs of a study with seven."""
    root = tmp_path_factory.mktemp("whole")
    first = solved(root / "d0", mode="mixed", origin="generated")
    others = [path_only(root / f"d{i}", mode="twisting", origin="published") for i in range(1, 5)]
    write_page([first, *others], root / "index.html", study=study)
    return root / "index.html"


def test_page_of_a_study_follows_the_method(whole_page):
    text = whole_page.read_text(encoding="utf-8")
    assert titles_of(text) == [
        "What was run",
        "Beside the paper",
        "Explorer",
        "Data set and embedding",
        "Generator and modes",
        "Novelty and diversity",
        "What the designs can do",
        "Performance",
        "Trajectories, angles and forces",
        "Each design",
    ]
    for fact in (
        "<dt>training designs</dt><dd>1,900</dd>",
        "<dd>901 bending, 999 twisting</dd>",
        "<dd>1,899 random, 1 of Table 2</dd>",
        "<dd>bending 50 %</dd>",
        "<dd>t-SNE, perplexity 30</dd>",
        "<dd>bending 25 %, twisting 25 %, mixed 50 %</dd>",
        "<dt>mean novelty, all parameters</dt><dd>1.250</dd>",
        "<dt>simulated designs</dt><dd>7</dd>",
        "<dd>2 invalid, 1 copy of a training design, 3 duplicates</dd>",
        "<dd>990 ok, 10 bending limit</dd>",
        "By bending, twist, blocked force at once, generated designs do more: 23 % more in volume,"
        " 160 designs of either kind, drawn from 1,210 generated and 480 training designs,"
        " p = 0.013. Of the front of such a draw 68 % are generated.",
    ):
        assert fact in text
    assert cells(re.search(r"<tr><th>generated designs.*?</tr>", text).group())[-1] == "7 of 7"


def test_every_picture_of_a_study_is_there_once_with_its_caption(whole_page):
    text = whole_page.read_text(encoding="utf-8")
    shown = re.findall(r"<figcaption>How (\w+) was &lt;made&gt;\.</figcaption>", text)
    assert sorted(shown) == sorted(CAPTIONS)
    assert text.count("data:image/webp") == len(CAPTIONS)
    assert shown[0] == "embedding"
    assert text.index("How hull") < text.index("<h2>8. Performance") < text.index("How feasibility")


def test_whoever_does_not_see_the_pictures_is_told_what_they_show(whole_page):
    told = re.findall(r'<img[^>]* alt="([^"]*)"', whole_page.read_text(encoding="utf-8"))
    assert sorted(told) == sorted(html.escape(alternative(name)) for name in CAPTIONS)
    assert alternative("mesh", "bending") == f"{ALTERNATIVES['mesh']}: bending."
    assert set(ALTERNATIVES) == {*CAPTIONS, *captions_of_design(), *PICTURES_TOGETHER}
    assert all(len(text.split()) > 5 for text in ALTERNATIVES.values())


def test_many_cards_are_closed_and_designs_without_a_folder_have_none(whole_page):
    text = whole_page.read_text(encoding="utf-8")
    assert re.findall(r'<details class="card" id="design-(\w+)" data-address="[^"]*">', text) == [
        f"d{i}" for i in range(5)
    ]
    data = data_of(text)
    assert data["explorer"]["links"] == [0, 1, 2, 3, 4]
    assert len(data["explorer"]["rows"]) == 7
    assert data["groups"] == ["twisting", "mixed"]


def test_a_study_that_cannot_be_read_is_said(tmp_path):
    (tmp_path / "diversity.json").write_text("{")
    with pytest.raises(InputError, match=r"diversity.json: not readable as JSON"):
        write_page([], tmp_path / "index.html", study=Study(diversity=tmp_path / "diversity.json"))
    assert not (tmp_path / "index.html").exists()
