"""Pictures of designs and their results, and the page that shows them.

Nothing is imported here: the pictures need pyvista and matplotlib, and each module takes only what
it draws with. Reading is kept in :mod:`pagd.figures.load`; everything else works on arrays.
"""
