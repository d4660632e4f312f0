"""What is written under the pictures: how each was computed, with the numbers of the run.

A caption is a row of sentences with places for facts; a sentence with a fact that a run does not
know is left out, so that no caption ever says what was not done.
"""

from __future__ import annotations

from collections.abc import Mapping
from string import Formatter
from typing import Any, Final

__all__ = ["CAPTIONS", "caption", "captions", "facts_of_settings", "written"]

#: Name of the picture to the sentences below it, in the order of the page.
CAPTIONS: Final[Mapping[str, tuple[str, ...]]] = {
    "embedding": (
        "The training designs in the reduced space (Fig. 4a of the paper): each has its 14"
        " numbers standardised and its categories one-hot.",
        "Method: {embedding}.",
        "Perplexity {perplexity}; neighbours matter in such a plane, distances between islands"
        " do not.",
        "Left: a seeded choice of up to 1,000, by category; right: all {trained}, by where they"
        " come from, with published actuators and those of Table 2 as stars.",
        "Trustworthiness {trustworthiness} (1: all neighbours are kept).",
        "Seed {embedding_seed}.",
    ),
    "mixture": (
        "Generated designs in the reduced space, by the mode of the decoded design (Fig. 4b of"
        " the paper), over the training designs in grey.",
        "Ellipses: {gaussians} Gaussians at one and two standard deviations.",
        "EM models where the data are, so that between the islands there are only its tails. The"
        " dashed Gaussian, with {bridge_weight} of the weight, is not fitted but put between the"
        " two categories (their Wasserstein barycentre); its share of the designs is a setting"
        " (generator.bridge_share). What it draws on an island is drawn again, so that its designs"
        " lie only where both kinds are blended; the ellipse shows the Gaussian before that.",
        "{redrawn} draws were made again.",
        "Upper right: the Bayesian information criterion of EM by number of Gaussians; it is least"
        " with {least_bic}.",
        "Lower right: the share α of helical chambers of the {mixed} mixed designs out of"
        " {generated}.",
        "Generator {generator}, seed {generator_seed}.",
    ),
    "hull": (
        "Convex hulls of random training and random generated designs at equal counts, in the"
        " plane (Fig. 5 of the paper).",
        "Left: one draw of {hull_designs} each; right: the areas of {hull_repeats} independent"
        " draws.",
        "The interval holds the middle 95 % of the ratios, draw by draw.",
        "Seed {diversity_seed}.",
    ),
    "comparison": (
        "All generators by the same measures; each dot is a generator, the line its interval"
        " where there is one; the dashed line is the same measure of the training designs.",
        "All parameters: the standardised 16 parameters; plane: the reduced space scaled to the"
        " unit square; small plane: the same made of {plane_designs} training designs, as the"
        " paper's, over {plane_seeds} seeds.",
        "Random sampling and resampling of the training set are the baselines: a measure that one"
        " of them wins says little about design.",
        "Coverage and density are over {neighbours} nearest neighbours.",
        "Seed {diversity_seed}.",
    ),
    "novelty_performance": (
        "Every simulated design by its novelty, the distance to the nearest training design in the"
        " standardised 16 parameters, and by what it does at the last pressure it reached.",
        "Colour and shape: the mode it was drawn for; open: Table 2 of the paper and published"
        " actuators, where novelty 0 means that the design is itself in the training set;"
        " crosses: designs that failed, as far as they came.",
        "The rank correlation (Spearman) is over the designs that ended well.",
        "{simulated} designs were simulated, {succeeded} ended well.",
    ),
    "bending_twist": (
        "Bending and twist of the tip of every simulated design at the last pressure it reached.",
        "Colour and shape: the mode it was drawn for; open: Table 2 of the paper and published"
        " actuators; crosses: designs that failed, as far as they came.",
        "{simulated} designs were simulated, {succeeded} ended well.",
    ),
    "force_bending": (
        "Blocked force against bending of the free tip of every simulated design, each at the last"
        " pressure that its analysis reached.",
        "The blocked force is that on the support of an actuator held from the start: what pushes"
        " hard need not bend far.",
        "Colour and shape: the mode it was drawn for; open: Table 2 of the paper and published"
        " actuators; crosses: designs whose free actuation failed.",
        "{held} of {simulated} simulated designs have a blocked force ({support}).",
    ),
    "feasibility": (
        "What became of the simulated designs, by the mode they were drawn for and by where they"
        " come from; the numbers are counts.",
        "Right: the mode drawn against the mode measured from bending and twist of the joints.",
        "{simulated} designs were simulated, {succeeded} ended well.",
    ),
    "screened": (
        "What generated and training designs can do, by a chamber each: bending and twist of the"
        " free tip, to either side, and blocked force, at the last pressure reached.",
        "Stairs are Pareto fronts: no design of a kind is beyond its own.",
        "Shown are designs that came to an equilibrium at the last pressure, or to the limit of"
        " bending: {screened} generated and {screened_training} training designs; with the blocked"
        " force only those whose force the gate trusts.",
    ),
    "screened_novelty": (
        "The screened generated designs by their novelty, the distance to the nearest training"
        " design in the standardised 16 parameters, and by what a chamber tells that they do;"
        " blocked forces are those that the gate trusts.",
        "Open circles: full analyses, joined to the same designs by a chamber, trusted or not.",
        "The rank correlation (Spearman) is over all shown.",
    ),
    "screened_beside_full": (
        "Bending, twist and blocked force by a chamber against those of the full analysis, of"
        " designs that have both and came to the same pressure, trusted or not.",
        "The median error is over designs with more than 5 % of the largest value.",
    ),
    "distributions": (
        "The eleven independent parameters: {generated} generated designs, stacked by mode, and"
        " {trained} training designs as outline.",
        "The distance is the Wasserstein distance of the two distributions in standard deviations"
        " of the training designs: 0 would be the same distribution.",
        "θ is compared among the designs that have slanted chambers.",
    ),
}

