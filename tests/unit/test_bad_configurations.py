"""Configurations that nobody has thought of: each is taken, or refused in one sentence."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import pytest
import yaml
from hypothesis import given
from hypothesis import strategies as st

from pagd.cli import main
from pagd.config import SECTIONS, checked, completed, load
from pagd.errors import InputError

VALUES = st.recursive(
    st.one_of(
        st.none(),
        st.booleans(),
        st.integers(),
        st.floats(),
        st.text(max_size=12),
        st.sampled_from([-1, 0, 0.5, 1e9, "auto", "gmsh", "; reboot", [], {}]),
    ),
    lambda inner: st.lists(inner, max_size=3) | st.dictionaries(st.text(max_size=6), inner),
    max_leaves=4,
)
KEYS = [
    (section, key)
    for section, value in completed({}).items()
    if isinstance(value, dict)
    for key in value
]


def taken_or_refused(read: Callable[[], dict[str, Any]]) -> tuple[dict[str, Any], str]:
    """The configuration, or the sentence that refuses it."""
    try:
        return read(), ""
    except InputError as error:
        return {}, str(error)


@given(place=st.sampled_from(KEYS), value=VALUES)
def test_any_value_is_taken_or_refused_by_its_name(place: tuple[str, str], value: Any) -> None:
    section, key = place
    config, refusal = taken_or_refused(lambda: checked({section: {key: value}}, "here"))
    if refusal:
        assert refusal.startswith("here: ")
        assert section in refusal
    else:
        assert repr(config[section][key]) == repr(value)
        assert set(config) == set(completed({}))


@given(document=st.dictionaries(st.text(max_size=12) | st.sampled_from(list(SECTIONS)), VALUES))
def test_any_document_is_taken_or_refused(document: dict[str, Any]) -> None:
    config, refusal = taken_or_refused(lambda: checked(document, "here"))
    assert refusal.startswith("here: ") or set(config) >= set(document)


@given(text=st.text(max_size=60))
def test_any_text_is_taken_or_refused(text: str, tmp_path_factory: pytest.TempPathFactory) -> None:
    file = tmp_path_factory.getbasetemp() / "any.yaml"
    file.write_text(text, encoding="utf-8", errors="replace")
    config, refusal = taken_or_refused(lambda: load(str(file)))
    assert "any.yaml" in refusal or set(config) == set(completed({}))


def test_what_is_refused_leaves_nothing(tmp_path: Any, capsys: pytest.CaptureFixture[str]) -> None:
    file = tmp_path / "bad.yaml"
    file.write_text(yaml.safe_dump({"solve": {"maximum_pressure_kPa": float("nan")}}))
    out = tmp_path / "out"
    assert main(["dataset", "--config", str(file), "--out", str(out)]) == 2
    (line,) = capsys.readouterr().err.splitlines()
    assert "solve.maximum_pressure_kPa = nan" in line
    assert not out.exists()
