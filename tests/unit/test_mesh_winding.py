import numpy as np
from mesh_samples import box_surface, together

from pagd.mesh.winding import inside, winding_numbers

CUBE = box_surface((0, 0, 0), (2, 2, 2))
HOLLOW = together(CUBE, box_surface((0.5, 0.5, 0.5), (1.5, 1.5, 1.5), inwards=True))


def test_winding_number_is_one_inside_and_zero_outside() -> None:
    queries = np.random.default_rng(0).uniform(-1, 3, (5000, 3))
    expected = ((queries > 0) & (queries < 2)).all(axis=1)
    numbers = winding_numbers(queries, CUBE.points, CUBE.triangles)
    np.testing.assert_allclose(numbers, expected, atol=1e-9)
    np.testing.assert_array_equal(inside(queries, CUBE.points, CUBE.triangles), expected)


def test_void_is_outside() -> None:
    queries = np.array([[1.0, 1.0, 1.0], [0.2, 1.0, 1.0], [2.2, 1.0, 1.0]])
    found = inside(queries, HOLLOW.points, HOLLOW.triangles)
    assert found.tolist() == [False, True, False]


def test_a_missing_triangle_does_not_turn_the_answer() -> None:
    queries = np.array([[1.0, 1.0, 1.0], [-3.0, 1.0, 1.0]])
    numbers = winding_numbers(queries, CUBE.points, CUBE.triangles[1:])
    assert numbers[0] > 0.9
    assert abs(numbers[1]) < 0.1


def test_no_queries_give_no_answers() -> None:
    assert winding_numbers(np.empty((0, 3)), CUBE.points, CUBE.triangles).shape == (0,)