_METHODS: Final = {
    "tsne": "t-SNE",
    "pca": "principal components",
    "none": "none, the space of all encoded parameters",
}


def caption(name: str, facts: Mapping[str, str]) -> str:
    """Return the caption of a picture with the facts filled in.

    >>> caption("hull", {"diversity_seed": "1"}).endswith("Seed 1.")
    True
    """
    return " ".join(s.format_map(facts) for s in CAPTIONS[name] if _needs(s) <= set(facts))


def captions(facts: Mapping[str, str]) -> dict[str, str]:
    """Return the captions of all pictures."""
    return {name: caption(name, facts) for name in CAPTIONS}


def facts_of_settings(settings: Mapping[str, Any]) -> dict[str, str]:
    """Return the facts that a configuration alone knows (sections embedding, generator …)."""
    embedding, generator, diversity = (
        settings.get(name) or {} for name in ("embedding", "generator", "diversity")
    )
    method = embedding.get("method")
    known = {
        "embedding": _METHODS.get(str(method), method),
        "perplexity": embedding.get("perplexity") if method == "tsne" else None,
        "embedding_seed": embedding.get("seed"),
        "generator": generator.get("method"),
        "generator_seed": generator.get("seed"),
        "hull_designs": diversity.get("hull_designs"),
        "hull_repeats": diversity.get("hull_repeats"),
        "plane_designs": diversity.get("plane_designs"),
        "plane_seeds": diversity.get("plane_seeds"),
        "neighbours": diversity.get("neighbours"),
        "diversity_seed": diversity.get("seed"),
    }
    return {key: written(value) for key, value in known.items() if value is not None}


def _needs(sentence: str) -> set[str]:
    return {name for _, name, _, _ in Formatter().parse(sentence) if name}


def written(value: Any) -> str:
    """Return a fact as it stands in a caption."""
    if isinstance(value, float):
        return f"{value:,.0f}" if value.is_integer() else f"{value:,.3f}"
    return f"{value:,}" if isinstance(value, int) else str(value)
