# One design, stage by stage. Every stage leaves a folder with a record, also for a design that
# fails as designs may; the stages after it pass its status on within a fraction of a second.
#
# The first three take a second together, and are one job: with a job each, what Snakemake does for
# every job is most of the time of a dry run, and a good part of that of a sweep besides the solves.
# All take the folder for temporary files from their environment (`tmpdir=None`): Snakemake would
# look for it job by job.


rule prepare:
    input:
        selection=selection_of_design,
    output:
        geometry=directory("results/designs/{design}/geometry"),
        repair=directory("results/designs/{design}/repair"),
        mesh=directory("results/designs/{design}/mesh"),
    log:
        geometry="results/logs/geometry/{design}.log",
        repair="results/logs/repair/{design}.log",
        mesh="results/logs/mesh/{design}.log",
    benchmark:
        "results/benchmarks/prepare/{design}.tsv"
    retries: RETRIES
    resources:
        mem_mb=growing(2000),
        runtime=growing(40),
        tries_left=tries_left,
        tmpdir=None,
    params:
        versions=and_family([STAGE_VERSIONS[part] for part in ("geometry", "repair", "mesh")]),
        design=design_row,
        geometry=config_of("geometry"),
        repair=config_of("repair"),
        mesh=config_of("mesh"),
    message:
        "Draw, check and mesh design {wildcards.design}."
    shell:
        "pagd geometry --design {params.design:q} --config {params.geometry:q}"
        " --allotted $(({resources.runtime} / 3)) {resources.mem_mb} {resources.tries_left}"
        " --keep-going --out {output.geometry:q} > {log.geometry:q} 2>&1\n"
        "pagd repair --geometry {output.geometry:q} --config {params.repair:q}"
        " --allotted $(({resources.runtime} / 3)) {resources.mem_mb} {resources.tries_left}"
        " --keep-going --out {output.repair:q} > {log.repair:q} 2>&1\n"
        "pagd mesh --geometry {output.geometry:q} --repair {output.repair:q}"
        " --config {params.mesh:q}"
        " --allotted $(({resources.runtime} / 3)) {resources.mem_mb} {resources.tries_left}"
        " --keep-going --out {output.mesh:q} > {log.mesh:q} 2>&1"


rule solve:
    input:
        mesh=rules.prepare.output.mesh,
    output:
        solve=directory("results/designs/{design}/solve"),
    log:
        "results/logs/solve/{design}.log",
    benchmark:
        "results/benchmarks/solve/{design}.tsv"
    retries: RETRIES
    # One thread a solve: two designs side by side beat one design on two threads.
    threads: 1
    resources:
        mem_mb=growing(4000),
        runtime=growing(120),
        tries_left=tries_left,
        tmpdir=None,
    params:
        version=STAGE_VERSIONS["solve"],
        config=config_of("solve"),
        material=MATERIALS["material"],
        paper=MATERIALS["paper"],
    message:
        "Solve design {wildcards.design} under rising pressure."
    shell:
        "pagd solve --mesh {input.mesh:q} --config {params.config:q}"
        " --material {params.material:q} --paper {params.paper:q} --threads {threads}"
        " --allotted {resources.runtime} {resources.mem_mb} {resources.tries_left}"
        " --keep-going --out {output.solve:q} > {log:q} 2>&1"


rule metrics:
    input:
        geometry=rules.prepare.output.geometry,
        repair=rules.prepare.output.repair,
        mesh=rules.prepare.output.mesh,
        solve=rules.solve.output.solve,
    output:
        metrics=directory("results/designs/{design}/metrics"),
    log:
        "results/logs/metrics/{design}.log",
    benchmark:
        "results/benchmarks/metrics/{design}.tsv"
    retries: RETRIES
    resources:
        mem_mb=growing(1500),
        runtime=growing(10),
        tries_left=tries_left,
        tmpdir=None,
    params:
        version=STAGE_VERSIONS["metrics"],
        config=config_of("metrics"),
    message:
        "Measure trajectory, bending and twist of design {wildcards.design}."
    shell:
        "pagd metrics --geometry {input.geometry:q} --repair {input.repair:q}"
        " --mesh {input.mesh:q} --solve {input.solve:q} --config {params.config:q}"
        " --allotted {resources.runtime} {resources.mem_mb} {resources.tries_left}"
        " --keep-going --out {output.metrics:q} > {log:q} 2>&1"
