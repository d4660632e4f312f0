# New designs, how new and varied they are, and which of them are simulated.


rule generative:
    input:
        rules.dataset.output.dataset,
        rules.embedding.output.embedding,
        "results/generated",
        "results/diversity",
        "results/summary/diversity.json",
        "results/figures/generative",


rule generate:
    input:
        dataset=rules.dataset.output.dataset,
        embedding=rules.embedding.output.embedding,
    output:
        generated=directory("results/generated"),
    log:
        "results/logs/generate.log",
    benchmark:
        "results/benchmarks/generate.tsv"
    resources:
        mem_mb=2000,
        runtime=20,
    params:
        version=STAGE_VERSIONS["generate"],
        config=config_of("generate"),
    message:
        "Fit the generator and draw new designs."
    shell:
        "pagd generate --dataset {input.dataset:q} --embedding {input.embedding:q}"
        " --config {params.config:q} --out {output.generated:q} > {log:q} 2>&1"


rule diversity:
    input:
        dataset=rules.dataset.output.dataset,
        embedding=rules.embedding.output.embedding,
        generated=rules.generate.output.generated,
    output:
        diversity=directory("results/diversity"),
    log:
        "results/logs/diversity.log",
    benchmark:
        "results/benchmarks/diversity.tsv"
    # Beside the simulations: threads that wait for a core that others use cost more than they give.
    threads: 1
    resources:
        mem_mb=2000,
        runtime=60,
    params:
        version=STAGE_VERSIONS["diversity"],
        config=config_of("diversity"),
    message:
        "Compare the generators: novelty and diversity of their designs."
    shell:
        "pagd diversity --dataset {input.dataset:q} --embedding {input.embedding:q}"
        " --generated {input.generated:q} --config {params.config:q} --threads {threads}"
        " --out {output.diversity:q} > {log:q} 2>&1"


rule diversity_table:
    input:
        diversity=rules.diversity.output.diversity,
    output:
        table="results/summary/diversity.json",
    log:
        "results/logs/diversity_table.log",
    benchmark:
        "results/benchmarks/diversity_table.tsv"
    resources:
        mem_mb=100,
        runtime=5,
    params:
        version=STAGE_VERSIONS["diversity"],
    message:
        "Put the measures of novelty and diversity beside the other tables."
    shell:
        "cp {input.diversity:q}/diversity.json {output.table:q} 2> {log:q}"


# A checkpoint: which designs are simulated is known only when it is done.
checkpoint select:
    input:
        dataset=rules.dataset.output.dataset,
        generated=rules.generate.output.generated,
    output:
        selection=directory("results/selection"),
    log:
        "results/logs/selection.log",
    benchmark:
        "results/benchmarks/selection.tsv"
    resources:
        mem_mb=1000,
        runtime=10,
    params:
        version=STAGE_VERSIONS["selection"],
        config=config_of("selection"),
    message:
        "Select the generated designs to simulate."
    shell:
        "pagd select --dataset {input.dataset:q} --generated {input.generated:q}"
        " --config {params.config:q} --out {output.selection:q} > {log:q} 2>&1"
