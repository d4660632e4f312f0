# Many designs by a chamber each: all generated ones, and training designs to compare them with.


wildcard_constraints:
    screened="generated|training",
    part=r"\d+",


rule screening:
    input:
        of_screening("results/screening/generated"),
        of_screening("results/screening/training"),
        of_screening("results/summary/fronts.json"),


rule screen_part:
    input:
        designs=designs_to_screen,
    output:
        part=directory("results/screening/parts/{screened}_{part}"),
    log:
        "results/logs/screening/{screened}_{part}.log",
    benchmark:
        "results/benchmarks/screening/{screened}_{part}.tsv"
    resources:
        mem_mb=2000,
        runtime=60,
    params:
        version=[STAGE_VERSIONS[stage] for stage in SCREENING_STAGES],
        config=config_of("screening"),
        material=MATERIALS["material"],
        paper=MATERIALS["paper"],
        part=part_of_table,
    message:
        "Analyse {wildcards.screened} designs by a chamber each, part {wildcards.part}."
    shell:
        "pagd screen {input.designs:q}/designs.parquet --part {params.part:q}"
        " --material {params.material:q} --paper {params.paper:q} --config {params.config:q}"
        " --out {output.part:q} > {log:q} 2>&1"


rule screened:
    input:
        parts=parts_to_screen,
    output:
        screened=directory("results/screening/{screened}"),
    log:
        "results/logs/screening/{screened}.log",
    benchmark:
        "results/benchmarks/screening/{screened}.tsv"
    resources:
        mem_mb=2000,
        runtime=10,
    params:
        version=STAGE_VERSIONS["screening"],
    message:
        "Gather what chambers tell of {wildcards.screened} designs."
    script:
        "../scripts/screened.py"


rule fronts:
    input:
        generated="results/screening/generated",
        training="results/screening/training",
    output:
        fronts="results/summary/fronts.json",
    log:
        "results/logs/fronts.log",
    benchmark:
        "results/benchmarks/fronts.tsv"
    resources:
        mem_mb=1000,
        runtime=10,
    params:
        version=STAGE_VERSIONS["fronts"],
        seed=CONFIG["screening"]["seed"],
    message:
        "Compare the Pareto fronts of generated and training designs."
    script:
        "../scripts/fronts.py"
