# All designs together: one row a design, whatever became of it, and what was measured of all.


rule summary:
    input:
        "results/summary/performance.parquet",
        "results/summary/by_pressure.parquet",
        "results/summary/chambers.parquet",
        "results/summary/trajectories.parquet",
        "results/summary/summary.csv",
        of_generative_half("results/summary/diversity.json"),
        # Designs of the tables need not wait until others are selected.
        expand(rules.metrics.output.metrics, design=TABLES),


rule summary_tables:
    input:
        geometry=of_all_designs(rules.prepare.output.geometry),
        metrics=of_all_designs(rules.metrics.output.metrics),
        dataset=of_generative_half(rules.dataset.output.dataset),
    output:
        performance="results/summary/performance.parquet",
        by_pressure="results/summary/by_pressure.parquet",
        chambers="results/summary/chambers.parquet",
        trajectories="results/summary/trajectories.parquet",
        table=report(
            "results/summary/summary.csv",
            caption="../report/summary.rst",
            category="Summary",
            labels={"table": "bending and twist"},
        ),
    log:
        "results/logs/summary.log",
    benchmark:
        "results/benchmarks/summary.tsv"
    resources:
        mem_mb=1000,
        runtime=10,
    params:
        version=STAGE_VERSIONS["summary"],
    message:
        "Gather performance, chambers and trajectories of all designs."
    script:
        "../scripts/summary.py"
