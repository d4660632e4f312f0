"""Families of actuators: the interface, tables of parameters, what is refused, and how."""

from __future__ import annotations

import dataclasses
import json
import sys
from collections.abc import Iterator
from pathlib import Path

import numpy as np
import pytest
from family_samples import BAR, BELLOWS, MODEL, MODULE, TABLE, write_family

from pagd.catalogue import NamedDesign, design_from, read_designs, read_pneunets
from pagd.cli import main
from pagd.design import Design, GeometryRules
from pagd.errors import InputError, StageFailure
from pagd.families import FAMILIES, PneuNet, actuator_of, family_named, name_of
from pagd.families.half_bellows import HalfBellows
from pagd.families.parameters import read_parameters
from pagd.families.sampling import sample
from pagd.geometry import Part, render, write_design_scad
from pagd.record import read_record
from pagd.repair import repair
from pagd.simulation import simulate
from pagd.stages.novelty import novelty_of
from pagd.tables import GENERATED, Column, write_rows

ROOT = Path(__file__).parents[2]
TABLE2 = str(ROOT / "config" / "table2.csv")
RULES = GeometryRules()
HEAD = "name,family,N,q,w,R,L_c,L_r,t,t_e,t_b,b_f,L,W,H,t_n,t_h,t_ab,theta,alpha\n"
ROW = "b,half_bellows,2,11,4,7,5,2,2,2,3,1,,,,,,,,\n"
PNEUNET_ROW = "p,,12,,,,,,4.02,,2.12,,9.51,15.2,13.01,1.5,3.95,1.95,0,0\n"


