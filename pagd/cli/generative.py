"""What the subcommands of the generative half do, and the line in which they tell how it went."""

from __future__ import annotations

from argparse import Namespace
from collections.abc import Mapping
from typing import Any

from pagd.cli.answer import Answer, answer_of
from pagd.cli.options import checked_threads, config_of
from pagd.errors import InputError

__all__ = ["dataset", "diversity", "embed", "generate", "sample", "screen", "select"]


def dataset(options: Namespace) -> Answer:
    """Run the stage dataset."""
    from pagd.stages import dataset as stage

    record = stage.run(options.out, config_of(options))
    found = record.figures
    drawn = sum(sum(parts.values()) for parts in found["drawn"].values())
    accepted = sum(
        found["counts"][mode].get(origin, 0)
        for mode, parts in found["drawn"].items()
        for origin in parts
    )
    modes = {mode: sum(counts.values()) for mode, counts in found["counts"].items()}
    print(
        f"{found['size']} designs ({_listed(modes)}) in {options.out}; "
        f"{accepted / max(drawn, 1):.1%} of those drawn were valid and new."
    )
    for note in found["notes"]:
        print(note)
    return answer_of(record, options.out)


def embed(options: Namespace) -> Answer:
    """Run the stage embedding."""
    from pagd.stages import embedding as stage

    threads = checked_threads(options.threads)
    record = stage.run(options.dataset, options.out, config_of(options), threads=threads)
    found = record.figures
    error = found["left_out_error"]
    print(
        f"{found['size']} designs in {found['dimensions']} dimensions in {options.out}: "
        f"trustworthiness {found['trustworthiness']:.3f}, decoding "
        + (
            f"from the other designs is off by {error:.2f} standard deviations."
            if error is not None
            else f"is off by {found['round_trip_error']:.2g} standard deviations."
        )
    )
    return answer_of(record, options.out)


def generate(options: Namespace) -> Answer:
    """Run the stage generate; without a data set or an embedding it makes them first."""
    from pagd.stages import generate as stage

    config, threads = config_of(options), checked_threads(options.threads)
    _tell_what_is_made(options, config)
    record = stage.run(
        options.out,
        config,
        dataset=options.dataset,
        embedding=options.embedding,
        mode=options.mode,
        threads=threads,
    )
    found = record.figures
    shares = {mode: f"{share:.0%}" for mode, share in found["mode_share"].items() if share}
    print(
        f"{found['designs']} designs ({_listed(shares)}) in {options.out}, of "
        f"{found['proposed']} proposed; novelty {found['novelty_mean']:.3f}."
    )
    return answer_of(record, options.out)


def diversity(options: Namespace) -> Answer:
    """Run the stage diversity."""
    from pagd.stages import diversity as stage

    record = stage.run(
        options.dataset,
        options.embedding,
        options.generated,
        options.out,
        config_of(options),
        threads=checked_threads(options.threads),
    )
    found = record.figures
    for name, novelty in found["novelty_encoded"].items():
        ratio = found["hull_ratio_plane"].get(name)
        hull = "" if ratio is None else f", hull in the plane {ratio:.2f} of the training designs'"
        print(f"{name}: novelty {novelty:.3f}{hull}")
    for name, reason in found["left_out"].items():
        print(f"{name}: left out ({reason})")
    return answer_of(record, options.out)


def screen(options: Namespace) -> Answer:
    """Run the stage screening."""
    checked_threads(options.processes, "--processes")
    from pagd.catalogue import read_pneunets
    from pagd.stages import screening as stage
    from pagd.stages.solve import materials_of

    config = config_of(options)
    designs = list(read_pneunets({options.designs.stem: str(options.designs)}).values())
    record = stage.run(
        designs,
        options.out,
        config,
        materials_of(config, options.material, options.paper),
        fidelity=options.fidelity,
        processes=options.processes,
        part_of=options.part,
    )
    found = record.figures
    print(
        f"{found['designs']} designs ({_listed(found['statuses'])}) in {options.out}, "
        f"{found['cpu_s_median']:.2f} core-s each in the median."
    )
    return answer_of(record, options.out)


def sample(options: Namespace) -> Answer:
    """Write a table of random designs of a family."""
    import numpy as np

    from pagd.catalogue import name_from
    from pagd.families import family_named
    from pagd.families import sampling as library
    from pagd.files import write_text
    from pagd.stages.geometry import rules_of

    if options.out.suffix != ".csv":
        raise InputError(f"--out = {options.out} must end in .csv.")
    if options.seed < 0:
        raise InputError(f"--seed = {options.seed} must be at least 0.")
    designs = library.sample(
        family_named(options.family),
        options.designs,
        rules_of(config_of(options)),
        np.random.default_rng(options.seed),
        options.sampling,
    )
    write_text(options.out, library.table_of(designs, f"{name_from(options.out)}_"))
    print(f"{len(designs)} designs in {options.out}")
    return Answer(0, {"file": options.out, "family": options.family, "designs": len(designs)})


def select(options: Namespace) -> Answer:
    """Run the stage selection."""
    from pagd.stages import selection as stage

    record = stage.run(options.dataset, options.generated, options.out, config_of(options))
    found = record.figures
    modes = f" ({_listed(found['modes'])})" if found["modes"] else ""
    print(
        f"{found['designs']} of {found['candidates']} designs{modes} "
        f"in {options.out / stage.SELECTION_NAME}"
    )
    return answer_of(record, options.out)


def _tell_what_is_made(options: Namespace, config: Mapping[str, Any]) -> None:
    data, plane = config["dataset"], config["embedding"]
    if options.dataset is None and options.embedding is None:
        print(
            f"No --dataset is given: {data['size']} designs are drawn for this one, into "
            f"{options.out / 'dataset'} (section dataset of the configuration).",
            flush=True,
        )
    if options.embedding is None:
        print(
            f"No --embedding is given: it is made by {plane['method']}, into "
            f"{options.out / 'embedding'} (section embedding of the configuration).",
            flush=True,
        )


def _listed(values: Mapping[str, Any]) -> str:
    return ", ".join(f"{value} {name}" for name, value in values.items())
