"""t-SNE by openTSNE, which pagd uses, against scikit-learn's: seconds, trustworthiness, repeats.

    python benchmarks/embedding.py [--size 11000] [--threads 2]

Both embed the same data set with the same perplexity, one after the other, in this process.
"""

from __future__ import annotations

import argparse
import importlib.metadata
import platform
import time
from collections.abc import Callable

import numpy as np
from numpy.typing import NDArray
from sklearn.manifold import TSNE as PEER
from sklearn.manifold import trustworthiness

from pagd import TSNE, Encoder, make_dataset

PERPLEXITY = 30


def main() -> None:
    """Print one row a library, and the ratio of the times."""
    options = _options()
    designs = make_dataset(options.size).designs
    vectors = Encoder().fit_transform(designs)

    def ours() -> NDArray[np.float64]:
        return TSNE(PERPLEXITY, threads=options.threads).fit(designs).points

    def peer() -> NDArray[np.float64]:
        method = PEER(perplexity=PERPLEXITY, random_state=1, n_jobs=options.threads)
        return np.asarray(method.fit_transform(vectors), dtype=np.float64)

    ours_s, plane = _timed(ours)
    peer_s, other = _timed(peer)
    again_s, again = _timed(ours)
    print(_machine(options.size, options.threads))
    print("library       seconds  trustworthiness")
    for name, seconds, points in (("openTSNE", ours_s, plane), ("scikit-learn", peer_s, other)):
        print(f"{name:<12}  {seconds:7.1f}  {trustworthiness(vectors, points, n_neighbors=12):.4f}")
    print(f"scikit-learn / openTSNE: {peer_s / ours_s:.2f}")
    print(f"openTSNE again: {again_s:.1f} s, largest difference {abs(again - plane).max():g}")
    new_s, _ = _timed(lambda: TSNE(PERPLEXITY).restore(designs, plane).transform(designs[:1000]))
    print(f"1,000 designs placed in the finished plane: {new_s:.1f} s (scikit-learn cannot)")


def _timed(call: Callable[[], NDArray[np.float64]]) -> tuple[float, NDArray[np.float64]]:
    start = time.perf_counter()
    result = call()
    return time.perf_counter() - start, result


def _machine(size: int, threads: int) -> str:
    libraries = (
        f"{name} {importlib.metadata.version(name)}" for name in ("openTSNE", "scikit-learn")
    )
    return f"{size} designs, {threads} threads, {platform.machine()}, {', '.join(libraries)}"


def _options() -> argparse.Namespace:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--size", type=int, default=11_000, help="designs (default: %(default)s)")
    parser.add_argument("--threads", type=int, default=2, help="threads (default: %(default)s)")
    return parser.parse_args()


if __name__ == "__main__":
    main()
