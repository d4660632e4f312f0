from __future__ import annotations

import numpy as np
import pandas as pd
import pytest
from design_samples import TABLE2_MIXED, training
from sklearn.base import clone
from sklearn.pipeline import make_pipeline
from sklearn.preprocessing import FunctionTransformer

from pagd.dataset.frame import INDEPENDENT, designs_of, frame_of
from pagd.encoding import Encoder, Limiter


def raw(**values: float) -> pd.DataFrame:
    """Return parameters of one bending training design, some of them replaced."""
    return training().loc[[0], list(INDEPENDENT)].astype(float).assign(**values)


def test_numbers_are_standardised_and_categories_are_one_hot() -> None:
    vectors = Encoder().fit_transform(training())
    assert vectors.shape == (240, 17)
    np.testing.assert_allclose(vectors[:, :14].mean(axis=0), 0, atol=1e-12)
    np.testing.assert_allclose(vectors[:, :14].std(axis=0), 1, rtol=1e-12)
    bending = (training()["mode"] == "bending").to_numpy()
    np.testing.assert_array_equal(vectors[:, 14:], np.c_[bending, ~bending, np.ones(240)])


def test_the_places_of_a_vector_have_names() -> None:
    names = list(Encoder().fit(training()).get_feature_names_out())
    assert names[:14] == [*INDEPENDENT, "L_T", "N1", "N2"]
    assert names[14:] == ["mode_bending", "mode_twisting", "cross_section_rectangular"]


def test_a_mixed_design_is_of_neither_category() -> None:
    vector = Encoder().fit(training()).transform(frame_of([TABLE2_MIXED], ["m"], "table2"))
    np.testing.assert_array_equal(vector[0, 14:], [0, 0, 1])


def test_the_way_back_gives_the_same_designs() -> None:
    encoder = Encoder().fit(training())
    decoded = Limiter(training())(encoder.inverse_transform(encoder.transform(training())))
    assert designs_of(decoded.parameters) == designs_of(training())
    assert decoded.corrections == {}


def test_dependent_numbers_are_not_decoded() -> None:
    encoder = Encoder().fit(training())
    vectors = encoder.transform(training())
    wrong = vectors.copy()
    wrong[:, 11:] = 7.0
    pd.testing.assert_frame_equal(
        encoder.inverse_transform(wrong), encoder.inverse_transform(vectors)
    )


def test_it_is_an_estimator_like_any_other() -> None:
    pipeline = make_pipeline(clone(Encoder()), FunctionTransformer())
    vectors = pipeline.fit_transform(training())
    back = pipeline.inverse_transform(vectors)
    np.testing.assert_allclose(back["L"], training()["L"])


def test_one_category_alone_can_be_encoded() -> None:
    bending = training().query("mode == 'bending'")
    vectors = Encoder().fit_transform(bending)
    assert vectors.shape == (120, 16)
    assert np.isfinite(vectors).all()


def test_whole_chambers_only() -> None:
    decoded = Limiter(training())(raw(N=9.4, alpha=0.49, theta=20.123))
    row = decoded.parameters.iloc[0]
    # 0.49 of 9 chambers are 4.41, which is 4.
    assert (row["N"], row["alpha"], row["theta"]) == (9, 0.4444, 20.12)
    assert decoded.corrections == {}


@pytest.mark.parametrize(("alpha", "theta"), [(0.05, 0.0), (0.95, 20.12)])
def test_a_share_of_less_than_half_a_chamber_is_none(alpha: float, theta: float) -> None:
    row = Limiter(training())(raw(N=6, alpha=alpha, theta=20.12)).parameters.iloc[0]
    assert row["alpha"] == round(alpha)
    assert row["theta"] == theta


def test_limits_are_those_of_the_training_designs_and_are_counted() -> None:
    rows = pd.concat([raw(L=30.0), raw(L=1.0, t_b=9.0), raw(theta=80, alpha=1.0), raw(alpha=-0.3)])
    decoded = Limiter(training())(rows)
    assert decoded.corrections == {"L": 2, "t_b": 1, "theta": 1, "alpha": 1}
    ranges = training()[list(INDEPENDENT)].agg(["min", "max"])
    assert list(decoded.parameters["L"][:2]) == [ranges["L"]["max"], ranges["L"]["min"]]
    assert decoded.parameters["theta"][2] == ranges["theta"]["max"]


def test_a_slant_is_at_least_the_smallest_of_the_slanted_designs() -> None:
    """The range of all designs begins at 0, where a helical chamber would be a straight one."""
    decoded = Limiter(training())(raw(theta=1.0, alpha=0.5))
    smallest = training().query("N1 > 0")["theta"].min()
    assert smallest > 5
    assert decoded.parameters["theta"][0] == smallest
    assert decoded.corrections == {"theta": 1}
