"""The stages of the chain: each reads folders, calls the library and leaves a folder.

A stage's folder holds its files and ``record.json``. A design that fails in an expected way
leaves a folder too, with the reason in the record; the stages after it pass that on.
"""

#: Version of each stage's meaning. Raise it when a change of the library changes what the stage
#: makes of the same inputs: the workflow then runs it again, and what follows from it.
STAGE_VERSIONS = {
    "dataset": 1,
    "embedding": 1,
    "generate": 2,
    "diversity": 1,
    "selection": 1,
    "geometry": 1,
    "repair": 1,
    "mesh": 3,
    "solve": 11,
    "metrics": 5,
    "screening": 5,
    "fronts": 4,
    "figures": 3,
    "export": 1,
    "generative_figures": 4,
    "summary": 5,
    "report": 8,
    "run_crate": 1,
}
