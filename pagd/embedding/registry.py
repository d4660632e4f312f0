"""Embeddings by their names in the configuration. A new one: a class, and a line here."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from typing import Any, Final

from pagd.embedding.interface import Embedding
from pagd.embedding.linear import FullSpace, PrincipalComponents
from pagd.embedding.tsne import TSNE

__all__ = ["EMBEDDINGS", "make_embedding"]

#: Name to a function that makes the embedding from the section ``embedding`` of a configuration
#: and the number of threads (−1: all cores).
EMBEDDINGS: Final[Mapping[str, Callable[[Mapping[str, Any], int], Embedding]]] = {
    "tsne": lambda given, threads: TSNE(given["perplexity"], given["neighbours"], threads),
    "pca": lambda given, threads: PrincipalComponents(given["dimensions"]),
    "none": lambda given, threads: FullSpace(),
}


def make_embedding(section: Mapping[str, Any], threads: int = -1) -> Embedding:
    """Return the embedding, not fitted, that the section ``embedding`` asks for."""
    return EMBEDDINGS[section["method"]](section, threads)