@pytest.fixture
def own(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Iterator[Path]:
    """A folder that Python imports from, with the family of a user's own."""
    folder = tmp_path / "modules"
    folder.mkdir()
    write_family(folder)
    monkeypatch.syspath_prepend(str(folder))
    yield folder
    sys.modules.pop("hollow_bar", None)


def bellows(**changes: float) -> HalfBellows:
    made = design_from(json.dumps(BELLOWS | changes)).design
    assert isinstance(made, HalfBellows)
    return made


def table(folder: Path, text: str) -> dict[str, str]:
    (folder / "designs.csv").write_text(text)
    return {"own": str(folder / "designs.csv")}


def test_families_are_found_by_name_and_names_by_family() -> None:
    for name in FAMILIES:
        assert name_of(family_named(name)) == name


def test_the_text_of_a_pneu_net_names_no_family() -> None:
    """Records, and what the workflow compares, are those of before there were families."""
    assert read_designs({"table2": TABLE2})["mixed"].as_json() == (
        '{"name": "mixed", "origin": "table2", "L": 8.01, "W": 15.12, "H": 12.98, "t": 1.49, '
        '"t_n": 2.8, "t_h": 4.07, "t_ab": 2.05, "t_b": 1.97, "N": 12, "theta": 27.2, "alpha": 0.5}'
    )


def test_a_pneu_net_may_name_its_family(tmp_path: Path) -> None:
    named = read_designs({"table2": TABLE2})["mixed"]
    told = {**json.loads(named.as_json()), "family": "pneunet"}
    assert design_from(json.dumps(told)) == named
    assert actuator_of(named.design) == PneuNet(named.pneunet)
    assert actuator_of(named.design).digest() is None


def test_a_design_of_a_family_survives_the_way_through_json(tmp_path: Path) -> None:
    named = design_from(json.dumps(BELLOWS))
    assert design_from(named.as_json()) == named
    assert hash(named) == hash(design_from(named.as_json()))
    assert json.loads(named.as_json()) == BELLOWS | {"origin": "own"}
    assert type(named.actuator.as_dict()["N"]) is int


def test_a_table_may_have_several_families(tmp_path: Path) -> None:
    found = read_designs(table(tmp_path, HEAD + ROW + PNEUNET_ROW))
    assert found["b"].design == bellows()
    assert isinstance(found["p"].design, Design)
    assert found["p"].pneunet.t == 4.02
    assert read_designs(table(tmp_path, HEAD + ROW), checked=False)["b"] == found["b"]


def test_a_parquet_table_may_have_families(tmp_path: Path) -> None:
    known = [column for column in GENERATED if column.name in ("design_id", "L_T")]
    symbols = dict.fromkeys(HalfBellows.parameters(), "double")
    columns = [*known, *(Column(s, kind, "", "") for s, kind in symbols.items())]
    columns.append(Column("family", "string", "", ""))
    row = {key: value for key, value in BELLOWS.items() if key != "name"}
    path = tmp_path / "designs.parquet"
    write_rows(path, columns, [{"design_id": "b", "L_T": 1.0, **row}])
    assert read_designs({"own": str(path)})["b"].design == bellows()


@pytest.mark.parametrize(
    ("change", "words"),
    [
        ({"q": "long"}, r"design bellows: q = 'long' must be a number"),
        ({"N": 2.5}, r"N = 2\.5 must be a whole number"),
        ({"R": None}, r"R = None must be a number"),
        ({"Lc": 1}, r"Lc is not a known key \(did you mean L_c\?\)"),
        ({"family": "bellow"}, r"family = 'bellow': must be pneunet or half_bellows, or a module:"),
        ({"family": 3}, r"family = 3: must be pneunet or half_bellows"),
        ({"family": "pagd.design:Design"}, r"it is no class of pagd\.families\.Actuator"),
        ({"family": "pagd.families:TabledActuator"}, r"it lacks L_T, broken, is_symmetric"),
        (
            {key: value / 1000 for key, value in BELLOWS.items() if key not in ("name", "family")}
            | {"N": 2},
            r"q = 0\.011, .*: lengths must be in mm, and these look like metres",
        ),
    ],
)
def test_a_bad_design_is_told_in_one_sentence(change: dict[str, object], words: str) -> None:
    with pytest.raises(InputError, match=words):
        design_from(json.dumps(BELLOWS | change))


def test_a_missing_parameter_is_told_with_its_row(tmp_path: Path) -> None:
    with pytest.raises(InputError, match=r"designs\.csv, row 2: q missing"):
        read_designs(table(tmp_path, HEAD + ROW.replace(",11,", ",,")))
    with pytest.raises(InputError, match=r"designs\.csv, row 2: family = 'x': must be pneunet"):
        read_designs(table(tmp_path, HEAD + ROW.replace("half_bellows", "x")))


def test_where_only_pneu_nets_will_do_others_are_refused(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    tables = table(tmp_path, HEAD + ROW + PNEUNET_ROW)
    with pytest.raises(InputError, match=r"design b: family = 'half_bellows' must be pneunet here"):
        read_pneunets(tables)
    for command in (
        ["screen", tables["own"], "--out", str(tmp_path / "screened")],
        [
            "dataset",
            "--config",
            json.dumps({"dataset": {"known": tables}}),
            "--out",
            str(tmp_path / "dataset"),
        ],
    ):
        assert main(command) == 2
        told = capsys.readouterr().err
        assert told.startswith("pagd: design b: family = 'half_bellows' must be pneunet here")
        assert told.count("\n") == 1
    assert [path.name for path in tmp_path.iterdir()] == ["designs.csv"]


def test_other_families_have_no_novelty(tmp_path: Path) -> None:
    (tmp_path / "design.json").write_text(design_from(json.dumps(BELLOWS)).as_json())
    assert novelty_of([tmp_path], tmp_path / "no data set is read") == {}


@pytest.mark.parametrize(
    ("change", "words"),
    [
        ({"N": 0}, "N = 0: must be at least 1"),
        ({"t_e": 0.5}, "t_e = 0.5: the end walls must be at least 0.75 mm"),
        ({"t_b": 0.8}, "t_b = 0.8: the paper, at t_b / 2, must lie 0.5 mm from the faces"),
        ({"q": 6.0}, "q = 6: crest and root, L_c + L_r, must not be longer"),
        ({"w": 0.2}, "w = 0.2: the height of the convolutions, 0.2 mm, must be at least 0.5 mm"),
        ({"R": 2.5}, "R = 2.5: the cavity at the roots, R - t, 0.5 mm, must be at least 1 mm"),
        ({"L_c": 2.0}, "L_c = 2: the cavity in the crests, 0.1849 mm, must be at least 1 mm"),
        ({"L_r": 0.4}, "L_r = 0.4: the gap between convolutions, 0.4 mm, must be at least 0.5 mm"),
        ({"w": float("inf")}, "w = inf: must be a finite number"),
    ],
)
def test_every_rule_of_the_half_bellows(change: dict[str, float], words: str) -> None:
    design = bellows(**change)
    assert [str(violation) for violation in design.violations(RULES)] == [words]
    with pytest.raises(StageFailure, match="The design cannot be built"):
        design.check(RULES)


def random_bellows(count: int) -> list[HalfBellows]:
    generator = np.random.default_rng(3)
    designs: list[HalfBellows] = []
    while len(designs) < count:
        box = HalfBellows.parameters()
        values = {key: generator.uniform(p.low, p.high) for key, p in box.items()}
        design = HalfBellows.from_mapping(values | {"N": 1 + len(designs)})
        if not design.violations(RULES):
            designs.append(design)
    return designs


@pytest.mark.parametrize("design", [*random_bellows(2), bellows(L_c=9.0)], ids=["1", "2", "flat"])
@pytest.mark.parametrize("half", [False, True], ids=["whole", "half"])
def test_half_bellows_have_their_exact_volume(
    design: HalfBellows, half: bool, tmp_path: Path
) -> None:
    """Also with flanks straight up; binary STL keeps coordinates to 6e-8 of themselves."""
    volumes = design.volumes(RULES)
    expected: dict[Part, float] = {
        "body": volumes.body,
        "base": volumes.base,
        "cavity": volumes.cavity,
    }
    for part, volume in expected.items():
        path = tmp_path / f"{part}.stl"
        render(design, RULES, part, path, half=half)
        report = repair(path, path, components=2 if part == "body" and not half else 1)
        assert report.repairs == 0
        assert report.volume == pytest.approx((0.5 if half else 1.0) * volume, rel=1e-6)


def test_more_facets_come_near_the_smooth_half_circle() -> None:
    """The cavity of one long crest: nearly half a cylinder, less than 1 % of it in 16 facets."""
    design = bellows(N=1, w=0.5, q=100.0, L_c=98.9, L_r=1.0, t=1.0)
    radius, length = 7.0 + 0.5 - 1.0, 100.0
    smooth = np.pi / 2 * radius**2 * length
    assert 0.98 * smooth < design.volumes(RULES).cavity < smooth


def test_a_family_of_ones_own_needs_three_files(own: Path, tmp_path: Path) -> None:
    named = design_from(json.dumps(BAR))
    assert named.actuator.family == "hollow_bar:HollowBar"
    assert named.actuator.volumes(RULES) is None
    assert named.actuator.mode == "bending"
    path = tmp_path / "design.scad"
    write_design_scad(named.actuator, RULES, path)
    assert "a = 8.0; // [4:0.1:20]" in path.read_text()
    render(named.actuator, RULES, "body", tmp_path / "body.stl")
    assert repair(tmp_path / "body.stl", tmp_path / "body.stl", components=2).volume == (
        pytest.approx(8 * 8 * 30 - 4 * 4 * 26, rel=1e-6)
    )


def test_a_change_of_any_file_of_a_family_is_noticed(own: Path) -> None:
    family = family_named("hollow_bar:HollowBar")
    texts = {"py": MODULE, "csv": TABLE, "scad": MODEL}
    digests = {family.digest()}
    for ending, text in texts.items():
        write_family(own, **{ending: text + "\n"})
        digests.add(family.digest())
    assert len(digests) == 4


@pytest.mark.parametrize(
    ("texts", "words"),
    [
        ({"py": "import nothing_of_that_name"}, r"family = 'hollow_bar:HollowBar': must be .*noth"),
        ({"py": MODULE.replace("def L_T", "def length")}, r"\(it lacks L_T\)"),
        ({"csv": TABLE.replace("symbol", "name")}, r"hollow_bar\.csv, row 2: .*name is not a kn"),
        ({"csv": TABLE.replace("4,20", "4,wide")}, r"row 2: high = 'wide' must be a number"),
        ({"csv": TABLE.replace("4,20", "20,4")}, r"row 2: low = 20 must be less than high = 4"),
        ({"csv": TABLE.replace("no,side", "maybe,side")}, r"whole = 'maybe' must be one of yes, n"),
        ({"csv": TABLE.replace("\nL,", "\na,")}, r"row 3: symbol = 'a' must be unique"),
        ({"csv": TABLE.replace("\nL,", "\nname,")}, r"symbol = 'name' must be a letter"),
        ({"csv": TABLE.splitlines()[0]}, r"must have at least one parameter"),
    ],
)
def test_what_is_wrong_with_a_family_is_told(own: Path, texts: dict[str, str], words: str) -> None:
    write_family(own, **texts)
    read_parameters.cache_clear()
    with pytest.raises(InputError, match=words):
        design_from(json.dumps(BAR))
    read_parameters.cache_clear()


def test_a_model_must_have_every_setting(own: Path, tmp_path: Path) -> None:
    write_family(own, scad=MODEL.replace("wall = 2;", "wall = 1 + 1; // the default\n//"))
    named = design_from(json.dumps(BAR))
    with pytest.raises(InputError, match=r"hollow_bar:HollowBar: has no line 'wall = …;'"):
        write_design_scad(named.actuator, RULES, tmp_path / "design.scad")
    (own / "hollow_bar.scad").unlink()
    with pytest.raises(InputError, match=r"OpenSCAD model .*hollow_bar\.scad: cannot be read"):
        write_design_scad(named.actuator, RULES, tmp_path / "design.scad")
    assert not (tmp_path / "design.scad").exists()


def test_check_and_show_tell_of_any_family(capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["design", "show", json.dumps(BELLOWS)]) == 0
    shown = capsys.readouterr().out
    assert shown.startswith("bellows (own, half_bellows)\n  N                  2")
    assert "L_T               26 mm       total length" in shown
    assert "volume of the air" in shown
    assert main(["design", "check", json.dumps(BELLOWS | {"t_e": 0.5})]) == 1
    assert "t_e = 0.5: the end walls must be" in capsys.readouterr().out


def test_a_family_that_cannot_be_built_has_a_record(tmp_path: Path) -> None:
    text = json.dumps(BELLOWS | {"t_e": 0.5})
    assert main(["geometry", "--design", text, "--out", str(tmp_path / "geometry")]) == 1
    record = read_record(tmp_path / "geometry")
    assert record.status == "invalid_geometry"
    assert record.configuration["design"]["family"] == "half_bellows"
    assert record.configuration["family_sha256"] == HalfBellows.digest()


def sampled(out: Path, *more: str) -> dict[str, NamedDesign]:
    assert main(["sample", "--family", "half_bellows", "-n", "12", "--out", str(out), *more]) == 0
    return read_designs({"own": str(out)})


def test_a_sample_is_valid_and_the_same_for_the_same_seed(tmp_path: Path) -> None:
    found = sampled(tmp_path / "some.csv")
    assert list(found) == [f"some_{i:02d}" for i in range(1, 13)]
    box = HalfBellows.parameters()
    for named in found.values():
        values = named.actuator.as_dict()
        assert not named.actuator.violations(RULES)
        assert all(box[key].low <= value <= box[key].high for key, value in values.items())
        assert all(round(value, 2) == value for value in values.values())
    again = sampled(tmp_path / "again.csv", "--seed", "1")
    assert [n.design for n in again.values()] == [n.design for n in found.values()]
    other = sampled(tmp_path / "other.csv", "--seed", "2", "--sampling", "sobol")
    assert not {n.design for n in other.values()} & {n.design for n in found.values()}


def test_whole_numbers_are_equally_likely_in_a_sample() -> None:
    found = sample(HalfBellows, 2000, RULES, np.random.default_rng(5))
    counts = np.bincount([int(design.as_dict()["N"]) for design in found])[4:]
    assert len(counts) == 7
    assert counts.min() > 0.8 * counts.mean()


@pytest.mark.parametrize(
    ("arguments", "words"),
    [
        (["--family", "x"], "pagd: family = 'x': must be pneunet or half_bellows"),
        (["--family", "half_bellows", "-n", "0"], "pagd: designs = 0 must be at least 1."),
        (["--family", "half_bellows", "--sampling", "grid"], "pagd: sampling = 'grid' must be one"),
        (["--family", "half_bellows", "--seed", "-1"], "pagd: --seed = -1 must be at least 0."),
        (
            ["--family", "half_bellows", "--config", '{"limits": {"thickness_mm": 9}}'],
            "pagd: family = 'half_bellows': only 0 of ",
        ),
    ],
)
def test_what_cannot_be_sampled_is_told(
    arguments: list[str], words: str, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    assert main(["sample", *arguments, "--out", str(tmp_path / "a.csv")]) == 2
    told = capsys.readouterr().err
    assert told.startswith(words)
    assert told.count("\n") == 1
    assert list(tmp_path.iterdir()) == []


def test_python_takes_designs_of_any_family(tmp_path: Path) -> None:
    broken = {key: value for key, value in BELLOWS.items() if key != "name"} | {"t_e": 0.5}
    given = (broken, bellows(t_e=0.5), design_from(json.dumps(broken)))
    for number, design in enumerate(given):
        result = simulate(design, tmp_path / f"design-{number}", name="thin")
        assert result.status == "invalid_geometry"
        assert result.design == bellows(t_e=0.5)
    with pytest.raises(InputError, match="Unusable design: Lc is not a design parameter"):
        simulate(broken | {"Lc": 1.0}, tmp_path / "other")


def test_machines_read_designs_of_any_family(capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["design", "show", json.dumps(BELLOWS), "--json"]) == 0
    document = json.loads(capsys.readouterr().out)
    volumes = bellows().volumes(RULES)
    assert document["family"] == "half_bellows"
    assert document["L_T"] == 26.0
    assert document["cavity_volume_mm3"] == pytest.approx(volumes.cavity)
    assert document["violations"] == []


def test_a_design_knows_what_it_is() -> None:
    named = NamedDesign(name="b", origin="own", design=bellows())
    changed = dataclasses.replace(named, design=bellows(t=1.9))
    assert named != changed
    assert bellows(t=1.9)["t"] == 1.9
