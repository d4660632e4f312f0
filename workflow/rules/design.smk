# One design, stage by stage. Every stage leaves a folder with a record, also for a design that
# fails as designs may; the stages after it pass its status on within a fraction of a second.


rule geometry:
    input:
        selection=selection_of_design,
    output:
        geometry=directory("results/designs/{design}/geometry"),
    log:
        "results/logs/geometry/{design}.log",
    benchmark:
        "results/benchmarks/geometry/{design}.tsv"
    resources:
        mem_mb=1000,
        runtime=10,
    params:
        version=STAGE_VERSIONS["geometry"],
        design=design_row,
        config=config_of("geometry"),
    message:
        "Draw design {wildcards.design} with OpenSCAD."
    shell:
        "pagd geometry --design {params.design:q} --config {params.config:q}"
        " --keep-going --out {output.geometry:q} > {log:q} 2>&1"


rule repair:
    input:
        geometry=rules.geometry.output.geometry,
    output:
        repair=directory("results/designs/{design}/repair"),
    log:
        "results/logs/repair/{design}.log",
    benchmark:
        "results/benchmarks/repair/{design}.tsv"
    resources:
        mem_mb=1000,
        runtime=10,
    params:
        version=STAGE_VERSIONS["repair"],
        config=config_of("repair"),
    message:
        "Check and repair the surfaces of design {wildcards.design}."
    shell:
        "pagd repair --geometry {input.geometry:q} --config {params.config:q}"
        " --keep-going --out {output.repair:q} > {log:q} 2>&1"


rule mesh:
    input:
        geometry=rules.geometry.output.geometry,
        repair=rules.repair.output.repair,
    output:
        mesh=directory("results/designs/{design}/mesh"),
    log:
        "results/logs/mesh/{design}.log",
    benchmark:
        "results/benchmarks/mesh/{design}.tsv"
    resources:
        mem_mb=2000,
        runtime=30,
    params:
        version=STAGE_VERSIONS["mesh"],
        config=config_of("mesh"),
    message:
        "Mesh design {wildcards.design}."
    shell:
        "pagd mesh --geometry {input.geometry:q} --repair {input.repair:q}"
        " --config {params.config:q} --keep-going --out {output.mesh:q} > {log:q} 2>&1"


rule solve:
    input:
        mesh=rules.mesh.output.mesh,
    output:
        solve=directory("results/designs/{design}/solve"),
    log:
        "results/logs/solve/{design}.log",
    benchmark:
        "results/benchmarks/solve/{design}.tsv"
    # One thread a solve: two designs side by side beat one design on two threads.
    threads: 1
    resources:
        mem_mb=4000,
        runtime=120,
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
        " --keep-going --out {output.solve:q} > {log:q} 2>&1"


rule metrics:
    input:
        geometry=rules.geometry.output.geometry,
        repair=rules.repair.output.repair,
        mesh=rules.mesh.output.mesh,
        solve=rules.solve.output.solve,
    output:
        metrics=directory("results/designs/{design}/metrics"),
    log:
        "results/logs/metrics/{design}.log",
    benchmark:
        "results/benchmarks/metrics/{design}.tsv"
    resources:
        mem_mb=1000,
        runtime=10,
    params:
        version=STAGE_VERSIONS["metrics"],
        config=config_of("metrics"),
    message:
        "Measure trajectory, bending and twist of design {wildcards.design}."
    shell:
        "pagd metrics --geometry {input.geometry:q} --repair {input.repair:q}"
        " --mesh {input.mesh:q} --solve {input.solve:q} --config {params.config:q}"
        " --keep-going --out {output.metrics:q} > {log:q} 2>&1"
