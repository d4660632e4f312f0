# All designs together: one row a design, whatever became of it.


rule summary:
    input:
        "results/summary/performance.parquet",
        "results/summary/trajectories.parquet",
        "results/summary/summary.csv",


rule summary_tables:
    input:
        metrics=of_all_designs(rules.metrics.output.metrics),
    output:
        performance="results/summary/performance.parquet",
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
        "Gather performance and trajectories of all designs."
    script:
        "../scripts/summary.py"
