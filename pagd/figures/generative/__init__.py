"""Pictures of the generative half: data set, embedding, mixture, diversity, performance.

Each figure has a file with a function ``x_figure`` on tables and arrays, and ``draw_x`` on the
result files. :func:`pagd.figures.generative.draw.draw_generative` draws all that there is;
:mod:`pagd.figures.generative.captions` says how each was computed.
"""
