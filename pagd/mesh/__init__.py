"""Tetrahedral meshes with named surfaces: types, meshers, quality, files.

Nothing is imported here, so that ``pagd.mesh.types`` stays free of gmsh.
"""
