# The training designs and their reduced space.


rule dataset:
    output:
        dataset=directory("results/dataset"),
    log:
        "results/logs/dataset.log",
    benchmark:
        "results/benchmarks/dataset.tsv"
    resources:
        mem_mb=1000,
        runtime=20,
    params:
        version=STAGE_VERSIONS["dataset"],
        config=config_of("dataset"),
        known=KNOWN,
    message:
        "Draw the training designs."
    shell:
        "pagd dataset --config {params.config:q} --out {output.dataset:q} > {log:q} 2>&1"


rule embedding:
    input:
        dataset=rules.dataset.output.dataset,
    output:
        embedding=directory("results/embedding"),
    log:
        "results/logs/embedding.log",
    benchmark:
        "results/benchmarks/embedding.tsv"
    # Everything else waits for the plane: it may have both cores of a small machine.
    threads: 2
    resources:
        mem_mb=2000,
        runtime=30,
    params:
        version=STAGE_VERSIONS["embedding"],
        config=config_of("embedding"),
    message:
        "Embed the training designs in a reduced space."
    shell:
        "pagd embed --dataset {input.dataset:q} --config {params.config:q} --threads {threads}"
        " --out {output.embedding:q} > {log:q} 2>&1"
