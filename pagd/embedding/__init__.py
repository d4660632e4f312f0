"""Reduced spaces of designs, and the way back: t-SNE, PCA, or none."""

from pagd.embedding.interface import Embedding
from pagd.embedding.registry import EMBEDDINGS, make_embedding

__all__ = ["EMBEDDINGS", "Embedding", "make_embedding"]
