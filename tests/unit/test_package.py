from __future__ import annotations

import subprocess
import sys

import pytest

import pagd


@pytest.mark.parametrize("name", pagd.__all__)
def test_what_is_listed_can_be_imported(name: str) -> None:
    thing = getattr(pagd, name)
    assert thing.__doc__
    assert name in dir(pagd)


def test_what_is_not_there_is_told() -> None:
    with pytest.raises(AttributeError, match="no attribute 'make_coffee'"):
        pagd.make_coffee  # noqa: B018


def test_the_package_alone_is_light() -> None:
    code = "import sys, pagd; print({'numpy', 'pandas', 'sklearn', 'openTSNE'} & set(sys.modules))"
    command = [sys.executable, "-c", code]
    answer = subprocess.run(command, capture_output=True, text=True, check=True)
    assert answer.stdout.strip() == "set()"


def test_the_example_of_the_package() -> None:
    data = pagd.make_dataset(size=120, seed=1)
    plane = pagd.TSNE(perplexity=10, threads=1).fit(data.designs)
    generated = pagd.generate(
        pagd.ReducedSpaceMixture(largest_components=1).fit(plane), 30, training=data.designs
    )
    assert set(generated.designs["mode"]) == {"bending", "twisting", "mixed"}
